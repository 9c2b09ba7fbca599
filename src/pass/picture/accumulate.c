// Accumulate: works at the resolution of what it accumulates.
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"

enum { N_source };
static const char *const names[] = {"source"};

static bool accumulate_declare(pass *p) {
    const graph_image source = *pass_image(p, N_source);
    if (source.id) {
        float scale = graph_get_desc(p->host->graph, source)->scale;
        if (!(scale > 0))
            return err_set("%s: the size of its source is fixed; accepted: one relative to the "
                           "effect's output",
                           p->label);
        if (p->scale != 1 && p->scale != scale)
            return err_set("%s: resolution is %g; accepted: that of its source, %g", p->label,
                           (double)p->scale, (double)scale);
        p->scale = scale;
    }
    return pass_declare_images(p) && pass_add_to_graph(p);
}

const pass_type accumulate_type = {
    .name = "accumulate",
    .shader = "pass/picture/accumulate.comp",
    .names = {names, COUNT_OF(names)},
    .declare = accumulate_declare,
};
