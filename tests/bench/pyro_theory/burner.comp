// Gives fuel to the lowest cells of burning gas, within a disc or a square, before a step.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;
#define PYRO_ON_GAS
#include "sim/pyro/state.glsl"

uniform vec2 middle;    // cells
uniform float radius;   // of the disc, or half a side, cells
uniform int square;     // 1: a square, not a disc
uniform float give;     // fuel in this step, kg by m^3 of the source
uniform float flicker;  // share by which it differs from cell to cell, and in time
uniform int seed;       // of that
layout(std430) buffer PyroGas { PYRO_FOUR gas[]; };

uint hash(uint x) { // Wellons, "Prospecting for hash functions" (2018)
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(c, PYRO_SIZE))) return;
    vec2 from = abs(vec2(c.xy) + 0.5 - middle);
    // The part of the cell that is within, about.
    float in_ = square == 1 ? clamp(radius - from.x + 0.5, 0.0, 1.0) * clamp(radius - from.y + 0.5, 0.0, 1.0)
                            : clamp(radius - length(from) + 0.5, 0.0, 1.0);
    if (in_ == 0.0) return;
    float noise = float(hash(uint(c.x + PYRO_NX * c.y) + hash(uint(seed))) >> 8) / 8388608.0 - 1.0;
    int at = pyro_at(c);
    vec4 g = pyro_load(gas[at]); // packed: by mass of the surroundings' air
    g.PYRO_FUEL += in_ * give * (1.0 + flicker * noise) * ambient / PYRO_AIR;
    gas[at] = pyro_store(g);
}
