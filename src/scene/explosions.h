// Explosions: a list of times, places and sizes, for passes that draw them and for scripts that
// read them. Explosions that the script declares are permanent; those that are added while the
// effect runs are removed when time goes back.
#pragma once
#include "base/maths.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    SCENE_EXPLOSIONS_MAX = 1024,          // per list
    SCENE_EXPLOSIONS_SEED = (1 << 24) - 1 // the greatest seed
};

typedef struct scene_explosion {
    double time;   // seconds: when it begins
    float3 place;  // metres
    float size;    // factor of the radius
    float life;    // factor of the duration
    uint32_t seed; // makes it look different from others; up to SCENE_EXPLOSIONS_SEED
} scene_explosion;

typedef struct scene_explosions {
    scene_explosion all[SCENE_EXPLOSIONS_MAX];
    size_t fixed; // number of permanent ones, which come first
    size_t count;
    size_t gone;                   // number of those that made room for others
    struct scene_explosions *next; // next list of the script
} scene_explosions;

// Checks an explosion. False with a message that names the wrong number.
bool scene_explosion_check(const scene_explosion *one);
// Returns random numbers of an explosion, 0 to 1: three that move noise, and one for other uses.
void scene_explosion_chance(const scene_explosion *one, float out[4]);
// Returns the default seed of the next explosion: its number, counting those that made room.
uint32_t scene_explosions_seed(const scene_explosions *list);
// Adds an explosion while the effect runs. In a full list the first one that was added so makes
// room. False: there is none.
bool scene_explosions_add(scene_explosions *list, const scene_explosion *one);
void scene_explosions_reset(scene_explosions *list); // removes those added while the effect ran
// Lists the explosions that are going on at `time`, the youngest first, at most `capacity`. Returns
// how many it wrote. `life`: seconds that an explosion with a factor of 1 takes.
size_t scene_explosions_alive(const scene_explosions *list, double time, double life,
                              const scene_explosion **out, size_t capacity);
