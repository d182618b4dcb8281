#!/bin/sh
# run.sh static|shared SOURCE BUILD - installs into a scratch prefix and builds programs against it:
# with pkg-config, with find_package, and a distribution of the program's own.
set -eu
kind=$1 source=$2 build=$3
here=$source/tests/install
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
prefix=$scratch/prefix
passed=0

ok() { passed=$((passed + 1)); echo "ok: $*"; }
fail() { echo "FAILED: $*"; echo "$passed passed, 1 failed"; exit 1; }

if [ "$kind" = shared ]; then
    cmake -S "$source" -B "$scratch/build" -G Ninja -DBUILD_SHARED_LIBS=ON -DASPERITY_TESTS=OFF \
        -DCMAKE_BUILD_TYPE=Debug >"$scratch/log" || { cat "$scratch/log"; fail "configuring"; }
    cmake --build "$scratch/build" -j 2 >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "building"; }
    build=$scratch/build
fi
cmake --install "$build" --prefix "$prefix" >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail install; }
ok "installed"

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name asperity.pc)")
libraries=$(dirname "$PKG_CONFIG_PATH")
export PKG_CONFIG_PATH
if [ "$kind" = shared ]; then
    export LD_LIBRARY_PATH="$libraries"
    for l in asperity asperity_data asperity_draw; do
        readelf -d "$libraries/lib$l.so" | grep -q "SONAME.*lib$l.so.0\]" || fail "soname of $l"
        other=$(nm -D --defined-only "$libraries/lib$l.so" |
            awk '$2 != "A" && $3 !~ /^asp_[A-Za-z0-9_]*@@ASPERITY_0$/ &&
                $3 !~ /^aspi_[A-Za-z0-9_]*@@ASPERITY_PRIVATE$/')
        [ -z "$other" ] || fail "$l shows more: $other"
    done
    ok "shared libraries have their soname, show asp_*, and aspi_* as private"
fi
"$prefix/bin/asperity" --version >/dev/null || fail "the installed command"
ok "the installed command runs"

# the core's own pkg-config file asks for nothing but libm
libs=$(pkg-config --libs asperity)
for word in $libs; do
    case $word in -L*|-lasperity|-lm) ;; *) fail "asperity.pc links $word" ;; esac
done
warn="-std=c11 -Wall -Wextra -Wpedantic -Werror"
# shellcheck disable=SC2046,SC2086
gcc $warn "$here/core.c" $(pkg-config --cflags --libs asperity) -o "$scratch/core"
[ "$("$scratch/core")" = "sigma 0.827200187266" ] || fail "core through pkg-config: $("$scratch/core")"
ok "a program of the core, through pkg-config"
# shellcheck disable=SC2046,SC2086
gcc $warn "$here/draw.c" $(pkg-config --cflags --libs asperity-draw) -o "$scratch/draw"
[ "$("$scratch/draw")" = "<svg" ] || fail "draw through pkg-config"
ok "a program of all three libraries, through pkg-config"

cmake -S "$here" -B "$scratch/outside" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail find_package; }
cmake --build "$scratch/outside" >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail find_package; }
[ "$("$scratch/outside/core")" = "sigma 0.827200187266" ] || fail "core through find_package"
[ "$("$scratch/outside/draw")" = "<svg" ] || fail "draw through find_package"
ok "the same programs, through find_package"

if [ "$kind" = static ]; then
    # the distribution in the recipe, laws included; as C++ too
    "$scratch/outside/laws" || fail "the laws of a distribution outside the library"
    ok "a distribution of the program's own keeps the laws"
    g++ -x c++ -std=c++17 -Wall -Wextra -Wpedantic -Werror -I"$prefix/include" \
        -c "$here/two_scale.c" -o "$scratch/two_scale.o"
    ok "the same file as C++17"
fi
echo "$passed passed, 0 failed"
