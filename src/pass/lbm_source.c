// Sources of simulated air: passes of the type `lbm_source`, which the air's pass runs before each
// of its steps, over the cells of their box.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/lbm_parts.h"
#include <math.h>
#include <string.h>

typedef struct source_state {
    lbm_air *air;
    uint8_t first_id;         // of its meshes; 0: it has none
    float first[3], count[3]; // cells of its box as of now
} source_state;

static const field *shape_of(const pass *p) {
    size_t index;
    return pass_find_key(p, "shape", &index) == PASS_FIELD ? p->fields[index] : NULL;
}

bool lbm_source_declare(pass *p) {
    return shape_of(p) || p->mesh_count ||
           err_set("%s: it has no place; give it a mesh, or shape = sphere { ... }", p->label);
}

bool pass_lbm_add_source(pass *p, pass *source) {
    lbm_air *a = lbm_air_of(p);
    source_state *s = source->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (source_state){.air = a, .first_id = (uint8_t)(a->givers.count + 1)};
    size_t option;
    pass_find_key(source, "rule", &option);
    voxels_rule rule = (voxels_rule)source->options[option];
    for (size_t i = 0; i < source->mesh_count; i++)
        if (!lbm_air_add_body(a, &a->givers, source->meshes[i], rule)) return false;
    if (!source->mesh_count) s->first_id = 0;
    source->runs_in = p;
    MEM_RESERVE(a->sources, a->source_count + 1, a->source_capacity);
    a->sources[a->source_count++] = source;
    for (int i = 0; i < PASS_LBM_NAMES; i++) {
        size_t index;
        if (pass_find_key(source, pass_lbm_names[i], &index) == PASS_FIELD && source->fields[index])
            a->used[i] = true;
    }
    return true;
}

// ---- building ---------------------------------------------------------------------------------

static bool compile(pass *p) {
    const source_state *s = p->state;
    shader_define defines[LBM_MAX_DEFINES + 1];
    size_t count = lbm_defines(s->air->solver, defines);
    defines[count++] = (shader_define){"MESHES", s->first_id ? "1" : "0"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &p->binary);
}

bool lbm_source_check(pass *p) {
    return compile(p);
}

bool lbm_source_build(pass *p) {
    if (!compile(p)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    return p->pipeline != NULL;
}

// ---- where it is ------------------------------------------------------------------------------

static bool mesh_box(const scene_mesh *mesh, const field_context *context, box3 *out) {
    const float corners[2][3] = {
        {mesh->data.box.min.x, mesh->data.box.min.y, mesh->data.box.min.z},
        {mesh->data.box.max.x, mesh->data.box.max.y, mesh->data.box.max.z}};
    mat4 place;
    if (!scene_mesh_transform(mesh, context, place)) return false;
    for (int i = 0; i < 8; i++) {
        vec3 p = {corners[i & 1][0], corners[i >> 1 & 1][1], corners[i >> 2][2]}, q;
        glm_mat4_mulv3(place, p, 1, q);
        box3 point = {{q[0], q[1], q[2]}, {q[0], q[1], q[2]}};
        if (i == 0) *out = point;
        out->min =
            (float3){fminf(out->min.x, q[0]), fminf(out->min.y, q[1]), fminf(out->min.z, q[2])};
        out->max =
            (float3){fmaxf(out->max.x, q[0]), fmaxf(out->max.y, q[1]), fmaxf(out->max.z, q[2])};
    }
    return true;
}

static bool box_of(const pass *p, box3 *out) {
    const field_context *context = p->host->context;
    *out = box3_infinite();
    if (shape_of(p) && !field_bounds(shape_of(p), context, out)) return false;
    box3 meshes = box3_empty();
    for (size_t i = 0; i < p->mesh_count; i++) {
        box3 one;
        if (!mesh_box(p->meshes[i], context, &one)) return false;
        meshes = i ? box3_union(meshes, one) : one;
    }
    if (p->mesh_count) *out = box3_intersect(*out, box3_grow(meshes, 1e-3f));
    return true;
}

// Cells whose middle the box may hold; none: false.
static bool find_cells(source_state *s, box3 box) {
    const lbm_air *a = s->air;
    box = box3_intersect(box, a->grid.box);
    if (box3_is_empty(box)) return false;
    float h = (float)a->desc.voxel_size;
    const float low[3] = {box.min.x - a->grid.box.min.x, box.min.y - a->grid.box.min.y,
                          box.min.z - a->grid.box.min.z};
    const float high[3] = {box.max.x - a->grid.box.min.x, box.max.y - a->grid.box.min.y,
                           box.max.z - a->grid.box.min.z};
    for (int i = 0; i < 3; i++) {
        float n = (float)a->desc.size[i];
        s->first[i] = clampf(floorf(low[i] / h - 0.5f), 0, n - 1);
        s->count[i] = clampf(ceilf(high[i] / h + 0.5f), 1, n) - s->first[i];
    }
    return true;
}

// ---- a step -----------------------------------------------------------------------------------

bool lbm_source_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const source_state *s = p->state;
    const lbm_air *a = s->air;
    double rate = (double)pass_evaluate(p, "rate");
    const float cell = (float)a->units.cell, speed = (float)sim_velocity(&a->units, 1);
    const float share = rate > 0 ? (float)sim_decay(&a->units, rate) : 1;
    const float ids[2] = {s->first_id, (float)s->first_id + (float)p->mesh_count - 1};
    const float pascal = (float)(1 / lbm_air_pascals(a));
    const uint32_t parity = lbm_parity(a->solver);
    pass_write_box(binary, block, a->grid.box);
    pass_write_member(binary, block, "cell_size", &cell, sizeof cell);
    pass_write_member(binary, block, "step_speed", &speed, sizeof speed);
    pass_write_member(binary, block, "pascal", &pascal, sizeof pascal);
    pass_write_member(binary, block, "share", &share, sizeof share);
    pass_write_member(binary, block, "ids", ids, sizeof ids);
    pass_write_member(binary, block, "first", s->first, sizeof s->first);
    pass_write_member(binary, block, "count", s->count, sizeof s->count);
    pass_write_member(binary, block, "lbm_parity", &parity, sizeof parity);
    return true;
}

static size_t override(const pass *p, pass_override out[GPU_MAX_SLOTS]) {
    const lbm_air *a = ((const source_state *)p->state)->air;
    size_t count = 0;
    for (size_t i = 0; i < p->binary.slot_count; i++) {
        const char *name = p->binary.slots[i].name;
        gpu_binding *binding = &out[count].binding;
        *binding = (gpu_binding){0};
        bool known = lbm_bind(a->solver, name, binding);
        if (!known && a->givers.cells) {
            if (strcmp(name, "SourceIds") == 0) binding->buffer = voxels_ids(a->givers.cells);
            if (strcmp(name, "SourceMotions") == 0)
                binding->buffer = voxels_motions(a->givers.cells);
            known = binding->buffer != NULL;
        }
        out[count].name = name;
        count += known;
    }
    return count;
}

bool lbm_air_run_source(lbm_air *a, pass *p) {
    source_state *s = p->state;
    box3 box;
    if (!box_of(p, &box)) return err_prefix("%s: ", p->label);
    if (!find_cells(s, box)) return true;
    if (!pass_prepare(p)) return err_prefix("%s: ", p->label);
    pass_override overrides[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {.pipeline = p->pipeline, .bindings = bindings};
    uint32_t layers = a->desc.size[2] / (lbm_get_desc(a->solver)->precision == LBM_F16 ? 8 : 4);
    for (int i = 0; i < 3; i++) dispatch.threads[i] = (uint32_t)s->count[i];
    if (dispatch.threads[2] > layers) dispatch.threads[2] = layers;
    size_t count = override(p, overrides);
    return pass_bind(p, &p->binary, p->block, overrides, count, bindings,
                     &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}
