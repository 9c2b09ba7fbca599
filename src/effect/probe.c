// What is under a pointer: the effect's media along a ray, and what its grids hold at the point
// that is seen there.
#include "pass/march/probe.h"
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include "effect/events.h"
#include "effect/things.h"
#include <string.h>

void effect_note_reading(effect *e, const field_grid *grid, const char *name, const field *node) {
    const char *label = grid->label ? grid->label : grid->name;
    const char *whole = arena_format(&e->memory, "%s.%s", label, name);
    for (size_t i = 0; i < e->reading_count; i++)
        if (strcmp(e->readings[i].name, whole) == 0) return;
    if (e->reading_count == EFFECT_MAX_READINGS) return;
    if (!e->readings)
        e->readings = arena_alloc(&e->memory, EFFECT_MAX_READINGS * sizeof *e->readings);
    e->readings[e->reading_count++] = (effect_reading){whole, node};
}

static bool has_medium(const pass *p, const field **density) {
    static const char *const types[] = {"march", "lighting", "stack", "reference"};
    size_t index;
    bool one = false;
    for (size_t i = 0; i < COUNT_OF(types); i++) one = one || pass_is(p, types[i]);
    *density =
        one && pass_find_key(p, "density", &index) == PASS_FIELD ? pass_get_field(p, index) : NULL;
    return *density;
}

// The sum of all media, each once. NULL with a message.
static const field *all_media(effect *e) {
    const field *sum = NULL;
    for (size_t i = 0; i < e->pass_count; i++) {
        const field *density, *other;
        if (!has_medium(e->passes[i], &density)) continue;
        bool known = false;
        for (size_t k = 0; k < i && !known; k++)
            known = has_medium(e->passes[k], &other) && other == density;
        const field *args[FIELD_MAX_ARGS] = {sum, density};
        if (!known) sum = sum ? field_make(&e->memory, "add", args, NULL) : density;
        if (!sum) return NULL;
    }
    if (!sum) err_set("%s: nothing fills its space", e->facts.name);
    return sum;
}

// What failed once fails again: it is tried once.
static bool make_probe(effect *e) {
    if (e->probe) return true;
    if (e->no_probe) return err_set("%s", e->no_probe);
    const field *density = all_media(e), *values[PASS_PROBE_VALUES];
    if (!density) {
        e->no_probe = arena_string(&e->memory, err_get());
        return false;
    }
    for (size_t i = 0; i < e->reading_count && e->probed_count < PASS_PROBE_VALUES; i++) {
        if (!pass_probe_sees(&e->host, e->readings[i].node)) continue;
        e->probed[e->probed_count] = &e->readings[i];
        values[e->probed_count++] = e->readings[i].node;
    }
    e->probe = pass_probe_create(&e->host, density, values, e->probed_count);
    if (!e->probe) e->no_probe = arena_string(&e->memory, err_get());
    return e->probe;
}

bool effect_probe(effect *e, float x, float y, effect_probed *out) {
    float origin[3], way[3], found[1 + PASS_PROBE_VALUES][4];
    *out = (effect_probed){0};
    if (!e->counter) return err_set("%s: render a frame first", e->facts.name);
    if (!make_probe(e) || !effect_camera_ray(e, x, y, origin, way)) return false;
    glm_vec3_normalize(way);
    if (!pass_probe_look(e->probe, origin, way, found)) return false;
    out->found = found[0][3] >= 0;
    memcpy(out->at, found[0], sizeof out->at);
    out->density = found[0][3];
    out->count = e->probed_count;
    for (size_t i = 0; i < out->count; i++) {
        out->values[i].name = e->probed[i]->name;
        out->values[i].components = e->probed[i]->node->components;
        memcpy(out->values[i].value, found[1 + i], sizeof out->values[i].value);
    }
    return true;
}
