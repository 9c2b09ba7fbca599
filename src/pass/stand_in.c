// A pass that stands for one of another type takes what is said to that one, and passes over what
// it has no use for.
#include "pass/pass_impl.h"
#include <string.h>

bool pass_stand_for(pass *p, const pass_type *other) {
    p->stands_for =
        shader_interface_load(p->host->library, p->host->memory, other->shader, p->host->reader);
    return p->stands_for != NULL;
}

static bool has(const shader_interface *face, const char *name) {
    for (size_t i = 0; i < face->uniform_count; i++)
        if (strcmp(face->uniforms[i].name, name) == 0) return true;
    for (size_t i = 0; i < face->option_count; i++)
        if (strcmp(face->options[i].name, name) == 0) return true;
    for (size_t i = 0; i < face->field_count; i++)
        if (strcmp(face->fields[i].name, name) == 0) return true;
    for (size_t i = 0; i < face->image_count; i++)
        if (!face->images[i].output && strcmp(face->images[i].name, name) == 0) return true;
    return false;
}

bool pass_ignores(const pass *p, const char *name) {
    size_t index;
    return p->stands_for && pass_find_key(p, name, &index) == PASS_UNKNOWN &&
           has(p->stands_for, name);
}
