/* test_film_glass.c - thin films on dielectrics: reflectances by characteristic matrices from either side
 *
 * The matrices are those of Born, Wolf, sec. 1.6; nothing of the library's own film is used. */
#include "bsdf/energy.h"
#include "scatter_test.h"

#include <complex.h>
#include <string.h>

#define NODES 30      /* cells of the library's table over the cosine on the less dense side */

/* A stack seen from the index n0 at the cosine c: a film n1 of thickness d on n2. */
typedef struct stack { double n0, n1, d, n2, c; int sheet; } stack;

static double by_matrices(const void *context, double nm)
{
    const stack *f = (const stack *)context;
    double complex s = f->n0 * sqrt(1 - f->c * f->c), c1 = csqrt(1 - s * s / (f->n1 * f->n1));
    double complex c2 = csqrt(1 - s * s / (f->n2 * f->n2)), phase = 2 * PI * f->n1 * f->d * c1 / nm;
    double total = 0;
    for (int p = 0; p < 2; p++) {
        double complex q0 = p ? f->c / f->n0 : f->n0 * f->c, q1 = p ? c1 / f->n1 : f->n1 * c1, q2 = p ? c2 / f->n2 : f->n2 * c2;
        double complex b = ccos(phase) - I * csin(phase) / q1 * q2, c = ccos(phase) * q2 - I * csin(phase) * q1;
        double r = cabs((q0 * b - c) / (q0 * b + c));
        total += 0.5 * r * r;
    }
    return f->sheet ? 2 * total / (1 + total) : total;
}

static double channel(asp_rgb c, int i) { return i == 0 ? c.r : i == 1 ? c.g : c.b; }

static double share(stack f, int ch) { return fmin(fmax(channel(asp_rgb_of_reflectance(by_matrices, &f), ch), 0), 1); }

static asp_vec3 flip(asp_vec3 w) { return (asp_vec3){ -w.x, -w.y, -w.z }; }

typedef struct glass { double eta, film_eta, film; } glass;
static const glass glasses[] = { { 1.5, 2.2, 300 }, { 1.5, 1.33, 500 }, { 2.4, 1.4, 120 }, { 0.7, 1.8, 260 }, { 0.45, 1.2, 90 } };
enum { GLASSES = sizeof glasses / sizeof *glasses };

static asp_material film_on(glass g, const char *more)
{
    char spec[200];
    snprintf(spec, sizeof spec, "dielectric:eta=%g,film=%g,film_eta=%g%s,ndf=(ggx:alpha=0.3)", g.eta, g.film, g.film_eta, more);
    return material(spec);
}

static asp_material bare(glass g)
{
    asp_ndf surface = ndf("ggx:alpha=0.3");
    return asp_dielectric(&surface, g.eta, 0, ASP_RADIANCE, 0);
}

/* Bare Fresnel reflectance from n0 to n2, which divides out of the bare material. */
static double plain(double n0, double n2, double c)
{
    stack f = { n0, n2, 100, n2, c, 0 };
    return by_matrices(&f, 550);
}

/* What the film changes of reflection and refraction by the level facet, from both sides: shares of its table's cosines
 * to rounding, of others to what the table is stated to be off by. */
static void check_shares(void)
{
    double at = 0, off = 0, total = 0, spread = 0;
    for (int g = 0; g < GLASSES; g++) {
        asp_material film = film_on(glasses[g], ""), none = bare(glasses[g]);
        double eta = glasses[g].eta, less = fmin(eta, 1), more = fmax(eta, 1);
        for (int i = 1; i < 4 * NODES; i++) {
            double rare = i / (4.0 * NODES);                    /* cosines on the less dense side and on the other */
            double dense = sqrt(1 - (1 - rare * rare) * (less * less) / (more * more));
            double c_o = eta > 1 ? rare : dense, c_i = eta > 1 ? dense : rare;
            asp_vec3 out = direction(acos(c_o), 0.3), in = flip(direction(acos(c_i), 0.3));
            stack above = { 1, glasses[g].film_eta, glasses[g].film, eta, c_o, 0 };
            stack below = { eta, glasses[g].film_eta, glasses[g].film, 1, c_i, 0 };
            asp_vec3 away = direction(acos(c_o), 0.3 + PI), deep = flip(direction(acos(c_i), 0.3 + PI));
            asp_rgb f[4] = { asp_eval(&film, out, away), asp_eval(&film, in, deep), asp_eval(&film, out, flip(direction(acos(c_i), 0.3))),
                             asp_eval(&film, in, direction(acos(c_o), 0.3)) };
            double F_o = plain(1, eta, c_o), F_i = plain(eta, 1, c_i);
            double without[4] = { asp_eval(&none, out, away).r / F_o, asp_eval(&none, in, deep).r / F_i,
                                  asp_eval(&none, out, flip(direction(acos(c_i), 0.3))).r / (1 - F_o),
                                  asp_eval(&none, in, direction(acos(c_o), 0.3)).r / (1 - F_i) };
            for (int ch = 0; ch < 3; ch++) {
                double R_o = share(above, ch), R_i = share(below, ch), expected[4] = { R_o, R_i, 1 - R_o, 1 - R_i };
                for (int k = 0; k < 4; k++) {
                    double apart = fabs(channel(f[k], ch) / without[k] - expected[k]);
                    if (i % 4 == 0)
                        at = fmax(at, apart);
                    else
                        off = fmax(off, apart);
                }
                spread = fmax(spread, fabs(expected[0] - share(above, 0)));
            }
        }
        /* beyond the critical angle on the denser side */
        for (int i = 1; i < 20; i++) {
            double c = sqrt(1 - less * less / (more * more)) * i / 20;
            asp_vec3 w = direction(acos(c), 0.3), v = direction(acos(c), 0.3 + PI);
            asp_rgb a = eta > 1 ? asp_eval(&film, flip(w), flip(v)) : asp_eval(&film, w, v);
            asp_rgb b = eta > 1 ? asp_eval(&none, flip(w), flip(v)) : asp_eval(&none, w, v);
            for (int ch = 0; ch < 3; ch++)
                total = fmax(total, fabs(channel(a, ch) / channel(b, ch) - 1));
        }
    }
    expect(spread > 0.1, "films have colours, channels apart by", spread);
    expect(at < 1e-9, "shares by characteristic matrices, reflected and refracted, from both sides", at);
    expect(off < 2e-3, "between the table's cosines", off);
    expect(total < 1e-12, "total reflection is total", total);
}

/* f at a wavelength, for asp_rgb_of_reflectance. */
typedef struct pairing { const asp_material *mat; asp_vec3 wi, wo; } pairing;

static double at_wavelength(const void *context, double nm)
{
    const pairing *p = (const pairing *)context;
    double f = NAN;
    return asp_eval_wavelengths(p->mat, p->wi, p->wo, 1, &nm, &f, NULL) == ASP_OK ? f : NAN;
}

/* By wavelength: each by characteristic matrices, and all of them together the three channels at the table's cosines. */
static void check_wavelengths(void)
{
    static const char *const specs[] = { "conductor:metal=Al,film=60,film_eta=1.6,ndf=(ggx:alpha=0.3)",
                                         "dielectric:eta=1.5,film=300,film_eta=1.8,ndf=(ggx:alpha=0.3)",
                                         "dielectric:eta=0.7,film=260,film_eta=1.8,mask=uncorrelated,ndf=(ggx:alpha=0.3)",
                                         "dielectric:eta=1.5,thin=1,film=300,film_eta=1.8,ndf=(ggx:alpha=0.3)",
                                         "dielectric:eta=1.5,ndf=(ggx:alpha=0.3)", "conductor:eta=1.5,k=0,ndf=(ggx:alpha=0.3)" };
    const double nm[3] = { 380, 551.5, 780 };
    double alone = 0, together = 0;
    for (int k = 0; k < 6; k++) {
        asp_material mat = material(specs[k]);
        double eta = k == 0 ? 1.5 : mat.c.r, less = fmin(eta, 1), more = fmax(eta, 1);
        for (int i = 1; i <= NODES; i++)
            for (int way = 0; way < 4; way++) {
                double rare = (double)i / NODES, dense = sqrt(1 - (1 - rare * rare) * (less * less) / (more * more));
                double c_o = eta > 1 ? rare : dense, c_i = eta > 1 ? dense : rare, c, f[3];
                int below = way & 1, crosses = way >> 1, sheet = k == 3;
                asp_vec3 wi, wo;
                pairing p;
                asp_rgb sum, rgb;
                if (k == 0 || k == 5)
                    below = crosses = 0;
                c = below && !sheet ? c_i : c_o;
                /* from above at the azimuth 0.3 and on to the opposite; from below the way back, but for sheets */
                wi = direction(acos(c), below && !sheet ? 0.3 + PI : 0.3);
                wo = direction(acos(crosses && !sheet ? (below ? c_o : c_i) : c), below && !sheet ? 0.3 : 0.3 + PI);
                wi.z = below ? -wi.z : wi.z;
                wo.z = below != crosses ? -wo.z : wo.z;
                p = (pairing){ &mat, wi, wo };
                sum = asp_rgb_of_reflectance(at_wavelength, &p);
                rgb = asp_eval(&mat, wi, wo);
                for (int ch = 0; ch < 3; ch++)
                    together = fmax(together, fabs(channel(sum, ch) / channel(rgb, ch) - 1));
                if (asp_eval_wavelengths(&mat, wi, wo, 3, nm, f, NULL) != ASP_OK || !(f[1] > 0))
                    alone = 1;
                for (int j = 0; j < 3 && mat.film > 0 && k > 0; j++) {
                    stack s = { below && !sheet ? eta : 1, mat.film_eta, mat.film, below && !sheet ? 1 : eta, c, sheet };
                    asp_material none = mat;
                    double F = by_matrices(&s, nm[j]), less_film = plain(s.n0, s.n2, c), x;
                    none.fresnel = bare(glasses[0]).fresnel;
                    less_film = sheet ? 2 * less_film / (1 + less_film) : less_film;
                    x = asp_eval(&none, wi, wo).r / (crosses ? 1 - less_film : less_film);
                    alone = fmax(alone, fabs(f[j] / ((crosses ? 1 - F : F) * x) - 1));
                }
            }
    }
    expect(alone < 1e-10, "f at a wavelength by characteristic matrices", alone);
    expect(together < 2e-5, "all wavelengths together are the three channels (weights in six digits)", together);
}

/* A sheet has the film on both faces: R = 2F/(1 + F), and the rest passes as if mirrored. */
static void check_sheet(void)
{
    double worst = 0;
    for (int g = 0; g < 3; g++) {
        asp_material film = film_on(glasses[g], ",thin=1");
        asp_ndf surface = ndf("ggx:alpha=0.3");
        asp_material mirror = asp_mirror(&surface, 0);
        for (int i = 1; i <= NODES; i++) {
            double c = (double)i / NODES;
            stack f = { 1, glasses[g].film_eta, glasses[g].film, glasses[g].eta, c, 1 };
            asp_vec3 w = direction(acos(c), 0.3), v = direction(acos(c), 0.3 + PI), through = { v.x, v.y, -v.z };
            asp_rgb a = asp_eval(&film, w, v), b = asp_eval(&film, w, through);
            double x = asp_eval(&mirror, w, v).r;
            for (int ch = 0; ch < 3; ch++) {
                double R = share(f, ch);
                worst = fmax(worst, fmax(fabs(channel(a, ch) / x - R), fabs(channel(b, ch) / x - (1 - R))));
            }
        }
    }
    expect(worst < 1e-9, "sheets with films", worst);
}

/* Channels of walks and of samples carry all light in the mean, of importance, each alone. */
static void check_carried(void)
{
    enum { WALKS = 40000 };
    uint64_t state = 7;
    double worst = 0, once = 0;
    for (int g = 0; g < GLASSES; g++)
        for (int side = 0; side < 2; side++) {
            asp_material film = film_on(glasses[g], ",transport=importance");
            asp_vec3 wi = direction(0.9, 0.2);
            double sum[3] = { 0 }, square[3] = { 0 };
            wi = side ? flip(wi) : wi;
            for (int i = 0; i < WALKS; i++) {
                double u1 = next(&state), u2 = next(&state);
                asp_rgb w = asp_walk_sample(&film, wi, next, &state).weight;
                asp_rgb s = asp_sample_lobe(&film, wi, u1, u2, next(&state)).weight;
                once = fmax(once, (s.r + s.g + s.b) / 3 - 1);
                for (int ch = 0; ch < 3; ch++) {
                    sum[ch] += channel(w, ch) / WALKS;
                    square[ch] += channel(w, ch) * channel(w, ch) / WALKS;
                }
            }
            for (int ch = 0; ch < 3; ch++)
                worst = fmax(worst, fabs(sum[ch] - 1) / sqrt((square[ch] - sum[ch] * sum[ch]) / WALKS));
        }
    expect(worst < 4, "each channel of walks carries all light, in standard errors", worst);
    expect(once < 1e-12, "the mean weight of samples is never above 1", once);
}

/* A film that is too thin to be seen: walks by the same numbers are those over bare glass, each channel and where walls
 * close a skewed surface, but for the film's table, which makes a choice in 10^4 another. */
static void check_walks(void)
{
    enum { WALKS = 20000 };
    static const char *const surfaces[] = { "ggx:alpha=0.6", "ggx:alpha=0.6,mean_x=0.5" };
    double worst = 0;
    for (int k = 0; k < 2; k++) {
        asp_ndf surface = ndf(surfaces[k]);
        asp_material none = asp_dielectric(&surface, 1.5, 0, ASP_RADIANCE, 0), film = none;
        double sum[4][3] = { { 0 } }, bare_sum[4] = { 0 };
        if (asp_film(&film, 1.5, 1e-6, NULL) != ASP_OK)
            worst = 1;
        for (int i = 0; i < WALKS; i++) {
            asp_vec3 wi = direction(1.3 * sqrt((i % 89) / 89.0), i), wo = direction(1.4 * sqrt((i % 97) / 97.0), 2.4 * i);
            uint64_t a = (uint64_t)i, b = a;
            asp_rgb f;
            wi = i & 1 ? flip(wi) : wi;
            wo = i & 2 ? flip(wo) : wo;
            f = asp_walk_eval_cos(&film, wi, wo, next, &a);
            bare_sum[i & 3] += asp_walk_eval_cos(&none, wi, wo, next, &b).g;
            for (int ch = 0; ch < 3; ch++)
                sum[i & 3][ch] += channel(f, ch);
        }
        for (int way = 0; way < 4; way++)
            for (int ch = 0; ch < 3; ch++)
                worst = fmax(worst, fabs(sum[way][ch] / bare_sum[way] - 1));
    }
    expect(worst < 3e-3, "walks under a film that is not there", worst);
}

/* Channels that change places do so in all that comes of them: the mean, by which facets choose, stays. */
static void check_channels(void)
{
    static const char *const specs[] = { "dielectric:eta=1.5,film=300,film_eta=2.2,ndf=(ggx:alpha=0.6,mean_x=0.5)",
                                         "dielectric:eta=1.5,film=300,film_eta=2.2,thin=1,ndf=(ggx:alpha=0.6)" };
    double worst = 0;
    for (int k = 0; k < 2; k++) {
        asp_material mat = material(specs[k]), turned = mat;
        for (int i = 0; i < 3 * ENERGY_FILM_NODES; i++)
            turned.energy[ENERGY_FILM + (i + ENERGY_FILM_NODES) % (3 * ENERGY_FILM_NODES)] = mat.energy[ENERGY_FILM + i];
        for (int i = 0; i < 4000; i++) {
            asp_vec3 wi = direction(1.3 * sqrt((i % 89) / 89.0), i), wo = direction(1.4 * sqrt((i % 97) / 97.0), 2.4 * i);
            uint64_t a = (uint64_t)i, b = a;
            double u1 = next(&a), u2 = next(&b), u3 = next(&a);
            asp_rgb before[3], after[3];
            next(&b);
            wi = i & 1 ? flip(wi) : wi;
            wo = i & 2 ? flip(wo) : wo;
            before[0] = asp_eval(&mat, wi, wo);
            after[0] = asp_eval(&turned, wi, wo);
            before[1] = asp_sample_lobe(&mat, wi, u1, u2, u3).weight;
            after[1] = asp_sample_lobe(&turned, wi, u1, u2, u3).weight;
            before[2] = asp_walk_eval_cos(&mat, wi, wo, next, &a);
            after[2] = asp_walk_eval_cos(&turned, wi, wo, next, &b);
            for (int j = 0; j < 3; j++)
                for (int ch = 0; ch < 3; ch++) {
                    double x = channel(before[j], ch), y = channel(after[j], (ch + 1) % 3);
                    worst = fmax(worst, fabs(x - y) / fmax(fabs(x), 1e-3));
                }
        }
    }
    expect(worst < 1e-9, "channels that change places", worst);
}

/* out stays as it was, and the name is told. */
static int refuses(const asp_material *mat, double nm, const char *name)
{
    double out = -1;
    asp_error err;
    asp_vec3 up = { 0, 0, 1 };
    return asp_eval_wavelengths(mat, up, up, 1, &nm, &out, &err) == ASP_EINVAL && out == -1 && !strcmp(err.name, name);
}

/* What asp_film makes is what a spec makes, and what it refuses it leaves as it was. */
static void check_asked(void)
{
    asp_material mat = bare(glasses[0]), spec = film_on(glasses[0], ""), before;
    asp_material plastic = material("plastic:ndf=(ggx)"), kin = material("compensated_dielectric:ndf=(ggx)");
    asp_material f0 = material("conductor:f0=0.5,ndf=(ggx)"), gold = material("conductor:metal=Au,ndf=(ggx:alpha=0.2)");
    asp_material golden = material("conductor:metal=Au,film=200,film_eta=1.5,ndf=(ggx:alpha=0.2)");
    asp_material given = material("compensated:metal=Au,ndf=(ggx:alpha=0.2)");
    asp_material coated = material("compensated:metal=Au,film=200,film_eta=1.5,ndf=(ggx:alpha=0.2)");
    asp_error err;
    int wrong = 0;
    wrong += asp_film(&mat, glasses[0].film_eta, glasses[0].film, &err) != ASP_OK;
    wrong += memcmp(mat.energy, spec.energy, sizeof mat.energy) != 0 || mat.fresnel != spec.fresnel;
    wrong += asp_film(&gold, 1.5, 200, &err) != ASP_OK;
    wrong += memcmp(gold.energy, golden.energy, sizeof gold.energy) != 0 || gold.fresnel != golden.fresnel;
    wrong += asp_film(&given, 1.5, 200, &err) != ASP_OK;
    wrong += memcmp(given.energy, coated.energy, sizeof given.energy) != 0 || given.fresnel != coated.fresnel;
    expect(wrong == 0, "asp_film and the key film agree, but for", wrong);
    wrong = 0;
    before = mat;
    wrong += asp_film(&mat, 0.9, 100, &err) != ASP_EINVAL || strcmp(err.name, "film_eta") || err.low != 1 || err.high != 10;
    wrong += asp_film(&mat, 1.5, NAN, &err) != ASP_EINVAL || strcmp(err.name, "film") || !err.low_open || err.high != 1e4;
    wrong += memcmp(&mat, &before, sizeof mat) != 0;
    wrong += asp_film(&plastic, 1.5, 100, &err) != ASP_EINVAL || asp_film(&kin, 1.5, 100, &err) != ASP_EINVAL;
    wrong += asp_film(&f0, 1.5, 100, &err) != ASP_EINVAL;
    mat = asp_dielectric(&mat.ndf, 1, 0, ASP_RADIANCE, 0);
    wrong += asp_film(&mat, 1.5, 100, &err) != ASP_EINVAL;
    wrong += asp_material_parse(NULL, "dielectric:eta=1,film=100,ndf=(ggx)", &mat, &err) != ASP_EINVAL || err.position != 22;
    wrong += asp_material_parse(NULL, "dielectric:film_eta=1.4,ndf=(ggx)", &mat, &err) != ASP_EINVAL;
    wrong += asp_material_parse(NULL, "compensated_dielectric:film=100,ndf=(ggx)", &mat, &err) != ASP_EUNKNOWN;
    wrong += !refuses(&plastic, 500, "plastic") || !refuses(&f0, 500, "f0") || !refuses(&gold, 379, "wavelength");
    wrong += !refuses(&gold, NAN, "wavelength") || !refuses(&gold, 781, "wavelength");
    mat = material("conductor:eta=0.2/0.3/0.4,k=3,ndf=(ggx)");
    wrong += !refuses(&mat, 500, "eta");
    expect(wrong == 0, "films that cannot be are refused, but for", wrong);
}

int main(void)
{
    check_shares();
    check_wavelengths();
    check_sheet();
    check_carried();
    check_walks();
    check_channels();
    check_asked();
    return finish();
}
