// Effects made by the C interface alone, for tests. Their folder is tests/gpu/data; the camera
// stands at (0, -5, 0) and looks along +Y, without sun and sky.
#pragma once
#include "effect/effect.h"
#include "gpu_test.h"
#include <math.h>
#include <string.h>

static inline const field *number(effect *e, float value) {
    return field_constant(effect_memory(e), 1, (float[4]){value});
}

static inline const field *triple(effect *e, float x, float y, float z) {
    return field_constant(effect_memory(e), 3, (float[4]){x, y, z});
}

// Any kind of field by its arguments in order; those left out get their default.
#define make(e, kind, ...) effect_field(e, kind, (const field *const[FIELD_MAX_ARGS]){__VA_ARGS__})

static inline const field *effect_field(effect *e, const char *kind, const field *const *args) {
    const field *made = field_make(effect_memory(e), kind, args, NULL);
    gpu_test_ok(made);
    return made;
}

// A hard-edged box around the origin, 2 m wide, times `value`.
static inline const field *block(effect *e, const field *value) {
    const field *shape = make(e, "box", triple(e, 0, 0, 0), triple(e, 2, 2, 2), number(e, 0));
    return make(e, "mul", shape, value);
}

static inline const field *param(effect *e, const char *name, float value, float max) {
    int index = effect_add_param(e, &(effect_param){.desc = {.name = name,
                                                             .components = 1,
                                                             .value = {value},
                                                             .max = max,
                                                             .unit = "",
                                                             .help = ""}});
    gpu_test_ok(index >= 0);
    return field_param(effect_memory(e), 1, index);
}

static inline effect *open_effect(const effect_desc *more) {
    char file[4096], shaders[4096];
    snprintf(file, sizeof file, "%s/tests/gpu/data/test.lua", getenv("ROIL_SOURCE_DIR"));
    snprintf(shaders, sizeof shaders, "%s/shaders", getenv("ROIL_SOURCE_DIR"));
    effect_desc desc = *more;
    desc.file = file;
    desc.shader_root = shaders;
    effect *e = effect_create(&desc);
    gpu_test_ok(e);
    scene *s = effect_scene(e);
    s->camera.eye = triple(e, 0, -5, 0);
    s->camera.target = triple(e, 0, 0, 0);
    s->sun.strength = s->sky.strength = number(e, 0);
    return e;
}

static inline pass *add(effect *e, const char *type, const char *shader) {
    pass *p = effect_add_pass(e, type, shader, NULL);
    gpu_test_ok(p);
    return p;
}

// A march of `density` without light, every ray to its end. The output of the effect.
static inline pass *add_march(effect *e, const field *density) {
    pass *p = add(e, "march", NULL);
    gpu_test_ok(pass_set_field(p, "density", density));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(e, 0)));
    return p;
}

static inline void finish(effect *e, pass *p, uint32_t width, uint32_t height) {
    gpu_test_ok(pass_declare(p));
    gpu_test_ok(effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "color")));
    gpu_test_ok(effect_check_settings(e));
    gpu_test_ok(effect_build(e, width, height));
}

// RGBA of the effect's picture; free with mem_free.
static inline float *read_picture(effect *e) {
    graph_image picture = effect_get_picture(e, EFFECT_OUTPUT);
    gpu_image *image = graph_get_image(effect_graph(e), picture);
    const gpu_image_desc *desc = gpu_image_get_desc(image);
    size_t count = (size_t)desc->width * desc->height * 4;
    uint16_t *halves = mem_alloc(count * 2);
    gpu_test_ok(gpu_image_read(effect_pass_host(e)->device, image, halves, count * 2));
    float *out = mem_alloc(count * sizeof *out);
    for (size_t i = 0; i < count; i++) out[i] = half_to_float(halves[i]);
    mem_free(halves);
    return out;
}

// Renders a frame; channel `channel` of the middle pixel of a picture `size` wide and high.
static inline float middle(effect *e, double frame, uint32_t size, uint32_t channel) {
    gpu_test_ok(effect_render(e, frame, false));
    float *pixels = read_picture(e);
    float value = pixels[4 * (size / 2 * size + size / 2) + channel];
    mem_free(pixels);
    return value;
}
