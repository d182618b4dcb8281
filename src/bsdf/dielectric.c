/* dielectric.c - rough dielectrics: reflection and refraction by the facets, from both sides
 *
 * Walter et al. 2007, section 5; eq. 7 of the Ellipsoid NDF paper is its sign function. Seen from
 * inside everything is turned round by a point reflection: directions change sign, the index becomes its
 * inverse, and the same formulas serve. Walter's eq. 22 gives F for both ways, total reflection too.
 *
 * `thin` is a sheet of the material whose lower face is the mirror image of the upper one: from below only
 * heights change sign. With the reflections inside summed up R = 2F/(1 + F), and what passes leaves in the
 * mirror image of the reflected direction in the sheet. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_NDF dielectric
#define ASP_PRECISION 64
#include "dielectric.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "dielectric.c"
#undef ASP_PRECISION
#undef ASP_NDF

static asp_status dielectric_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    double eta = 1.5, thin = 0.0;
    asp_status s = aspi_spec_ranged(spec, "eta", 0.01, 0, 100.0, &eta, NULL, err);
    if (!s)
        s = aspi_spec_number(spec, "thin", &thin, NULL, err);
    if (!s && thin != 0.0 && thin != 1.0) {
        asp_fail_range(err, "thin", thin, 0, 0, 1);
        s = aspi_spec_blame(spec, "thin", ASP_EINVAL, err);
    }
    if (!s)
        s = aspi_parse_transport(spec, out, err);
    out->fresnel = ASPI_FRESNEL_DIELECTRIC;
    out->c.r = out->c.g = out->c.b = eta;
    out->a.r = out->a.g = out->a.b = thin;
    return s;
}

static const aspi_bsdf_key dielectric_keys[] = { ASPI_DIELECTRIC_KEYS, { NULL, NULL } };

ASP_RECORD asp_bsdf asp_bsdf_dielectric = {
    "dielectric", "Rough dielectric", "Walter et al. 2007, eqs. 20-21", dielectric_keys, 0,
    ASPI_FACETS_REFRACT, dielectric_parse, NULL, ASPI_BSDF_OWN_BLOCKS(dielectric)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/ops.h"
#include "bsdf/reflection.h"
#include "bsdf/refraction.h"

#ifndef DIELECTRIC_NAMES
#define DIELECTRIC_NAMES
#define case_of ASP_NDF_NAME(_case)
#define make_case ASP_NDF_NAME(_make)
#define refracted_masking ASP_NDF_NAME(_refracted_masking)
#define stirling ASP_NDF_NAME(_stirling)
#define beta ASP_NDF_NAME(_beta)
#define near_terms ASP_NDF_NAME(_near_terms)
#define near_series ASP_NDF_NAME(_near_series)
#define beta_near ASP_NDF_NAME(_beta_near)
#define beta_near_1 ASP_NDF_NAME(_beta_near_1)
#define is_near ASP_NDF_NAME(_is_near)
#define sheet ASP_NDF_NAME(_sheet)
#define area_over ASP_NDF_NAME(_area_over)
#define inverse_of ASP_NDF_NAME(_inverse_of)
#define lengthened ASP_NDF_NAME(_lengthened)
#define joint_reflected ASP_NDF_NAME(_joint_reflected)
#define facet_density ASP_NDF_NAME(_facet_density)
#define index_of ASP_NDF_NAME(_index_of)
#define sample_as ASP_NDF_NAME(_sample_as)
#define sample_thin ASP_NDF_NAME(_sample_thin)
#define nothing_of ASP_NDF_NAME(_nothing_of)
#define crossing_scale ASP_NDF_NAME(_crossing_scale)
#define crossing_weight ASP_NDF_NAME(_crossing_weight)
#define staying_weight ASP_NDF_NAME(_staying_weight)
#define beta_n ASP_NDF_NAME(_beta_n)
#endif

/* A pair of directions with wi above: which facet joins them, and F there. */
typedef struct case_of {
    asp_v3 wi, wo, m;
    asp_real eta, c, wm, F;      /* wi.m, wo.m */
    asp_real sigma_i;
    int refracts, dark;
} case_of;

/* F with the reflections inside a sheet summed up. */
ASP_FN asp_real sheet(asp_real F, int thin) { return thin ? R(2.0) * F / (R(1.0) + F) : F; }

ASP_FN case_of make_case(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    int thin = mat->a.r > R(0.0);
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0);
    case_of k;
    k.eta = sign < R(0.0) && !thin ? R(1.0) / mat->c.r : mat->c.r;
    k.wi = aspi_turned(wi, sign, thin);
    k.wo = aspi_turned(wo, sign, thin);
    k.refracts = k.wo.z < R(0.0);
    if (thin && k.refracts) {
        k.wo.z = -k.wo.z;
        k.m = aspi_half_vector(k.wi, k.wo);
    } else {
        k.m = k.refracts ? aspi_bent_half(k.wi, k.wo, k.eta) : aspi_half_vector(k.wi, k.wo);
    }
    k.c = aspi_dot(k.wi, k.m);
    k.wm = aspi_dot(k.wo, k.m);
    k.F = sheet(aspi_fresnel_dielectric(k.c, k.eta), thin);
    k.dark = !(k.c > R(0.0) && k.m.z > ASP_FLAT && k.wi.z > R(0.0) && k.wo.z != R(0.0))
          || mat->c.r == R(1.0);
    k.sigma_i = aspi_sigma_of(&mat->ndf, k.wi);
    return k;
}

/* Stirling's series, the logarithm of Gamma(z) over sqrt(2 pi/z) (z/e)^z, from 1/z; z is at least 3 in
 * float32, 9 in float64. */
#define BETA_STEPS (ASP_PRECISION == 64 ? 8 : 2)
ASP_FN asp_real stirling(asp_real i)
{
    asp_real i2 = i * i, s = R(-1.0 / 1680.0);
#if ASP_PRECISION == 64
    s = R(1.0 / 1188.0) + i2 * (R(-691.0 / 360360.0) + i2 * R(1.0 / 156.0));
    s = R(-1.0 / 1680.0) + i2 * s;
#endif
    s = R(1.0 / 1260.0) + i2 * s;
    s = R(-1.0 / 360.0) + i2 * s;
    return i * (R(1.0 / 12.0) + i2 * s);
}

/* Euler's B(a, b), a and b at least 1: brought to a + n, b + n by the recurrence. With x = B/A <= 1 the power is
 * exp(-((A + B) log(1 + x) - B log x)), whose error by that of x vanishes. Relative error 1e-11 and 5e-7 per
 * 1 + |ln B|; float32 answers 0 below about 1e-20. */
ASP_FN asp_real beta(asp_real p, asp_real q)
{
    asp_real a = aspi_max(p, q), b = aspi_min(p, q);
    int low = a + b < R(1e6);
    asp_real over = R(1.0), under = R(1.0), A, B, S, one, x, e;
    int i;
    a = low ? a : R(1.0);
    b = low ? b : R(1.0);
    A = a + R(BETA_STEPS);
    B = b + R(BETA_STEPS);
    S = A + B;
    for (i = 0; i < BETA_STEPS; i++) {
        asp_real s = (a + b) + R(2 * i);
        over = over * (s * (s + R(1.0)));
        under = under * ((a + R(i)) * (b + R(i)));
    }
    one = R(1.0) / (A * B * S);
    x = B * (B * S * one);
    e = (stirling(B * S * one) + stirling(A * S * one) - stirling(A * B * one))
      - (S * aspi_log1p(x) - B * aspi_log(x));
    x = over / under * aspi_sqrt(R(2.0 * ASP_PI) * (S * S * one)) * aspi_exp(e);
    return low ? x : R(0.0);
}

/* The same for a and b within [1, 2], float32: Gamma(a) and Gamma(b) and 1/Gamma(a + b) as polynomials
 * (scripts/series.py), relative error 4e-7. */
ASP_FN int is_near(asp_real a, asp_real b) { return ASP_PRECISION == 32 && aspi_max(a, b) <= R(2.0); }

/* Of each power the coefficients of Gamma(3/2 + t), twice, and of 1/Gamma(3 + t). */
static const asp_real near_terms[10][4] = {
    { R(0.8862269557), R(0.8862269557), R(0.4999999876), R(0.0) },
    { R(0.03233828362), R(0.03233828362), R(-0.4613921502), R(0.0) },
    { R(0.4148074728), R(0.4148074728), R(0.1141498354), R(0.0) },
    { R(-0.1072858207), R(-0.1072858207), R(0.03847059524), R(0.0) },
    { R(0.1448331843), R(0.1448331843), R(-0.03151665695), R(0.0) },
    { R(-0.07772028495), R(-0.07772028495), R(0.006935187604), R(0.0) },
    { R(0.05657111942), R(0.05657111942), R(0.0005587637258), R(0.0) },
    { R(-0.03625772053), R(-0.03625772053), R(-0.0006791526744), R(0.0) },
    { R(0.03459742257), R(0.03459742257), R(0.0001414160983), R(0.0) },
    { R(-0.02374981865), R(-0.02374981865), R(-1.148210216e-6), R(0.0) }
};

/* c[0] + c[1] t + ... + c[9] t^9, numbers or several at once. */
#define NEAR_SERIES(t, t2, t4, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9) \
    (((c0 + c1 * t) + (c2 + c3 * t) * t2) + ((c4 + c5 * t) + (c6 + c7 * t) * t2) * t4 + (c8 + c9 * t) * (t4 * t4))
#define NEAR_SERIES_OF(t, t2, t4, c) NEAR_SERIES(t, t2, t4, c(0), c(1), c(2), c(3), c(4), c(5), c(6), c(7), c(8), c(9))

ASP_FN asp_real near_series(asp_real t, int j)
{
    asp_real t2 = t * t, t4 = t2 * t2;
#define NEAR_TERM(i) near_terms[i][j]
    return NEAR_SERIES_OF(t, t2, t4, NEAR_TERM);
#undef NEAR_TERM
}

ASP_FN asp_real beta_near(asp_real a, asp_real b)
{
    return near_series(a - R(1.5), 0) * near_series(b - R(1.5), 1) * near_series(a + b - R(3.0), 2);
}

/* The same for a single pair, the three side by side. */
ASP_FN asp_real beta_near_1(asp_real a, asp_real b)
{
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__CUDA__)
    typedef asp_real four __attribute__((vector_size(4 * sizeof(asp_real))));
    four t = { a - R(1.5), b - R(1.5), a + b - R(3.0), R(0.0) }, t2 = t * t, t4 = t2 * t2, c[10];
    memcpy(c, near_terms, sizeof c);
#define NEAR_TERM(i) c[i]
    t = NEAR_SERIES_OF(t, t2, t4, NEAR_TERM);
#undef NEAR_TERM
    return t[0] * t[1] * t[2];
#else
    return beta_near(a, b);
#endif
}

ASP_FN asp_real inverse_of(asp_real cosine) { return R(1.0) / aspi_max(cosine, ASP_TINY); }

/* Masked area over cosine, 1 + Lambda, of a direction above. */
ASP_FN asp_real area_over(const asp_shape *shape, asp_v3 w, asp_real sigma, asp_real inverse, int mask)
{
    return aspi_masked(shape, w, sigma, mask) * inverse;
}

/* G2 of light that crosses, from 1 + Lambda of both sides. Heitz 2014, sec. 5.4 (after Dupuy): B(1 + Lambda_i,
 * 1 + Lambda_o). V-cavities, from the cosines: what both sides leave of a groove, G1 + G1 - 1. */
ASP_FN asp_real refracted_masking(asp_real a, asp_real b, asp_real mz, asp_real ci, asp_real co, asp_real c_i,
                                  asp_real c_o, int mask)
{
    if ((mask & 15) == ASP_MASK_UNCORRELATED)
        return R(1.0) / (a * b);
    if ((mask & 15) == ASP_MASK_V_CAVITY) {
        asp_real open_i = aspi_min(R(1.0), R(2.0) * mz * ci / aspi_max(c_i, ASP_SMALLEST));
        asp_real open_o = aspi_min(R(1.0), R(2.0) * mz * co / aspi_max(c_o, ASP_SMALLEST));
        return aspi_max(open_i + open_o - R(1.0), R(0.0));
    }
    return is_near(a, b) ? beta_near_1(a, b) : beta(a, b);
}

/* G2 / (ci co) of a reflection. */
ASP_FN asp_real joint_reflected(const asp_shape *shape, asp_v3 wi, asp_v3 wo, asp_real sigma_i, asp_real sigma_o,
                                asp_real mz, asp_real c, int mask)
{
    asp_real si = aspi_masked(shape, wi, sigma_i, mask), so = aspi_masked(shape, wo, sigma_o, mask);
    return aspi_joint(wi.z, wo.z, si, so, mz, c, c, mask);
}

/* f times |cos_o|^cosine. */
static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    case_of k = make_case(mat, *wi, *wo);
    asp_real nothing = k.c * R(0.0), f = nothing, D, co = aspi_abs(wo->z);
    if (!k.dark) {
        int thin = mat->a.r > R(0.0);
        D = aspi_density_of(&mat->ndf, k.m);
        if (!k.refracts || thin) {
            asp_real so = aspi_sigma_of(&mat->ndf, k.wo);
            asp_real share = k.refracts ? R(1.0) - k.F : k.F;
            f = share * aspi_finite(R(0.25) * D * joint_reflected(&mat->ndf, k.wi, k.wo, k.sigma_i, so, k.m.z, k.c, mat->mask));
            f = cosine ? f * co : f;
        } else if (k.wm < R(0.0)) {
            asp_v3 below = aspi_turned(k.wo, R(-1.0), 0);
            asp_real so = aspi_sigma_of(&mat->ndf, below);
            asp_real a = area_over(&mat->ndf, k.wi, k.sigma_i, inverse_of(k.wi.z), mat->mask);
            asp_real b = area_over(&mat->ndf, below, so, inverse_of(co), mat->mask);
            asp_real G2 = refracted_masking(a, b, k.m.z, k.wi.z, co, k.c, -k.wm, mat->mask);
            f = (R(1.0) - k.F) * aspi_finite(k.c * D * aspi_bent_density(k.c, k.wm, k.eta) * G2 / k.wi.z)
              * aspi_crossing_scale(k.eta, aspi_crossing_scales(mat->transport, mat->a.r));
            f = cosine ? f : f / co;
        }
    }
    out->r = out->g = out->b = f;
}

/* Density of wo by the facet of a case that is not dark. */
ASP_FN asp_real facet_density(const case_of *k, asp_real D, int thin)
{
    asp_real p = D / aspi_max(k->sigma_i, ASP_SMALLEST);
    if (!k->refracts || thin)
        p = (k->refracts ? R(1.0) - k->F : k->F) * R(0.25) * p;
    else
        p = (R(1.0) - k->F) * k->c * p * aspi_bent_density(k->c, k->wm, k->eta);
    return aspi_finite(p);
}

static asp_real bsdf_pdf(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    case_of k = make_case(mat, *wi, *wo);
    int thin = mat->a.r > R(0.0);
    if (k.dark || (k.refracts && !thin && k.wm >= R(0.0)))
        return k.c * R(0.0);
    return facet_density(&k, aspi_density_of(&mat->ndf, k.m), thin);
}

/* The index of the other side over that of the side of `sign`. */
ASP_FN asp_real index_of(asp_real sign, asp_real eta, asp_real inverse) { return sign < R(0.0) ? inverse : eta; }

/* sign w of length 1: a step towards 1/|w| from 1, |w| is 1 to rounding. */
ASP_FN asp_v3 lengthened(asp_v3 w, asp_real sign)
{
    asp_real by = sign * (R(1.5) - R(0.5) * aspi_dot(w, w));
    w.x = by * w.x;
    w.y = by * w.y;
    w.z = by * w.z;
    return w;
}

/* f cos / pdf, where F cancels: of light that crosses G2 times this, and of light that stays. */
ASP_FN asp_real crossing_weight(asp_real sigma_i, asp_real over_cosine, asp_real scale)
{
    return aspi_finite(sigma_i * over_cosine) * scale;
}

/* What crosses is scaled so, from 1/eta. */
ASP_FN asp_real crossing_scale(const asp_mat *mat, asp_real inverse)
{
    return aspi_crossing_scales(mat->transport, mat->a.r) ? inverse * inverse : R(1.0);
}

ASP_FN asp_real staying_weight(const asp_shape *shape, asp_v3 wi, asp_v3 wo, asp_real sigma_i, asp_real sigma_o,
                               asp_real mz, asp_real c, int mask)
{
    return sigma_i * wo.z * joint_reflected(shape, wi, wo, sigma_i, sigma_o, mz, c, mask);
}

/* Seen edge-on or from nowhere. */
ASP_FN asp_sampled nothing_of(asp_v3 wi, asp_real nothing)
{
    asp_sampled out;
    out.wo = aspi_turned(wi, R(-1.0), 0);
    out.pdf = out.weight.r = out.weight.g = out.weight.b = nothing;
    return out;
}

/* A visible normal, then reflection or refraction by F. What single scattering loses, light into the surface
 * again, has density and weight 0. */
ASP_FN asp_sampled sample_as(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3, int mask)
{
    const asp_shape *shape = &mat->ndf;
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0), index = mat->c.r, inverse = R(1.0) / mat->c.r;
    asp_real over = index_of(sign, inverse, index), nothing = aspi_abs((wi.x + wi.y + wi.z) * R(0.0));
    asp_real weight, up, scale;
    asp_v3 v = aspi_turned(wi, sign, 0), wo;
    asp_split_ray s;
    asp_sampled out;
    if (v.z <= R(0.0) || nothing != R(0.0))
        return nothing_of(wi, nothing);
    ASPI_OPS(shape).refract(shape, v.x, v.y, v.z, u1, u2, u3, index_of(sign, index, inverse), over, &s);
    wo = aspi_vector(s.wo_x, s.wo_y, s.wo_z);
    scale = (mask & 15) == ASP_MASK_V_CAVITY ? aspi_sqrt(s.q) : R(0.0);
    if (u3 >= s.F) {
        asp_real over_i = inverse_of(v.z), a = area_over(shape, v, s.sigma_i, over_i, mask), b;
        up = -wo.z;
        b = area_over(shape, aspi_turned(wo, R(-1.0), 0), s.sigma_o, inverse_of(up), mask);
        weight = crossing_weight(s.sigma_i, over_i, crossing_scale(mat, over))
               * refracted_masking(a, b, s.m_z * scale, v.z, up, s.wi_m * scale, over * s.wo_m * scale, mask);
    } else {
        up = wo.z;
        weight = staying_weight(shape, v, wo, s.sigma_i, s.sigma_o, s.m_z * scale, s.wi_m * scale, mask);
    }
    out.wo = lengthened(wo, sign);
    out.pdf = up <= R(0.0) ? R(0.0) : s.pdf;
    weight = out.pdf <= R(0.0) ? R(0.0) : weight;
    out.weight.r = out.weight.g = out.weight.b = weight;
    return out;
}

/* A sheet: what passes leaves in the mirror image of what is reflected. */
static asp_sampled sample_thin(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    const asp_shape *shape = &mat->ndf;
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0), nothing = aspi_abs((wi.x + wi.y + wi.z) * R(0.0));
    asp_real weight, c, F, share;
    asp_v3 v = aspi_turned(wi, sign, 1), wo;
    asp_mirrored s;
    asp_sampled out;
    if (v.z <= R(0.0) || nothing != R(0.0))
        return nothing_of(wi, nothing);
    ASPI_OPS(shape).reflect(shape, v.x, v.y, v.z, u1, u2, &s);
    c = aspi_sqrt(aspi_unit_cosine(s.cosine2));
    F = sheet(aspi_fresnel_dielectric(c, mat->c.r), 1);
    share = u3 >= F ? R(1.0) - F : F;
    wo = aspi_vector(s.wo_x, s.wo_y, s.wo_z);
    weight = staying_weight(shape, v, wo, s.sigma_i, s.sigma_o, aspi_sqrt(aspi_above(s.m_z2)), c, mat->mask);
    out.pdf = wo.z <= R(0.0) ? R(0.0) : share * s.pdf;
    weight = out.pdf <= R(0.0) ? R(0.0) : weight;
    out.wo = aspi_turned(lengthened(wo, R(1.0)), u3 >= F ? -sign : sign, 1);
    out.weight.r = out.weight.g = out.weight.b = weight;
    return out;
}

ASP_CLONES_SINGLE static asp_sampled bsdf_sample(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2,
                                                 asp_real u3)
{
    asp_sampled out;
    /* constants spare the default the others' arithmetic */
    if (mat->a.r > R(0.0) && mat->c.r != R(1.0))
        return sample_thin(mat, wi, u1, u2, u3);
    if (mat->c.r != R(1.0))
        return mat->mask == 0 ? sample_as(mat, wi, u1, u2, u3, 0) : sample_as(mat, wi, u1, u2, u3, mat->mask);
    /* nothing is there: the light goes on */
    out.pdf = (wi.x + wi.y + wi.z) * R(0.0);
    out.wo = aspi_turned(wi, R(-1.0), 0);
    out.weight.r = out.weight.g = out.weight.b = R(1.0) + out.pdf;
    return out;
}

/* beta of a block whose elements with far[i] != 0 matter and are not near: those are collected. */
ASP_FN void beta_n(size_t n, const asp_real *ASP_RESTRICT a, const asp_real *ASP_RESTRICT b,
                   const int *ASP_RESTRICT far, asp_real *ASP_RESTRICT out)
{
    asp_real x[ASP_BLOCK], y[ASP_BLOCK];
    int place[ASP_BLOCK];
    size_t i, count;
    for (i = count = 0; i < n; i++) {
        place[count] = (int)i;
        count += far[i] != 0;
    }
    for (i = 0; i < count; i++) {
        x[i] = a[place[i]];
        y[i] = b[place[i]];
    }
    ASP_IN_PLACE
    for (i = 0; i < count; i++)
        x[i] = beta(x[i], y[i]);
    for (i = 0; i < count; i++)
        out[place[i]] = x[i];
}

/* Reflected and refracted alike, for half spaces with the default masking. Outputs may be inputs: they are
 * written last. */
ASP_CLONES static int bsdf_sample_n(const asp_mat *mat, size_t n, const asp_real *const wi[3],
                                    const asp_real *const u[3], asp_real *const wo[3], asp_real *pdf,
                                    asp_real *const weight[3])
{
    const asp_shape *shape = &mat->ndf;
    const asp_real *wx = wi[0], *wy = wi[1], *wz = wi[2], *u3 = u[2];
    asp_real *px = wo[0], *py = wo[1], *pz = wo[2], *r = weight[0], *g = weight[1], *b = weight[2];
    asp_real vx[ASP_BLOCK], vy[ASP_BLOCK], vz[ASP_BLOCK], ox[ASP_BLOCK], oy[ASP_BLOCK], oz[ASP_BLOCK];
    asp_real si[ASP_BLOCK], so[ASP_BLOCK], p[ASP_BLOCK], F[ASP_BLOCK], eta[ASP_BLOCK], over[ASP_BLOCK];
    asp_real A[ASP_BLOCK], B[ASP_BLOCK], G2[ASP_BLOCK];
    int far[ASP_BLOCK];
    asp_real index = mat->c.r, inverse = R(1.0) / mat->c.r;
    asp_real above = crossing_scale(mat, inverse), below = crossing_scale(mat, index);
    asp_split_rays out;
    size_t i;
    if (mat->a.r > R(0.0) || index == R(1.0) || mat->mask != 0 || !n)
        return 0;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_turned(aspi_vector(wx[i], wy[i], wz[i]), wz[i] < R(0.0) ? R(-1.0) : R(1.0), 0);
        vx[i] = v.x;
        vy[i] = v.y;
        vz[i] = v.z;
        eta[i] = index_of(wz[i], index, inverse);
        over[i] = index_of(wz[i], inverse, index);
    }
    out.wo_x = ox;
    out.wo_y = oy;
    out.wo_z = oz;
    out.F = F;
    out.pdf = p;
    out.sigma_i = si;
    out.sigma_o = so;
    ASPI_OPS(shape).refract_n(shape, n, vx, vy, vz, u[0], u[1], u3, eta, over, &out);
    for (i = 0; i < n; i++) {
        asp_real sign = u3[i] >= F[i] ? R(-1.0) : R(1.0);
        asp_v3 v = aspi_vector(vx[i], vy[i], vz[i]), up = aspi_vector(sign * ox[i], sign * oy[i], sign * oz[i]);
        asp_real a = area_over(shape, v, si[i], inverse_of(v.z), 0);
        asp_real o = area_over(shape, up, so[i], inverse_of(up.z), 0);
        A[i] = a;
        B[i] = o;
        far[i] = (u3[i] >= F[i]) & !is_near(a, o);
        G2[i] = beta_near(a, o);
    }
    beta_n(n, A, B, far, G2);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real nothing = aspi_abs((wx[i] + wy[i] + wz[i]) * R(0.0)), sign = wz[i] < R(0.0) ? R(-1.0) : R(1.0);
        asp_real w, stay, d;
        asp_v3 v = aspi_vector(vx[i], vy[i], vz[i]), wo = aspi_vector(ox[i], oy[i], oz[i]), to = lengthened(wo, sign);
        int crosses = u3[i] >= F[i], stop = (v.z <= R(0.0)) | (nothing != R(0.0));
        int lost = stop | (aspi_select(crosses, -wo.z, wo.z) <= R(0.0));
        d = aspi_select(lost, nothing, p[i]);
        w = crossing_weight(si[i], inverse_of(v.z), index_of(wz[i], above, below)) * G2[i];
        stay = staying_weight(shape, v, wo, si[i], so[i], R(0.0), R(0.0), 0);
        w = aspi_select(crosses, w, stay);
        w = aspi_select(lost | (d <= R(0.0)), nothing, w);
        px[i] = aspi_select(stop, -wx[i], to.x);
        py[i] = aspi_select(stop, -wy[i], to.y);
        pz[i] = aspi_select(stop, -wz[i], to.z);
        pdf[i] = d;
        r[i] = w;
        g[i] = w;
        b[i] = w;
    }
    return 1;
}
#undef BETA_STEPS
#endif
