#!/bin/sh
# Prints src/asperity_core.c: the core as one file for `cc`, from what is in the folders.
cd "$(dirname "$0")/../src" || exit 1
cat <<'END'
/* asperity_core.c - the whole core as one translation unit: cc -O2 -Iinclude -Isrc -c src/asperity_core.c
 *
 * Written by scripts/single-file.sh (make docs). Add -fno-math-errno -fno-trapping-math
 * -ffp-contract=off -O3 to get the speed and the bits of the library. */
END
for f in core/*.c bsdf/*.c ndf/*.c; do
    printf '#include "%s"\n#undef ASP_PRECISION\n' "$f"
done
