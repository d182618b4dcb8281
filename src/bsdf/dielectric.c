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
#include "bsdf/reflection.h"
#include "bsdf/refraction.h"

#ifndef DIELECTRIC_NAMES
#define DIELECTRIC_NAMES
#define turned ASP_NDF_NAME(_turned)
#define case_of ASP_NDF_NAME(_case)
#define make_case ASP_NDF_NAME(_make)
#define refracted_masking ASP_NDF_NAME(_refracted_masking)
#define crossing_scale ASP_NDF_NAME(_crossing)
#define stirling ASP_NDF_NAME(_stirling)
#define beta ASP_NDF_NAME(_beta)
#define joint_reflected ASP_NDF_NAME(_joint_reflected)
#define facet_density ASP_NDF_NAME(_facet_density)
#define surface_density ASP_NDF_NAME(_surface_density)
#define surface_sigma ASP_NDF_NAME(_surface_sigma)
#define index_of ASP_NDF_NAME(_index_of)
#define bend ASP_NDF_NAME(_bend)
#define sample_weight ASP_NDF_NAME(_sample_weight)
#endif

/* A pair of directions with wi above: which facet joins them, and F there. */
typedef struct case_of {
    asp_v3 wi, wo, m;
    asp_real eta, c, wm, F;      /* wi.m, wo.m */
    asp_real sigma_i;
    int refracts, dark;
} case_of;

#define OPS ASP_NAME(OPS)
#define OPS_64(k) ((k)->model->f64)
#define OPS_32(k) ((k)->model->f32)

ASP_FN asp_real surface_density(const asp_shape *k, asp_v3 m) { return OPS(k).density(k, m.x, m.y, m.z); }

ASP_FN asp_real surface_sigma(const asp_shape *k, asp_v3 w) { return OPS(k).sigma(k, w.x, w.y, w.z); }

/* As seen from the side of `sign`: by a point reflection, or for a sheet by a mirror. */
ASP_FN asp_v3 turned(asp_v3 w, asp_real sign, int thin)
{
    asp_real across = thin ? R(1.0) : sign;
    w.x = across * w.x;
    w.y = across * w.y;
    w.z = sign * w.z;
    return w;
}

ASP_FN case_of make_case(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    int thin = mat->a.r > R(0.0);
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0);
    case_of k;
    k.eta = sign < R(0.0) && !thin ? R(1.0) / mat->c.r : mat->c.r;
    k.wi = turned(wi, sign, thin);
    k.wo = turned(wo, sign, thin);
    k.refracts = k.wo.z < R(0.0);
    if (thin && k.refracts) {
        k.wo.z = -k.wo.z;
        k.m = aspi_half_vector(k.wi, k.wo);
    } else {
        k.m = k.refracts ? aspi_bent_half(k.wi, k.wo, k.eta) : aspi_half_vector(k.wi, k.wo);
    }
    k.c = aspi_dot(k.wi, k.m);
    k.wm = aspi_dot(k.wo, k.m);
    k.F = aspi_fresnel_dielectric(k.c, k.eta);
    if (thin)
        k.F = R(2.0) * k.F / (R(1.0) + k.F);
    k.dark = !(k.c > R(0.0) && k.m.z > ASP_FLAT && k.wi.z > R(0.0) && k.wo.z != R(0.0))
          || mat->c.r == R(1.0);
    k.sigma_i = surface_sigma(&mat->ndf, k.wi);
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

/* Euler's B(a, b), a and b at least 1: brought to a + n, b + n by the recurrence. With x = B/A the power is
 * exp(-((A + B) log(1 + x) - B log x)), whose error by that of x vanishes. Relative error 1e-11 and 5e-7 per
 * 1 + |ln B|; float32 answers 0 below about 1e-20. */
ASP_FN asp_real beta(asp_real a, asp_real b)
{
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

/* G2 of light that crosses: the one direction sees from above, the other from below, so that heights
 * are opposed. Heitz 2014, sec. 5.4 (after Dupuy): B(1 + Lambda_i, 1 + Lambda_o). V-cavities: what both
 * sides leave of a groove, G1 + G1 - 1. */
ASP_FN asp_real refracted_masking(const asp_shape *shape, const case_of *k, asp_real sigma_o, int mask)
{
    asp_real ci = k->wi.z, co = aspi_abs(k->wo.z);
    asp_v3 below = turned(k->wo, R(-1.0), 0);
    asp_real a = aspi_masked(shape, k->wi, k->sigma_i, mask) / ci;
    asp_real b = aspi_masked(shape, below, sigma_o, mask) / co;
    if ((mask & 15) == ASP_MASK_UNCORRELATED)
        return R(1.0) / (a * b);
    if ((mask & 15) == ASP_MASK_V_CAVITY) {
        asp_real open_i = aspi_min(R(1.0), R(2.0) * k->m.z * ci / k->c);
        asp_real open_o = aspi_min(R(1.0), R(2.0) * k->m.z * co / aspi_max(-k->wm, ASP_SMALLEST));
        return aspi_max(open_i + open_o - R(1.0), R(0.0));
    }
    return beta(a, b);
}

/* G2 / (ci co) of a reflection. */
ASP_FN asp_real joint_reflected(const asp_shape *shape, const case_of *k, asp_real sigma_o, int mask)
{
    asp_real si = aspi_masked(shape, k->wi, k->sigma_i, mask), so = aspi_masked(shape, k->wo, sigma_o, mask);
    return aspi_joint(k->wi.z, k->wo.z, si, so, k->m.z, k->c, k->c, mask);
}

ASP_FN asp_real crossing_scale(const asp_mat *mat, const case_of *k)
{
    return mat->transport == ASP_IMPORTANCE || mat->a.r > R(0.0) ? R(1.0)
                                                                   : R(1.0) / (k->eta * k->eta);
}

/* f times |cos_o|^cosine. */
static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    case_of k = make_case(mat, *wi, *wo);
    asp_real nothing = k.c * R(0.0), f = nothing, D, co = aspi_abs(wo->z);
    if (!k.dark) {
        int thin = mat->a.r > R(0.0);
        D = surface_density(&mat->ndf, k.m);
        if (!k.refracts || thin) {
            asp_real so = surface_sigma(&mat->ndf, k.wo);
            asp_real share = k.refracts ? R(1.0) - k.F : k.F;
            f = share * aspi_finite(R(0.25) * D * joint_reflected(&mat->ndf, &k, so, mat->mask));
            f = cosine ? f * co : f;
        } else if (k.wm < R(0.0)) {
            asp_real so = surface_sigma(&mat->ndf, turned(k.wo, R(-1.0), 0));
            asp_real G2 = refracted_masking(&mat->ndf, &k, so, mat->mask);
            f = (R(1.0) - k.F) * aspi_finite(k.c * D * aspi_bent_density(k.c, k.wm, k.eta) * G2 / k.wi.z)
              * crossing_scale(mat, &k);
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
    return facet_density(&k, surface_density(&mat->ndf, k.m), thin);
}

/* The index of the other side over that of the side of `sign`. */
ASP_FN asp_real index_of(asp_real sign, asp_real eta, asp_real inverse, int thin)
{
    return sign < R(0.0) && !thin ? inverse : eta;
}

/* Reflection or refraction at the facet m by F; wo.z is of the side that it should be on unless single
 * scattering loses this light. */
ASP_FN case_of bend(asp_v3 v, asp_v3 m, asp_real eta, asp_real u3, int thin)
{
    case_of k;
    k.wi = v;
    k.m = m;
    k.eta = eta;
    k.c = aspi_dot(v, m);
    k.F = aspi_fresnel_dielectric(k.c, eta);
    if (thin)
        k.F = R(2.0) * k.F / (R(1.0) + k.F);
    k.refracts = u3 >= k.F;
    if (k.refracts && !thin)
        k.wo = aspi_refract(v, m, eta);
    else
        k.wo = aspi_reflect(v, m);
    k.wm = aspi_dot(k.wo, m);
    return k;
}

/* f cos / pdf, where F cancels; k.wo.z of a sheet is above. */
ASP_FN asp_real sample_weight(const asp_shape *shape, const case_of *k, asp_real sigma_o, asp_real scale, int thin,
                              int mask)
{
    asp_real w;
    if (!k->refracts || thin)
        w = k->sigma_i * aspi_abs(k->wo.z) * joint_reflected(shape, k, sigma_o, mask);
    else
        w = refracted_masking(shape, k, sigma_o, mask) * k->sigma_i / k->wi.z * scale;
    return w;
}

/* A visible normal, then reflection or refraction by F. */
ASP_CLONES_SINGLE static void bsdf_sample(const asp_mat *mat, const asp_v3 *wi, asp_real u1, asp_real u2,
                                          asp_real u3, asp_sampled *out)
{
    const asp_shape *shape = &mat->ndf;
    int thin = mat->a.r > R(0.0);
    asp_real sign = wi->z < R(0.0) ? R(-1.0) : R(1.0), weight, normal[3];
    asp_real nothing = (wi->x + wi->y + wi->z) * R(0.0);
    asp_v3 v = turned(*wi, sign, thin), wo, seen;
    case_of k;
    out->pdf = nothing;
    out->wo = turned(*wi, R(-1.0), 0);
    out->weight.r = out->weight.g = out->weight.b = nothing;
    if (mat->c.r == R(1.0)) {
        /* nothing is there: the light goes on */
        out->weight.r = out->weight.g = out->weight.b = R(1.0) + nothing;
        return;
    }
    if (v.z <= R(0.0) || nothing != R(0.0))
        return;
    OPS(shape).visible(shape, v.x, v.y, v.z, u1, u2, normal);
    k = bend(v, aspi_vector(normal[0], normal[1], normal[2]),
             index_of(sign, mat->c.r, R(1.0) / mat->c.r, thin), u3, thin);
    wo = k.wo;
    if (k.refracts && thin)
        wo.z = -wo.z;
    out->wo = turned(wo, sign, thin);
    if (k.refracts ? wo.z >= R(0.0) : wo.z <= R(0.0))
        return; /* into the surface again: single scattering loses this light */
    k.sigma_i = surface_sigma(shape, v);
    if (thin)
        k.wo.z = aspi_abs(wo.z); /* as make_case does */
    out->pdf = facet_density(&k, surface_density(shape, k.m), thin);
    if (out->pdf <= R(0.0))
        return;
    seen = turned(k.wo, k.refracts && !thin ? R(-1.0) : R(1.0), 0);
    weight = surface_sigma(shape, seen);
    weight = mat->mask == 0 /* a constant spares the default the others' arithmetic */
           ? sample_weight(shape, &k, weight, crossing_scale(mat, &k), thin, 0)
           : sample_weight(shape, &k, weight, crossing_scale(mat, &k), thin, mat->mask);
    out->weight.r = out->weight.g = out->weight.b = weight;
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
    asp_real si[ASP_BLOCK], so[ASP_BLOCK], D[ASP_BLOCK], c[ASP_BLOCK], F[ASP_BLOCK];
    asp_real index = mat->c.r, inverse = R(1.0) / mat->c.r;
    asp_real denser = mat->transport == ASP_IMPORTANCE ? R(0.0) : R(1.0);
    size_t i;
    if (mat->a.r > R(0.0) || index == R(1.0) || mat->mask != 0 || !n)
        return 0;
    for (i = 0; i < n; i++) {
        asp_v3 v = turned(aspi_vector(wx[i], wy[i], wz[i]), wz[i] < R(0.0) ? R(-1.0) : R(1.0), 0);
        vx[i] = v.x;
        vy[i] = v.y;
        vz[i] = v.z;
    }
    OPS(shape).visible_n(shape, n, vx, vy, vz, u[0], u[1], mx, my, mz);
    OPS(shape).sigma_n(shape, n, R(1.0), vx, vy, vz, si);
    OPS(shape).density_n(shape, n, mx, my, mz, D);
    for (i = 0; i < n; i++) {
        asp_real eta = index_of(wz[i], index, inverse, 0), sign;
        case_of k = bend(aspi_vector(vx[i], vy[i], vz[i]), aspi_vector(mx[i], my[i], mz[i]), eta, u3[i], 0);
        sign = k.refracts ? R(-1.0) : R(1.0);
        c[i] = k.c;
        F[i] = k.F;
        ox[i] = k.wo.x;
        oy[i] = k.wo.y;
        oz[i] = k.wo.z;
        bx[i] = sign * k.wo.x;
        by[i] = sign * k.wo.y;
        bz[i] = sign * k.wo.z;
    }
    OPS(shape).sigma_n(shape, n, R(1.0), bx, by, bz, so);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real nothing = (wx[i] + wy[i] + wz[i]) * R(0.0), sign = wz[i] < R(0.0) ? R(-1.0) : R(1.0), p, w;
        case_of k;
        int stop, lost;
        k.wi = aspi_vector(vx[i], vy[i], vz[i]);
        k.m = aspi_vector(mx[i], my[i], mz[i]);
        k.wo = aspi_vector(ox[i], oy[i], oz[i]);
        k.eta = index_of(wz[i], index, inverse, 0);
        k.c = c[i];
        k.F = F[i];
        k.wm = aspi_dot(k.wo, k.m);
        k.refracts = u3[i] >= F[i];
        k.sigma_i = si[i];
        p = facet_density(&k, D[i], 0);
        w = sample_weight(shape, &k, so[i], denser > R(0.0) ? R(1.0) / (k.eta * k.eta) : R(1.0), 0, 0);
        stop = (k.wi.z <= R(0.0)) | (nothing != R(0.0));
        lost = stop | (bz[i] <= R(0.0));
        p = aspi_select(lost, nothing, p);
        w = aspi_select(lost | (p <= R(0.0)), nothing, w);
        px[i] = aspi_select(stop, -wx[i], sign * k.wo.x);
        py[i] = aspi_select(stop, -wy[i], sign * k.wo.y);
        pz[i] = aspi_select(stop, -wz[i], sign * k.wo.z);
        pdf[i] = p;
        r[i] = w;
        g[i] = w;
        b[i] = w;
    }
    return 1;
}
#undef OPS
#undef OPS_64
#undef OPS_32
#undef BETA_STEPS
#endif
