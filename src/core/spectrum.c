/* spectrum.c - reflectance by wavelength: metals, thin films, F82 and back; asperity.h section 6 */
#define ASP_PRECISION 64
#include "bsdf/bsdf.h"
#include "bsdf/energy.h"
#include "asperity/fresnel.h"

#define SPECTRUM 41
#define FIRST_NM 380.0
#define STEP_NM 10.0
#include "core/metals_spectrum.h"

asp_status asp_metal_index(const asp_metal *metal, double nm, double *eta, double *k, asp_error *err)
{
    size_t count, at;
    const asp_metal *all = asp_metals(&count);
    double x, d, last = FIRST_NM + STEP_NM * (SPECTRUM - 1);
    int i;
    if (!(nm >= FIRST_NM && nm <= last))
        return asp_fail_range(err, "wavelength", nm, FIRST_NM, 0, last);
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

/* What a film's table integrates over wavelengths. */
typedef struct film {
    const asp_metal *metal;
    double c, film_eta, thickness, eta, k;
} film;

static double film_reflectance(const void *context, double nm)
{
    const film *f = (const film *)context;
    double eta = f->eta, k = f->k;
    if (f->metal)
        asp_metal_index(f->metal, nm, &eta, &k, NULL);
    return asp_fresnel_film(f->c, f->film_eta, f->thickness, eta, k, nm);
}

/* Of glass the cosine is that on its less dense side. */
static void prepare_film(asp_material *out, const asp_metal *metal, double film_eta, double thickness)
{
    const double eta[3] = { out->c.r, out->c.g, out->c.b }, k[3] = { out->d.r, out->d.g, out->d.b };
    int i, channel, turned = out->model->facets == ASPI_FACETS_REFRACT && out->c.r < 1.0;
    for (i = 0; i < ENERGY_FILM_NODES; i++)
        for (channel = 0; channel < 3; channel++) {
            film f;
            asp_rgb colour;
            double value, c = (double)i / (ENERGY_FILM_NODES - 1);
            f.metal = metal;
            f.c = turned && i ? aspi_sqrt(aspi_other_side2(c, 1.0 / eta[0])) * eta[0] : c;
            f.film_eta = film_eta;
            f.thickness = thickness;
            f.eta = eta[channel];
            f.k = k[channel];
            colour = asp_rgb_of_reflectance(film_reflectance, &f);
            value = channel == 0 ? colour.r : channel == 1 ? colour.g : colour.b;
            out->energy[ENERGY_FILM + channel * ENERGY_FILM_NODES + i] = aspi_min(aspi_max(value, 0.0), 1.0);
        }
    out->fresnel = ASPI_FRESNEL_FILM;
}

asp_status aspi_film(asp_material *out, const asp_metal *metal, double film_eta, double thickness, asp_error *err)
{
    if (out->fresnel == ASPI_FRESNEL_ONE || out->fresnel == ASPI_FRESNEL_F82)
        return asp_fail(err, ASP_EINVAL, "film", "a film needs metal or eta beneath it");
    if (out->model->facets == ASPI_FACETS_REFRACT && out->c.r == 1.0)
        return asp_fail(err, ASP_EINVAL, "film", "on a dielectric a film needs an eta other than 1, which bends light");
    prepare_film(out, metal, film_eta, thickness);
    return ASP_OK;
}

asp_status asp_film(asp_material *mat, const asp_metal *metal, double film_eta, double thickness, asp_error *err)
{
    double eta, k;
    asp_status s = metal ? asp_metal_index(metal, FIRST_NM, &eta, &k, err) : ASP_OK;
    if (s)
        return s;
    if (!aspi_bsdf_has(mat->model, "film"))
        return asp_fail(err, ASP_EINVAL, "film", "this material knows no films");
    if (!(film_eta >= 1.0 && film_eta <= 10.0))
        return asp_fail_range(err, "film_eta", film_eta, 1.0, 0, 10.0);
    if (!(thickness > 0.0 && thickness <= 1e4))
        return asp_fail_range(err, "film", thickness, 0.0, 1, 1e4);
    s = aspi_film(mat, metal, film_eta, thickness, err);
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

asp_status asp_eval_spectrum(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, size_t n, const double *eta,
                             const double *k, double *out)
{
    asp_material other;
    asp_vec3 m;
    double l2, c, x;
    size_t i;
    if (mat->fresnel == ASPI_FRESNEL_FILM)
        return ASP_EINVAL;
    if (mat->model->facets == ASPI_FACETS_REFRACT) {
        other = *mat;
        for (i = 0; i < n; i++) {
            other.c.r = eta[i];
            out[i] = asp_eval(&other, wi, wo).r;
        }
        return ASP_OK;
    }
    if (mat->model->facets != ASPI_FACETS_REFLECT)
        return ASP_EINVAL;
    m.x = wi.x + wo.x;
    m.y = wi.y + wo.y;
    m.z = wi.z + wo.z;
    l2 = m.x * m.x + m.y * m.y + m.z * m.z;
    c = (wi.x * m.x + wi.y * m.y + wi.z * m.z) / aspi_sqrt(l2 > 0.0 ? l2 : 1.0);
    other = asp_mirror(&mat->ndf, mat->mask);
    x = asp_eval(&other, wi, wo).r;
    for (i = 0; i < n; i++)
        out[i] = x * aspi_fresnel_conductor(c, eta[i], k[i]);
    return ASP_OK;
}
