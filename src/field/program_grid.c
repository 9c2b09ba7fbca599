// Samples of grids: the GLSL function that fetches an image of one, whole, in bricks, repeating, or
// as slices round an axis.
#include "field/program_parts.h"
#include <stdio.h>

static void add_repeating_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    unsigned at = grid->at;
    bool levels = grid->grid->levels;
    strbuf_add(out,
               "uniform sampler3D field_grid_%zu_%d;\n"
               "vec4 field_fetch_%zu_%d(vec3 p%s) {\n"
               "    vec3 uvw = (p - field_numbers[%u].xyz) * field_numbers[%u].xyz;\n",
               g, image, g, image, levels ? ", float width" : "", at, at + 1);
    if (levels)
        strbuf_add(out,
                   "    return textureLod(field_grid_%zu_%d, uvw, "
                   "grid_level(width * field_numbers[%u].w));\n}\n",
                   g, image, at + 1);
    else
        strbuf_add(out, "    return textureLod(field_grid_%zu_%d, uvw, 0.0);\n}\n", g, image);
}

// A sample of one of the two sets of images.
static void sample_text(const program_grid *grid, size_t g, int image, bool next, char out[240]) {
    const char *set = next ? "next" : "grid", *place = next ? "index_next" : "index";
    unsigned at = grid->at;
    if (grid->grid->sparse)
        snprintf(out, 240,
                 "grid_sample_bricks(field_%s_%zu_%d, field_%s_%zu_%d, vec3(field_numbers[%u].w, "
                 "field_numbers[%u].w, field_numbers[%u].w), uvw)",
                 set, g, image, place, g, image, at + 2, at + 3, at + 4);
    else
        snprintf(out, 240, "grid_sample(field_%s_%zu_%d, uvw)", set, g, image);
}

static void add_extruded_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    unsigned at = grid->at + 5;
    bool vectors = grid->grid->extruded->vectors >> image & 1;
    strbuf_add(out,
               "uniform sampler3D field_grid_%zu_%d;\n"
               "vec4 field_fetch_%zu_%d(vec3 p) {\n"
               "    return extrude_%s(field_grid_%zu_%d, field_numbers[%u], field_numbers[%u], "
               "field_numbers[%u], field_numbers[%u], p);\n}\n",
               g, image, g, image, vectors ? "vector" : "sample", g, image, at, at + 1, at + 2,
               at + 3);
}

void emit_grid_fetch(const program_grid *grid, size_t g, int image, strbuf *out) {
    if (grid->grid->repeats) {
        add_repeating_fetch(grid, g, image, out);
        return;
    }
    if (grid->grid->extruded) {
        add_extruded_fetch(grid, g, image, out);
        return;
    }
    unsigned at = grid->at;
    bool sparse = grid->grid->sparse, blends = grid->grid->blends;
    char now[240], next[240];
    sample_text(grid, g, image, false, now);
    sample_text(grid, g, image, true, next);
    strbuf_add(out, "uniform sampler3D field_grid_%zu_%d;\n", g, image);
    if (blends) strbuf_add(out, "uniform sampler3D field_next_%zu_%d;\n", g, image);
    if (sparse) strbuf_add(out, "uniform usampler3D field_index_%zu_%d;\n", g, image);
    if (sparse && blends)
        strbuf_add(out, "uniform usampler3D field_index_next_%zu_%d;\n", g, image);
    strbuf_add(out,
               "vec4 field_fetch_%zu_%d(vec3 p) {\n"
               "    if (any(lessThan(p, field_numbers[%u].xyz)) || "
               "any(greaterThan(p, field_numbers[%u].xyz))) return vec4(0.0);\n"
               "    vec3 uvw = (p - field_numbers[%u].xyz) * field_numbers[%u].xyz;\n",
               g, image, at + 2, at + 3, at, at + 1);
    if (blends)
        strbuf_add(out,
                   "    float blend = field_numbers[%u].w;\n"
                   "    vec4 now = %s;\n"
                   "    return blend > 0.0 ? mix(now, %s, blend) : now;\n}\n",
                   at, now, next);
    else
        strbuf_add(out, "    return %s;\n}\n", now);
}
