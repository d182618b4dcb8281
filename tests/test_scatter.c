/* test_scatter.c - scattering models beyond the conductor: energy, limits, films, indices, samplers */
#include "scatter_test.h"

#include <complex.h>
#include <string.h>

/* Mean weight over a lattice of (u1, u2, u3). */
static double albedo(const asp_material *mat, asp_vec3 wi, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double a = fmod(0.5 + 0.8191725133961645 * i, 1), b = fmod(0.5 + 0.6710436067037893 * i, 1);
        sum += asp_sample_lobe(mat, wi, a, b, fmod(0.5 + 0.5497004779019703 * i, 1)).weight.g;
    }
    return sum / n;
}

/* ---- energy given back */

static void check_energy(void)
{
    static const char *const whole[] = {
        "plastic:albedo=1,ndf=(ggx:alpha=0.3)", "plastic:albedo=1,eta=1.8,ndf=(beckmann:alpha=1)",
        "plastic:albedo=1,ndf=(student_t:alpha_x=0.2,alpha_y=0.5,gamma=2.5,mean_x=0.3),mask=wall",
        "compensated:ndf=(ggx:alpha=0.8)", "compensated:ndf=(beckmann:alpha_x=0.3,alpha_y=0.9,rotation=0.4)",
        "compensated:form=turquin,f0=1,ndf=(student_t:alpha=0.6,gamma=3)"
    };
    double worst = 0, lost = 0;
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) {
        asp_material mat = material(whole[i]);
        double off = 0;
        for (int k = 0; k < 6; k++)
            off = fmax(off, fabs(albedo(&mat, direction(0.02 + 0.29 * k, 0.4 + k), 100000) - 1));
        printf("  %s: off by %.4f\n", whole[i], off);
        worst = fmax(worst, off);
    }
    expect(worst < 0.003, "plastic and compensated conductors without absorption return all light", worst);
    /* with absorption, less; and never more */
    for (int k = 0; k < 6; k++) {
        asp_material mat = material("plastic:albedo=0.6,ndf=(ggx:alpha=0.3)");
        lost = fmax(lost, albedo(&mat, direction(0.02 + 0.29 * k, 0), 4000));
    }
    expect(lost < 0.95, "plastic over a grey base absorbs", lost);
}

/* From both sides, in importance; the index inside is above and below that outside. */
static void check_energy_glass(void)
{
    static const struct { const char *spec; double allowed; } whole[] = {
        { "compensated_dielectric:transport=importance,ndf=(ggx:alpha=0.1)", 3e-3 },
        { "compensated_dielectric:transport=importance,eta=0.6,ndf=(ggx:alpha=1)", 3e-3 },
        { "compensated_dielectric:transport=importance,eta=2.5,ndf=(student_t:alpha=0.3,gamma=1.6)", 3e-3 },
        { "compensated_dielectric:transport=importance,thin=1,ndf=(beckmann:alpha=0.7)", 3e-3 },
        { "compensated_dielectric:transport=importance,form=turquin,ndf=(beckmann:alpha=0.7)", 3e-3 },
        { "compensated_dielectric:transport=importance,ndf=(ggx:alpha_x=0.2,alpha_y=0.7,rotation=0.4)", 6e-3 },
        { "compensated_dielectric:transport=importance,mask=wall,ndf=(beckmann:alpha=0.4,mean_x=0.3)", 6e-3 }
    };
    double worst = 0, lost = 1;
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) {
        asp_material mat = material(whole[i].spec);
        double off = 0;
        for (int k = 0; k < 6; k++) {
            asp_vec3 wi = direction(0.02 + 0.7 * (k / 2), 0.4 + k);
            wi.z = k & 1 ? -wi.z : wi.z;
            off = fmax(off, fabs(albedo(&mat, wi, 200000) - 1));
        }
        printf("  %s: off by %.4f\n", whole[i].spec, off);
        worst = fmax(worst, off / whole[i].allowed);
    }
    expect(worst < 1, "compensated dielectrics return all light from both sides, of what is allowed", worst);
    {
        asp_material single = material("dielectric:transport=importance,ndf=(ggx:alpha=1)");
        lost = albedo(&single, direction(1, 0), 4000);
        expect(lost < 0.85, "which single scattering does not", lost);
    }
}

/* A smooth surface loses light within a roughness of the horizon only: that is where it must be given back, not by
 * weights of thousands elsewhere. */
static void check_even(void)
{
    static const char *const smooth[] = {
        "compensated:metal=Ag,ndf=(student_t:alpha=0.001,gamma=4)", "compensated:metal=Ag,ndf=(ggx:alpha=0.001)",
        "compensated_dielectric:ndf=(ggx:alpha=0.002)"
    };
    double worst = 0;
    for (size_t i = 0; i < sizeof smooth / sizeof *smooth; i++) {
        asp_material mat = material(smooth[i]);
        uint64_t state = 1;
        double sum = 0, sum2 = 0, n = 200000;
        for (int j = 0; j < n; j++) {
            double w = asp_sample_lobe(&mat, direction(0.5 * PI - 1e-4, 1), next(&state), next(&state), next(&state)).weight.g;
            sum += w;
            sum2 += w * w;
        }
        worst = fmax(worst, n * sum2 / (sum * sum));
    }
    expect(worst < 4, "samples near the horizon of smooth compensated surfaces have even weights: mean w^2 over mean^2", worst);
}

/* The share of what is given back that crosses, against that of walks. */
static void check_split(void)
{
    static const char *const specs[] = { "ggx:alpha=0.3", "ggx:alpha=1", "beckmann:alpha=1" };
    double apart = 0;
    uint64_t state = 3;
    for (int i = 0; i < 3; i++)
        for (int side = 0; side < 2; side++) {
            char spec[96];
            asp_ndf k = ndf(specs[i]);
            asp_material glass = asp_dielectric(&k, 1.5, 0, ASP_IMPORTANCE, 0), whole;
            double crosses[3] = { 0, 0, 0 }, lost = 0, split[2];
            int n = 60000;
            snprintf(spec, sizeof spec, "compensated_dielectric:transport=importance,ndf=(%s)", specs[i]);
            whole = material(spec);
            for (int j = 0; j < n; j++) {
                double u1 = next(&state), u2 = next(&state), u3 = next(&state);
                asp_vec3 wi = direction(acos(sqrt(next(&state))), 2 * PI * next(&state));
                wi.z = side ? -wi.z : wi.z;
                for (int way = 0; way < 3; way++) {
                    asp_bsdf_sample s = way == 0 ? asp_sample_lobe(&glass, wi, u1, u2, u3)
                                      : way == 1 ? asp_sample_lobe(&whole, wi, u1, u2, u3)
                                                 : asp_walk_sample(&glass, wi, next, &state);
                    crosses[way] += (s.wo.z * wi.z < 0) * s.weight.g / n;
                    lost += way == 0 ? (1 - s.weight.g) / n : 0;
                }
            }
            split[0] = (crosses[1] - crosses[0]) / lost;
            split[1] = (crosses[2] - crosses[0]) / lost;
            printf("  %s from %s: of what is given back %.3f crosses, of walks %.3f\n", specs[i],
                   side ? "inside" : "outside", split[0], split[1]);
            apart = fmax(apart, fabs(split[0] - split[1]));
        }
    expect(apart < 0.1, "the share given back across the boundary is about that of walks, apart", apart);
}

/* ---- limits */

static void check_limits(void)
{
    double worst = 0, smooth, apart = 0;
    /* alpha -> 0 joins the smooth boundary: the share reflected is Fresnel's */
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 5; k++) {
            asp_ndf flat = ndf("beckmann:alpha=0.0001");
            asp_material glass = asp_dielectric(&flat, 1.5, 0, ASP_IMPORTANCE, 0);
            asp_vec3 wi = direction(0.1 + 0.3 * k, 1);
            double up = 0;
            int n = 4000;
            if (side)
                wi.z = -wi.z;
            for (int i = 0; i < n; i++) {
                double u3 = (i + 0.5) / n;
                asp_bsdf_sample s = asp_sample_lobe(&glass, wi, fmod(0.618034 * i, 1), fmod(0.41421 * i, 1), u3);
                up += (s.wo.z * wi.z > 0) / (double)n;
            }
            smooth = asp_fresnel_dielectric(fabs(wi.z), side ? 1 / 1.5 : 1.5);
            worst = fmax(worst, fabs(up - smooth));
        }
    expect(worst < 2e-3, "a nearly flat dielectric reflects Fresnel's share", worst);
    worst = 0;
    for (int k = 0; k < 8; k++) {
        /* gamma -> infinity joins Beckmann, in refraction too */
        asp_ndf a = ndf("student_t:alpha=0.4,gamma=1e9"), b = ndf("beckmann:alpha=0.4");
        asp_material ma = asp_dielectric(&a, 1.5, 0, 0, 0), mb = asp_dielectric(&b, 1.5, 0, 0, 0);
        asp_vec3 wi = direction(0.1 + 0.17 * k, 0.3), wo = direction(2.3 + 0.1 * k, 3);
        double x = asp_eval(&ma, wi, wo).r, y = asp_eval(&mb, wi, wo).r;
        worst = fmax(worst, fabs(x - y) / fmax(y, 1e-3));
        /* eta -> 1 vanishes: what is reflected goes with (eta - 1)^2 */
        mb = asp_dielectric(&b, 1 + 1e-4, 0, 0, 0);
        apart = fmax(apart, asp_eval_cos(&mb, wi, direction(0.5, 3)).r);
    }
    expect(worst < 1e-6, "Student's t with gamma 1e9 refracts like Beckmann", worst);
    expect(apart < 1e-6, "index 1.0001 hardly reflects", apart);
}

/* ---- the walk against single scattering */

static void check_walk(void)
{
    asp_ndf k = ndf("ggx:alpha=0.7");
    asp_material mirror = asp_mirror(&k, 0);
    asp_vec3 wi = direction(0.9, 0.2), wo = direction(0.7, 2.5);
    uint64_t state = 1;
    double sum[2] = { 0, 0 }, sum2[2] = { 0, 0 }, z;
    int n = 200000;
    for (int i = 0; i < n; i++)
        for (int way = 0; way < 2; way++) {
            double f = way ? asp_walk_eval_cos(&mirror, wo, wi, next, &state).r / wi.z
                           : asp_walk_eval_cos(&mirror, wi, wo, next, &state).r / wo.z;
            sum[way] += f / n;
            sum2[way] += f * f / n;
        }
    z = fabs(sum[0] - sum[1]) / sqrt((sum2[0] - sum[0] * sum[0] + sum2[1] - sum[1] * sum[1]) / n);
    expect(z < 4, "walks are reciprocal, standard errors apart", z);
    z = sum[0] / asp_eval(&mirror, wi, wo).r;
    expect(z > 1.01 && z < 3, "multiple scattering adds light to single scattering, factor", z);
    /* a metal of F = 1/2: the walk returns less than single scattering of a mirror plus its rest */
    {
        asp_material half = material("conductor:f0=0.5,tint=1,ndf=(ggx:alpha=0.7)");
        double w = 0;
        for (int i = 0; i < 20000; i++)
            w += asp_walk_sample(&half, wi, next, &state).weight.r / 20000;
        expect(w > albedo(&half, wi, 4000) && w < 1, "a half mirror: above single scattering, below 1", w);
    }
    {
        asp_ndff kf = asp_ndf_narrow(&k);
        asp_material d = asp_mirror(&k, 0);
        asp_materialf f = asp_material_narrow(&d);
        double lost = 0;
        (void)kf;
        for (int i = 0; i < 20000; i++) {
            asp_bsdf_samplef s = asp_walk_samplef(&f, (asp_vec3f){ 0.6f, 0, 0.8f }, next, &state);
            lost = fmax(lost, fabs(s.weight.r - 1));
        }
        expect(lost < 1e-6, "float32 walks lose nothing", lost);
    }
}

/* ---- bounded visible normals */

static void check_bounded(void)
{
    static const char *const specs[] = { "ggx:alpha=0.2", "ggx:alpha=0.8", "ggx:alpha_x=0.3,alpha_y=0.9,rotation=0.7" };
    double worst = 0, gain = 1e9, apart = 0, off = 0;
    for (int i = 0; i < 3; i++)
        for (int t = 0; t < 3; t++) {
            asp_ndf k = ndf(specs[i]);
            asp_material m = asp_mirror(&k, 0);
            asp_vec3 wi = direction(0.1 + 0.6 * t, 1);
            double all = 0;
            for (int j = 0; j < 400 * 400; j++) {
                double z = (j / 400 + 0.5) / 200 - 1, s = sqrt(1 - z * z), a = 2 * PI * (j % 400 + 0.5) / 400;
                all += asp_pdf_bounded(&m, wi, (asp_vec3){ s * cos(a), s * sin(a), z }) * 4 * PI / (400 * 400);
            }
            off = fmax(off, fabs(all - 1));
            double mean[2] = { 0, 0 }, square[2] = { 0, 0 };
            int n = 40000;
            for (int j = 0; j < n; j++) {
                double u1 = fmod(0.5 + 0.7548776662466927 * j, 1), u2 = fmod(0.5 + 0.5698402909980532 * j, 1);
                for (int b = 0; b < 2; b++) {
                    asp_bsdf_sample s = b ? asp_sample_bounded(&m, wi, u1, u2) : asp_sample(&m, wi, u1, u2);
                    mean[b] += s.weight.r / n;
                    square[b] += s.weight.r * s.weight.r / n;
                    if (b && s.pdf > 0)
                        worst = fmax(worst, fabs(asp_pdf_bounded(&m, wi, s.wo) / s.pdf - 1));
                }
            }
            apart = fmax(apart, fabs(mean[0] - mean[1]));
            gain = fmin(gain, (square[0] - mean[0] * mean[0]) / (square[1] - mean[1] * mean[1]));
        }
    expect(worst < 1e-12, "bounded sampling: the density of the sample is asp_pdf_bounded", worst);
    expect(off < 2e-3, "it integrates to 1 over all directions", off);
    expect(apart < 2e-3, "bounded and plain sampling agree in the mean", apart);
    expect(gain > 1.05, "bounded sampling has less variance everywhere, factor at least", gain);
}

/* ---- films, indices */

static double film_by_amplitudes(double c, double n1, double d, double complex n2, double nm)
{
    double complex c1 = csqrt(1 - (1 - c * c) / (n1 * n1)), c2 = csqrt(1 - (1 - c * c) / (n2 * n2));
    double complex s1 = (c - n1 * c1) / (c + n1 * c1), s2 = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    double complex p1 = (n1 * c - c1) / (n1 * c + c1), p2 = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    double complex e = cexp(4 * PI * I * n1 * c1 * d / nm);
    double a = cabs((s1 + s2 * e) / (1 + s1 * s2 * e)), b = cabs((p1 + p2 * e) / (1 + p1 * p2 * e));
    return 0.5 * (a * a + b * b);
}

static double white(const void *context, double nm)
{
    (void)nm;
    return *(const double *)context;
}

/* The weight of what crosses against B(a, b) a / eta^2 by the gamma function; errors over 1 + |ln B|. */
static void check_crossing(void)
{
    static const double alphas[] = { 0.05, 0.3, 1.0, 4.0 }, etas[] = { 1.5, 0.6 };
    double worst = 0, worstf = 0;
    uint64_t state = 3;
    int i, count = 0, far = 0;
    for (i = 0; i < 200000; i++) {
        double eta = etas[i / 4 % 2], z = next(&state), u1 = next(&state), u2 = next(&state), u3 = next(&state), e, w;
        asp_map map;
        asp_ndf surface;
        static asp_material mat[8];
        static asp_materialf matf[8];
        int j = i % 8;
        asp_vec3 wi = direction(acos(z), 6 * u3);
        asp_vec3f wif = { (float)wi.x, (float)wi.y, (float)wi.z }, back;
        asp_bsdf_sample s;
        asp_bsdf_samplef f;
        if (i < 8) {
            asp_map_from_roughness(alphas[j % 4], alphas[j % 4], 0, 0, 0, &map, NULL);
            asp_ndf_make(asp_find_model(NULL, "ggx"), &map, NULL, &surface, NULL);
            mat[j] = asp_dielectric(&surface, eta, 0, ASP_RADIANCE, 0);
            matf[j] = asp_material_narrow(&mat[j]);
        }
        s = asp_sample_lobe(&mat[j], wi, u1, u2, u3);
        f = asp_sample_lobef(&matf[j], wif, (float)u1 * 0.99999f, (float)u2, (float)u3);
        if (s.wo.z < 0 && s.weight.r > 0) {
            asp_vec3 below = { -s.wo.x, -s.wo.y, -s.wo.z };
            double a = asp_sigma(&mat[j].ndf, wi) / wi.z, b = asp_sigma(&mat[j].ndf, below) / below.z;
            e = lgamma(a) + lgamma(b) - lgamma(a + b);
            w = exp(e) * a / (eta * eta);
            worst = fmax(worst, fabs(s.weight.r / w - 1) / (1 + fabs(e)));
            far += a > 2 || b > 2;
            count++;
        }
        if (f.wo.z < 0 && f.weight.r > 1e-15f) {
            double a, b;
            back = (asp_vec3f){ -f.wo.x, -f.wo.y, -f.wo.z };
            a = (double)asp_sigmaf(&matf[j].ndf, wif) / (double)wif.z;
            b = (double)asp_sigmaf(&matf[j].ndf, back) / (double)back.z;
            e = lgamma(a) + lgamma(b) - lgamma(a + b);
            w = exp(e) * a / (eta * eta);
            worstf = fmax(worstf, fabs((double)f.weight.r / w - 1) / (1 + fabs(e)));
        }
    }
    printf("       %d crossings, %d of them far\n", count, far);
    expect(count > 100000 && far > 10000 && worst < 1e-10, "what crosses: Euler's beta, float64", worst);
    expect(worstf < 1e-6, "what crosses: Euler's beta, float32", worstf);
}

static void check_spectrum(void)
{
    double worst = 0, back = 0, one = 0.37;
    size_t count;
    const asp_metal *metals = asp_metals(&count);
    asp_error err;
    for (double c = 0.01; c <= 1; c += 0.06)
        for (double n1 = 1; n1 < 3; n1 += 0.37)
            for (double d = 0; d < 1500; d += 130)
                for (double n2 = 0.2; n2 < 4; n2 += 0.9)
                    for (double k = 0.01; k < 5; k += 1.3)
                        worst = fmax(worst, fabs(asp_fresnel_film(c, n1, d, n2, k, 550)
                                                 - film_by_amplitudes(c, n1, d, n2 + I * k, 550)));
    expect(worst < 1e-12, "thin films against complex amplitudes", worst);
    worst = fabs(asp_fresnel_film(0.4, 1.5, 0, 0.2, 3, 550) - asp_fresnel_conductor(0.4, 0.2, 3));
    expect(worst < 1e-14, "a film of no thickness is not there", worst);
    for (size_t i = 0; i < count; i++) {
        double eta, k, f0, tint, eta2, k2;
        if (asp_metal_index(&metals[i], 555, &eta, &k, &err) != ASP_OK)
            back = 1;
        asp_f82_of_index(eta, k, &f0, &tint);
        if (asp_index_of_f82(f0, tint, &eta2, &k2, &err) != ASP_OK)
            back = 1;
        back = fmax(back, fmax(fabs(eta2 / eta - 1), fabs(k2 / k - 1)));
    }
    expect(back < 1e-9, "n, k -> F82-tint -> n, k for every metal at 555 nm", back);
    expect(asp_index_of_f82(0.5, 0.1, &worst, &back, &err) == ASP_EINVAL && strcmp(err.name, "tint") == 0
               && err.high > err.low, "an impossible tint is refused with its range", err.low);
    expect(asp_metal_index(&metals[0], 1000, &worst, &back, &err) == ASP_EINVAL, "1000 nm is refused", err.high);
    {
        asp_rgb grey = asp_rgb_of_reflectance(white, &one);
        worst = fmax(fabs(grey.r - one), fmax(fabs(grey.g - one), fabs(grey.b - one)));
        expect(worst < 1e-5, "an even reflectance is grey", worst);
    }
    {
        /* by wavelength and by channel: the same when the numbers are */
        asp_material mat = material("conductor:eta=0.2/0.9/1.5,k=3.9/2.4/1.9,ndf=(ggx:alpha=0.3)");
        const double eta[3] = { 0.2, 0.9, 1.5 }, k[3] = { 3.9, 2.4, 1.9 };
        double f[3];
        asp_vec3 wi = direction(0.5, 0.1), wo = direction(0.9, 3);
        asp_rgb rgb = asp_eval(&mat, wi, wo);
        asp_eval_spectrum(&mat, wi, wo, 3, eta, k, f);
        worst = fmax(fabs(f[0] - rgb.r), fmax(fabs(f[1] - rgb.g), fabs(f[2] - rgb.b)));
        expect(worst < 1e-14, "three wavelengths are the three channels", worst);
        mat = material("dielectric:eta=1.5,ndf=(ggx:alpha=0.3)");
        wo = direction(0.32, 0.1);
        worst = asp_eval_spectrum(&mat, wi, (asp_vec3){ -wo.x, -wo.y, -wo.z }, 3, (double[3]){ 1.4, 1.5, 1.6 }, NULL, f);
        worst += fabs(f[1] / asp_eval(&mat, wi, (asp_vec3){ -wo.x, -wo.y, -wo.z }).r - 1) + (f[0] == f[1]);
        expect(worst < 1e-14, "and a dielectric's index its own, in transmission too", worst);
        mat = material("plastic:ndf=(ggx)");
        worst = asp_eval_spectrum(&mat, wi, wo, 3, eta, k, f) != ASP_EINVAL;
        mat = material("conductor:eta=1.5,film=200,ndf=(ggx)");
        worst += asp_eval_spectrum(&mat, wi, wo, 3, eta, k, f) != ASP_EINVAL;
        expect(worst == 0, "other materials and films are refused", worst);
        mat = material("conductor:f0=0.9,tint=1.05,ndf=(ggx:alpha=0.3)");
        wo = direction(0.9, 3);
        rgb = asp_eval(&mat, wi, wo);
        expect(rgb.r > 0, "tints above 1, which some metals have", rgb.r);
    }
}

/* ---- Lambertian facets */

static void check_diffuse(void)
{
    asp_material exact = material("rough_diffuse:albedo=1,ndf=(beckmann:alpha=0.001)");
    asp_ndf k = ndf("ggx:alpha_x=0.6,alpha_y=0.3,mean_x=0.2");
    asp_material rough = asp_rough_diffuse(&k, (asp_rgb){ 1, 1, 1 }, ASP_MASK_WALL);
    asp_vec3 wi = direction(0.8, 0.2), wo = direction(1.1, 2.5);
    double worst = 0, brute = 0, sum;
    int n = 400;
    for (int i = 0; i < 6; i++)
        worst = fmax(worst, fabs(asp_eval(&exact, direction(0.2 * i, 1), direction(0.25 * i, 2)).r * PI - 1));
    expect(worst < 2e-3, "Lambertian facets on a flat surface are Lambert's law", worst);
    /* the integral of max(0, wi.m) max(0, wo.m) D by brute force over slopes r = tan a, in polar form */
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double a = (i + 0.5) / n * (PI / 2), phi = (j + 0.5) / n * 2 * PI, r = tan(a);
            double x = r * cos(phi), y = r * sin(phi), c = 1 / sqrt(1 + r * r);
            double ci = fmax(0, wi.z - wi.x * x - wi.y * y) * c, co = fmax(0, wo.z - wo.x * x - wo.y * y) * c;
            brute += asp_P22(&k, x, y) / c * ci * co * r / (cos(a) * cos(a)) * (PI / 2 / n) * (2 * PI / n);
        }
    sum = asp_eval(&rough, wi, wo).r * PI;
    {
        double si = asp_sigma(&k, wi) + 0.2 * fmax(0, wi.x), so = asp_sigma(&k, wo) + 0.2 * fmax(0, wo.x);
        brute /= si * wo.z + so * wi.z - wi.z * wo.z;
    }
    worst = fabs(sum / brute - 1);
    expect(worst < 3e-3, "Lambertian facets against brute force", worst);
    worst = fabs(asp_eval(&rough, wi, wo).r / asp_eval(&rough, wo, wi).r - 1);
    expect(worst < 1e-14, "and reciprocal", worst);
}

/* eon by quadrature over the hemisphere: albedo 1 returns all light, less in between, and its mean. */
static void check_eon(void)
{
    static const double alphas[] = { 0.05, 0.5, 1, 5, 100 };
    double worst = 0, back = 0, dark = 0, fujii = 1;
    for (int a = 0; a < 5; a++) {
        char spec[96];
        asp_material eon[2], plain;
        snprintf(spec, sizeof spec, "rough_diffuse:form=eon,albedo=1,ndf=(ggx:alpha=%g)", alphas[a]);
        eon[0] = material(spec);
        snprintf(spec, sizeof spec, "rough_diffuse:form=eon,albedo=0.5,ndf=(ggx:alpha=%g)", alphas[a]);
        eon[1] = material(spec);
        snprintf(spec, sizeof spec, "rough_diffuse:form=fujii,albedo=1,ndf=(ggx:alpha=%g)", alphas[a]);
        plain = material(spec);
        for (int k = 0; k < 5; k++) {
            asp_vec3 wi = direction(0.05 + 0.37 * k, 0.3);
            double sum[3] = { 0, 0, 0 };
            int n = 128, m = 256;
            /* the integrand has a kink where wo is as high as wi: the rule is cut there */
            for (int half = 0; half < 2; half++)
                for (int i = 0; i < n; i++)
                    for (int j = 0; j < m; j++) {
                        double low = half ? 0.05 + 0.37 * k : 0, high = half ? PI / 2 : 0.05 + 0.37 * k;
                        double theta = low + (high - low) * (i + 0.5) / n, phi = 0.3 + 2 * PI * (j + 0.5) / m;
                        asp_vec3 wo = direction(theta, phi);
                        double w = sin(theta) * (high - low) / n * 2 * PI / m;
                        sum[0] += asp_eval_cos(&eon[0], wi, wo).r * w;
                        sum[1] += asp_eval_cos(&eon[1], wi, wo).r * w;
                        sum[2] += asp_eval_cos(&plain, wi, wo).r * w;
                        if (j == 0) {
                            double f = asp_eval(&eon[0], wi, wo).r, g = asp_eval(&eon[0], wo, wi).r;
                            back = fmax(back, fabs(f / g - 1));
                        }
                    }
            worst = fmax(worst, fabs(sum[0] - 1));
            dark = fmax(dark, sum[1]);
            fujii = fmin(fujii, sum[2]);
        }
    }
    expect(worst < 1e-4, "eon with albedo 1 returns all light", worst);
    expect(fujii < 0.8, "fujii, which it completes, does not", fujii);
    expect(dark < 0.5 + 1e-4, "eon with albedo 1/2 returns at most half", dark);
    expect(back < 1e-14, "eon is reciprocal", back);
    worst = 0;
    for (int a = 0; a < 6; a++) { /* the mean of estimates by one facet */
        asp_material m = material(a % 2 ? "rough_diffuse:albedo=0.7,ndf=(ggx:alpha=0.6)"
                                        : "rough_diffuse:albedo=0.7,mask=uncorrelated,ndf=(beckmann:alpha_x=0.3,alpha_y=0.8)");
        asp_vec3 wi = direction(0.2 + 0.2 * a, 1), wo = direction(1.2 - 0.2 * a, 2.5 + a);
        int n = 200000;
        double sum = 0;
        for (int j = 0; j < n; j++)
            sum += asp_eval_stochastic(&m, wi, wo, fmod(0.5 + 0.7548776662466927 * j, 1),
                                       fmod(0.5 + 0.5698402909980532 * j, 1)).r / n;
        worst = fmax(worst, fabs(sum / asp_eval(&m, wi, wo).r - 1));
    }
    expect(worst < 5e-3, "one facet drawn estimates Lambertian facets' quadrature", worst);
    for (int a = 0; a < 4; a++) {
        static const char *const pairs[4][2] = { { "torrance_sparrow:alpha=0.1", "torrance_sparrow:alpha=1" },
                                                 { "abc:alpha=10", "abc:alpha=10000" },
                                                 { "gtr:alpha=0.1", "gtr:alpha=0.9" }, { "sgd:alpha=0.01", "sgd:alpha=1" } };
        double f[2];
        char spec[96];
        for (int b = 0; b < 2; b++) {
            asp_vec3 w = direction(0.9, 0);
            snprintf(spec, sizeof spec, "rough_diffuse:form=oren_nayar,ndf=(%s)", pairs[a][b]);
            asp_material m = material(spec);
            f[b] = asp_eval(&m, w, w).r;
        }
        expect(fabs(f[1] - f[0]) > 0.01, "oren_nayar knows the roughness that is a shape number", f[1] - f[0]);
    }
}

static void check_refusals(void)
{
    static const char *const bad[] = {
        "dielectric:eta=0,ndf=(ggx)", "dielectric:eta=nan,ndf=(ggx)", "dielectric:thin=2,ndf=(ggx)",
        "dielectric:transport=light,ndf=(ggx)", "plastic:eta=1,ndf=(ggx)", "plastic:albedo=1.1,ndf=(ggx)",
        "rough_diffuse:form=lambert,ndf=(ggx)", "compensated:form=none,ndf=(ggx)",
        "compensated_dielectric:form=single,ndf=(ggx)", "compensated_dielectric:eta=0,ndf=(ggx)",
        "compensated_dielectric:metal=Au,ndf=(ggx)",
        "conductor:metal=Au,film=-1,ndf=(ggx)", "conductor:metal=Au,film_eta=1.5,ndf=(ggx)",
        "conductor:f0=0.5,film=100,ndf=(ggx)"
    };
    int refused = 0, n = (int)(sizeof bad / sizeof *bad);
    for (int i = 0; i < n; i++) {
        asp_material mat;
        asp_error err;
        int s = asp_material_parse(NULL, bad[i], &mat, &err) != ASP_OK && err.name[0] && err.position >= 0;
        if (!s)
            printf("accepted, or refused without a position: %s\n", bad[i]);
        refused += s;
    }
    expect(refused == n, "bad numbers and names are refused with their place", refused);
}

int main(void)
{
    check_energy();
    check_energy_glass();
    check_even();
    check_split();
    check_limits();
    check_walk();
    check_bounded();
    check_crossing();
    check_spectrum();
    check_diffuse();
    check_eon();
    check_refusals();
    return finish();
}
