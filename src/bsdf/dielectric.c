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
#define beta_near ASP_NDF_NAME(_beta_near)
#define is_near ASP_NDF_NAME(_is_near)
#define sheet ASP_NDF_NAME(_sheet)
#define area_i ASP_NDF_NAME(_area_i)
#define area_o ASP_NDF_NAME(_area_o)
#define lengthened ASP_NDF_NAME(_lengthened)
#define joint_reflected ASP_NDF_NAME(_joint_reflected)
#define facet_density ASP_NDF_NAME(_facet_density)
#define index_of ASP_NDF_NAME(_index_of)
#define bend ASP_NDF_NAME(_bend)
#define sample_as ASP_NDF_NAME(_sample_as)
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

/* The same for a and b within [1, 2], float32: reciprocal gamma functions as polynomials (scripts/series.py),
 * relative error 4e-7. */
ASP_FN int is_near(asp_real a, asp_real b) { return ASP_PRECISION == 32 && aspi_max(a, b) <= R(2.0); }

ASP_FN asp_real beta_near(asp_real a, asp_real b)
{
    asp_real x = a - R(1.5), y = b - R(1.5), s = a + b - R(3.0);
    asp_real x2 = x * x, y2 = y * y, s2 = s * s, ex, ox, ey, oy, es, os;
    ex = R(0.006062104116);
    ey = R(0.006062104116);
    es = R(0.0001414160983);
    ox = R(0.002203451363);
    oy = R(0.002203451363);
    os = R(-1.148210216e-6);
    ex = ex * x2 + R(0.05105268071);
    ey = ey * y2 + R(0.05105268071);
    es = es * s2 + R(0.0005587637258);
    ox = ox * x2 + R(-0.04217049317);
    oy = oy * y2 + R(-0.04217049317);
    os = os * s2 + R(-0.0006791526744);
    ex = ex * x2 + R(-0.5266587205);
    ey = ey * y2 + R(-0.5266587205);
    es = es * s2 + R(-0.03151665695);
    ox = ox * x2 + R(0.1751030837);
    oy = oy * y2 + R(0.1751030837);
    os = os * s2 + R(0.006935187604);
    ex = ex * x2 + R(1.128379201);
    ey = ey * y2 + R(1.128379201);
    es = es * s2 + R(0.1141498354);
    ox = ox * x2 + R(-0.0411745462);
    oy = oy * y2 + R(-0.0411745462);
    os = os * s2 + R(0.03847059524);
    es = es * s2 + R(0.4999999876);
    os = os * s2 + R(-0.4613921502);
    return (os * s + es) / ((ox * x + ex) * (oy * y + ey));
}

/* Masked area over cosine, 1 + Lambda, of wi, and of light that crosses, which sees from below. */
ASP_FN asp_real area_i(const asp_shape *shape, const case_of *k, int mask)
{
    return aspi_masked(shape, k->wi, k->sigma_i, mask) / k->wi.z;
}

ASP_FN asp_real area_o(const asp_shape *shape, asp_v3 wo, asp_real sigma_o, int mask)
{
    return aspi_masked(shape, aspi_turned(wo, R(-1.0), 0), sigma_o, mask) / aspi_abs(wo.z);
}

/* G2 of light that crosses, from area_i and sigma_o. Heitz 2014, sec. 5.4 (after Dupuy): B(1 + Lambda_i,
 * 1 + Lambda_o). V-cavities: what both sides leave of a groove, G1 + G1 - 1. */
ASP_FN asp_real refracted_masking(const asp_shape *shape, const case_of *k, asp_real a, asp_real sigma_o, int mask)
{
    asp_real ci = k->wi.z, co = aspi_abs(k->wo.z), b = area_o(shape, k->wo, sigma_o, mask);
    if ((mask & 15) == ASP_MASK_UNCORRELATED)
        return R(1.0) / (a * b);
    if ((mask & 15) == ASP_MASK_V_CAVITY) {
        asp_real open_i = aspi_min(R(1.0), R(2.0) * k->m.z * ci / k->c);
        asp_real open_o = aspi_min(R(1.0), R(2.0) * k->m.z * co / aspi_max(-k->wm, ASP_SMALLEST));
        return aspi_max(open_i + open_o - R(1.0), R(0.0));
    }
    return is_near(a, b) ? beta_near(a, b) : beta(a, b);
}

/* G2 / (ci co) of a reflection. */
ASP_FN asp_real joint_reflected(const asp_shape *shape, const case_of *k, asp_real sigma_o, int mask)
{
    asp_real si = aspi_masked(shape, k->wi, k->sigma_i, mask), so = aspi_masked(shape, k->wo, sigma_o, mask);
    return aspi_joint(k->wi.z, k->wo.z, si, so, k->m.z, k->c, k->c, mask);
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
            f = share * aspi_finite(R(0.25) * D * joint_reflected(&mat->ndf, &k, so, mat->mask));
            f = cosine ? f * co : f;
        } else if (k.wm < R(0.0)) {
            asp_real so = aspi_sigma_of(&mat->ndf, aspi_turned(k.wo, R(-1.0), 0));
            asp_real G2 = refracted_masking(&mat->ndf, &k, area_i(&mat->ndf, &k, mat->mask), so, mat->mask);
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
ASP_FN asp_real index_of(asp_real sign, asp_real eta, asp_real inverse, int thin)
{
    return sign < R(0.0) && !thin ? inverse : eta;
}

/* Reflection or refraction at the facet m by F (Walter et al. 2007, eqs. 39-40); wo, a unit vector to rounding,
 * is on the side that it should be on unless single scattering loses this light. */
ASP_FN case_of bend(asp_v3 v, asp_v3 m, asp_real eta, asp_real inverse, asp_real u3, int thin)
{
    case_of k;
    asp_v2 f;
    asp_real by, of_v, cosine;
    k.wi = v;
    k.m = m;
    k.eta = eta;
    k.c = aspi_dot(v, m);
    f = aspi_dielectric(k.c, eta);
    k.F = sheet(f.x, thin);
    k.refracts = u3 >= k.F;
    cosine = f.y * inverse;
    by = k.refracts && !thin ? k.c * inverse - cosine : R(2.0) * k.c;
    of_v = k.refracts && !thin ? inverse : R(1.0);
    k.wm = k.refracts && !thin ? -cosine : k.c;
    k.wo.x = by * m.x - of_v * v.x;
    k.wo.y = by * m.y - of_v * v.y;
    k.wo.z = by * m.z - of_v * v.z;
    return k;
}

/* w of length 1: a step towards 1/|w| from 1, |w| is 1 to rounding. */
ASP_FN asp_v3 lengthened(asp_v3 w)
{
    asp_real by = R(1.5) - R(0.5) * aspi_dot(w, w);
    w.x = by * w.x;
    w.y = by * w.y;
    w.z = by * w.z;
    return w;
}

/* f cos / pdf, where F cancels: of light that crosses G2 times this, and of light that stays; k.wo.z of a sheet
 * is above. */
ASP_FN asp_real crossing_weight(const case_of *k, asp_real scale)
{
    return aspi_finite(k->sigma_i / k->wi.z) * scale;
}

ASP_FN asp_real staying_weight(const asp_shape *shape, const case_of *k, asp_real sigma_o, int mask)
{
    return k->sigma_i * aspi_abs(k->wo.z) * joint_reflected(shape, k, sigma_o, mask);
}

/* A visible normal, then reflection or refraction by F. */
ASP_FN void sample_as(const asp_mat *mat, const asp_v3 *wi, asp_real u1, asp_real u2, asp_real u3, int thin, int mask,
                      asp_sampled *out)
{
    const asp_shape *shape = &mat->ndf;
    asp_real sign = wi->z < R(0.0) ? R(-1.0) : R(1.0), index = mat->c.r, inverse = R(1.0) / mat->c.r;
    asp_real nothing = (wi->x + wi->y + wi->z) * R(0.0), weight;
    asp_seen facet;
    asp_v3 v = aspi_turned(*wi, sign, thin), wo;
    case_of k;
    out->pdf = nothing;
    out->weight.r = out->weight.g = out->weight.b = nothing;
    if (v.z <= R(0.0) || nothing != R(0.0)) {
        out->wo = aspi_turned(*wi, R(-1.0), 0);
        return;
    }
    ASPI_OPS(shape).facet(shape, v.x, v.y, v.z, u1, u2, &facet);
    k = bend(v, aspi_vector(facet.m_x, facet.m_y, facet.m_z), index_of(sign, index, inverse, thin),
             index_of(sign, inverse, index, thin), u3, thin);
    wo = k.wo;
    if (k.refracts && thin)
        wo.z = -wo.z;
    out->wo = aspi_turned(lengthened(wo), sign, thin);
    if (k.refracts ? wo.z >= R(0.0) : wo.z <= R(0.0))
        return; /* into the surface again: single scattering loses this light */
    k.sigma_i = facet.sigma_i;
    if (thin)
        k.wo.z = aspi_abs(wo.z); /* as make_case does */
    out->pdf = facet_density(&k, facet.density, thin);
    if (out->pdf <= R(0.0))
        return;
    if (k.refracts && !thin) {
        /* first what need not be kept while sigma is called */
        asp_real a = area_i(shape, &k, mask), scale = aspi_crossing_scale(k.eta, aspi_crossing_scales(mat->transport, mat->a.r));
        asp_real by = crossing_weight(&k, scale);
        weight = aspi_sigma_of(shape, aspi_turned(k.wo, R(-1.0), 0));
        weight = refracted_masking(shape, &k, a, weight, mask) * by;
    } else {
        weight = staying_weight(shape, &k, aspi_sigma_of(shape, k.wo), mask);
    }
    out->weight.r = out->weight.g = out->weight.b = weight;
}

ASP_CLONES_SINGLE static void bsdf_sample(const asp_mat *mat, const asp_v3 *wi, asp_real u1, asp_real u2,
                                          asp_real u3, asp_sampled *out)
{
    if (mat->c.r == R(1.0)) {
        /* nothing is there: the light goes on */
        out->pdf = (wi->x + wi->y + wi->z) * R(0.0);
        out->wo = aspi_turned(*wi, R(-1.0), 0);
        out->weight.r = out->weight.g = out->weight.b = R(1.0) + out->pdf;
    } else if (mat->a.r > R(0.0)) {
        sample_as(mat, wi, u1, u2, u3, 1, mat->mask, out);
    } else if (mat->mask == 0) {
        sample_as(mat, wi, u1, u2, u3, 0, 0, out); /* constants spare the default the others' arithmetic */
    } else {
        sample_as(mat, wi, u1, u2, u3, 0, mat->mask, out);
    }
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
    asp_real vx[ASP_BLOCK], vy[ASP_BLOCK], vz[ASP_BLOCK], mx[ASP_BLOCK], my[ASP_BLOCK], mz[ASP_BLOCK];
    asp_real ox[ASP_BLOCK], oy[ASP_BLOCK], oz[ASP_BLOCK], bx[ASP_BLOCK], by[ASP_BLOCK], bz[ASP_BLOCK];
    asp_real si[ASP_BLOCK], so[ASP_BLOCK], D[ASP_BLOCK], c[ASP_BLOCK], F[ASP_BLOCK], wm[ASP_BLOCK];
    asp_real G2[ASP_BLOCK];
    int far[ASP_BLOCK];
    asp_real index = mat->c.r, inverse = R(1.0) / mat->c.r;
    int denser = aspi_crossing_scales(mat->transport, mat->a.r);
    size_t i;
    if (mat->a.r > R(0.0) || index == R(1.0) || mat->mask != 0 || !n)
        return 0;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_turned(aspi_vector(wx[i], wy[i], wz[i]), wz[i] < R(0.0) ? R(-1.0) : R(1.0), 0);
        vx[i] = v.x;
        vy[i] = v.y;
        vz[i] = v.z;
    }
    ASPI_OPS(shape).visible_n(shape, n, vx, vy, vz, u[0], u[1], mx, my, mz);
    ASPI_OPS(shape).sigma_n(shape, n, R(1.0), vx, vy, vz, si);
    ASPI_OPS(shape).density_n(shape, n, mx, my, mz, D);
    for (i = 0; i < n; i++) {
        asp_real eta = index_of(wz[i], index, inverse, 0), over = index_of(wz[i], inverse, index, 0), sign;
        case_of k = bend(aspi_vector(vx[i], vy[i], vz[i]), aspi_vector(mx[i], my[i], mz[i]), eta, over, u3[i], 0);
        sign = k.refracts ? R(-1.0) : R(1.0);
        c[i] = k.c;
        F[i] = k.F;
        wm[i] = k.wm;
        ox[i] = k.wo.x;
        oy[i] = k.wo.y;
        oz[i] = k.wo.z;
        bx[i] = sign * k.wo.x;
        by[i] = sign * k.wo.y;
        bz[i] = sign * k.wo.z;
    }
    ASPI_OPS(shape).sigma_n(shape, n, R(1.0), bx, by, bz, so);
    for (i = 0; i < n; i++) {
        case_of k;
        asp_real a, o;
        k.wi = aspi_vector(vx[i], vy[i], vz[i]);
        k.sigma_i = si[i];
        a = area_i(shape, &k, 0);
        o = area_o(shape, aspi_vector(ox[i], oy[i], oz[i]), so[i], 0);
        bx[i] = a;
        by[i] = o;
        far[i] = (u3[i] >= F[i]) & !is_near(a, o);
        G2[i] = beta_near(a, o);
    }
    beta_n(n, bx, by, far, G2);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real nothing = (wx[i] + wy[i] + wz[i]) * R(0.0), sign = wz[i] < R(0.0) ? R(-1.0) : R(1.0), p, w, stay;
        case_of k;
        asp_v3 out;
        int stop, lost;
        k.wi = aspi_vector(vx[i], vy[i], vz[i]);
        k.m = aspi_vector(mx[i], my[i], mz[i]);
        k.wo = aspi_vector(ox[i], oy[i], oz[i]);
        k.eta = index_of(wz[i], index, inverse, 0);
        k.c = c[i];
        k.F = F[i];
        k.wm = wm[i];
        k.refracts = u3[i] >= F[i];
        k.sigma_i = si[i];
        out = lengthened(k.wo);
        p = facet_density(&k, D[i], 0);
        w = G2[i] * crossing_weight(&k, aspi_crossing_scale(k.eta, denser));
        stay = staying_weight(shape, &k, so[i], 0);
        w = k.refracts ? w : stay;
        stop = (k.wi.z <= R(0.0)) | (nothing != R(0.0));
        lost = stop | (bz[i] <= R(0.0));
        p = aspi_select(lost, nothing, p);
        w = aspi_select(lost | (p <= R(0.0)), nothing, w);
        px[i] = aspi_select(stop, -wx[i], sign * out.x);
        py[i] = aspi_select(stop, -wy[i], sign * out.y);
        pz[i] = aspi_select(stop, -wz[i], sign * out.z);
        pdf[i] = p;
        r[i] = w;
        g[i] = w;
        b[i] = w;
    }
    return 1;
}
#undef BETA_STEPS
#endif
