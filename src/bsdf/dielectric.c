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
    /* its kin know no films */
    return s || !aspi_bsdf_has(out->model, "film") ? s : aspi_parse_film(spec, out, err);
}

aspi_dielectric_part aspi_dielectric_part_of(const asp_material *mat, asp_vec3 wi, asp_vec3 wo)
{
    aspi_dielectric_part out;
    dielectric_case_64 k;
    out.f = dielectric_part_as_64(mat, wi, wo, 0, mat->a.r > 0.0, 0, mat->mask, &k);
    out.c = k.c;
    out.eta = k.eta;
    out.crosses = k.refracts;
    return out;
}

static const aspi_bsdf_key dielectric_keys[] = { ASPI_DIELECTRIC_KEYS, ASPI_FILM_KEYS, { NULL, NULL } };

ASP_RECORD asp_bsdf asp_bsdf_dielectric = {
    "dielectric", "Rough dielectric", "Walter et al. 2007, eqs. 20-21", dielectric_keys, 0,
    ASPI_FACETS_REFRACT, dielectric_parse, NULL, ASPI_BSDF_OWN_BLOCKS(dielectric)
};

#else
#include "asperity/elementary.h"
#include "bsdf/beta.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/ops.h"
#include "bsdf/reflection.h"
#include "bsdf/refraction.h"

#ifndef DIELECTRIC_NAMES
#define DIELECTRIC_NAMES
#define case_of ASP_NDF_NAME(_case)
#define make_case ASP_NDF_NAME(_make)
#define case_at ASP_NDF_NAME(_case_at)
#define lit ASP_NDF_NAME(_lit)
#define eval_as ASP_NDF_NAME(_eval_as)
#define part_as ASP_NDF_NAME(_part_as)
#define staying_value ASP_NDF_NAME(_staying_value)
#define crossing_value ASP_NDF_NAME(_crossing_value)
#define plain ASP_NDF_NAME(_plain)
#define join_n ASP_NDF_NAME(_join_n)
#define joined ASP_NDF_NAME(_joined)
#define joined_case ASP_NDF_NAME(_joined_case)
#define refracted_masking ASP_NDF_NAME(_refracted_masking)
#define area_over ASP_NDF_NAME(_area_over)
#define inverse_of ASP_NDF_NAME(_inverse_of)
#define lengthened ASP_NDF_NAME(_lengthened)
#define joint_reflected ASP_NDF_NAME(_joint_reflected)
#define facet_density ASP_NDF_NAME(_facet_density)
#define index_of ASP_NDF_NAME(_index_of)
#define sample_as ASP_NDF_NAME(_sample_as)
#define weight_of ASP_NDF_NAME(_weight_of)
#define sample_thin ASP_NDF_NAME(_sample_thin)
#define nothing_of ASP_NDF_NAME(_nothing_of)
#define sample_film ASP_NDF_NAME(_sample_film)
#define sheets ASP_NDF_NAME(_sheets)
#define crossing_weight ASP_NDF_NAME(_crossing_weight)
#define staying_weight ASP_NDF_NAME(_staying_weight)
#endif

/* By time reversal a film that absorbs nothing looks alike from both sides: its table is over the cosine on the less
 * dense one, where light is never reflected totally. */
void aspi_film_shares(const asp_mat *mat, asp_real c, asp_real eta, asp_real F[3])
{
    asp_real u = aspi_unit_cosine(c), g2 = aspi_other_side2(u, eta);
    int i;
    aspi_film_colours(mat, eta < R(1.0) ? aspi_sqrt(aspi_max(g2, R(0.0))) / eta : u, F);
    for (i = 0; i < 3; i++)
        F[i] = g2 <= R(0.0) ? R(1.0) : F[i];
}

/* A pair of directions with wi above: which facet joins them, and F there, in the mean and of each channel. */
typedef struct case_of {
    asp_v3 wi, wo, m;
    asp_real eta, c, wm, F;      /* wi.m, wo.m */
    asp_real colours[3];
    asp_real sigma_i;
    int refracts, dark;
} case_of;

ASP_FN void sheets(asp_real F[3])
{
    F[0] = aspi_sheet(F[0]);
    F[1] = aspi_sheet(F[1]);
    F[2] = aspi_sheet(F[2]);
}

/* wi above, seen from its side; without F. */
ASP_FN case_of case_at(asp_v3 wi, asp_v3 wo, asp_real eta, int thin)
{
    case_of k;
    k.wi = wi;
    k.wo = wo;
    k.eta = eta;
    k.refracts = wo.z < R(0.0);
    k.wo.z = thin ? aspi_abs(wo.z) : wo.z;
    if (k.refracts && !thin)
        k.m = aspi_bent_half(k.wi, k.wo, eta);
    else
        k.m = aspi_half_vector(k.wi, k.wo);
    k.c = aspi_dot(k.wi, k.m);
    k.wm = aspi_dot(k.wo, k.m);
    return k;
}

ASP_FN int lit(const case_of *k, int thin)
{
    return (k->c > R(0.0)) & (k->m.z > ASP_FLAT) & (k->wi.z > R(0.0)) & (k->wo.z != R(0.0))
         & !(k->refracts & !thin & (k->wm >= R(0.0)));
}

/* The index of the other side over that of the side of `sign`. */
ASP_FN asp_real index_of(asp_real sign, asp_real eta, asp_real inverse) { return sign < R(0.0) ? inverse : eta; }

ASP_FN case_of make_case(const asp_mat *mat, asp_v3 wi, asp_v3 wo, int thin, int film)
{
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0), eta = sign < R(0.0) && !thin ? R(1.0) / mat->c.r : mat->c.r;
    case_of k = case_at(aspi_turned(wi, sign, thin), aspi_turned(wo, sign, thin), eta, thin);
    k.dark = !lit(&k, thin) || mat->c.r == R(1.0);
    k.sigma_i = aspi_sigma_of(&mat->ndf, k.wi);
    aspi_reflected_shares(mat, film, k.c, eta, k.colours);
    if (thin && !film) /* a film's table is the sheet's */
        sheets(k.colours);
    k.F = aspi_mean_share(film, k.colours);
    return k;
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
    return aspi_beta_is_near(a, b) ? aspi_beta_near_1(a, b) : aspi_beta(a, b);
}

/* G2 / (ci co) of a reflection. */
ASP_FN asp_real joint_reflected(const asp_shape *shape, asp_v3 wi, asp_v3 wo, asp_real sigma_i, asp_real sigma_o,
                                asp_real mz, asp_real c, int mask)
{
    asp_real si = aspi_masked(shape, wi, sigma_i, mask), so = aspi_masked(shape, wo, sigma_o, mask);
    return aspi_joint(wi.z, wo.z, si, so, mz, c, c, mask);
}

/* f, but for the share F or 1 - F, of what stays on its side by J = G2/(ci co); and of what crosses, times co. */
ASP_FN asp_real staying_value(asp_real D, asp_real J) { return aspi_finite(R(0.25) * D * J); }

ASP_FN asp_real crossing_value(const case_of *k, asp_real D, asp_real G2, asp_real scale)
{
    return aspi_finite(k->c * D * aspi_bent_density(k->c, k->wm, k->eta) * G2 / k->wi.z) * scale;
}

/* f times |cos_o|^cosine, but for the share. */
ASP_FN asp_real part_as(const asp_mat *mat, asp_v3 wi, asp_v3 wo, int cosine, int thin, int film, int mask, case_of *at)
{
    case_of k = make_case(mat, wi, wo, thin, film);
    asp_real f = k.c * R(0.0), D, so, co = aspi_abs(wo.z);
    if (!k.dark) {
        D = aspi_density_of(&mat->ndf, k.m);
        if (!k.refracts || thin) {
            so = aspi_sigma_of(&mat->ndf, k.wo);
            f = staying_value(D, joint_reflected(&mat->ndf, k.wi, k.wo, k.sigma_i, so, k.m.z, k.c, mask));
            f = cosine ? f * co : f;
        } else {
            asp_v3 below = aspi_turned(k.wo, R(-1.0), 0);
            asp_real a = area_over(&mat->ndf, k.wi, k.sigma_i, inverse_of(k.wi.z), mask), b;
            so = aspi_sigma_of(&mat->ndf, below);
            b = area_over(&mat->ndf, below, so, inverse_of(co), mask);
            f = crossing_value(&k, D, refracted_masking(a, b, k.m.z, k.wi.z, co, k.c, -k.wm, mask),
                               aspi_crossing_scale(R(1.0) / k.eta, aspi_crossing_scales(mat->transport, mat->a.r)));
            f = cosine ? f : f / co;
        }
    }
    *at = k;
    return f;
}

ASP_FN asp_c3 eval_as(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, int thin, int film, int mask)
{
    case_of k;
    asp_real f = part_as(mat, *wi, *wo, cosine, thin, film, mask, &k);
    return aspi_tinted(film, k.colours, k.F, k.refracts, (k.refracts ? R(1.0) - k.F : k.F) * f);
}

static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    /* constants spare the default the others' arithmetic */
    int thin = mat->a.r > R(0.0), film = aspi_has_film(mat);
    *out = thin | film | mat->mask ? eval_as(mat, wi, wo, cosine, thin, film, mat->mask)
                                   : eval_as(mat, wi, wo, cosine, 0, 0, 0);
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
    int thin = mat->a.r > R(0.0);
    case_of k = aspi_has_film(mat) ? make_case(mat, *wi, *wo, thin, 1) : make_case(mat, *wi, *wo, thin, 0);
    if (k.dark)
        return k.c * R(0.0);
    return facet_density(&k, aspi_density_of(&mat->ndf, k.m), thin);
}

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

/* The weight of light from v to wo by a facet of cosines mz, c_i and c_o, which only V-cavities ask for; over is
 * 1/eta. */
ASP_FN asp_real weight_of(const asp_mat *mat, asp_v3 v, asp_v3 wo, asp_real sigma_i, asp_real sigma_o, asp_real mz,
                          asp_real c_i, asp_real c_o, asp_real over, int crosses, int mask)
{
    const asp_shape *shape = &mat->ndf;
    if (crosses) {
        asp_real over_i = inverse_of(v.z), a = area_over(shape, v, sigma_i, over_i, mask), up = -wo.z, b;
        b = area_over(shape, aspi_turned(wo, R(-1.0), 0), sigma_o, inverse_of(up), mask);
        return crossing_weight(sigma_i, over_i, aspi_crossing_scale(over, aspi_crossing_scales(mat->transport, mat->a.r)))
             * refracted_masking(a, b, mz, v.z, up, c_i, c_o, mask);
    }
    return staying_weight(shape, v, wo, sigma_i, sigma_o, mz, c_i, mask);
}

/* A visible normal, then reflection or refraction by F. What single scattering loses, light into the surface
 * again, has density and weight 0; by facets too steep for a density it is 0 alone. */
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
    up = u3 >= s.F ? -wo.z : wo.z;
    weight = weight_of(mat, v, wo, s.sigma_i, s.sigma_o, s.m_z * scale, s.wi_m * scale, over * s.wo_m * scale, over,
                       u3 >= s.F, mask);
    out.wo = lengthened(wo, sign);
    out.pdf = up <= R(0.0) ? R(0.0) : s.pdf;
    weight = up <= R(0.0) ? R(0.0) : weight;
    out.weight.r = out.weight.g = out.weight.b = weight;
    return out;
}

/* The same under a film, with the probability of the channels' mean share and weights of their own. */
static asp_sampled sample_film(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    const asp_shape *shape = &mat->ndf;
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0), nothing = aspi_abs((wi.x + wi.y + wi.z) * R(0.0));
    asp_real m[3], so, up, weight;
    asp_sampled out;
    case_of k;
    k.wi = aspi_turned(wi, sign, 0);
    if (k.wi.z <= R(0.0) || nothing != R(0.0))
        return nothing_of(wi, nothing);
    ASPI_OPS(shape).visible(shape, k.wi.x, k.wi.y, k.wi.z, u1, u2, m);
    k.m = aspi_vector(m[0], m[1], m[2]);
    k.eta = index_of(sign, mat->c.r, R(1.0) / mat->c.r);
    k.c = aspi_dot(k.wi, k.m);
    k.sigma_i = aspi_sigma_of(shape, k.wi);
    aspi_film_shares(mat, k.c, k.eta, k.colours);
    k.F = aspi_mean_share(1, k.colours);
    k.refracts = u3 >= k.F;
    k.wo = lengthened(k.refracts ? aspi_refract(k.wi, k.m, k.eta) : aspi_reflect(k.wi, k.m), R(1.0));
    k.wm = aspi_dot(k.wo, k.m);
    up = k.refracts ? -k.wo.z : k.wo.z;
    so = aspi_sigma_of(shape, aspi_turned(k.wo, k.refracts ? R(-1.0) : R(1.0), 0));
    weight = weight_of(mat, k.wi, k.wo, k.sigma_i, so, k.m.z, k.c, -k.wm, R(1.0) / k.eta, k.refracts, mat->mask);
    out.pdf = up <= R(0.0) ? R(0.0) : facet_density(&k, aspi_density_of(shape, k.m), 0);
    out.wo = aspi_turned(k.wo, sign, 0);
    out.weight = aspi_tinted(1, k.colours, k.F, k.refracts, up <= R(0.0) ? R(0.0) : weight);
    return out;
}

/* A sheet: what passes leaves in the mirror image of what is reflected. */
static asp_sampled sample_thin(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    const asp_shape *shape = &mat->ndf;
    asp_real sign = wi.z < R(0.0) ? R(-1.0) : R(1.0), nothing = aspi_abs((wi.x + wi.y + wi.z) * R(0.0));
    asp_real weight, c, F, colours[3];
    asp_v3 v = aspi_turned(wi, sign, 1), wo;
    asp_mirrored s;
    asp_sampled out;
    int passes, film = aspi_has_film(mat);
    if (v.z <= R(0.0) || nothing != R(0.0))
        return nothing_of(wi, nothing);
    ASPI_OPS(shape).reflect(shape, v.x, v.y, v.z, u1, u2, &s);
    c = aspi_sqrt(aspi_unit_cosine(s.cosine2));
    aspi_reflected_shares(mat, film, c, mat->c.r, colours);
    if (!film)
        sheets(colours);
    F = aspi_mean_share(film, colours);
    passes = u3 >= F;
    wo = aspi_vector(s.wo_x, s.wo_y, s.wo_z);
    weight = staying_weight(shape, v, wo, s.sigma_i, s.sigma_o, aspi_sqrt(aspi_above(s.m_z2)), c, mat->mask);
    out.pdf = wo.z <= R(0.0) ? R(0.0) : (passes ? R(1.0) - F : F) * s.pdf;
    weight = wo.z <= R(0.0) ? R(0.0) : weight;
    out.wo = aspi_turned(lengthened(wo, R(1.0)), passes ? -sign : sign, 1);
    out.weight = aspi_tinted(film, colours, F, passes, weight);
    return out;
}

ASP_CLONES_SINGLE static asp_sampled bsdf_sample(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2,
                                                 asp_real u3)
{
    asp_sampled out;
    /* constants spare the default the others' arithmetic */
    if (mat->a.r > R(0.0) && mat->c.r != R(1.0))
        return sample_thin(mat, wi, u1, u2, u3);
    if (aspi_has_film(mat))
        return sample_film(mat, wi, u1, u2, u3);
    if (mat->c.r != R(1.0))
        return mat->mask == 0 ? sample_as(mat, wi, u1, u2, u3, 0) : sample_as(mat, wi, u1, u2, u3, mat->mask);
    /* nothing is there: the light goes on */
    out.pdf = (wi.x + wi.y + wi.z) * R(0.0);
    out.wo = aspi_turned(wi, R(-1.0), 0);
    out.weight.r = out.weight.g = out.weight.b = R(1.0) + out.pdf;
    return out;
}

/* Bare half spaces with the default masking, which blocks are for. */
ASP_FN int plain(const asp_mat *mat)
{
    return !(mat->a.r > R(0.0)) && mat->c.r != R(1.0) && mat->mask == 0 && !aspi_has_film(mat);
}

/* A block of pairs: wi and wo turned up, the facets that join them, D and sigma. */
typedef struct joined {
    asp_real vx[ASP_BLOCK], vy[ASP_BLOCK], vz[ASP_BLOCK], ux[ASP_BLOCK], uy[ASP_BLOCK], uz[ASP_BLOCK];
    asp_real mx[ASP_BLOCK], my[ASP_BLOCK], mz[ASP_BLOCK], c[ASP_BLOCK], wm[ASP_BLOCK], F[ASP_BLOCK], eta[ASP_BLOCK];
    asp_real D[ASP_BLOCK], si[ASP_BLOCK], so[ASP_BLOCK], side[ASP_BLOCK];
} joined;

ASP_FN void join_n(const asp_mat *mat, size_t n, const asp_real *const wi[3], const asp_real *const wo[3], joined *j)
{
    const asp_real *ix = wi[0], *iy = wi[1], *iz = wi[2], *ox = wo[0], *oy = wo[1], *oz = wo[2];
    asp_real index = mat->c.r, inverse = R(1.0) / mat->c.r;
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real sign = iz[i] < R(0.0) ? R(-1.0) : R(1.0), eta = index_of(iz[i], index, inverse), up;
        case_of k = case_at(aspi_turned(aspi_vector(ix[i], iy[i], iz[i]), sign, 0),
                            aspi_turned(aspi_vector(ox[i], oy[i], oz[i]), sign, 0), eta, 0);
        up = k.refracts ? R(-1.0) : R(1.0);
        j->vx[i] = k.wi.x;
        j->vy[i] = k.wi.y;
        j->vz[i] = k.wi.z;
        j->ux[i] = up * k.wo.x;
        j->uy[i] = up * k.wo.y;
        j->uz[i] = up * k.wo.z;
        j->mx[i] = k.m.x;
        j->my[i] = k.m.y;
        j->mz[i] = k.m.z;
        j->c[i] = k.c;
        j->wm[i] = k.wm;
        j->F[i] = aspi_fresnel_dielectric(k.c, eta);
        j->eta[i] = eta;
        j->side[i] = up;
    }
    ASPI_OPS(&mat->ndf).density_n(&mat->ndf, n, j->mx, j->my, j->mz, j->D);
    ASPI_OPS(&mat->ndf).sigma_n(&mat->ndf, n, R(1.0), j->vx, j->vy, j->vz, j->si);
}

ASP_FN case_of joined_case(const joined *j, size_t i)
{
    case_of k;
    k.wi = aspi_vector(j->vx[i], j->vy[i], j->vz[i]);
    k.wo = aspi_vector(j->ux[i], j->uy[i], j->uz[i]);
    k.m = aspi_vector(j->mx[i], j->my[i], j->mz[i]);
    k.eta = j->eta[i];
    k.c = j->c[i];
    k.wm = j->wm[i];
    k.F = j->F[i];
    k.sigma_i = j->si[i];
    k.refracts = j->side[i] < R(0.0);
    return k;
}

ASP_CLONES static int bsdf_eval_n(const asp_mat *mat, size_t n, const asp_real *const wi[3],
                                  const asp_real *const wo[3], int cosine, asp_real *out)
{
    const asp_shape *shape = &mat->ndf;
    int scales = aspi_crossing_scales(mat->transport, mat->a.r);
    asp_real above = aspi_crossing_scale(R(1.0) / mat->c.r, scales), below = aspi_crossing_scale(mat->c.r, scales);
    asp_real A[ASP_BLOCK], B[ASP_BLOCK], G2[ASP_BLOCK];
    int far[ASP_BLOCK];
    const asp_real *iz = wi[2];
    joined j;
    size_t i;
    if (!plain(mat) || !n)
        return 0;
    join_n(mat, n, wi, wo, &j);
    ASPI_OPS(shape).sigma_n(shape, n, R(1.0), j.ux, j.uy, j.uz, j.so);
    for (i = 0; i < n; i++) {
        case_of k = joined_case(&j, i);
        asp_real a = area_over(shape, k.wi, k.sigma_i, inverse_of(k.wi.z), 0);
        asp_real b = area_over(shape, k.wo, j.so[i], inverse_of(k.wo.z), 0);
        A[i] = a;
        B[i] = b;
        far[i] = k.refracts & lit(&k, 0) & !aspi_beta_is_near(a, b);
        G2[i] = aspi_beta_near(a, b);
    }
    aspi_beta_n(n, A, B, far, G2);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        case_of k = joined_case(&j, i);
        asp_real co = k.wo.z, J = joint_reflected(shape, k.wi, k.wo, k.sigma_i, j.so[i], R(0.0), R(0.0), 0);
        asp_real stays = staying_value(j.D[i], J);
        asp_real crosses = crossing_value(&k, j.D[i], G2[i], index_of(iz[i], above, below));
        asp_real f;
        stays = cosine ? stays * co : stays;
        crosses = cosine ? crosses : crosses / co;
        f = aspi_select(k.refracts, (R(1.0) - k.F) * crosses, k.F * stays);
        out[i] = aspi_select(lit(&k, 0), f, k.c * R(0.0));
    }
    return 1;
}

ASP_CLONES static int bsdf_pdf_n(const asp_mat *mat, size_t n, const asp_real *const wi[3],
                                 const asp_real *const wo[3], asp_real *out)
{
    joined j;
    size_t i;
    if (!plain(mat) || !n)
        return 0;
    join_n(mat, n, wi, wo, &j);
    for (i = 0; i < n; i++) {
        case_of k = joined_case(&j, i);
        out[i] = aspi_select(lit(&k, 0), facet_density(&k, j.D[i], 0), k.c * R(0.0));
    }
    return 1;
}

/* Reflected and refracted alike. Outputs may be inputs: they are written last. */
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
    int scales = aspi_crossing_scales(mat->transport, mat->a.r);
    asp_real above = aspi_crossing_scale(inverse, scales), below = aspi_crossing_scale(index, scales);
    asp_split_rays out;
    size_t i;
    if (!plain(mat) || !n)
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
        far[i] = (u3[i] >= F[i]) & !aspi_beta_is_near(a, o);
        G2[i] = aspi_beta_near(a, o);
    }
    aspi_beta_n(n, A, B, far, G2);
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
        w = aspi_select(lost, nothing, w);
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
#endif
