/* svg_test.h - just enough of an XML reader to take a chart apart again */
#ifndef SVG_TEST_H
#define SVG_TEST_H

#include "draw_test.h"

/* Whether s is UTF-8 that XML 1.0 allows. */
static inline int is_xml_text(const char *s)
{
    for (const unsigned char *p = (const unsigned char *)s; *p;) {
        int n = *p < 0x80 ? 1 : *p < 0xc2 ? 0 : *p < 0xe0 ? 2 : *p < 0xf0 ? 3 : *p < 0xf5 ? 4 : 0;
        if (n == 0 || (*p < 0x20 && *p != '\n') || *p == 0x7f)
            return 0;
        for (int i = 1; i < n; i++)
            if ((p[i] & 0xc0) != 0x80)
                return 0;
        if (n == 3 && ((p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xed && p[1] >= 0xa0)))
            return 0;
        p += n;
    }
    return 1;
}

/* Well-formed: one root, tags balanced, attributes quoted and not given twice, entities known. NULL, or
 * what is wrong. */
static inline const char *svg_fault(const char *svg)
{
    char stack[32][32];
    int depth = 0, roots = 0;
    if (!is_xml_text(svg))
        return "characters";
    for (const char *p = svg; *p;) {
        if (*p == '&') {
            static const char *const known[] = { "&amp;", "&lt;", "&gt;", "&quot;", "&#39;" };
            int good = 0;
            for (int i = 0; i < 5; i++)
                good |= strncmp(p, known[i], strlen(known[i])) == 0;
            if (!good)
                return "entity";
        }
        if (*p == '>')
            return "a bare >";
        if (*p != '<') {
            if (depth == 0 && *p != '\n')
                return "text outside the root";
            p++;
            continue;
        }
        int closing = p[1] == '/';
        p += 1 + closing;
        char name[32];
        size_t n = strspn(p, "abcdefghijklmnopqrstuvwxyz");
        if (n == 0 || n >= sizeof name)
            return "tag name";
        memcpy(name, p, n);
        name[n] = '\0';
        p += n;
        if (closing) {
            if (*p != '>' || depth == 0 || strcmp(stack[depth - 1], name) != 0)
                return "closing tag";
            depth--;
            p++;
            continue;
        }
        char seen[24][32];
        int attributes = 0;
        while (*p == ' ') {
            p++;
            size_t a = strcspn(p, "= >");
            if (p[a] != '=' || p[a + 1] != '"' || a >= 32 || attributes >= 24)
                return "attribute";
            memcpy(seen[attributes], p, a);
            seen[attributes][a] = '\0';
            for (int i = 0; i < attributes; i++)
                if (strcmp(seen[i], seen[attributes]) == 0)
                    return "attribute given twice";
            attributes++;
            p += a + 2;
            size_t v = strcspn(p, "\"<");
            if (p[v] != '"')
                return "attribute value";
            p += v + 1;
        }
        if (*p == '/' && p[1] == '>') {
            p += 2;
            roots += depth == 0;
            continue;
        }
        if (*p != '>' || depth >= 32)
            return "tag";
        p++;
        roots += depth == 0;
        strcpy(stack[depth++], name);
    }
    return depth ? "unclosed" : roots != 1 ? "not one root" : NULL;
}

/* The value of `attribute` in the tag at p ("" when there is none); valid until the next call. */
static inline const char *attribute_of(const char *p, const char *attribute)
{
    static char value[4][256];
    static int turn;
    char *out = value[turn = (turn + 1) % 4];
    char key[64];
    snprintf(key, sizeof key, " %s=\"", attribute);
    const char *end = strchr(p, '>'), *at = strstr(p, key);
    out[0] = '\0';
    if (at && end && at < end) {
        at += strlen(key);
        snprintf(out, 256, "%.*s", (int)strcspn(at, "\""), at);
    }
    return out;
}

/* The part <g><title>label</title>...</g> of a series; NULL when there is none. */
static inline const char *series_part(const char *svg, const char *label)
{
    char key[256];
    snprintf(key, sizeof key, "<g><title>%s</title>", label);
    return strstr(svg, key);
}

/* Points of the first path of a part; `moves` counts the strokes. Only absolute M and L, as the line of
 * a series has. -1 when there is anything else. */
static inline int path_points(const char *part, double (*out)[2], int room, int *moves)
{
    const char *p = strstr(part, " d=\"");
    int n = 0;
    *moves = 0;
    if (!p)
        return -1;
    for (p += 4; *p && *p != '"';) {
        char command = *p++;
        char *end;
        if (command != 'M' && command != 'L')
            return -1;
        double x = strtod(p, &end);
        if (end == p || *end != ' ')
            return -1;
        p = end + 1;
        double y = strtod(p, &end);
        if (end == p)
            return -1;
        p = end;
        *moves += command == 'M';
        if (n < room) {
            out[n][0] = x;
            out[n][1] = y;
        }
        n++;
    }
    return n;
}

/* A text element: where it is, and what it says without tags; 10^{-3} comes as "10^-3". */
typedef struct label { double x, y; char anchor[8], text[128]; } label;

static inline int read_labels(const char *svg, label *out, int room)
{
    int n = 0;
    for (const char *p = svg; (p = strstr(p, "<text ")) && n < room; p++) {
        label *l = &out[n++];
        l->x = atof(attribute_of(p, "x"));
        l->y = atof(attribute_of(p, "y"));
        snprintf(l->anchor, sizeof l->anchor, "%s", attribute_of(p, "text-anchor"));
        size_t k = 0;
        for (const char *q = strchr(p, '>') + 1; strncmp(q, "</text>", 7) != 0 && k < 100;) {
            if (*q == '<') {
                if (strncmp(q, "<tspan", 6) == 0)
                    l->text[k++] = atof(attribute_of(q, "dy")) < 0 ? '^' : '_';
                q = strchr(q, '>') + 1;
            } else if (strncmp(q, "\xe2\x88\x92", 3) == 0) {
                l->text[k++] = '-';
                q += 3;
            } else {
                l->text[k++] = *q++;
            }
        }
        l->text[k] = '\0';
    }
    return n;
}

/* The number on a tick label, NaN when it is none. */
static inline double label_value(const char *text)
{
    char *end;
    double v = strtod(text, &end);
    if (end == text)
        return NAN;
    if (strncmp(end, "\xc3\x97", 2) == 0) {       /* 5 x 10^3 */
        double power = label_value(end + 2);
        return v * power;
    }
    if (*end == '^' && v == 10)
        return pow(10, atof(end + 1));
    return *end ? NAN : v;
}

#endif
