/* prepared_sight.c - what a view of slope mu sees from below the mean plane, as an integrand */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

#define SIGHT_BLOCK 256
#define SIGHT_STEPS 8            /* that are looked at together on the way in */

prepared_sight aspi_prepared_sight(const prepared_source *s, double mu)
{
    prepared_sight sight;
    sight.s = s;
    sight.mu = mu;
    sight.base = aspi_prepared_base(s, mu);
    return sight;
}

ASP_CLONES static void sight_slopes(double mu, size_t n, const double *ASP_RESTRICT t, double *ASP_RESTRICT eta,
                                    double *ASP_RESTRICT r2)
{
    size_t i;
    for (i = 0; i < n; i++) {
        eta[i] = aspi_exp_64(t[i]);
        r2[i] = mu * mu + eta[i] * eta[i];
    }
}

ASP_CLONES static void sight_masses(double mu, double base, size_t n, const double *ASP_RESTRICT eta,
                                    const double *ASP_RESTRICT log_density, double *ASP_RESTRICT out)
{
    const double per = mu > 0 ? 1 / mu : 1e300;
    size_t i;
    for (i = 0; i < n; i++) {
        double x = aspi_min_64(eta[i] * per, 1e9);
        double bracket = aspi_select_64(x < 0.1, eta[i] * aspi_prepared_near(x * x),
                                        eta[i] - mu * aspi_atan_64(x, 1));
        out[i] = aspi_exp_64(log_density[i] - base) * (eta[i] * eta[i]) * bracket;
    }
}

void aspi_prepared_seen(const void *context, size_t n, const double *t, double *out)
{
    const prepared_sight *v = (const prepared_sight *)context;
    double eta[SIGHT_BLOCK], r2[SIGHT_BLOCK], log_density[SIGHT_BLOCK];
    size_t from, count;
    for (from = 0; from < n; from += count) {
        count = n - from < SIGHT_BLOCK ? n - from : SIGHT_BLOCK;
        sight_slopes(v->mu, count, t + from, eta, r2);
        aspi_prepared_logs(v->s, count, r2, log_density);
        sight_masses(v->mu, v->base, count, eta, log_density, out + from);
    }
}

/* From far out down to past the peak and to where next to nothing is left. */
static double sight_start(const prepared_sight *sight, double from)
{
    double t[SIGHT_STEPS], found[SIGHT_STEPS], peak = 0;
    int i;
    for (;; from = t[SIGHT_STEPS - 1] - 0.7) {
        for (i = 0; i < SIGHT_STEPS; i++)
            t[i] = from - 0.7 * i;
        aspi_prepared_seen(sight, SIGHT_STEPS, t, found);
        for (i = 0; i < SIGHT_STEPS; i++) {
            peak = aspi_max_64(peak, found[i]);
            if (found[i] < 1e-8 * peak || t[i] <= sight->s->low)
                return t[i];
        }
    }
}

void aspi_prepared_sight_panels(const prepared_sight *sight, double t0, double longest, double least,
                                prepared_panels *out)
{
    double unit = 0.5 * aspi_log_64(sight->mu * sight->mu + t0 * t0);
    aspi_prepared_integrate(aspi_prepared_seen, sight, sight_start(sight, unit + 2), sight->mu > 0 ? 5 : 3,
                            aspi_max_64(sight->s->high, unit + 10), longest, least, out);
}
