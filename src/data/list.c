/* list.c - measurements that are a list of geometries, and the nearest of them
 *
 * Nearness is measured between half and difference vectors laid flat: (theta_h, phi_h) and
 * (theta_d, 2 phi_d) as polar coordinates, so that a geometry and its reciprocal coincide and nothing
 * jumps where an azimuth wraps. Isotropic data ignore phi_h. The search is a k-d tree of the four
 * coordinates, split at the median of the widest one. */
#include "measured.h"

#include <stdlib.h>
#include <string.h>

int aspi_list_add(aspi_list *list, asp_vec3 wi, asp_vec3 wo, asp_rgb f)
{
    if (list->count == list->room) {
        size_t room = list->room ? list->room + list->room / 2 : 64;
        asp_measurement *item = room < SIZE_MAX / sizeof *item
                              ? realloc(list->item, room * sizeof *item) : NULL;
        if (!item)
            return 0;
        list->item = item;
        list->room = room;
    }
    list->item[list->count++] = (asp_measurement){ wi, wo, f };
    return 1;
}

void aspi_list_clear(aspi_list *list)
{
    free(list->item);
    free(list->node);
    memset(list, 0, sizeof *list);
}

static void list_release(void *data)
{
    aspi_list *list = data;
    aspi_list_clear(list);
    free(list);
}

static void key_of(asp_vec3 wi, asp_vec3 wo, int isotropic, double key[4])
{
    aspi_half a = aspi_half_of(wi, wo);
    double phi_h = isotropic ? 0 : a.phi_h;
    key[0] = a.theta_h * cos(phi_h);
    key[1] = a.theta_h * sin(phi_h);
    key[2] = a.theta_d * cos(2 * a.phi_d);
    key[3] = a.theta_d * sin(2 * a.phi_d);
}

static void swap_nodes(aspi_node *a, aspi_node *b)
{
    aspi_node t = *a;
    *a = *b;
    *b = t;
}

/* Puts the node of rank `middle` in its place (Hoare 1961). Scans stop at equal keys, so that many
 * equal ones still split in halves. */
static void select_middle(aspi_node *node, size_t n, size_t middle, int axis)
{
    size_t lo = 0, hi = n - 1;
    while (lo < hi) {
        double pivot = node[lo + (hi - lo) / 2].key[axis];
        size_t i = lo, j = hi;
        for (;;) {
            while (node[i].key[axis] < pivot) i++;
            while (node[j].key[axis] > pivot) j--;
            if (i >= j)
                break;
            swap_nodes(&node[i++], &node[j--]);
        }
        /* up to j all are at most the pivot, after j at least; lo <= j < hi */
        if (middle <= j)
            hi = j;
        else
            lo = j + 1;
    }
}

static int widest_axis(const aspi_node *node, size_t n)
{
    int best = 0;
    double widest = -1;
    for (int axis = 0; axis < 4; axis++) {
        double low = node[0].key[axis], high = low;
        for (size_t i = 1; i < n; i++) {
            double x = node[i].key[axis];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        if (high - low > widest) {
            widest = high - low;
            best = axis;
        }
    }
    return best;
}

/* The middle node of a range splits it; depth is the logarithm of n. */
static void build(aspi_node *node, size_t n)
{
    while (n > 1) {
        size_t middle = n / 2;
        int axis = widest_axis(node, n);
        select_middle(node, n, middle, axis);
        node[middle].axis = (uint32_t)axis;
        build(node, middle);
        node += middle + 1;
        n -= middle + 1;
    }
}

typedef struct search { double key[4], best; uint32_t index; } search;

static void visit(const aspi_node *node, size_t n, search *s)
{
    while (n) {
        const aspi_node *at = node + n / 2;
        double distance = 0;
        for (int axis = 0; axis < 4; axis++) {
            double d = s->key[axis] - at->key[axis];
            distance += d * d;
        }
        /* of equally near ones the first listed, whatever the shape of the tree */
        if (distance < s->best || (distance == s->best && at->index < s->index)) {
            s->best = distance;
            s->index = at->index;
        }
        if (n == 1)
            return;
        double side = s->key[at->axis] - at->key[at->axis];
        size_t below = n / 2, above = n - below - 1;
        const aspi_node *far_node = side < 0 ? at + 1 : node;
        size_t far_n = side < 0 ? above : below;
        visit(side < 0 ? node : at + 1, side < 0 ? below : above, s);
        if (side * side > s->best)
            return;
        node = far_node;
        n = far_n;
    }
}

static asp_rgb list_eval(const void *data, asp_vec3 wi, asp_vec3 wo)
{
    const aspi_list *list = data;
    search s = { .best = INFINITY, .index = UINT32_MAX };
    key_of(wi, wo, list->isotropic, s.key);
    visit(list->node, list->count, &s);
    return s.index < list->count ? list->item[s.index].f : (asp_rgb){ 0, 0, 0 };
}

asp_measured *aspi_list_wrap(aspi_list *given, asp_measured_info info, const char *description,
                             size_t length, const char *file, asp_error *err)
{
    aspi_list *list = malloc(sizeof *list);
    if (!list || !given->count || given->count >= UINT32_MAX) {
        int empty = !given->count;
        free(list);
        aspi_list_clear(given);
        aspi_fail_at(err, empty ? ASP_EFORMAT : ASP_ENOMEM, file, -1, "",
                     empty ? "no row has both directions above the horizon and a value"
                           : "not enough memory for the geometries");
        return NULL;
    }
    *list = *given;
    memset(given, 0, sizeof *given);
    list->isotropic = info.isotropic;
    list->node = malloc(list->count * sizeof *list->node);
    if (!list->node) {
        list_release(list);
        aspi_fail_at(err, ASP_ENOMEM, file, -1, "", "not enough memory for the geometries");
        return NULL;
    }
    for (size_t i = 0; i < list->count; i++) {
        key_of(list->item[i].wi, list->item[i].wo, info.isotropic, list->node[i].key);
        list->node[i].index = (uint32_t)i;
        list->node[i].axis = 0;
    }
    build(list->node, list->count);
    info.scattered = 1;
    info.samples = list->count;
    return aspi_measured_wrap(&aspi_kind_list, list, info, description, length, err);
}

/* Vectors rather than angles: they come back bit for bit. */
static asp_status list_write_csv(const asp_measured *measured, aspi_out *out, asp_error *err)
{
    const aspi_list *list = measured->data;
    int grey = measured->info.channels == 1;
    (void)err;
    aspi_csv_comment(measured, out);
    aspi_out_text(out, grey ? "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n"
                            : "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n");
    for (size_t i = 0; i < list->count && !out->failed; i++) {
        const asp_measurement *m = &list->item[i];
        const double row[9] = { m->wi.x, m->wi.y, m->wi.z, m->wo.x, m->wo.y, m->wo.z,
                                m->f.r, m->f.g, m->f.b };
        aspi_csv_row(out, row, grey ? 7 : 9);
    }
    return ASP_OK;
}

const aspi_kind aspi_kind_list = { list_eval, list_release, list_write_csv };
