#!/usr/bin/env python3
"""The command on scattering models: energy, walks, dielectrics from both sides, pictures of them."""
import cmath
import math
import json
import os
import pty
import struct
import subprocess

from cli import COMMAND, check, near, rows, run, run_sections

# Light kept by single scattering of mirror facets, percent, at roughness 0.1 ... 1 (computed with 12 digits
# outside this library): separable and height-correlated masking.
KEPT = {
    1.65: ([86.75, 72.64, 60.30, 49.93, 41.34, 34.30, 28.54, 23.84, 20.00, 16.85],
           [87.24, 73.97, 62.47, 52.85, 44.89, 38.34, 32.95, 28.49, 24.80, 21.73]),
    2: ([97.16, 91.39, 84.28, 76.62, 68.94, 61.56, 54.67, 48.37, 42.71, 37.66],
        [97.20, 91.58, 84.69, 77.33, 70.02, 63.06, 56.63, 50.79, 45.56, 40.91]),
    4: ([99.29, 97.26, 94.12, 90.08, 85.35, 80.13, 74.61, 68.97, 63.37, 57.93],
        [99.30, 97.30, 94.19, 90.21, 85.56, 80.46, 75.11, 69.69, 64.37, 59.27]),
    50: ([99.51, 98.08, 95.78, 92.73, 89.04, 84.83, 80.23, 75.34, 70.29, 65.20],
         [99.52, 98.10, 95.82, 92.80, 89.16, 85.02, 80.50, 75.73, 70.85, 65.98]),
}
GLASS = "dielectric:eta=1.5,ndf=(ggx:alpha=0.3)"
MODELS = ["conductor:metal=Cu,ndf=(ggx:alpha=0.4)", "lambert_specular:ndf=(ggx:alpha=0.4)", GLASS,
          "dielectric:eta=1.5,thin=1,ndf=(ggx:alpha=0.3)", "rough_diffuse:albedo=0.6,ndf=(ggx:alpha=0.4)",
          "rough_diffuse:form=oren_nayar,ndf=(ggx:alpha=0.4)",
          "rough_diffuse:form=eon,albedo=0.7/0.4/0.1,ndf=(ggx:alpha=0.8)", "plastic:albedo=0.5/0.2/0.1,ndf=(ggx:alpha=0.3)",
          "compensated:metal=Au,ndf=(beckmann:alpha=0.5)", "compensated:form=turquin,ndf=(ggx:alpha=0.5)",
          "compensated_dielectric:eta=1.5,ndf=(ggx:alpha=0.6)",
          "compensated_dielectric:form=turquin,eta=0.7,thin=0,ndf=(beckmann:alpha=0.6)",
          "conductor:metal=Al,film=300,film_eta=1.5,ndf=(ggx:alpha=0.3)",
          "dielectric:eta=1.5,film=400,film_eta=2,ndf=(ggx:alpha=0.3)"]


def energy_values():
    for gamma, columns in KEPT.items():
        for mask, percent in zip(("uncorrelated", "correlated"), columns):
            got = rows(run("energy", "student_t:alpha={},gamma=%g" % gamma, "--over", "0.1:1:10", "--mask", mask,
                           "-n", "65536", status=0).stdout)
            check(len(got) == 10, "rows of energy")
            for row, want in zip(got, percent):
                value, error = float(row["albedo_g"]), float(row["error"])
                # the table's last digit, and what is stated
                check(abs(value - want / 100) < 6 * error + 1e-4 and error < 3e-3,
                      "gamma %g, alpha %s, %s: %g +- %g, not %g" % (gamma, row["value"], mask, value, error,
                                                                   want / 100))
    # over angles: along the normal nothing is masked once; a half mirror gives half
    full = rows(run("energy", "ggx:alpha=0.2", "--angles", "4", status=0).stdout)
    half = rows(run("energy", "conductor:f0=0.5,tint=1,ndf=(ggx:alpha=0.0001)", "--angles", "4", status=0).stdout)
    check([row["theta"] for row in full] == ["0", "30", "60", "89.99"], "angles of energy")
    check(near(float(half[0]["albedo_r"]), 0.5, 1e-4), "a half mirror: %s" % half[0]["albedo_r"])
    grey = 0.5 + 0.5 * (1 - math.cos(math.radians(60))) ** 5
    check(near(float(half[2]["albedo_r"]), grey, 1e-4), "Schlick at 60 degrees: %s" % half[2]["albedo_r"])


def energy_walks():
    for spec in ("ggx:alpha=0.8", "beckmann:alpha=1", "student_t:alpha=0.5,gamma=2.5,mean_x=0.3",
                 "dielectric:transport=importance,ndf=(ggx:alpha=0.6)", "rough_diffuse:albedo=1,ndf=(ggx:alpha=0.5)"):
        for row in rows(run("energy", spec, "--walk", "--angles", "3", "-n", "2000", status=0).stdout):
            check(near(float(row["walk_g"]), 1, 1e-9), "%s at %s: walks return %s" % (spec, row["theta"],
                                                                                     row["walk_g"]))
            check(float(row["albedo_g"]) <= 1 + 1e-9, "single scattering above 1")
    one = rows(run("energy", "conductor:metal=Cu,ndf=(ggx:alpha=0.8)", "--walk", "--angles", "3",
                   status=0).stdout)[0]
    check(float(one["albedo_r"]) + 0.1 < float(one["walk_r"]) < 1, "walks add light: %s" % one)
    check(float(one["walk_r"]) > float(one["walk_g"]) > float(one["walk_b"]), "the light added is coloured")


def energy_refusals():
    def bad(*words, says):
        run("energy", *words, "-o", "out.csv", status=2, says=says)
        run("energy", *words, "-o", "out.svg", status=2, says=says)
    bad("gxx:alpha=0.1", says=["gxx"])
    bad("ggx:alpha=-1", says=["alpha = -1", "[1e-05, 100]"])
    bad("conductor:metal=Xy,ndf=(ggx)", says=["Xy"])
    bad("plastic:albedo=2,ndf=(ggx)", says=["albedo"])
    bad("ggx:alpha=0.3", "--over", "0.1:1:10", says=["--over", "{}"])
    bad("ggx:alpha={}", "--over", "0.1:1", says=["--over", "LOW:HIGH:N"])
    bad("ggx:alpha={}", "--over", "0.1:1:0", says=["--over"])
    bad("ggx:alpha={}", "--over", "a:b:3", says=["--over"])
    bad("ggx:alpha={}", "--over", "0.1:1000:3", says=["alpha = "])
    bad("ggx", "--mask", "none", says=["none"])
    bad("ggx", "--samples", "1", says=["--samples"])
    bad(*["ggx"] * 13, says=["12"])
    check(os.listdir(".") == [], "left behind: %s" % os.listdir("."))
    run("energy", "ggx:alpha=0.4", "--angles", "3", "-o", "no/where.csv", status=1, says=["no/where.csv"])
    run("energy", "ggx:alpha=0.4", "conductor:metal=Au,ndf=(ggx)", "--angles", "3", "-o", "ok.svg", status=0)
    run("energy", "ggx:alpha=0.4", "--angles", "3", "-o", "ok.csv", status=0)
    check(sorted(os.listdir(".")) == ["ok.csv", "ok.svg"], "left behind: %s" % os.listdir("."))


def models():
    """Every model: samples whose density and weight are those that eval gives."""
    for spec in MODELS:
        for wi in ("40,10", "0.5,0.3,-0.8") if "dielectric" in spec else ("40,10",):
            made = run("sample", "brdf", "--material", spec, "--wi", wi, "-n", "300", status=0).stdout
            full = run("eval", "brdf_cos", "--material", spec, stdin=made, status=0).stdout
            full = rows(run("eval", "pdf_brdf", "--material", spec, stdin=full, status=0).stdout)
            seen, below = 0, 0
            for row in full:
                weight, pdf = float(row["weight_g"]), float(row["pdf"])
                seen += weight > 0
                below += weight > 0 and float(row["wo_z"]) * float(row["wi_z"]) < 0
                if weight > 0:
                    check(near(weight * pdf, float(row["brdf_cos_g"]), 1e-9), "%s: weight is not f cos / pdf" % spec)
                    check(near(pdf, float(row["pdf_brdf"]), 1e-9), "%s: pdf" % spec)
            check(seen > 150, "%s from %s: %d samples with weight" % (spec, wi, seen))
            if "dielectric" in spec:
                check(0.2 * seen < below < seen, "%s from %s: %d of %d cross" % (spec, wi, below, seen))
    # f(wo, wi) = f(wi, wo) n_o^2/n_i^2
    there = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,-0.3,0.1,%r\n"
    back = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n-0.3,0.1,%r,0.6,0,0.8\n"
    z = -math.sqrt(0.9)
    f = [float(rows(run("eval", "brdf", "--material", GLASS, stdin=text % z, status=0).stdout)[0]["brdf_g"])
         for text in (there, back)]
    check(f[0] > 0 and near(f[1], f[0] * 2.25, 1e-12), "glass from both sides: %r" % f)
    run("sample", "brdf", "--material", GLASS, "--wi", "1,0,0", status=2, says=["--wi", "surface"])
    for spec in (m for m in MODELS if "dielectric" not in m):
        run("sample", "brdf", "--material", spec, "--wi", "0.6,0,-0.8", status=2, says=["-0.8", "(0, 1]"])


def energy_shares():
    """What crosses is counted as energy, unless the spec asks for radiance."""
    def albedo(spec, *words):
        return [float(row["albedo_g"]) for row in rows(run("energy", spec, "--angles", "2", "-n", "4096", *words,
                                                           status=0).stdout)]
    for spec in ("dielectric:ndf=(ggx:alpha=0.01)", "dielectric:eta=0.5,ndf=(ggx:alpha=0.01)",
                 "dielectric:thin=1,ndf=(ggx:alpha=0.01)", "compensated_dielectric:ndf=(ggx:alpha=0.1)"):
        head, tail = spec.split(":", 1)
        given = albedo("%s:transport=importance,%s" % (head, tail))
        check(albedo(spec) == given and 0.95 < given[0] < 1.01, "%s: %r of energy" % (spec, given))
    radiance = albedo("dielectric:ndf=(ggx:alpha=0.01),transport=radiance")[0]
    check(near(radiance, 0.04 + 0.96 / 2.25, 1e-2), "radiance through glass: %g" % radiance)


def energy_masks():
    """--mask is that of the spec, for tables too."""
    def both(material, ndf, mask, *words):
        spec = "%s,%%sndf=(%s)" % (material, ndf)
        outer = run("energy", spec % "", "--mask", mask, *words, "-n", "8192", status=0).stdout
        other = run("energy", spec % "", *words, "-n", "8192", status=0).stdout
        inner = run("energy", spec % ("mask=%s," % mask), *words, "-n", "8192", status=0).stdout
        got = [[{k: v for k, v in row.items() if k != "spec"} for row in rows(text)] for text in (outer, inner, other)]
        check(got[0] == got[1], "%s: --mask %s: %r, in the spec %r" % (material, mask, got[0], got[1]))
        check(got[0] != got[2], "%s: --mask %s changes nothing" % (material, mask))
        return [float(row["albedo_g"]) for row in got[0]]
    value = both("compensated:f0=1", "ggx:alpha={}", "uncorrelated", "--over", "0.5:2:2")
    check(all(abs(a - 1) < 4e-3 for a in value), "light given back with --mask: %r" % value)
    both("plastic:albedo=1,eta=3", "ggx:alpha=1", "v_cavity", "--angles", "3")
    both("compensated_dielectric:eta=1.5", "ggx:alpha=0.7", "uncorrelated", "--angles", "3")
    # the spec's own mask is overruled as well
    run("energy", "compensated:f0=1,mask=v_cavity,ndf=(ggx:alpha=1)", "--mask", "correlated", "--angles", "2", status=0)


def energy_of_data():
    """Distributions that are data stand where a bare distribution does."""
    table = "tabulated:slopes=0/0.1/0.3/0.6,density=5/4/1/0.2"
    with open("slopes.csv", "w") as file:
        file.write("p_x,p_y,weight\n" + "".join("%g,%g,1\n" % (math.sin(i) * 0.3, math.cos(1.7 * i) * 0.2) for i in range(400)))
    for spec in (table, "histogram:file=slopes.csv,bins=8"):
        bare, inside = (rows(run("energy", text, "--angles", "3", "-n", "1024", status=0).stdout)
                        for text in (spec, "conductor:f0=1,tint=1,ndf=(%s)" % spec))
        check(all(near(float(a["albedo_g"]), float(b["albedo_g"]), 1e-9) for a, b in zip(bare, inside)),
              "%s: bare %r, in a mirror %r" % (spec, bare, inside))
    # a material over a file has the tables of that file
    one = rows(run("energy", "compensated:f0=1,ndf=(histogram:file=slopes.csv,bins=8)", "--over", "0:1:1", "-n", "4096",
                   status=2, says=["{}"]).stdout)
    one = rows(run("energy", "compensated:f0=1,ndf=(histogram:file=slopes.csv,bins=8)", "--angles", "3", "-n", "4096",
                   status=0).stdout)
    check(all(abs(float(row["albedo_g"]) - 1) < 0.05 for row in one), "light given back over a file: %r" % one)
    run("energy", "gxx:alpha=0.1", status=2, says=["unknown distribution or material 'gxx'", "'ggx'"])
    run("energy", "conducter:ndf=(ggx)", status=2, says=["unknown distribution or material", "'conductor'"])


def airy(c, eta, film_eta, film, nm):
    """Unpolarised reflectance of a film on a dielectric from outside."""
    s2 = 1 - c * c
    c1, c2 = math.sqrt(1 - s2 / film_eta ** 2), math.sqrt(1 - s2 / eta ** 2)
    turn = cmath.exp(4j * math.pi * film_eta * film * c1 / nm)
    total = 0
    for top, low in (((c - film_eta * c1) / (c + film_eta * c1), (film_eta * c1 - eta * c2) / (film_eta * c1 + eta * c2)),
                     ((film_eta * c - c1) / (film_eta * c + c1), (eta * c1 - film_eta * c2) / (eta * c1 + film_eta * c2))):
        total += 0.5 * abs((top + low * turn) / (1 + top * low * turn)) ** 2
    return total


def wavelengths():
    pair = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,-0.6,0,0.8\n0,0.28,0.96,0,-0.28,0.96\n0.6,0,0.8,-0.4,0,-0.91651513899116800\n"

    def ask(*words):
        return run("eval", *words, stdin=pair, status=0).stdout

    film = "dielectric:eta=1.5,film=400,film_eta=2,ndf=(ggx:alpha=0.3)"
    bare = rows(ask("brdf", "--material", "dielectric:eta=1.5,ndf=(ggx:alpha=0.3)"))
    got = rows(ask("brdf", "--material", film, "--wavelengths", "400:700:7"))
    check(list(got[0])[6:] == ["brdf_%d" % nm for nm in range(400, 701, 50)], "columns: %s" % list(got[0]))
    for c, there, row in zip((0.8, 0.96, 0.8), bare, got):
        none = airy(c, 1.5, 1.5, 1, 550)
        for nm in range(400, 701, 50):
            share = airy(c, 1.5, 2, 400, nm)
            crosses = float(row["wo_z"]) < 0
            want = float(there["brdf_r"]) * ((1 - share) / (1 - none) if crosses else share / none)
            check(near(float(row["brdf_%d" % nm]), want, 1e-9), "film at %g nm: %s, not %g" % (nm, row, want))
    times = rows(ask("brdf_cos", "--material", film, "--wavelengths", "550.5", "--as", "f"))
    once = rows(ask("brdf", "--material", film, "--wavelengths", "550.5"))
    check(near(float(times[1]["f_550.5"]), 0.96 * float(once[1]["brdf_550.5"]), 1e-15), "times the cosine")
    for listed in ("", ",", "400,", "400,,500", "400:700:0", "400:700:82", "379", "781", "nan", "400;500", "4e2:5e2",
                   ",".join(["500"] * 82)):
        run("eval", "brdf", "--material", film, "--wavelengths", listed, stdin=pair, status=2, says=["wavelengths"])
    for words in (("D", "--ndf", "ggx"), ("brdf", "--material", "plastic:ndf=(ggx)"), ("brdf", "--ndf", "ggx", "--precision", "f32"),
                  ("brdf", "--material", "conductor:eta=0.2/0.3/0.4,k=3,ndf=(ggx)"), ("brdf", "--material", "conductor:f0=0.5,ndf=(ggx)")):
        run("eval", *words, "--wavelengths", "500", stdin=pair, status=2, says=["wavelength"])


def no_walks():
    """What cannot walk is refused before there is any work."""
    for name in ("plastic:ndf=(ggx)", "dielectric:thin=1,ndf=(ggx)", "compensated:f0=1,ndf=(ggx)",
                 "lambert_specular:ndf=(ggx)", "compensated_dielectric:ndf=(ggx)", "rough_diffuse:form=eon,ndf=(ggx)",
                 "rough_diffuse:form=oren_nayar,ndf=(ggx)", "rough_diffuse:form=fujii,ndf=(ggx)"):
        says = ["--walk: " + name.split(":")[0], "conductor", "dielectric (a half space)", "rough_diffuse (exact)"]
        run("energy", name, "--walk", status=2, says=says)
        run("render", "--material", name, "--walk", "--size", "8", "--spp", "1", "-o", "x.png", status=2, says=says)
    check(os.listdir(".") == [], "left behind: %s" % os.listdir("."))
    for name in ("conductor:metal=Cu,ndf=(ggx)", "dielectric:ndf=(ggx)", "rough_diffuse:form=exact,ndf=(ggx)"):
        run("render", "--material", name, "--walk", "--size", "4", "--spp", "1", "-o", "x.pfm", status=0)


def check_materials():
    """`check --material`: laws of the material itself."""
    def laws(spec, *words, status=0):
        done = run("check", "--material", spec, "--json", "--samples", "4000", *words)
        check(done.returncode == status and not done.stderr, "%s: exit status %d" % (spec, done.returncode))
        found = json.loads(done.stdout)
        check(found["holds"] == (status == 0) and len(found["results"]) == 1, spec + ": one result")
        check(found["results"][0]["material"] == spec, spec + ": named")
        return {law["law"]: law for law in found["results"][0]["laws"]}
    always = {"furnace", "float32", "batch", "finite", "nan"}
    for spec in MODELS + ["dielectric:eta=0.7,transport=importance,mask=wall,ndf=(beckmann:alpha=0.3,mean_x=0.2)",
                          "conductor:metal=Au,mask=uncorrelated,ndf=(tabulated:slopes=0/0.1/0.3/0.6,density=5/4/1/0.2)"]:
        if spec.startswith("compensated_dielectric:form=turquin"):
            continue
        want = set(always)
        want |= {"refraction", "sample_materials"} if "dielectric" in spec else {"weight", "sample_bsdf", "weight_histogram"}
        want |= set() if "turquin" in spec else {"reciprocity"} | ({"adjoint"} if "dielectric" in spec else set())
        if spec.split(":")[0] in ("conductor", "dielectric", "rough_diffuse") and "form=" not in spec and "thin" not in spec:
            want.add("walk")
        got = laws(spec)
        check(set(got) == want, "%s: laws %s, not %s" % (spec, sorted(got), sorted(want)))
    # more light than came
    broken = laws("lambert_specular:diffuse=0.9,specular=1,f0=0.9,ndf=(ggx:alpha=0.3)", status=1)
    check([name for name in broken if not broken[name]["holds"]] == ["furnace"], "too bright: %r" % broken)
    one = laws(GLASS, "--law", "adjoint")
    check(list(one) == ["adjoint"] and one["adjoint"]["checks"] > 100, "one law of glass: %r" % one)
    text = run("check", "--material", GLASS, "--law", "walk", "ggx:alpha=0.3", status=0).stdout
    check(GLASS in text and "\nggx:alpha=0.3\n" in text and "all laws hold" in text, "both at once: " + text)
    run("check", "--material", GLASS, "--law", "sigma", status=2, says=["--law sigma", "--material"])
    run("check", "--material", GLASS, "--model", "ggx", status=2, says=["--model", "--material"])
    run("check", "--material", "dielectric:eta=-1,ndf=(ggx)", status=2, says=["--material", "eta = -1"])
    run("check", "--material", "ggx", status=2, says=["--material ggx", "unknown material"])
    run("check", GLASS, status=2, says=["--material"])


def on_terminal(*words):
    """What a terminal on standard error sees."""
    reader, writer = pty.openpty()
    done = subprocess.Popen([COMMAND, *words], stderr=writer, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    os.close(writer)
    seen = b""
    while True:
        try:
            part = os.read(reader, 4096)
        except OSError:
            break
        if not part:
            break
        seen += part
    os.close(reader)
    check(done.wait() == 0, "asperity %s on a terminal" % " ".join(words))
    return seen.decode()


def bars():
    """One bar from 0 to 100 % over all of the work."""
    def percents(seen, label):
        parts = [p for p in seen.split("\r") if p.startswith(label + " [")]
        return [int(p.split("]")[1].split("%")[0]) for p in parts]
    # as much work as takes a second or two anywhere
    seen = percents(on_terminal("energy", *["student_t:alpha=0.3,gamma=%d" % g for g in (2, 3, 4)], "-n", "200000",
                                "--angles", "6"), "energy")
    check(len(seen) > 3 and seen == sorted(seen) and seen[0] < 40, "the bar of energy: %r" % seen)
    made = on_terminal("sample", "brdf", "--ndf", "ggx:alpha=0.3", "--wi", "30,0", "-n", "300000", "-o", "made.csv")
    seen = percents(made, "sample")
    check(len(seen) > 2 and seen == sorted(seen), "the bar of sample: %r" % seen)
    check(made.endswith("\r\033[K"), "the bar of sample stays")
    seen = percents(on_terminal("eval", "brdf_cos", "made.csv", "--ndf", "ggx:alpha=0.3", "-o", "full.csv"), "eval")
    check(len(seen) > 2 and seen == sorted(seen), "the bar of eval: %r" % seen)


def read_pfm(name):
    with open(name, "rb") as file:
        check(file.readline().strip() == b"PF", name + ": no colour PFM")
        width, height = (int(x) for x in file.readline().split())
        file.readline()
        data = file.read()
    return width, struct.unpack("<%df" % (3 * width * height), data)


def middle(name):
    """Mean of green in the middle of a picture, which the sphere fills."""
    width, data = read_pfm(name)
    inside = range(width // 3, 2 * width // 3)
    values = [data[3 * (y * width + x) + 1] for y in inside for x in inside]
    check(all(0 <= v < 1e3 for v in values), name + ": not finite")
    return sum(values) / len(values)


def pictures():
    furnace = ["--env", "furnace", "--size", "24", "--spp", "64"]
    def render(name, *words):
        run("render", *furnace, *words, "-o", name, status=0)
        return middle(name)
    mirror = ["--ndf", "ggx:alpha=0.8"]
    one, all_ = render("one.pfm", *mirror), render("all.pfm", *mirror, "--walk")
    check(one < 0.75, "single scattering in a furnace: %g" % one)
    check(abs(all_ - 1) < 0.02, "walks in a furnace: %g" % all_)
    copper = ["--material", "conductor:metal=Cu,ndf=(ggx:alpha=0.8)"]
    check(render("a.pfm", *copper) < render("b.pfm", *copper, "--walk") - 0.05, "walks are brighter")
    glass = render("c.pfm", "--material", "dielectric:eta=1.5,ndf=(ggx:alpha=0.05)")
    check(0.9 < glass < 1.02, "a glass sphere in a furnace: %g" % glass)
    for i, spec in enumerate(MODELS):
        check(0.02 < render("m%d.pfm" % i, "--material", spec) < 1.02, spec + ": brightness")
    # the picture depends on its description alone
    for threads in ("1", "2"):
        run("render", "--material", GLASS, "--size", "16", "--spp", "8", "--walk", "--threads", threads,
            "-o", threads + ".pfm", status=0)
    with open("1.pfm", "rb") as a, open("2.pfm", "rb") as b:
        check(a.read() == b.read(), "the picture of a walk depends on the threads")


run_sections([energy_values, energy_walks, energy_refusals, energy_shares, energy_masks, energy_of_data, wavelengths, no_walks,
              models, check_materials, bars, pictures])
