/* csv_write.c - rows of text */
#include "measured.h"

#include <string.h>

void aspi_csv_comment(const asp_measured *measured, aspi_out *out)
{
    if (measured->info.description[0]) {
        aspi_out_text(out, "# ");
        aspi_out_text(out, measured->info.description);
        aspi_out_text(out, "\n");
    }
    aspi_out_text(out, measured->info.isotropic ? "# isotropic = 1\n" : "# isotropic = 0\n");
    aspi_out_text(out, "# unit = 1/sr, without the cosine\n");
}

void aspi_csv_row(aspi_out *out, const double *number, int count)
{
    char row[16 * ASPI_NUMBER_TEXT];
    size_t used = 0;
    for (int i = 0; i < count && i < 15; i++) {
        used += aspi_format_number(number[i], 17, row + used);
        row[used++] = i + 1 < count ? ',' : '\n';
    }
    aspi_out_write(out, row, used);
}

static double zenith(asp_vec3 w) { return atan2(sqrt(w.x * w.x + w.y * w.y), w.z); }

/* The grid lies in half and difference angles, where highlights are narrow in one angle only:
 * theta_h at ((i+1/2)/45)^2 of a right angle for i = 0..44, theta_d = 2.5, 7.5 .. 87.5 deg,
 * phi_d = 7.5, 22.5 .. 352.5 deg, and phi_h = 0 (isotropic) or 0, 30 .. 330 deg. Only geometries
 * above the horizon are written. */
asp_status aspi_csv_sampled(const asp_measured *measured, aspi_out *out, asp_error *err)
{
    int azimuths = measured->info.isotropic ? 1 : 12;
    double degree = ASPI_PI / 180;
    (void)err;
    aspi_csv_comment(measured, out);
    aspi_out_text(out, "# grid = half and difference angles: theta_h at 90 ((i + 0.5)/45)^2 deg, "
                       "theta_d at 2.5 + 5 j deg, phi_d at 7.5 + 15 k deg\n"
                       "theta_i,phi_i,theta_o,phi_o,r,g,b\n");
    for (int l = 0; l < azimuths; l++)
        for (int i = 0; i < 45; i++)
            for (int j = 0; j < 18; j++)
                for (int k = 0; k < 24 && !out->failed; k++) {
                    double u = (i + 0.5) / 45;
                    aspi_half a = { u * u * (ASPI_PI / 2), 30 * l * degree,
                                    (2.5 + 5 * j) * degree, (7.5 + 15 * k) * degree };
                    asp_vec3 wi, wo;
                    aspi_half_to(a, &wi, &wo);
                    if (wi.z <= 0 || wo.z <= 0)
                        continue;
                    asp_rgb f = asp_measured_eval(measured, wi, wo);
                    const double row[7] = { zenith(wi), atan2(wi.y, wi.x), zenith(wo),
                                            atan2(wo.y, wo.x), f.r, f.g, f.b };
                    aspi_csv_row(out, row, 7);
                }
    return ASP_OK;
}
