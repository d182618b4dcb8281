/* test_data_csv.c - tables of text: every way of naming columns, what is refused and how it is said,
 * the nearest geometry, round trips */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

#define PI 3.14159265358979323846

static asp_measured *read_text(const char *text)
{
    asp_error err;
    char line[600];
    asp_measured *m = asp_measured_read_memory(text, strlen(text), "test.csv", &err);
    if (!m)
        CHECK(0, "%s\n%s", text, asp_error_text(&err, line, sizeof line));
    return m;
}

static int close_to(asp_vec3 a, asp_vec3 b)
{
    return fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z) < 1e-12;
}

/* The first row of a table is this geometry and value. */
static void expect_row(const char *text, asp_vec3 wi, asp_vec3 wo, asp_rgb f, size_t rows,
                       int isotropic)
{
    asp_measured *m = read_text(text);
    size_t count = 0;
    const asp_measurement *g = asp_measured_geometries(m, &count);
    asp_measured_info info = asp_measured_get_info(m);
    if (CHECK(count == rows, "%zu rows, not %zu: %s", count, rows, text)) {
        CHECK(close_to(g->wi, wi) && close_to(g->wo, wo), "directions: %s", text);
        CHECK(g->f.r == f.r && g->f.g == f.g && g->f.b == f.b, "values: %s", text);
        CHECK(info.scattered && info.isotropic == isotropic, "isotropic %d: %s", info.isotropic, text);
        asp_rgb nearest = asp_measured_eval(m, g->wi, g->wo);
        CHECK(nearest.r == f.r, "eval gives the row: %s", text);
    }
    asp_measured_free(m);
}

static void check_columns(void)
{
    const double d = PI / 180;
    asp_vec3 wi = direction_of(30 * d, 0), wo = direction_of(40 * d, 150 * d);
    asp_rgb grey = { 2.5, 2.5, 2.5 }, colour = { 1, 0.5, 0.25 };
    expect_row("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n30,0,40,150,2.5\n", wi, wo, grey, 1, 1);
    expect_row("theta_i_deg theta_o_deg\tphi_o_deg f\n30 40 \t 150   2.5", wi, wo, grey, 1, 1);
    expect_row("f; phi_o_deg; theta_o_deg; theta_i_deg\r\n2.5; 150; 40; 30\r\n", wi, wo, grey, 1, 1);
    expect_row("theta_i,phi_i,theta_o,phi_o,r,g,b\n"
               "0.52359877559829887,0,0.69813170079773184,2.6179938779914944,1,.5,25e-2\n",
               wi, wo, colour, 1, 1);
    expect_row("\xef\xbb\xbf# a scan\n\n\"Theta_I_deg\",\"theta_o_deg\",\"phi_o_deg\",\"BRDF\"\n"
               "# in between\n\n30,40,150,2.5\n  \n31,40,150,-1\n30,90,150,7\n32,40,150,3",
               wi, wo, grey, 2, 1);
    expect_row("# phi_o = 150 deg, all rows\ntheta_i_deg,theta_o_deg,fr\n30,40,2.5\n", wi, wo, grey, 1,
               1);
    expect_row("# phi_o_deg = 150\n# theta_i_deg theta_o_deg f\n30 40 2.5\n", wi, wo, grey, 1, 1);
    expect_row("theta_i_deg,theta_o_deg,phi_o_deg,f\n-30,-40,-30,2.5\n", direction_of(30 * d, PI), wo,
               grey, 1, 1);
    expect_row("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n30,0,40,150,2.5\n30,10,40,150,1\n",
               wi, wo, grey, 2, 0);
    expect_row("# isotropic = 1\ntheta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n"
               "30,0,40,150,2.5\n30,10,40,150,1\n", wi, wo, grey, 2, 1);
    expect_row("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n0.6,0,0.8,-0.6,0,0.8,1,0.5,0.25\n",
               (asp_vec3){ 0.6, 0, 0.8 }, (asp_vec3){ -0.6, 0, 0.8 }, colour, 1, 1);
    /* half vector 20 deg from the normal, both directions 15 deg from it in its plane */
    expect_row("theta_h_deg,theta_d_deg,phi_d_deg,f\n20,15,0,2.5\n", direction_of(35 * d, 0),
               direction_of(5 * d, 0), grey, 1, 1);
    expect_row("theta_h_deg,phi_h_deg,theta_d_deg,phi_d_deg,f\n20,90,15,180,2.5\n",
               direction_of(5 * d, 90 * d), direction_of(35 * d, 90 * d), grey, 1, 1);
    /* bin 29 of theta_h: (29.5/90)^2 of 90 deg */
    double t = 29.5 / 90 * 29.5 / 90 * 90;
    expect_row("theta_h_index,theta_d_index,phi_d_index,f\n29,14,0,2.5\n# phi_d 0.5 deg\n80,80,0,1\n",
               (asp_vec3){ cos(t * d) * sin(14.5 * d) * cos(0.5 * d) + sin(t * d) * cos(14.5 * d),
                           sin(14.5 * d) * sin(0.5 * d),
                           cos(t * d) * cos(14.5 * d) - sin(t * d) * sin(14.5 * d) * cos(0.5 * d) },
               (asp_vec3){ -cos(t * d) * sin(14.5 * d) * cos(0.5 * d) + sin(t * d) * cos(14.5 * d),
                           -sin(14.5 * d) * sin(0.5 * d),
                           cos(t * d) * cos(14.5 * d) + sin(t * d) * sin(14.5 * d) * cos(0.5 * d) },
               grey, 1, 1);
    /* the same names in the lumos order, in a comment: phi is the zenith, in degrees */
    expect_row("# phi_i theta_i phi_o theta_o brdf\n30 0 -40 -30 2.5\n", wi, wo, grey, 1, 1);
}

/* Rows that are left out are counted in the description. */
static void check_left_out(void)
{
    const struct { const char *rows, *says; } table[] = {
        { "1,1,0,1,1,1\n", "scan" },
        { "1,1,0,1,1,1\n1,1,1,1,1,-1\n", "scan; 1 row left out: a negative value" },
        { "1,1,0,1,1,1\n1,1.570796,1,1,1,1\n1.570796,1,1,1,1,1\n",
          "scan; 2 rows left out: a direction at the horizon" },
        { "1,1,0,1,1,1\n1,1,1,-1,-1,-1\n1,1.570796,1,1,1,1\n1,1.570796,1,-1,1,1\n",
          "scan; 3 rows left out: a negative value or a direction at the horizon" },
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        char text[400];
        snprintf(text, sizeof text, "# scan\ntheta_i,theta_o,phi_o,r,g,b\n%s", table[i].rows);
        asp_measured *m = read_text(text);
        asp_measured_info info = asp_measured_get_info(m);
        CHECK(info.samples == 1 && !strcmp(info.description, table[i].says), "'%s', not '%s'",
              info.description, table[i].says);
        asp_measured_free(m);
    }
    asp_measured *m = read_text("theta_i,theta_o,phi_o,f\n1,1,0,1\n1,1,1,-1\n");
    CHECK(!strcmp(asp_measured_get_info(m).description, "1 row left out: a negative value"),
          "a remark without a description");
    asp_measured_free(m);
}

static void refuse(const char *text, const char *first, const char *second)
{
    expect_refusal(text, strlen(text), "bad.csv", 2, first, second);
}

static void check_refusals(void)
{
    refuse("", "empty", "");
    refuse("# only a comment\n", "line 1", "no rows");
    refuse("theta_i,theta_o,phi_o,f\n", "no row", "");
    refuse("theta_i,theta_o,phi_o,f\n1.570796,1,0,1\n", "no row", "above the horizon");
    refuse("# c\ntheta_i,theta_o,phi_o,f\n1,1,0,-1\n1,1,1,-2\n1,1,2,-2\n", "line 3: no row",
           "negative ones mark missing values, here and in 2 more");
    refuse("theta_i,theta_o,phi_o,r,g,b\n1,1,0,1,1,-1\n", "line 2: no row", "values, here");
    refuse("1 2 3 4\n5 6 7 8\n", "line 1", "theta_i");
    refuse("0.1,0.2\n", "line 1", "columns have no names");
    refuse("angle,theta_o,phi_o,f\n1,1,1,1\n", "line 1: column 'angle'", "accepted: theta_i");
    refuse("# c\ntheta_i,theta_i_deg,theta_o,phi_o,f\n", "line 2: column 'theta_i_deg'", "already");
    refuse("theta_i,theta_o,phi_o,wi_x,f\n1,1,1,1,1\n", "line 1", "two ways");
    refuse("theta_i,theta_o,phi_o,f,r,g,b\n1,1,1,1,1,1,1\n", "line 1: column 'f'", "two ways");
    refuse("theta_i,theta_o,phi_o\n1,1,1\n", "line 1", "f or r, g, b");
    refuse("theta_i,theta_o,f\n1,1,1\n", "line 1: column 'phi_o'", "missing");
    refuse("theta_i,theta_o,phi_o,r,g\n1,1,1,1,1\n", "line 1: column 'b'", "missing");
    refuse("theta_h,theta_d,f\n1,1,1\n", "line 1: column 'phi_d'", "'# phi_d = 90 deg'");
    refuse("f,r\n1,1\n", "line 1", "directions");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,1\n1,1,0\n", "line 3", "3 columns here, 4 in the header");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,1,\n", "line 2", "5 columns here");
    refuse("theta_i,theta_o,phi_o,f\n1,x,0,1\n", "line 2: column 'theta_o'", "'x'");
    refuse("theta_i,theta_o,phi_o,f\n1,,0,1\n", "line 2: column 'theta_o'", "not a finite");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,nan\n", "line 2: column 'f'", "'nan'");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,inf\n", "line 2: column 'f'", "'inf'");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,1e999\n", "line 2: column 'f'", "not a finite");
    refuse("theta_i,theta_o,phi_o,f\n1,1,0,0x10\n", "line 2: column 'f'", "'0x10'");
    refuse("theta_i;theta_o;phi_o;f\n1;1;0;0,5\n", "line 2: column 'f'", "'0,5'");
    refuse("theta_i,theta_o,phi_o,f\n30,1,0,1\n", "line 2: column 'theta_i' = 30 is outside",
           "theta_i_deg");
    refuse("theta_i_deg,theta_o_deg,phi_o_deg,f\n30,91,0,1\n", "line 2: column 'theta_o_deg' = 91",
           "[-90, 90]");
    refuse("theta_h,theta_d,phi_d,f\n-0.1,1,0,1\n", "line 2: column 'theta_h'", "outside [0");
    refuse("theta_h_index,theta_d_index,phi_d_index,f\n90,1,0,1\n", "line 2: column 'theta_h_index'",
           "[0, 89]");
    refuse("theta_h_index,theta_d_index,phi_d_index,f\n9.5,1,0,1\n", "line 2", "whole");
    refuse("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n0,0,1,0,0.5,0.5,1\n", "line 2: column 'wo_x'", "length");
    refuse("theta_i_deg,theta_o_deg,phi_o_deg,f\n30,90,0,1\n20,20,0,-1\n", "no row", "horizon");
    refuse("# phi_in theta_in phi_out theta_out brdf\n10 0 95 0 1\n", "line 2: column 'phi_out' = 95",
           "[-90, 90]");
    refuse("31\n400 410 420\n", "column 'wavelength'", "ends inside");
    refuse("30\n400 410 420\n", "column 'number of wavelengths' = 30", "[31, 31]");
    refuse("\x01\x02\x03", "not recognised", "merl, rgl, cornell, lumos, csv");
}

/* The nearest geometry against a search of them all, in the documented distance. */
static void flat(asp_vec3 wi, asp_vec3 wo, int isotropic, double key[4])
{
    asp_vec3 h = { wi.x + wo.x, wi.y + wo.y, wi.z + wo.z };
    double length = sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
    double th = acos(fmin(1, h.z / length)), ph = atan2(h.y, h.x);
    double c = (wi.x * h.x + wi.y * h.y + wi.z * h.z) / length, td = acos(fmin(1, c));
    /* axes across the half vector: one in its meridian, one along its parallel */
    asp_vec3 e1 = { cos(th) * cos(ph), cos(th) * sin(ph), -sin(th) }, e2 = { -sin(ph), cos(ph), 0 };
    double pd = atan2(wi.x * e2.x + wi.y * e2.y, wi.x * e1.x + wi.y * e1.y + wi.z * e1.z);
    key[0] = isotropic ? th : th * cos(ph);
    key[1] = isotropic ? 0 : th * sin(ph);
    key[2] = td * cos(2 * pd);
    key[3] = td * sin(2 * pd);
}

static void check_nearest(int isotropic)
{
    enum { ROWS = 3000, PLANE = 1500 };
    static double key[ROWS][4];
    char *text = malloc(ROWS * 200);
    size_t used = (size_t)sprintf(text, "# isotropic = %d\nwi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n",
                                  isotropic);
    for (int i = 0; i < ROWS; i++) {
        asp_vec3 wi = random_direction(), wo = random_direction();
        if (i < PLANE) {                                   /* many in one plane, some twice */
            wi = direction_of(0.2 * (i % 7), 0);
            wo = direction_of(1.5 * ((i / 7) % 200 - 100) / 100.0, 0);
        }
        used += (size_t)sprintf(text + used, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d\n", wi.x, wi.y,
                                wi.z, wo.x, wo.y, wo.z, i);
        flat(wi, wo, isotropic, key[i]);
    }
    asp_error err;
    asp_measured *m = asp_measured_read_memory(text, used, "rows.csv", &err);
    CHECK(m != NULL, "%d rows are read", ROWS);
    int wrong = 0;
    for (int k = 0; m && k < 2000; k++) {
        asp_vec3 wi = random_direction(), wo = random_direction();
        double at[4], best = INFINITY, found = 0;
        if (k % 2)
            wi = direction_of(1.2 * random_number(), 0), wo = direction_of(1.3 * random_number(), PI);
        flat(wi, wo, isotropic, at);
        int answer = (int)asp_measured_eval(m, wi, wo).r;
        for (int i = 0; i < ROWS; i++) {
            double s = 0;
            for (int a = 0; a < 4; a++)
                s += (key[i][a] - at[a]) * (key[i][a] - at[a]);
            best = fmin(best, s);
            if (i == answer)
                found = s;
        }
        wrong += found > best + 1e-9;
    }
    printf("nearest of %d geometries, %s: %d wrong of 2000\n", ROWS,
           isotropic ? "isotropic" : "anisotropic", wrong);
    CHECK(wrong == 0, "the nearest geometry is found");
    asp_measured_free(m);
    free(text);
}

static void check_round_trip(void)
{
    char text[8000];
    size_t used = (size_t)sprintf(text, "# some scan\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n");
    for (int i = 0; i < 50; i++)
        used += (size_t)sprintf(text + used, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                                1.5 * random_number(), 6 * random_number(), 1.5 * random_number(),
                                6 * random_number(), random_number(), 1e5 * random_number(),
                                1e-9 * random_number());
    asp_error err;
    asp_measured *m = read_text(text);
    const char *path = temporary_path("list.csv");
    CHECK(m && asp_measured_write_csv(m, path, &err) == ASP_OK, "a list is written");
    asp_measured *back = asp_measured_read(path, &err);
    size_t n = 0, k = 1;
    const asp_measurement *a = asp_measured_geometries(m, &n), *b = asp_measured_geometries(back, &k);
    CHECK(n == 50 && k == n && !memcmp(a, b, n * sizeof *a), "and comes back bit for bit");
    CHECK(back && !strcmp(asp_measured_get_info(back).description, "some scan"), "with its description");
    CHECK(back && !asp_measured_get_info(back).isotropic, "and its symmetry");
    asp_measured_free(m);
    asp_measured_free(back);
    m = read_text("theta_i,theta_o,phi_o,f\n0.5,0.25,1,0.125\n");
    CHECK(asp_measured_write_csv(m, path, &err) == ASP_OK, "one channel is written");
    back = asp_measured_read(path, &err);
    CHECK(back && asp_measured_get_info(back).channels == 1
          && asp_measured_geometries(back, NULL)->f.b == 0.125
          && !asp_measured_get_info(back).description[0], "and comes back as one");
    asp_measured_free(m);
    asp_measured_free(back);
    remove(path);
}

/* Rows by bin: a quarter of the table makes a table, and a bin may stand once. */
static void check_bins(void)
{
    size_t rows = 400000, used;
    char *text = malloc(rows * 24 + 200);
    used = (size_t)sprintf(text, "theta_h_index,theta_d_index,phi_d_index,f\n");
    for (size_t i = 0; i < rows; i++)
        used += (size_t)sprintf(text + used, "%zu,%zu,%zu,%g\n", i / 16200, i / 180 % 90, i % 180,
                                0.5 + (double)(i % 4) / 8);
    asp_error err;
    asp_measured *m = asp_measured_read_memory(text, used, "bins.csv", &err);
    CHECK(m && !asp_measured_get_info(m).scattered && asp_measured_get_info(m).channels == 1,
          "many bins make a table");
    asp_rgb f = asp_measured_eval(m, direction_of(0.05, 0), direction_of(0.04, 2));
    CHECK(f.r > 0.4 && f.r < 1 && fabs(f.g - f.r) + fabs(f.b - f.r) < 1e-14, "of one channel in three");
    asp_measured_free(m);
    sprintf(text + used, "5,4,3,1\n");
    expect_refusal(text, strlen(text), "again.csv", 2, "line 400002", "has a row already");
    free(text);
}

int main(void)
{
    check_columns();
    check_left_out();
    check_refusals();
    check_nearest(1);
    check_nearest(0);
    check_round_trip();
    check_bins();
    if (folder_[0])
        rmdir(folder_);
    return finish();
}
