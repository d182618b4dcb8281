/* fft.c - the discrete Fourier transform in two dimensions, radix two */
#include "surface/surface.h"

#include <math.h>

/* Bit-reversed order first, then butterflies of growing length (Cooley, Tukey 1965). */
static void transform(aspi_complex *a, int n, const aspi_complex *roots)
{
    for (int i = 1, j = 0; i < n; ++i) {
        int bit = n >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j ^= bit;
        if (i < j) {
            aspi_complex t = a[i];
            a[i] = a[j];
            a[j] = t;
        }
    }
    for (int half = 1; half < n; half *= 2) {
        int stride = n / (2 * half);
        for (int start = 0; start < n; start += 2 * half)
            for (int k = 0; k < half; ++k) {
                aspi_complex w = roots[k * stride], x = a[start + k], y = a[start + k + half];
                aspi_complex t = { w.re * y.re - w.im * y.im, w.re * y.im + w.im * y.re };
                a[start + k] = (aspi_complex){ x.re + t.re, x.im + t.im };
                a[start + k + half] = (aspi_complex){ x.re - t.re, x.im - t.im };
            }
    }
}

static void transpose(aspi_complex *data, int n)
{
    enum { TILE = 16 };
    for (int by = 0; by < n; by += TILE)
        for (int bx = by; bx < n; bx += TILE)
            for (int y = by; y < by + TILE && y < n; ++y)
                for (int x = bx > y ? bx : y + 1; x < bx + TILE && x < n; ++x) {
                    size_t i = (size_t)y * (size_t)n + (size_t)x;
                    size_t j = (size_t)x * (size_t)n + (size_t)y;
                    aspi_complex t = data[i];
                    data[i] = data[j];
                    data[j] = t;
                }
}

void aspi_fft2(aspi_complex *data, int n, aspi_complex *roots)
{
    for (int k = 0; k < n / 2; ++k) {
        double angle = 2 * ASPI_PI * k / n;
        roots[k] = (aspi_complex){ cos(angle), sin(angle) };
    }
    for (int row = 0; row < n; ++row)
        transform(data + (size_t)row * (size_t)n, n, roots);
    transpose(data, n);
    for (int row = 0; row < n; ++row)
        transform(data + (size_t)row * (size_t)n, n, roots);
}
