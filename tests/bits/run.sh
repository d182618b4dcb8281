#!/bin/sh
# run.sh SOURCE [FOLDER [LIBRARY [SANITIZED]]] - builds bits.c with the core in every way there is and compares the
# hashes. Compilers, sanitizers, instruction sets and WASM that are absent are left out, and said to be. What was
# compiled stays in the folder; libraries newer than the sources save compiling theirs.
set -u
folder=${2:-$(mktemp -d)}
library=${3:-}
sanitized=${4:-}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
cd "${1:-.}" || exit 1

has() { command -v "$1" >/dev/null 2>&1; }
skip() { echo "$1: left out, $2"; }
cpu() { grep -qw "$1" /proc/cpuinfo 2>/dev/null; }
# made by gcc of these sources
current() {
    [ -f "$1" ] && readelf -p .comment "$1" 2>/dev/null | grep -q 'GCC:' &&
        [ -z "$(find include src/core src/ndf src/bsdf -newer "$1" -type f)" ]
}

has make || { echo "0 passed, 0 failed: make is absent"; exit 77; }
current "$sanitized" || sanitized=
ways=
if has gcc; then
    # the library as it is shipped stands for gcc's
    if current "$library"; then ways=library; else ways=gcc-clones; fi
    ways="$ways gcc-o1-sanitized gcc-o0"
    if cpu avx2; then ways="$ways gcc-avx2"; else skip gcc-avx2 "no AVX2 here"; fi
    if cpu avx512f; then ways="$ways gcc-avx512"; else skip gcc-avx512 "no AVX-512 here"; fi
else
    skip gcc "absent"
fi
if has clang; then
    ways="$ways clang-clones clang-sse2"
    if cpu avx512f; then ways="$ways clang-avx512"; else skip clang-avx512 "no AVX-512 here"; fi
else
    skip clang "absent"
fi
# Debian's lld, wasi-libc and libclang-rt-dev-wasm32
if has clang && has wasm-ld && has node && [ -d /usr/lib/wasm32-wasi ]; then
    ways="$ways wasm wasm-simd"
else
    skip wasm "needs clang, lld, wasi-libc and node"
fi
[ -n "$ways" ] || { echo "0 passed, 0 failed"; exit 77; }

targets=
for way in $ways; do
    rm -f "$folder/$way.program" "$folder/$way.out"
    targets="$targets $folder/$way.out"
done
# shellcheck disable=SC2086
make -k -j2 -f tests/objects.mk "OUT=$folder" "LIBRARY=$library" "SANITIZED=$sanitized" $targets >"$folder/log" 2>&1

passed=0 failed=0 first=
for way in $ways; do
    if [ ! -f "$folder/$way.out" ]; then
        echo "$way: could not be built"
        grep -A5 'error\|Error' "$folder/log" | sed -n 1,12p
        failed=$((failed + 1))
    elif [ -z "$first" ]; then
        first=$way
        echo "$way:"
        cat "$folder/$way.out"
        if grep -q 'refused\|differ\|exit status' "$folder/$way.out"; then
            failed=$((failed + 1))
        else
            passed=$((passed + 1))
        fi
    elif cmp -s "$folder/$first.out" "$folder/$way.out"; then
        echo "$way: the same bits as $first"
        passed=$((passed + 1))
    else
        echo "$way: DIFFERENT from $first"
        diff "$folder/$first.out" "$folder/$way.out" | grep "^[<>]" | sed -n 1,8p
        failed=$((failed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
