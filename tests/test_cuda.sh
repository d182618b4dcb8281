#!/bin/sh
# The kernels as CUDA: host and device sides compile, and the device code has neither fused products
# nor approximate divisions and roots, so that it gives the host's bits. No GPU and no toolkit needed.
set -eu
cd "$1"
command -v clang >/dev/null || { echo "skipped: clang is not installed"; exit 77; }
clang --print-targets | grep -q nvptx64 || { echo "skipped: this clang has no NVPTX target"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0
ok() { passed=$((passed + 1)); echo "ok: $*"; }
fail() { echo "FAILED: $*"; echo "$passed passed, 1 failed"; exit 1; }

# planar surfaces take vectors and live in the host's memory
grep -L 'define ASP_NDF_PLANAR' src/ndf/*.c | xargs sed -n 's/^#define ASP_NDF \([a-z_0-9]*\)$/KERNEL(\1)/p' \
    >"$scratch/cuda_kernels.list"
kernels=$(wc -l <"$scratch/cuda_kernels.list")
[ "$kernels" -ge 3 ] || fail "only $kernels standard surfaces found"
flags="-x cuda -nocudainc -nocudalib --cuda-gpu-arch=sm_70 -std=c++17 -O2 -Wall -Wextra -Werror
    -Wno-unused-function -ffp-contract=off -fno-math-errno -Iinclude -Isrc -I$scratch"
for side in host device; do
    # shellcheck disable=SC2086
    clang $flags --cuda-$side-only -S -o "$scratch/$side.s" tests/cuda_kernels.cu || fail "$side"
    ok "$side side of $kernels standard surfaces, both precisions"
done
entries=$(grep -c '\.entry' "$scratch/device.s")
[ "$entries" -eq $((2 * kernels)) ] || fail "$entries kernels in the device code"
ok "$entries kernels in the device code"
if grep -nE '\b(fma|mad)\.(rn|rz|f)|div\.(approx|full)|sqrt\.approx|\.ftz' "$scratch/device.s"; then
    fail "device code rounds differently from the host's"
fi
grep -q 'div\.rn\.f32' "$scratch/device.s" && grep -q 'sqrt\.rn\.f64' "$scratch/device.s" ||
    fail "no exactly rounded divisions and roots found: was anything compiled?"
ok "every product, division and root is rounded by itself"
echo "$passed passed, 0 failed"
