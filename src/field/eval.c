// Evaluating fields on the host by the kinds' C twins. Expressions are graphs with shared nodes;
// large ones remember each node's value at each point, so that the cost is that of the graph, not
// of the tree it unfolds to. Recursion is bounded by FIELD_MAX_DEPTH.
#include "base/error.h"
#include "base/map.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/kinds.h"
#include "shared.h"
#include <math.h>
#include <string.h>

enum { REMEMBER_FROM = 64 }; // nodes as a tree
enum { TOGETHER = 16 };      // instances: their values are on the stack

// Where a field is evaluated. What does not vary in space is evaluated NOWHERE, once for all.
typedef struct points {
    const float3 *at;
    const struct instance_entry *instances; // one for each point; NULL: that of the context
    size_t count;
    uint32_t set; // tells these points from others of the evaluation
} points;

enum { NOWHERE, FIRST_SET };

typedef struct evaluation {
    const field_context *context;
    bool remembers;
    map places; // (node, set of points) -> index of the first value
    float (*values)[4];
    size_t count, capacity;
    uint32_t sets; // handed out so far
} evaluation;

static bool eval(evaluation *e, const field *node, const points *p, float (*out)[4]);

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

// Widened to four components.
static bool eval_arg(evaluation *e, const field *arg, const points *p, float (*out)[4]) {
    const points nowhere = {.at = p->at, .count = 1, .set = NOWHERE};
    const points *at = arg->uniform ? &nowhere : p;
    if (!eval(e, arg, at, out)) return false;
    for (size_t i = 0; i < at->count && arg->components == 1; i++)
        out[i][1] = out[i][2] = out[i][3] = out[i][0];
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

static bool eval_grid(const field *node, const points *p, float (*out)[4]) {
    const field_grid *grid = node->object;
    if (!grid->sample)
        return err_set("grid '%s' keeps no values on the host", grid->name ? grid->name : "?");
    for (size_t i = 0; i < p->count; i++)
        for (int c = 0; c < node->components; c++)
            if (!grid->sample(grid, p->at[i], node->index + c, &out[i][c])) return false;
    return true;
}

// Where a node that moves space samples its first argument; `args` are of one point.
static float3 moved(const field *node, float3 p, const float (*args)[4]) {
    if (kind_of(node) == KIND_WARP)
        return (float3){p.x + args[2][0] * args[1][0], p.y + args[2][0] * args[1][1],
                        p.z + args[2][0] * args[1][2]};
    float m[3][4], back[3][4];
    kind_transform_matrix(args[1], args[2], args[3], m, back);
    return (float3){m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
                    m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
                    m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

// By the values of its arguments, in columns of one row for each point.
static void compute(const evaluation *e, const field *node, const points *p, size_t first,
                    float (*columns)[4], float3 *to, float (*out)[4]) {
    float row[FIELD_MAX_ARGS][4];
    size_t varying[FIELD_MAX_ARGS], count = 0;
    const float(*args)[4] = (const float(*)[4])(p->count == 1 ? columns : row);
    field_context here;
    field_point at = {.node = node, .context = p->instances ? &here : e->context};
    if (p->instances) here = *e->context;
    for (size_t a = first; a < FIELD_MAX_ARGS && node->args[a] && p->count > 1; a++) {
        memcpy(row[a], columns[a * p->count], sizeof row[a]);
        if (!node->args[a]->uniform) varying[count++] = a;
    }
    for (size_t i = 0; i < p->count; i++) {
        for (size_t k = 0; k < count; k++)
            memcpy(row[varying[k]], columns[varying[k] * p->count + i], sizeof *row);
        if (p->instances) here.instance = &p->instances[i];
        at.p = p->at[i];
        if (to)
            to[i] = moved(node, at.p, args);
        else
            node->kind->eval(&at, args, out[i]);
    }
}

static bool eval_by_args(evaluation *e, const field *node, const points *p, float (*columns)[4],
                         float3 *to, float (*out)[4]) {
    const bool moves = kind_of(node) == KIND_WARP || kind_of(node) == KIND_TRANSFORM;
    const size_t first = moves ? 1 : 0;
    for (size_t a = first; a < FIELD_MAX_ARGS && node->args[a]; a++)
        if (!eval_arg(e, node->args[a], p, &columns[a * p->count])) return false;
    compute(e, node, p, first, columns, moves ? to : NULL, out);
    if (!moves) return true;
    const points there = {to, p->instances, p->count, ++e->sets};
    return eval(e, node->args[0], &there, out);
}

static bool eval_alone(evaluation *e, const field *node, const points *p, float (*out)[4]) {
    float columns[FIELD_MAX_ARGS][4];
    float3 to;
    return eval_by_args(e, node, p, columns, &to, out);
}

static bool eval_together(evaluation *e, const field *node, const points *p, float (*out)[4]) {
    float columns[FIELD_MAX_ARGS * TOGETHER][4];
    float3 to[TOGETHER];
    return eval_by_args(e, node, p, columns, to, out);
}

static bool eval_now(evaluation *e, const field *node, const points *p, float (*out)[4]) {
    switch (kind_of(node)) {
    case KIND_CONSTANT:
        memcpy(out[0], node->value, sizeof node->value);
        return true;
    case KIND_PARAM:
        return eval_param(node, e->context, out[0]);
    case KIND_CURVE:
        curve_eval(node->object, e->context->time, out[0]);
        return true;
    case KIND_CALL:
        return eval_call(node, e->context, out[0]);
    case KIND_TIME:
        out[0][0] = (float)e->context->time;
        return true;
    case KIND_GRID:
        return eval_grid(node, p, out);
    case KIND_GLSL:
        return err_set("the GLSL function '%s' cannot be evaluated on the host",
                       ((const field_glsl *)node->object)->function);
    default:
        return p->count == 1 ? eval_alone(e, node, p, out) : eval_together(e, node, p, out);
    }
}

static bool eval(evaluation *e, const field *node, const points *p, float (*out)[4]) {
    memset(out, 0, p->count * sizeof *out);
    if (!e->remembers || !node->args[0]) return eval_now(e, node, p, out);
    const uint32_t *place = map_find(&e->places, node, p->set);
    if (place) {
        memcpy(out, e->values[*place], p->count * sizeof *out);
        return true;
    }
    if (!eval_now(e, node, p, out)) return false;
    MEM_RESERVE(e->values, e->count + p->count, e->capacity);
    memcpy(e->values[e->count], out, p->count * sizeof *out);
    map_set(&e->places, node, p->set, (uint32_t)e->count);
    e->count += p->count;
    return true;
}

static bool field_eval_points(const field *node, const field_context *context, const points *p,
                              float (*out)[4]) {
    evaluation e = {.context = context, .remembers = node->size > REMEMBER_FROM, .sets = FIRST_SET};
    const bool done = eval(&e, node, p, out);
    map_free(&e.places);
    mem_free(e.values);
    return done;
}

bool field_eval(const field *node, const field_context *context, float3 p, float out[4]) {
    const points at = {.at = &p, .count = 1, .set = node->uniform ? NOWHERE : FIRST_SET};
    return field_eval_points(node, context, &at, (float(*)[4])out);
}

bool field_eval_instances(const field *node, const field_context *context,
                          const struct instance_entry *entries, size_t count, float (*out)[4]) {
    float3 at[TOGETHER];
    for (size_t first = 0; first < count; first += TOGETHER) {
        const size_t here = count - first < TOGETHER ? count - first : TOGETHER;
        const points p = {at, entries + first, here, FIRST_SET};
        for (size_t i = 0; i < here; i++) memcpy(&at[i], p.instances[i].place.v, sizeof at[i]);
        if (node->uniform) {
            if (first == 0 && !field_eval(node, context, at[0], out[0])) return false;
            for (size_t i = 0; i < here; i++) memcpy(out[first + i], out[0], sizeof *out);
        } else if (!field_eval_points(node, context, &p, out + first)) {
            return false;
        }
    }
    return true;
}

bool kind_uniform_arg(const field *node, size_t arg, const field_context *context, float out[4]) {
    const field *value = node->args[arg];
    if (!value->uniform || !field_eval(value, context, (float3){0, 0, 0}, out)) return false;
    for (int c = 1; value->components == 1 && c < 4; c++) out[c] = out[0];
    return true;
}
