/* spectrum.c - reflectance by wavelength: metals, thin films, F82 and back; asperity.h section 6 */
#define ASP_PRECISION 64
#include "bsdf/bsdf.h"
#include "bsdf/energy.h"
#include "asperity/fresnel.h"
#include "bsdf/reflection.h"

#define SPECTRUM 41
#define FIRST_NM 380.0
#define STEP_NM 10.0
#define LAST_NM (FIRST_NM + STEP_NM * (SPECTRUM - 1))
#include "core/metals_spectrum.h"

asp_status asp_metal_index(const asp_metal *metal, double nm, double *eta, double *k, asp_error *err)
{
    size_t count, at;
    const asp_metal *all = asp_metals(&count);
    double x, d;
    int i;
    if (!(nm >= FIRST_NM && nm <= LAST_NM))
        return asp_fail_range(err, "wavelength", nm, FIRST_NM, 0, LAST_NM);
    if (metal < all || metal >= all + count)
        return asp_fail(err, ASP_EINVAL, "metal", "not one of asp_metals()");
    at = (size_t)(metal - all);
    x = (nm - FIRST_NM) / STEP_NM;
    i = (int)x < SPECTRUM - 2 ? (int)x : SPECTRUM - 2;
    d = x - i;
    *eta = (1.0 - d) * metal_index[at][0][i] + d * metal_index[at][0][i + 1];
    *k = (1.0 - d) * metal_index[at][1][i] + d * metal_index[at][1][i + 1];
    return ASP_OK;
}

asp_rgb asp_rgb_of_reflectance(asp_reflectance *reflectance, const void *context)
{
    asp_rgb out = { 0.0, 0.0, 0.0 };
    int i;
    for (i = 0; i < SPECTRUM; i++) {
        double value = reflectance(context, FIRST_NM + STEP_NM * i);
        out.r += rgb_weights[0][i] * value;
        out.g += rgb_weights[1][i] * value;
        out.b += rgb_weights[2][i] * value;
    }
    return out;
}

/* ---- complex numbers, four operations of them: C++ and C do not agree on how to write these */

typedef struct complex_number { double re, im; } complex_number;

static complex_number make(double re, double im)
{
    complex_number z;
    z.re = re;
    z.im = im;
    return z;
}

static complex_number add(complex_number a, complex_number b) { return make(a.re + b.re, a.im + b.im); }
static complex_number sub(complex_number a, complex_number b) { return make(a.re - b.re, a.im - b.im); }

static complex_number mul(complex_number a, complex_number b)
{
    return make(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
}

static double norm(complex_number a) { return a.re * a.re + a.im * a.im; }

static complex_number quotient(complex_number a, complex_number b)
{
    double n = norm(b);
    n = n > 0.0 ? n : 1e-300;
    return make((a.re * b.re + a.im * b.im) / n, (a.im * b.re - a.re * b.im) / n);
}

/* The root with both parts >= 0, of a number with im >= 0: a wave that decays inwards. */
static complex_number root(complex_number a)
{
    /* the larger part by the root, the other from re im = a.im/2: nothing cancels */
    double large = aspi_sqrt(0.5 * (aspi_sqrt(norm(a)) + aspi_abs(a.re)));
    double small = large > 0.0 ? 0.5 * a.im / large : 0.0, re, im;
    re = a.re < 0.0 ? small : large;
    im = a.re < 0.0 ? large : small;
    return make(re, im);
}

/* n cos theta of a layer of index n, from the conserved sin^2. */
static complex_number layer(complex_number n, double s2)
{
    return root(sub(mul(n, n), make(s2, 0.0)));
}

/* Amplitudes between two layers: s takes n cos theta, p takes n^2/(n cos theta). */
static complex_number amplitude(complex_number a, complex_number b) { return quotient(sub(a, b), add(a, b)); }

/* r = (r01 + r12 e)/(1 + r01 r12 e), e = exp(2 i delta): Airy's sum over the reflections in the film (Born,
 * Wolf, sec. 7.6). p with the sign of n^2/(n cos), which squares away alike in both. */
double asp_fresnel_film(double c, double film_eta, double thickness, double eta, double k, double nm)
{
    complex_number n0 = make(1.0, 0.0), n1 = make(film_eta, 0.0), n2 = make(eta, k), q0, q1, q2, e;
    double cosine = aspi_unit_cosine(c), s2 = 1.0 - cosine * cosine, total = 0.0, decay;
    asp_vec2 turn;
    int p;
    q0 = make(cosine, 0.0);
    q1 = layer(n1, s2);
    q2 = layer(n2, s2);
    /* phase 4 pi n1 cos1 d / lambda, in turns */
    turn = aspi_sincos2pi(2.0 * q1.re * thickness / nm
                          - (double)(long long)(2.0 * q1.re * thickness / nm));
    decay = aspi_exp(-4.0 * ASP_PI * q1.im * thickness / nm);
    e = make(decay * turn.x, decay * turn.y);
    for (p = 0; p < 2; p++) {
        complex_number a = p ? quotient(q0, mul(n0, n0)) : q0, b = p ? quotient(q1, mul(n1, n1)) : q1;
        complex_number d = p ? quotient(q2, mul(n2, n2)) : q2;
        complex_number r01 = amplitude(a, b), r12 = mul(amplitude(b, d), e);
        total += 0.5 * norm(quotient(add(r01, r12), add(make(1.0, 0.0), mul(r01, r12))));
    }
    return cosine <= 0.0 ? 1.0 : aspi_min(total, 1.0);
}

/* What lies under a material's facets, known by wavelength: a metal of the list by its numbers, else one index. */
typedef struct beneath {
    const asp_metal *metal;
    double eta, k;
} beneath;

static beneath beneath_of(const asp_material *mat)
{
    size_t count, i;
    const asp_metal *metals = asp_metals(&count);
    beneath out;
    out.metal = NULL;
    out.eta = mat->c.r;
    out.k = mat->d.r;
    for (i = 0; i < count; i++)
        if (!memcmp(&metals[i].eta, &mat->c, sizeof mat->c) && !memcmp(&metals[i].k, &mat->d, sizeof mat->d))
            out.metal = &metals[i];
    return out;
}

static void index_at(const beneath *b, double nm, double *eta, double *k)
{
    *eta = b->eta;
    *k = b->k;
    if (b->metal)
        asp_metal_index(b->metal, nm, eta, k, NULL);
}

/* What a film's table integrates over wavelengths. */
typedef struct film {
    beneath under;
    double c, film_eta, thickness;
    int sheet;
} film;

static double film_reflectance(const void *context, double nm)
{
    const film *f = (const film *)context;
    double eta, k, F;
    index_at(&f->under, nm, &eta, &k);
    F = asp_fresnel_film(f->c, f->film_eta, f->thickness, eta, k, nm);
    return f->sheet ? aspi_sheet(F) : F;
}

/* Of glass the cosine is that on its less dense side. */
static void prepare_film(asp_material *out)
{
    const double eta[3] = { out->c.r, out->c.g, out->c.b }, k[3] = { out->d.r, out->d.g, out->d.b };
    int i, channel, glass = out->model->facets == ASPI_FACETS_REFRACT, turned = glass && out->c.r < 1.0;
    film f;
    f.sheet = glass && out->a.r > 0.0;
    f.under = beneath_of(out);
    f.film_eta = out->film_eta;
    f.thickness = out->film;
    for (i = 0; i < ENERGY_FILM_NODES; i++)
        for (channel = 0; channel < 3; channel++) {
            asp_rgb colour;
            double value, c = (double)i / (ENERGY_FILM_NODES - 1);
            f.c = turned && i ? aspi_sqrt(aspi_other_side2(c, 1.0 / eta[0])) * eta[0] : c;
            f.under.eta = eta[channel];
            f.under.k = k[channel];
            colour = asp_rgb_of_reflectance(film_reflectance, &f);
            value = channel == 0 ? colour.r : channel == 1 ? colour.g : colour.b;
            out->energy[ENERGY_FILM + channel * ENERGY_FILM_NODES + i] = aspi_min(aspi_max(value, 0.0), 1.0);
        }
}

asp_status aspi_film(asp_material *out, double film_eta, double thickness, asp_error *err)
{
    if (out->fresnel == ASPI_FRESNEL_ONE || out->fresnel == ASPI_FRESNEL_F82)
        return asp_fail(err, ASP_EINVAL, "film", "a film needs metal or eta beneath it");
    if (out->model->facets == ASPI_FACETS_REFRACT && out->c.r == 1.0)
        return asp_fail(err, ASP_EINVAL, "film", "on a dielectric a film needs an eta other than 1, which bends light");
    out->film = thickness;
    out->film_eta = film_eta;
    out->fresnel = ASPI_FRESNEL_FILM;
    prepare_film(out);
    return ASP_OK;
}

asp_status asp_film(asp_material *mat, double film_eta, double thickness, asp_error *err)
{
    asp_status s;
    if (!aspi_bsdf_has(mat->model, "film"))
        return asp_fail(err, ASP_EINVAL, "film", "this material knows no films");
    if (!(film_eta >= 1.0 && film_eta <= 10.0))
        return asp_fail_range(err, "film_eta", film_eta, 1.0, 0, 10.0);
    if (!(thickness > 0.0 && thickness <= 1e4))
        return asp_fail_range(err, "film", thickness, 0.0, 1, 1e4);
    s = aspi_film(mat, film_eta, thickness, err);
    return !s && mat->model->prepare ? mat->model->prepare(mat, err) : s;
}

/* ---- F82 <-> n, k */

#define C82 (1.0 / 7.0)

void asp_f82_of_index(double eta, double k, double *f0, double *tint)
{
    double schlick;
    *f0 = asp_fresnel_conductor(1.0, eta, k);
    schlick = asp_fresnel_schlick(C82, *f0);
    *tint = asp_fresnel_conductor(C82, eta, k) / schlick;
}

/* The k that gives reflectance f0 along the normal with this eta: f0 ((eta + 1)^2 + k^2) = (eta - 1)^2 + k^2. */
static double k_of(double eta, double f0)
{
    double k2 = (f0 * (eta + 1.0) * (eta + 1.0) - (eta - 1.0) * (eta - 1.0)) / (1.0 - f0);
    return aspi_sqrt(aspi_max(k2, 0.0));
}

/* At given f0 the reflectance at 82 degrees falls while eta rises from its least, (1 - r)/(1 + r), to its
 * largest, (1 + r)/(1 - r), r = sqrt f0 (Gulbrandsen 2014 for the range): bisection. */
asp_status asp_index_of_f82(double f0, double tint, double *eta, double *k, asp_error *err)
{
    double r, low, high, f_low, f_high, target, schlick;
    int i;
    if (!(f0 > 0.0 && f0 < 1.0))
        return asp_fail_range(err, "f0", f0, 0.0, 1, 1.0);
    r = aspi_sqrt(f0);
    low = (1.0 - r) / (1.0 + r);
    high = (1.0 + r) / (1.0 - r);
    schlick = asp_fresnel_schlick(C82, f0);
    f_low = asp_fresnel_conductor(C82, low, k_of(low, f0)) / schlick;
    f_high = asp_fresnel_conductor(C82, high, k_of(high, f0)) / schlick;
    if (!(tint >= aspi_min(f_low, f_high) && tint <= aspi_max(f_low, f_high)))
        return asp_fail_range(err, "tint", tint, aspi_min(f_low, f_high), 0, aspi_max(f_low, f_high));
    target = tint * schlick;
    for (i = 0; i < 200; i++) {
        double middle = 0.5 * (low + high), f = asp_fresnel_conductor(C82, middle, k_of(middle, f0));
        if ((f > target) == (f_low > f_high))
            low = middle;
        else
            high = middle;
    }
    *eta = 0.5 * (low + high);
    *k = k_of(*eta, f0);
    return ASP_OK;
}

/* ---- a material at wavelengths of its own */

/* f of mirror facets, and the cosine at them. */
static double mirror_part(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, double *c)
{
    asp_vec3 m = aspi_half_vector(wi, wo);
    double D = asp_D(&mat->ndf, m);
    *c = aspi_dot(wi, m);
    return aspi_facet_part(&mat->ndf, wi, wo, m.z, *c, asp_sigma(&mat->ndf, wi), asp_sigma(&mat->ndf, wo), 0.25 * D, mat->mask);
}

asp_status asp_eval_spectrum(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, size_t n, const double *eta,
                             const double *k, double *out)
{
    double c, x;
    size_t i;
    if (mat->fresnel == ASPI_FRESNEL_FILM)
        return ASP_EINVAL;
    if (mat->model->facets == ASPI_FACETS_REFRACT) {
        asp_material other = *mat;
        for (i = 0; i < n; i++) {
            other.c.r = eta[i];
            out[i] = asp_eval(&other, wi, wo).r;
        }
        return ASP_OK;
    }
    if (mat->model->facets != ASPI_FACETS_REFLECT)
        return ASP_EINVAL;
    x = mirror_part(mat, wi, wo, &c);
    for (i = 0; i < n; i++)
        out[i] = x * aspi_fresnel_conductor(c, eta[i], k[i]);
    return ASP_OK;
}

/* F of a facet seen at the cosine c. */
static double reflectance_at(const asp_material *mat, const beneath *under, double c, double nm)
{
    double eta, k;
    if (mat->fresnel == ASPI_FRESNEL_ONE)
        return c == c ? 1.0 : c;
    index_at(under, nm, &eta, &k);
    return mat->fresnel == ASPI_FRESNEL_FILM ? asp_fresnel_film(c, mat->film_eta, mat->film, eta, k, nm)
                                             : aspi_fresnel_conductor(c, eta, k);
}

/* The same of a dielectric's. Inside, light under a film is looked at from outside, where it comes out if it is not
 * reflected totally. */
static double split_at(const asp_material *mat, const aspi_dielectric_part *at, double nm)
{
    int inside = at->eta != mat->c.r;
    double F, g2;
    if (mat->fresnel != ASPI_FRESNEL_FILM) {
        F = aspi_fresnel_dielectric(at->c, at->eta);
    } else {
        double c = aspi_unit_cosine(at->c);
        g2 = aspi_other_side2(c, at->eta);
        c = inside ? aspi_sqrt(aspi_max(g2, 0.0)) / at->eta : c;
        F = g2 <= 0.0 ? 1.0 : asp_fresnel_film(c, mat->film_eta, mat->film, mat->c.r, 0.0, nm);
    }
    return mat->a.r > 0.0 ? aspi_sheet(F) : F;
}

asp_status asp_eval_wavelengths(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, size_t n, const double *nm,
                                double *out, asp_error *err)
{
    const asp_rgb *eta = &mat->c, *k = &mat->d;
    beneath under = beneath_of(mat);
    int grey = eta->r == eta->g && eta->g == eta->b && k->r == k->g && k->g == k->b;
    double x, c;
    size_t i;
    if (mat->model->facets != ASPI_FACETS_REFLECT && mat->model->facets != ASPI_FACETS_REFRACT)
        return asp_fail(err, ASP_EINVAL, mat->model->name, "its colours are not known by wavelength");
    if (mat->fresnel == ASPI_FRESNEL_F82 || !(grey || under.metal))
        return asp_fail(err, ASP_EINVAL, mat->fresnel == ASPI_FRESNEL_F82 ? "f0" : "eta",
                        "three channels are not known by wavelength");
    for (i = 0; i < n; i++)
        if (!(nm[i] >= FIRST_NM && nm[i] <= LAST_NM))
            return asp_fail_range(err, "wavelength", nm[i], FIRST_NM, 0, LAST_NM);
    if (mat->model->facets == ASPI_FACETS_REFRACT) {
        aspi_dielectric_part at = aspi_dielectric_part_of(mat, wi, wo);
        for (i = 0; i < n; i++) {
            double F = split_at(mat, &at, nm[i]);
            out[i] = (at.crosses ? 1.0 - F : F) * at.f;
        }
        return ASP_OK;
    }
    x = mirror_part(mat, wi, wo, &c);
    for (i = 0; i < n; i++)
        out[i] = reflectance_at(mat, &under, c, nm[i]) * x;
    return ASP_OK;
}
