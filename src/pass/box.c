// The box of a volume: where its density can be above 0, as the bounds of the field say.
#include "base/error.h"
#include "pass/pass_impl.h"
#include <string.h>

const field *pass_density(const pass *p) {
    return p->density >= 0 ? p->fields[p->density] : NULL;
}

// As an author writes it.
static const char *written(const field *node) {
    const char *name = node->kind->name;
    return strcmp(name, "add") == 0 ? "+" : strcmp(name, "sub") == 0 ? "-" : name;
}

// Of a box that came from the field's bounds, if these are known.
static bool has_end(const pass *p, bool known, const box3 *box) {
    if (!known) return err_prefix("%s: ", p->label);
    if (box3_is_finite(*box) || box3_is_empty(*box)) return true;
    const field *cause = field_without_bounds(pass_density(p), p->host->context);
    return err_set("%s: field 'density' fills all of space, because of '%s'; multiply it by a grid "
                   "or a shape",
                   p->label, written(cause));
}

bool pass_check_density(const pass *p) {
    box3 box;
    return has_end(p, field_bounds_of_grids(pass_density(p), p->host->context, &box), &box);
}

bool pass_density_box(const pass *p, box3 *box) {
    return has_end(p, field_bounds(pass_density(p), p->host->context, box), box) ||
           pass_locate_error(p);
}

bool pass_density_box_of_grids(const pass *p, box3 *box) {
    return has_end(p, field_bounds_of_grids(pass_density(p), p->host->context, box), box) ||
           pass_locate_error(p);
}
