/* cornell.c - spectral tables of the Cornell gonioreflectometer, as they come with pbrt
 *
 * Text: the number of bands, their wavelengths in nm, then per geometry theta_i, phi_i, theta_o,
 * phi_o in radians and one value per band in 1/sr; # starts a comment. Read for 31 bands, 400 to
 * 700 nm in steps of 10 nm, as linear sRGB under D65; colours outside its gamut are clipped at 0. */
#include "text.h"

#include <string.h>

#define BANDS 31

/* Weights of the bands; scripts/cornell_weights.py prints them. */
static const double weight[BANDS][3] = {
    {  0.00093723, -0.00080645,  0.00568537 }, /* 400 */
    {  0.00310191, -0.00270581,  0.01921114 }, /* 410 */
    {  0.00952496, -0.00847252,  0.06106337 }, /* 420 */
    {  0.01738263, -0.01604866,  0.12151681 }, /* 430 */
    {  0.02211175, -0.02199236,  0.18513237 }, /* 440 */
    {  0.01637831, -0.02001616,  0.20909426 }, /* 450 */
    {  0.00199803, -0.01113239,  0.19759220 }, /* 460 */
    { -0.01621797,  0.00378086,  0.14743780 }, /* 470 */
    { -0.03400436,  0.02212404,  0.09194590 }, /* 480 */
    { -0.04625754,  0.03894107,  0.04654937 }, /* 490 */
    { -0.06395157,  0.06332313,  0.02301369 }, /* 500 */
    { -0.08408703,  0.09592459,  0.00665867 }, /* 510 */
    { -0.09202426,  0.12620721, -0.00582483 }, /* 520 */
    { -0.08275371,  0.14849256, -0.01246786 }, /* 530 */
    { -0.05306019,  0.14896440, -0.01554531 }, /* 540 */
    { -0.01275313,  0.14232652, -0.01673472 }, /* 550 */
    {  0.03749199,  0.12202754, -0.01572033 }, /* 560 */
    {  0.09189426,  0.09540903, -0.01366343 }, /* 570 */
    {  0.14827474,  0.06740360, -0.01132908 }, /* 580 */
    {  0.18192304,  0.03569238, -0.00808355 }, /* 590 */
    {  0.21112518,  0.01314829, -0.00586598 }, /* 600 */
    {  0.21049772, -0.00236176, -0.00394383 }, /* 610 */
    {  0.18169153, -0.00938582, -0.00248959 }, /* 620 */
    {  0.13234108, -0.00987016, -0.00143975 }, /* 630 */
    {  0.09391991, -0.00836547, -0.00085188 }, /* 640 */
    {  0.05727888, -0.00559734, -0.00045823 }, /* 650 */
    {  0.03353969, -0.00343942, -0.00024795 }, /* 660 */
    {  0.01827362, -0.00191816, -0.00012953 }, /* 670 */
    {  0.00931821, -0.00099386, -0.00006407 }, /* 680 */
    {  0.00403211, -0.00043468, -0.00002714 }, /* 690 */
    {  0.00207297, -0.00022421, -0.00001386 }, /* 700 */
};

/* Numbers one after another, wherever the lines break. */
typedef struct numbers { aspi_lines lines; aspi_line line; const aspi_bytes *file; } numbers;

/* 1: a number, 0: the end, -1: something else, with err filled. */
static int next_number(numbers *n, const char *what, double *value, asp_error *err)
{
    for (;;) {
        n->line = aspi_trimmed(n->line);
        if (n->line.length && !aspi_is_comment(n->line, NULL))
            break;
        if (!aspi_next_line(&n->lines, &n->line)) {
            n->line.length = 0;
            return 0;
        }
    }
    size_t i = 0;
    while (i < n->line.length && !strchr(" \t,", n->line.text[i]))
        i++;
    aspi_word word = { n->line.text, i };
    if (!aspi_word_number(word, value)) {
        aspi_fail_line(err, ASP_EPARSE, n->file->name, n->line.number, what,
                       "not a finite decimal number");
        return -1;
    }
    n->line.text += i;
    n->line.length -= i;
    while (n->line.length && strchr(" \t,", n->line.text[0])) {
        n->line.text++;
        n->line.length--;
    }
    return 1;
}

static numbers numbers_of(const aspi_bytes *file)
{
    return (numbers){ aspi_lines_of(file), { "", 0, 0 }, file };
}

/* A first row that is one whole number: no table with named columns starts so. */
static int cornell_probe(const aspi_bytes *file)
{
    aspi_lines lines = aspi_lines_of(file);
    aspi_line line;
    double value;
    if (!aspi_is_text(file))
        return 0;
    while (aspi_next_line(&lines, &line)) {
        line = aspi_trimmed(line);
        if (!line.length || aspi_is_comment(line, NULL))
            continue;
        return aspi_parse_number(line.text, line.length, &value) && value >= 1
            && value == floor(value);
    }
    return 0;
}

static asp_status fail_number(const numbers *n, const char *what, double value, double low,
                              double high, asp_error *err)
{
    asp_fail_range(err, what, value, low, 0, high);
    aspi_error_file(err, n->file->name);
    if (err) {
        err->status = ASP_EPARSE;
        err->line = n->line.number;
    }
    return ASP_EPARSE;
}

static asp_status fail_end(const numbers *n, const char *what, asp_error *err)
{
    return aspi_fail_line(err, ASP_EPARSE, n->file->name, n->lines.number, what,
                          "the file ends inside this list");
}

/* One number in a range; ASP_OK or the failure. */
static asp_status want(numbers *n, const char *what, double low, double high, double *value,
                       asp_error *err)
{
    int got = next_number(n, what, value, err);
    if (got <= 0)
        return got < 0 ? ASP_EPARSE : fail_end(n, what, err);
    if (*value < low || *value > high)
        return fail_number(n, what, *value, low, high, err);
    return ASP_OK;
}

static asp_status read_bands(numbers *n, asp_error *err)
{
    double value;
    asp_status status = want(n, "number of wavelengths", BANDS, BANDS, &value, err);
    for (int i = 0; status == ASP_OK && i < BANDS; i++)
        status = want(n, "wavelength", 400 + 10 * i, 400 + 10 * i, &value, err);
    return status;
}

/* One geometry; *done at the end of the file. */
static asp_status read_row(numbers *n, aspi_list *list, int *done, asp_error *err)
{
    static const char *const name[4] = { "theta_i", "phi_i", "theta_o", "phi_o" };
    double angle[4], rgb[3] = { 0, 0, 0 }, value;
    for (int i = 0; i < 4; i++) {
        double high = i % 2 ? 4 * ASPI_PI : ASPI_PI / 2;
        int got = next_number(n, name[i], &angle[i], err);
        if (got < 0)
            return ASP_EPARSE;
        if (!got) {
            *done = 1;
            return i ? fail_end(n, name[i], err) : ASP_OK;
        }
        if (fabs(angle[i]) > high * (1 + 1e-6))
            return fail_number(n, name[i], angle[i], -high, high, err);
    }
    for (int i = 0; i < BANDS; i++) {
        asp_status status = want(n, "sample", -1e26, 1e26, &value, err);
        if (status != ASP_OK)
            return status;
        for (int c = 0; c < 3; c++)
            rgb[c] += weight[i][c] * value;
    }
    double si = sin(angle[0]), so = sin(angle[2]);
    asp_vec3 wi = { si * cos(angle[1]), si * sin(angle[1]), cos(angle[0]) };
    asp_vec3 wo = { so * cos(angle[3]), so * sin(angle[3]), cos(angle[2]) };
    asp_rgb f = { fmax(0, rgb[0]), fmax(0, rgb[1]), fmax(0, rgb[2]) };
    if (wi.z >= 1e-6 && wo.z >= 1e-6 && !aspi_list_add(list, wi, wo, f))
        return aspi_fail_line(err, ASP_ENOMEM, n->file->name, n->line.number, "", "out of memory");
    return ASP_OK;
}

static asp_measured *cornell_read(const aspi_bytes *file, asp_error *err)
{
    numbers n = numbers_of(file);
    aspi_list list = { 0 };
    int done = 0;
    asp_status status = read_bands(&n, err);
    while (status == ASP_OK && !done)
        status = read_row(&n, &list, &done, err);
    if (status != ASP_OK) {
        aspi_list_clear(&list);
        return NULL;
    }
    asp_measured_info info = { .format = "cornell", .isotropic = 1, .channels = 3 };
    for (size_t i = 0; i < list.count; i++)        /* every file there is has phi_i = 0 */
        if (list.item[i].wi.y != 0)
            info.isotropic = 0;
    aspi_lines lines = aspi_lines_of(file);
    aspi_line line, comment = { "", 0, 0 };
    if (!aspi_next_line(&lines, &line) || !aspi_is_comment(aspi_trimmed(line), &comment))
        comment.length = 0;
    return aspi_list_wrap(&list, info, comment.text, comment.length, file->name, err);
}

const aspi_format aspi_format_cornell = {
    "cornell", "number of bands, wavelengths, angles and spectra", cornell_probe, cornell_read
};
