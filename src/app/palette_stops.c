// Edits a palette's stops, which stay in rising order; equal positions make a hard edge.
#include "app/palette_stops.h"
#include "base/maths.h"
#include <math.h>
#include <string.h>

size_t palette_stops_add(roil_palette *p, float at, const float color[4]) {
    if (p->count >= ROIL_MAX_STOPS) return ROIL_MAX_STOPS;
    size_t index = 0;
    while (index < p->count && p->stops[index].at <= at) index++;
    memmove(&p->stops[index + 1], &p->stops[index], (p->count - index) * sizeof p->stops[0]);
    p->count++;
    p->stops[index].at = at;
    memcpy(p->stops[index].color, color, sizeof p->stops[index].color);
    return index;
}

bool palette_stops_remove(roil_palette *p, size_t index) {
    if (p->count <= 2 || index >= p->count) return false;
    p->count--;
    memmove(&p->stops[index], &p->stops[index + 1], (p->count - index) * sizeof p->stops[0]);
    return true;
}

void palette_stops_move(roil_palette *p, size_t index, float at) {
    float low = index > 0 ? p->stops[index - 1].at : -INFINITY;
    float high = index + 1 < p->count ? p->stops[index + 1].at : INFINITY;
    p->stops[index].at = clampf(at, low, high);
}

// ---- fitting ------------------------------------------------------------------------------------

// Returns the distance of a sample from the straight line between two others, relative to its
// brightness, since bright colours may differ by more.
static float bend(const float (*samples)[4], size_t i, size_t from, size_t to) {
    const float *s = samples[i];
    float t = (float)(i - from) / (float)(to - from), worst = 0;
    float peak = fmaxf(fmaxf(s[0], s[1]), fmaxf(s[2], s[3]));
    for (int k = 0; k < 4; k++)
        worst = fmaxf(worst, fabsf(s[k] - mixf(samples[from][k], samples[to][k], t)));
    return worst / (0.1f + peak);
}

// Returns the sample that is farthest from the lines between the chosen ones; 0 when all are
// chosen.
static size_t farthest(const float (*samples)[4], const size_t *chosen, size_t count) {
    size_t found = 0;
    float worst = -1;
    for (size_t k = 0; k + 1 < count; k++)
        for (size_t i = chosen[k] + 1; i < chosen[k + 1]; i++) {
            float error = bend(samples, i, chosen[k], chosen[k + 1]);
            if (error <= worst) continue;
            worst = error;
            found = i;
        }
    return found;
}

static size_t insert_sorted(size_t *chosen, size_t count, size_t value) {
    size_t at = count;
    for (; at > 0 && chosen[at - 1] > value; at--) chosen[at] = chosen[at - 1];
    chosen[at] = value;
    return count + 1;
}

void palette_stops_fit(roil_palette *p, const float (*samples)[4], size_t sample_count,
                       size_t count) {
    size_t chosen[ROIL_MAX_STOPS] = {0, sample_count - 1}, found = 2;
    while (found < count) {
        size_t next = farthest(samples, chosen, found);
        if (!next) break;
        found = insert_sorted(chosen, found, next);
    }
    p->count = found;
    for (size_t i = 0; i < found; i++) {
        float t = (float)chosen[i] / (float)(sample_count - 1);
        p->stops[i].at = mixf(p->min, p->max, t);
        memcpy(p->stops[i].color, samples[chosen[i]], sizeof p->stops[i].color);
    }
}
