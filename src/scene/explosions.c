#include "scene/explosions.h"
#include "base/error.h"
#include <string.h>

bool scene_explosion_check(const scene_explosion *one) {
    const float most = 1e6f;
    const struct {
        const char *name;
        double value, least, most;
    } numbers[] = {
        {"time", one->time, -1e6, 1e6},
        {"position.x", (double)one->place.x, -1e6, 1e6},
        {"position.y", (double)one->place.y, -1e6, 1e6},
        {"position.z", (double)one->place.z, -1e6, 1e6},
        {"size", (double)one->size, 0, (double)most},
        {"life", (double)one->life, 1e-6, (double)most},
        {"seed", one->seed, 0, SCENE_EXPLOSIONS_SEED},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (!(numbers[i].value >= numbers[i].least && numbers[i].value <= numbers[i].most))
            return err_set("'%s' is %g; accepted: %g to %g", numbers[i].name, numbers[i].value,
                           numbers[i].least, numbers[i].most);
    return true;
}

// PCG hash by Jarzynski and Olano (JCGT 9(3), 2020).
static uint32_t scramble(uint32_t v) {
    uint32_t state = v * 747796405u + 2891336453u;
    uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

void scene_explosion_chance(const scene_explosion *one, float out[4]) {
    uint32_t chance = one->seed;
    for (int i = 0; i < 4; i++) {
        chance = scramble(chance);
        out[i] = (float)(chance >> 8) / 16777216;
    }
}

uint32_t scene_explosions_seed(const scene_explosions *list) {
    return (uint32_t)(list->gone + list->count + 1) & SCENE_EXPLOSIONS_SEED;
}

bool scene_explosions_add(scene_explosions *list, const scene_explosion *one) {
    if (list->count == SCENE_EXPLOSIONS_MAX) {
        if (list->fixed == list->count) return false;
        scene_explosion *first = &list->all[list->fixed];
        list->count--;
        list->gone++;
        memmove(first, first + 1, (list->count - list->fixed) * sizeof *first);
    }
    list->all[list->count++] = *one;
    return true;
}

void scene_explosions_reset(scene_explosions *list) {
    list->count = list->fixed;
    list->gone = 0;
}

size_t scene_explosions_alive(const scene_explosions *list, double time, double life,
                              const scene_explosion **out, size_t capacity) {
    size_t count = 0;
    for (size_t i = 0; i < list->count; i++) {
        const scene_explosion *one = &list->all[i];
        if (!(time >= one->time && time < one->time + life * (double)one->life)) continue;
        size_t at = count; // of two that begin at once, the first in the list stands first
        while (at > 0 && out[at - 1]->time < one->time) at--;
        if (at == capacity) continue;
        if (count < capacity) count++;
        memmove(out + at + 1, out + at, (count - at - 1) * sizeof(const scene_explosion *));
        out[at] = one;
    }
    return count;
}
