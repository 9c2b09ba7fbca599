// Prints the graph as Graphviz text. Passes are boxes, images are ellipses, outputs have a double
// line.
#include "graph/internal.h"
#include <ctype.h>

static void add_quoted(strbuf *out, const char *text) {
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') strbuf_append(out, "\\", 1);
        strbuf_append(out, iscntrl((unsigned char)*text) ? " " : text, 1);
    }
}

static void add_size(strbuf *out, const graph *g, const graph_node_image *image) {
    if (g->compiled) {
        strbuf_add(out, " %ux%u", image->size[0], image->size[1]);
        if (image->desc.depth) strbuf_add(out, "x%u", image->size[2]);
        if (image->desc.mips > 1) strbuf_add(out, ", %u mips", image->desc.mips);
    } else if (image->desc.scale > 0) {
        strbuf_add(out, " x %g", (double)image->desc.scale);
    }
}

static void add_image(strbuf *out, const graph *g, size_t index) {
    const graph_node_image *image = &g->images[index];
    strbuf_add(out, "  i%zu [label=\"", index);
    add_quoted(out, image->desc.name);
    strbuf_add(out, "\\n%s", gpu_format_name(image->desc.format));
    add_size(out, g, image);
    strbuf_add(out, "\"%s%s];\n", image->output ? ", peripheries=2" : "",
               g->compiled && image->slot == NONE ? ", color=grey, fontcolor=grey" : "");
    if (image->of != NONE)
        strbuf_add(out, "  i%u -> i%zu [style=dashed, label=\"last frame\"%s];\n", image->of, index,
                   g->compiled && image->slot == NONE ? ", color=grey, fontcolor=grey" : "");
}

static void add_pass(strbuf *out, const graph *g, size_t index) {
    const graph_node_pass *pass = &g->passes[index];
    bool culled = g->compiled && !pass->live;
    const char *edge = culled ? " [color=grey]" : "";
    strbuf_add(out, "  p%zu [shape=box, label=\"", index);
    add_quoted(out, pass->name);
    strbuf_add(out, "\"%s];\n", culled ? ", color=grey, fontcolor=grey" : "");
    for (size_t i = 0; i < pass->read_count; i++)
        strbuf_add(out, "  i%u -> p%zu%s;\n", pass->reads[i], index, edge);
    for (size_t i = 0; i < pass->write_count; i++)
        strbuf_add(out, "  p%zu -> i%u%s;\n", index, pass->writes[i], edge);
}

void graph_print_dot(const graph *g, const char *title, strbuf *out) {
    strbuf_add(out, "digraph \"");
    add_quoted(out, title);
    strbuf_add(out, "\" {\n  rankdir=LR;\n  node [shape=ellipse, fontname=\"sans-serif\"];\n");
    for (size_t i = 0; i < g->image_count; i++) add_image(out, g, i);
    for (size_t i = 0; i < g->pass_count; i++) add_pass(out, g, i);
    strbuf_add(out, "}\n");
}
