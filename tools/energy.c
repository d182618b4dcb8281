/* energy.c - the energy balance by quadrature
 *
 * With the facet m and the given direction seen from it, wi = (theta_d, phi_d), the reflected direction
 * has the same theta_d on the other side. f cos cos dwi dwo = D G2 cos(theta_d) dm dwi, so that
 *
 *     E = (1/pi) int D(m) int G2 cos(theta_d) dwi dm
 *       = 2 int P22(r) r^2 sqrt(1 + r^2) I(r) d(log r),    r = tan(theta_m)
 *     I = 4 int_0^(pi/2) int_0^U G2 du/2 dphi,             u = sin^2(theta_d)
 *
 * where both directions are above the horizon for tan(theta_d) < T = cot(theta_m)/cos(phi),
 * U = T^2/(1 + T^2). Nothing is discontinuous inside. G2 leaves 0 at U with a power of its own and, for
 * smooth surfaces, in a thin layer: the double exponential rule (Takahasi, Mori 1974) puts its points
 * there. Along log r the trapezoid rule converges exponentially. */
#include "energy.h"

#include <math.h>

#define ASP_PRECISION 64
#include "asperity/elementary.h"

enum { OUTER = 144, PHI = 24, DEPTH = 40, POINTS = PHI * DEPTH };
#define PI 3.14159265358979323846

/* Node k of the double exponential rule for n on (0, 1), with its weight; `rest` is 1 - t. */
typedef struct node { double t, rest, weight; } node;

static node double_exponential(int k, int n, double reach)
{
    double h = 2 * reach / (n - 1), s = -reach + h * k;
    double up = aspi_exp(s), down = aspi_exp(-s);
    double e = aspi_exp(-PI / 2 * (up - down));              /* t = 1/(1 + e) */
    node out = { 1 / (1 + e), e / (1 + e), 0 };
    out.weight = h * PI / 2 * (up + down) * out.t * out.rest;
    return out;
}

/* Both directions for the nodes of one r; the weights of I. */
static void directions(double r, double *ci, double *co, double *weight)
{
    double cos_m = 1 / sqrt(1 + r * r), sin_m = r * cos_m;
    for (int j = 0; j < PHI; j++) {
        node p = double_exponential(j, PHI, 2.6);
        asp_v2 cs = aspi_sincos2pi(0.25 * p.t);
        double cos_p = p.rest < 0.5 ? aspi_sincos2pi(0.25 * p.rest).y : cs.x;
        double T = cos_m / (sin_m * cos_p), U = T * T / (1 + T * T);
        for (int k = 0; k < DEPTH; k++) {
            node d = double_exponential(k, DEPTH, 3.0);
            int i = j * DEPTH + k;
            /* 1 - u and cot^2(theta_d)/cot_min^2 without cancellation where u is near U */
            double u = U * d.t, cos_d = sqrt(1 / (1 + T * T) + U * d.rest), sin_d = sqrt(u);
            double along = sin_d * sin_m * cos_p;
            /* cos_d cos_m - along = (cos_d^2 cos_m^2 - along^2)/sum, and cos_d^2 = U rest + 1/(1+T^2) */
            double sum = cos_d * cos_m + along;
            ci[i] = U * d.rest * (cos_m * cos_m + sin_m * sin_m * cos_p * cos_p) / sum;
            co[i] = sum;
            weight[i] = 4 * (PI / 2 * p.weight) * (0.5 * U * d.weight);
        }
    }
}

energy_kept energy_of(const asp_ndf *ndf, double alpha)
{
    static const double steps_below = 7, steps_above = 16;
    energy_kept out = { 0, 0 };
    double low = aspi_log(alpha) - steps_below, high = aspi_log(alpha) + steps_above;
    double h = (high - low) / (OUTER - 1);
    double ci[POINTS], co[POINTS], si[POINTS], so[POINTS], weight[POINTS], s[POINTS], zero[POINTS];
    for (int i = 0; i < POINTS; i++)
        zero[i] = 0;
    for (int n = 0; n < OUTER; n++) {
        double r = aspi_exp(low + n * h), sum_s = 0, sum_c = 0;
        double p22 = asp_P22(ndf, r, 0), outer = 2 * h * p22 * r * r * sqrt(1 + r * r);
        if (!(outer > 1e-18))
            continue;
        directions(r, ci, co, weight);
        for (int i = 0; i < POINTS; i++)
            s[i] = sqrt(fmax(0, 1 - ci[i] * ci[i]));
        asp_sigma_n(ndf, POINTS, (asp_cvec3s){ s, zero, ci }, si);
        for (int i = 0; i < POINTS; i++)
            s[i] = sqrt(fmax(0, 1 - co[i] * co[i]));
        asp_sigma_n(ndf, POINTS, (asp_cvec3s){ s, zero, co }, so);
        for (int i = 0; i < POINTS; i++) {
            sum_s += weight[i] * ci[i] * co[i] / (si[i] * so[i]);
            sum_c += weight[i] * ci[i] * co[i] / (si[i] * co[i] + so[i] * ci[i] - ci[i] * co[i]);
        }
        out.separable += outer * sum_s;
        out.correlated += outer * sum_c;
    }
    return out;
}
