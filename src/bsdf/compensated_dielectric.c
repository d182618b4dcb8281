/* compensated_dielectric.c - a rough dielectric that gives back what single scattering loses, without a walk
 *
 * form=kulla_conty (Kulla, Conty 2017): E_s(w) is what comes back of light from w on side s, reflected and
 * refracted together, m_s the mean of 1 - E_s over the hemisphere. To single scattering is added
 *
 *     f = A_st (1 - E_s(wi)) (1 - E_t(wo)) / pi,   t the side of wo,
 *
 * in importance, and n_s^2/n_t^2 times as much in radiance. All light is given back where
 * A_so m_o + A_si m_i = 1 for either side s, and f is reciprocal, f(wo, wi) n_t^2 = f(wi, wo) n_s^2, where
 * A_io n_i^2 = A_oi n_o^2. One number is free, the share that crosses. Here
 *
 *     A_st = (1 - F_s) / max(m_o, m_i),   s and t different sides,
 *
 * with F_s the mean of Fresnel's term seen from s, since (1 - F_i) eta^2 = 1 - F_o. So at most the share
 * crosses that a flat boundary lets through of light from everywhere, and nothing becomes negative. A sheet
 * looks the same from both sides.
 * form=turquin (Turquin 2019): single scattering over E(wi). Not reciprocal. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"
#include "bsdf/energy.h"

extern const asp_bsdf asp_bsdf_dielectric;

#define ASP_NDF compensated_dielectric
#define ASP_PRECISION 64
#include "compensated_dielectric.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "compensated_dielectric.c"
#undef ASP_PRECISION
#undef ASP_NDF

/* Mean of 1 - F (of a sheet: 1 - 2F/(1 + F)) against 2 c dc = 4 t^3 dt for eta > 1, by Simpson's rule. */
static double mean_crossing(double eta, int thin)
{
    double sum = 0.0;
    int i, n = 512;
    for (i = 0; i <= n; i++) {
        double t = (double)i / n, F = aspi_fresnel_dielectric_64(t * t, eta);
        double crosses = thin ? (1.0 - F) / (1.0 + F) : 1.0 - F;
        sum += 4.0 * t * t * t * crosses * (i == 0 || i == n ? 1.0 : i & 1 ? 4.0 : 2.0);
    }
    return sum / (3.0 * n);
}

static asp_status compensated_dielectric_prepare(asp_material *out, asp_error *err)
{
    int thin = out->a.r > 0.0;
    double eta = out->c.r, crosses = mean_crossing(eta < 1.0 ? 1.0 / eta : eta, thin), m_o, m_i, most;
    (void)err;
    if (thin) {
        /* what a facet does not reflect leaves it as if reflected: E is that of perfect mirrors */
        asp_material mirror = asp_mirror(&out->ndf, out->mask);
        aspi_energy_prepare(&mirror);
        memcpy(out->energy, mirror.energy, sizeof out->energy);
        memcpy(out->energy + ENERGY_INSIDE, mirror.energy, (ENERGY_INSIDE - ENERGY_TABLE) * sizeof(double));
    } else {
        aspi_energy_prepare_sides(out);
    }
    m_o = aspi_max_64(1.0 - out->energy[ENERGY_MEAN], 1e-12);
    m_i = aspi_max_64(1.0 - out->energy[ENERGY_INSIDE + ENERGY_MEAN], 1e-12);
    most = aspi_max_64(m_o, m_i);
    /* A_oi, A_io, A_oo, A_ii; from the denser side eta^2 less crosses */
    out->d.r = crosses / most * (thin || eta > 1.0 ? 1.0 : eta * eta);
    out->d.g = crosses / most / (thin || eta < 1.0 ? 1.0 : eta * eta);
    out->b.g = (1.0 - out->d.r * m_i) / m_o;
    out->b.b = (1.0 - out->d.g * m_o) / m_i;
    /* the shares that cross */
    out->a.g = out->d.r * m_i;
    out->a.b = out->d.g * m_o;
    return ASP_OK;
}

static asp_status compensated_dielectric_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    asp_status s = aspi_parse_compensation(spec, out, err);
    return s ? s : asp_bsdf_dielectric.parse(spec, out, err);
}

static const aspi_bsdf_key compensated_dielectric_keys[] = {
    ASPI_COMPENSATION_KEY, ASPI_DIELECTRIC_KEYS, { NULL, NULL }
};

ASP_RECORD asp_bsdf asp_bsdf_compensated_dielectric = {
    "compensated_dielectric", "Rough dielectric, energy given back", "Kulla, Conty 2017; Turquin 2019",
    compensated_dielectric_keys, 0, ASPI_FACETS_NONE, compensated_dielectric_parse,
    compensated_dielectric_prepare, ASPI_BSDF_OWN(compensated_dielectric)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/energy_at.h"
#include "bsdf/reflection.h"
#include "bsdf/refraction.h"

#ifndef COMPENSATED_DIELECTRIC_NAMES
#define COMPENSATED_DIELECTRIC_NAMES
#define energy_of ASP_NDF_NAME(_energy_of)
#define side_energy ASP_NDF_NAME(_side_energy)
#define given_back ASP_NDF_NAME(_given_back)
#define crossing_share ASP_NDF_NAME(_crossing_share)
#define lobe_share ASP_NDF_NAME(_lobe_share)
#define rest_density ASP_NDF_NAME(_rest_density)
#endif

ASP_FN const asp_real *energy_of(const asp_mat *mat, asp_real z)
{
    return z < R(0.0) ? mat->energy + ENERGY_INSIDE : mat->energy;
}

/* E on the side of w. */
ASP_FN asp_real side_energy(const asp_mat *mat, asp_v3 w)
{
    asp_v3 v = aspi_turned(w, w.z < R(0.0) ? R(-1.0) : R(1.0), mat->a.r > R(0.0));
    return aspi_energy_at(mat, energy_of(mat, w.z), v);
}

/* The lobe of what is given back, without a cosine. */
ASP_FN asp_real given_back(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    int inside = wi.z < R(0.0), crosses = inside != (wo.z < R(0.0));
    int scales = crosses && aspi_crossing_scales(mat->transport, mat->a.r);
    asp_real A, scale = aspi_crossing_scale(inside ? mat->c.r : R(1.0) / mat->c.r, scales);
    if (mat->b.r == R(COMPENSATED_TURQUIN) || mat->c.r == R(1.0) || wi.z == R(0.0) || wo.z == R(0.0))
        return R(0.0);
    A = crosses ? (inside ? mat->d.g : mat->d.r) : (inside ? mat->b.b : mat->b.g);
    return scale * R(1.0 / ASP_PI) * A * (R(1.0) - side_energy(mat, wi)) * (R(1.0) - side_energy(mat, wo));
}

/* The share of samples spent on visible normals. */
ASP_FN asp_real lobe_share(const asp_mat *mat, asp_v3 wi)
{
    return mat->b.r == R(COMPENSATED_TURQUIN) || mat->c.r == R(1.0)
         ? R(1.0) : aspi_min(aspi_max(side_energy(mat, wi), R(0.1)), R(0.9999));
}

/* Of the other samples this share crosses: A m of the other side. */
ASP_FN asp_real crossing_share(const asp_mat *mat, asp_v3 wi)
{
    return wi.z < R(0.0) ? mat->a.b : mat->a.g;
}

ASP_FN asp_real rest_density(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_real p = crossing_share(mat, wi);
    p = (wi.z < R(0.0)) != (wo.z < R(0.0)) ? p : R(1.0) - p;
    return wi.z == R(0.0) ? R(0.0) : p * aspi_rest_density(energy_of(mat, wo.z), aspi_abs(wo.z));
}

static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    asp_real f, scale = R(1.0);
    asp_bsdf_dielectric.ASPI_CALL(eval)(mat, wi, wo, cosine, out);
    if (mat->b.r == R(COMPENSATED_TURQUIN))
        scale = R(1.0) / aspi_max(side_energy(mat, *wi), R(1e-3));
    f = out->r * scale + given_back(mat, *wi, *wo) * (cosine ? aspi_abs(wo->z) : R(1.0));
    out->r = out->g = out->b = f;
}

static asp_real bsdf_pdf(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    asp_real share = lobe_share(mat, *wi), p = asp_bsdf_dielectric.ASPI_CALL(pdf)(mat, wi, wo);
    return share < R(1.0) ? share * p + (R(1.0) - share) * rest_density(mat, *wi, *wo) : p;
}

static asp_sampled bsdf_sample(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    asp_sampled out;
    asp_real share = lobe_share(mat, wi), pdf, by, w;
    if (u3 < share || !(share < R(1.0))) {
        out = asp_bsdf_dielectric.ASPI_CALL(sample)(mat, wi, u1, u2, share < R(1.0) ? u3 / share : u3);
        if (!(share < R(1.0))) {
            w = mat->b.r == R(COMPENSATED_TURQUIN) && mat->c.r != R(1.0)
              ? out.weight.r / aspi_max(side_energy(mat, wi), R(1e-3)) : out.weight.r;
        } else if (out.pdf > R(0.0)) {
            /* the facet's own weight: wo carries the facet in its last digits only */
            pdf = share * out.pdf + (R(1.0) - share) * rest_density(mat, wi, out.wo);
            w = out.weight.r * (out.pdf / pdf)
              + given_back(mat, wi, out.wo) * aspi_abs(out.wo.z) / pdf;
            out.pdf = pdf;
        } else {
            return out;
        }
    } else {
        by = (u3 - share) / (R(1.0) - share) < crossing_share(mat, wi) ? R(-1.0) : R(1.0);
        by = wi.z < R(0.0) ? -by : by;
        out.wo = aspi_rest_lobe(energy_of(mat, by), wi, u1, u2);
        out.wo.z = by * out.wo.z;
        out.pdf = bsdf_pdf(mat, &wi, &out.wo);
        bsdf_eval(mat, &wi, &out.wo, 1, &out.weight);
        w = out.pdf > R(0.0) ? out.weight.r / out.pdf : out.pdf;
    }
    out.weight.r = out.weight.g = out.weight.b = w;
    return out;
}
#endif
