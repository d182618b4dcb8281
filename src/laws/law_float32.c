/* law_float32.c - float32 against float64 at the same float32 inputs
 *
 * Allowed are 2e-6, and 1e-4 where D is below 1e-6 of its peak. Three things are beyond any
 * arithmetic of 24 bits and are added: a difference loses what cancels in it. They are the height
 * w.z - t.w_xy of a view on a skewed surface, the standard slope M^-1 (p - t) where the map is
 * skewed or turned, and the cosine w.m of a facet seen edge-on. Unskewed along the axes nothing is
 * added but what the record's two arguments lose by being float32. The numbers of the map are inputs as the directions are: float64 is given
 * the same ones. */
#include "laws/laws.h"

#include <math.h>

#define EPS 1.2e-7

static asp_vec3f narrow(asp_vec3 v)
{
    asp_vec3f out;
    out.x = (float)v.x;
    out.y = (float)v.y;
    out.z = (float)v.z;
    return out;
}

static asp_vec3 widen(asp_vec3f v)
{
    asp_vec3 out;
    out.x = v.x;
    out.y = v.y;
    out.z = v.z;
    return out;
}

/* What rounding the terms of q = M^-1 (p - t) does to ln P22: 0 where nothing cancels. The slope of
 * ln P22 is taken from P22 itself. */
static double slope_rounding(const aspi_trial *t, asp_vec3 m)
{
    const asp_ndf *k = t->ndf;
    double z = fabs(m.z) > 1e-30 ? fabs(m.z) : 1e-30;
    double px = -m.x / z, py = -m.y / z, dx = px - k->map.tx, dy = py - k->map.ty;
    double x = fabs(px) + fabs(k->map.tx), y = fabs(py) + fabs(k->map.ty);
    double qx = k->i00 * dx + k->i01 * dy, qy = k->i10 * dx + k->i11 * dy;
    double ex = fabs(k->i00) * x + fabs(k->i01) * y - fabs(qx);
    double ey = fabs(k->i10) * x + fabs(k->i11) * y - fabs(qy);
    double lost = EPS * (fmax(ex, 0) + fmax(ey, 0)), r = hypot(qx, qy), low, high;
    if (!(lost > 1e-12 * (r + t->scale)))
        return 0;
    low = asp_P22(&t->standard, r + lost, 0);
    high = asp_P22(&t->standard, r > lost ? r - lost : 0, 0);
    return low > 0 ? fabs(log(high / low)) : INFINITY;
}

/* A record's density takes r2 and z2 as two numbers: half an ulp each, times d ln P22 / d ln r2. That
 * is 1.6e-6 for a Gaussian at 1e-6 of its peak, and next to nothing for GGX. */
static double record_rounding(const aspi_trial *t, asp_vec3 m)
{
    double r, phi, a, b;
    aspi_standard_polar(t->ndf, m, &r, &phi);
    a = asp_P22(&t->standard, r * 0.9999, 0);
    b = asp_P22(&t->standard, r * 1.0001, 0);
    return b > 0 ? EPS * fabs(log(a / b)) / (2 * log(1.0001 / 0.9999)) : 0;
}

/* Slopes counted in cells: where rounding may carry a slope into the next cell, by how much that
 * differs. */
static double cell_rounding(const aspi_trial *t, asp_vec3 m)
{
    const asp_ndf *k = t->ndf;
    double z = fabs(m.z) > 1e-30 ? fabs(m.z) : 1e-30, low, high;
    double px = -m.x / z, py = -m.y / z, dx = px - k->map.tx, dy = py - k->map.ty;
    double x = fabs(px) + fabs(k->map.tx), y = fabs(py) + fabs(k->map.ty);
    aspi_planar_bounds(t, k->i00 * dx + k->i01 * dy, k->i10 * dx + k->i11 * dy,
                       4 * EPS * (fabs(k->i00) * x + fabs(k->i01) * y),
                       4 * EPS * (fabs(k->i10) * x + fabs(k->i11) * y), &low, &high);
    return low == high ? 0 : low > 0 ? (high - low) / low : INFINITY;
}

static double density_allowance(const aspi_trial *t, asp_vec3 m, double D)
{
    asp_vec3 top = asp_mean_normal(t->ndf);
    double z4 = m.z * m.z / (top.z * top.z), peak = asp_D(t->ndf, top);
    /* what the standard surface's P22 loses below the least normal number of float32 */
    double lost = 2e-38 * t->ndf->inv_det / (m.z * m.z * m.z * m.z);
    if (t->planar)
        return 2e-6 + cell_rounding(t, m);
    /* of the peak in slopes: D = P22/cos^4 grows without bound towards vertical facets */
    return (D * z4 * z4 < 1e-6 * peak ? 1e-4 : 2e-6) + slope_rounding(t, m) + record_rounding(t, m)
         + lost / D;
}

static double off_range(double found, double low, double high)
{
    if (high < 1e-30)
        return found < 1e-29 ? 0 : INFINITY;
    return found < low ? (low - found) / low : found > high ? (found - high) / high
         : found == found ? 0 : NAN;
}

/* All that is rounded on the way is a height above the farthest cell. */
static double planar_sigma_deviation(const aspi_trial *t, asp_vec3 w, double found)
{
    const asp_map *map = &t->ndf->map;
    const asp_lattice *l = &t->lattice;
    double far_x = fmax(fabs(l->x0), fabs(l->x0 + l->dx * (double)l->nx));
    double far_y = fmax(fabs(l->y0), fabs(l->y0 + l->dy * (double)l->ny)), step, low, high;
    asp_vec3 v = aspi_standard_vector(t->ndf, w);
    step = EPS * (fabs(w.z) + fabs(map->tx * w.x) + fabs(map->ty * w.y)
                  + far_x * (fabs(map->m00 * w.x) + fabs(map->m10 * w.y))
                  + far_y * (fabs(map->m01 * w.x) + fabs(map->m11 * w.y)));
    v.z -= step;
    low = asp_sigma(&t->standard, v);
    v.z += 2 * step;
    high = asp_sigma(&t->standard, v);
    return off_range(found, low, high);
}

/* Relative distance of x from the interval that the roundings of the view's height and length span. */
static double sigma_deviation(const aspi_trial *t, asp_vec3 w, double found)
{
    const asp_map *map = &t->ndf->map;
    double h, s, step, lost, low, high;
    asp_vec3 v = { 0, 0, 0 };
    if (t->planar)
        return planar_sigma_deviation(t, w, found);
    aspi_standard_view(t->ndf, w, &h, &s);
    step = EPS * (fabs(w.z) + fabs(map->tx * w.x) + fabs(map->ty * w.y));
    if (!t->skewed)
        step = 0;
    /* and of its length where the map is turned: M^T w_xy; and half an ulp, as of a record's arguments */
    lost = EPS * fmax(s / 2, hypot(fabs(map->m00 * w.x) + fabs(map->m10 * w.y),
                                   fabs(map->m01 * w.x) + fabs(map->m11 * w.y)) - s / 2);
    v.x = fmax(0, s - lost); /* sigma grows with both */
    v.z = h - step;
    low = asp_sigma(&t->standard, v);
    v.x = s + lost;
    v.z = h + step;
    high = asp_sigma(&t->standard, v);
    return off_range(found, low, high);
}

/* What the height of a view above the mean slope, or above the farthest cell, loses. */
static double height_lost(const aspi_trial *t)
{
    const asp_map *map = &t->ndf->map;
    double tilt = hypot(map->tx, map->ty), far = 0;
    if (t->planar) /* scale is an eighth of the cells' diagonal */
        far = 8 * t->scale * hypot(hypot(map->m00, map->m01), hypot(map->m10, map->m11));
    return t->skewed || t->planar ? 4 * EPS * (1 + tilt + far) : 0;
}

static void compare_facets(aspi_trial *t)
{
    int i;
    for (i = 0; i < 3000; i++) {
        asp_vec3f mf = narrow(aspi_random_facet(t));
        asp_vec3 m = widen(mf);
        double D = asp_D(t->ndf, m), found = asp_Df(&t->ndff, mf);
        double pdf = asp_pdf_normalf(&t->ndff, mf);
        if (!(m.z > 2e-9) || D > 1e37)
            continue;
        if (D > 1e-30)
            aspi_find(t, fabs(found - D) / D, density_allowance(t, m, D),
                      "D, m = (%.7g, %.7g, %.7g): %.9g, float64 %.9g", m.x, m.y, m.z, found, D);
        else
            aspi_find(t, found, t->planar && cell_rounding(t, m) > 0 ? INFINITY : 2e-30,
                      "D, m = (%.7g, %.7g, %.7g): not gone", m.x, m.y, m.z);
        if (D * m.z > 1e-30)
            aspi_find(t, fabs(pdf - D * m.z) / (D * m.z), density_allowance(t, m, D),
                      "pdf_normal, m = (%.7g, %.7g, %.7g)", m.x, m.y, m.z);
        {
            float px = -mf.x / mf.z, py = -mf.y / mf.z;
            double P22 = asp_P22(t->ndf, px, py), other = asp_P22f(&t->ndff, px, py);
            if (P22 > 1e-30 && P22 < 1e37) {
                asp_vec3 n = { 0, 0, 1 };
                n.x = -px;
                n.y = -py;
                aspi_find(t, fabs(other - P22) / P22, density_allowance(t, n, P22),
                          "P22(%.7g, %.7g): %.9g, float64 %.9g", (double)px, (double)py, other,
                          P22);
            }
        }
    }
}

static void compare_views(aspi_trial *t)
{
    int i, k;
    for (i = 0; i < 600; i++) {
        asp_vec3f wf;
        asp_vec3 w = aspi_random_direction(t);
        double found, rounding, h, s;
        if (i % 3 == 0)
            w = t->views[(size_t)i / 3 % t->view_count].w;
        if (i % 3 == 1)
            w = aspi_unit(w.x, w.y, w.z * exp(-12 * aspi_uniform(t)));
        wf = narrow(w);
        w = widen(wf);
        found = asp_sigmaf(&t->ndff, wf);
        aspi_standard_view(t->ndf, w, &h, &s);
        /* far below the mean plane sigma is a tail: 1e-4 below 1e-6 of its height at the plane */
        rounding = asp_sigma(t->ndf, w) < 1e-6 * s * t->scale ? 1e-4 : 2e-6;
        /* on the way there it carries the rounding of its exponent, as densities do */
        if (h < 0 && t->ndf->model->own_scale)
            rounding += 3e-7 * fmax(0, log(s * t->scale / asp_sigma(t->ndf, w)));
        aspi_find(t, sigma_deviation(t, w, found), rounding,
                  "sigma, w = (%.7g, %.7g, %.7g): %.9g, float64 %.9g", w.x, w.y, w.z, found,
                  asp_sigma(t->ndf, w));
        if (w.z <= 0)
            continue;
        for (k = 0; k < 2; k++) {
            int mask = k ? ASP_MASK_WALL : 0;
            double G1 = asp_G1(t->ndf, w, mask), other = asp_G1f(&t->ndff, wf, mask);
            double lost = height_lost(t) / asp_sigma(t->ndf, w);
            aspi_find(t, fabs(other - G1) / G1, rounding + fmin(lost, 1),
                      "G1%s, w = (%.7g, %.7g, %.7g): %.9g, float64 %.9g", k ? " wall" : "", w.x,
                      w.y, w.z, other, G1);
        }
    }
}

static void compare_visible(aspi_trial *t)
{
    int i;
    for (i = 0; i < 1500; i++) {
        asp_vec3f wf = narrow(t->views[(size_t)i % t->view_count].w);
        asp_vec3f mf = narrow(aspi_random_facet(t));
        asp_vec3 w = widen(wf), m = widen(mf);
        double pdf = asp_pdf_visible(t->ndf, w, m), found = asp_pdf_visiblef(&t->ndff, wf, mf);
        double c = aspi_dot(w, m), sigma = asp_sigma(t->ndf, w), lost;
        if (!(pdf > 1e-30 && pdf < 1e37 && sigma > 1e-12 && m.z > 2e-9))
            continue;
        lost = 2 * EPS / c + height_lost(t) / sigma;
        aspi_find(t, fabs(found - pdf) / pdf, density_allowance(t, m, asp_D(t->ndf, m))
                  + fmin(lost, 1) + (sigma < 1e-6 * t->scale ? 1e-4 : 0),
                  "pdf_visible, %s, m = (%.7g, %.7g, %.7g): %.9g, float64 %.9g",
                  t->views[(size_t)i % t->view_count].name, m.x, m.y, m.z, found, pdf);
    }
}

/* Samples of one (u1, u2): the same facet within 1e-5 of its slope's length plus the roughness. u
 * near 1 is left out: there 1 - u itself has only a few bits, in the input. Where the tails are heavy a
 * last bit of the distribution function, which a sampler inverts in 24 bits, moves the sample far:
 * two such are added. */
static void compare_samples(aspi_trial *t)
{
    int i;
    for (i = 0; i < 1000; i++) {
        float u1 = (float)(0.98 * aspi_uniform(t)), u2 = (float)(0.98 * aspi_uniform(t));
        const aspi_view *v = &t->views[(size_t)i % t->view_count];
        asp_vec3f wf = narrow(v->w);
        asp_vec3 a, b, c, d;
        double size, moved, stretch = hypot(hypot(t->ndf->map.m00, t->ndf->map.m01),
                                     hypot(t->ndf->map.m10, t->ndf->map.m11));
        const char *name = i % 2 ? v->name : "normals";
        /* which normals are seen hangs on the height of the view, too */
        double bit = EPS + (i % 2 ? 0.25 * height_lost(t) / fmax(asp_sigma(t->ndf, v->w), 1e-3) : 0);
        if (i % 2) {
            a = widen(asp_sample_visiblef(&t->ndff, wf, u1, u2));
            b = asp_sample_visible(t->ndf, widen(wf), u1, u2);
            c = asp_sample_visible(t->ndf, widen(wf), u1 + bit, u2);
            d = asp_sample_visible(t->ndf, widen(wf), fmax(u1 - bit, 0), u2);
        } else {
            a = widen(asp_sample_normalf(&t->ndff, u1, u2));
            b = asp_sample_normal(t->ndf, u1, u2);
            c = asp_sample_normal(t->ndf, u1 + bit, u2);
            d = asp_sample_normal(t->ndf, fmax(u1 - bit, 0), u2);
        }
        if (!(asp_sigma(t->ndf, v->w) > 1e-3)) /* so little is seen that height's rounding rules */
            continue;
        size = hypot(hypot(b.x, b.y), b.z * stretch * t->scale) + b.z * (t->skewed
             ? hypot(t->ndf->map.tx, t->ndf->map.ty) : 0);
        size = fmin(size, 1);
        moved = 2 * fmax(hypot(hypot(c.x - b.x, c.y - b.y), c.z - b.z),
                         hypot(hypot(d.x - b.x, d.y - b.y), d.z - b.z));
        aspi_find(t, hypot(a.x - b.x, a.y - b.y), 1e-5 * size + moved,
                  "sample of %s, u = (%.7g, %.7g): (%.7g, %.7g, %.7g), float64 (%.7g, %.7g, %.7g)",
                  name, u1, u2, a.x, a.y, a.z, b.x, b.y, b.z);
        aspi_find(t, fabs(a.z - b.z), 1e-5 * size * size + 2 * EPS + moved,
                  "sample of %s, u = (%.7g, %.7g): (%.7g, %.7g, %.7g), float64 (%.7g, %.7g, %.7g)",
                  name, u1, u2, a.x, a.y, a.z, b.x, b.y, b.z);
    }
}

static double farthest(asp_rgb a, asp_rgbf b)
{
    return fmax(fabs(a.r - (double)b.r), fmax(fabs(a.g - (double)b.g), fabs(a.b - (double)b.b)));
}

/* f cos and density of the caller's material. A facet is what two directions leave: their rounding is multiplied as in
 * float64 (aspi_facet_steps), by a quarter of how much wider a step is; ten steps are for colours, masking and tables. */
static void compare_material(aspi_trial *t)
{
    asp_material wide = *t->own;
    asp_materialf single = asp_material_narrow(t->own);
    aspi_traits is = aspi_traits_of(t->own);
    wide.ndf = *t->ndf;
    for (int i = 0; i < (is.quadrature ? 200 : 2000); i++) {
        asp_vec3 w = t->views[(size_t)i % t->view_count].w, v = aspi_random_direction(t), h;
        double n, k, f, pdf, steps;
        asp_vec3f wi, wo;
        if (is.crosses && i & 1)
            w.x = -w.x, w.y = -w.y, w.z = -w.z;
        if (i % 3)
            v = asp_sample_lobe(&wide, w, aspi_uniform(t), aspi_uniform(t), aspi_uniform(t)).wo;
        wi = narrow(w);
        wo = narrow(v);
        w = widen(wi);
        v = widen(wo);
        f = aspi_largest(asp_eval_cos(&wide, w, v));
        pdf = asp_pdf(&wide, w, v);
        n = w.z < 0 ? 1 / is.eta : is.eta;
        k = w.z * v.z > 0 ? 1 : n;
        h = aspi_unit(w.x + k * v.x, w.y + k * v.y, w.z + k * v.z);
        if (is.thin && w.z * v.z < 0)
            h = aspi_unit(w.x + v.x, w.y + v.y, w.z - v.z);
        if (h.z < 0)
            h.x = -h.x, h.y = -h.y, h.z = -h.z;
        steps = aspi_facet_steps(t, w, v, n) * (0.25 * EPS / 2.2e-16) + height_lost(t) / fmax(asp_sigma(t->ndf, w), 1e-30);
        if (!(steps < 0.03) || !(h.z > 1e-6) || !(f > 1e-25 && f < 1e30 && pdf > 1e-25 && pdf < 1e30))
            continue;
        steps += 10 * EPS + density_allowance(t, h, asp_D(t->ndf, h));
        aspi_find(t, farthest(asp_eval_cos(&wide, w, v), asp_eval_cosf(&single, wi, wo)) / f, steps,
                  "f cos, wi (%.7g, %.7g, %.7g), wo (%.7g, %.7g, %.7g): float64 %.9g", w.x, w.y, w.z, v.x, v.y, v.z, f);
        aspi_find(t, fabs((double)asp_pdff(&single, wi, wo) - pdf) / pdf, steps,
                  "pdf, wi (%.7g, %.7g, %.7g), wo (%.7g, %.7g, %.7g): float64 %.9g", w.x, w.y, w.z, v.x, v.y, v.z, pdf);
    }
}

/* float64's shape and table, float32's map. */
static asp_ndf widened(const asp_ndf *ndf, const asp_ndff *f)
{
    asp_ndf out = *ndf;
    out.map.m00 = f->map.m00;
    out.map.m01 = f->map.m01;
    out.map.m10 = f->map.m10;
    out.map.m11 = f->map.m11;
    out.map.tx = f->map.tx;
    out.map.ty = f->map.ty;
    out.i00 = f->i00;
    out.i01 = f->i01;
    out.i10 = f->i10;
    out.i11 = f->i11;
    out.inv_det = f->inv_det;
    return out;
}

void aspi_law_float32(aspi_trial *t)
{
    const asp_ndf *ndf = t->ndf;
    asp_ndf wide = widened(ndf, &t->ndff);
    t->ndf = &wide;
    if (t->own) {
        compare_material(t);
        t->ndf = ndf;
        return;
    }
    compare_facets(t);
    aspi_tick(t, 0.3);
    if (!t->cancelled)
        compare_views(t);
    aspi_tick(t, 0.5);
    if (!t->cancelled)
        compare_visible(t);
    if (!t->cancelled)
        compare_samples(t);
    t->ndf = ndf;
}
