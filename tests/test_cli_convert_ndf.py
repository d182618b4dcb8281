#!/usr/bin/env python3
"""asperity convert-ndf: representations, conventions, moments, nearest distributions, refusals."""
import json
import math

from cli import check, near, run, run_sections


def words(line):
    """name:a=1,b=2 or a=1,b=2 as a dictionary."""
    return {k: float(v) for k, v in (item.split("=") for item in line.strip().split(":")[-1].split(","))}


def known(name):
    tree = json.loads(run("list", "distributions", "--json", status=0).stdout)
    return name in [d["name"] for d in tree["distributions"]]


def density(spec, x, y):
    rows = run("eval", "P22", "--ndf", spec, stdin="px,py\n%r,%r\n" % (x, y), status=0).stdout
    return float(rows.strip().split("\n")[-1].split(",")[-1])


def representations():
    spec = "ggx:alpha_x=0.3,alpha_y=0.1,rotation=0.4,mean_x=0.2,mean_y=-0.1"
    lines = run("convert-ndf", spec, "--digits", "17", status=0).stdout.split("\n")
    said = {line.split()[0]: line[11:] for line in lines if line}
    check(list(said)[:5] == ["roughness", "map", "matrix", "gram", "moments"], "lines: %s" % list(said))
    check(said["moments"].startswith("- ("), "ggx has no covariance: " + said["moments"])
    check(said["disney"].startswith("- ("), "a mean slope has no convention: " + said["disney"])
    for again in ("ggx:" + said["roughness"], "ellipsoid:" + said["matrix"], "ellipsoid:" + said["gram"]):
        for x, y in ((0, 0), (0.3, -0.2), (0.5, 0.4)):
            check(near(density(again, x, y), density(spec, x, y), 1e-12), again)
    m, r = words(said["map"]), words(said["roughness"])
    check(near(m["m00"] * m["m11"] - m["m01"] * m["m10"], r["alpha_x"] * r["alpha_y"], 1e-12), "det M")


def conventions():
    one = run("convert-ndf", "disney:roughness=0.5,anisotropic=0.3", "--to", "roughness", status=0).stdout
    aspect = math.sqrt(1 - 0.27)
    check(near(words(one)["alpha_x"], 0.25 / aspect, 1e-8), one)
    check(near(words(one)["alpha_y"], 0.25 * aspect, 1e-8), one)
    # through every other convention and back
    for other in ("gltf", "materialx", "openpbr", "filament", "pbrt", "pbrt3", "alpha"):
        there = run("convert-ndf", "disney:roughness=0.5,anisotropic=0.3,rotation=0.7", "--to", other,
                    "--digits", "17", status=0).stdout.strip()
        check(there.startswith(other + ":"), there)
        back = run("convert-ndf", there, "--to", "disney", "--digits", "17", status=0).stdout
        check(near(words(back)["roughness"], 0.5, 1e-12) and near(words(back)["anisotropic"], 0.3, 1e-11)
              and near(words(back)["rotation"], 0.7, 1e-12), other + ": " + back)
    check(near(words(run("convert-ndf", "ggx:alpha=0.3", "--to", "exponent", status=0).stdout)["exponent"],
               20.2222222, 1e-8), "the notebook's 2/alpha^2 - 2")
    table = json.loads(run("convert-ndf", "--conventions", "--json", status=0).stdout)
    check([c["name"] for c in table][:3] == ["alpha", "disney", "gltf"], "table")
    text = run("convert-ndf", "--conventions", status=0).stdout
    for c in table:
        check(c["formula"] in text and c["source"] in text, c["name"])
        # each at its defaults, or at the least that its ranges allow
        run("convert-ndf", c["name"] + ":" + ",".join("%s=%r" % (n["name"], n["default"]) for n in c["numbers"]),
            "--to", "map", status=0)


def moments():
    said = run("convert-ndf", "moments:mean_x=0.1,xx=0.03,xy=0.01,yy=0.05", "--as", "student_t:gamma=4",
               "--to", "roughness", "--to", "moments", "--digits", "15", status=0).stdout.split("\n")
    m = words(said[1])
    check(near(m["xx"], 0.03, 1e-12) and near(m["xy"], 0.01, 1e-12) and near(m["yy"], 0.05, 1e-12), said[1])
    r = words(said[0])
    # (gamma - 1)/(2 (gamma - 2)) = 3/4 of alpha^2 is the variance; the trace does not turn
    check(near(0.75 * (r["alpha_x"] ** 2 + r["alpha_y"] ** 2), 0.03 - 0.01 + 0.05, 1e-12), said[0])
    b = words(run("convert-ndf", "moments:xx=0.02,yy=0.02", "--to", "roughness", status=0).stdout)
    check(near(b["alpha_x"], 0.2, 1e-8), "beckmann unless said otherwise")


def nearest():
    said = run("convert-ndf", "ggx:alpha=0.3", "--to", "student_t", status=0).stdout.split("\n")
    check(said[0] == "student_t:alpha=0.3,gamma=2", said[0])
    check("theta" in said[1] and "*" in said[1] and "peak 1" in said[1], said[1])
    done = run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann", "--norm", "l1_cos", "--json", status=0)
    (b,) = json.loads(done.stdout)
    check(b["error"] == b["errors"]["l1_cos"] and b["norm"] == "l1_cos", done.stdout)
    for norm in b["errors"]:
        (other,) = json.loads(run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann", "--norm", norm, "--json",
                                  status=0).stdout)
        check(other["errors"]["l1_cos"] >= b["error"] * (1 - 1e-9), norm)
        if norm == "peak":
            check(near(other["peak"], 1, 1e-12), "peak")
    run("convert-ndf", "ggx:alpha=0.3", "--to", b["spec"], "--to", "moments", status=2)    # ggx has none
    # axes and mean slope stay
    spec = run("convert-ndf", "ggx:alpha_x=0.4,alpha_y=0.1,rotation=0.5,mean_x=0.3", "--to", "beckmann",
               status=0).stdout.split("\n")[0]
    r = words(spec)
    check(near(r["alpha_x"] / r["alpha_y"], 4, 1e-7) and near(r["rotation"], 0.5, 1e-8)
          and r["mean_x"] == 0.3, spec)
    # what is given is held
    held = run("convert-ndf", "beckmann:alpha=0.2", "--to", "student_t:gamma=4,alpha=0.21", status=0).stdout
    check(held.startswith("student_t:alpha=0.21,gamma=4\n"), held)
    if known("abc"):
        spec = run("convert-ndf", "ggx:alpha=0.3", "--to", "abc:gamma=1.75", "--norm", "peak", status=0).stdout
        check(near(words(spec.split("\n")[0])["alpha"], 23.44425, 1e-6), spec)


def notebook():
    groups = json.loads(run("convert-ndf", "--table", "--json", status=0).stdout)
    rows = [f for g in groups for f in g["fits"]]
    fits = {(f["target"], f["model"]): f for f in rows}
    if all(map(known, ("abc", "gtr", "torrance_sparrow", "phong"))):
        check(len(groups) == 6 and len(rows) == 39, "%d groups, %d rows" % (len(groups), len(rows)))
    for f in rows:
        check(f["nearest_error"] <= f["peak_error"] * (1 + 1e-9), "nearest is nearest: %s" % f)
        if f["printed"] is not None:
            check(abs(f["printed"] / f["peak"] - 1) < 0.06, "by hand: %s" % f)


def refusals():
    run("convert-ndf", status=2, says=["nothing to convert"])
    run("convert-ndf", "gg:alpha=1", status=2, says=["'gg'", "did you mean 'ggx'", "disney", "moments"])
    run("convert-ndf", "ggx:alpha=-1", status=2, says=["alpha = -1", "[1e-05, 100]", "byte 10"])
    run("convert-ndf", "disney:roughness=2", status=2, says=["roughness = 2", "(0, 1]"])
    run("convert-ndf", "disney:rough=0.2", status=2, says=["rough"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "gtlf", status=2, says=["'gtlf'", "'gltf'"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "moments", status=2, says=["--to moments", "infinite"])
    run("convert-ndf", "ggx:alpha_x=0.5,alpha_y=0.01", "--to", "disney", status=2, says=["anisotropic", "[0, 1]"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "student_t:gamma=1", status=2, says=["gamma = 1", "(1.5, inf]"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann:alpha=0", status=2, says=["alpha = 0", "[1e-05, 100]"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann:mean_x=1", status=2, says=["mean_x", "axes"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann", "--norm", "l3", status=2, says=["'l3'", "theta", "peak"])
    run("convert-ndf", "ggx:alpha=0.3", "--to", "beckmann:alpha=0.3", "--norm", "peak", status=2, says=["free"])
    run("convert-ndf", "ggx:alpha=0.3", "--as", "beckmann", status=2, says=["--as"])
    run("convert-ndf", "moments:xx=1", status=2, says=["xx and yy"])
    run("convert-ndf", "moments:xx=1,yy=1", "--as", "ggx", status=2, says=["ggx", "infinite"])
    run("convert-ndf", "moments:xx=1,yy=1,xy=2", status=2, says=["positive definite"])
    run("convert-ndf", "--table", "--conventions", status=2, says=["only one"])
    run("convert-ndf", "ggx:alpha=0.3", "--table", status=2, says=["only one"])
    run("convert-ndf", "--table", "--to", "map", status=2, says=["--to"])
    run("convert-ndf", "ggx:alpha=0.3", "--digits", "18", status=2, says=["digits", "17"])
    if known("abc"):
        run("convert-ndf", "abc:alpha=20", "--to", "disney", status=2, says=["nearest"])


run_sections([representations, conventions, moments, nearest, notebook, refusals])
