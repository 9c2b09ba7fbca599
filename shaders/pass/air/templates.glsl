// A group of templates in simulated air: the life of each, one thread a template. It grows older, and when its
// time is over it begins anew at another place. pass/air/templates_draw.comp puts them into an image that the
// solvers read.
//
// Who includes this has the solver's state before, options `scale_by` and `within`, and says after it
//
//     float quantity_at(int which, vec3 at): of the air, which word of these, at a place in cells
//     float scale_of(int which, float value): what `strength` is times then
//     vec3 way_at(vec3 at): along which the air goes there, of any length
//@ option kind = pressure {pressure, velocity} : which of the picture's channels act: pressure lets gas out where the picture is raised and takes it in where it is lowered; velocity is a force
//@ option align = none {none, fixed, radial, contour, direction, flow} : which way the picture's upper edge looks: any way, up (its right along x), away from `center`, out of the region, along `direction`, the way that the air goes
//@ option depth = revolve {revolve, extrude} : how a picture is deep: turned about the line upwards through its middle (a source is a ball, a pair of vortices a ring), or continued on both sides, where it fades as a Gaussian (a vortex is a tube)
//@ field float region = 1 : where templates are put, as share of the places in the box that are tried (m)
//@ field vec3 direction = {0, 0, 1} : of `align = "direction"`; where it is 0 they look any way
uniform float strength; //= 1 [-1e6, 1e6] : what a picture's 1 means: of pressure, how much gas comes out of a place in a second, as a multiple of its volume (1/s); of velocity, m/s^2
uniform float size_min; //= 0.2 [1e-4, 1e6] m : side of the smallest template; below eight cells it is as one of eight
uniform float size_max; //= 0.5 [1e-4, 1e6] m : of the largest; sizes between are as likely
#include "lib/template_life.glsl"
uniform float angle;  //= 0 [-inf, inf] degrees : that templates are turned by besides, anticlockwise as one sees the picture
uniform float spread; //= 0 [0, 180] degrees : by which each may be turned more or less, about any axis
uniform vec3 center;  //= {0, 0, 0} m : of `align = "radial"`
uniform float above;  //= 1e-4 [-inf, inf] : least of what `within` names
uniform float below;  //= 1e9 [-inf, inf] : most of it
uniform int seed;     //= 0 [0, 16777215] : of what is random
#include "fields.glsl"
#define TEMPLATES_USE
#include "pass/air/templates_state.glsl"
uniform vec3 corner;     // of the air's box (m)
uniform float cell_size; // m
uniform vec3 box_min;    // where the region may be (m)
uniform vec3 box_max;

float quantity_at(int which, vec3 at);
float scale_of(int which, float value);
vec3 way_at(vec3 at);

const int TRIES = 32; // places a step
const int RINGS = 10; // spheres that a contour is looked for with
const float TURN = 6.28318530718;

// ---- the air ----------------------------------------------------------------------------------

vec3 place_of(vec3 at) { // m
    return corner + at * cell_size;
}

float region_at(vec3 at) {
    return clamp(field_region(place_of(at)), 0.0, 1.0);
}

bool fits(vec3 at) {
#if WITHIN != WITHIN_NOTHING
    float held = quantity_at(WITHIN - 1, at);
    return held >= above && held <= below;
#else
    return true;
#endif
}

// A corner of a cube around 0, and the middles of its faces: 14 directions.
vec3 direction_of(int i) {
    if (i < 6) return float(2 * (i & 1) - 1) * vec3(i >> 1 == 0, i >> 1 == 1, i >> 1 == 2);
    i -= 6;
    return (2.0 * vec3(i & 1, (i >> 1) & 1, i >> 2) - 1.0) * inversesqrt(3.0);
}

// Around the middle, as wide as the template: one cell alone would make it flicker.
float scale_at(vec3 at, float half_side) {
#if SCALE_BY == SCALE_BY_NOTHING
    return 1.0;
#else
    float sum = quantity_at(SCALE_BY - 1, at);
    for (int i = 0; i < 6; i++) sum += quantity_at(SCALE_BY - 1, at + 0.5 * half_side * direction_of(i));
    return scale_of(SCALE_BY - 1, sum / 7.0);
#endif
}

// ---- turns ------------------------------------------------------------------------------------

// What the region's contour is that of.
float height_at(vec3 at) {
#if WITHIN != WITHIN_NOTHING
    return region_at(at) * quantity_at(WITHIN - 1, at);
#else
    return region_at(at);
#endif
}

// Where the region ends soonest; 0: it is as far in all directions. Looked for on a sphere of the template's
// size; where it lies within the region, on larger ones, until one crosses the contour.
vec3 way_out(vec3 at, float half_side) {
    float here = height_at(at), radius = half_side, inner = 0.0, outer = 0.0;
    for (int k = 0; k < RINGS; k++) {
        vec3 sum = vec3(0.0);
        float mean = 0.0;
        for (int i = 0; i < 14; i++) {
            vec3 to = direction_of(i);
            float height = height_at(at + to * radius);
            sum -= to * height;
            mean += height / 14.0;
        }
        if (dot(sum, sum) > 1e-4 * here * here) return sum;
        if (mean > 0.5 * here) inner = radius;
        else outer = radius;
        radius = outer > 0.0 ? 0.5 * (inner + outer) : 2.0 * radius;
    }
    return vec3(0.0);
}

vec3 any_way() {
    float z = 2.0 * next_chance() - 1.0, turn = TURN * next_chance();
    return vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(turn), sin(turn)), z);
}

vec3 turned(vec3 v, vec3 axis, float angle_) { // Rodrigues
    return v * cos(angle_) + cross(axis, v) * sin(angle_) + axis * dot(axis, v) * (1.0 - cos(angle_));
}

// Where the picture's upper edge looks, and its right.
void turn_at(vec3 at, float half_side, out vec3 right, out vec3 up) {
    vec3 any = any_way();
#if ALIGN == ALIGN_FIXED
    up = vec3(0.0, 0.0, 1.0);
    right = vec3(1.0, 0.0, 0.0);
#else
#if ALIGN == ALIGN_NONE
    up = any;
#elif ALIGN == ALIGN_RADIAL
    up = place_of(at) - center;
#elif ALIGN == ALIGN_CONTOUR
    up = way_out(at, half_side);
#elif ALIGN == ALIGN_DIRECTION
    up = field_direction(place_of(at));
#else
    up = way_at(at);
#endif
    float square = dot(up, up);
    up = square > 1e-20 && square < 1e20 ? up * inversesqrt(square) : any;
    right = normalize(cross(up, abs(up.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    right = turned(right, up, TURN * next_chance());
#endif
    vec3 axis = any_way();
    float more = radians(spread) * (2.0 * next_chance() - 1.0);
    right = turned(right, axis, more);
    up = turned(up, axis, more);
}

// ---- life -------------------------------------------------------------------------------------

// A place that the region and the air agree to. A template that finds none looks again in the next step.
bool find_place(out vec3 found) {
    for (int k = 0; k < TRIES; k++) {
        uint x = random_hash(chance + uint(k)), y = random_hash(x), z = random_hash(y), share = random_hash(z);
        vec3 p = mix(box_min, box_max, vec3(share_of(x), share_of(y), share_of(z)));
        found = (p - corner) / cell_size;
        if (share_of(share) < region_at(found) && fits(found)) return true;
    }
    return false;
}

void main() {
    uint i = gl_GlobalInvocationID.x, which = first + i;
    if (i >= count) return;
    vec4 life = templates[template_at(3u, 0, which)], place = templates[template_at(4u, 0, which)];
    vec3 right = templates[template_at(5u, 0, which)].xyz, up = templates[template_at(6u, 0, which)].xyz;
    bool waits;
    if (template_ends(life, place.w > 0.0, waits)) {
        float over = life.x - life.y;
        template_begin(life, 0u, which, size_min, size_max);
        place.w = 0.0;
        if (find_place(place.xyz)) {
            turn_at(place.xyz, 0.5 * life.w / cell_size, right, up);
            place.w = 1.0;
            life.x = template_age(life, waits, over);
        }
    }
    bool acts = place.w > 0.0 && template_acts(i);
    float half_side = max(0.5 * life.w / cell_size, 2.0 * AIR_COARSER); // what is finer is not seen
    float factor = acts ? strength * template_envelope(life) * scale_at(place.xyz, half_side) : 0.0;
    vec3 middle = place.xyz / AIR_COARSER;
    half_side /= AIR_COARSER;
    float turn = radians(angle);
    vec3 right_now = right * cos(turn) + up * sin(turn), up_now = up * cos(turn) - right * sin(turn);
    if (factor != 0.0) {
        vec3 reach = half_side * (abs(right_now) + abs(up_now) + abs(cross(right_now, up_now))); // of the cube
        template_mark(ivec3(floor((middle - reach) / float(TEMPLATES_TILE))),
                      ivec3(floor((middle + reach) / float(TEMPLATES_TILE))), which);
    } else {
        half_side = 0.0;
    }
    int look = (KIND == KIND_VELOCITY ? TEMPLATE_PUSHES : 0) | (DEPTH == DEPTH_EXTRUDE ? TEMPLATE_EXTRUDED : 0);
    templates[template_at(0u, 0, which)] = vec4(middle, half_side);
    templates[template_at(1u, 0, which)] = vec4(right_now, factor);
    templates[template_at(2u, 0, which)] = vec4(up_now, 4.0 * tile + float(look));
    templates[template_at(3u, 0, which)] = life;
    templates[template_at(4u, 0, which)] = place;
    templates[template_at(5u, 0, which)] = vec4(right, 0.0);
    templates[template_at(6u, 0, which)] = vec4(up, 0.0);
}
