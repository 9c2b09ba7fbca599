// Puts the templates of all groups into all slices of a flow: the pressure that the solver blends
// in, and forces. A thread does cells above each other, so that threads side by side write side by
// side, and a template is looked at once for all of them; it looks at those of its tile alone.
layout(local_size_x = 16, local_size_y = 4, local_size_z = 1) in;
#if PUSHES
#define FLOW_SOURCES
#endif
#if PRESSES
#define FLOW_TEMPLATES writeonly
#endif
#include "sim/flow/state.glsl"
#define TEMPLATES_USE readonly
#include "pass/slices/templates.glsl"
uniform float time_step; // s
uniform uint alone;      // nobody else has written sources in this step
#if HAND
// By hand: each has rows 0 and 1 of an instance, and the slice that it is in (below 0: all).
uniform vec4 hand[3 * HAND];
uniform uint hand_count;
#endif
#include "lib/template_pictures.glsl"

// Mixing in each iteration adds 4 alpha / (1 - alpha) (p - pressure) to the equation of the pressure,
// for each square of a cell's side: alpha is made such that it is as much for a square of a width.
// And what flows out of a template in a step is as much longer as the step is: alpha is made such
// that it is as much in a second.
float alpha_here(float alpha) {
    const float finer = float(FLOW_NX) / 128.0;
    return alpha / max(alpha + (1.0 - alpha) * finer * finer * 60.0 * time_step, 1e-6);
}

#define EACH_CELL for (int c = 0; c < TEMPLATES_CELLS; c++)

flow_template pressed[TEMPLATES_CELLS];
vec2 pushed[TEMPLATES_CELLS];

// `place`, `look`: rows 0 and 1 of an instance.
void add(vec4 place, vec4 look, ivec2 low) {
    float level = template_level(place.z);
    bool pushes = look.w < 0.0;
    EACH_CELL {
        vec2 d = (vec2(low) + vec2(0.5, float(c) + 0.5) - place.xy) / place.z;
        vec2 at = vec2(look.x * d.x + look.y * d.y, look.x * d.y - look.y * d.x);
        if (max(abs(at.x), abs(at.y)) > 1.0) continue;
        vec4 held = template_picture(at, pushes ? -1.0 - look.w : look.w, level);
        if (pushes) {
            vec2 v = place.w * look.z * held.xy;
            pushed[c] += vec2(look.x * v.x - look.y * v.y, look.y * v.x + look.x * v.y);
        } else if (held.w > 0.0) {
            flow_blend(pressed[c], alpha_here(min(look.z * held.w, 1.0)),
                       place.w * held.z / held.w);
        }
    }
}

void add_groups(ivec2 low, int slice) {
    ivec3 tile = ivec3(low / TEMPLATES_TILE, slice);
    uint now = template_mask_at(parity, tile);
    vec4 place = vec4(0.0), look = vec4(0.0);
    for (int w = 0; w < TEMPLATES_WORDS; w++) {
        uint bits = template_masks[now + uint(w)];
        while (bits != 0u) {
            uint i = uint(w * 32 + findLSB(bits));
            bits &= bits - 1u;
            vec4 next = templates[template_at(0u, slice, i)], next_look = templates[template_at(1u, slice, i)];
            if (place.z > 0.0) add(place, look, low); // while the next is on its way
            place = next;
            look = next_look;
        }
    }
    if (place.z > 0.0) add(place, look, low);
    if (low == tile.xy * TEMPLATES_TILE) template_clear(tile);
}

void main() {
    ivec2 low = ivec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y * TEMPLATES_CELLS);
    int slice = int(gl_GlobalInvocationID.z);
    if (low.x >= FLOW_NX || low.y >= FLOW_NY || slice >= FLOW_SLICES) return;
    EACH_CELL {
        pressed[c] = flow_template(0.0, 0.0);
        pushed[c] = vec2(0.0);
    }
    add_groups(low, slice);
#if HAND
    for (uint i = 0u; i < hand_count; i++) {
        float where = hand[3u * i + 2u].x;
        if (where < 0.0 || int(where) == slice) add(hand[3u * i], hand[3u * i + 1u], low);
    }
#endif
    EACH_CELL {
        ivec2 cell = low + ivec2(0, c);
        if (cell.y >= FLOW_NY) break;
#if PRESSES
        FLOW_TEMPLATE_STORE(cell, slice, pressed[c]);
#endif
#if PUSHES
        if (alone == 1u) {
            flow_source s = flow_no_source();
            s.push = pushed[c] * time_step;
            FLOW_SOURCE_STORE(cell, slice, s);
        } else if (pushed[c] != vec2(0.0)) {
            FLOW_PUSH_ADD(cell, slice, pushed[c] * time_step);
        }
#endif
    }
}
