/* test_scatter_numbers.c - values of scattering models against formulas written here once more, from the papers
 *
 * The surface is GGX with its own closed forms; reflectances are those of complex amplitudes; albedos are sums over
 * facets. Nothing of the library is used but what is tested. */
#include "scatter_test.h"

#include <complex.h>

/* ---- the surface and a facet */

static asp_vec3 half(asp_vec3 a, asp_vec3 b)
{
    double x = a.x + b.x, y = a.y + b.y, z = a.z + b.z, n = sqrt(x * x + y * y + z * z);
    return (asp_vec3){ x / n, y / n, z / n };
}

/* Trowbridge, Reitz 1975; Walter et al. 2007, eqs. 33-34. */
static double ggx(double alpha, double mz)
{
    double c2 = mz * mz, t = c2 * (alpha * alpha - 1) + 1;
    return alpha * alpha / (PI * t * t);
}

static double hidden(double alpha, double c)
{
    return 0.5 * (sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1);
}

/* D G2 / (4 cos cos) with height-correlated masking (Heitz 2014, eq. 99). */
static double facets(double alpha, asp_vec3 wi, asp_vec3 wo)
{
    return ggx(alpha, half(wi, wo).z) / (1 + hidden(alpha, wi.z) + hidden(alpha, wo.z)) / (4 * wi.z * wo.z);
}

/* Fresnel's equations for a complex index, unpolarised. */
static double fresnel(double c, double complex n)
{
    double complex t = csqrt(1 - (1 - c * c) / (n * n));
    double s = cabs((c - n * t) / (c + n * t)), p = cabs((n * c - t) / (n * c + t));
    return 0.5 * (s * s + p * p);
}

/* The same and 1 at any index. */
static double reflectance(double c, double complex n) { return n == 0 ? 1 : fresnel(c, n); }

/* What is reflected once of light from wi: the mean of F G2 (wi.m)/(wi.z m.z) over normals of density D m.z.
 * n = 0 is a perfect mirror. */
static double reflected(double alpha, double c, double complex n)
{
    const int rings = 300, sectors = 150;
    double s = sqrt(1 - c * c), sum = 0;
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < sectors; j++) {
            double u = (i + 0.5) / rings, t = alpha * sqrt(u / (1 - u)), mz = 1 / sqrt(1 + t * t);
            double wm = s * t * mz * cos((j + 0.5) / sectors * PI) + c * mz, oz = 2 * wm * mz - c;
            if (wm > 0 && oz > 0)
                sum += reflectance(wm, n) * wm / (mz * c) / (1 + hidden(alpha, c) + hidden(alpha, oz));
        }
    return sum / (rings * sectors);
}

/* Its mean against 2 c dc, by midpoints in c^2. */
static double reflected_mean(double alpha, double complex n)
{
    double sum = 0;
    for (int i = 0; i < 40; i++)
        sum += reflected(alpha, sqrt((i + 0.5) / 40), n) / 40;
    return sum;
}

static double fresnel_mean(double complex n)
{
    double sum = 0;
    for (int i = 0; i < 4000; i++)
        sum += fresnel(sqrt((i + 0.5) / 4000), n) / 4000;
    return sum;
}

/* Pairs away from the horizon. */
#define PAIRS 5
static void pair(int i, asp_vec3 *wi, asp_vec3 *wo)
{
    static const double from[PAIRS] = { 0.1, 0.6, 1.1, 1.25, 0.8 }, to[PAIRS] = { 0.9, 1.2, 1.0, 0.3, 0.8 },
                        phi[PAIRS] = { 2.0, 0.4, 3.0, 1.5, 3.3 };
    *wi = direction(from[i], 0.3);
    *wo = direction(to[i], 0.3 + phi[i]);
}

static double channel(asp_rgb c, int i) { return i == 0 ? c.r : i == 1 ? c.g : c.b; }

/* ---- energy given back by metals */

static void check_compensated(void)
{
    static const double eta[3] = { 0.2, 0.9, 1.5 }, k[3] = { 3.9, 2.4, 1.9 };
    double worst[2] = { 0, 0 }, back = 0;
    for (int a = 0; a < 3; a++) {
        double alpha = a == 0 ? 0.4 : a == 1 ? 0.7 : 1, Em = reflected_mean(alpha, 0);
        char spec[128];
        for (int turquin = 0; turquin < 2; turquin++) {
            asp_material mat;
            snprintf(spec, sizeof spec, "compensated:form=%s,eta=0.2/0.9/1.5,k=3.9/2.4/1.9,ndf=(ggx:alpha=%g)",
                     turquin ? "turquin" : "kulla_conty", alpha);
            mat = material(spec);
            for (int i = 0; i < PAIRS; i++) {
                asp_vec3 wi, wo;
                asp_rgb f;
                double Ei, Eo, x, c;
                pair(i, &wi, &wo);
                f = asp_eval(&mat, wi, wo);
                Ei = reflected(alpha, wi.z, 0);
                Eo = reflected(alpha, wo.z, 0);
                x = facets(alpha, wi, wo);
                c = dot(wi, half(wi, wo));
                for (int ch = 0; ch < 3; ch++) {
                    double complex n = eta[ch] + I * k[ch];
                    double F = fresnel(c, n), F0 = fresnel(1, n), Fm = fresnel_mean(n), expected;
                    /* Turquin 2019, eq. 16; Kulla, Conty 2017, with F averaged */
                    if (turquin)
                        expected = F * x * (1 + F0 * (1 - Ei) / Ei);
                    else
                        expected = F * x + (1 - Ei) * (1 - Eo) / (PI * (1 - Em)) * Fm * Fm * Em / (1 - Fm * (1 - Em));
                    worst[turquin] = fmax(worst[turquin], fabs(channel(f, ch) / expected - 1));
                    back = fmax(back, (expected - F * x) / expected);
                }
            }
        }
    }
    expect(back > 0.3, "of f what is given back is up to", back);
    expect(worst[0] < 3e-3, "Kulla, Conty: the colour of what is given back, relative", worst[0]);
    expect(worst[1] < 2e-3, "Turquin: by F along the normal, relative", worst[1]);
}

/* ---- a coat over a base: what gets through, reflected under the coat again and again, in each of three colours */

static void check_plastic(void)
{
    static const struct { const char *spec; double alpha, eta; } cases[] = {
        { "plastic:albedo=1/0.6/0.1,eta=1.5,ndf=(ggx:alpha=0.3)", 0.3, 1.5 },
        { "plastic:albedo=1/0.6/0.1,eta=2.2,ndf=(ggx:alpha=0.8)", 0.8, 2.2 },
        { "plastic:albedo=1/0.6/0.1,eta=1.2,ndf=(ggx:alpha=0.5)", 0.5, 1.2 }
    };
    static const double albedo[3] = { 1, 0.6, 0.1 };
    double worst = 0;
    for (int j = 0; j < 3; j++) {
        asp_material mat = material(cases[j].spec);
        double alpha = cases[j].alpha, eta = cases[j].eta, Em = reflected_mean(alpha, eta);
        for (int i = 0; i < PAIRS; i++) {
            asp_vec3 wi, wo;
            asp_rgb f;
            double through, out;
            pair(i, &wi, &wo);
            f = asp_eval(&mat, wi, wo);
            through = (1 - reflected(alpha, wi.z, eta)) * (1 - reflected(alpha, wo.z, eta)) / (PI * (1 - Em));
            /* of diffuse light from below, what came in from everywhere over eta^2 times as much radiance */
            out = (1 - Em) / (eta * eta);
            for (int ch = 0; ch < 3; ch++) {
                double sum = 0, left = albedo[ch], expected;
                for (int k = 0; k < 2000; k++) {
                    sum += left * out;
                    left *= (1 - out) * albedo[ch];
                }
                expected = fresnel(dot(wi, half(wi, wo)), eta) * facets(alpha, wi, wo) + through * sum;
                worst = fmax(worst, fabs(channel(f, ch) / expected - 1));
            }
        }
    }
    expect(worst < 1e-3, "plastic: reflections under the coat summed one by one, relative", worst);
}

/* ---- Lambertian facets by name */

static void check_diffuse(void)
{
    static const char *const forms[] = { "oren_nayar", "fujii", "eon" };
    static const double albedo[3] = { 0.9, 0.5, 0.2 };
    double worst[3] = { 0, 0, 0 };
    for (int form = 0; form < 3; form++)
        for (int a = 0; a < 3; a++) {
            double alpha = a == 0 ? 0.2 : a == 1 ? 0.7 : 1.3, sigma = atan(alpha / sqrt(2)), mean = 0, A;
            char spec[128];
            asp_material mat;
            snprintf(spec, sizeof spec, "rough_diffuse:albedo=0.9/0.5/0.2,form=%s,ndf=(beckmann:alpha=%g)", forms[form], alpha);
            mat = material(spec);
            A = 1 / (1 + (0.5 - 2 / (3 * PI)) * sigma);
            for (int i = 0; i <= PAIRS; i++) {
                asp_vec3 wi = { 0, 0, 1 }, wo = direction(1.1, 2);
                double ti, to, dphi, E[2];
                asp_rgb f;
                if (i < PAIRS)
                    pair(i, &wi, &wo);
                f = asp_eval(&mat, wi, wo);
                ti = acos(wi.z);
                to = acos(wo.z);
                dphi = atan2(wo.y, wo.x) - atan2(wi.y, wi.x);
                for (int ch = 0; ch < 3; ch++) {
                    double rho = albedo[ch], expected, s = sin(ti) * sin(to) * cos(dphi);
                    if (form == 0) {
                        /* Oren, Nayar 1994, eq. 30 */
                        double a2 = sigma * sigma, B = 0.45 * a2 / (a2 + 0.09);
                        expected = rho / PI * (1 - 0.5 * a2 / (a2 + 0.33)
                                               + B * fmax(0, cos(dphi)) * sin(fmax(ti, to)) * tan(fmin(ti, to)));
                    } else {
                        /* Fujii 2012, the improved model; Portsmouth, Kutz, Hill 2025, eqs. 8-9 */
                        expected = rho / PI * A * (1 + sigma * s / (s > 0 ? fmax(cos(ti), cos(to)) : 1));
                    }
                    if (form == 2) {
                        /* the same paper: albedo of fujii's form by its closed form, and what is lost given back */
                        int n = 2000;
                        mean = 0;
                        for (int k = -2; k < n; k++) {
                            double t = k == -2 ? ti : k == -1 ? to : acos(sqrt((k + 0.5) / n));
                            double G = sin(t) * (t - sin(t) * cos(t)) + 2.0 / 3 * (tan(t) * (1 - pow(sin(t), 3)) - sin(t));
                            double e = A * (1 + sigma / PI * G);
                            if (k < 0)
                                E[k + 2] = e;
                            else
                                mean += e / n;
                        }
                        expected += rho * rho * mean / (1 - rho * (1 - mean)) * (1 - E[0]) * (1 - E[1]) / (PI * (1 - mean));
                    }
                    worst[form] = fmax(worst[form], fabs(channel(f, ch) / expected - 1));
                }
            }
        }
    expect(worst[0] < 1e-12, "Oren, Nayar's qualitative model, relative", worst[0]);
    expect(worst[1] < 1e-12, "Fujii's, relative", worst[1]);
    expect(worst[2] < 1e-5, "EON: what is given back by albedo squared, relative", worst[2]);
}

/* ---- a sheet */

static void check_sheet(void)
{
    double worst = 0, off = 0, split = 0;
    for (int j = 0; j < 2; j++) {
        double eta = j ? 2.4 : 1.5, alpha = j ? 0.8 : 0.3, all = 0, r, lost;
        asp_material mat = material(j ? "dielectric:thin=1,eta=2.4,ndf=(ggx:alpha=0.8)" : "dielectric:thin=1,eta=1.5,ndf=(ggx:alpha=0.3)");
        for (int i = 0; i < PAIRS; i++)
            for (int side = 0; side < 4; side++) {
                asp_vec3 wi, wo, up, down;
                double F, R = 0, left = 1, x, p, expected;
                pair(i, &wi, &wo);
                F = fresnel(dot(wi, half(wi, wo)), eta);
                /* reflected once, and after 2, 4, ... more reflections inside */
                R = F;
                left = (1 - F) * (1 - F) * F;
                for (int k = 0; k < 2000; k++) {
                    R += left;
                    left *= F * F;
                }
                x = facets(alpha, wi, wo);
                p = ggx(alpha, half(wi, wo).z) / (4 * wi.z * (1 + hidden(alpha, wi.z)));
                up = wi;
                down = wo;
                up.z = side & 1 ? -wi.z : wi.z;
                down.z = (side & 1) != side >> 1 ? -wo.z : wo.z;
                expected = side & 2 ? 1 - R : R;
                worst = fmax(worst, fabs(asp_eval(&mat, up, down).r / (expected * x) - 1));
                worst = fmax(worst, fabs(asp_pdf(&mat, up, down) / (expected * p) - 1));
            }
        /* samples change from reflection to transmission where u3 passes R */
        for (int i = 0; i < 2000; i++) {
            double u1 = fmod(0.5 + 0.8191725133961645 * i, 1), u2 = fmod(0.5 + 0.6710436067037893 * i, 1), R, F;
            asp_vec3 wi = direction(0.7 * i / 1000, i), v = wi, m;
            asp_bsdf_sample s = asp_sample_lobe(&mat, wi, u1, u2, 0), a, b;
            if (!(s.pdf > 0))
                continue;
            m = half(v, s.wo);
            F = fresnel(dot(v, m), eta);
            R = 2 * F / (1 + F);
            a = asp_sample_lobe(&mat, wi, u1, u2, R * (1 - 1e-7));
            b = asp_sample_lobe(&mat, wi, u1, u2, fmin(R * (1 + 1e-7), 1 - 1e-16));
            off += (R < 1 - 1e-6) && !(a.wo.z > 0 && b.wo.z < 0);
            split = fmax(split, fabs(b.wo.x - a.wo.x) + fabs(b.wo.y - a.wo.y) + fabs(b.wo.z + a.wo.z));
        }
        /* nothing is lost between the two ways, but by masking: the albedo is that of perfect mirrors */
        for (int i = 0; i < 40000; i++)
            all += asp_sample_lobe(&mat, direction(0.9, 1), fmod(0.5 + 0.8191725133961645 * i, 1),
                                   fmod(0.5 + 0.6710436067037893 * i, 1), fmod(0.5 + 0.5497004779019703 * i, 1)).weight.r / 40000;
        r = reflected(alpha, cos(0.9), 0);
        lost = fabs(all - r);
        expect(lost < 1e-3, "a sheet returns and lets pass together what perfect mirrors return, apart", lost);
    }
    expect(worst < 1e-12, "a sheet: reflections inside summed one by one, f and density, relative", worst);
    expect(off == 0, "its samples pass where u3 is above the share reflected; exceptions", off);
    expect(split < 1e-12, "what passes leaves in the mirror image of what is reflected", split);
}

/* ---- refraction in grooves and by Smith */

static void check_refraction(void)
{
    static const char *const masks[] = { "v_cavity", "uncorrelated", "correlated" };
    double worst[3] = { 0, 0, 0 };
    int blocked = 0, count = 0;
    for (int mask = 0; mask < 3; mask++)
        for (int inside = 0; inside < 2; inside++)
            for (int transport = 0; transport < 2; transport++)
                for (int i = 0; i < 200; i++) {
                    char spec[128];
                    static asp_material mat;
                    double alpha = 0.6, eta = inside ? 1 / 1.6 : 1.6, over, c, co, F, G, f, expected;
                    asp_vec3 wi = direction(0.02 + 1.5 * fmod(0.618034 * i, 1), i), wo = direction(0.02 + 1.5 * fmod(0.414 * i, 1), 2.1 * i), m, a, b;
                    if (i == 0) {
                        snprintf(spec, sizeof spec, "dielectric:eta=1.6,mask=%s,transport=%s,ndf=(ggx:alpha=0.6)", masks[mask],
                                 transport ? "importance" : "radiance");
                        mat = material(spec);
                    }
                    wo.z = -wo.z;
                    /* Walter et al. 2007, eqs. 16 and 21, with index 1 on the side of wi */
                    m = (asp_vec3){ -(wi.x + eta * wo.x), -(wi.y + eta * wo.y), -(wi.z + eta * wo.z) };
                    over = sqrt(dot(m, m));
                    over = m.z < 0 ? -over : over;
                    m = (asp_vec3){ m.x / over, m.y / over, m.z / over };
                    c = dot(wi, m);
                    co = -dot(wo, m);
                    a = wi;
                    b = wo;
                    if (inside) {
                        a = (asp_vec3){ -wi.x, -wi.y, -wi.z };
                        b = (asp_vec3){ -wo.x, -wo.y, -wo.z };
                    }
                    f = asp_eval(&mat, a, b).r;
                    if (c <= 1e-6 || co <= 1e-6) {
                        worst[mask] = fmax(worst[mask], f);
                        continue;
                    }
                    F = 1 - (1 - c * c) / (eta * eta) > 0 ? fresnel(c, eta) : 1;
                    if (mask == 0) {
                        /* what is left of the groove by both sides, which light that crosses meets apart: G1 + G1 - 1 */
                        G = fmin(1, 2 * m.z * wi.z / c) + fmin(1, 2 * m.z * -wo.z / co) - 1;
                        blocked += G > 0 && G < 1;
                        G = fmax(G, 0);
                    } else if (mask == 1) {
                        G = 1 / (1 + hidden(alpha, wi.z)) / (1 + hidden(alpha, wo.z));
                    } else {
                        double p = 1 + hidden(alpha, wi.z), q = 1 + hidden(alpha, wo.z);
                        G = tgamma(p) * tgamma(q) / tgamma(p + q);
                    }
                    expected = c * co / (wi.z * -wo.z) * eta * eta * (1 - F) * G * ggx(alpha, m.z) / pow(c - eta * co, 2);
                    if (!transport)
                        expected /= eta * eta;
                    worst[mask] = fmax(worst[mask], fabs(f - expected) / fmax(expected, 1e-6));
                    count++;
                }
    printf("       %d pairs, %d of them hidden in part\n", count, blocked);
    expect(count > 300 && blocked > 20 && worst[0] < 1e-10, "refraction in grooves: G1 + G1 - 1, relative", worst[0]);
    expect(worst[1] < 1e-10, "refraction by Smith, uncorrelated, relative", worst[1]);
    expect(worst[2] < 1e-8, "refraction by Smith, correlated: Euler's beta, relative", worst[2]);
}

/* ---- films and wavelengths */

typedef struct layer { double c, n1, d; double complex n2; } layer;

/* Airy's sum, the reflections in the film added one by one. */
static double airy(const void *context, double nm)
{
    const layer *f = (const layer *)context;
    double complex n2 = f->n2, c1 = csqrt(1 - (1 - f->c * f->c) / (f->n1 * f->n1));
    double complex c2 = csqrt(1 - (1 - f->c * f->c) / (n2 * n2)), e = cexp(4 * PI * I * f->n1 * c1 * f->d / nm);
    double total = 0;
    for (int p = 0; p < 2; p++) {
        double complex top = p ? (f->n1 * f->c - c1) / (f->n1 * f->c + c1) : (f->c - f->n1 * c1) / (f->c + f->n1 * c1);
        double complex low = p ? (n2 * c1 - f->n1 * c2) / (n2 * c1 + f->n1 * c2)
                               : (f->n1 * c1 - n2 * c2) / (f->n1 * c1 + n2 * c2);
        double complex r = top, pass = (1 - top * top) * low * e;
        for (int k = 0; k < 400; k++) {
            r += pass;
            pass *= -top * low * e;
        }
        total += 0.5 * (creal(r) * creal(r) + cimag(r) * cimag(r));
    }
    return total;
}

static void check_film(void)
{
    static const double eta[3] = { 0.3, 0.9, 1.5 }, k[3] = { 3.9, 2.4, 1.9 };
    asp_material mat = material("conductor:eta=0.3/0.9/1.5,k=3.9/2.4/1.9,film=350,film_eta=1.6,ndf=(ggx:alpha=0.4)");
    double at = 0, off = 0, grazing = 0, low = 1, high = 0;
    for (int i = 1; i <= 120; i++) {
        double c = i / 120.0, x;                         /* four to each of the table's cells */
        asp_vec3 wi = { sqrt(1 - c * c), 0, c }, wo = { -sqrt(1 - c * c), 0, c };
        asp_rgb f = asp_eval(&mat, wi, wo);
        x = facets(0.4, wi, wo);
        for (int ch = 0; ch < 3; ch++) {
            layer film = { c, 1.6, 350, eta[ch] + I * k[ch] };
            double expected = fmin(fmax(channel(asp_rgb_of_reflectance(airy, &film), ch), 0), 1);
            double apart = fabs(channel(f, ch) / x - expected), *worst = i % 4 == 0 ? &at : i > 12 ? &off : &grazing;
            *worst = fmax(*worst, apart);
            low = fmin(low, expected);
            high = fmax(high, expected);
        }
    }
    expect(high - low > 0.3, "a film's colour varies with the angle by", high - low);
    expect(at < 1e-9, "a film's colour at cosines of the table, Airy's sum over wavelengths", at);
    expect(off < 1e-3, "between them, cosines from 0.1 to 1", off);
    expect(grazing < 0.02, "and below 0.1", grazing);
}

static void check_spectrum(void)
{
    static const double eta[7] = { 0.2, 0.5, 0.9, 1.2, 1.5, 2.5, 0.1 }, k[7] = { 3.9, 3.1, 2.4, 2.2, 1.9, 3.3, 5 };
    static const size_t counts[] = { 1, 2, 3, 4, 7 };
    asp_material mat = material("conductor:metal=Au,ndf=(ggx:alpha=0.3)");
    double worst = 0, beyond = 0;
    for (int i = 0; i < PAIRS; i++)
        for (int j = 0; j < 5; j++) {
            double out[8] = { -1, -1, -1, -1, -1, -1, -1, -1 };
            asp_vec3 wi, wo;
            pair(i, &wi, &wo);
            beyond += asp_eval_spectrum(&mat, wi, wo, counts[j], eta, k, out) != ASP_OK;
            for (size_t n = 0; n < 8; n++) {
                double expected = n < 7 ? fresnel(dot(wi, half(wi, wo)), eta[n] + I * k[n]) * facets(0.3, wi, wo) : 0;
                if (n < counts[j])
                    worst = fmax(worst, fabs(out[n] / expected - 1));
                else
                    beyond += out[n] != -1;
            }
        }
    for (int i = 0; i < PAIRS; i++) {
        asp_material glass = material("dielectric:eta=1.5,ndf=(ggx:alpha=0.3)");
        static const double indices[7] = { 1.3, 1.4, 1.5, 1.6, 1.8, 2.2, 3 };
        double out[7];
        asp_vec3 wi, wo;
        pair(i, &wi, &wo);
        beyond += asp_eval_spectrum(&glass, wi, wo, 7, indices, k, out) != ASP_OK;
        for (int n = 0; n < 7; n++)
            worst = fmax(worst, fabs(out[n] / (fresnel(dot(wi, half(wi, wo)), indices[n]) * facets(0.3, wi, wo)) - 1));
    }
    expect(worst < 1e-12, "1, 2, 3, 4 and 7 wavelengths of a metal, 7 of glass, relative", worst);
    expect(beyond == 0, "none refused, nothing written beyond them", beyond);
}

int main(void)
{
    check_compensated();
    check_plastic();
    check_diffuse();
    check_sheet();
    check_refraction();
    check_film();
    check_spectrum();
    return finish();
}
