// Point lights: their fields, evaluated once for each and frame into an image.
#include "pass/light/point_lights.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include <string.h>

enum { TEXELS = 4 }; // of a light_entry

#define NAMES(NAME)                                                                                \
    NAME(point_lights), NAME(point_light_total), NAME(point_light_group), NAME(Instances)
KERNEL_NAMES(NAMES);

typedef struct point_lights_state {
    uint32_t count;
    scene_instances *at; // NULL: they stand for themselves
} point_lights_state;

static point_lights_state *state_of(const pass *p) {
    return p->state;
}

bool pass_point_lights_open(pass *p, uint32_t count, scene_instances *at) {
    if (at) count = scene_instances_count(at);
    if (count < 1 || count > PASS_POINT_LIGHTS_MOST)
        return err_set("%s: %s %u; 1 to %d are accepted", p->label,
                       at ? "the instances of 'at' are" : "'count' is", count,
                       PASS_POINT_LIGHTS_MOST);
    point_lights_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
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

static bool point_lights_declare(pass *p) {
    if (!check_constants(p)) return false;
    graph_image *point_lights = pass_image(p, N_point_lights);
    *point_lights = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.point_lights", p->label),
                            .format = p->formats[p->names[N_point_lights].image],
                            .width = TEXELS,
                            .height = state_of(p)->count,
                        });
    return point_lights->id && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool point_lights_defines(pass *p, size_t index, pass_defines *out) {
    (void)index;
    pass_define_flag(out, "POINT_LIGHTS_AT", state_of(p)->at);
    return true;
}

static bool point_lights_allocate(pass *p) {
    scene_instances *at = state_of(p)->at;
    return !at || scene_instances_allocate(at, p->host->device);
}

static bool point_lights_update(pass *p) {
    const point_lights_state *s = state_of(p);
    mat4 group;
    float tint[4];
    pass_set(p, N_point_light_total, &s->count, sizeof s->count);
    if (!s->at) return true;
    if (!scene_instances_place(s->at, p->host->context, group, tint)) return false;
    pass_set(p, N_point_light_group, group, sizeof group);
    return true;
}

static bool point_lights_record(pass *p) {
    const point_lights_state *s = state_of(p);
    kernel *k = pass_prepare(p) ? pass_use(p, 0) : NULL;
    if (!k) return false;
    if (s->at) kernel_bind_buffer(k, N_Instances, scene_instances_buffer(s->at));
    return kernel_run(k, p->host->device, s->count, 1, 1);
}

static const pass_kernel kernels[1];

const pass_type point_lights_type = {
    .name = "point_lights",
    .constructed = true,
    .shader = "pass/light/point_lights.comp",
    PASS_KERNELS,
    .unscaled = true,
    .declare = point_lights_declare,
    .defines = point_lights_defines,
    .allocate = point_lights_allocate,
    .update = point_lights_update,
    .record = point_lights_record,
};
