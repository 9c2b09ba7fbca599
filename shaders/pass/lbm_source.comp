// Where simulated air is given smoke, heat, dye and speed, before each of its steps. Fields are
// evaluated at the time of the step. What is not given stays as the air has it.
//
// A thread does one element of the state: four or eight cells that lie apart along z.
layout(local_size_x = 32, local_size_y = 2, local_size_z = 1) in;
//@ option rule = auto {auto, solid, shell} : which cells its meshes are, as of `voxels`; solid keeps thin parts thin
//@ field float shape = 0 : the source is where this is above 0.5; without it, in the meshes that it is given
//@ field float density = 0 : smoke
//@ field float temperature = 0 : heat
//@ field float dye = 0 : a second colour of smoke
//@ field vec3 velocity = {0, 0, 0} : of the air there (m/s)
//@ field float pressure = 0 : beyond that of the air around (Pa): a source that holds it blows new air out where otherwise it only pushes on what is there
uniform float rate;            //= 0 [0, 1e4] 1/s : how fast the air takes on these values; 0: at once
uniform float velocity_factor; //= 0 [-10, 10] : share of the meshes' own motion that is added to the velocity
#include "shared.h"
#include "fields.glsl"
#include "sim/lbm/cells.glsl"
uniform vec3 box_min;     // corner of the lattice (m)
uniform float cell_size;  // m
uniform float step_speed; // cells a step of 1 m/s
uniform float pascal;     // excess of density of a pascal
uniform float share;      // of the values that the air takes on in this step
uniform vec3 first;       // cells of the source's box: of the first corner,
uniform vec3 count;       // and how many
uniform vec2 ids;         // of its meshes: the first and the last

#if MESHES
layout(std430) readonly buffer SourceIds { uint source_ids[]; };
layout(std430) readonly buffer SourceMotions { voxel_motion source_motions[]; };

uint body_at(uvec3 cell) {
    uint at = cell.x + LBM_NX * (cell.y + LBM_NY * cell.z);
    return source_ids[at >> 2] >> (8u * (at & 3u)) & 0xffu;
}
#endif

uvec3 cell_of(uvec3 at, int lane) {
    return uvec3(at.xy, at.z + uint(lane) * LBM_LAYERS);
}

vec3 point_of(uvec3 cell) {
    return box_min + (vec3(cell) + 0.5) * cell_size;
}

bool gives(uvec3 cell) {
    if (any(lessThan(vec3(cell), first)) || any(greaterThanEqual(vec3(cell), first + count)))
        return false;
#if MESHES
    uint id = body_at(cell);
    if (id < uint(ids.x) || id > uint(ids.y)) return false;
#if !HAS_SHAPE
    return true;
#endif
#endif
    return field_shape(point_of(cell)) > 0.5;
}

vec3 velocity_at(uvec3 cell) {
    vec3 p = point_of(cell), v = field_velocity(p);
#if MESHES
    voxel_motion body = source_motions[body_at(cell)];
    vec3 r = p - body.centre.xyz;
    v += velocity_factor * (body.linear.xyz + cross(body.angular.xyz, r) + body.linear.w * r);
#endif
    return v * step_speed;
}

#define EACH_CHUNK for (int c = 0; c < LBM_CHUNKS; c++)
#define EACH_LANE for (int l = 0; l < 4; l++)

// Density less 1, and velocity, of four cells.
vec4 excess_of(lbm_element q[LBM_Q], int chunk, out lbm_vec u) {
    vec4 excess = lbm_unpack(q[0], chunk, LBM_AIR_SCALE);
    u = lbm_vec_all(vec3(0.0));
#define SUM(i, dx, dy, dz)                                                                         \
    {                                                                                              \
        vec4 a = lbm_unpack(q[i], chunk, LBM_AIR_SCALE);                                           \
        vec4 b = lbm_unpack(q[i + 1], chunk, LBM_AIR_SCALE);                                       \
        excess += a + b;                                                                           \
        u.x += float(dx) * (a - b);                                                                \
        u.y += float(dy) * (a - b);                                                                \
        u.z += float(dz) * (a - b);                                                                \
    }
    LBM_PAIRS(SUM)
#undef SUM
    vec4 density = 1.0 + excess;
    u = lbm_vec(u.x / density, u.y / density, u.z / density);
    return excess;
}

// What is not given stays as it is: the pressure, above all, so that as much air is drawn in as is
// blown out.
void push(inout lbm_element q[LBM_Q], uvec3 at, int chunk, vec4 some, inout lbm_vec u) {
    lbm_vec old;
    vec4 excess = excess_of(q, chunk, old), f[LBM_Q];
    u = old;
    EACH_LANE {
        if (some[l] == 0.0) continue;
        uvec3 cell = cell_of(at, 4 * chunk + l);
#if HAS_PRESSURE
        excess[l] = mix(excess[l], field_pressure(point_of(cell)) * pascal, some[l]);
#endif
        if (HAS_VELOCITY == 0 && velocity_factor == 0.0) continue;
        vec3 v = velocity_at(cell);
        u.x[l] = mix(u.x[l], v.x, some[l]);
        u.y[l] = mix(u.y[l], v.y, some[l]);
        u.z[l] = mix(u.z[l], v.z, some[l]);
    }
    lbm_set_equilibrium(excess, u, f);
    for (int i = 0; i < LBM_Q; i++)
        lbm_pack(q[i], chunk, LBM_AIR_SCALE,
                 mix(lbm_unpack(q[i], chunk, LBM_AIR_SCALE), f[i], some));
}

void carry(inout lbm_element q[LBM_SCALAR_Q], int chunk, vec4 some, vec4 value, lbm_vec u) {
    vec4 g[LBM_SCALAR_Q];
    lbm_set_scalar_equilibrium(value, u, g);
    for (int i = 0; i < LBM_SCALAR_Q; i++)
        lbm_pack(q[i], chunk, LBM_SCALAR_SCALE,
                 mix(lbm_unpack(q[i], chunk, LBM_SCALAR_SCALE), g[i], some));
}

#define GIVE(s, FIELD)                                                                             \
    {                                                                                              \
        lbm_element q[LBM_SCALAR_Q];                                                               \
        lbm_load_scalar(s, place, q);                                                              \
        EACH_CHUNK {                                                                               \
            vec4 value = vec4(0.0);                                                                \
            EACH_LANE if (some[c][l] > 0.0) value[l] = FIELD(point_of(cell_of(at, 4 * c + l)));    \
            carry(q, c, some[c], value, u[c]);                                                     \
        }                                                                                          \
        lbm_replace_scalar(s, place, q);                                                           \
    }

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (any(greaterThanEqual(vec3(at), min(count, vec3(count.xy, LBM_LAYERS))))) return;
    at += uvec3(first);
    at.z %= LBM_LAYERS;
    lbm_place place = lbm_place_at(at);
    uint solid = lbm_site_at(at, place.own).solid; // nothing comes out of walls and colliders
    vec4 some[LBM_CHUNKS];
    bool any_ = false;
    EACH_CHUNK EACH_LANE {
        bool here = (solid >> 4 * c + l & 1u) == 0u && gives(cell_of(at, 4 * c + l));
        some[c][l] = here ? share : 0.0;
        any_ = any_ || here;
    }
    if (!any_) return;
    lbm_element air[LBM_Q];
    lbm_load_air(place, air);
    lbm_vec u[LBM_CHUNKS];
    if (HAS_VELOCITY == 1 || HAS_PRESSURE == 1 || velocity_factor != 0.0) {
        EACH_CHUNK push(air, at, c, some[c], u[c]);
        lbm_replace_air(place, air);
    } else {
        EACH_CHUNK excess_of(air, c, u[c]);
    }
#if HAS_DENSITY
    GIVE(0, field_density)
#endif
#if HAS_TEMPERATURE
    GIVE(1, field_temperature)
#endif
#if HAS_DYE
    GIVE(2, field_dye)
#endif
}
