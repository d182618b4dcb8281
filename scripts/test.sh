#!/bin/sh
# Builds twice, runs every test in both builds, and prints as its last line
#     N passed, N failed, N skipped
# Exit status 1 when a test failed, or, with CI=true, when one was skipped.
set -eu
cd "$(dirname "$0")/.."
shipped=${BUILD:-build}
unset ASPERITY_SANITIZED
jobs=$(getconf _NPROCESSORS_ONLN)
export CTEST_OUTPUT_ON_FAILURE=1
export ASPERITY_SHARED="${ASPERITY_SHARED:-../shared}"
case $ASPERITY_SHARED in /*) ;; *) ASPERITY_SHARED=$(pwd)/$ASPERITY_SHARED ;; esac

passed=0 failed=0 skipped=0 status=0
number() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1; }

# build FOLDER CMAKE-ARGUMENT...
build() {
    dir=$1
    shift
    echo "== $dir: $*"
    cmake -S . -B "$dir" -G Ninja -DASPERITY_TESTS=ON "$@" >"$dir.log" || {
        cat "$dir.log"; rm -f "$dir.log"; status=1; failed=$((failed + 1)); return 1; }
    rm -f "$dir.log"
    cmake --build "$dir" -j "$jobs" || { status=1; failed=$((failed + 1)); return 1; }
}

# suite FOLDER
suite() {
    dir=$1
    echo "== $dir: tests"
    ctest --test-dir "$dir" -j "$jobs" --no-tests=error --output-junit results.xml || status=1
    xml=$dir/results.xml
    tests=$(number tests "$xml") f=$(number failures "$xml") s=$(number skipped "$xml")
    d=$(number disabled "$xml")
    passed=$((passed + tests - f - s - d)) failed=$((failed + f)) skipped=$((skipped + s + d))
}

# -O1 keeps the instrumented tests within minutes; assertions of the compilers stay on
if build "$shipped-sanitize" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG='-O1 -g' \
    -DASPERITY_SANITIZE=address,undefined; then
    ASPERITY_SANITIZED=$(cd "$shipped-sanitize" && pwd)
    export ASPERITY_SANITIZED
fi
if build "$shipped" -DCMAKE_BUILD_TYPE=Release; then
    suite "$shipped"
fi
if [ -n "${ASPERITY_SANITIZED:-}" ]; then
    suite "$shipped-sanitize"
fi

if [ "${CI:-}" = true ] && [ "$skipped" -gt 0 ]; then
    echo "CI runs with everything in place: a skipped test is a failure."
    status=1
fi
[ "$failed" -eq 0 ] || status=1
echo "$passed passed, $failed failed, $skipped skipped"
exit $status
