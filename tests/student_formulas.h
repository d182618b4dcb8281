/* student_formulas.h - the formulas of student_t, beckmann and ggx themselves, before the slope map */
#ifndef STUDENT_FORMULAS_H
#define STUDENT_FORMULAS_H

#define asp_model_student_t formulas_student_t
#define asp_model_phong formulas_phong
#define asp_model_hyper_cauchy formulas_hyper_cauchy
#define asp_model_student_t_general formulas_student_t_general
#define asp_model_beckmann formulas_beckmann
#define asp_model_ggx formulas_ggx
#define asp_model_ellipsoid formulas_ellipsoid
#include "ndf/student_t.c"
#undef ASP_PRECISION
#include "ndf/beckmann.c"
#undef ASP_PRECISION
#include "ndf/ggx.c"
#undef ASP_PRECISION

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
    static const formulas of_##name = { &formulas_##name, name##_d, name##_s, name##_df, name##_sf };
FORMULAS(student_t)
FORMULAS(beckmann)
FORMULAS(ggx)

#endif
