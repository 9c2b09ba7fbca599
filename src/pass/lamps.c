// Lamps: their fields, evaluated once for each and frame into an image.
#include "pass/lamps.h"
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

enum { TEXELS = 4 }; // of a light_entry

typedef struct lamps_state {
    uint32_t count;
    scene_instances *at; // NULL: they stand for themselves
} lamps_state;

static lamps_state *state_of(const pass *p) {
    return p->state;
}

bool pass_lamps_open(pass *p, uint32_t count, scene_instances *at) {
    if (at) count = scene_instances_count(at);
    if (count < 1 || count > PASS_LAMPS_MOST)
        return err_set("%s: %s %u; 1 to %d are accepted", p->label,
                       at ? "the instances of 'at' are" : "'count' is", count, PASS_LAMPS_MOST);
    lamps_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->count = count;
    s->at = at;
    return true;
}

// Of what does not move: the device keeps the rest from 0 on.
static bool check_constants(const pass *p) {
    const shader_interface *interface = pass_interface(p);
    for (size_t i = 0; i < interface->field_count; i++) {
        const char *name = interface->fields[i].name;
        const field *value = pass_get_field(p, i);
        if (!value || strcmp(value->kind->name, "constant") != 0 || strcmp(name, "position") == 0)
            continue;
        for (int c = 0; c < value->components; c++)
            if (!(value->value[c] >= 0))
                return err_set("%s: '%s' is %g; accepted: 0 and above", p->label, name,
                               (double)value->value[c]);
    }
    return true;
}

bool lamps_declare(pass *p) {
    if (!check_constants(p)) return false;
    int output = pass_find_image(p, "lamps");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.lamps", p->label),
                            .format = p->formats[output],
                            .width = TEXELS,
                            .height = state_of(p)->count,
                        });
    return p->images[output].id && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool compile(pass *p) {
    const shader_define at = {"LAMPS_AT", state_of(p)->at ? "1" : "0"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, &at, 1, &p->binary);
}

bool lamps_check(pass *p) {
    return compile(p);
}

bool lamps_build(pass *p) {
    if (!compile(p)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    return p->pipeline != NULL;
}

bool lamps_allocate(pass *p) {
    scene_instances *at = state_of(p)->at;
    return !at || scene_instances_allocate(at, p->host->device);
}

bool lamps_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const lamps_state *s = state_of(p);
    mat4 group;
    float tint[4];
    pass_write_member(binary, block, "lamp_total", &s->count, sizeof s->count);
    if (!s->at) return true;
    if (!scene_instances_place(s->at, p->host->context, group, tint)) return false;
    pass_write_member(binary, block, "lamp_group", group, sizeof group);
    return true;
}

bool lamps_record(pass *p) {
    const lamps_state *s = state_of(p);
    const pass_override at = {.name = "Instances",
                              .binding = {.buffer = s->at ? scene_instances_buffer(s->at) : NULL}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = p->pipeline, .bindings = bindings, .threads = {s->count, 1, 1}};
    return pass_prepare(p) &&
           pass_bind(p, &p->binary, p->block, &at, 1, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}
