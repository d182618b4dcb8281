/* report_page.c - text that grows */
#include "report.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static int grow(page *p, size_t more)
{
    if (p->broken)
        return 0;
    if (p->used + more + 1 > p->room) {
        size_t room = 2 * (p->used + more) + 4096;
        char *text = realloc(p->text, room);
        if (!text) {
            page_free(p);
            p->broken = 1;
            return 0;
        }
        p->text = text;
        p->room = room;
    }
    return 1;
}

void page_add(page *p, const char *text)
{
    size_t n = strlen(text);
    if (!grow(p, n))
        return;
    memcpy(p->text + p->used, text, n + 1);
    p->used += n;
}

void page_put(page *p, const char *format, ...)
{
    va_list list, again;
    va_start(list, format);
    va_copy(again, list);
    int n = vsnprintf(NULL, 0, format, list);
    if (n >= 0 && grow(p, (size_t)n)) {
        vsnprintf(p->text + p->used, (size_t)n + 1, format, again);
        p->used += (size_t)n;
    }
    va_end(again);
    va_end(list);
}

void page_escaped(page *p, const char *text)
{
    for (; *text; text++) {
        char one[2] = { *text, 0 };
        page_add(p, *text == '&' ? "&amp;" : *text == '<' ? "&lt;" : *text == '>' ? "&gt;"
                  : *text == '"' ? "&quot;" : one);
    }
}

void page_free(page *p)
{
    free(p->text);
    memset(p, 0, sizeof *p);
}
