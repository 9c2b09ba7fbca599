// What the names of a pass's type are in its interface: found once, when the pass is declared, and
// given by number from then on.
#include "base/log.h"
#include "pass/pass_impl.h"
#include <stdlib.h>
#include <string.h>

kernel_names pass_names_of(const pass *p) {
    return p->type ? p->type->names : (kernel_names){0};
}

static pass_name find_name(const pass *p, const char *name) {
    size_t index;
    pass_name out = {-1, -1, -1, (int16_t)pass_find_image(p, name)};
    const pass_key key = pass_find_key(p, name, &index);
    if (key == PASS_UNIFORM) out.uniform = (int16_t)index;
    if (key == PASS_OPTION) out.option = (int16_t)index;
    if (key == PASS_FIELD) out.field = (int16_t)index;
    return out;
}

void pass_find_names(pass *p) {
    const kernel_names names = pass_names_of(p);
    pass_name *found = arena_alloc(p->host->memory, (names.count + 1) * sizeof *found);
    for (size_t i = 0; i < names.count; i++) found[i] = find_name(p, names.items[i]);
    p->names = found;
    p->density = find_name(p, "density").field;
}

// A type that asks for what its shader does not declare.
static size_t known(const pass *p, int name, int index, const char *what) {
    if (index >= 0) return (size_t)index;
    log_write(LOG_ERROR, "%s declares no %s '%s'", p->shader, what, pass_names_of(p).items[name]);
    abort();
}

size_t pass_image_index(const pass *p, const char *name) {
    const int index = pass_find_image(p, name);
    if (index >= 0) return (size_t)index;
    log_write(LOG_ERROR, "%s declares no image '%s'", p->shader, name);
    abort();
}

const float *pass_vector(const pass *p, int name) {
    return p->values[known(p, name, p->names[name].uniform, "uniform")];
}

float pass_value(const pass *p, int name) {
    return pass_vector(p, name)[0];
}

bool pass_evaluate_now(const pass *p, int name, float out[4]) {
    return pass_evaluate_at(p, known(p, name, p->names[name].uniform, "uniform"), out);
}

size_t pass_option(const pass *p, int name) {
    return p->options[known(p, name, p->names[name].option, "option")];
}

static const char *option_word(const pass *p, int name) {
    const size_t index = known(p, name, p->names[name].option, "option");
    return p->face->options[index].words[p->options[index]];
}

bool pass_option_is(const pass *p, int name, const char *word) {
    return strcmp(option_word(p, name), word) == 0;
}

uint32_t pass_option_number(const pass *p, int name) {
    return (uint32_t)strtoul(option_word(p, name), NULL, 10);
}

const field *pass_given_field(const pass *p, int name) {
    return p->fields[known(p, name, p->names[name].field, "field")];
}

bool pass_gives(const pass *p, int name) {
    const size_t index = known(p, name, p->names[name].uniform, "uniform");
    const value_desc *declared;
    return p->uniforms[index] || pass_inherited_uniform(p, index, &declared);
}

bool pass_may_be(const pass *p, int name, float limit, bool above) {
    const size_t index = known(p, name, p->names[name].uniform, "uniform");
    const value_desc *declared = &p->face->uniforms[index];
    const field *node = p->uniforms[index];
    if (!node) node = pass_inherited_uniform(p, index, &declared);
    if (node && !field_is_constant(node)) return true; // it moves
    return ((node ? node->value[0] : declared->value[0]) > limit) == above;
}

graph_image *pass_image(const pass *p, int name) {
    return &p->images[known(p, name, p->names[name].image, "image")];
}

gpu_image *pass_get_image(const pass *p, int name) {
    return graph_get_image(p->host->graph, *pass_image(p, name));
}
