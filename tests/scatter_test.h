/* scatter_test.h - counting checks, directions and materials from text, for tests of scattering */
#ifndef SCATTER_TEST_H
#define SCATTER_TEST_H

#include "asperity.h"
#include "splitmix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

static int passed, failed;

static inline void expect(int ok, const char *what, double worst)
{
    printf("%s %s: %.3g\n", ok ? "ok    " : "FAILED", what, worst);
    passed += ok != 0;
    failed += ok == 0;
}

static inline int finish(void)
{
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}

static inline void refused(const char *spec, const asp_error *err)
{
    printf("FAILED %s: %s %s\n", spec, err->name, err->reason);
    failed++;
    exit(finish());
}

static inline asp_material material(const char *spec)
{
    asp_material mat;
    asp_error err;
    if (asp_material_parse(NULL, spec, &mat, &err) != ASP_OK)
        refused(spec, &err);
    return mat;
}

static inline asp_ndf ndf(const char *spec)
{
    asp_ndf k;
    asp_error err;
    if (asp_ndf_parse(NULL, spec, &k, &err) != ASP_OK)
        refused(spec, &err);
    return k;
}

static inline asp_vec3 direction(double theta, double phi)
{
    return (asp_vec3){ sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta) };
}

static inline double dot(asp_vec3 a, asp_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

#endif
