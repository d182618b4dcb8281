/* calls.h - one loop per function, single and batch; read once per precision
 *
 * What is defined before reading: REAL, VEC3, S(name) (the library's name in this precision, single),
 * B(name) (batch), F(name) (our own name); WALKS for the walks too. */

typedef struct F(setup) {
    F(asp_ndf_type) ndf;
    F(asp_material_type) material;
    REAL *wi[3], *wo[3], *m[3], *u1, *u2, *out[8];
} F(setup);

#define AT(a, i) (VEC3){ (a)[0][i], (a)[1][i], (a)[2][i] }
#define IN(a) { (a)[0], (a)[1], (a)[2] }

#define SINGLE(name, body) \
    static void F(name##_single)(const void *context) \
    { \
        const F(setup) *s = context; \
        size_t i; \
        for (i = 0; i < COUNT; i++) { body } \
    }

SINGLE(D, s->out[0][i] = S(asp_D)(&s->ndf, AT(s->m, i));)
SINGLE(sigma, s->out[0][i] = S(asp_sigma)(&s->ndf, AT(s->wi, i));)
SINGLE(G1, s->out[0][i] = S(asp_G1)(&s->ndf, AT(s->wi, i), 0);)
SINGLE(visible, VEC3 v = S(asp_sample_visible)(&s->ndf, AT(s->wi, i), s->u1[i], s->u2[i]);
       s->out[0][i] = v.x; s->out[1][i] = v.y; s->out[2][i] = v.z;)
SINGLE(normal, VEC3 v = S(asp_sample_normal)(&s->ndf, s->u1[i], s->u2[i]);
       s->out[0][i] = v.x; s->out[1][i] = v.y; s->out[2][i] = v.z;)
SINGLE(eval, F(asp_rgb_type) v = S(asp_eval)(&s->material, AT(s->wi, i), AT(s->wo, i));
       s->out[0][i] = v.r; s->out[1][i] = v.g; s->out[2][i] = v.b;)
SINGLE(pdf, s->out[0][i] = S(asp_pdf)(&s->material, AT(s->wi, i), AT(s->wo, i));)
SINGLE(sample, F(asp_sample_type) v = S(asp_sample)(&s->material, AT(s->wi, i), s->u1[i], s->u2[i]);
       s->out[0][i] = v.wo.x; s->out[1][i] = v.wo.y; s->out[2][i] = v.wo.z; s->out[3][i] = v.pdf;
       s->out[4][i] = v.weight.r; s->out[5][i] = v.weight.g; s->out[6][i] = v.weight.b;)

#ifdef WALKS
SINGLE(walk_eval, F(asp_rgb_type) v = S(asp_walk_eval_cos)(&s->material, AT(s->wi, i), AT(s->wo, i), next, NULL);
       s->out[0][i] = v.r; s->out[1][i] = v.g; s->out[2][i] = v.b;)
SINGLE(walk_sample, F(asp_sample_type) v = S(asp_walk_sample)(&s->material, AT(s->wi, i), next, NULL);
       s->out[0][i] = v.wo.x; s->out[1][i] = v.wo.y; s->out[2][i] = v.wo.z; s->out[3][i] = v.pdf;
       s->out[4][i] = v.weight.r; s->out[5][i] = v.weight.g; s->out[6][i] = v.weight.b;)
#endif

#define BATCH(name, body) \
    static void F(name##_batch)(const void *context) \
    { \
        const F(setup) *s = context; \
        F(asp_in_type) wi = IN(s->wi), wo = IN(s->wo), m = IN(s->m); \
        F(asp_out_type) out = IN(s->out); \
        F(asp_rgbs_type) rgb = IN(s->out + 4); \
        (void)wi, (void)wo, (void)m, (void)out, (void)rgb; \
        body \
    }

BATCH(D, B(asp_D)(&s->ndf, COUNT, m, s->out[0]);)
BATCH(sigma, B(asp_sigma)(&s->ndf, COUNT, wi, s->out[0]);)
BATCH(G1, B(asp_G1)(&s->ndf, COUNT, wi, 0, s->out[0]);)
BATCH(visible, B(asp_sample_visible)(&s->ndf, COUNT, wi, s->u1, s->u2, out);)
BATCH(normal, B(asp_sample_normal)(&s->ndf, COUNT, s->u1, s->u2, out);)
BATCH(eval, B(asp_eval)(&s->material, COUNT, wi, wo, rgb);)
BATCH(pdf, B(asp_pdf)(&s->material, COUNT, wi, wo, s->out[0]);)
BATCH(sample, B(asp_sample)(&s->material, COUNT, wi, s->u1, s->u2, out, s->out[3], rgb);)
#ifdef WALKS
BATCH(walk_eval, B(asp_walk_eval_cos)(&s->material, COUNT, wi, wo, next, NULL, 0, rgb);)
BATCH(walk_sample, B(asp_walk_sample)(&s->material, COUNT, wi, next, NULL, 0, out, s->out[3], rgb);)

static run_function *const F(walk_calls)[2][2] = {
    { F(walk_eval_single), F(walk_eval_batch) }, { F(walk_sample_single), F(walk_sample_batch) },
};
#undef WALKS
#endif

static run_function *const F(calls)[FUNCTIONS][2] = {
    { F(D_single), F(D_batch) },             { F(sigma_single), F(sigma_batch) },
    { F(G1_single), F(G1_batch) },           { F(visible_single), F(visible_batch) },
    { F(normal_single), F(normal_batch) },   { F(eval_single), F(eval_batch) },
    { F(pdf_single), F(pdf_batch) },         { F(sample_single), F(sample_batch) },
};

#undef AT
#undef IN
#undef SINGLE
#undef BATCH
#undef REAL
#undef VEC3
#undef S
#undef B
#undef F
