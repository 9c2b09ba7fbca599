// One step of a lattice Boltzmann solver: each thread takes what arrives at an element, collides
// it, and sends it off; with LBM_BUNDLED at the elements of a bundle. Not a pass of its own: see
// src/sim/lbm_step.c.
#if LBM_SOFTWARE
#extension GL_ARB_gpu_shader_int64 : require
#endif
layout(local_size_x = LBM_GROUP) in;
#define LBM_BUNDLED (LBM_BUNDLE > 1)
#include "sim/lbm/state.glsl"
#include "sim/lbm/collide.glsl"
#include "sim/lbm/scalar.glsl"
#include "sim/lbm/walls.glsl"

// All elements (bundles); or those that no face touches which is not periodic, the core, and the others, the skin,
// which are in a list: src/sim/lbm_step.c says when.
#define SKIN (LBM_REGION == LBM_SKIN || LBM_REGION == LBM_SKIN_FIRST)
#define CORE (LBM_REGION == LBM_CORE || LBM_REGION == LBM_SKIN_FIRST)
#if SKIN
layout(std430) readonly buffer LbmSkin { uint skin[]; }; // as elements are counted
uniform uint skin_count;
uniform uint skin_layers; // of threads, with LBM_SKIN_FIRST
#endif
#define WALLED (LBM_WALLED && (LBM_BODIES || LBM_REGION != LBM_CORE))
// Faces or bodies may change what arrives.
#define MEETS (LBM_BODIES || LBM_RIMS && LBM_REGION != LBM_CORE)
// Scalars of 27 directions do not fit into registers beside the air: they go one by one.
#define ALONE (LBM_SCALAR_Q == 27 && LBM_SCALARS > 0 && LBM_SOFTWARE == 0)

uniform float tau;
uniform float smagorinsky;
uniform vec3 acceleration;
uniform float max_speed;
uniform vec3 scalar_tau;
uniform vec3 buoyancy[3]; // by 1 of a scalar above ambient
uniform vec3 ambient;
uniform vec3 decay;
#if LBM_FORCE
uniform sampler3D force; //= input : acceleration, times force_scale
uniform float force_scale;
#if LBM_OUTFLOW
uniform float outflow_scale; // of the fourth channel: what comes out of a place in a step, by what is there
lbm_float grows;             // of the element
#endif
#endif
#if LBM_KEEP
layout(std430) writeonly buffer LbmMoments { uvec4 moments[]; };
#endif

// The diffusion that eddies add is their viscosity over this, the turbulent Schmidt number.
#define SCHMIDT 0.7

lbm_place place;

// An element:
uvec3 at; // x, y, layer
uint element;
lbm_site site;
#define HELD (ALONE ? 1 : max(LBM_SCALARS, 1)) // scalars at a time
lbm_element air[LBM_Q], carried[HELD][LBM_SCALAR_Q];

// What arrives, and then leaves, at once; apart from the element where it is a bundle, or where what arrived is
// wanted again (processors take both ways of a branch: copies cost them less than loads).
#define APART (LBM_BUNDLED || WALLED && LBM_SOFTWARE)
#if APART
lbm_access all_air[LBM_Q], all_carried[HELD][LBM_SCALAR_Q];
#else
#define all_air air
#define all_carried carried
#endif

lbm_float value[3]; // of scalars

#if LBM_FORCE
#if LBM_OUTFLOW
#define FIND_OUTFLOW(lane) grows[lane] = outflow_scale * more.w;
#else
#define FIND_OUTFLOW(lane)
#endif
void add_force(inout lbm_vec a) {
#define ADD(lane)                                                                                  \
    {                                                                                              \
        vec3 cell = vec3(at.xy, at.z + LBM_LAYERS * uint(lane)) + 0.5;                             \
        vec3 p = cell / vec3(LBM_NX, LBM_NY, LBM_LAYERS * LBM_LANES);                              \
        vec4 more = textureLod(force, p, 0.0);                                                     \
        a.x[lane] += force_scale * more.x;                                                         \
        a.y[lane] += force_scale * more.y;                                                         \
        a.z[lane] += force_scale * more.z;                                                         \
        FIND_OUTFLOW(lane)                                                                         \
    }
    LBM_EACH_LANE(ADD)
#undef ADD
}
#endif

#if LBM_OUTFLOW
// More of the same air comes, as fast as it is, with what it carries; or it goes. Populations are less their
// weights.
void grow_air() {
    lbm_float k = 1.0 + grows;
    air[0] = lbm_pack(LBM_AIR_SCALE, k * lbm_unpack(air[0], LBM_AIR_SCALE) + LBM_REST * grows);
#define GROW(i, x, y, z)                                                                           \
    {                                                                                              \
        lbm_float more = LBM_WEIGHT(x, y, z) * grows;                                              \
        air[i] = lbm_pack(LBM_AIR_SCALE, k * lbm_unpack(air[i], LBM_AIR_SCALE) + more);            \
        air[i + 1] = lbm_pack(LBM_AIR_SCALE, k * lbm_unpack(air[i + 1], LBM_AIR_SCALE) + more);    \
    }
    LBM_PAIRS(GROW)
#undef GROW
}
#endif

lbm_vec find_force(lbm_float density) {
    lbm_vec a = lbm_vec_all(acceleration);
#define RISE(s)                                                                                    \
    {                                                                                              \
        lbm_float above = value[s] - ambient[s];                                                   \
        a.x += above * buoyancy[s].x;                                                              \
        a.y += above * buoyancy[s].y;                                                              \
        a.z += above * buoyancy[s].z;                                                              \
    }
    LBM_EACH_SCALAR(RISE)
#undef RISE
#if LBM_FORCE
    add_force(a);
#endif
    return lbm_vec(density * a.x, density * a.y, density * a.z);
}

// Velocities above `most` are cut off: that costs momentum, and keeps what would burst.
void limit(inout lbm_vec u, float most) {
    lbm_float factor = min(lbm_float(1.0), most * inversesqrt(max(lbm_dot(u, u), 1e-20)));
    u = lbm_vec(u.x * factor, u.y * factor, u.z * factor);
}

lbm_air find_air() {
    lbm_air a;
    lbm_sums sums = lbm_sum(air);
    lbm_vec momentum = sums.momentum;
    a.excess = sums.excess;
    lbm_float density = 1.0 + a.excess, volume = 1.0 / density;
    a.force = find_force(density);
#if LBM_WEIGHTS_ONLY
    a.u = lbm_vec(momentum.x * volume, momentum.y * volume, momentum.z * volume);
#else
    a.u = lbm_vec((momentum.x + 0.5 * a.force.x) * volume, (momentum.y + 0.5 * a.force.y) * volume,
                  (momentum.z + 0.5 * a.force.z) * volume);
#endif
    limit(a.u, max_speed);
#if LBM_CENTRAL_MOMENTS || LBM_SUBGRID
    a.stress = lbm_stress(sums.second, a.excess, a.u, a.force);
#endif
    return a;
}

#if LBM_KEEP
// Of solid lanes: none, and that they are.
void keep_solid() {
#if WALLED
    for (uint lane = 0u; lane < LBM_LANES; lane++)
        if ((site.solid >> lane & 1u) != 0u)
            moments[element + lane * LBM_ELEMENTS] = uvec4(0u, 0u, 0u, packHalf2x16(vec2(0.0, 1.0)));
#endif
}

void keep_moments(lbm_air a) {
#define KEEP(lane)                                                                                 \
    moments[element + uint(lane) * LBM_ELEMENTS] =                                                 \
        uvec4(packHalf2x16(vec2(a.u.x[lane], a.u.y[lane])),                                        \
              packHalf2x16(vec2(a.u.z[lane], a.excess[lane])),                                     \
              packHalf2x16(vec2(value[0][lane], value[1][lane])),                                  \
              packHalf2x16(vec2(value[2][lane], 0.0)));
    LBM_EACH_LANE(KEEP)
#undef KEEP
}
#endif

// ---- what is loaded and stored ---------------------------------------------------------------

void take_air() {
#if APART
    for (int i = 0; i < LBM_Q; i++) air[i] = lbm_take(all_air[i]);
#endif
}

void take_scalar(const int held) {
#if APART
    for (int i = 0; i < LBM_SCALAR_Q; i++) carried[held][i] = lbm_take(all_carried[held][i]);
#endif
}

void give_air() {
#if APART
    for (int i = 0; i < LBM_Q; i++) lbm_give(all_air[i], air[i]);
#endif
}

void give_scalar(const int held) {
#if APART
    for (int i = 0; i < LBM_SCALAR_Q; i++) lbm_give(all_carried[held][i], carried[held][i]);
#endif
}

// ---- an element -------------------------------------------------------------------------------

#if MEETS
// `wave`: a step of the waves at open faces, too, which is done once.
// In full precision memory holds what is computed with: a copy would count among the arrays of a thread, which are
// limited.
void meet_air(const bool wave) {
#if LBM_HALF
    lbm_float f[LBM_Q];
    lbm_unpack_air(air, LBM_AIR_SCALE, f);
    lbm_meet_air(at, site, wave, f);
    lbm_pack_air(f, LBM_AIR_SCALE, air);
#else
    lbm_meet_air(at, site, wave, air);
#endif
}

void meet_scalar(const int s, const int held) {
#if LBM_HALF
    lbm_float g[LBM_SCALAR_Q];
    lbm_unpack_scalar(carried[held], LBM_SCALAR_SCALE, g);
    lbm_meet_scalar(s, at, site, ambient[s], g);
    lbm_pack_scalar(g, LBM_SCALAR_SCALE, carried[held]);
#else
    lbm_meet_scalar(s, at, site, ambient[s], carried[held]);
#endif
}
#endif

// By the scalars' values. `eddies`: what they add to the relaxation time.
void collide_air(out lbm_vec u, out lbm_float eddies) {
    lbm_air a = find_air();
#if LBM_KEEP
    keep_moments(a);
#endif
    eddies = lbm_float(0.0);
#if LBM_SUBGRID
    eddies = lbm_eddy_tau(a, tau, smagorinsky) - tau;
#endif
#if LBM_ROUTES
    if (site.reached != 0u) lbm_begin_routes(air);
#endif
    lbm_collide(a, 1.0 / (tau + eddies), air);
#if LBM_ROUTES
    if (site.reached != 0u) lbm_end_routes(air, 1.0 + a.excess, a.u);
#endif
#if LBM_OUTFLOW
    grow_air();
#endif
    u = a.u;
}

void collide_scalar(const int s, const int held, lbm_vec u, lbm_float eddies) {
#if LBM_HALF
    lbm_float g[LBM_SCALAR_Q];
    lbm_unpack_scalar(carried[held], LBM_SCALAR_SCALE, g);
#else
#define g carried[held]
#endif
    lbm_collide_scalar(value[s], u,
                       1.0 / (scalar_tau[s] + eddies * (1.0 / (3.0 * SCHMIDT * LBM_SCALAR_SPEED))),
                       1.0 - decay[s], ambient[s], g);
#if LBM_ROUTES
    if (site.reached != 0u) lbm_route_scalar(value[s], site.reached, 1.0 - decay[s], ambient[s], g);
#endif
#if LBM_OUTFLOW
#if ALONE // the air of all elements went before
    lbm_vec none = lbm_vec_all(vec3(0.0));
    add_force(none);
#endif
    for (int i = 0; i < LBM_SCALAR_Q; i++) g[i] *= 1.0 + grows;
#endif
#if LBM_HALF
    lbm_pack_scalar(g, LBM_SCALAR_SCALE, carried[held]);
#else
#undef g
#endif
}

// In these lanes what arrived stays.
void keep_air(uint lanes) {
#if !LBM_SOFTWARE
    if (lanes == 0u) return;
#endif
    lbm_element arrived[LBM_Q];
#if APART
    for (int i = 0; i < LBM_Q; i++) arrived[i] = lbm_take(all_air[i]);
#else
    lbm_load_air(place, arrived);
#endif
    lbm_keep_air(lanes, arrived, air);
}

void keep_scalar(const int s, const int held, uint lanes) {
#if !LBM_SOFTWARE
    if (lanes == 0u) return;
#endif
    lbm_element arrived[LBM_SCALAR_Q];
#if APART
    for (int i = 0; i < LBM_SCALAR_Q; i++) arrived[i] = lbm_take(all_carried[held][i]);
#else
    lbm_load_scalar(s, place, arrived);
#endif
    lbm_keep_scalar(lanes, arrived, carried[held]);
}

// False: there is no air in it.
bool find_site() {
    element = lbm_element_at(at);
#if WALLED
    site = lbm_site_at(at, element);
    if (site.solid == LBM_ALL_LANES) {
#if LBM_KEEP
        keep_solid();
#endif
        return false;
    }
#endif
    return true;
}

// ---- all ---------------------------------------------------------------------------------------

// The thread's element, or the first of its bundle. One function for each region would be shorter: compilers then know
// less of where the threads of a group are, and steps take up to 14 % longer.
bool find() {
    uint thread = gl_GlobalInvocationID.x, layer = gl_GlobalInvocationID.z;
#if SKIN
#if LBM_REGION == LBM_SKIN_FIRST
    const bool in_skin = layer < skin_layers;
    if (in_skin && thread >= LBM_LAYER) return false;
    if (in_skin) thread += LBM_LAYER * layer;
    layer -= skin_layers;
#else
    const bool in_skin = true;
#endif
    if (in_skin) {
        if (thread >= skin_count) return false;
        uint first = skin[thread], column = first % LBM_LAYER;
        at = uvec3(column % LBM_NX, column / LBM_NX, first / LBM_LAYER);
        return true;
    }
#endif
#if CORE
    const uvec3 rim = uvec3(LBM_FACE_0 != 0, LBM_FACE_2 != 0, LBM_FACE_4 != 0);
    const uvec2 size = uvec2(LBM_NX, LBM_NY) - 2u * rim.xy;
    if (thread >= size.x * size.y) return false;
    at = uvec3(thread % size.x, thread / size.x, layer) + rim;
    if (at.z >= LBM_DEPTH - rim.z) return false;
#else
    if (thread >= LBM_LAYER) return false;
    at = uvec3(thread % LBM_NX, thread / LBM_NX, layer);
#endif
    return true;
}

#if LBM_BUNDLED
// LBM_ROWS, but no compiler knows that it is no more: unrolled, the numbers of all rows would want
// registers at once.
#define ROWS (LBM_ROWS + (lbm_parity & 2u))

bool has_air() {
    return find_site();
}
#else
#define ROWS 1u
bool has_air() {
    return true;
}
#endif
#if LBM_SOFTWARE
#define EACH_ELEMENT // a loop of one turn costs processors a third
#else
#define EACH_ELEMENT for (uint row = 0u; row < ROWS; row++, at.z += LBM_SPAN)
#define AGAIN at.z -= LBM_LAYERS; // to the first
#endif

#if ALONE
#include "sim/lbm/alone.glsl"
#else
void keep(uint lanes) {
    keep_air(lanes);
#define KEEP(s) keep_scalar(s, s, lanes);
    LBM_EACH_SCALAR(KEEP)
#undef KEEP
}

void step_element() {
#if MEETS
    if (lbm_meets(at, site)) {
        lbm_find_bodies(at, site);
        meet_air(true);
#define MEET(s) meet_scalar(s, s);
        LBM_EACH_SCALAR(MEET)
#undef MEET
    }
#endif
    lbm_vec u;
    lbm_float eddies;
    value[0] = value[1] = value[2] = lbm_float(0.0);
#define SUM(s) value[s] = lbm_sum_scalar(carried[s]);
    LBM_EACH_SCALAR(SUM)
#undef SUM
    collide_air(u, eddies);
#define COLLIDE(s) collide_scalar(s, s, u, eddies);
    LBM_EACH_SCALAR(COLLIDE)
#undef COLLIDE
#if LBM_KEEP
    keep_solid();
#endif
#if WALLED
    keep(site.solid);
#endif
}

void step_all() {
#define LOAD(s) lbm_load_scalar(s, place, all_carried[s]);
    LBM_EACH_SCALAR(LOAD)
#undef LOAD
    lbm_load_air(place, all_air);
    EACH_ELEMENT {
#define TAKE(s) take_scalar(s);
        take_air();
        LBM_EACH_SCALAR(TAKE)
#undef TAKE
        if (has_air())
            step_element();
        else
            keep(LBM_ALL_LANES);
#define GIVE(s) give_scalar(s);
        give_air();
        LBM_EACH_SCALAR(GIVE)
#undef GIVE
    }
    lbm_send_air(place, all_air);
#define SEND(s) lbm_send_scalar(s, place, all_carried[s]);
    LBM_EACH_SCALAR(SEND)
#undef SEND
}
#endif

void main() {
    if (!find()) return;
#if !LBM_BUNDLED
    if (!find_site()) return;
#endif
    place = lbm_place_at(at);
    step_all();
}
