"""What the tests of the command share: running it, counting checks, reading its tables.

A test program is called as: test_cli_*.py COMMAND SOURCE_DIRECTORY. It prints what it checked; its
exit status is 0 when all passed, 1 when something failed."""
import csv
import os
import subprocess
import sys
import tempfile
import time

COMMAND, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
GOLD = "conductor:metal=Au,ndf=(ggx:alpha=0.2)"
count = {True: 0, False: 0}


def check(good, what):
    count[bool(good)] += 1
    if not good:
        print("FAILED:", what)


def run(*words, stdin="", status=None, says=(), timeout=120):
    """Runs the command; checks its exit status and that its error names every one of `says`."""
    done = subprocess.run([COMMAND, *words], input=stdin, capture_output=True, text=True,
                          timeout=timeout)
    called = "asperity " + " ".join(words)[:150]
    if status is not None:
        check(done.returncode == status,
              "%s: exit status %d, expected %d: %s" % (called, done.returncode, status, done.stderr))
    for part in says:
        check(part in done.stderr, "%s: '%s' not in: %s" % (called, part, done.stderr.strip()))
    if status:
        check(done.stderr.startswith("asperity: ") and done.stderr.count("\n") == 1,
              "%s: one line of error, not: %s" % (called, done.stderr))
    return done


def rows(text):
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


def near(a, b, tolerance):
    return a == b or abs(a - b) <= tolerance * max(abs(a), abs(b))


def run_sections(sections):
    """Each section starts in an empty directory of its own."""
    home = os.getcwd()
    for section in sections:
        before, start = sum(count.values()), time.time()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            section()
            os.chdir(home)
        print("%-18s %5d checks, %.1f s" % (section.__name__, sum(count.values()) - before,
                                           time.time() - start))
    print("%d passed, %d failed" % (count[True], count[False]))
    sys.exit(1 if count[False] else 0)
