/* student_formulas.h - the formulas of student_t, beckmann and ggx themselves, before the slope map
 *
 * What goes through the map, single or in loops, is the library's. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/student.h"

extern const asp_model asp_model_student_t, asp_model_beckmann, asp_model_ggx;

typedef struct formulas {
    const asp_model *ops;
    double (*density)(const asp_ndf *k, double r2, double z2);
    double (*sigma)(const asp_ndf *k, double w, double s2);
    float (*density_f)(const asp_ndff *k, float r2, float z2);
    float (*sigma_f)(const asp_ndff *k, float w, float s2);
} formulas;

#define FORMULAS(name) \
    static double name##_d(const asp_ndf *k, double r2, double z2) { return name##_density_64(k, r2, z2); } \
    static double name##_s(const asp_ndf *k, double w, double s2) { return name##_sigma_64(k, w, s2); } \
    static float name##_df(const asp_ndff *k, float r2, float z2) { return name##_density_32(k, r2, z2); } \
    static float name##_sf(const asp_ndff *k, float w, float s2) { return name##_sigma_32(k, w, s2); } \
    static const formulas of_##name = { &asp_model_##name, name##_d, name##_s, name##_df, name##_sf };

/* the loops that come with the formulas are not called */
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define ASP_NDF student_t
#define STUDENT_GAUSSIAN 0
#define ASP_PRECISION 64
#include "student_formulas.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "student_formulas.h"
#undef ASP_PRECISION
FORMULAS(student_t)
#undef STUDENT_GAUSSIAN
#undef ASP_NDF

#define ASP_NDF beckmann
#define STUDENT_GAUSSIAN 1
#define ASP_PRECISION 64
#include "student_formulas.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "student_formulas.h"
#undef ASP_PRECISION
FORMULAS(beckmann)
#undef STUDENT_GAUSSIAN
#undef ASP_NDF
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

#define asp_model_ggx formulas_ggx
#define asp_model_ellipsoid formulas_ellipsoid
#include "ndf/ggx.c"
#undef ASP_PRECISION
#undef asp_model_ggx
#undef asp_model_ellipsoid
FORMULAS(ggx)

#else
#include "asperity/elementary.h"
#undef ASP_CLONES
#define ASP_CLONES
#include "ndf/student_kernel.h"
#undef ASP_OWN_DENSITY_N
#undef ASP_OWN_SIGMA_N
#undef ASP_OWN_VISIBLE_N
#undef ASP_OWN_NORMAL_N
#endif
