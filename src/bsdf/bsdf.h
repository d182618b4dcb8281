/* bsdf.h - what a scattering model is: a pure function of D, sigma_i, sigma_o, cosines and F
 *
 * A model is one file in src/bsdf, read twice like a distribution, and a row in bsdfs.def. */
#ifndef ASPI_BSDF_H
#define ASPI_BSDF_H

#include "asperity_ndf.h"
#include "bsdf/spec.h"

/* Which Fresnel term; its colours are material.c and material.d. */
enum {
    ASPI_FRESNEL_ONE,          /* 1 */
    ASPI_FRESNEL_CONDUCTOR,    /* c = eta, d = k */
    ASPI_FRESNEL_METAL,        /* the same, all of them within [0.01, 100] */
    ASPI_FRESNEL_F82,          /* c = f0, d = tint */
    ASPI_FRESNEL_DIELECTRIC,   /* c.r = eta */
    ASPI_FRESNEL_FILM          /* a table in energy, from ENERGY_FILM on (bsdf/energy.h) */
};

/* What a facet does with light. */
enum {
    ASPI_FACETS_NONE,          /* unknown, or more than facets: no walk */
    ASPI_FACETS_REFLECT,       /* a mirror of the Fresnel term */
    ASPI_FACETS_REFRACT,       /* a dielectric of index c.r */
    ASPI_FACETS_DIFFUSE        /* Lambert's law, albedo a */
};

typedef struct aspi_bsdf_key { const char *name, *what; } aspi_bsdf_key;

struct asp_bsdf {
    const char *name, *title, *source;
    const aspi_bsdf_key *keys;        /* ends with a NULL name */
    int mixed;                        /* 1: a cosine lobe is sampled beside the visible normals */
    int facets;                       /* what a facet does with light, for walks */
    /* Reads the model's own keys and the Fresnel term's. */
    asp_status (*parse)(aspi_spec *spec, asp_material *out, asp_error *err);
    /* Fills out->energy and derived colours, when distribution and keys are known; may be NULL. */
    asp_status (*prepare)(asp_material *out, asp_error *err);
    /* f from F and from x = D G2 / (4 cos_i cos_o), with y multiplying what does not come from
     * facets; the caller may scale x and y alike. The loop's r, g, b hold F and receive f. NULL is f = F x. */
    void (*value)(const asp_material *mat, double F_r, double F_g, double F_b, double x, double y,
                  asp_rgb *out);
    void (*valuef)(const asp_materialf *mat, float F_r, float F_g, float F_b, float x, float y,
                   asp_rgbf *out);
    void (*value_n)(const asp_material *mat, size_t n, const double *x, const double *y, double *r,
                    double *g, double *b);
    void (*value_nf)(const asp_materialf *mat, size_t n, const float *x, const float *y, float *r,
                     float *g, float *b);
    /* The share of samples spent on visible normals, from F at cos_i; used when mixed. */
    double (*share)(const asp_material *mat, const double F[3]);
    float  (*sharef)(const asp_materialf *mat, const float F[3]);
    void (*share_n)(const asp_material *mat, size_t n, const double *r, const double *g,
                    const double *b, double *share);
    void (*share_nf)(const asp_materialf *mat, size_t n, const float *r, const float *g,
                     const float *b, float *share);
    /* A model that does more than reflect brings whole calls instead of value and share, which are
     * then NULL. f cos is f times |wo.z|; u3 chooses among lobes. */
    void (*eval)(const asp_material *mat, const asp_vec3 *wi, const asp_vec3 *wo, int cosine, asp_rgb *f);
    void (*evalf)(const asp_materialf *mat, const asp_vec3f *wi, const asp_vec3f *wo, int cosine,
                  asp_rgbf *f);
    double (*pdf)(const asp_material *mat, const asp_vec3 *wi, const asp_vec3 *wo);
    float  (*pdff)(const asp_materialf *mat, const asp_vec3f *wi, const asp_vec3f *wo);
    asp_bsdf_sample (*sample)(const asp_material *mat, asp_vec3 wi, double u1, double u2, double u3);
    asp_bsdf_samplef (*samplef)(const asp_materialf *mat, asp_vec3f wi, float u1, float u2, float u3);
    /* Blocks of the same, of eval one channel, as all are alike; the outputs of samples may be inputs, and u holds
     * u1, u2, u3. They return 0 where it has to be done one by one; may be NULL. */
    int (*eval_n)(const asp_material *mat, size_t n, const double *const wi[3], const double *const wo[3], int cosine,
                  double *f);
    int (*eval_nf)(const asp_materialf *mat, size_t n, const float *const wi[3], const float *const wo[3], int cosine,
                   float *f);
    int (*pdf_n)(const asp_material *mat, size_t n, const double *const wi[3], const double *const wo[3], double *pdf);
    int (*pdf_nf)(const asp_materialf *mat, size_t n, const float *const wi[3], const float *const wo[3], float *pdf);
    int (*sample_n)(const asp_material *mat, size_t n, const double *const wi[3], const double *const u[3],
                    double *const wo[3], double *pdf, double *const weight[3]);
    int (*sample_nf)(const asp_materialf *mat, size_t n, const float *const wi[3], const float *const u[3],
                     float *const wo[3], float *pdf, float *const weight[3]);
};

/* Does it know the key `name`? */
int aspi_bsdf_has(const asp_bsdf *model, const char *name);

/* Does light cross it? Then it is there from both sides. */
int aspi_bsdf_crosses(const asp_bsdf *model);

/* transport=radiance|importance into out->transport. */
asp_status aspi_parse_transport(aspi_spec *spec, asp_material *out, asp_error *err);

/* form=kulla_conty or turquin into out->b.r: how lost energy is given back. */
enum { COMPENSATED_KULLA_CONTY, COMPENSATED_TURQUIN };
asp_status aspi_parse_compensation(aspi_spec *spec, asp_material *out, asp_error *err);
#define ASPI_COMPENSATION_KEY { "form", "kulla_conty (default) or turquin" }

/* The forms of rough_diffuse, out->b.r. */
enum { ROUGH_EXACT, ROUGH_OREN_NAYAR, ROUGH_FUJII, ROUGH_EON, ROUGH_FORMS };

/* asp_film but for ranges and for the model's own tables: linear sRGB reflectance over the cosine, of a dielectric
 * over that on its less dense side. */
asp_status aspi_film(asp_material *out, double film_eta, double thickness, asp_error *err);

/* The keys film and film_eta. */
asp_status aspi_parse_film(aspi_spec *spec, asp_material *out, asp_error *err);

/* f of a dielectric but for the share F or 1 - F, the cosine at the facet, the index there and whether light crosses. */
typedef struct aspi_dielectric_part { double f, c, eta; int crosses; } aspi_dielectric_part;
aspi_dielectric_part aspi_dielectric_part_of(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);

/* The keys that name a Fresnel term: metal, eta with k, eta alone, f0 with tint. `initial` is taken
 * when none is given. */
asp_status aspi_parse_fresnel(aspi_spec *spec, double initial_eta, asp_material *out,
                              asp_error *err);
#define ASPI_FRESNEL_KEYS \
    { "metal", "a metal by name: Au, Ag, Al, Cu, ..." }, \
    { "eta", "index of refraction, interior over exterior; with k that of a conductor" }, \
    { "k", "extinction coefficient" }, \
    { "f0", "reflectance at normal incidence, Schlick's term" }, \
    { "tint", "with f0: factor at 82 degrees (F82-tint), 0 to 2, 1 = Schlick" }, \
    ASPI_FILM_KEYS
#define ASPI_FILM_KEYS \
    { "film", "thickness in nm of a thin film on it, up to 10000" }, \
    { "film_eta", "index of the film, 1 to 10, default 1.33" }

/* The keys of a dielectric; what has a transport is there from both sides. */
#define ASPI_DIELECTRIC_KEYS \
    { "eta", "index of refraction, interior over exterior, 0.01 to 100, default 1.5" }, \
    { "thin", "1: a sheet instead of a half space, default 0" }, \
    { "transport", "radiance (default) or importance: whether what crosses is scaled by 1/eta^2" }

/* The formulas of a record, in the order of struct asp_bsdf. */
#define ASPI_BSDF_NO_BLOCKS NULL, NULL, NULL, NULL, NULL, NULL
#define ASPI_BSDF_FACETS NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, \
    ASPI_BSDF_NO_BLOCKS
#define ASPI_BSDF_OPS(n) n##_value_1_64, n##_value_1_32, n##_value_n_64, n##_value_n_32, \
    n##_share_1_64, n##_share_1_32, n##_share_n_64, n##_share_n_32, NULL, NULL, NULL, NULL, NULL, NULL, \
    ASPI_BSDF_NO_BLOCKS
#define ASPI_BSDF_CALLS(n) NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, \
    n##_eval_64, n##_eval_32, n##_pdf_64, n##_pdf_32, n##_sample_64, n##_sample_32
#define ASPI_BSDF_OWN(n) ASPI_BSDF_CALLS(n), ASPI_BSDF_NO_BLOCKS
#define ASPI_BSDF_OWN_BLOCKS(n) ASPI_BSDF_CALLS(n), n##_eval_n_64, n##_eval_n_32, \
    n##_pdf_n_64, n##_pdf_n_32, n##_sample_n_64, n##_sample_n_32

#endif
