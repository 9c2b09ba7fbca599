// A walk over a lattice of rungs. Cost and error are taken to be nearly monotonous on each axis and
// nearly additive between axes, which what is measured then corrects:
//
// 1. From the start, while the limit is not kept: the step is taken that helps most for what it
//    spends. 2. Then, as long as the limit is kept: the step that gains most for what it spends.
//    Both are greedy marginal analysis, evaluated lazily (Minoux, "Accelerated Greedy Algorithms
//    for Maximizing Submodular Set Functions", 1978): a step's worth hardly grows as the walk goes
//    on, so that only the one that looks best is measured again.
// 3. Exchanges around where that ends: up on one axis and down on another, those first whose sum of
//    known differences promises most. After each that succeeds, 2 again.
//
// Every point is measured once.
#include "bench/search.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

enum { LONGEST_STEP = 3, MAX_EXCHANGES = 256 };
static const double SAME_ERROR = 0.005, SLACK = 0.1; // parts; the latter of what is only predicted

typedef struct walk {
    const search_desc *desc;
    search_point points[SEARCH_MAX_POINTS];
    size_t count;
    bool stopped;
    search_point at;
} walk;

typedef struct difference {
    double cost, error;
} difference;

// ---- points -------------------------------------------------------------------------------------

static bool same_place(const walk *w, const search_point *a, const search_point *b) {
    return memcmp(a->rungs, b->rungs, w->desc->axis_count * sizeof *a->rungs) == 0;
}

// Measures a point. False when the search must end.
static bool walk_visit(walk *w, search_point *p) {
    for (size_t i = 0; i < w->count; i++)
        if (same_place(w, &w->points[i], p)) {
            *p = w->points[i];
            return true;
        }
    if (w->stopped || w->count == SEARCH_MAX_POINTS || !w->desc->measure(w->desc->user, p)) {
        w->stopped = true;
        return false;
    }
    w->points[w->count++] = *p;
    return true;
}

static bool within(const walk *w, const search_point *p) {
    return (w->desc->by_error ? p->error : p->cost) <= w->desc->limit;
}

// Returns the point `by` rungs away. False when there is none.
static bool step_to(const walk *w, const search_point *from, size_t axis, int by,
                    search_point *out) {
    *out = *from;
    size_t rung = from->rungs[axis];
    if (by < 0 ? rung < (size_t)-by : rung + (size_t)by >= w->desc->axes[axis].count) return false;
    out->rungs[axis] = by < 0 ? rung - (size_t)-by : rung + (size_t)by;
    return true;
}

// ---- greedy steps -------------------------------------------------------------------------------

// Returns the gain of a step relative to its cost; 0 when it gains nothing.
static double worth(const walk *w, const search_point *to, bool up) {
    double saved = w->at.cost - to->cost, lost = to->error - w->at.error;
    double gain = up ? -lost : saved, spent = up ? -saved : lost;
    double least = up ? SAME_ERROR * w->at.error : w->desc->noise * w->at.cost;
    if (!(gain > least)) return 0;
    double nothing = 1e-4 * (up ? w->at.cost : w->at.error) + 1e-12;
    return gain / fmax(spent, nothing);
}

typedef struct candidate {
    search_point to;
    double worth; // as far as it is known; INFINITY: not yet
    bool fresh;   // measured from where the walk is now
} candidate;

// A rung that changes nothing may be on the way to one that does.
static void walk_look(walk *w, size_t axis, bool up, bool until_within, candidate *c) {
    c->worth = 0;
    for (int far = 1; far <= LONGEST_STEP && c->worth <= 0; far++) {
        if (!step_to(w, &w->at, axis, up ? far : -far, &c->to) || !walk_visit(w, &c->to)) return;
        if (!until_within && !within(w, &c->to)) return;
        c->worth = worth(w, &c->to, up);
    }
    c->fresh = true;
}

// Takes steps in one direction: until the limit is kept, or as long as it is.
static void walk_go(walk *w, bool up, bool until_within) {
    candidate all[SEARCH_MAX_AXES];
    size_t count = w->desc->axis_count;
    for (size_t i = 0; i < count; i++) all[i] = (candidate){.worth = INFINITY};
    while (!w->stopped && !(until_within && within(w, &w->at))) {
        size_t best = 0;
        for (size_t i = 1; i < count; i++)
            if (all[i].worth > all[best].worth) best = i;
        if (all[best].worth <= 0) return;
        if (!all[best].fresh) {
            walk_look(w, best, up, until_within, &all[best]);
            continue;
        }
        w->at = all[best].to;
        for (size_t i = 0; i < count; i++) all[i].fresh = false;
    }
}

// ---- exchanges ----------------------------------------------------------------------------------

static bool differ_only(const walk *w, const search_point *a, const search_point *b, size_t axis) {
    for (size_t i = 0; i < w->desc->axis_count; i++)
        if (i != axis && a->rungs[i] != b->rungs[i]) return false;
    return true;
}

// Returns the effect of a step where it was measured last.
static bool known_step(const walk *w, size_t axis, size_t from, size_t to, difference *out) {
    for (size_t i = w->count; i-- > 0;)
        for (size_t k = w->count; k-- > 0;) {
            const search_point *a = &w->points[i], *b = &w->points[k];
            if (a->rungs[axis] != from || b->rungs[axis] != to || !differ_only(w, a, b, axis))
                continue;
            difference d = {b->cost - a->cost, b->error - a->error};
            if (!isfinite(d.cost) || !isfinite(d.error)) return false;
            *out = d;
            return true;
        }
    return false;
}

// Returns the sum of known steps; an unknown one is assumed to equal its neighbour.
static bool known_steps(const walk *w, size_t axis, int by, difference *out) {
    size_t from = w->at.rungs[axis];
    search_point to;
    if (!step_to(w, &w->at, axis, by, &to)) return false;
    if (known_step(w, axis, from, to.rungs[axis], out)) return true;
    int one = by < 0 ? -1 : 1;
    difference last = {0};
    *out = last;
    for (int i = 0; i != by; i += one) {
        size_t at = (size_t)((int)from + i);
        if (!known_step(w, axis, at, (size_t)((int)at + one), &last) && i == 0) return false;
        out->cost += last.cost;
        out->error += last.error;
    }
    return true;
}

typedef struct exchange {
    search_point to;
    double promise; // by how much the part of what is minimised would fall
} exchange;

static void walk_consider(walk *w, size_t up, int far_up, size_t down, int far_down, exchange *all,
                          size_t *count) {
    difference a, b;
    if (*count == MAX_EXCHANGES || !known_steps(w, up, far_up, &a) ||
        !known_steps(w, down, -far_down, &b))
        return;
    // An axis that does nothing is no partner.
    if (w->desc->by_error ? a.error > -SAME_ERROR * w->at.error
                          : b.cost > -w->desc->noise * w->at.cost)
        return;
    double cost = w->at.cost + a.cost + b.cost, error = w->at.error + a.error + b.error;
    double limited = w->desc->by_error ? error : cost, aim = w->desc->by_error ? cost : error;
    double now = w->desc->by_error ? w->at.cost : w->at.error;
    double least = w->desc->by_error ? w->desc->noise : SAME_ERROR;
    if (limited > w->desc->limit * (1 + SLACK) || aim > now * (1 - least)) return;
    exchange *e = &all[(*count)++];
    e->promise = now - aim;
    e->to = w->at;
    e->to.rungs[up] += (size_t)far_up;
    e->to.rungs[down] -= (size_t)far_down;
}

static bool improves(const walk *w, const search_point *p) {
    if (!within(w, p)) return false;
    return w->desc->by_error ? p->cost < w->at.cost * (1 - w->desc->noise)
                             : p->error < w->at.error * (1 - SAME_ERROR);
}

// Measures the neighbours of the walk's end, on the side that it did not come from.
static void look_around(walk *w) {
    for (size_t i = 0; i < w->desc->axis_count && !w->stopped; i++) {
        search_point p;
        difference d;
        int by = w->desc->by_error ? 1 : -1;
        if (!known_steps(w, i, by, &d) && step_to(w, &w->at, i, by, &p)) walk_visit(w, &p);
    }
}

// True when one was found.
static bool take_exchange(walk *w) {
    exchange all[MAX_EXCHANGES];
    size_t count = 0, tries = 4 * w->desc->axis_count;
    look_around(w);
    for (size_t up = 0; up < w->desc->axis_count; up++)
        for (size_t down = 0; down < w->desc->axis_count; down++)
            for (int far = 0; up != down && far < LONGEST_STEP * LONGEST_STEP; far++)
                walk_consider(w, up, far % LONGEST_STEP + 1, down, far / LONGEST_STEP + 1, all,
                              &count);
    for (; tries > 0 && count > 0 && !w->stopped; tries--) {
        size_t best = 0;
        for (size_t i = 1; i < count; i++)
            if (all[i].promise > all[best].promise) best = i;
        if (walk_visit(w, &all[best].to) && improves(w, &all[best].to)) {
            w->at = all[best].to;
            return true;
        }
        all[best] = all[--count];
    }
    return false;
}

// ---- result -------------------------------------------------------------------------------------

static size_t changes(const walk *w, const search_point *p) {
    size_t count = 0;
    for (size_t i = 0; i < w->desc->axis_count; i++) count += p->rungs[i] != w->desc->axes[i].start;
    return count;
}

// Of two points that are equally good in what is minimised, prefers the one that is better
// otherwise, or else the one that changes less.
static bool preferred(const walk *w, const search_point *a, const search_point *b, bool by_cost) {
    double x = by_cost ? a->error : a->cost, y = by_cost ? b->error : b->cost;
    double same = by_cost ? SAME_ERROR : w->desc->noise;
    if (fabs(x - y) > same * y) return x < y;
    return changes(w, a) < changes(w, b);
}

// Returns the best measured point; when none keeps the limit, the nearest to it.
static search_point walk_choose(const walk *w, bool *kept) {
    double least = (double)INFINITY;
    for (size_t i = 0; i < w->count; i++) *kept = *kept || within(w, &w->points[i]);
    bool by_cost = w->desc->by_error == *kept;
    for (size_t i = 0; i < w->count; i++)
        if (within(w, &w->points[i]) == *kept)
            least = fmin(least, by_cost ? w->points[i].cost : w->points[i].error);
    double most = least * (1 + (by_cost ? w->desc->noise : SAME_ERROR));
    const search_point *best = NULL;
    for (size_t i = 0; i < w->count; i++) {
        const search_point *p = &w->points[i];
        if (within(w, p) != *kept || (by_cost ? p->cost : p->error) > most) continue;
        if (!best || preferred(w, p, best, by_cost)) best = p;
    }
    return best ? *best : w->points[0];
}

// Steps to where the limit is kept, starting at the end of all axes when it is not on the way.
static void reach_limit(walk *w) {
    bool up = w->desc->by_error;
    walk_go(w, up, true);
    if (within(w, &w->at)) return;
    search_point end = w->at;
    for (size_t i = 0; i < w->desc->axis_count; i++)
        end.rungs[i] = up ? w->desc->axes[i].count - 1 : 0;
    if (walk_visit(w, &end) && within(w, &end)) w->at = end;
}

bool search_run(const search_desc *desc, search_result *out) {
    walk *w = mem_alloc(sizeof *w);
    w->desc = desc;
    for (size_t i = 0; i < desc->axis_count; i++) w->at.rungs[i] = desc->axes[i].start;
    bool begun = walk_visit(w, &w->at);
    *out = (search_result){.start = w->at};
    if (begun) {
        reach_limit(w);
        bool more = within(w, &w->at);
        while (more) {
            walk_go(w, !desc->by_error, false);
            more = take_exchange(w);
        }
        out->best = walk_choose(w, &out->within);
        out->complete = !w->stopped;
        out->count = w->count;
    }
    mem_free(w);
    return begun;
}
