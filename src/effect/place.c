// Where in its files the script makes what has controls, so that values can be written back.
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <string.h>

typedef struct noted_place {
    const void *made;
    effect_place place;
} noted_place;

void effect_note_place(effect *e, const void *made, const char *file, int line, const char *call) {
    const char *last = e->place_count ? e->places[e->place_count - 1].place.file : "";
    if (strcmp(last, file) != 0) last = arena_string(&e->memory, file);
    *MEM_ADD(e->places, e->place_count, e->place_capacity) =
        (noted_place){made, {last, line, call}};
}

const effect_place *effect_find_place(const effect *e, const void *made) {
    for (size_t i = e->place_count; made && i-- > 0;)
        if (e->places[i].made == made) return &e->places[i].place;
    return NULL;
}

static const void *made_by_script(const effect *e, const control *c) {
    switch (c->face.kind) {
    case EFFECT_CONTROL_PARAM:
        return e->params[c->face.index];
    case EFFECT_CONTROL_PALETTE:
        return c->palette;
    case EFFECT_CONTROL_CURVE:
        return c->palette ? (const void *)c->palette : c->curve;
    case EFFECT_CONTROL_SCENE:
    case EFFECT_CONTROL_LIGHT:
    case EFFECT_CONTROL_MATERIAL:
    case EFFECT_CONTROL_PLACE:
        return c->face.moved ? c->original : *c->slot;
    case EFFECT_CONTROL_FIELD:
        return c->nodes[0];
    case EFFECT_CONTROL_LOADED:
        return c->owner;
    case EFFECT_CONTROL_UNIFORM:
    case EFFECT_CONTROL_OPTION:
    case EFFECT_CONTROL_SCALE:
        return e->passes[c->face.pass];
    case EFFECT_CONTROL_EVENTS:
        break;
    }
    return NULL;
}

const effect_place *effect_control_place(const effect *e, const effect_control *c) {
    const effect_place *own = effect_find_place(e, made_by_script(e, (const control *)c));
    // A value that the script leaves open belongs where it gives another of the same object.
    for (size_t i = 0; !own && c->kind >= EFFECT_CONTROL_SCENE && i < e->control_count; i++) {
        const control *other = e->controls[i];
        if (other->face.kind == c->kind && strcmp(other->face.group, c->group) == 0)
            own = effect_find_place(e, made_by_script(e, other));
    }
    return own ? own : effect_find_place(e, ((const control *)c)->owner);
}
