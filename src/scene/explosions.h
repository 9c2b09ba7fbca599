// Explosions: a list of when something bursts, where and how large, for passes that draw them and
// for scripts that ask. Those that it begins with stay; others come while the effect runs, and are
// forgotten when time goes back.
#pragma once
#include "base/maths.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    SCENE_EXPLOSIONS_MAX = 1024,          // of one list
    SCENE_EXPLOSIONS_SEED = (1 << 24) - 1 // the greatest
};

typedef struct scene_explosion {
    double time;   // seconds: when it begins
    float3 place;  // metres
    float size;    // factor of its radius
    float life;    // factor of how long it takes
    uint32_t seed; // no two look alike; up to SCENE_EXPLOSIONS_SEED
} scene_explosion;

typedef struct scene_explosions {
    scene_explosion all[SCENE_EXPLOSIONS_MAX];
    size_t fixed; // that it begins with, the first
    size_t count;
    size_t gone;                   // that made room for others
    struct scene_explosions *next; // of a script
} scene_explosions;

// False with a message that names the number at fault.
bool scene_explosion_check(const scene_explosion *one);
// Numbers of its own, 0..1: three by which noise is moved, and one for all else.
void scene_explosion_chance(const scene_explosion *one, float out[4]);
// Of the next one, if nobody says another: its number, those that made room counted.
uint32_t scene_explosions_seed(const scene_explosions *list);
// One that came while the effect runs. In a full list the first of these makes room; false: there
// is none.
bool scene_explosions_add(scene_explosions *list, const scene_explosion *one);
void scene_explosions_reset(scene_explosions *list); // time has gone back
// Those that go on at `time`, the youngest first, at most `capacity`; returns how many it wrote.
// `life`: seconds that one takes whose factor is 1.
size_t scene_explosions_alive(const scene_explosions *list, double time, double life,
                              const scene_explosion **out, size_t capacity);
