/* walk_loops.h - the formulas of walker.h and reflection.h over the rays of a block */

#include "bsdf/reflection.h"
#include "core/blocks.h"
#include "core/walker.h"

#ifndef ASPI_WALK_LOOPS_NAMES
#define ASPI_WALK_LOOPS_NAMES
#define aspi_walk_all ASP_NAME(aspi_walk_all)
#define aspi_walk_again ASP_NAME(aspi_walk_again)
#define aspi_walk_area ASP_NAME(aspi_walk_area)
#define aspi_walk_facets ASP_NAME(aspi_walk_facets)
#define aspi_walk_first ASP_NAME(aspi_walk_first)
#define aspi_walk_flights ASP_NAME(aspi_walk_flights)
#define aspi_walk_densities ASP_NAME(aspi_walk_densities)
#define aspi_walk_below_1 ASP_NAME(aspi_walk_below_1)
#define aspi_walk_begin ASP_NAME(aspi_walk_begin)
#define aspi_walk_meet ASP_NAME(aspi_walk_meet)
#define aspi_walk_roulette ASP_NAME(aspi_walk_roulette)
#define aspi_walk_scatter ASP_NAME(aspi_walk_scatter)
#define aspi_walk_spare ASP_NAME(aspi_walk_spare)
#define aspi_walk_sum ASP_NAME(aspi_walk_sum)
#define aspi_walk_tint ASP_NAME(aspi_walk_tint)
/* Of a flight from or to a height that is drawn. */
enum {
    FLIGHT_L, FLIGHT_SEEN, FLIGHT_HEIGHT, FLIGHT_RISE, FLIGHT_AREA, FLIGHT_OUT_AREA, FLIGHT_OUT_RISE, FLIGHT_U0,
    FLIGHT_U1, FLIGHT_NUMBERS
};
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_WALK_LOOPS_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_WALK_LOOPS_32))
#if ASP_PRECISION == 64
#define ASPI_WALK_LOOPS_64
#else
#define ASPI_WALK_LOOPS_32
#endif

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

/* aspi_area_seen from sigma. */
ASP_FN void aspi_walk_area(size_t n, asp_real sign, IN z, OUT area)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        area[i] = aspi_max(area[i], sign * z[i]);
}

/* Whether light may walk from every one of these v to its w: aspi_may_walk over mirrors. */
ASP_FN int aspi_walk_all(size_t n, IN vx, IN vy, IN vz, IN wx, IN wy, IN wz)
{
    int refused = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real nothing = aspi_walk_nothing(aspi_at(vx, vy, vz, i), aspi_at(wx, wy, wz, i));
        refused += !((vz[i] > R(0.0)) & (wz[i] > R(0.0)) & (nothing == R(0.0)));
    }
    return refused == 0;
}

/* aspi_next_uniform's bound. */
ASP_FN void aspi_walk_below_1(size_t n, OUT u)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        u[i] = aspi_below_1(u[i]);
}

/* The facets between v and w, and the cosines there. */
ASP_FN void aspi_walk_facets(size_t n, IN vx, IN vy, IN vz, IN wx, IN wy, IN wz, OUT mx, OUT my, OUT mz, OUT c)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(vx, vy, vz, i), m = aspi_half_vector(v, aspi_at(wx, wy, wz, i));
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
        c[i] = aspi_dot(v, m);
    }
}

/* The first meeting is certain. */
ASP_FN void aspi_walk_first(size_t n, IN area, IN vz, OUT seen, OUT height, OUT meets)
{
    size_t i;
    for (i = 0; i < n; i++) {
        seen[i] = area[i];
        height[i] = aspi_abs(vz[i]);
        meets[i] = R(1.0);
    }
}

/* Where q is not drawn and the ray leads away: the probability that it meets facets again. */
ASP_FN void aspi_walk_again(size_t n, IN area, IN vz, IN seen, IN height, OUT meets)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real p = aspi_meets_one(seen[i], height[i], area[i], aspi_abs(vz[i]));
        meets[i] = area[i] > ASP_SMALLEST ? p : R(0.0);
    }
}

/* The same, and what facets send to w, but for F and over the area seen. */
ASP_FN void aspi_walk_meet(size_t n, IN area, IN vz, IN seen, IN height, IN out_area, IN wz, IN D, OUT meets, OUT sent)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real p = aspi_meets_one(seen[i], height[i], area[i], aspi_abs(vz[i]));
        meets[i] = p;
        sent[i] = aspi_facets_send(D[i], aspi_meets_none(seen[i], height[i], out_area[i], wz[i]) * p);
    }
}

/* What the first facets send, which meet all. */
ASP_FN void aspi_walk_begin(size_t n, IN area, IN vz, IN out_area, IN wz, IN D, OUT sent)
{
    size_t i;
    for (i = 0; i < n; i++)
        sent[i] = aspi_facets_send(D[i], aspi_meets_none(area[i], vz[i], out_area[i], wz[i]));
}

/* Flights of rays whose q is drawn now at the latest: log q at the facet, the probability that there is one, and
 * that times the probability that light gets out from there. */
ASP_FN void aspi_walk_flights(size_t n, const int *ASP_RESTRICT drawn, const int *ASP_RESTRICT deeper,
                         asp_real f[FLIGHT_NUMBERS][ASP_BLOCK], OUT l, OUT meets, OUT open)
{
    size_t i;
    for (i = 0; i < n; i++) {
        aspi_flown to = aspi_flown_to(drawn[i], deeper[i], f[FLIGHT_L][i], f[FLIGHT_U0][i], f[FLIGHT_U1][i],
                                      f[FLIGHT_SEEN][i], f[FLIGHT_HEIGHT][i], f[FLIGHT_RISE][i], f[FLIGHT_AREA][i],
                                      f[FLIGHT_OUT_AREA][i], f[FLIGHT_OUT_RISE][i]);
        l[i] = to.l;
        meets[i] = to.meets;
        open[i] = to.open;
    }
}

/* The share of walks that go on by roulette, and what they then carry. */
ASP_FN void aspi_walk_roulette(size_t n, const int *ASP_RESTRICT met, OUT r, OUT g, OUT b, OUT share)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real p = aspi_goes_on(met[i], aspi_max(r[i], aspi_max(g[i], b[i])));
        r[i] = r[i] / p;
        g[i] = g[i] / p;
        b[i] = b[i] / p;
        share[i] = p;
    }
}

/* By how much the number that decides it is below the probability that a walk goes on. */
ASP_FN void aspi_walk_spare(size_t n, IN meets, IN share, IN u, OUT spare)
{
    size_t i;
    for (i = 0; i < n; i++)
        spare[i] = meets[i] * share[i] - u[i];
}

ASP_FN void aspi_walk_sum(size_t n, IN carried, IN sent, IN meets, OUT sum)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real more = sum[i] + carried[i] * sent[i];
        sum[i] = meets[i] > R(0.0) ? more : sum[i];
    }
}

ASP_FN void aspi_walk_tint(size_t n, IN F, OUT carried)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        carried[i] = carried[i] * F[i];
}

/* The rays turn by reflection at m; the squared cosines there. */
ASP_FN void aspi_walk_scatter(size_t n, IN mx, IN my, IN mz, OUT vx, OUT vy, OUT vz, OUT c2)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(vx, vy, vz, i), m = aspi_at(mx, my, mz, i), d = aspi_negate(aspi_reflect(v, m));
        asp_real c = aspi_dot(v, m);
        vx[i] = d.x;
        vy[i] = d.y;
        vz[i] = d.z;
        c2[i] = c * aspi_abs(c);
    }
}

ASP_FN void aspi_walk_densities(size_t n, IN iz, IN oz, IN area, IN D, IN mz, IN c, OUT pdf)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real once = R(0.25) * D[i];
        once = aspi_min(c[i], mz[i]) <= R(0.0) ? R(0.0) : once;
        pdf[i] = aspi_walk_mixture(iz[i], area[i], once / area[i], aspi_abs(oz[i]) * R(1.0 / ASP_PI));
    }
}
#undef IN
#undef OUT
#endif
