#!/bin/sh
# Feeds mutated files to the readers.
#
# usage: scripts/fuzz.sh [SECONDS [NAME...]]
#
# Builds the data library with clang's sanitizers in build-fuzz/, then runs every tests/fuzz/fuzz_NAME.c
# (or the ones named) for SECONDS (default 60) each, starting from tests/fuzz/corpus/NAME. What is
# found on the way stays in build-fuzz/found/NAME; an input that breaks a promise is written to
# build-fuzz/NAME-* and the exit status is 1.
# Last line: N passed, N failed.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-60}
case $seconds in
    ''|*[!0-9]*) echo "usage: scripts/fuzz.sh [SECONDS [NAME...]]" >&2; exit 2 ;;
esac
[ $# -eq 0 ] || shift
build=${BUILD_FUZZ:-build-fuzz}
clang=${CLANG:-clang}
command -v "$clang" >/dev/null || { echo "fuzz.sh: clang is needed (apt-get install clang libclang-rt-14-dev)" >&2; exit 1; }

cmake -S . -B "$build" -G Ninja -DCMAKE_C_COMPILER="$clang" -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_C_FLAGS_DEBUG='-O1 -g' -DASPERITY_TESTS=OFF -DASPERITY_WERROR=OFF \
    -DASPERITY_SANITIZE=fuzzer-no-link,address,undefined >"$build.log" || { cat "$build.log"; exit 1; }
rm -f "$build.log"
cmake --build "$build" --target asperity_data -j "${JOBS:-2}"
libraries="$build/libasperity_data.a $build/libasperity.a $(pkg-config --libs jansson cminpack) -lembree3 -lpthread -lm"

if [ $# -eq 0 ]; then
    for source in tests/fuzz/fuzz_*.c; do
        name=${source##*/fuzz_}
        set -- "$@" "${name%.c}"
    done
fi

passed=0 failed=0
for name in "$@"; do
    mkdir -p "$build/found/$name" "tests/fuzz/corpus/$name"
    # shellcheck disable=SC2086
    "$clang" -std=c11 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all \
        -Iinclude -Isrc "tests/fuzz/fuzz_$name.c" $libraries -o "$build/fuzz_$name"
    dictionary=
    [ ! -f "tests/fuzz/$name.dict" ] || dictionary="-dict=tests/fuzz/$name.dict"
    # shellcheck disable=SC2086
    if "$build/fuzz_$name" -max_total_time="$seconds" -max_len="${MAX_LEN:-4096}" -timeout=5 \
        -rss_limit_mb=1024 -print_final_stats=1 -verbosity=0 -artifact_prefix="$build/$name-" \
        $dictionary "$build/found/$name" "tests/fuzz/corpus/$name" >"$build/$name.log" 2>&1; then
        runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$name.log")
        echo "$name: ${runs:-?} inputs in $seconds s"
        passed=$((passed + 1))
    else
        tail -n 40 "$build/$name.log"
        echo "$name: FAILED"
        failed=$((failed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
