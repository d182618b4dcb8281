#!/bin/sh
# test_bits.sh SOURCE BUILD - the same bits from every compiler, instruction set and WASM
set -u
exec sh "$1/tests/bits/run.sh" "$1" "$2/tests"
