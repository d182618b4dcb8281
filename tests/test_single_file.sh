#!/bin/sh
# test_single_file.sh SOURCE BUILD - the core as one file: the list is current; cc builds it without further flags;
# gcc, clang and C++17 build it without a warning; and all of them print the same.
set -eu
build=$2
cd "$1"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0
ok() { passed=$((passed + 1)); echo "ok: $*"; }
fail() { echo "FAILED: $*"; echo "$passed passed, 1 failed"; exit 1; }

scripts/single-file.sh >"$scratch/asperity_core.c"
diff src/asperity_core.c "$scratch/asperity_core.c" || fail "src/asperity_core.c is stale: make docs"
ok "src/asperity_core.c lists every file of the core"

# runs NAME OBJECT: the object in a program
runs() {
    gcc -O1 -Iinclude tests/install/core.c "$2" -lm -o "$scratch/core" || fail "$1: link"
    [ "$("$scratch/core")" = "sigma 0.827200187266" ] || fail "$1: $("$scratch/core")"
    ok "$1"
}

core=$build/tests/objects/core.o
make -f tests/objects.mk OUT="$build/tests/objects" "$core" || fail "cc -O2"
runs "cc -O2 -Iinclude -Isrc -c src/asperity_core.c, with all warnings" "$core"
shown=$(nm -g --defined-only "$core" | awk 'NF == 3 && $3 !~ /^aspi?_/ { print $3 }')
[ -z "$shown" ] || fail "names without a prefix: $shown"
ok "every name that another file can see begins with asp_ or aspi_"

# strings, numbers and their decimal point, memory, square roots, and what the compiler itself adds;
# nothing that allocates or prints
asked=$(nm -u "$core" | awk '{ print $2 }' |
    grep -vE '^(mem(cpy|set|move|cmp)|str(len|n?cmp|chr|c?spn|tod)|sqrtf?|_GLOBAL_OFFSET_TABLE_|localeconv|__cpu_.*|__stack_chk_fail)$' || true)
[ -z "$asked" ] || fail "the core asks for $asked"
ok "the core asks the C library for strings, memory and square roots only"

# The library's own flags. What an optimiser warns of, the one above has seen.
flags="-O0 -Wall -Wextra -Wpedantic -Werror -fno-math-errno -fno-trapping-math -ffp-contract=off"
for compiler in "clang -std=c11" "g++ -x c++ -std=c++17" "clang++ -x c++ -std=c++17"; do
    # shellcheck disable=SC2086
    $compiler $flags -fno-exceptions -Iinclude -Isrc -c src/asperity_core.c -o "$scratch/core.o" || fail "$compiler"
    runs "$compiler" "$scratch/core.o"
done
# shellcheck disable=SC2086
gcc -std=c11 $flags -Iinclude -Isrc -fsyntax-only src/asperity_core.c || fail "gcc -std=c11"
ok "gcc -std=c11"
for header in asperity asperity_ndf asperity_data asperity_draw; do
    for compiler in "gcc -x c -std=c11" "clang -x c -std=c11" "g++ -x c++ -std=c++17" \
                 "clang++ -x c++ -std=c++17"; do
        # shellcheck disable=SC2086
        echo "#include \"$header.h\"" | $compiler -Wall -Wextra -Wpedantic -Werror -Iinclude \
            -fsyntax-only - || fail "$header.h alone with $compiler"
    done
done
ok "each public header compiles alone, as C11 and C++17"
echo "$passed passed, 0 failed"
