#!/bin/sh
# run.sh SOURCE [FOLDER] - builds bits.c with the core in every way there is and compares the hashes.
# Compilers, sanitizers, instruction sets and WASM that are absent are left out, and said to be.
set -u
source=${1:-.}
folder=${2:-$(mktemp -d)}
made=$folder/bits
mkdir -p "$made"
strict="-std=c11 -fno-math-errno -fno-trapping-math -ffp-contract=off"
files="$source/src/core/*.c $source/src/ndf/*.c $source/src/bsdf/*.c $source/tests/bits/bits.c"
flags="-I$source/include -I$source/src"
passed=0
failed=0

# build NAME COMPILER FLAGS... builds and runs in the background; two at a time.
build() {
    name=$1
    compiler=$2
    shift 2
    if ! $compiler $strict $flags "$@" $files -lm -o "$made/$name" 2>"$made/$name.log"; then
        echo "could not be built" >"$made/$name.out"
        sed -n 1,5p "$made/$name.log" >>"$made/$name.out"
        return
    fi
    "$made/$name" >"$made/$name.out" 2>&1 || echo "exit status $?" >>"$made/$name.out"
}

has() { command -v "$1" >/dev/null 2>&1; }
skip() { echo "$1: left out, $2"; }
cpu() { grep -qw "$1" /proc/cpuinfo 2>/dev/null; }

rm -f "$made"/*.out
queue=0
ways=""
start() {
    ways="$ways $1"
    build "$@" &
    queue=$((queue + 1))
    if [ $queue -ge 2 ]; then
        wait
        queue=0
    fi
}

if has gcc; then
    start gcc-clones gcc -O3
    start gcc-o1-sanitized gcc -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -DASP_NO_CLONES
    start gcc-o0 gcc -O0 -DASP_NO_CLONES
    cpu avx2 && start gcc-avx2 gcc -O3 -mavx2 -mfma -DASP_NO_CLONES || skip gcc-avx2 "no AVX2 here"
    cpu avx512f && start gcc-avx512 gcc -O3 -mavx512f -mfma -DASP_NO_CLONES \
        || skip gcc-avx512 "no AVX-512 here"
else
    skip gcc "absent"
fi
if has clang; then
    start clang-clones clang -O3
    start clang-sse2 clang -O3 -DASP_NO_CLONES
    cpu avx512f && start clang-avx512 clang -O3 -mavx512f -mfma -DASP_NO_CLONES \
        || skip clang-avx512 "no AVX-512 here"
else
    skip clang "absent"
fi

# WASM, with and without vectors: Debian's lld, wasi-libc and libclang-rt-dev-wasm32, run by node.
# Batches keep their blocks on the stack, and the linker gives WASM 64 KB of it unless told.
wasm() {
    name=$1
    shift
    if ! clang --target=wasm32-wasi -Wl,-z,stack-size=1048576 -Wl,--stack-first $strict $flags -O3 \
        "$@" $files -o "$made/$name.wasm" \
        2>"$made/$name.log"; then
        echo "could not be built" >"$made/$name.out"
        sed -n 1,5p "$made/$name.log" >>"$made/$name.out"
        return
    fi
    node --no-warnings "$source/tests/bits/run-wasm.mjs" "$made/$name.wasm" >"$made/$name.out" 2>&1 \
        || echo "exit status $?" >>"$made/$name.out"
}
if has clang && has wasm-ld && has node && [ -d /usr/lib/wasm32-wasi ]; then
    ways="$ways wasm wasm-simd"
    wasm wasm &
    wasm wasm-simd -msimd128 &
else
    skip wasm "needs clang, lld, wasi-libc and node"
fi
wait

first=
for way in $ways; do
    if [ -z "$first" ]; then
        first=$way
        cat "$made/$way.out"
        if grep -q 'refused\|differ\|exit status\|could not' "$made/$way.out"; then
            failed=$((failed + 1))
        else
            passed=$((passed + 1))
        fi
    elif cmp -s "$made/$first.out" "$made/$way.out"; then
        echo "$way: the same bits as $first"
        passed=$((passed + 1))
    else
        echo "$way: DIFFERENT from $first"
        diff "$made/$first.out" "$made/$way.out" | grep "^[<>]" | sed -n 1,8p
        failed=$((failed + 1))
    fi
done
[ -z "$first" ] && { echo "0 passed, 0 failed"; exit 77; }
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
