/* make_material.c - the table of scattering models, and making a material of one */
#define ASP_PRECISION 64
#include "bsdf/bsdf.h"
#include "asperity/elementary.h"
#include "asperity/fresnel.h"

#include <math.h>

#define ASPI_BSDF(name) extern const asp_bsdf asp_bsdf_##name;
#include "core/bsdfs.def"
#undef ASPI_BSDF

static const asp_bsdf *const bsdfs[] = {
#define ASPI_BSDF(name) &asp_bsdf_##name,
#include "core/bsdfs.def"
#undef ASPI_BSDF
    NULL
};

const asp_bsdf *const *asp_bsdfs(void) { return bsdfs; }

static asp_rgb grey(double x)
{
    asp_rgb c;
    c.r = c.g = c.b = x;
    return c;
}

static asp_material start(const asp_bsdf *model, const asp_ndf *ndf, int mask, int fresnel)
{
    asp_material mat;
    memset(&mat, 0, sizeof mat);
    mat.model = model;
    mat.mask = mask;
    mat.fresnel = fresnel;
    mat.b = grey(1.0);
    if (ndf)
        mat.ndf = *ndf;
    return mat;
}

asp_material asp_mirror(const asp_ndf *ndf, int mask)
{
    return start(&asp_bsdf_conductor, ndf, mask, ASPI_FRESNEL_ONE);
}

/* The Fresnel term of eta + i k. */
static int conductor_term(asp_rgb eta, asp_rgb k)
{
    const double n[6] = { eta.r, eta.g, eta.b, k.r, k.g, k.b };
    int i, within = 1;
    for (i = 0; i < 6; i++)
        within = within && n[i] >= 0.01 && n[i] <= 100.0;
    return within ? ASPI_FRESNEL_METAL : ASPI_FRESNEL_CONDUCTOR;
}

asp_material asp_conductor(const asp_ndf *ndf, asp_rgb eta, asp_rgb k, int mask)
{
    asp_material mat = start(&asp_bsdf_conductor, ndf, mask, conductor_term(eta, k));
    mat.c = eta;
    mat.d = k;
    return mat;
}

asp_material asp_lambert_specular(const asp_ndf *ndf, asp_rgb diffuse, asp_rgb specular, double eta,
                                  int mask)
{
    asp_material mat = start(&asp_bsdf_lambert_specular, ndf, mask, ASPI_FRESNEL_DIELECTRIC);
    mat.a = diffuse;
    mat.b = specular;
    mat.c = grey(eta);
    return mat;
}

asp_material asp_dielectric(const asp_ndf *ndf, double eta, int thin, int transport, int mask)
{
    asp_material mat = start(&asp_bsdf_dielectric, ndf, mask, ASPI_FRESNEL_DIELECTRIC);
    mat.transport = transport;
    mat.c = grey(eta);
    mat.a = grey(thin ? 1.0 : 0.0);
    return mat;
}

asp_material asp_rough_diffuse(const asp_ndf *ndf, asp_rgb albedo, int mask)
{
    asp_material mat = start(&asp_bsdf_rough_diffuse, ndf, mask, ASPI_FRESNEL_ONE);
    mat.a = albedo;
    mat.b = grey(0.0);
    return mat;
}

asp_material asp_plastic(const asp_ndf *ndf, asp_rgb albedo, double eta, int mask)
{
    asp_material mat = start(&asp_bsdf_plastic, ndf, mask, ASPI_FRESNEL_DIELECTRIC);
    mat.a = albedo;
    mat.c = grey(eta);
    mat.model->prepare(&mat, NULL);
    return mat;
}

static asp_status parse_metal(aspi_spec *spec, asp_material *out, asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, "metal");
    char name[16];
    const asp_metal *metal = NULL;
    if (item->value_size < sizeof name) {
        memcpy(name, item->value, item->value_size);
        name[item->value_size] = '\0';
        metal = asp_find_metal(name);
    }
    if (!metal)
        return aspi_spec_fail(spec, item->value, ASP_EUNKNOWN, item->value, item->value_size,
                              "no such metal (asperity list names them)", err);
    out->fresnel = conductor_term(metal->eta, metal->k);
    out->c = metal->eta;
    out->d = metal->k;
    return ASP_OK;
}

static asp_status parse_bare(aspi_spec *spec, double initial_eta, asp_material *out, asp_error *err)
{
    int has_metal = aspi_spec_find(spec, "metal") != NULL, has_eta, has_k, has_f0, has_tint;
    asp_rgb eta = grey(initial_eta), k = grey(0.0), f0 = grey(1.0), tint = grey(1.0);
    asp_status s = aspi_spec_colour(spec, "eta", 0.0, 1, 100.0, &eta, &has_eta, err);
    if (!s)
        s = aspi_spec_colour(spec, "k", 0.0, 0, 100.0, &k, &has_k, err);
    if (!s)
        s = aspi_spec_colour(spec, "f0", 0.0, 0, 1.0, &f0, &has_f0, err);
    if (!s)
        s = aspi_spec_colour(spec, "tint", 0.0, 0, 2.0, &tint, &has_tint, err);
    if (s)
        return s;
    if (has_metal + (has_eta || has_k) + (has_f0 || has_tint) > 1)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "metal", 5,
                              "give one of metal, eta (with k), or f0 (with tint)", err);
    if (has_metal)
        return parse_metal(spec, out, err);
    if ((has_k && !has_eta) || (has_tint && !has_f0))
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, has_k ? "k" : "tint", has_k ? 1 : 4,
                              has_k ? "k needs eta" : "tint needs f0", err);
    if (has_f0) {
        out->fresnel = ASPI_FRESNEL_F82;
        out->c = f0;
        out->d = tint;
    } else if (has_k) {
        out->fresnel = conductor_term(eta, k);
        out->c = eta;
        out->d = k;
    } else if (has_eta && (eta.r != eta.g || eta.g != eta.b)) {
        /* an index per channel without absorption is a conductor with k = 0 */
        out->fresnel = ASPI_FRESNEL_CONDUCTOR;
        out->c = eta;
        out->d = k;
    } else {
        out->fresnel = eta.r > 0.0 ? ASPI_FRESNEL_DIELECTRIC : ASPI_FRESNEL_ONE;
        out->c = eta;
    }
    return ASP_OK;
}

asp_status aspi_parse_film(aspi_spec *spec, asp_material *out, asp_error *err)
{
    double thickness = 0.0, film_eta = 1.33;
    int has_film, has_eta;
    asp_status s = aspi_spec_ranged(spec, "film", 0.0, 1, 1e4, &thickness, &has_film, err);
    if (!s)
        s = aspi_spec_ranged(spec, "film_eta", 1.0, 0, 10.0, &film_eta, &has_eta, err);
    if (s || !(has_film || has_eta))
        return s;
    if (!has_film)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "film", 4, "film_eta needs film, a thickness", err);
    s = aspi_film(out, film_eta, thickness, err);
    return s ? aspi_spec_blame(spec, "film", s, err) : s;
}

asp_status aspi_parse_fresnel(aspi_spec *spec, double initial_eta, asp_material *out, asp_error *err)
{
    asp_status s = parse_bare(spec, initial_eta, out, err);
    return s ? s : aspi_parse_film(spec, out, err);
}

int aspi_bsdf_has(const asp_bsdf *model, const char *name)
{
    const aspi_bsdf_key *key = model->keys;
    while (key->name && strcmp(key->name, name))
        key++;
    return key->name != NULL;
}

int aspi_bsdf_crosses(const asp_bsdf *model) { return aspi_bsdf_has(model, "transport"); }

int asp_can_walk(const asp_material *mat)
{
    switch (mat->model->facets) {
    case ASPI_FACETS_REFLECT:
        return 1;
    case ASPI_FACETS_REFRACT:
        return !(mat->a.r > 0.0);      /* a thin sheet has no inside */
    case ASPI_FACETS_DIFFUSE:
        return mat->b.r == ROUGH_EXACT;
    default:
        return 0;
    }
}

asp_status aspi_parse_transport(aspi_spec *spec, asp_material *out, asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, "transport");
    if (!item)
        return ASP_OK;
    if (item->value_size == 8 && !memcmp(item->value, "radiance", 8))
        out->transport = ASP_RADIANCE;
    else if (item->value_size == 10 && !memcmp(item->value, "importance", 10))
        out->transport = ASP_IMPORTANCE;
    else
        return aspi_spec_fail(spec, item->value, ASP_EUNKNOWN, "transport", 9,
                              "expected radiance or importance", err);
    return ASP_OK;
}

static const asp_bsdf *find_bsdf(const char *name, size_t size)
{
    size_t i;
    for (i = 0; bsdfs[i]; i++)
        if (strlen(bsdfs[i]->name) == size && !memcmp(bsdfs[i]->name, name, size))
            return bsdfs[i];
    return NULL;
}

static asp_status parse_ndf(const asp_model *const *models, aspi_spec *spec, asp_ndf *out,
                            asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, "ndf");
    const char *p;
    size_t size;
    asp_status s;
    if (!item)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "ndf", 3,
                              "a material needs a distribution, as in ndf=(ggx:alpha=0.3)", err);
    p = item->value;
    size = item->value_size;
    if (size >= 2 && p[0] == '(' && p[size - 1] == ')') {
        p++;
        size -= 2;
    }
    s = aspi_ndf_parse(models, p, size, out, err);
    if (s && err && err->position >= 0)
        err->position += p - spec->text;
    return s;
}

asp_status asp_material_parse(const asp_model *const *models, const char *text, asp_material *out,
                              asp_error *err)
{
    aspi_spec spec;
    asp_material mat;
    aspi_item *item;
    const asp_bsdf *model;
    asp_status s = aspi_spec_cut(text, strlen(text), &spec, err);
    if (s)
        return s;
    model = find_bsdf(spec.name, spec.name_size);
    if (!model)
        return aspi_spec_fail(&spec, text, ASP_EUNKNOWN, spec.name, spec.name_size,
                              "no such material (asperity list)", err);
    mat = start(model, NULL, 0, ASPI_FRESNEL_ONE);
    if ((item = aspi_spec_find(&spec, "mask")) != NULL) {
        char name[64] = "";
        if (item->value_size < sizeof name)
            memcpy(name, item->value, item->value_size);
        s = asp_mask_parse(name, &mat.mask, err);
        if (s && err)
            err->position += item->value - text;
    }
    if (!s)
        s = parse_ndf(models, &spec, &mat.ndf, err);
    if (!s)
        s = model->parse(&spec, &mat, err);
    if (!s)
        s = aspi_spec_rest(&spec, "unknown key of this material (asperity list)", err);
    if (!s && model->prepare)
        s = model->prepare(&mat, err);
    if (!s)
        *out = mat;
    return s;
}

static asp_rgbf narrow_rgb(asp_rgb c)
{
    asp_rgbf out;
    out.r = (float)c.r;
    out.g = (float)c.g;
    out.b = (float)c.b;
    return out;
}

asp_materialf asp_material_narrow(const asp_material *mat)
{
    asp_materialf out;
    size_t i;
    out.model = mat->model;
    out.mask = mat->mask;
    out.fresnel = mat->fresnel;
    out.transport = mat->transport;
    out.a = narrow_rgb(mat->a);
    out.b = narrow_rgb(mat->b);
    out.c = narrow_rgb(mat->c);
    out.d = narrow_rgb(mat->d);
    for (i = 0; i < ASP_ENERGY_NUMBERS; i++)
        out.energy[i] = (float)mat->energy[i];
    out.ndf = asp_ndf_narrow(&mat->ndf);
    return out;
}
