/* test_data_rgl.c - RGL tensor files: synthetic materials whose value is known in closed form,
 * isotropic and anisotropic with every symmetry, and damaged files of every kind */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

#define PI 3.14159265358979323846

/* ---- a tensor file under construction */

typedef struct build { unsigned char bytes[400000]; size_t used, fields, data; } build;

static void put(build *b, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        b->bytes[b->used++] = (unsigned char)(value >> 8 * i);
}

static void start(build *b)
{
    memset(b, 0, sizeof *b);
    memcpy(b->bytes, "tensor_file", 12);
    b->bytes[12] = 1;
    b->used = 18;
    b->data = 1024;
}

/* Adds a field of `count` elements and returns where its data go. */
static unsigned char *field(build *b, const char *name, int type, int rank, const int *size)
{
    size_t count = 1;
    put(b, strlen(name), 2);
    memcpy(b->bytes + b->used, name, strlen(name));
    b->used += strlen(name);
    put(b, (uint64_t)rank, 2);
    put(b, (uint64_t)type, 1);
    put(b, b->data, 8);
    for (int i = 0; i < rank; i++) {
        put(b, (uint64_t)size[i], 8);
        count *= (size_t)size[i];
    }
    unsigned char *at = b->bytes + b->data;
    b->data += count * (type == 10 ? 4 : 1);
    b->bytes[14] = (unsigned char)++b->fields;
    return at;
}

static void put_float(unsigned char *at, size_t i, double value)
{
    float f = (float)value;
    memcpy(at + 4 * i, &f, 4);
}

typedef struct material { int n_phi, n_theta, n, symmetry, jacobian; } material;

static double phi_at(const material *m, int i)
{
    return m->n_phi == 1 ? 0 : -PI + 2 * PI / m->symmetry * i / (m->n_phi - 1);
}

/* vndf = 1 + v (of the azimuth of m), ndf = 2 + v/2, sigma = 1 + u, and
 * rgb = (1 + c) (3 + phi_i/4 + theta_i/2 + u + v/2): all bilinear, so the tables hold them exactly. */
static void make_material(build *b, const material *m)
{
    int n = m->n, p = m->n_phi, t = m->n_theta, two = 2;
    start(b);
    unsigned char *text = field(b, "description", 1, 1, (int[]){ 11 });
    memcpy(text, "synthetic\n1", 11);
    unsigned char *phi = field(b, "phi_i", 10, 1, &p), *theta = field(b, "theta_i", 10, 1, &t);
    for (int i = 0; i < p; i++)
        put_float(phi, (size_t)i, phi_at(m, i));
    for (int i = 0; i < t; i++)
        put_float(theta, (size_t)i, PI / 2 * i / (t - 1));
    unsigned char *sigma = field(b, "sigma", 10, 2, (int[]){ 2, two });
    put_float(sigma, 0, 1), put_float(sigma, 1, 2), put_float(sigma, 2, 1), put_float(sigma, 3, 2);
    unsigned char *ndf = field(b, "ndf", 10, 2, (int[]){ 2, two });
    put_float(ndf, 0, 2), put_float(ndf, 1, 2), put_float(ndf, 2, 2.5), put_float(ndf, 3, 2.5);
    unsigned char *vndf = field(b, "vndf", 10, 4, (int[]){ p, t, n, n });
    unsigned char *rgb = field(b, "rgb", 10, 5, (int[]){ p, t, 3, n, n });
    for (int i = 0; i < p; i++)
        for (int j = 0; j < t; j++)
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++) {
                    size_t slice = (size_t)(i * t + j), at = (size_t)(y * n + x);
                    double v = (double)y / (n - 1), u = (double)x / (n - 1);
                    put_float(vndf, slice * (size_t)(n * n) + at, (1 + v) * (1 + (int)slice));
                    for (int c = 0; c < 3; c++)
                        put_float(rgb, (3 * slice + (size_t)c) * (size_t)(n * n) + at,
                                  (1 + c) * (3 + phi_at(m, i) / 4 + PI / 4 * j / (t - 1) + u + v / 2));
                }
    *field(b, "jacobian", 1, 1, (int[]){ 1 }) = (unsigned char)m->jacobian;
    put_float(field(b, "luminance", 10, 1, (int[]){ 1 }), 0, 0.5);
}

/* f cos(theta_o) of that material in closed form. */
static double exact(const material *m, asp_vec3 wi, asp_vec3 wo, int channel)
{
    if (m->symmetry == 2 && wi.y > 0)
        wi.x = -wi.x, wi.y = -wi.y, wo.x = -wo.x, wo.y = -wo.y;
    if (m->symmetry == 4) {
        if (wi.x > 0) wi.x = -wi.x, wo.x = -wo.x;
        if (wi.y > 0) wi.y = -wi.y, wo.y = -wo.y;
    }
    asp_vec3 h = { wi.x + wo.x, wi.y + wo.y, wi.z + wo.z };
    double length = sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
    double theta_m = acos(h.z / length), phi_m = atan2(h.y, h.x);
    double theta_i = acos(wi.z), phi_i = atan2(wi.y, wi.x);
    double x = sqrt(theta_m * 2 / PI);
    double y = ((m->n_phi == 1 ? phi_m - phi_i : phi_m) + PI) / (2 * PI);
    y -= floor(y);
    double u = x, v = (y + y * y / 2) / 1.5;         /* the share of 1 + v below y */
    double rgb = (1 + channel) * (3 + (m->n_phi == 1 ? 0 : phi_i / 4) + theta_i / 2 + u + v / 2);
    return m->jacobian ? rgb * (2 + y / 2) / (4 * (1 + sqrt(theta_i * 2 / PI))) : rgb;
}

static void check_material(const material *m, const char *name)
{
    static build b;
    asp_error err;
    char text[600];
    make_material(&b, m);
    asp_measured *r = asp_measured_read_memory(b.bytes, b.data, name, &err);
    if (!CHECK(r != NULL, "%s: %s", name, r ? "" : asp_error_text(&err, text, sizeof text)))
        return;
    asp_measured_info info = asp_measured_get_info(r);
    CHECK(!strcmp(info.format, "rgl") && info.isotropic == (m->n_phi == 1) && !info.scattered
          && info.channels == 3, "%s: what it says of itself", name);
    CHECK(!strcmp(info.description, "synthetic 1"), "%s: description '%s'", name,
          info.description);
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        asp_vec3 wi = random_direction(), wo = random_direction();
        asp_rgb f = asp_measured_eval(r, wi, wo);
        const double got[3] = { f.r, f.g, f.b };
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(got[c] * wo.z / exact(m, wi, wo, c) - 1));
    }
    printf("%-30s largest relative deviation %.2g\n", name, worst);
    /* tables are float32; the share of the mass is quadratic in y, exact inside each cell */
    CHECK(worst < 1e-6, "%s: closed form (%g)", name, worst);
    asp_measured_free(r);
}

/* ---- damage */

static const material small = { 1, 3, 3, 1, 1 };

static size_t entry_of(const build *b, const char *name)
{
    for (size_t i = 18; i + strlen(name) < b->used; i++)
        if (!memcmp(b->bytes + i, name, strlen(name)) && b->bytes[i - 2] == strlen(name))
            return i + strlen(name);               /* where rank, type, offset, sizes follow */
    printf("no field %s\n", name);
    exit(1);
}

static uint64_t offset_of(const build *b, const char *name)
{
    uint64_t value = 0;
    for (int i = 7; i >= 0; i--)
        value = value << 8 | b->bytes[entry_of(b, name) + 3 + (size_t)i];
    return value;
}

static void set(build *b, size_t at, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        b->bytes[at + (size_t)i] = (unsigned char)(value >> 8 * i);
}

static void check_damage(void)
{
    static build good, bad;
    make_material(&good, &small);
    size_t end = offset_of(&good, "jacobian") + 1;
    int refused = 0;
    asp_error err;
    for (size_t size = 0; size < end; size++) {            /* cut at every byte */
        asp_measured *m = asp_measured_read_memory(good.bytes, size, "cut.bsdf", &err);
        refused += !m;
        asp_measured_free(m);
    }
    printf("cut at every byte: %d of %zu refused\n", refused, end);
    CHECK(refused == (int)end, "a file cut anywhere is refused");

    const struct { const char *name; int at; uint64_t value; int bytes; const char *says; } harm[] = {
        { "rgb", 11, 0xffffffffffffffffu, 8, "whole file" },  /* a size */
        { "rgb", 11 + 24, 0x4000000000000000u, 8, "whole file" },
        { "rgb", 11, 0, 8, "a size of 0" },
        { "rgb", 3, 0xffffffffffffff00u, 8, "ends at byte" }, /* the offset */
        { "rgb", 3, 100000, 8, "ends at byte" },
        { "rgb", 2, 9, 1, "float32" },                        /* the type */
        { "rgb", 2, 77, 1, "unknown element type" },
        { "rgb", 0, 0xffff, 2, "field table" },               /* the rank */
        { "rgb", 0, 4, 2, "" },
        { "vndf", 11 + 8, 2, 8, "do not agree" },
        { "phi_i", 11, 0, 8, "a size of 0" },
        { "sigma", 11, 1, 8, "2 x 2" },
    };
    for (size_t i = 0; i < sizeof harm / sizeof harm[0]; i++) {
        bad = good;
        set(&bad, entry_of(&bad, harm[i].name) + (size_t)harm[i].at, harm[i].value, harm[i].bytes);
        expect_refusal(bad.bytes, bad.data, "harm.bsdf", 1, harm[i].says);
    }
    const struct { const char *name; int element; double value; const char *says; } number[] = {
        { "rgb", 5, NAN, "'rgb' = nan" },        { "rgb", 0, INFINITY, "'rgb' = inf" },
        { "vndf", 4, -1, "'vndf' = -1" },        { "vndf", 4, 1e30, "vndf" },
        { "sigma", 0, NAN, "sigma" },            { "theta_i", 1, 9, "theta_i" },
        { "theta_i", 1, 0, "must increase" },    { "luminance", 0, NAN, "'luminance' = nan" },
        { "luminance", 0, -INFINITY, "'luminance' = -inf" },
    };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        bad = good;
        put_float(bad.bytes + offset_of(&bad, number[i].name), (size_t)number[i].element,
                  number[i].value);
        expect_refusal(bad.bytes, bad.data, "number.bsdf", 2, "byte", number[i].says);
    }
    bad = good;
    memset(bad.bytes + offset_of(&bad, "vndf") + 36, 0, 36);
    expect_refusal(bad.bytes, bad.data, "zero.bsdf", 2, "vndf", "slice 1 is zero");
    bad = good;                                            /* a description may be empty */
    set(&bad, entry_of(&bad, "description") + 11, 0, 8);
    asp_measured *m = asp_measured_read_memory(bad.bytes, bad.data, "empty.bsdf", &err);
    CHECK(m && !asp_measured_get_info(m).description[0], "an empty description is read");
    asp_measured_free(m);
    bad = good;
    bad.bytes[12] = 2;
    expect_refusal(bad.bytes, bad.data, "version.bsdf", 1, "version 2.0");
    bad = good;
    set(&bad, 14, 0xffffffffu, 4);
    expect_refusal(bad.bytes, bad.data, "fields.bsdf", 2, "byte 14: field 'number of fields'",
                   "4294967295 fields");
    bad = good;                                            /* more fields than the table holds */
    set(&bad, 14, good.fields + 2, 4);
    memset(bad.bytes + good.used, 0xff, 2);                /* a name that is longer than the file */
    expect_refusal(bad.bytes, bad.data, "table.bsdf", 1, ": the file ends inside the field table");
    bad = good;
    memcpy(bad.bytes + entry_of(&bad, "rgb") - 3, "ndf", 3);
    expect_refusal(bad.bytes, bad.data, "twice.bsdf", 2, "field 'ndf'", "listed twice");
    bad = good;
    memcpy(bad.bytes + entry_of(&bad, "rgb") - 3, "abc", 3);
    expect_refusal(bad.bytes, bad.data, "missing.bsdf", 2, "'rgb'", "missing");

    /* every byte of the header, and a few of the data, turned round: no crash, and what is read
     * evaluates to finite numbers */
    int read = 0;
    for (size_t at = 0; at < end; at += at < good.used ? 1 : 7)
        for (int bit = 0; bit < 8; bit++) {
            bad = good;
            bad.bytes[at] ^= (unsigned char)(1 << bit);
            asp_measured *m = asp_measured_read_memory(bad.bytes, bad.data, "flip.bsdf", &err);
            if (!m)
                continue;
            read++;
            for (int i = 0; i < 3; i++) {
                asp_rgb f = asp_measured_eval(m, random_direction(), random_direction());
                if (!isfinite(f.r + f.g + f.b) || f.r < 0)
                    CHECK(0, "byte %zu bit %d: finite values", at, bit);
            }
            asp_measured_free(m);
        }
    printf("one bit turned: %d files still read\n", read);
    CHECK(read > 100, "most data bits do not matter to the structure");
}

/* Negative values are counted, channel by channel. */
static void check_negative(void)
{
    static build b;
    const material m = { 1, 5, 5, 1, 1 };                  /* 125 values in each channel */
    asp_error err;
    make_material(&b, &m);
    unsigned char *rgb = b.bytes + offset_of(&b, "rgb");
    for (size_t slice = 0; slice < 15; slice++)
        for (size_t i = 0; i < 25; i++)
            if (slice % 3 == 0 && i < 20)                  /* four fifths of red */
                put_float(rgb, slice * 25 + i, -1 - (double)i);
    put_float(rgb, 2 * 25 + 7, -1e-9);                     /* one of blue, in the first slice */
    put_float(rgb, 1 * 25 + 7, -0.0);                      /* is no negative value */
    asp_measured *r = asp_measured_read_memory(b.bytes, b.data, "negative.bsdf", &err);
    const char *says = asp_measured_get_info(r).description;
    CHECK(!strcmp(says, "synthetic 1; 80 % of red, 0.8 % of blue values are negative and read as 0"),
          "negative values: '%s'", says);
    asp_measured_free(r);
}

static void check_csv(void)
{
    static build b;
    const material m = { 9, 4, 5, 1, 1 };
    asp_error err;
    make_material(&b, &m);
    asp_measured *r = asp_measured_read_memory(b.bytes, b.data, "a.bsdf", &err);
    const char *path = temporary_path("rgl.csv");
    CHECK(r && asp_measured_write_csv(r, path, &err) == ASP_OK, "CSV is written");
    asp_measured *list = asp_measured_read(path, &err);
    size_t count = 0;
    const asp_measurement *g = asp_measured_geometries(list, &count);
    double worst = 0;
    for (size_t i = 0; i < count; i++)
        worst = fmax(worst, fabs(asp_measured_eval(r, g[i].wi, g[i].wo).g / g[i].f.g - 1));
    printf("as CSV: %zu rows, largest relative deviation %.2g\n", count, worst);
    CHECK(count > 10000 && worst < 1e-5, "rows hold what the file evaluates to (%g)", worst);
    CHECK(list && !asp_measured_get_info(list).isotropic, "and say that it is anisotropic");
    asp_measured_free(list);
    asp_measured_free(r);
    remove(path);
}

int main(void)
{
    check_material(&(material){ 1, 8, 9, 1, 1 }, "isotropic");
    check_material(&(material){ 1, 8, 9, 1, 0 }, "isotropic without jacobian");
    check_material(&(material){ 9, 6, 5, 1, 1 }, "anisotropic");
    check_material(&(material){ 7, 6, 5, 2, 1 }, "anisotropic, half turn");
    check_material(&(material){ 5, 6, 5, 4, 1 }, "anisotropic, quarter turn");
    check_damage();
    check_negative();
    check_csv();
    if (folder_[0])
        rmdir(folder_);
    return finish();
}
