#!/bin/sh
# Prints src/asperity_core.c: the core as one file for `cc`, from what is in the folders.
cd "$(dirname "$0")/../src" || exit 1
cat <<'END'
/* asperity_core.c - the whole core as one translation unit: cc -O2 -Iinclude -Isrc -c src/asperity_core.c
 *
 * Written by scripts/single-file.sh (make docs). Whatever the command line says, products and sums are
 * rounded one by one, so that the bits are the library's; -O3 gives its speed. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-math-errno", "no-trapping-math")
#endif

END
for f in core/*.c bsdf/*.c ndf/*.c; do
    printf '#include "%s"\n#undef ASP_PRECISION\n' "$f"
done
