// The life of a template (src/pass/templates.h): how long it is, when it ends, and what is random in it.
// The state of a life, a vec4: age and lifetime (s), its number (0: there has been none), side.
#ifndef LIB_TEMPLATE_LIFE_GLSL
#define LIB_TEMPLATE_LIFE_GLSL
#include "lib/random.glsl"

uniform float lifetime_min; //= 0.1 [1e-3, 1e4] s : of the shortest life
uniform float lifetime_max; //= 0.4 [1e-3, 1e4] s : of the longest; those between are as likely
uniform float fade;         //= 0.25 [0, 0.5] : share of its life in which a template comes, and in which it goes
uniform float amount;       //= 1 [0, 1] : share of the templates that act
uniform uint key;           // of what is random
uniform uint first;         // of this group
uniform uint count;         // of this group
uniform float tile;         // of its picture
uniform float time_step;    // s

// ---- chance -----------------------------------------------------------------------------------

uint chance; // of this template in this life

float share_of(uint number) { // [0, 1)
    return float(number >> 8) * (1.0 / 16777216.0);
}

float next_chance() { // [0, 1)
    chance = random_hash(chance);
    return share_of(chance);
}

// ---- time -------------------------------------------------------------------------------------

// Ages it by a step. Whether a new life begins; `waits`: it found no place when it should have begun.
bool template_ends(inout vec4 life, bool placed, out bool waits) {
    waits = life.z > 0.0 && !placed;
    life.x += time_step;
    return life.z == 0.0 || waits || life.x >= life.y;
}

// The next life of the template `which` of its set: how long, and how large.
void template_begin(inout vec4 life, uint set_, uint which, float least, float most) {
    life.z += 1.0;
    chance = random_hash(uint(life.z) + random_hash(which + random_hash(set_ + random_hash(key))));
    life.y = mix(lifetime_min, max(lifetime_min, lifetime_max), next_chance());
    life.w = mix(least, max(least, most), next_chance());
}

// How old it is when it has found a place, `over` after the last life should have ended. Those of the first
// step are in the midst of their lives.
float template_age(vec4 life, bool waits, float over) {
    return life.z == 1.0 && !waits ? life.y * next_chance() : waits ? 0.0 : min(over, 0.5 * life.y);
}

bool template_acts(uint i) { // the `i`th of its group
    return float(i) < amount * float(count);
}

float template_envelope(vec4 life) { // 0 to 1
    float age = life.x / life.y;
    if (fade <= 0.0) return 1.0;
    return smoothstep(0.0, fade, age) * smoothstep(0.0, fade, 1.0 - age);
}
#endif
