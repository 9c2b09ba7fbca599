// Whether what a tree says repeats after some seconds, from what it is made of.
//
// Numbers are compared at a few times with themselves later. A noise repeats where its phase and
// its drift have gone on by whole periods of its lattice, and a tile where the place that it is
// sampled at has gone on by whole sides of it. What is simulated or recorded is not known to.
#include "field/kinds.h"
#include "field/palette.h"
#include <math.h>
#include <string.h>

enum {
    TIMES = 5,
    PLACES = 4,
    FREQUENCY = 0,
    DRIFT = 6,
    PHASE = 7,
    PERIOD = 9,
    VALUE = 0,
    BY = 1,
    AMOUNT = 2
};
enum { MOST_VISITS = 20000, MOST_WARPS = 32 };

typedef struct search {
    const field_context *context;
    double seconds;
    strbuf *why;
    int visits;
    const field *warps[MOST_WARPS]; // and transforms around the node at hand, the outermost first
    int warp_count;
} search;

static bool refuse(search *s, const char *format, ...) PRINTF_LIKE(2, 3);
static bool refuse(search *s, const char *format, ...) {
    va_list list;
    char text[256];
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!s->why->length) strbuf_add(s->why, "%s", text);
    return false;
}

static bool repeats(search *s, const field *node);

static double time_of(const search *s, int k) {
    return s->context->time + s->seconds * (0.37 * k - floor(0.37 * k)); // well spread
}

// The value then, and after the seconds.
static bool both(search *s, const field *node, float3 p, int k, float now[4], float later[4]) {
    field_context at = *s->context;
    memset(now, 0, 4 * sizeof *now);
    memset(later, 0, 4 * sizeof *later);
    at.time = time_of(s, k);
    const bool done = field_eval(node, &at, p, now);
    at.time += s->seconds;
    return done && field_eval(node, &at, p, later);
}

static bool is_same(search *s, const field *node) {
    float now[4], later[4];
    for (int k = 0; k < TIMES; k++) {
        if (!both(s, node, (float3){0, 0, 0}, k, now, later)) return false;
        for (int c = 0; c < node->components; c++)
            if (!(fabsf(now[c] - later[c]) <= 1e-4f * fmaxf(1, fabsf(now[c])))) return false;
    }
    return true;
}

static bool is_whole(float moved, float period) {
    if (fabsf(moved) < 1e-3f) return true;
    return period > 0 && fabsf(moved / period - roundf(moved / period)) < 2e-3f;
}

// Seconds after which what moves by so much in the loop has gone on by a period; 0: never.
static double own_seconds(const search *s, float moved, float period) {
    return period > 0 && fabsf(moved) > 1e-6f ? s->seconds * (double)(period / fabsf(moved)) : 0;
}

static bool noise_fits(search *s, const field *node, const char *what, float moved, float period) {
    if (is_whole(moved, period)) return true;
    double seconds = own_seconds(s, moved, period);
    return seconds > 0
               ? refuse(s, "the %s of '%s' repeats every %.4g s", what, node->kind->name, seconds)
               : refuse(s, "the %s of '%s' goes on, and it has no period", what, node->kind->name);
}

static bool noise_repeats(search *s, const field *node) {
    float now[4], later[4], period[4], frequency[4];
    for (size_t i = 0; i < kind_arg_count(node); i++)
        if (i != DRIFT && i != PHASE && !repeats(s, node->args[i])) return false;
    if (!both(s, node->args[PERIOD], (float3){0, 0, 0}, 0, period, later) ||
        !both(s, node->args[FREQUENCY], (float3){0, 0, 0}, 0, frequency, later))
        return false;
    for (int k = 0; k < TIMES; k++) {
        if (!both(s, node->args[PHASE], (float3){0, 0, 0}, k, now, later)) return false;
        if (!noise_fits(s, node, "boiling", later[0] - now[0], period[0])) return false;
        if (!both(s, node->args[DRIFT], (float3){0, 0, 0}, k, now, later)) return false;
        for (int c = 0; c < 3; c++)
            if (!noise_fits(s, node, "drift", (later[c] - now[c]) * frequency[0], period[0]))
                return false;
    }
    return true;
}

// Where the warps around a node take a point, at one time.
static bool carry(const search *s, double time, float3 *p) {
    field_context at = *s->context;
    at.time = time;
    for (int i = 0; i < s->warp_count; i++) {
        const field *node = s->warps[i];
        float args[FIELD_MAX_ARGS][4] = {{0}}, m[3][4], back[3][4], out[3];
        const float v[3] = {p->x, p->y, p->z};
        for (size_t k = 1; k < kind_arg_count(node); k++) {
            if (!field_eval(node->args[k], &at, *p, args[k])) return false;
            for (int c = 1; node->args[k]->components == 1 && c < 4; c++) args[k][c] = args[k][0];
        }
        kind_transform_matrix(args[1], args[2], args[3], m, back);
        for (int c = 0; c < 3; c++)
            out[c] = kind_of(node) == KIND_WARP
                         ? v[c] + args[AMOUNT][0] * args[BY][c]
                         : m[c][0] * v[0] + m[c][1] * v[1] + m[c][2] * v[2] + m[c][3];
        *p = (float3){out[0], out[1], out[2]};
    }
    return true;
}

// What was baked knows nothing of what bends it where it is sampled.
static bool content_repeats(search *s, const field *content) {
    const int count = s->warp_count;
    s->warp_count = 0;
    const bool done = repeats(s, content);
    s->warp_count = count;
    return done;
}

// Wherever it is sampled, that place has gone on by whole sides of the tile.
static bool tile_repeats(search *s, const field_grid *tile) {
    const box3 *box = &tile->box;
    const float sides[3] = {box->max.x - box->min.x, box->max.y - box->min.y,
                            box->max.z - box->min.z};
    for (int k = 0; k < TIMES * PLACES; k++) {
        const float part = (float)(k % PLACES);
        float3 now = {0.7f * part, -0.4f * part, 0.9f * part}, later = now;
        if (!carry(s, time_of(s, k / PLACES), &now) ||
            !carry(s, time_of(s, k / PLACES) + s->seconds, &later))
            return refuse(s, "what bends a tile is not known");
        const float moved[3] = {later.x - now.x, later.y - now.y, later.z - now.z};
        for (int c = 0; c < 3; c++)
            if (!is_whole(moved[c], sides[c]))
                return refuse(s, "the drift of a tile repeats every %.4g s",
                              own_seconds(s, moved[c], sides[c]));
    }
    return !tile->content || content_repeats(s, tile->content);
}

// Of what depends on the place otherwise, all that bends it has to repeat.
static bool warps_repeat(search *s) {
    const int count = s->warp_count;
    for (int i = 0; i < count; i++) {
        s->warp_count = i;
        for (size_t k = 1; k < kind_arg_count(s->warps[i]); k++)
            if (!repeats(s, s->warps[i]->args[k])) return false;
    }
    s->warp_count = count;
    return true;
}

static bool warp_repeats(search *s, const field *node) {
    if (s->warp_count == MOST_WARPS) return refuse(s, "the effect is too large to tell");
    s->warps[s->warp_count++] = node;
    const bool done = repeats(s, node->args[VALUE]);
    s->warp_count--;
    return done;
}

static bool grid_repeats(search *s, const field_grid *grid) {
    if (grid->repeats) return tile_repeats(s, grid);
    if (!warps_repeat(s)) return false;
    if (grid->content) return content_repeats(s, grid->content);
    const char *name = grid->label ? grid->label : grid->name;
    return refuse(s, grid->simulated ? "'%s' is simulated" : "'%s' is recorded", name);
}

static bool repeats(search *s, const field *node) {
    if (s->visits++ > MOST_VISITS) return refuse(s, "the effect is too large to tell");
    if (node->uniform) {
        if (is_same(s, node)) return true;
        strbuf text = {0};
        field_print(node, &text);
        refuse(s, "%.80s goes on", strbuf_text(&text));
        strbuf_free(&text);
        return false;
    }
    if (kind_of(node) == KIND_GRID) return grid_repeats(s, node->object);
    if (kind_of(node) == KIND_PALETTE && palette_is_animated(node->object))
        return refuse(s, "a palette changes");
    if (strcmp(node->kind->group, "noise") == 0) return warps_repeat(s) && noise_repeats(s, node);
    if (kind_of(node) == KIND_WARP || kind_of(node) == KIND_TRANSFORM) return warp_repeats(s, node);
    if (node->kind->spatial && !warps_repeat(s)) return false;
    for (size_t i = 0; i < kind_arg_count(node); i++)
        if (!repeats(s, node->args[i])) return false;
    return true;
}

bool field_repeats(const field *node, const field_context *context, double seconds, strbuf *why) {
    search s = {.context = context, .seconds = seconds, .why = why};
    return repeats(&s, node);
}
