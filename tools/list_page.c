/* list_page.c - docs/distributions.md: a section for each distribution of the library
 *
 * Names, sources, ranges and the error of masking come from the records; a new model gets its section,
 * its figure included, by its row in models.def. What a record does not hold, the formula in text and how
 * masking and visible normals are come by, stands in the table below. */
#include "list_page.h"

#include "cmd.h"

#include <math.h>
#include <string.h>

#define SLOPES "in closed form"
#define OF_STUDENT "that of `student_t`, an incomplete beta function by a series fitted to the gamma"
#define PREPARED "by quadrature when the distribution is made, then polynomials by pieces"
#define REJECTION_FREE "exact, a map of two uniform numbers without rejection"
#define BY_TABLE "the radius of the slope by tables made with the distribution, its azimuth by a few steps of " \
    "Newton's; a continuous map of two uniform numbers without rejection"

static const struct text { const char *name, *formula, *masking, *visible, *figures; } texts[] = {
    { "ggx", "D = alpha^2 / (pi (1 + (alpha^2 - 1) cos^2)^2)\n"
      "  = 1 / (pi alpha^2 cos^4 (1 + tan^2/alpha^2)^2)", SLOPES, REJECTION_FREE,
      "notebook-trowbridge-reitz notebook-trowbridge-reitz-phong" },
    { "beckmann", "D = exp(-tan^2/alpha^2) / (pi alpha^2 cos^4)", "the error function",
      REJECTION_FREE, "notebook-beckmann notebook-beckmann-phong" },
    { "student_t", "D = 1 / (pi alpha^2 cos^4 (1 + tan^2/((gamma - 1) alpha^2))^gamma)\n"
      "gamma = 2: ggx; gamma = inf: beckmann", "an incomplete beta function, by a series that is fitted to "
      "the gamma when the distribution is made", REJECTION_FREE, "std-3 std-9 std-10 std-5 std-4" },
    { "hyper_cauchy", "D = (gamma - 1) / (pi alpha^2 cos^4 (1 + tan^2/alpha^2)^gamma)", OF_STUDENT,
      REJECTION_FREE, "" },
    { "student_t_general", "D = (C - 1) B / (pi cos^4 (1 + B tan^2)^C)", OF_STUDENT, REJECTION_FREE, "" },
    { "ellipsoid", "D = 1 / (pi |det A| |A n| |A^-T m|^4),   m a normal, n = (0, 0, 1)\n"
      "which is ggx through the slope map of A", SLOPES, REJECTION_FREE, "" },
    { "phong", "D = (exponent + 2)/(2 pi) cos^exponent", OF_STUDENT
      " (phong is student_t with gamma = exponent/2 + 2 and alpha = sqrt(2/(exponent + 2)))",
      REJECTION_FREE, "notebook-phong" },
    { "torrance_sparrow", "D = exp(-theta^2/alpha^2) / N(alpha),   N from the condition that the integral of "
      "D cos is 1", PREPARED, BY_TABLE, "notebook-torrance-sparrow notebook-torrance-sparrow-factor" },
    { "abc", "D = (1 + alpha (1 - cos))^-gamma / N(alpha, gamma),   N likewise", PREPARED, BY_TABLE,
      "notebook-abc notebook-abc-fits notebook-abc-spiky" },
    { "sgd", "D = alpha^(gamma - 1) exp(-(alpha^2 + tan^2)/alpha)\n"
      "    / (pi cos^4 Gamma(1 - gamma, alpha) (alpha^2 + tan^2)^gamma)", PREPARED, BY_TABLE,
      "notebook-sgd" },
    { "gtr", "D = (1 + (alpha^2 - 1) cos^2)^-gamma / N(alpha, gamma)\n"
      "N = pi (1 - alpha^(2 - 2 gamma)) / ((alpha^2 - 1) (gamma - 1)),\n"
      "    its limit 2 pi ln(alpha)/(alpha^2 - 1) at gamma = 1 and pi at alpha = 1", PREPARED, BY_TABLE,
      "notebook-gtr notebook-gtr-phong notebook-gtr-abc" },
};

static const struct text *find_text(const char *name)
{
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (strcmp(texts[i].name, name) == 0)
            return &texts[i];
    return NULL;
}

static void print_range(const asp_param *p)
{
    if (isfinite(p->low))
        printf("%s%g", p->low_open ? "(" : "[", p->low);
    else
        printf("(-inf");
    if (isinf(p->high))
        printf(", inf]");
    else
        printf(", %g]", p->high);
}

static void print_parameters(const asp_model *m)
{
    printf("| parameter | range | default | |\n|---|---|---|---|\n");
    for (size_t i = 0; i < m->param_count; i++) {
        printf("| `%s` | ", m->params[i].name);
        print_range(&m->params[i]);
        printf(" | ");
        if (isfinite(m->params[i].initial))
            printf("%g", m->params[i].initial);
        printf(" | %s |\n", m->params[i].what);
    }
    if (m->keys == ASP_KEYS_ELLIPSOID)
        printf("| `alpha_x`, `alpha_y`, `theta_x`, `theta_y`, `theta_z` | | | or the nine numbers of A, or the "
               "six of A^T A |\n");
    else if (m->own_scale)
        printf("| slope map | | 1 | `alpha_x`, `alpha_y` stretch the slopes |\n");
    else
        printf("| slope map | | %g | `alpha`, the roughness; or `alpha_x`, `alpha_y` |\n", m->alpha);
    printf("\n");
}

static void print_link(const char *name, size_t n)
{
    printf("[%.*s](figures.md#%.*s)", (int)n, name, (int)n, name);
}

static void print_model(const asp_model *m)
{
    const struct text *t = find_text(m->name);
    printf("## %s\n\n%s. %s.", m->name, m->title, m->source);
    if (m->alias)
        printf(" Also `%s`.", m->alias);
    printf("\n\n");
    if (t)
        printf("```text\n%s\n```\n\n", t->formula);
    print_parameters(m);
    printf("* Masking: ");
    if (t)
        printf("%s; ", t->masking);
    if (m->area_error > 0)
        printf("relative error of sigma at most %g.\n", m->area_error);
    else
        printf("sigma is exact to rounding.\n");
    if (t)
        printf("* Visible normals: %s.\n", t->visible);
    asp_ndf ndf;
    if (asp_ndf_parse(NULL, m->name, &ndf, NULL) == ASP_OK)      /* else it has no figure */
        printf("\n![%s](images/figures/ndf-%s.svg)\n", m->title, m->name);
    printf("\n");
    if (t && *t->figures) {
        printf("More: ");
        for (const char *at = t->figures; *at; at += strspn(at, " ")) {
            size_t n = strcspn(at, " ");
            print_link(at, n);
            at += n;
            printf("%s", *at ? ", " : ".\n\n");
        }
    }
}

void list_page(void)
{
    printf("# The distributions\n\n"
           "Written by `asperity list --markdown` from the records that the library itself reads; do not edit\n"
           "by hand. cos, tan and theta are those of the angle between facet normal and surface normal. Every\n"
           "distribution, the ellipsoid apart, takes the keys of the slope map: `alpha_x`, `alpha_y` or\n"
           "`alpha`, `rotation` or `rho`, `mean_x`, `mean_y`; the formulas are those of equal roughness along\n"
           "both axes and no mean slope. How masking is held to what is said here: [accuracy.md](accuracy.md).\n\n");
    for (const asp_model *const *m = asp_models(); *m; m++)
        printf("* [%s](#%s): %s\n", (*m)->name, (*m)->name, (*m)->title);
    printf("\n");
    for (const asp_model *const *m = asp_models(); *m; m++)
        print_model(*m);
}
