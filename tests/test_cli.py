#!/usr/bin/env python3
"""The command's words and numbers: help, refusals, list, eval and sample."""
import csv
import json
import math
import os
import random
import struct
import subprocess

from cli import COMMAND, GOLD, SOURCE, check, near, rows, run, run_sections


def direction(rng, low=0.0):
    z, phi = low + (1 - low) * rng.random(), 2 * math.pi * rng.random()
    r = math.sqrt(1 - z * z)
    return (r * math.cos(phi), r * math.sin(phi), z)


# ---------------------------------------------------------------- help

def commands():
    text = run("--help", status=0).stdout
    return [line.split()[0] for line in text.splitlines()
            if line.startswith("  ") and not line.startswith("   ") and ":" not in line.split()[0]]


def help_texts():
    names = commands()
    check({"list", "eval", "sample", "plot", "render", "convert", "check"} <= set(names),
          "subcommands in the help: %s" % names)
    for name in names:
        asked, option = run("help", name, status=0).stdout, run(name, "--help", status=0).stdout
        check(asked == option and asked.startswith("usage: asperity " + name), name + ": help")
        check(max(len(line) for line in asked.splitlines()) <= 80, name + ": help is too wide")
        # every long option that the help shows is taken, and no other
        for line in asked.splitlines():
            if line.startswith("  -") and "--" in line:
                word = line.split("--")[1].split()[0]
                done = run(name, "--%s=" % word)
                check("unknown option" not in done.stderr, "%s --%s is in the help only"
                      % (name, word))
        run(name, "--nonesuch", status=2, says=["'nonesuch'", "known: "])
    check(run("--version", status=0).stdout.startswith("asperity 0."), "version")
    run("--version", "x", status=2, says=["'x'"])
    check(subprocess.run([COMMAND], capture_output=True).returncode == 2, "no subcommand")
    page = os.path.join(SOURCE, "docs", "commands.md")
    now = run("help", "--markdown", status=0).stdout
    with open(page, encoding="utf-8") as file:
        check(file.read() == now,
              "docs/commands.md is stale: asperity help --markdown > docs/commands.md")


def usage_errors():
    run("evla", status=2, says=["'evla'", "did you mean 'eval'?", "known: list"])
    run("zzz", status=2, says=["'zzz'", "known: list"])
    run("help", "zzz", status=2, says=["'zzz'", "known: list"])
    run("eval", status=2, says=["QUANTITY"])
    run("eval", "d", "--ndf", "ggx", status=2, says=["'d'", "pdf_visible"])
    run("eval", "D", "a", "b", "--ndf", "ggx", status=2, says=["'b'"])
    run("eval", "D", status=2, says=["--ndf"])
    run("eval", "D", "--ndf", "ggx", "--material", GOLD, status=2, says=["--ndf", "--material"])
    run("eval", "D", "--ndf", "ggx", "--ndf", "ggx", status=2, says=["twice"])
    run("eval", "D", "--ndf", status=2, says=["--ndf", "SPEC"])
    run("eval", "D", "--ndf", "gxx:alpha=1", status=2, says=["gxx", "'ggx'", "known:"])
    run("eval", "D", "--ndf", "nothing", status=2, says=["nothing", "known: ggx"])
    run("eval", "D", "--ndf", "ggx:alpha=0", status=2, says=["alpha = 0", "[1e-05, 100]"])
    run("eval", "D", "--ndf", "ggx:alpha=nan", status=2, says=["alpha"])
    run("eval", "D", "--ndf", "ggx:alpha=1e999", status=2, says=["alpha"])
    run("eval", "D", "--ndf", "ggx:alpha=,", status=2, says=["alpha"])
    run("eval", "D", "--ndf", "ggx:alhpa=1", status=2, says=["alhpa", "alpha"])
    run("eval", "D", "--ndf", "ggx:alpha=(1", status=2)
    run("eval", "D", "--ndf", "", status=2, says=["--ndf"])
    run("eval", "D", "--ndf", "student_t:alpha=0.3,gamma=1.5", status=2,
        says=["gamma = 1.5", "(1.5, inf]"])
    run("eval", "D", "--ndf", "ellipsoid:alpha=0.2,theta_x=1.5708", status=2,
        says=["1.5708 is", ", 1.570796]"])
    run("eval", "D", "--ndf", "ggx", "--mask", "vcavity", status=2, says=["vcavity", "v_cavity"])
    run("eval", "D", "--ndf", "ggx", "--precision", "f16", status=2, says=["'f16'", "f64|f32"])
    run("eval", "brdf", "--material", "conducter:metal=Au", status=2,
        says=["conducter", "did you mean 'conductor'?"])
    run("eval", "brdf", "--material", "conductor:metal=Xy,ndf=(ggx:alpha=0.1)", status=2,
        says=["Xy"])
    run("eval", "brdf", "--material", "conductor:metal=Au,ndf=(ggy:alpha=0.1)", status=2,
        says=["ggy", "did you mean 'ggx'?"])
    for count in ("0", "-1", "1.5", "many", "1e13", "nan", "0x10", ""):
        run("sample", "normal", "--ndf", "ggx", "-n", count, status=2,
            says=["--count", "[1, 1000000000000]"])
    run("sample", "things", "--ndf", "ggx", status=2, says=["'things'", "visible"])
    run("sample", "brdf", "--ndf", "ggx", status=2, says=["--wi"])
    for wi in ("0,0,0", "1", "1,2,3,4", "a,b", "190,0", "0,0,nan", ""):
        run("sample", "brdf", "--ndf", "ggx", "--wi", wi, status=2, says=["--wi"])
    run("sample", "brdf", "--ndf", "ggx", "--wi", "0.6,0,-0.8", status=2, says=["-0.8", "(0, 1]"])
    run("sample", "visible", "--ndf", "ggx", "--wi", "0,0,-1", status=2, says=["no facet"])
    run("plot", "D", status=2, says=["--output"])
    run("plot", "D", "-o", "x.svg", status=2, says=["--ndf"])
    run("plot", "E", "--ndf", "ggx", "-o", "x.svg", status=2, says=["'E'", "polar"])
    run("plot", "brdf", "--ndf", "ggx", "-i", "30,95", "-o", "x.svg", status=2,
        says=["95", "[0, 90)"])
    run("plot", "--ndf", "ggx", "--csv", "-o", "x.csv", status=2)
    for name in ("x.png", "x", "x.svg.pdf"):
        run("plot", "--ndf", "ggx", "-o", name, status=2, says=[name, ".svg"])
    run("render", "--ndf", "ggx", "-o", "x.png", "--float", status=2, says=["x.png", ".exr"])
    for name in ("a,b", "a;b", "a\tb", 'a"b', "a\nb", "a\rb", "a" * 101):
        run("eval", "D", "--ndf", "ggx", "--as", name, stdin="mx,my,mz\n0,0,1\n", status=2,
            says=["--as"])
    for words in (["eval", "D", "--ndf"], ["check"]):
        run(*words, "conductor:metal=Au", status=2,
            says=["'conductor'", "scattering model", "--material", "ggx", "student_t"])
        run(*words, "nothing", status=2, says=["'nothing'", "known: ggx"])
    run("render", "--ndf", "ggx", status=2, says=["--output"])
    run("render", "--ndf", "ggx", "-o", "x.gif", status=2, says=["x.gif", ".png, .exr or .pfm"])
    run("render", "--ndf", "ggx", "-o", "x.png", "--size", "0", status=2,
        says=["--size", "[1, 16384]"])
    run("render", "--ndf", "ggx", "-o", "x.png", "--env", "moon", status=2,
        says=["'moon'", "studio|furnace"])
    run("convert", "x.binary", status=2)
    run("convert", "a.binary", "b.txt", status=2, says=["b.txt", ".csv"])
    run("check", "ggx:alpha=-1", status=2, says=["alpha = -1", "[1e-05, 100]"])
    run("check", "--law", "gravity", status=2, says=["'gravity'", "known: "])
    run("check", "--model", "ggy", status=2, says=["'ggy'", "'ggx'"])
    run("list", "metal", status=2, says=["'metal'", "'metals'"])
    check(not [n for n in os.listdir(".") if n.startswith("x.")], "a refused command wrote a file")


# ---------------------------------------------------------------- list

def accepted(spec):
    done = run("eval", "D", "--ndf", spec, stdin="mx,my,mz\n")
    return done.returncode == 0, done.stderr


def list_ranges():
    """The ranges that `list` shows are the parser's: both ends, and the next number outside."""
    tree = json.loads(run("list", "--json", status=0).stdout)
    check(set(tree) >= {"distributions", "materials", "metals", "masks", "formats", "losses"},
          "sections of list: %s" % list(tree))
    maps = {"slope": tree["slope_map"], "ellipsoid": tree["ellipsoid_map"]}
    for model in tree["distributions"]:
        for name in [model["name"]] + ([model["also"]] if model["also"] else []):
            check(accepted(name)[0], "%s: defaults are refused" % name)
        # a range that cannot be reached because the product of two limits is refused is a mistake
        own = {p["name"] for p in model["parameters"]}      # hides the map's key of that name
        for p in [p for p in maps[model["map"]] if p["name"] not in own] + model["parameters"]:
            key = p["name"]
            for end, outwards in (("low", -math.inf), ("high", math.inf)):
                value, refused = float(p[end]), p[end + "_refused"]
                other = {"alpha_x": ",alpha_y=0.5", "alpha_y": ",alpha_x=0.5"}.get(key, "")
                # an Ellipsoid tilted by a right angle has no finite mean slope
                tilted = key in ("theta_x", "theta_y")
                good, error = accepted("%s:%s=%r%s" % (model["name"], key, value, other))
                if not tilted:
                    check(good != refused, "%s: %s=%r: %s" % (model["name"], key, value, error))
                if math.isinf(value):
                    continue
                outside = math.nextafter(value, outwards) if not refused else value
                good, error = accepted("%s:%s=%r%s" % (model["name"], key, outside, other))
                check(not good and key.split("_")[0] in error,
                      "%s: %s=%r is taken: %s" % (model["name"], key, outside, error))
    for metal in tree["metals"]:
        run("eval", "brdf", "--material", "conductor:metal=%s,ndf=(ggx:alpha=0.3)" % metal["name"],
            stdin="wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n", status=0)
    for mask in tree["masks"]:
        for name in [mask["name"]] + ([mask["also"]] if mask["also"] else []):
            run("eval", "G1", "--ndf", "ggx", "--mask", name, stdin="wx,wy,wz\n", status=0)
    text = run("list", status=0).stdout
    for section_items in tree.values():
        check(all(item["name"] in text for item in section_items), "list and list --json differ")
    one = json.loads(run("list", "metals", "--json", status=0).stdout)
    check(list(one) == ["metals"], "one section")


# ---------------------------------------------------------------- eval

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def ggx(alpha):
    """GGX with height-correlated masking from its textbook formulas (Walter et al. 2007)."""
    def d(m):
        if m[2] <= 0:
            return 0.0
        t2 = (m[0] ** 2 + m[1] ** 2) / (m[2] ** 2 * alpha ** 2)
        return 1 / (math.pi * alpha ** 2 * m[2] ** 4 * (1 + t2) ** 2)

    def lam(w):
        t2 = alpha ** 2 * (w[0] ** 2 + w[1] ** 2) / w[2] ** 2
        return 0.5 * t2 / (1 + math.sqrt(1 + t2))      # (sqrt(1 + t2) - 1)/2 without cancellation

    def sigma(w):
        z = w[2]
        return 0.5 * (z + math.sqrt(z * z + alpha ** 2 * (w[0] ** 2 + w[1] ** 2)))

    def f(wi, wo):
        h = [a + b for a, b in zip(wi, wo)]
        n = math.sqrt(dot(h, h))
        return d([x / n for x in h]) / (4 * wi[2] * wo[2] * (1 + lam(wi) + lam(wo)))
    return d, lam, sigma, f


def eval_values():
    rng, alpha = random.Random(7), 0.35
    d, lam, sigma, f = ggx(alpha)
    names = "mx my mz wx wy wz wi_x wi_y wi_z wo_x wo_y wo_z".split()
    points, text = [], "# a comment\nid;" + ";".join(names) + ";note\n"
    for i in range(3000):
        wi, wo = direction(rng, 1e-3), direction(rng, 1e-3)
        m, w = direction(rng), direction(rng, -1 if i % 3 == 0 else 1e-3)
        points.append((m, w, wi, wo))
        text += "%d;%s;\"a;b\"\n" % (i, ";".join(repr(x) for x in m + w + wi + wo))
        text += "\n" if i % 1000 == 1 else ""
    expected = {
        "D": lambda m, w, wi, wo: d(m),
        "P22": lambda m, w, wi, wo: d(m) * m[2] ** 4,
        "sigma": lambda m, w, wi, wo: sigma(w) if w[2] > 0 else sigma([-x for x in w]) + w[2],
        "lambda": lambda m, w, wi, wo: lam(w) if w[2] > 0 else None,
        "G1": lambda m, w, wi, wo: 1 / (1 + lam(w)) if w[2] > 0 else 0.0,
        "G2": lambda m, w, wi, wo: 1 / (1 + lam(wi) + lam(wo))
        if dot(wi, m) > 0 and dot(wo, m) > 0 else 0.0,
        "pdf_normal": lambda m, w, wi, wo: d(m) * m[2],
        "pdf_visible": lambda m, w, wi, wo: max(0, dot(wi, m)) * d(m) / sigma(wi),
        "brdf": lambda m, w, wi, wo: f(wi, wo),
        "brdf_cos": lambda m, w, wi, wo: f(wi, wo) * wo[2],
        "pdf_brdf": lambda m, w, wi, wo: f(wi, wo) * wo[2] * (1 + lam(wi) + lam(wo))
        / (1 + lam(wi)) * 1.0,
    }
    for quantity, formula in expected.items():
        column = quantity + ("_g" if quantity in ("brdf", "brdf_cos") else "")
        for precision, tolerance in (("f64", 2e-12), ("f32", 2e-3)):
            done = run("eval", quantity, "--ndf", "ggx:alpha=%r" % alpha, "--precision", precision,
                       stdin=text, status=0)
            lines = done.stdout.splitlines()
            check(lines[0] == "# a comment" and "" in lines, quantity + ": lines set aside")
            kept = [a for a, b in zip(text.splitlines(), lines) if b[:len(a)] != a]
            check(not kept, "%s: rows changed: %s" % (quantity, kept[:1]))
            got = list(csv.DictReader((x for x in lines if x and x[0] != "#"), delimiter=";"))
            check(len(got) == len(points), quantity + ": number of rows")
            worst = 0
            for row, point in zip(got, points):
                value, want = float(row[column]), formula(*point)
                if want is None:
                    continue
                if want < 1e-4 and quantity == "sigma":      # cancels in the formula used here
                    check(abs(value - want) < 1e-6, "sigma below the horizon")
                elif not near(value, want, tolerance):
                    worst = max(worst, abs(value - want) / max(abs(want), 1e-300))
                if precision == "f32":
                    exact = struct.unpack("f", struct.pack("f", value))[0]
                    check(abs(exact - value) <= 1e-8 * abs(value), quantity + ": is no float32")
            check(worst == 0, "%s in %s: relative error %g" % (quantity, precision, worst))


def eval_read_back():
    """What eval wrote, read again, gives the same digits: 17 (9) of them are enough."""
    made = run("sample", "brdf", "--material", GOLD, "--wi", "50,20", "-n", "500", status=0).stdout
    once = run("eval", "brdf", "--material", GOLD, stdin=made, status=0).stdout
    again = run("eval", "brdf", "--as", "f", "--material", GOLD, stdin=once, status=0).stdout
    for row in rows(again):
        check(row["brdf_r"] == row["f_r"], "17 digits: %s %s" % (row["brdf_r"], row["f_r"]))
        check("%.17g" % float(row["f_r"]) == row["f_r"], "not in 17 digits: " + row["f_r"])
    check(any(float("%.16g" % float(row["f_r"])) != float(row["f_r"]) for row in rows(again)),
          "17 digits are never needed")
    run("eval", "brdf", "--material", GOLD, stdin=once, status=1, says=["'brdf_r'", "--as"])
    px = "px,py\n0.1,0.2\n1e300,0\n"
    values = rows(run("eval", "P22", "--ndf", "ggx:alpha=0.5", stdin=px, status=0).stdout)
    t2 = 0.05 / 0.25
    check(near(float(values[0]["P22"]), 1 / (math.pi * 0.25 * (1 + t2) ** 2), 1e-14), "P22 of slopes")
    check(float(values[1]["P22"]) == 0, "P22 of a steep slope")
    crlf = run("eval", "D", "--ndf", "ggx", stdin="\ufeffmx\t my\tmz\r\n0\t0\t 1 \r\n", status=0)
    check(len(crlf.stdout.splitlines()) == 2, "byte order mark, tabs, CR LF")
    check(crlf.stdout.startswith("mx\t"), "the byte order mark is copied: %r" % crlf.stdout[:8])
    aside = run("eval", "D", "--ndf", "ggx", stdin="\ufeff# a\nmx,my,mz\n0,0,1\n", status=0)
    check(aside.stdout.startswith("# a\n"), "a comment behind a byte order mark")


def eval_bad_rows():
    def bad(text, *says, quantity="D"):
        with open("bad.csv", "w", encoding="utf-8") as file:
            file.write(text)
        run("eval", quantity, "--ndf", "ggx", "bad.csv", "-o", "out.csv", status=1,
            says=("bad.csv",) + says)
        check(sorted(os.listdir(".")) == ["bad.csv"], "left behind: %s" % os.listdir("."))
        os.remove("bad.csv")
    bad("", "header")
    bad("# only a comment\n", "header")
    bad("mx,my\n0,0\n", "line 1", "'mz'")
    bad("mx,my,mx\n0,0,0\n", "line 1", "'mx'", "twice")
    bad("mx,my,mz\n0,0,1\n0,0\n", "line 3", "2 cells", "3")
    bad("mx,my,mz\n0,0,1,5\n", "line 2", "4 cells")
    bad("mx,my,mz\n0,zero,1\n", "line 2", "'my'", "'zero'")
    bad("mx,my,mz\n0,0,nan\n", "line 2", "'mz'", "'nan'", "finite")
    bad("mx,my,mz\n0,0,1\n\n0,0,inf\n", "line 4", "'inf'")
    bad("mx,my,mz\n0,,1\n", "line 2", "'my'", "''")
    bad("mx,my,mz\n0,0,0x1\n", "'0x1'")
    bad("mx,my,mz\n0,0,1.00001\n", "line 2", "1.00001", "1e-06")
    bad("mx,my,mz\n0,0,0\n", "line 2", "length 0")
    bad("wx,wy,wz\n0,0,1\n", "'mx'")
    bad("mx,my,mz\n0,0,1\n", "'wi_x'", quantity="pdf_visible")
    bad("mx,my,mz\n" + "0,0,1\n" * 5000 + "0,0,2\n", "line 5002", "length 2")
    bad("a,b\n1,2\n", "'px'", "mx", quantity="P22")
    bad("mx,my,mz\n0,\x000,1\n", "line 2", "zero byte")
    bad("mx;my;mz\n0,5;0;1\n", "'0,5'")
    run("eval", "D", "--ndf", "ggx", "none.csv", status=1, says=["none.csv"])
    run("eval", "D", "--ndf", "ggx", ".", status=1, says=[".: cannot read: Is a directory"])
    wide = "px,py\n0,0\n0,-1e39\n"
    run("eval", "P22", "--ndf", "ggx", "--precision", "f32", stdin=wide, status=1,
        says=["line 3", "'py'", "-1e+39", "3.40282347e+38]", "float32"])
    run("eval", "P22", "--ndf", "ggx", stdin=wide, status=0)
    steep = run("eval", "P22", "--ndf", "ggx", "--precision", "f32",
                stdin="mx,my,mz\n1,0,1e-60\n", status=0)
    check(float(rows(steep.stdout)[0]["P22"]) == 0, "P22 of a slope beyond float32")
    f32 = run("eval", "D", "--ndf", "ggx", "--precision", "f32", stdin="mx,my,mz\n0,0,1.00001\n")
    check(f32.returncode == 0, "the tolerance of f32")
    low = rows(run("eval", "D", "--ndf", "ggx", stdin="mx,my,mz\n0.6,0,-0.8\n", status=0).stdout)
    check(float(low[0]["D"]) == 0, "below the horizon is legal and 0")


def eval_forms():
    """Masking by the formulas of the Student-t paper; at gamma = 2 all of them are GGX's."""
    text = "wx,wy,wz\n0.6,0,0.8\n0,0.8,0.6\n0.6,-0.64,0.48\n0,0,1\n1,0,0\n0.6,0,-0.8\n"
    ndf = "student_t:alpha_x=0.5,alpha_y=0.2,rotation=0.3,gamma=%g"
    for gamma, forms in ((2, {"exact": 1e-12, "hypergeometric": 1e-12, "integer": 1e-13,
                              "rational": 0.008}),
                         (3.5, {"half_integer": 1e-11, "hypergeometric": 1e-11, "rational": 0.008})):
        for quantity in ("lambda", "G1"):
            want = rows(run("eval", quantity, "--ndf", ndf % gamma, stdin=text, status=0).stdout)
            for form, tolerance in forms.items():
                got = rows(run("eval", quantity, "--ndf", ndf % gamma, "--form", form, stdin=text,
                               status=0).stdout)
                for a, b in zip(got, want):
                    x, y = float(a[quantity]), float(b[quantity])
                    if quantity == "lambda":
                        x, y = 1 / (1 + x), 1 / (1 + y)
                    check(abs(x - y) <= tolerance, "%s by %s: %g, not %g" % (quantity, form, x, y))
    for words, says in ((("D", "--ndf", ndf % 2, "--form", "exact"), "lambda and G1"),
                        (("G1", "--ndf", "ggx", "--form", "exact"), "student_t"),
                        (("G1", "--ndf", ndf % 2 + ",mean_x=0.1", "--form", "exact"), "mean slope"),
                        (("G1", "--ndf", ndf % 2.25, "--form", "integer"), "gamma"),
                        (("G1", "--ndf", ndf % 2, "--form", "half_integer"), "[2.5, 499.5]"),
                        (("G1", "--ndf", ndf % 2, "--form", "fast"), "hypergeometric"),
                        (("G1", "--ndf", ndf % 2, "--form", "exact", "--mask", "wall"), "--mask")):
        run("eval", *words, stdin=text, status=2, says=["--form", says])


def eval_memory():
    def peak(count):
        read, write = os.pipe()
        process = subprocess.Popen([COMMAND, "eval", "D", "--ndf", "ggx"], stdin=read,
                                   stdout=subprocess.DEVNULL)
        os.close(read)
        with os.fdopen(write, "w") as file:
            file.write("mx,my,mz\n")
            for _ in range(count // 1000):
                file.write("0.6,0,0.8\n" * 1000)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        check(status == 0, "eval over a pipe")
        return usage.ru_maxrss
    small, large = peak(10000), peak(500000)
    check(large < small + 3000, "memory grows with the file: %d KB, %d KB" % (small, large))


# ---------------------------------------------------------------- sample

def sample_lengths():
    """--wi of any length, however small or large, is the same direction."""
    one = run("sample", "brdf", "--ndf", "ggx", "--wi", "1,0,1", "-n", "3", status=0).stdout
    for wi in ("5e-324,0,5e-324", "1e308,0,1e308", "1e-200,0,1e-200"):
        check(run("sample", "brdf", "--ndf", "ggx", "--wi", wi, "-n", "3").stdout == one,
              "--wi %s is not 1,0,1" % wi)


def samplers():
    """Visible normals by other samplers: the same law, by the mean of the slope along x."""
    for spec in ("ggx:alpha=0.4,mean_x=0.1", "ellipsoid:alpha_x=0.3,alpha_y=0.2,theta_x=0.2"):
        mean = {}
        for sampler in ("default", "walter", "rejection"):
            for precision in ("f64", "f32"):
                words = ["sample", "visible", "--ndf", spec, "--wi", "70,30", "--precision", precision,
                         "--sampler", sampler]
                long = run(*words, "-n", "4000", status=0).stdout
                check(long.startswith(run(*words, "-n", "1100", status=0).stdout),
                      sampler + ": a longer run begins differently")
                drawn = rows(long)
                mean[sampler] = sum(float(row["mx"]) for row in drawn) / len(drawn)
                seen = rows(run("eval", "pdf_visible", "--ndf", spec, "--precision", precision, stdin=long,
                                status=0).stdout)
                tolerance = 1e-12 if precision == "f64" else 1e-3
                check(all(near(float(row["pdf"]), float(row["pdf_visible"]), tolerance) for row in seen),
                      sampler + ": pdf")
                check(len(set(row["mx"] for row in drawn)) > 3900, sampler + ": normals repeat")
                check(abs(mean[sampler] - mean["default"]) < 0.02, "%s: mean %r" % (sampler, mean))
    run("sample", "visible", "--ndf", "beckmann", "--wi", "0,0", "--sampler", "walter", status=2,
        says=["walter", "beckmann"])
    run("sample", "normal", "--ndf", "ggx", "--sampler", "walter", status=2, says=["--sampler"])
    run("sample", "visible", "--ndf", "ggx", "--wi", "0,0", "--sampler", "smith", status=2,
        says=["--sampler", "rejection"])


def samples():
    for what, wi in (("normal", None), ("visible", "60,30"), ("brdf", "60,30")):
        for precision in ("f64", "f32"):
            words = ["sample", what, "--ndf", "ggx:alpha=0.4", "--precision", precision]
            words += ["--wi", wi] if wi else []
            long, short = run(*words, "-n", "2500", status=0), run(*words, "-n", "1100", status=0)
            check(long.stdout.startswith(short.stdout), what + ": a longer run begins differently")
            check(long.stdout == run(*words, "-n", "2500").stdout, what + ": not deterministic")
            other = run(*words, "-n", "2500", "--seed", "2", status=0)
            check(other.stdout.splitlines()[1:] != long.stdout.splitlines()[1:], what + ": seed")
            drawn = rows(long.stdout)
            u1, u2 = ([float(row[u]) for row in drawn] for u in ("u1", "u2"))
            check(all(0 <= u < 1 for u in u1 + u2), what + ": u in [0, 1)")
            if precision == "f64":
                check(all((u * 2.0 ** 53).is_integer() for u in u1 + u2), what + ": digits of u")
            check(len(set(u1 + u2)) > 4990, what + ": a number comes twice")
            for u in (u1, u2):
                check(abs(sum(u) / len(u) - 0.5) < 4 / math.sqrt(12 * len(u)), what + ": mean of u")
            pdf = {"normal": "pdf_normal", "visible": "pdf_visible", "brdf": "pdf_brdf"}[what]
            seen = rows(run("eval", pdf, "--ndf", "ggx:alpha=0.4", "--precision", precision,
                            stdin=long.stdout, status=0).stdout)
            tolerance = 1e-12 if precision == "f64" else 1e-3
            check(all(near(float(row["pdf"]), float(row[pdf]), tolerance) for row in seen),
                  "%s in %s: pdf" % (what, precision))
            if what != "brdf":
                continue
            full = rows(run("eval", "brdf_cos", "--ndf", "ggx:alpha=0.4", "--precision", precision,
                            stdin=long.stdout, status=0).stdout)
            check(all(near(float(row["weight_g"]) * float(row["pdf"]), float(row["brdf_cos_g"]),
                           tolerance) for row in full), "weight is not f cos / pdf, " + precision)
            mean = sum(float(row["weight_g"]) for row in full) / len(full)
            check(0.7 < mean < 1, "albedo of mirror facets: %g" % mean)


run_sections([help_texts, usage_errors, list_ranges, eval_values, eval_read_back, eval_bad_rows,
              eval_forms, eval_memory, sample_lengths, samplers, samples])
