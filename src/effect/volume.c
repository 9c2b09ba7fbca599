// Volumes: fields of an effect on a lattice of cubes, to be read back. A grid of the effect gives
// its own voxels if they are cubes and no other size is asked for. The medium of a pass is sampled
// as finely as the finest grid below it. Each field is a bake of its own.
#include "base/error.h"
#include "effect/effect_impl.h"
#include <math.h>
#include <string.h>

enum { SIDE = 64, MOST_SIDE = 1024, MOST_FRAMES = 4096, MOST_GRIDS = 64 };

typedef struct source { // one of both
    field_grid *grid;
    pass *p;
} source;

// ---- finding it -------------------------------------------------------------------------------

static bool has_medium(const pass *p) {
    size_t index;
    return pass_find_key(p, "density", &index) == PASS_FIELD && pass_get_field(p, index);
}

static bool is_source(const field_grid *grid) {
    return grid->label && !grid->repeats;
}

static bool no_source(effect *e, const char *name) {
    strbuf all = {0};
    for (size_t i = 0; i < e->grid_count; i++)
        if (is_source(e->grids[i]))
            strbuf_add(&all, "%s%s", all.length ? ", " : "", e->grids[i]->label);
    for (size_t i = 0; i < e->pass_count; i++)
        if (has_medium(e->passes[i]))
            strbuf_add(&all, "%s%s", all.length ? ", " : "", pass_label(e->passes[i]));
    if (!all.length)
        err_set("%s: there is no volume in it: no grid, and no pass with a density", e->facts.file);
    else if (name)
        err_set("%s: no grid or medium '%s'; there are: %s", e->facts.file, name,
                strbuf_text(&all));
    else
        err_set("%s: no pass `march`; name one of: %s", e->facts.file, strbuf_text(&all));
    strbuf_free(&all);
    return false;
}

static bool find_source(effect *e, const char *name, source *out) {
    *out = (source){0};
    for (size_t i = 0; i < e->grid_count && !out->grid; i++)
        if (is_source(e->grids[i]) &&
            (name ? strcmp(e->grids[i]->label, name) == 0 : e->grids[i]->simulated))
            out->grid = e->grids[i];
    for (size_t i = 0; i < e->pass_count && !out->grid && !out->p; i++) {
        pass *p = e->passes[i];
        bool wanted = name ? strcmp(pass_label(p), name) == 0 : pass_is(p, "march");
        if (wanted && has_medium(p)) out->p = p;
    }
    return out->grid || out->p || no_source(e, name);
}

// ---- its fields -------------------------------------------------------------------------------

typedef struct chosen {
    const char *name;
    const field *node;
} chosen;

static const field *grid_field(effect *e, field_grid *grid, const char *name) {
    int components = grid->channel_count >= 3 ? 3 : 1, first = 0;
    if (grid->find_field)
        first = grid->find_field(grid, name, &components);
    else if (strcmp(name, grid->label) != 0)
        first = err_set("%s: no field '%s'; it has one, of its own name", grid->label, name) - 1;
    if (first < 0) return NULL;
    const field *node = field_grid_channel(&e->memory, grid, first, components);
    return strcmp(name, "velocity") == 0 ? field_of_effect_time(&e->memory, grid, node) : node;
}

static const field *medium_field(effect *e, const pass *p, const char *name) {
    size_t index;
    const field *node =
        pass_find_key(p, name, &index) == PASS_FIELD ? pass_get_field(p, index) : NULL;
    if (!node) return ERR_NULL("%s: field '%s' is not given there", pass_label(p), name);
    return node->components == 4 ? field_swizzle(&e->memory, node, "rgb") : node;
}

static bool choose_field(effect *e, const source *s, const char *name, chosen *list,
                         size_t *count) {
    for (size_t i = 0; i < *count; i++)
        if (strcmp(list[i].name, name) == 0) return err_set("field '%s' is named twice", name);
    if (*count == EFFECT_VOLUME_FIELDS) return err_set("more than %d fields", EFFECT_VOLUME_FIELDS);
    const field *node = s->grid ? grid_field(e, s->grid, name) : medium_field(e, s->p, name);
    list[*count] = (chosen){arena_string(&e->memory, name), node};
    return node && ++*count;
}

// Of a medium, only what varies in space is exported; the rest is a number, not a grid.
static bool choose_all(effect *e, const source *s, chosen *list, size_t *count) {
    const shader_interface *face = s->p ? pass_interface(s->p) : NULL;
    const char *name;
    if (s->grid && !s->grid->field_name) return choose_field(e, s, s->grid->label, list, count);
    for (size_t i = 0; s->grid && (name = s->grid->field_name(s->grid, i)); i++)
        if (!choose_field(e, s, name, list, count)) return false;
    for (size_t i = 0; face && i < face->field_count; i++) {
        const field *node = pass_get_field(s->p, i);
        if (node && !node->uniform && !choose_field(e, s, face->fields[i].name, list, count))
            return false;
    }
    return *count || err_set("%s: none of its fields varies in space; name them",
                             s->grid ? s->grid->label : pass_label(s->p));
}

static bool choose_named(effect *e, const source *s, const char *names, chosen *list,
                         size_t *count) {
    for (const char *at = names;; at++) {
        char name[64];
        size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof name)
            return err_set("fields '%s'; accepted: names with commas between", names);
        memcpy(name, at, length);
        name[length] = '\0';
        if (!choose_field(e, s, name, list, count)) return false;
        at += length;
        if (!*at) return true;
    }
}

// ---- its lattice ------------------------------------------------------------------------------

static float finest_side(const field_grid *grid) {
    const float extents[] = {grid->box.max.x - grid->box.min.x, grid->box.max.y - grid->box.min.y,
                             grid->box.max.z - grid->box.min.z};
    float side = INFINITY;
    if (grid->extruded) return grid->extruded->width / (float)grid->size[0];
    for (int i = 0; i < 3; i++) side = fminf(side, extents[i] / (float)grid->size[i]);
    return side;
}

bool effect_medium_box(effect *e, const field *density, double first, double last, box3 *out) {
    for (size_t i = 0; i < e->grid_count; i++) e->grids[i]->state.active = e->grids[i]->box;
    double step = fmax(1, (last - first) / MOST_FRAMES);
    field_context at = e->context;
    *out = box3_empty();
    for (double frame = first; frame <= last; frame += step) {
        box3 box;
        at.time = (frame - e->facts.first) / e->facts.fps;
        if (!field_bounds(density, &at, &box)) return false;
        *out = box3_union(*out, box);
    }
    if (box3_is_finite(*out) && !box3_is_empty(*out)) return true;
    return err_set("the density %s in these frames; give a box",
                   box3_is_empty(*out) ? "is zero everywhere" : "fills all of space");
}

static bool find_box(effect *e, const source *s, const effect_volume_desc *desc, box3 *box,
                     float *voxel) {
    size_t index, count = 1;
    const field_grid *grids[MOST_GRIDS] = {s->grid};
    *box = desc->box;
    *voxel = INFINITY;
    if (s->grid) {
        if (box3_is_empty(*box)) *box = s->grid->box;
    } else {
        pass_find_key(s->p, "density", &index);
        const field *density = pass_get_field(s->p, index);
        count = field_grids(density, grids, MOST_GRIDS);
        if (box3_is_empty(*box) && !effect_medium_box(e, density, desc->first, desc->last, box))
            return false;
    }
    for (size_t i = 0; i < count && i < MOST_GRIDS; i++)
        if (!grids[i]->repeats) *voxel = fminf(*voxel, finest_side(grids[i]));
    return true;
}

static bool make_lattice(effect *e, const source *s, const effect_volume_desc *desc,
                         effect_volume *out) {
    box3 box;
    if (!find_box(e, s, desc, &box, &out->voxel)) return false;
    const float *low = &box.min.x, *high = &box.max.x;
    float longest = fmaxf(fmaxf(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    if (desc->size > MOST_SIDE)
        return err_set("size %u; accepted: 1 to %d voxels", desc->size, MOST_SIDE);
    if (desc->size || !isfinite(out->voxel))
        out->voxel = longest / (float)(desc->size ? desc->size : SIDE);
    float end[3];
    for (int i = 0; i < 3; i++) {
        float side = ceilf((high[i] - low[i]) / out->voxel - 1e-3f);
        if (!(side <= MOST_SIDE))
            return err_set("%g voxels of %g m along one side; at most %d: give a size",
                           (double)side, (double)out->voxel, MOST_SIDE);
        out->size[i] = side > 1 ? (uint32_t)side : 1;
        end[i] = low[i] + (float)out->size[i] * out->voxel;
    }
    out->box = (box3){box.min, {end[0], end[1], end[2]}};
    return true;
}

// ---- all of it --------------------------------------------------------------------------------

// Returns whether the volume's voxels are those of the grid.
static bool is_same(const effect_volume *v, const field_grid *grid) {
    return grid && !grid->extruded && memcmp(v->size, grid->size, sizeof v->size) == 0 &&
           memcmp(&v->box.min, &grid->box.min, sizeof v->box.min) == 0 &&
           fabsf(v->box.max.x - grid->box.max.x) < 1e-3f * v->voxel &&
           fabsf(v->box.max.y - grid->box.max.y) < 1e-3f * v->voxel &&
           fabsf(v->box.max.z - grid->box.max.z) < 1e-3f * v->voxel;
}

static bool add_field(effect *e, const source *s, const chosen *c, effect_volume *out) {
    effect_bake_desc desc = {.box = out->box,
                             .sampling = is_same(out, s->grid) ? "nearest" : "linear"};
    memcpy(desc.size, out->size, sizeof desc.size);
    field_grid *grid = effect_add_bake(e, c->node, &desc);
    if (!grid) return false;
    out->fields[out->count++] =
        (effect_volume_field){.name = c->name,
                              .components = c->node->components,
                              .image = graph_find_image(e->graph, grid->name)};
    return true;
}

bool effect_add_volume(effect *e, const effect_volume_desc *desc, effect_volume *out) {
    chosen list[EFFECT_VOLUME_FIELDS];
    size_t count = 0;
    source s;
    *out = (effect_volume){0};
    if (!find_source(e, desc->source, &s)) return false;
    if (!(desc->fields ? choose_named(e, &s, desc->fields, list, &count)
                       : choose_all(e, &s, list, &count)) ||
        !make_lattice(e, &s, desc, out))
        return false;
    for (size_t i = 0; i < count; i++)
        if (!add_field(e, &s, &list[i], out)) return false;
    return true;
}

void effect_skip_pictures(effect *e) {
    e->unseen = true;
}
