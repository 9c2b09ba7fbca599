// A group of templates: pictures of pressure or velocity that are put into a flow of `slices` for a
// while, again and again, and leave eddies of their size there (Krueger and Westermann 2005, 3).
//
// Here the life of each, one thread a template and slice: it grows older, and when its time is over
// it begins anew at another place. pass/slices/templates_draw.comp puts them into the flow.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
//@ option kind = pressure {pressure, velocity} : which of the picture's channels act: pressure, blended in while the pressure is solved for, pushes out where it is raised and draws in where it is lowered; velocity is a force
//@ option align = none {none, fixed, radial, contour} : which way the picture's upper edge looks: any way, up, away from `center`, out of the region
//@ option scale_by = nothing {nothing, density, temperature, dye} : `strength` is times what the flow has of that around the template, as it is in each step
//@ option within = nothing {nothing, density, temperature, dye} : templates are put only where the flow has from `above` to `below` of that
//@ field float region = 1 : where templates are put, as share of the places that are tried; x and y in widths of a slice
uniform float strength;     //= 1 [-1e6, 1e6] : what a picture's 1 means: m^2/s^2 of pressure over the density of air, or m/s^2 of force
uniform float size_min;     //= 0.05 [1e-3, 10] widths : of a slice: side of the smallest template
uniform float size_max;     //= 0.1 [1e-3, 10] widths : of the largest; sizes between are as likely
#include "lib/template_life.glsl"
uniform float blend;        //= 0.02 [0, 1] : of the alpha of pressure: how firmly it is held, as in a slice of 128 cells across with 60 steps a second; more of them hold it no firmer. 0.002 nudges what flows, 0.1 blows it apart
uniform float angle;        //= 0 [-inf, inf] degrees : that templates are turned by besides, anticlockwise
uniform float spread;       //= 0 [0, 180] degrees : by which each may be turned more or less
uniform float center_x;     //= 0.5 [-100, 100] widths : of `align = "radial"`
uniform float center_y;     //= 0.5 [-100, 100] widths : of `align = "radial"`
uniform float above;        //= 0.1 [-inf, inf] : least of what `within` names
uniform float below;        //= 1e6 [-inf, inf] : most of it
uniform int seed;           //= 0 [0, 16777215] : of what is random, besides that of the flow
#define FLOW_STATE
#include "sim/flow/state.glsl"
#include "fields.glsl"
#define TEMPLATES_USE
#include "pass/slices/templates.glsl"
uniform vec2 box_min; // where the region may be (widths)
uniform vec2 box_max;

const int TRIES = 32, TOGETHER = 4; // places a step, and at once
const int RING = 12, RINGS = 10; // points of a circle that a contour is looked for with; circles
const float TURN = 6.28318530718;

// ---- the flow ---------------------------------------------------------------------------------

float quantity_at(int which, vec2 at, int slice) {
    ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), FLOW_SIZE - 1);
    return flow_scalars_of(cell, slice)[which];
}

float region_at(vec2 at) {
    return clamp(field_region(vec3(at / float(FLOW_NX), 0.0)), 0.0, 1.0);
}

bool fits(vec2 at, int slice) {
#if WITHIN != WITHIN_NOTHING
    float held = quantity_at(WITHIN - 1, at, slice);
    return held >= above && held <= below;
#else
    return true;
#endif
}

// Around the middle, as wide as the template: one cell alone would make it flicker.
float scale_at(vec2 at, float half_side, int slice) {
#if SCALE_BY == SCALE_BY_NOTHING
    return 1.0;
#else
    float sum = quantity_at(SCALE_BY - 1, at, slice);
    for (int i = 0; i < 4; i++) {
        vec2 to = vec2(i % 2 == 0 ? 0.5 : -0.5, i / 2 == 0 ? 0.5 : -0.5) * half_side;
        sum += quantity_at(SCALE_BY - 1, at + to, slice);
    }
    return 0.2 * sum;
#endif
}

// ---- turns ------------------------------------------------------------------------------------

// What the region's contour is that of.
float height_at(vec2 at, int slice) {
#if WITHIN != WITHIN_NOTHING
    return region_at(at) * quantity_at(WITHIN - 1, at, slice);
#else
    return region_at(at);
#endif
}

// Where the region ends soonest; 0: it is as far in all directions. Looked for on a circle of the
// template's size; where it lies within the region, on larger ones, until one crosses the contour.
vec2 way_out(vec2 at, float half_side, int slice) {
    float here = height_at(at, slice), radius = half_side, inner = 0.0, outer = 0.0;
    for (int k = 0; k < RINGS; k++) {
        vec2 sum = vec2(0.0);
        float mean = 0.0;
        for (int i = 0; i < RING; i++) {
            float turn = TURN / float(RING) * float(i);
            vec2 to = vec2(cos(turn), sin(turn));
            float height = height_at(at + to * radius, slice);
            sum -= to * height;
            mean += height / float(RING);
        }
        if (dot(sum, sum) > 1e-4 * here * here) return sum;
        if (mean > 0.5 * here) inner = radius;
        else outer = radius;
        radius = outer > 0.0 ? 0.5 * (inner + outer) : 2.0 * radius;
    }
    return vec2(0.0);
}

// Radians, anticlockwise, of the picture's upper edge from up.
float turn_at(vec2 at, float half_side, int slice) {
    float any = TURN * next_chance();
#if ALIGN == ALIGN_FIXED
    return 0.0;
#elif ALIGN == ALIGN_NONE
    return any;
#else
#if ALIGN == ALIGN_RADIAL
    vec2 out_ = at - vec2(center_x, center_y) * float(FLOW_NX);
#else
    vec2 out_ = way_out(at, half_side, slice);
#endif
    return dot(out_, out_) > 0.0 ? atan(out_.y, out_.x) - 0.25 * TURN : any;
#endif
}

// ---- life -------------------------------------------------------------------------------------

// A place that the region and the flow agree to. Several are looked at together: each waits for
// memory, and a template that finds none looks again in the next step.
bool find_place(int slice, out vec2 found) {
    for (int k = 0; k < TRIES; k += TOGETHER) {
        vec2 places[TOGETHER];
        bool good[TOGETHER], any = false;
        for (int i = 0; i < TOGETHER; i++) {
            uint x = random_hash(chance + uint(k + i)), y = random_hash(x), share = random_hash(y);
            places[i] = mix(box_min, box_max, vec2(share_of(x), share_of(y))) * float(FLOW_NX);
            good[i] = share_of(share) < region_at(places[i]) && fits(places[i], slice);
        }
        for (int i = TOGETHER - 1; i >= 0; i--)
            if (good[i]) {
                found = places[i];
                any = true;
            }
        if (any) return true;
    }
    return false;
}

// The next life: how long, how large, and where. False: there is no place for it now.
bool begin_life(int slice, uint which, inout vec4 life, inout vec4 place) {
    template_begin(life, uint(slice), which, size_min, size_max);
    float half_side = 0.5 * life.w * float(FLOW_NX);
    vec2 at;
    if (!find_place(slice, at)) return false;
    float turn = turn_at(at, half_side, slice);
    place = vec4(turn + radians(spread) * (2.0 * next_chance() - 1.0), at, 1.0);
    return true;
}

void mark_tiles(vec2 at, float reach, int slice, uint which) {
    ivec2 low = ivec2(floor((at - reach) / float(TEMPLATES_TILE)));
    ivec2 high = ivec2(floor((at + reach) / float(TEMPLATES_TILE)));
    template_mark(ivec3(low, slice), ivec3(high, slice), which);
}

void main() {
    uint i = gl_GlobalInvocationID.x, which = first + i;
    int slice = int(gl_GlobalInvocationID.y);
    if (i >= count || slice >= FLOW_SLICES) return;
    vec4 life = templates[template_at(2u, slice, which)];
    vec4 place = templates[template_at(3u, slice, which)];
    bool waits;
    if (template_ends(life, place.w > 0.0, waits)) {
        float over = life.x - life.y;
        place.w = 0.0;
        if (begin_life(slice, which, life, place)) life.x = template_age(life, waits, over);
    }
    bool acts = place.w > 0.0 && template_acts(i);
    float half_side = max(0.5 * life.w * float(FLOW_NX), 1.5); // what is finer than cells is not seen
    float factor = strength * (acts ? scale_at(place.yz, half_side, slice) : 0.0);
    float now = template_envelope(life), turn = place.x + radians(angle);
    bool pushes = KIND == KIND_VELOCITY;
    if (factor != 0.0) {
        float reach = half_side * (abs(cos(turn)) + abs(sin(turn))); // of the turned square
        mark_tiles(place.yz, reach, slice, which);
    } else {
        half_side = 0.0;
    }
    templates[template_at(0u, slice, which)] = vec4(place.yz, half_side, factor);
    templates[template_at(1u, slice, which)] =
        vec4(cos(turn), sin(turn), pushes ? now : blend * now, pushes ? -1.0 - tile : tile);
    templates[template_at(2u, slice, which)] = life;
    templates[template_at(3u, slice, which)] = place;
}
