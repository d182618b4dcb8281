#!/usr/bin/env python3
"""The command's files: pictures, plots, conversions; signals, full devices, broken input."""
import json
import os
import pty
import resource
import signal
import struct
import subprocess
import time
import xml.etree.ElementTree

from cli import COMMAND, GOLD, check, near, rows, run, run_sections

SHARED = os.environ.get("ASPERITY_SHARED", "../shared")
SHARED = SHARED if os.path.isabs(SHARED) else os.path.join(os.getcwd(), SHARED)


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def nothing_here(what, allowed=()):
    left = sorted(set(os.listdir(".")) - set(allowed))
    check(not left, "%s: left behind: %s" % (what, left))


# ---------------------------------------------------------------- plot

def plots():
    quantities = "D P22 sigma lambda G1 brdf brdf_cos polar".split()
    for quantity in quantities:
        for more in ([], ["--log"]):
            run("plot", quantity, "--ndf", "ggx:alpha=0.3", "--material", GOLD, "-i", "10,60",
                "-o", "one.svg", *more, status=0)
            root = xml.etree.ElementTree.parse("one.svg").getroot()
            check(root.tag.endswith("svg"), quantity + ": not SVG")
            text = contents("one.svg").decode()
            check("ggx:alpha=0.3" in text and "nan" not in text.lower().replace("nano", ""),
                  quantity + ": legend, no NaN")
            check(text.count("<path") >= 3, quantity + ": no curves")
    run("plot", *quantities, "--ndf", "beckmann:alpha=0.3,mean_x=0.2", "--csv", "-o", "all.svg",
        status=0)
    root = xml.etree.ElementTree.parse("all.svg").getroot()
    check(sum(1 for e in root.iter() if e.tag.endswith("svg")) == 1 + len(quantities), "panels")
    check(sorted(os.listdir(".")) == ["all.csv", "all.svg", "one.svg"], "files: %s" % os.listdir("."))
    numbers = rows(contents("all.csv").decode())
    check({row["quantity"] for row in numbers} == set(quantities), "quantities in the CSV")
    again = run("plot", *quantities, "--ndf", "beckmann:alpha=0.3,mean_x=0.2", "-o", "-", status=0)
    check(again.stdout == contents("all.svg").decode(), "standard output, deterministic")


def plot_numbers():
    """The numbers beside a plot are those of eval."""
    import math
    run("plot", "D", "--ndf", "ggx:alpha=0.2", "--phi", "40", "--csv", "-o", "d.svg", status=0)
    drawn = rows(contents("d.csv").decode())
    text = "mx,my,mz\n"
    for row in drawn:
        t, p = math.radians(float(row["theta_deg"])), math.radians(40)
        text += "%r,%r,%r\n" % (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))
    values = rows(run("eval", "D", "--ndf", "ggx:alpha=0.2", stdin=text, status=0).stdout)
    check(len(values) == len(drawn) > 1000, "number of points")
    # the last points lie where cos(theta) itself is a rounding error
    check(all(near(float(a["value"]), float(b["D"]), 1e-9) for a, b in list(zip(drawn, values))[:-1]),
          "the plot's numbers are not eval's")


# ---------------------------------------------------------------- convert

def conversions():
    run("convert", "--material", GOLD, "gold.binary", status=0)
    data = contents("gold.binary")
    check(len(data) == 12 + 8 * 3 * 90 * 90 * 180, "size of a MERL table")
    check(struct.unpack("<3i", data[:12]) == (90, 90, 180), "head of a MERL table")
    run("convert", "gold.binary", "copy.merl", status=0)
    check(contents("copy.merl") == data, "MERL to MERL is not the same bytes")
    run("convert", "gold.binary", "other.txt", "--to", "csv", status=0)
    run("convert", "other.txt", "back.binary", status=0)
    check(contents("back.binary") == data, "MERL to CSV and back is not the same bytes")
    run("plot", "brdf", "--data", "gold.binary", "--material", GOLD, "--csv", "-o", "p.svg", status=0)
    curves = {}
    for row in rows(contents("p.csv").decode()):
        curves.setdefault(row["curve"], []).append(float(row["value"]))
    check(len(curves) == 2, "curves: %s" % list(curves))
    a, b = curves.values()
    middle = range(300, 1100)                   # away from grazing angles a bin changes little
    check(all(near(a[i], b[i], 0.1) for i in middle), "a material as a measurement")


def isotropic_only():
    """What a MERL table cannot hold is refused rather than lost."""
    gold = "conductor:metal=Au,ndf=(%s)"
    for ndf in ("ggx:alpha_x=0.4,alpha_y=0.1", "beckmann:alpha_x=1e-4,alpha_y=1.01e-4",
                "student_t:alpha=0.2,gamma=3,mean_x=0.01", "ellipsoid:alpha=0.2,theta_x=0.1"):
        for name in ("an.binary", "an.csv"):
            run("convert", "--material", gold % ndf, name, status=1, says=[ndf, "isotropic"])
            run("convert", "--ndf", ndf, name, status=1, says=[ndf, "isotropic"])
    nothing_here("a refused conversion")
    for ndf in ("beckmann:alpha=1e-5", "ggx:alpha=100", "student_t:alpha=0.3,gamma=1.6"):
        run("convert", "--material", gold % ndf, "iso.binary", status=0)
    os.remove("iso.binary")
    turned = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n30,0,40,150,2\n30,10,40,150,1\n"
    with open("turned.csv", "w", encoding="utf-8") as file:
        file.write(turned)
    run("convert", "turned.csv", "an.binary", status=1, says=["turned.csv", "isotropic"])
    run("convert", "turned.csv", "copy.csv", status=0)
    nothing_here("a refused conversion", ["turned.csv", "copy.csv"])


def listed_geometries():
    """Between listed geometries nothing is known: no picture."""
    with open("one.csv", "w", encoding="utf-8") as file:
        file.write("theta_i_deg,theta_o_deg,phi_o_deg,f\n30,40,150,2\n")
    folder = os.path.join(SHARED, "data", "measured", "merl_subset")
    names = ["one.csv", os.path.join(folder, "aluminium_inplane_lumos.csv")]
    for name in [n for n in names if os.path.exists(n)]:
        run("render", "--data", name, "-o", "a.png", status=1,
            says=["the measurement lists geometries and cannot be rendered"])
    nothing_here("a refused picture", ["one.csv"])


def broken_measurements():
    run("convert", "--material", GOLD, "gold.binary", status=0)
    data = contents("gold.binary")
    hostile = {
        "cut.binary": data[:1000000], "head.binary": data[:7], "empty.binary": b"",
        "huge.binary": struct.pack("<3i", 2**30, 2**30, 2**30) + data[12:5000],
        "minus.binary": struct.pack("<3i", -90, 90, 180) + data[12:],
        "noise.bsdf": bytes(range(256)) * 40, "rgl.bsdf": b"tensor_file\0\1\0\xff\xff\xff\xff",
        "words.csv": b"theta_i,phi_i,theta_o,phi_o,r,g,b\n0,0,0,zero,1,1,1\n",
    }
    for name, content in hostile.items():
        with open(name, "wb") as file:
            file.write(content)
        kept = sorted(os.listdir("."))
        run("convert", name, "out.csv", status=1, says=[name])
        run("render", "--data", name, "-o", "out.png", status=1, says=[name])
        run("plot", "--data", name, "-o", "out.svg", status=1, says=[name])
        check(sorted(os.listdir(".")) == kept, name + ": left behind: %s" % os.listdir("."))
    run("convert", "none.binary", "out.csv", status=1, says=["none.binary"])
    run("convert", ".", "out.csv", status=1)
    rgl = os.path.join(SHARED, "data", "rgl", "chm_mint_rgb.bsdf")
    if os.path.exists(rgl):
        run("render", "--data", rgl, "-o", "mint.png", "--size", "16", "--spp", "4", status=0)
        run("plot", "polar", "brdf", "--data", rgl, "-o", "mint.svg", status=0)
        with open("mint_cut.bsdf", "wb") as file:
            file.write(contents(rgl)[:100000])
        run("render", "--data", "mint_cut.bsdf", "-o", "cut.png", status=1, says=["mint_cut.bsdf"])
        check(not os.path.exists("cut.png"), "a picture of a truncated file")


# ---------------------------------------------------------------- render

def renders():
    def render(name, *more):
        done = run("render", "--material", GOLD, "-o", name, "--size", "24", "--spp", "8", *more,
                   status=0)
        check(done.stderr == "" and done.stdout == "", "render is not silent in a pipe")
        return contents(name)
    check(render("a.png").startswith(b"\x89PNG"), "PNG")
    check(render("a.exr").startswith(b"v/1\x01"), "EXR")
    picture = render("a.pfm")
    check(picture.startswith(b"PF\n24 24\n-1") and len(picture) >= 24 * 24 * 12, "PFM")
    check(render("b.pfm", "--threads", "1") == render("c.pfm", "--threads", "3") == picture,
          "the picture depends on the threads")
    check(render("d.pfm", "--seed", "5") != picture, "the seed changes nothing")
    check(render("e.pfm", "--env", "furnace") != picture, "the environment changes nothing")
    # perfect mirror facets that lose little disappear in the furnace: radiance 1 but for masking
    run("render", "--ndf", "ggx:alpha=0.05", "-o", "f.pfm", "--env", "furnace", "--size", "24",
        "--spp", "64", status=0)
    values = struct.unpack("<%df" % (24 * 24 * 3), contents("f.pfm")[-24 * 24 * 12:])
    middle = values[(12 * 24 + 12) * 3]
    check(abs(middle - 1) < 0.02, "furnace: %g" % middle)
    run("render", "--material", GOLD, "-o", "nowhere/a.png", "--spp", "60000", "--size", "4000",
        status=1, says=["nowhere/a.png"])


def progress_bar():
    """Drawn on a terminal, and wiped away at the end."""
    reader, writer = pty.openpty()
    process = subprocess.Popen([COMMAND, "render", "--material", GOLD, "-o", "a.png", "--size",
                                "128", "--spp", "128"], stderr=writer)
    process.wait()
    os.close(writer)
    shown = b""
    try:
        while True:
            part = os.read(reader, 65536)
            if not part:
                break
            shown += part
    except OSError:                             # Linux: the other end is closed
        pass
    os.close(reader)
    check(process.returncode == 0, "render on a terminal")
    check(b"render [" in shown and b"%" in shown, "no bar: %r" % shown[:80])
    check(shown.endswith(b"\r\x1b[K"), "the bar stays: %r" % shown[-40:])


# ---------------------------------------------------------------- signals and full devices

def stopped(words, number, expect_temporary):
    process = subprocess.Popen([COMMAND, *words], stderr=subprocess.PIPE)
    limit = time.time() + 20
    seen = False
    while time.time() < limit and process.poll() is None:
        time.sleep(0.05)
        seen = bool(os.listdir("."))
        if seen == expect_temporary and (seen or time.time() > limit - 19.5):
            break
    check(seen == expect_temporary, "%s: a temporary file: %s" % (words[0], seen))
    check(process.poll() is None, "%s ended by itself" % words[0])
    process.send_signal(number)
    process.communicate(timeout=20)
    check(process.returncode == -number, "%s: status %d" % (words[0], process.returncode))
    nothing_here("%s, stopped by signal %d" % (words[0], number))


def signals():
    long_render = ["render", "--material", GOLD, "--size", "2048", "--spp", "65536", "-o", "a.png"]
    long_sample = ["sample", "brdf", "--ndf", "ggx", "--wi", "30,0", "-n", "1000000000", "-o", "s.csv"]
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        stopped(long_render, number, False)
        stopped(long_sample, number, True)


def file_limit():
    """Past `ulimit -f` a write fails as on a full disk; nothing is left behind."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20480, 20480))
    for words in (["convert", "--ndf", "ggx", "full.csv"], ["convert", "--ndf", "ggx", "full.merl"],
                  ["sample", "normal", "--ndf", "ggx", "-n", "100000", "-o", "full.csv"],
                  ["render", "--ndf", "ggx", "--size", "64", "--spp", "1", "-o", "full.pfm"]):
        done = subprocess.run([COMMAND, *words], capture_output=True, text=True, preexec_fn=limit,
                              check=False)
        check(done.returncode == 1 and "full." in done.stderr and ": cannot write: File too large" in done.stderr,
              "%s past the limit: %d %s" % (words[0], done.returncode, done.stderr))
        nothing_here("%s past the limit" % words[0])


def full_device():
    if not os.path.exists("/dev/full"):
        return
    full = "No space left on device"
    run("sample", "normal", "--ndf", "ggx", "-n", "100000", "-o", "/dev/full", status=1, says=[full])
    run("plot", "D", "--ndf", "ggx", "-o", "/dev/full", status=1, says=[full])
    run("convert", "--ndf", "ggx", "/dev/full", "--to", "merl", status=1, says=[full])
    run("eval", "D", "--ndf", "ggx", "-o", "/dev/full", stdin="mx,my,mz\n0,0,1\n", status=1,
        says=[full])
    for words in (["sample", "normal", "--ndf", "ggx", "-n", "100000"], ["list"], ["--help"],
                  ["list", "--json"], ["help", "eval"], ["plot", "D", "--ndf", "ggx", "-o", "-"]):
        with open("/dev/full", "w", encoding="utf-8") as device:
            done = subprocess.run([COMMAND, *words], stdout=device, stderr=subprocess.PIPE,
                                  text=True, check=False)
        check(done.returncode == 1 and full in done.stderr, "%s > /dev/full: %d %s"
              % (words[0], done.returncode, done.stderr))
    # an output that exists stays as it was when the command fails
    with open("kept.csv", "w", encoding="utf-8") as file:
        file.write("precious\n")
    run("eval", "D", "--ndf", "ggx", "-o", "kept.csv", stdin="mx,my,mz\n0,0,2\n", status=1)
    check(contents("kept.csv") == b"precious\n", "a failed command changed its output file")
    nothing_here("a failed command", ["kept.csv"])
    process = subprocess.Popen([COMMAND, "sample", "normal", "--ndf", "ggx", "-n", "10000000"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.readline()
    process.stdout.close()                      # as `| head -1` does
    process.stderr.close()
    check(process.wait(20) in (-signal.SIGPIPE, 1), "a closed pipe")


# ---------------------------------------------------------------- fabricate

def fabrications():
    words = ["fabricate", "--rays", "50000", "--size", "128", "--alpha", "0.3"]
    made = json.loads(run(*words, "--json", "a.binary", status=0).stdout)
    check(made["rays"] == 50000 and made["metal"] == "Au", "report: %s" % made)
    check(near(made["slopes"]["alpha"], 0.3, 0.2) and made["slopes"]["facets"] == 2 * 128 ** 2,
          "slopes: %s" % made["slopes"])
    check(made["albedo"][0] > made["albedo"][1] > made["albedo"][2] > 0, "gold is yellow")
    run(*words, "--threads", "3", "b.binary", status=0)
    check(contents("a.binary") == contents("b.binary"), "depends on the threads")
    flat = json.loads(run(*words, "--gamma", "inf", "--metal", "none", "--json", "c.binary",
                          status=0).stdout)
    check(all(abs(a - 1) < 1e-3 for a in flat["albedo"]), "nothing is absorbed: %s" % flat["albedo"])
    kept = sorted(os.listdir("."))
    run("fabricate", "x.binary", "--metal", "AU", status=2, says=["'AU'", "'Au'"])
    run("fabricate", "x.binary", "--gamma", "1.5", status=2, says=["1.5", "[1.6, inf]"])
    run("fabricate", "x.binary", "--size", "300", status=2, says=["--size", "power of two"])
    run("fabricate", "x.binary", "--size", "64", "--correlation", "30", status=2,
        says=["correlation", "[2, 8]"])
    run("fabricate", "x.png", status=2, says=["x.png", ".binary"])
    check(sorted(os.listdir(".")) == kept, "a refused command wrote a file")


# ---------------------------------------------------------------- check

def checks():
    done = run("check", "ggx:alpha=0.3", "--samples", "20000", status=0)
    check("holds" in done.stdout and "all laws hold" in done.stdout, "check: " + done.stdout[-80:])
    found = json.loads(run("check", "ggx:alpha=0.3", "student_t:alpha=0.2,gamma=3", "--samples",
                           "20000", "--json", status=0).stdout)
    check(found["holds"] and len(found["results"]) == 2, "check --json")
    names = [law["name"] for law in json.loads(run("list", "laws", "--json").stdout)["laws"]]
    for result in found["results"]:
        check({law["law"] for law in result["laws"]} <= set(names) and len(result["laws"]) > 4,
              "laws: %s" % result["laws"])
        check(all(law["holds"] == (float(law["worst"]) <= law["allowed"]) and law["checks"] > 0
                  for law in result["laws"]), "a law holds when it lies within what is allowed")
    one = json.loads(run("check", "ggx", "--law", names[0], "--json", status=0).stdout)
    check([law["law"] for law in one["results"][0]["laws"]] == names[:1], "check --law")


run_sections([plots, plot_numbers, conversions, isotropic_only, listed_geometries,
              broken_measurements, renders, progress_bar, signals, file_limit, full_device,
              fabrications, checks])
