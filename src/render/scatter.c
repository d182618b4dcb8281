/* scatter.c - sampling what scatters: materials by themselves, functions by a mixture */
#include "render/scatter.h"
#include "core/rng.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static asp_cvec3s read_directions(const aspi_directions *d)
{
    return (asp_cvec3s){ d->x, d->y, d->z };
}

static asp_vec3 get(const aspi_directions *d, size_t i)
{
    return (asp_vec3){ d->x[i], d->y[i], d->z[i] };
}

/* ------------------------------------------------------------------ a mixture for any function
 *
 * A cosine lobe, so that no direction is forgotten, and either the proposal or five lobes of facets
 * with D proportional to cos^n (Blinn 1977), whose widths cover measured lobes from mirror-like paint up. */

#define LOBES 5
static const double exponents[LOBES] = { 6, 60, 550, 5000, 50000 };

#define COSINE_SHARE_PROPOSAL 0.15
#define COSINE_SHARE_LOBES 0.28         /* 0.144 for each lobe */

static double cosine_share(const aspi_scatter *scatter)
{
    return scatter->proposal ? COSINE_SHARE_PROPOSAL : COSINE_SHARE_LOBES;
}

static double mixture_pdf(const aspi_scatter *scatter, asp_vec3 wi, asp_vec3 wo)
{
    double share = cosine_share(scatter), pdf = share * fmax(0, wo.z) / PI;
    if (scatter->proposal)
        return pdf + (1 - share) * asp_pdf(scatter->proposal, wi, wo);
    asp_vec3 h = { wi.x + wo.x, wi.y + wo.y, wi.z + wo.z };
    double length = sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
    if (!(h.z > 0))
        return pdf;
    /* density of m is (n + 2)/(2 pi) cos^(n+1); reflection divides it by 4 wi.m, and |h| = 2 wi.m */
    double c = h.z / length, sum = 0;
    for (int k = 0; k < LOBES; k++)
        sum += (exponents[k] + 2) * pow(c, exponents[k] + 1);
    return pdf + (1 - share) / LOBES * sum / (2 * PI) / (2 * length);
}

static asp_vec3 sample_cosine(double u1, double u2)
{
    double r = sqrt(u1), z = sqrt(1 - u1);
    return (asp_vec3){ r * cos(2 * PI * u2), r * sin(2 * PI * u2), z };
}

static asp_vec3 sample_lobe(double exponent, asp_vec3 wi, double u1, double u2)
{
    double c = pow(1 - u1, 1 / (exponent + 2)), s = sqrt(fmax(0, 1 - c * c));
    asp_vec3 m = { s * cos(2 * PI * u2), s * sin(2 * PI * u2), c };
    double twice = 2 * (wi.x * m.x + wi.y * m.y + wi.z * m.z);
    return (asp_vec3){ twice * m.x - wi.x, twice * m.y - wi.y, twice * m.z - wi.z };
}

/* u1 chooses the part of the mixture and is stretched to [0, 1) again. */
static asp_vec3 mixture_sample(const aspi_scatter *scatter, asp_vec3 wi, double u1, double u2)
{
    double share = cosine_share(scatter);
    if (u1 < share)
        return sample_cosine(u1 / share, u2);
    u1 = (u1 - share) / (1 - share);
    if (scatter->proposal)
        return asp_sample(scatter->proposal, wi, fmin(u1, 1 - 0x1p-53), u2).wo;
    int k = (int)fmin(LOBES * u1, LOBES - 1);
    return sample_lobe(exponents[k], wi, fmin(LOBES * u1 - k, 1 - 0x1p-53), u2);
}

/* ------------------------------------------------------------------ walks */

double aspi_stream_next(void *stream)
{
    aspi_stream *s = stream;
    return aspi_unit64(aspi_random_at(s->start, s->next++));
}

/* A stream made of two numbers, so that a picture depends on its description alone. */
static aspi_stream stream_of(double a, double b)
{
    uint64_t x, y;
    memcpy(&x, &a, sizeof x);
    memcpy(&y, &b, sizeof y);
    return (aspi_stream){ aspi_random_start(x, y), 0 };
}

static void eval_walk(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                      const aspi_directions *wo, double *pdf, aspi_colours *value)
{
    aspi_stream streams[ASPI_BLOCK];
    asp_cvec3s in = { wi->x, wi->y, wi->z }, out = { wo->x, wo->y, wo->z };
    for (size_t i = 0; i < n; i++)
        streams[i] = stream_of(wi->x[i] + wo->y[i], wi->y[i] - wo->x[i] + wo->z[i]);
    asp_walk_eval_cos_n(scatter->material, n, in, out, aspi_stream_next, streams, sizeof *streams,
                        (asp_rgbs){ value->r, value->g, value->b });
    asp_walk_pdf_n(scatter->material, n, in, out, pdf);
}

/* The weights of the two ways to sample come from asp_walk_pdf on both sides, so that they sum to 1. */
static void sample_walk(const aspi_scatter *scatter, size_t n, const aspi_directions *wi, const double *u1,
                        const double *u2, aspi_directions *wo, double *pdf, aspi_colours *weight)
{
    aspi_stream streams[ASPI_BLOCK];
    for (size_t i = 0; i < n; i++)
        streams[i] = stream_of(u1[i], u2[i]);
    asp_walk_sample_n(scatter->material, n, (asp_cvec3s){ wi->x, wi->y, wi->z }, aspi_stream_next, streams,
                      sizeof *streams, (asp_vec3s){ wo->x, wo->y, wo->z }, pdf,
                      (asp_rgbs){ weight->r, weight->g, weight->b });
}

/* ------------------------------------------------------------------ blocks */

static void eval_function(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                          const aspi_directions *wo, double *pdf, aspi_colours *value)
{
    for (size_t i = 0; i < n; i++) {
        asp_vec3 in = get(wi, i), out = get(wo, i);
        int lit = in.z > 0 && out.z > 0;
        asp_rgb f = lit ? scatter->function(scatter->context, in, out) : (asp_rgb){ 0, 0, 0 };
        double c = lit ? out.z : 0;
        pdf[i] = lit ? mixture_pdf(scatter, in, out) : 0;
        value->r[i] = f.r * c;
        value->g[i] = f.g * c;
        value->b[i] = f.b * c;
    }
}

void aspi_scatter_eval(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                       const aspi_directions *wo, double *pdf, aspi_colours *value)
{
    if (!scatter->material) {
        eval_function(scatter, n, wi, wo, pdf, value);
        return;
    }
    if (scatter->walk) {
        eval_walk(scatter, n, wi, wo, pdf, value);
        return;
    }
    asp_eval_cos_n(scatter->material, n, read_directions(wi), read_directions(wo),
                   (asp_rgbs){ value->r, value->g, value->b });
    asp_pdf_n(scatter->material, n, read_directions(wi), read_directions(wo), pdf);
}

void aspi_scatter_sample(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                         const double *u1, const double *u2, aspi_directions *wo, double *pdf,
                         aspi_colours *weight)
{
    if (scatter->material && scatter->walk) {
        sample_walk(scatter, n, wi, u1, u2, wo, pdf, weight);
        return;
    }
    if (scatter->material) {
        asp_sample_n(scatter->material, n, read_directions(wi), u1, u2,
                     (asp_vec3s){ wo->x, wo->y, wo->z }, pdf,
                     (asp_rgbs){ weight->r, weight->g, weight->b });
        return;
    }
    for (size_t i = 0; i < n; i++) {
        asp_vec3 w = mixture_sample(scatter, get(wi, i), u1[i], u2[i]);
        wo->x[i] = w.x;
        wo->y[i] = w.y;
        wo->z[i] = w.z;
    }
    eval_function(scatter, n, wi, wo, pdf, weight);
    for (size_t i = 0; i < n; i++) {
        double inverse = pdf[i] > 0 ? 1 / pdf[i] : 0;
        weight->r[i] *= inverse;
        weight->g[i] *= inverse;
        weight->b[i] *= inverse;
    }
}
