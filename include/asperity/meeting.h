/* meeting.h - facet to facet: what a walk over the microsurface asks of a distribution, single and in loops
 *
 * Read by ndf_loops.h, once per precision. D is homogeneous of degree -4: half vectors stay as long as they are,
 * v + w, whose squared length is four times the squared cosine of either to the facet. */

/* The area of facets seen from v: at least v.z, which rounding must not undercut. */
ASP_FN asp_real ndf_seen(const asp_shape *k, asp_v3 v) { return aspi_max(ndf_sigma_at(k, aspi_view(k, v)), v.z); }

/* D of the unit normal along the half vector h, from D of h where that came by a loop. */
ASP_FN asp_real ndf_unit_density(asp_real D, asp_real cosine2)
{
    asp_real l2 = R(4.0) * cosine2;
    return aspi_finite(D * (l2 * l2));
}

/* One that is a quotient, 1/ndf_density_over, takes fewer steps. */
ASP_FN asp_real ndf_along(const asp_shape *k, asp_v3 h, asp_real cosine2)
{
#ifdef ASP_NDF_DENSITY_OVER
    asp_v3 m = aspi_facet(k, h);
    asp_real l2 = R(4.0) * cosine2, over = ndf_density_over(k, aspi_length2(m), m.z * m.z);
    asp_real D = aspi_finite(k->inv_det * (l2 * l2) / (over + ASP_TINY));
    return h.z <= ASP_FLAT ? R(0.0) : D;
#else
    return ndf_unit_density(ndf_world_density(k, h), cosine2);
#endif
}

/* The normal, of any length, of facets that mirror v to w, and the squared cosine there. */
ASP_FN asp_v3 ndf_halfway(asp_v3 v, asp_v3 w, asp_real *cosine2)
{
    v.x = v.x + w.x;
    v.y = v.y + w.y;
    v.z = v.z + w.z;
    *cosine2 = R(0.25) * aspi_dot(v, v);
    return v;
}

/* v turned by the facet m of squared length 1/q: the way back after reflection. */
ASP_FN asp_v3 ndf_way_back(asp_v3 v, asp_v3 m, asp_real q, asp_real *cosine2)
{
    asp_real m_z2;
    asp_v3 d = ndf_mirror(v, m, q, &m_z2, cosine2);
    return aspi_vector(-d.x, -d.y, -d.z);
}

ASP_CLONES_SINGLE static void ndf_meet_1(const asp_shape *k, asp_real vx, asp_real vy, asp_real vz, asp_real wx,
                                         asp_real wy, asp_real wz, asp_met *out)
{
    asp_v3 v = aspi_vector(vx, vy, vz), h = ndf_halfway(v, aspi_vector(wx, wy, wz), &out->between2);
    out->area = ndf_seen(k, v);
    out->area_out = ndf_sigma_at(k, aspi_view(k, aspi_vector(-wx, -wy, -wz)));
    out->D = ndf_along(k, h, out->between2);
}

ASP_CLONES_SINGLE static void ndf_turn_1(const asp_shape *k, asp_real vx, asp_real vy, asp_real vz, asp_real u1,
                                         asp_real u2, asp_real wx, asp_real wy, asp_real wz, asp_met *out)
{
    asp_v3 v = aspi_vector(vx, vy, vz), h;
    ndf_drawn d = ndf_draw(k, v, aspi_view(k, v), u1, u2);
    v = ndf_way_back(v, d.back, d.q, &out->cosine2);
    out->x = v.x;
    out->y = v.y;
    out->z = v.z;
    h = ndf_halfway(v, aspi_vector(wx, wy, wz), &out->between2);
    out->area = ndf_seen(k, v);
    out->D = ndf_along(k, h, out->between2);
}

/* Areas seen from v, D at the half vectors and the squared cosines there. */
ASP_FN void ndf_meet_at(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT vx, const asp_real *ASP_RESTRICT vy,
                        const asp_real *ASP_RESTRICT vz, const asp_real *ASP_RESTRICT wx,
                        const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz, asp_real *ASP_RESTRICT area,
                        asp_real *ASP_RESTRICT D, asp_real *ASP_RESTRICT between2)
{
    size_t i;
#if defined(ASP_OWN_SIGMA_N) && !defined(ASP_NDF_UP)
    ndf_sigma_n(k, n, R(1.0), vx, vy, vz, area);
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        area[i] = aspi_max(area[i], vz[i]);
#else
    for (i = 0; i < n; i++)
        area[i] = ndf_seen(k, aspi_at(vx, vy, vz, i));
#endif
#ifdef ASP_OWN_DENSITY_N
    {
        asp_real x[ASP_BLOCK], y[ASP_BLOCK], z[ASP_BLOCK];
        for (i = 0; i < n; i++) {
            asp_v3 h = ndf_halfway(aspi_at(vx, vy, vz, i), aspi_at(wx, wy, wz, i), &between2[i]);
            x[i] = h.x;
            y[i] = h.y;
            z[i] = h.z;
        }
        ndf_density_n(k, n, x, y, z, D);
        ASP_IN_PLACE
        for (i = 0; i < n; i++)
            D[i] = ndf_unit_density(D[i], between2[i]);
    }
#else
    for (i = 0; i < n; i++) {
        asp_v3 h = ndf_halfway(aspi_at(vx, vy, vz, i), aspi_at(wx, wy, wz, i), &between2[i]);
        D[i] = ndf_along(k, h, between2[i]);
    }
#endif
}

ASP_CLONES static void ndf_meet_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT vx,
                                  const asp_real *ASP_RESTRICT vy, const asp_real *ASP_RESTRICT vz,
                                  const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                  const asp_real *ASP_RESTRICT wz, const asp_mets *out)
{
    if (n == 0)
        return;
    ndf_meet_at(k, n, vx, vy, vz, wx, wy, wz, out->area, out->D, out->between2);
    ndf_sigma_n(k, n, R(-1.0), wx, wy, wz, out->area_out);
}

ASP_CLONES static void ndf_turn_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT vx,
                                  const asp_real *ASP_RESTRICT vy, const asp_real *ASP_RESTRICT vz,
                                  const asp_real *ASP_RESTRICT u1, const asp_real *ASP_RESTRICT u2,
                                  const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                  const asp_real *ASP_RESTRICT wz, const asp_mets *out)
{
    asp_real *ASP_RESTRICT x = out->x, *ASP_RESTRICT y = out->y, *ASP_RESTRICT z = out->z;
    asp_real *ASP_RESTRICT c2 = out->cosine2;
    asp_real bx[ASP_BLOCK], by[ASP_BLOCK], bz[ASP_BLOCK];
    size_t i;
    if (n == 0)
        return;
#ifdef ASP_OWN_VISIBLE_N
    ndf_visible_n(k, n, vx, vy, vz, u1, u2, bx, by, bz);
#define NDF_Q(i) R(1.0)
#else
    asp_real q[ASP_BLOCK];
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(vx, vy, vz, i);
        ndf_drawn d = ndf_draw(k, v, aspi_view(k, v), u1[i], u2[i]);
        bx[i] = d.back.x;
        by[i] = d.back.y;
        bz[i] = d.back.z;
        q[i] = d.q;
    }
#define NDF_Q(i) q[i]
#endif
    for (i = 0; i < n; i++) {
        asp_v3 v = ndf_way_back(aspi_at(vx, vy, vz, i), aspi_at(bx, by, bz, i), NDF_Q(i), &c2[i]);
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
#undef NDF_Q
    ndf_meet_at(k, n, x, y, z, wx, wy, wz, out->area, out->D, out->between2);
}
