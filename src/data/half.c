/* half.c - half and difference angles
 * S. Rusinkiewicz, A New Change of Variables for Efficient BRDF Representation, EGWR 1998, sec. 3 */
#include "measured.h"

/* atan2 of lengths keeps small angles exact where acos of a cosine would lose half the digits */
static double polar(double x, double y, double z) { return atan2(sqrt(x * x + y * y), z); }

/* d = Ry(-theta_h) Rz(-phi_h) wi */
aspi_half aspi_half_of(asp_vec3 wi, asp_vec3 wo)
{
    aspi_half a;
    double hx = wi.x + wo.x, hy = wi.y + wo.y, hz = wi.z + wo.z;
    double across = sqrt(hx * hx + hy * hy), length = sqrt(across * across + hz * hz);
    double cos_phi = across > 0 ? hx / across : 1, sin_phi = across > 0 ? hy / across : 0;
    double cos_theta = length > 0 ? hz / length : 1, sin_theta = length > 0 ? across / length : 0;
    a.theta_h = atan2(across, hz);
    a.phi_h = atan2(sin_phi, cos_phi);
    double x = cos_phi * wi.x + sin_phi * wi.y;
    double y = cos_phi * wi.y - sin_phi * wi.x;
    double dx = cos_theta * x - sin_theta * wi.z;
    double dz = sin_theta * x + cos_theta * wi.z;
    a.theta_d = polar(dx, y, dz);
    a.phi_d = dx == 0 && y == 0 ? 0 : atan2(y, dx);
    return a;
}

/* wi = Rz(phi_h) Ry(theta_h) d; wo is wi mirrored at the half vector */
void aspi_half_to(aspi_half a, asp_vec3 *wi, asp_vec3 *wo)
{
    double ch = cos(a.theta_h), sh = sin(a.theta_h), cp = cos(a.phi_h), sp = sin(a.phi_h);
    double st = sin(a.theta_d), dz = cos(a.theta_d);
    double dx = st * cos(a.phi_d), dy = st * sin(a.phi_d);
    double xi = ch * dx + sh * dz, zi = ch * dz - sh * dx;
    double xo = sh * dz - ch * dx, zo = ch * dz + sh * dx;
    *wi = (asp_vec3){ cp * xi - sp * dy, sp * xi + cp * dy, zi };
    *wo = (asp_vec3){ cp * xo + sp * dy, sp * xo - cp * dy, zo };
}
