/* svg_png.c - SVG to PNG by librsvg (LGPL 2.1), where the program is built with it */
#include "figures.h"

#ifdef ASPERITY_RSVG
#include <librsvg/rsvg.h>
#include <cairo.h>
#include <stdlib.h>
#include <string.h>

typedef struct bytes { unsigned char *at; size_t size, room; } bytes;

static cairo_status_t append(void *context, const unsigned char *data, unsigned int size)
{
    bytes *b = context;
    if (b->size + size > b->room) {
        size_t room = 2 * (b->size + size);
        unsigned char *grown = realloc(b->at, room);
        if (!grown)
            return CAIRO_STATUS_NO_MEMORY;
        b->at = grown;
        b->room = room;
    }
    memcpy(b->at + b->size, data, size);
    b->size += size;
    return CAIRO_STATUS_SUCCESS;
}

int svg_png_available(void) { return 1; }

static int render(RsvgHandle *handle, double scale, bytes *out)
{
    gdouble width = 0, height = 0;
    GError *error = NULL;
    int status = CMD_OK;
    rsvg_handle_get_intrinsic_size_in_pixels(handle, &width, &height);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(width * scale + 0.5),
                                                          (int)(height * scale + 0.5));
    cairo_t *cairo = cairo_create(surface);
    RsvgRectangle all = { 0, 0, width * scale, height * scale };
    if (!rsvg_handle_render_document(handle, cairo, &all, &error)) {
        status = cmd_failed("PNG: %s", error ? error->message : "cannot be drawn");
        g_clear_error(&error);
    } else if (cairo_surface_write_to_png_stream(surface, append, out) != CAIRO_STATUS_SUCCESS) {
        status = cmd_failed("PNG: %s", cairo_status_to_string(cairo_surface_status(surface)));
    }
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return status;
}

int svg_png(const char *svg, double scale, unsigned char **out, size_t *size)
{
    bytes b = { NULL, 0, 0 };
    GError *error = NULL;
    RsvgHandle *handle = rsvg_handle_new_from_data((const guint8 *)svg, strlen(svg), &error);
    if (!handle) {
        int status = cmd_failed("PNG: %s", error ? error->message : "cannot be read");
        g_clear_error(&error);
        return status;
    }
    int status = render(handle, scale, &b);
    g_object_unref(handle);
    if (status != CMD_OK) {
        free(b.at);
        b.at = NULL;
    }
    *out = b.at;
    *size = b.size;
    return status;
}

#else

int svg_png_available(void) { return 0; }

int svg_png(const char *svg, double scale, unsigned char **out, size_t *size)
{
    (void)svg;
    (void)scale;
    *out = NULL;
    *size = 0;
    return cmd_failed("built without librsvg, which makes PNG of SVG: give --no-png");
}

#endif
