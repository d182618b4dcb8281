/* test_surface_files.c - the six measured height fields against the slopes their descriptions give */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

static double described(const char *path, const char *key)
{
    size_t size;
    char *text = (char *)read_bytes(path, &size), *at = strstr(text, key);
    double value = at ? atof(at + strlen(key)) : (double)NAN;
    free(text);
    return value;
}

static void test_field(const char *folder, const char *name)
{
    char path[1000], meta[1000];
    asp_height_field f = { 0 };
    asp_slope_statistics s = { 0 };
    asp_error err;
    snprintf(path, sizeof path, "%s/%s.f32", folder, name);
    snprintf(meta, sizeof meta, "%s/%s.meta.txt", folder, name);
    if (!CHECK(asp_height_field_read(path, &f, &err) == ASP_OK, "%s: %s %s", name, err.name,
               err.reason))
        return;
    CHECK(asp_height_field_slopes(&f, &s, &err) == ASP_OK, "%s: %s", name, err.reason);
    double x = described(meta, "rms_slope_x="), y = described(meta, "rms_slope_y=");
    printf("%s: %d x %d, rms slopes %.5g %.5g (described %.5g %.5g), mean %.3g %.3g, student alpha "
           "%.4g gamma %.3g, log-likelihood %.4g (ggx %.4g, beckmann %.4g)\n",
           name, f.nx, f.ny, s.rms_x, s.rms_y, x, y, s.mean_x, s.mean_y, s.alpha, s.gamma,
           s.log_student, s.log_ggx, s.log_beckmann);
    CHECK(fabs(s.rms_x / x - 1) < 0.02, "%s: rms_x %g, described %g", name, s.rms_x, x);
    CHECK(fabs(s.rms_y / y - 1) < 0.02, "%s: rms_y %g, described %g", name, s.rms_y, y);
    asp_height_field_free(&f);
}

int main(void)
{
    static const char *const names[] = { "st_al3d1_alicona", "st_di6_afm", "st_matrix3_afm",
                                         "st_nms1_nanofocus", "st_opd1_wyko", "st_plu1_sensofar" };
    const char *shared = getenv("ASPERITY_SHARED");
    char folder[800], probe[1000];
    snprintf(folder, sizeof folder, "%s/data/surfaces", shared && shared[0] ? shared : "../shared");
    snprintf(probe, sizeof probe, "%s/%s.f32", folder, names[0]);
    if (access(probe, R_OK) != 0) {
        printf("skipped: no height fields (ASPERITY_SHARED)\n");
        return 77;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        test_field(folder, names[i]);
    return finish();
}
