#!/bin/sh
# Installs the packages that are missing:  scripts/install-deps.sh run|test
#
#   run   what building the libraries and the command needs
#   test  in addition what the tests use: a second compiler, sanitizers, WebAssembly, scripts
#
# Asks what is there by trying it, so that anything already installed by other means is left alone.
# Debian 12's apt-get is used when this is root or can become root; otherwise the one line to type is
# printed and the exit status is 1.
set -eu
what=${1:-run}
case $what in run | test) ;; *) echo "usage: $0 run|test" >&2; exit 2 ;; esac

missing=
command_of() { command -v "$1" >/dev/null 2>&1 || missing="$missing $2"; }
library_of() { pkg-config --exists "$1" 2>/dev/null || missing="$missing $2"; }
file_of() { # file_of package pattern...
    package=$1
    shift
    for f in "$@"; do [ -e "$f" ] && return 0; done
    missing="$missing $package"
}

command_of gcc gcc
command_of cmake cmake
command_of ninja ninja-build
command_of pkg-config pkg-config
echo 'int main(void) { return 0; }' | gcc -x c -o /dev/null - 2>/dev/null || missing="$missing libc6-dev"
library_of jansson libjansson-dev
library_of libpng libpng-dev
library_of OpenEXR libopenexr-dev
library_of cminpack libcminpack-dev
file_of libembree-dev /usr/lib*/cmake/embree-3*/embree-config.cmake \
    /usr/lib/*/cmake/embree-3*/embree-config.cmake \
    /usr/local/lib*/cmake/embree-3*/embree-config.cmake

if [ "$what" = test ]; then
    command_of git git
    command_of g++ g++
    command_of clang clang
    command_of wasm-ld lld
    command_of node nodejs
    command_of python3 python3
    file_of wasi-libc /usr/include/wasm32-wasi/stdio.h
    file_of libclang-rt-14-dev /usr/lib/llvm-14/lib/clang/14*/lib/linux/libclang_rt.fuzzer-*.a
    file_of libclang-rt-14-dev-wasm32 \
        /usr/lib/llvm-14/lib/clang/14*/lib/wasi/libclang_rt.builtins-wasm32.a
fi

# Of use but not needed: without it `asperity figures` writes SVG and numbers, no PNG.
optional=
pkg-config --exists librsvg-2.0 2>/dev/null || optional=librsvg2-dev

# install RETRIES PACKAGE...: 1, and the line to type, where it cannot be done
install() {
    retries=$1
    shift
    line="apt-get install -y --no-install-recommends $*"
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "Missing (names of Debian 12): $*" >&2
        return 1
    fi
    if [ "$(id -u)" = 0 ]; then
        become=
    elif command -v sudo >/dev/null 2>&1 && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
        become=sudo
    else
        echo "Some packages are missing. As root, type:" >&2
        echo "    apt-get update && $line" >&2
        return 1
    fi
    echo "Installing: $*"
    if ! { $become env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries="$retries" update &&
        $become env DEBIAN_FRONTEND=noninteractive $line; } >"$log" 2>&1 </dev/null; then
        [ "$retries" = 0 ] || cat "$log" >&2
        echo "install-deps.sh: apt-get failed; by hand: apt-get update && $line" >&2
        return 1
    fi
}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# shellcheck disable=SC2086
[ -z "$missing" ] || install 3 $missing || exit 1
[ -z "$optional" ] || install 0 $optional ||
    echo "Going on without $optional: \`asperity figures\` will write no PNG" >&2
