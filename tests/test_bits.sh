#!/bin/sh
# test_bits.sh SOURCE BUILD - the same bits from every compiler, instruction set and WASM. ASPERITY_SANITIZED is the
# folder of a build with sanitizers, if there is one as new as this.
set -u
exec sh "$1/tests/bits/run.sh" "$1" "$2/tests/objects" "$2/libasperity.a" "${ASPERITY_SANITIZED:+$ASPERITY_SANITIZED/libasperity.a}"
