#include "app/film.h"
#include "base/memory.h"
#include <math.h>

enum { SHARE = 4 }; // one part in so many of the memory

void film_clear(film *f, roil *r) {
    for (size_t i = 0; i < f->count; i++) roil_still_destroy(r, f->stills[i]);
    mem_free(f->stills);
    *f = (film){.first = f->first, .count = f->count};
    if (f->count) f->stills = mem_alloc(f->count * sizeof *f->stills);
}

void film_set_range(film *f, roil *r, double first, double last) {
    size_t count = last >= first ? (size_t)(last - first) + 1 : 0;
    if (f->first == first && f->count == count) return;
    film_clear(f, r);
    mem_free(f->stills);
    *f = (film){.first = first, .count = count};
    if (count) f->stills = mem_alloc(count * sizeof *f->stills);
}

static roil_still **place_of(const film *f, double frame) {
    double at = frame - f->first;
    return at >= 0 && at < (double)f->count && at == floor(at) ? &f->stills[(size_t)at] : NULL;
}

static void drop(film *f, roil *r, roil_still **place) {
    if (!*place) return;
    f->bytes -= roil_still_bytes(*place);
    roil_still_destroy(r, *place);
    *place = NULL;
}

static roil_still **farthest(const film *f, double near) {
    double at = near - f->first;
    size_t first = 0, last = f->count;
    while (first < f->count && !f->stills[first]) first++;
    while (last > 0 && !f->stills[last - 1]) last--;
    if (first >= last) return NULL;
    return at - (double)first > (double)(last - 1) - at ? &f->stills[first] : &f->stills[last - 1];
}

static uint64_t most_of(const film *f, const roil *r) {
    roil_memory memory = roil_get_memory(r);
    uint64_t left = memory.limit > memory.sum ? memory.limit - memory.sum : 0;
    uint64_t share = memory.limit / SHARE, half = (f->bytes + left) / 2;
    return share < half ? share : half;
}

bool film_make_room(film *f, roil *r, double near, uint64_t bytes) {
    uint64_t most = most_of(f, r);
    while (f->bytes + bytes > most) {
        roil_still **place = farthest(f, near);
        if (!place) return false;
        drop(f, r, place);
    }
    return true;
}

void film_put(film *f, roil *r, double frame, roil_still *still) {
    roil_still **place = place_of(f, frame);
    if (!place) {
        roil_still_destroy(r, still);
        return;
    }
    drop(f, r, place);
    *place = still;
    f->bytes += roil_still_bytes(still);
}

roil_still *film_get(const film *f, double frame) {
    roil_still *const *place = place_of(f, frame);
    return place ? *place : NULL;
}
