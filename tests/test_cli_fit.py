#!/usr/bin/env python3
"""asperity fit: the table, fit.json, the report, refusals, nothing half-written."""
import html.parser
import json
import math
import os
import re
import signal
import subprocess
import time

from cli import COMMAND, check, near, run, run_sections

# What eval computes for these directions is the measurement: the fit must give the spec back.
TRUTH = "lambert_specular:diffuse=0.2/0.1/0.05,specular=0.9/0.8/0.7,eta=1.6,ndf=(%s)"


def directions():
    lines = ["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"]
    for i in range(0, 75, 6):
        for o in range(-75, 76, 3):
            for phi in (0, 25, 90):
                t, u, p = math.radians(i), math.radians(o), math.radians(phi)
                lines.append("%.17g,0,%.17g,%.17g,%.17g,%.17g"
                             % (-math.sin(t), math.cos(t), math.sin(u) * math.cos(p),
                                math.sin(u) * math.sin(p), math.cos(u)))
    return "\n".join(lines) + "\n"


def measurement(name, ndf):
    made = run("eval", "brdf", "--material", TRUTH % ndf, stdin=directions(), status=0).stdout
    with open(name, "w") as file:
        file.write(made.replace("brdf_", ""))


def listing(name, rows):
    """Rows of theta_i, theta_o on the far side, f; one channel."""
    with open(name, "w") as file:
        file.write("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n")
        for i, o, f in rows:
            file.write("%.17g,0,%.17g,180,%.17g\n" % (i, o, f))


class Page(html.parser.HTMLParser):
    """Checks that elements nest, and gathers what a page refers to."""
    void = {"meta", "br", "img", "link", "input", "hr"}

    def __init__(self):
        super().__init__()
        self.open, self.bad, self.refers, self.count, self.words = [], [], [], {}, []

    def handle_starttag(self, tag, attrs):
        self.count[tag] = self.count.get(tag, 0) + 1
        self.refers += [v for k, v in attrs if k in ("src", "href", "xlink:href")]
        if tag not in self.void:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.bad.append(tag)

    def handle_data(self, data):
        self.words.append(data)


def read_page(path):
    page = Page()
    with open(path, encoding="utf-8") as file:
        page.feed(file.read())
    check(not page.bad and not page.open, "%s: elements do not nest: %s %s"
          % (path, page.bad, page.open))
    return page


def one_file():
    measurement("m.csv", "student_t:alpha=0.2,gamma=3.5")
    done = run("fit", "m.csv", "-o", "out", "--spp", "4", status=0)
    check(not done.stderr, "says nothing in a pipe: " + done.stderr)
    check("student_t" in done.stdout and "<- best" in done.stdout, "table: " + done.stdout)
    check(sorted(os.listdir("out")) == ["fit.json", "report.html"], "files: %s" % os.listdir("out"))
    fit = json.load(open("out/fit.json"))
    check([r["model"] for r in fit["results"]][:3] == ["ggx", "beckmann", "student_t"], "models")
    best = [r for r in fit["results"] if r["best"]]
    check(len(best) == 1 and best[0]["model"] == "student_t", "best")
    value = {p["name"]: p["value"] for p in best[0]["parameters"]}
    want = {"alpha": 0.2, "gamma": 3.5, "eta": 1.6, "diffuse_r": 0.2, "diffuse_g": 0.1,
            "diffuse_b": 0.05, "specular_r": 0.9, "specular_g": 0.8, "specular_b": 0.7}
    check(set(value) == set(want), "parameters: %s" % sorted(value))
    for name in want:
        check(near(value[name], want[name], 1e-4), "%s = %g, not %g" % (name, value[name], want[name]))
    for result in fit["results"]:
        check(best[0]["errors"][fit["loss"]] <= result["errors"][fit["loss"]], "best is least")
        run("eval", "brdf", "--material", result["spec"], stdin=directions(), status=0)
    page = read_page("out/report.html")
    check(all(r.startswith("data:image/png;base64,") for r in page.refers), "the page stands alone")
    check(page.count.get("svg", 0) >= 7, "charts: %s" % page.count.get("svg"))
    check(page.count.get("img", 0) == len(fit["results"]), "spheres of listed data: the fits")
    words = "".join(page.words)
    check("nan" not in re.findall(r"[a-z]+", words), "NaN in the page")
    again = run("fit", "m.csv", "-o", "again", "--spp", "4", status=0)
    check(again.stdout == done.stdout, "another table")
    for name in ("fit.json", "report.html"):
        check(open("out/" + name).read() == open("again/" + name).read(), name + " differs")


def one_channel():
    """A listing of one channel with a peak that no lobe reaches, at theta_h = 0."""
    rows = []
    for i in range(5, 75, 5):
        for o in range(0, 76):
            h = (o - i) / 2
            rows.append((i, o, 500 if h == 0 else 0.03 + 6 / (1 + (h / 3) ** 2) ** 2))
    listing("grey.csv", rows)
    done = run("fit", "grey.csv", "-o", "out", "--spp", "1", status=0)
    text = open("out/fit.json").read()
    check(not re.search("(diffuse|specular)_[rgb]", done.stdout + text), "channels that do not exist")
    for result in json.loads(text)["results"]:
        names = [p["name"] for p in result["parameters"]]
        check(names[-3:] == ["eta", "diffuse", "specular"], "parameters: %s" % names)
        check(len(result["correlation"]) == len(names), "correlation: %d rows" % len(names))
        run("eval", "brdf", "--material", result["spec"], stdin=directions(), status=0)
        for p in result["parameters"]:
            if p["name"] == "eta" and p["determined"] and not p["at_bound"]:
                check(p["value"] - p["uncertainty"] >= 1.05 and p["value"] + p["uncertainty"] <= 100,
                      "eta %g +- %g leaves its range" % (p["value"], p["uncertainty"]))
    page = "".join(read_page("out/report.html").words)
    check(not re.search("(diffuse|specular)_[rgb]", page), "channels in the page")
    check("500" in page and "too low" in page, "the page says that the peak is missed")
    check(page.count("drawn at the left edge") == 1, "what becomes of theta_h = 0")
    # many values, but of one geometry: nothing follows of the lobe
    listing("same.csv", [(30, 30, 2 + 0.01 * k) for k in range(30)])
    for result in json.loads(run("fit", "same.csv", "--json", status=0).stdout)["fits"][0]["results"]:
        check(not [p for p in result["parameters"] if p["determined"] and not p["at_bound"]],
              "determined by one geometry: %s" % result["parameters"])


def several_files():
    os.mkdir("a")
    measurement("a/x.csv", "ggx:alpha=0.3")
    measurement("x.csv", "beckmann:alpha=0.2")
    done = run("fit", "a/x.csv", "x.csv", "--ndf", "ggx,beckmann", "--json", "-o", "out", "--spp", "1",
               status=0)
    fits = json.loads(done.stdout)["fits"]
    check([[r["model"] for r in f["results"]] for f in fits] == [["ggx", "beckmann"]] * 2, "models")
    check(sorted(os.listdir("out")) == ["index.html", "x", "x-2"], "folders: %s" % os.listdir("out"))
    check([next(r["model"] for r in f["results"] if r["best"]) for f in fits] == ["ggx", "beckmann"],
          "best of each")
    page = read_page("out/index.html")
    check(page.refers == ["x/report.html", "x-2/report.html"], "links: %s" % page.refers)
    for link in page.refers:
        check(os.path.exists("out/" + link), link)
    # the second cannot be read: the first is complete, nothing of the second is there
    with open("bad.csv", "w") as file:
        file.write("wi_x,wi_y\n1,2\n")
    run("fit", "a/x.csv", "bad.csv", "-o", "half", "--ndf", "ggx", "--spp", "1", status=1,
        says=["bad.csv"])
    check(sorted(os.listdir("half")) == ["index.html", "x"], "left behind: %s" % os.listdir("half"))
    check(read_page("half/index.html").refers == ["x/report.html"], "the index of what is finished")


def options():
    measurement("m.csv", "ggx:alpha=0.3")
    by_nad = json.loads(run("fit", "m.csv", "--json", "--loss", "nad", "--mask", "uncorrelated",
                            "--seed", "7", "--starts", "2", status=0).stdout)["fits"][0]
    check((by_nad["loss"], by_nad["mask"], by_nad["seed"], by_nad["starts"])
          == ("nad", "uncorrelated", 7, 2), "options are kept")
    ggx = by_nad["results"][0]
    check("mask=uncorrelated" in ggx["spec"] and ggx["errors"]["nad"] > 1e-5,
          "another masking cannot fit exactly: %g" % ggx["errors"]["nad"])
    check(not [n for n in os.listdir(".") if n != "m.csv"], "wrote without --output")


def refusals():
    measurement("m.csv", "ggx:alpha=0.3")
    run("fit", status=2, says=["--fabricate"])
    run("fit", "m.csv", "--ndf", "ggx,bekmann", status=2, says=["bekmann", "'beckmann'", "student_t"])
    run("fit", "m.csv", "--ndf", "ggx,ggx", status=2, says=["twice"])
    run("fit", "m.csv", "--ndf", "", status=2, says=["--ndf"])
    run("fit", "m.csv", "--ndf", "ellipsoid", status=2, says=["ellipsoid"])
    run("fit", "m.csv", "--loss", "nadd", status=2, says=["nadd", "'nad'", "log_relative"])
    run("fit", "m.csv", "--starts", "0", status=2, says=["starts"])
    run("fit", "m.csv", "--specular-limit", "0", status=2, says=["specular-limit"])
    run("fit", "m.csv", "--ndf", ",", status=2, says=["--ndf"])
    run("fit", "absent.bsdf", "-o", "out", status=1, says=["absent.bsdf", "No such file"])
    with open("bad.csv", "w") as file:
        file.write("wi_x,wi_y\n1,2\n")
    run("fit", "bad.csv", "-o", "out", status=1, says=["bad.csv"])
    os.remove("bad.csv")
    run("fit", "m.csv", "-o", "m.csv", status=1, says=["m.csv"])
    run("fit", "m.csv", "-o", "no/where", status=1, says=["no/where"])
    listing("zero.csv", [(i, o, 0) for i in range(0, 60, 10) for o in range(0, 60, 5)])
    listing("few.csv", [(30, 30, 2)])
    run("fit", "zero.csv", "-o", "out", status=1, says=["zero.csv", "every value is 0"])
    run("fit", "few.csv", "-o", "out", status=1, says=["few.csv", "1 value", "4 parameters", "'ggx'"])
    os.remove("zero.csv")
    os.remove("few.csv")
    check(os.listdir(".") == ["m.csv"], "left behind: %s" % os.listdir("."))


def interrupted():
    measurement("m.csv", "student_t:alpha=0.2,gamma=3")
    process = subprocess.Popen([COMMAND, "fit", "m.csv", "-o", "out", "--spp", "65536"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    check(process.returncode == -signal.SIGINT, "status %s" % process.returncode)
    check(not os.path.exists("out"), "left behind: %s" % os.listdir("."))


run_sections([one_file, one_channel, several_files, options, refusals, interrupted])
