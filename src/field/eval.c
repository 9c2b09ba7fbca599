// Evaluating fields on the host by the kinds' C twins. Expressions are graphs with shared nodes;
// large ones remember each node's value at each point, so that the cost is that of the graph, not
// of the tree it unfolds to. Recursion is bounded by FIELD_MAX_DEPTH.
#include "base/error.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/kinds.h"
#include <math.h>
#include <string.h>

enum { REMEMBER_FROM = 64 }; // nodes as a tree

typedef struct evaluation {
    const field_context *context;
    bool remembers;
    map places; // (node, point) -> index of the value
    float (*values)[4];
    size_t count, capacity;
    uint32_t points; // handed out so far
} evaluation;

static bool eval(evaluation *e, const field *node, float3 p, uint32_t point, float out[4]);

size_t kind_arg_count(const field *node) {
    size_t count = 0;
    while (count < FIELD_MAX_ARGS && node->args[count]) count++;
    return count;
}

int kind_arg_width(const field *node, size_t arg) {
    if (kind_of(node) == KIND_GLSL) return node->args[arg]->components;
    if (node->kind->args[arg].desc.name && node->kind->args[arg].desc.components > 0)
        return node->kind->args[arg].desc.components;
    int width = 1;
    for (size_t i = 0; i < FIELD_MAX_ARGS && node->args[i]; i++) {
        bool fixed = node->kind->args[i].desc.name && node->kind->args[i].desc.components > 0;
        if (!fixed && node->args[i]->components > width) width = node->args[i]->components;
    }
    return width;
}

static bool eval_args(evaluation *e, const field *node, float3 p, uint32_t point, size_t first,
                      float out[][4]) {
    for (size_t i = first; i < FIELD_MAX_ARGS && node->args[i]; i++) {
        if (!eval(e, node->args[i], p, point, out[i])) return false;
        for (int c = 1; node->args[i]->components == 1 && c < 4; c++) out[i][c] = out[i][0];
    }
    return true;
}

static bool eval_param(const field *node, const field_context *context, float out[4]) {
    if ((size_t)node->index >= context->param_count)
        return err_set("parameter %d does not exist; there are %zu", node->index,
                       context->param_count);
    memcpy(out, context->params[node->index], 4 * sizeof *out);
    return true;
}

static bool eval_call(const field *node, const field_context *context, float out[4]) {
    if (!context->call) return err_set("functions of the time cannot be called here");
    if (!context->call(context->user, node->index, context->time, out)) return false;
    for (int c = 0; c < node->components; c++)
        if (!isfinite(out[c]))
            return err_set("a function of the time gave a number that is not finite");
    return true;
}

static bool eval_grid(const field *node, float3 p, float out[4]) {
    const field_grid *grid = node->object;
    if (!grid->sample)
        return err_set("grid '%s' keeps no values on the host", grid->name ? grid->name : "?");
    for (int c = 0; c < node->components; c++)
        if (!grid->sample(grid, p, node->index + c, &out[c])) return false;
    return true;
}

static bool eval_moved(evaluation *e, const field *node, float3 p, uint32_t point, float out[4]) {
    float args[FIELD_MAX_ARGS][4];
    if (!eval_args(e, node, p, point, 1, args)) return false;
    float3 at;
    if (kind_of(node) == KIND_WARP) {
        at = (float3){p.x + args[2][0] * args[1][0], p.y + args[2][0] * args[1][1],
                      p.z + args[2][0] * args[1][2]};
    } else {
        float m[3][4], back[3][4];
        kind_transform_matrix(args[1], args[2], args[3], m, back);
        at.x = m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3];
        at.y = m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3];
        at.z = m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3];
    }
    return eval(e, node->args[0], at, ++e->points, out);
}

static bool eval_now(evaluation *e, const field *node, float3 p, uint32_t point, float out[4]) {
    float args[FIELD_MAX_ARGS][4];
    switch (kind_of(node)) {
    case KIND_PARAM:
        return eval_param(node, e->context, out);
    case KIND_CURVE:
        curve_eval(node->object, e->context->time, out);
        return true;
    case KIND_CALL:
        return eval_call(node, e->context, out);
    case KIND_TIME:
        out[0] = (float)e->context->time;
        return true;
    case KIND_GRID:
        return eval_grid(node, p, out);
    case KIND_WARP:
    case KIND_TRANSFORM:
        return eval_moved(e, node, p, point, out);
    case KIND_GLSL:
        return err_set("the GLSL function '%s' cannot be evaluated on the host",
                       ((const field_glsl *)node->object)->function);
    default:
        if (!eval_args(e, node, p, point, 0, args)) return false;
        node->kind->eval(node, e->context, p, (const float(*)[4])args, out);
        return true;
    }
}

static bool eval(evaluation *e, const field *node, float3 p, uint32_t point, float out[4]) {
    memset(out, 0, 4 * sizeof *out);
    if (!e->remembers || !node->args[0]) return eval_now(e, node, p, point, out);
    const uint32_t *place = map_find(&e->places, node, point);
    if (place) {
        memcpy(out, e->values[*place], 4 * sizeof *out);
        return true;
    }
    if (!eval_now(e, node, p, point, out)) return false;
    MEM_RESERVE(e->values, e->count + 1, e->capacity);
    memcpy(e->values[e->count], out, 4 * sizeof *out);
    map_set(&e->places, node, point, (uint32_t)e->count++);
    return true;
}

bool field_eval(const field *node, const field_context *context, float3 p, float out[4]) {
    evaluation e = {.context = context, .remembers = node->size > REMEMBER_FROM};
    bool ok = eval(&e, node, p, 0, out);
    map_free(&e.places);
    mem_free(e.values);
    return ok;
}

bool kind_uniform_arg(const field *node, size_t arg, const field_context *context, float out[4]) {
    const field *value = node->args[arg];
    if (!value->uniform || !field_eval(value, context, (float3){0, 0, 0}, out)) return false;
    for (int c = 1; value->components == 1 && c < 4; c++) out[c] = out[0];
    return true;
}
