/* test_data_merl.c - MERL tables: layout, parametrisation, interpolation, missing bins, round trips,
 * damaged files */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

#define PI 3.14159265358979323846
enum { NH = 90, ND = 90, NP = 180, BINS = NH * ND * NP };

static const double scale[3] = { 1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0 };

/* A file as the database has it, made byte by byte. */
static unsigned char *make_file(const double *values, size_t *size)
{
    *size = 12 + 24 * (size_t)BINS;
    unsigned char *file = calloc(*size, 1);
    file[0] = NH;
    file[4] = ND;
    file[8] = NP;
    memcpy(file + 12, values, 24 * (size_t)BINS);          /* little-endian machines only */
    return file;
}

static size_t bin(int h, int d, int p) { return ((size_t)h * ND + (size_t)d) * NP + (size_t)p; }

/* Directions from angles by rotating vectors step by step, apart from the library's way. */
static void from_half(double th, double td, double pd, double turn, asp_vec3 *wi, asp_vec3 *wo)
{
    asp_vec3 d = direction_of(td, pd), v;
    v = (asp_vec3){ cos(th) * d.x + sin(th) * d.z, d.y, -sin(th) * d.x + cos(th) * d.z };
    *wi = (asp_vec3){ cos(turn) * v.x - sin(turn) * v.y, sin(turn) * v.x + cos(turn) * v.y, v.z };
    asp_vec3 h = direction_of(th, turn);
    double c = wi->x * h.x + wi->y * h.y + wi->z * h.z;
    *wo = (asp_vec3){ 2 * c * h.x - wi->x, 2 * c * h.y - wi->y, 2 * c * h.z - wi->z };
}

static double centre_h(int i) { return (i + 0.5) / 90 * ((i + 0.5) / 90) * PI / 2; }
static double centre(double j) { return (j + 0.5) * PI / 180; }

static void check_lookup(void)
{
    double *values = malloc(3 * sizeof(double) * BINS);
    for (size_t i = 0; i < 3 * (size_t)BINS; i++)
        values[i] = (double)(1 + i % 99991);
    size_t size;
    unsigned char *file = make_file(values, &size);
    asp_error err;
    asp_measured *m = asp_measured_read_memory(file, size, "lookup.binary", &err);
    CHECK(m != NULL, "a whole table is read");
    asp_measured_info info = asp_measured_get_info(m);
    CHECK(!strcmp(info.format, "merl") && info.isotropic && !info.scattered && info.channels == 3
          && info.samples == 3 * (size_t)BINS, "what the table says of itself");
    size_t count = 1;
    CHECK(!asp_measured_geometries(m, &count) && count == 0, "a table has no list");

    double worst = 0;
    int compared = 0;
    for (int i = 0; i < 4000; i++) {
        int h = (int)(NH * random_number()), d = (int)(ND * random_number());
        int p = (int)(NP * random_number());
        asp_vec3 wi, wo;
        from_half(centre_h(h), centre(d), centre(p), 6.28 * random_number(), &wi, &wo);
        if (wi.z <= 1e-3 || wo.z <= 1e-3)
            continue;
        asp_rgb f = asp_measured_eval(m, wi, wo), back = asp_measured_eval(m, wo, wi);
        const double got[3] = { f.r, f.g, f.b }, swapped[3] = { back.r, back.g, back.b };
        for (int c = 0; c < 3; c++) {
            double want = values[(size_t)c * BINS + bin(h, d, p)] * scale[c];
            worst = fmax(worst, fabs(got[c] / want - 1));
            worst = fmax(worst, fabs(swapped[c] / want - 1));
            compared++;
        }
    }
    /* the values jump from bin to bin, so 1e-13 in position is 1e-8 in value */
    printf("bin centres: %d values, largest relative deviation %.2g\n", compared, worst);
    CHECK(compared > 5000 && worst < 1e-7, "bin centres give the bin's value (%g)", worst);
    asp_rgb below = asp_measured_eval(m, direction_of(0.3, 0), direction_of(2, 0));
    CHECK(below.r == 0 && below.g == 0 && below.b == 0, "0 below the horizon");
    asp_rgb nan = asp_measured_eval(m, (asp_vec3){ NAN, 0, 1 }, direction_of(0.1, 0));
    CHECK(isnan(nan.r), "NaN in, NaN out");
    for (int i = 0; i < 2000; i++) {             /* anywhere: finite */
        asp_rgb f = asp_measured_eval(m, random_direction(), random_direction());
        if (!(f.r >= 0 && f.r < 1e3 && f.g >= 0 && f.b >= 0 && isfinite(f.g + f.b)))
            CHECK(0, "eval is finite everywhere");
    }
    asp_vec3 up = { 0, 0, 1 };
    CHECK(fabs(asp_measured_eval(m, up, up).r / (values[0] * scale[0]) - 1) < 200,
          "the normal itself is in the first bins");
    asp_measured_free(m);
    free(file);
    free(values);
}

static void check_interpolation(void)
{
    /* linear in the three coordinates counted in bins: reproduced exactly away from the ends */
    double *values = malloc(3 * sizeof(double) * BINS);
    for (int h = 0; h < NH; h++)
        for (int d = 0; d < ND; d++)
            for (int p = 0; p < NP; p++)
                for (int c = 0; c < 3; c++)
                    values[(size_t)c * BINS + bin(h, d, p)] = 0.01 * (1 + h + 0.5 * d + 0.25 * p);
    asp_error err;
    asp_measured *m = asp_measured_from_merl_table(values, "linear", &err);
    CHECK(m && !strcmp(asp_measured_get_info(m).description, "linear"), "from_merl_table");
    double worst = 0;
    for (int i = 0; i < 3000; i++) {
        double h = 1 + 60 * random_number(), d = 1 + 40 * random_number();
        double p = 1 + 177 * random_number();
        asp_vec3 wi, wo;
        from_half((h / 90) * (h / 90) * PI / 2, d * PI / 180, p * PI / 180, 2, &wi, &wo);
        if (wi.z <= 1e-3 || wo.z <= 1e-3)
            continue;
        double want = 0.01 * (1 + (h - 0.5) + 0.5 * (d - 0.5) + 0.25 * (p - 0.5));
        asp_rgb f = asp_measured_eval(m, wi, wo);
        worst = fmax(worst, fmax(fabs(f.r / want - 1), fabs(f.b / want - 1)));
    }
    printf("between centres: largest relative deviation %.2g\n", worst);
    CHECK(worst < 1e-11, "linear between centres (%g)", worst);

    /* phi_d is periodic: half way between the last bin and the first */
    asp_vec3 wi, wo;
    from_half(centre_h(30), centre(20), PI - 1e-9, 0, &wi, &wo);
    double want = 0.01 * (1 + 30 + 10 + 0.25 * 179 / 2);
    double got = asp_measured_eval(m, wi, wo).g;
    CHECK(fabs(got / want - 1) < 1e-6, "phi_d wraps: %g, not %g", got, want);

    /* a bin without a value lends its weight to its neighbours */
    asp_measured_free(m);
    values[bin(30, 20, 90)] = -1;
    m = asp_measured_from_merl_table(values, NULL, &err);
    from_half(centre_h(30), centre(20), centre(90.25), 0, &wi, &wo);
    want = 0.01 * (1 + 30 + 10 + 0.25 * 91);
    CHECK(fabs(asp_measured_eval(m, wi, wo).r / want - 1) < 1e-9, "a missing bin has no weight");
    CHECK(fabs(asp_measured_eval(m, wi, wo).g / (want - 0.0025 * 0.75) - 1) < 1e-9,
          "channels are missing one by one");
    asp_measured_free(m);
    for (size_t i = 0; i < 3 * (size_t)BINS; i++)
        values[i] = -2;
    m = asp_measured_from_merl_table(values, NULL, &err);
    CHECK(asp_measured_eval(m, wi, wo).r == 0, "nothing known: 0");
    asp_measured_free(m);
    values[5] = NAN;
    CHECK(!asp_measured_from_merl_table(values, NULL, &err) && err.status == ASP_EINVAL
          && strstr(err.reason, "element 5"), "a table with a NaN is refused");
    free(values);
}

/* Smooth, different in every channel, depends on all of the geometry; anisotropic if asked. */
static asp_rgb smooth(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    double c = wi.x * wo.x + wi.y * wo.y + wi.z * wo.z;
    double s = wi.z + wo.z + (context ? 0.1 * (wi.x + wo.x) : 0);
    return (asp_rgb){ 0.3 + 0.1 * c, 0.2 * s, 0.05 + 0.02 * c * s };
}

static asp_rgb broken(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    (void)context;
    return (asp_rgb){ wi.z / 0.0 - wo.z / 0.0, 0, 0 };
}

static void check_function(void)
{
    asp_error err;
    asp_measured *m = asp_measured_from_function(smooth, NULL, "smooth", &err);
    CHECK(m != NULL, "from_function");
    double worst = 0;
    for (int i = 0; i < 5000; i++) {
        asp_vec3 wi = random_direction(), wo = random_direction();
        if (wi.z < 0.1 || wo.z < 0.1)
            continue;
        asp_rgb f = asp_measured_eval(m, wi, wo), want = smooth(NULL, wi, wo);
        worst = fmax(worst, fabs(f.r / want.r - 1) + fabs(f.g / want.g - 1)
                            + fabs(f.b / want.b - 1));
    }
    printf("function of cosines through the table: largest relative deviation %.2g\n", worst);
    CHECK(worst < 0.01, "a smooth function survives the table (%g)", worst);
    CHECK(!asp_measured_from_function(broken, NULL, NULL, &err) && err.status == ASP_EINVAL,
          "a function that gives NaN is refused");
    CHECK(!asp_measured_from_function(NULL, NULL, NULL, &err), "no function is refused");

    /* any kind of measurement writes as a table: here a list of two geometries */
    static const char text[] = "theta_i_deg,theta_o_deg,phi_o_deg,f\n10,10,180,0.5\n40,40,180,2\n";
    asp_measured *list = asp_measured_read_memory(text, sizeof text - 1, "two.csv", &err);
    const char *path = temporary_path("list.binary");
    CHECK(list && asp_measured_write_merl(list, path, &err) == ASP_OK, "a list writes as a table");
    asp_measured *table = asp_measured_read(path, &err);
    asp_rgb f = asp_measured_eval(table, direction_of(0.7, 0), direction_of(0.7, PI));
    CHECK(table && fabs(f.g - 2) < 1e-12, "and the table holds the nearest geometry (%g)", f.g);
    asp_measured_free(table);
    asp_measured_free(list);
    asp_measured_free(m);
    remove(path);
}

/* Every bit of a table through MERL and CSV and back. */
static void check_round_trip(void)
{
    double *values = malloc(3 * sizeof(double) * BINS);
    for (size_t i = 0; i < 3 * (size_t)BINS; i++)          /* full mantissas, ten decades */
        values[i] = i % 7 == 3 ? -1 : (random_number() + 0x1p-40) * pow(10, (double)(i % 10) - 4);
    for (int i = 0; i < 500; i++)                          /* bins no row is written for */
        for (int c = 0; c < 3; c++)
            values[(size_t)c * BINS + 1000 + (size_t)i] = -1;
    values[0] = -0.25;
    size_t size, again_size, csv_size;
    unsigned char *file = make_file(values, &size);
    asp_error err;
    asp_measured *m = asp_measured_read_memory(file, size, "random.binary", &err);
    const char *csv = temporary_path("table.csv"), *copy = temporary_path("copy.binary");
    CHECK(m && asp_measured_write_merl(m, copy, &err) == ASP_OK, "MERL is written");
    unsigned char *again = read_bytes(copy, &again_size);
    CHECK(again_size == size && !memcmp(again, file, size), "MERL -> MERL gives the same bytes");
    free(again);

    CHECK(asp_measured_write_csv(m, csv, &err) == ASP_OK, "CSV is written");
    asp_measured_free(m);
    m = asp_measured_read(csv, &err);
    char text[600];
    CHECK(m != NULL, "CSV is read: %s", m ? "" : asp_error_text(&err, text, sizeof text));
    CHECK(m && !asp_measured_get_info(m).scattered, "as a table");
    CHECK(m && asp_measured_write_merl(m, copy, &err) == ASP_OK, "MERL is written again");
    again = read_bytes(copy, &again_size);
    size_t different = 0;
    for (size_t i = 0; again_size == size && i < size; i++)
        different += again[i] != file[i];
    printf("MERL -> CSV -> MERL: %zu bytes, %zu differ\n", again_size, different);
    CHECK(again_size == size && different == 0, "MERL -> CSV -> MERL gives the same bytes");
    free(read_bytes(csv, &csv_size));
    printf("as CSV: %.0f MB\n", (double)csv_size / 1e6);
    free(again);
    asp_measured_free(m);

    /* a table with hardly any values comes back as a table too */
    for (size_t i = 0; i < 3 * (size_t)BINS; i++)
        values[i] = i % BINS < 1000 ? 1 + (double)i : -1;
    m = asp_measured_from_merl_table(values, "sparse", &err);
    CHECK(m && asp_measured_write_merl(m, copy, &err) == ASP_OK
          && asp_measured_write_csv(m, csv, &err) == ASP_OK, "a sparse table is written");
    asp_measured_free(m);
    unsigned char *first = read_bytes(copy, &size);
    m = asp_measured_read(csv, &err);
    CHECK(m && !strcmp(asp_measured_get_info(m).description, "sparse")
          && asp_measured_write_merl(m, copy, &err) == ASP_OK, "and read");
    again = read_bytes(copy, &again_size);
    CHECK(again_size == size && !memcmp(again, first, size), "sparse MERL -> CSV -> MERL");
    free(again);
    free(first);
    asp_measured_free(m);
    remove(csv);
    remove(copy);

    /* damaged copies of the file */
    expect_refusal(file, 11, "tiny.binary", 0);
    expect_refusal(file, 12, "header.binary", 2, "byte 12", "34992012");
    expect_refusal(file, 4000000, "half.binary", 2, "byte 4000000", "34992012");
    file[8] = 181;
    expect_refusal(file, size, "dims.binary", 2, "byte 0", "90 x 90 x 180");
    file[8] = 180;
    double nan = NAN, huge = 1e300;
    memcpy(file + 12 + 8 * ((size_t)BINS + 77), &nan, 8);
    expect_refusal(file, size, "nan.binary", 3, "green", "bin 77", "byte 11664628");
    memcpy(file + 12 + 8 * ((size_t)BINS + 77), &huge, 8);
    expect_refusal(file, size, "huge.binary", 1, "green");
    free(file);
    free(values);
}

int main(void)
{
    check_lookup();
    check_interpolation();
    check_function();
    check_round_trip();
    if (folder_[0])
        rmdir(folder_);
    return finish();
}
