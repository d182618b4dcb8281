#!/bin/sh
# docs.sh [--check] [BUILD] - writes again everything in the tree that a command produces, or, with
# --check, changes nothing and fails with the difference where something is stale.
#
# In a page, what stands between these two lines is the output of the command:
#     <!-- $ build/asperity list -->
#     <!-- end -->
# Whole files that are produced are listed at the end of this script.
set -eu
cd "$(dirname "$0")/.."
check=0
[ "${1:-}" != --check ] || { check=1; shift; }
build=$(cd "${1:-build}" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# pages name the command as a reader would type it after `make`
mkdir "$scratch/bin"
ln -s "$build/asperity" "$scratch/bin/asperity"
PATH=$scratch/bin:$PATH
stale=0

# put FILE NEW: NEW becomes FILE, or is compared with it
put() {
    if cmp -s "$1" "$2"; then
        return 0
    fi
    if [ $check = 1 ]; then
        stale=$((stale + 1))
        echo "stale: $1"
        case $1 in
        *.png) ;;
        *) diff -u "$1" "$2" | cut -c 1-200 | head -n 40 || true ;;
        esac
    else
        mkdir -p "$(dirname "$1")"
        cp "$2" "$1"
        echo "wrote $1"
    fi
}

# page FILE: runs its commands
page() {
    awk -v file="$1" '
        /^<!-- \$ .* -->$/ {
            print
            command = substr($0, 8, length($0) - 11)
            print "```text"
            while ((command | getline line) > 0)
                print line
            print "```"
            status = close(command)
            if (status != 0) {
                print file ": status " status " from: " command >"/dev/stderr"
                failed = 1
            }
            skipping = 1
            next
        }
        /^<!-- end -->$/ { skipping = 0 }
        !skipping { print }
        END {
            if (skipping)
                print file ": a command without its <!-- end -->" >"/dev/stderr"
            exit failed || skipping
        }' "$1" >"$scratch/page" || { echo "docs.sh: $1 failed" >&2; exit 1; }
    put "$1" "$scratch/page"
}

# file FILE COMMAND...: the command's standard output is the file
file() {
    target=$1
    shift
    "$@" >"$scratch/file" || { echo "docs.sh: failed: $*" >&2; exit 1; }
    put "$target" "$scratch/file"
}

for p in README.md docs/*.md; do
    page "$p"
done
file src/asperity_core.c scripts/single-file.sh
# the README's picture is what the last example writes
# shellcheck disable=SC2046
cc -O2 -Iinclude examples/6_render.c "$build/libasperity_draw.a" "$build/libasperity_data.a" \
    "$build/libasperity.a" $(pkg-config --libs jansson cminpack libpng OpenEXR) -lembree3 -lpthread -lm \
    -o "$scratch/render"
(cd "$scratch" && ./render >render.log)
put docs/images/spheres.png "$scratch/spheres.png"
# pictures of docs/materials.md: NAME SAMPLES SPEC
while read -r name samples spec; do
    walk=
    case $name in walk*) walk=--walk ;; esac
    # shellcheck disable=SC2086
    asperity render $walk --size 144 --spp "$samples" --material "$spec" -o "$scratch/material.png" ||
        { echo "docs.sh: $name could not be rendered" >&2; exit 1; }
    put "docs/images/materials/$name.png" "$scratch/material.png"
done <<'END'
conductor 64 conductor:metal=Au,ndf=(ggx:alpha=0.2)
film 64 conductor:eta=2.7,k=3.7,film=60,film_eta=2.4,ndf=(ggx:alpha=0.15)
lambert_specular 64 lambert_specular:diffuse=0.4/0.08/0.05,ndf=(student_t:alpha=0.15,gamma=2.5)
dielectric 128 dielectric:eta=1.5,ndf=(ggx:alpha=0.05)
film_glass 128 dielectric:eta=1.5,film=400,film_eta=2,ndf=(ggx:alpha=0.1)
thin 64 dielectric:eta=1.5,thin=1,ndf=(ggx:alpha=0.2)
rough_diffuse 8 rough_diffuse:albedo=0.6/0.55/0.5,ndf=(ggx:alpha=0.7)
plastic 64 plastic:albedo=0.5/0.05/0.05,ndf=(ggx:alpha=0.15)
compensated 64 compensated:metal=Cu,ndf=(ggx:alpha=0.8)
single 64 conductor:metal=Cu,ndf=(ggx:alpha=0.8)
walk 32 conductor:metal=Cu,ndf=(ggx:alpha=0.8)
compensated_dielectric 128 compensated_dielectric:eta=1.5,ndf=(ggx:alpha=0.8)
single_dielectric 128 dielectric:eta=1.5,ndf=(ggx:alpha=0.8)
walk_dielectric 64 dielectric:eta=1.5,ndf=(ggx:alpha=0.8)
END
file docs/commands.md asperity help --markdown
file docs/distributions.md asperity list --markdown
file docs/figures.md asperity figures --markdown
# The figures: SVG as they are. Of their numbers only the checksums are kept, and PNG are not kept at all:
# they are the SVG as the librsvg at hand draws it. Figure 4 of the STD paper is measured; its times are
# kept, and only the drawing of them is repeated (asperity figures std-4 -o docs/images/figures measures).
kept=docs/images/figures
asperity figures --no-png --cost $kept/std-4.csv -o "$scratch/figures" ||
    { echo "docs.sh: asperity figures failed" >&2; exit 1; }
for f in "$scratch"/figures/*.svg; do
    put "$kept/${f##*/}" "$f"
done
for f in $kept/*.svg; do
    [ -e "$scratch/figures/${f##*/}" ] || { echo "no figure any more: $f"; stale=$((stale + 1)); }
done
(cd "$scratch/figures" && sha256sum -- *.csv) >"$scratch/numbers"
put $kept/numbers.sha256 "$scratch/numbers"

[ $stale = 0 ] || { echo "$stale stale: run make docs and commit what changed"; exit 1; }
