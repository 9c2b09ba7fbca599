// Where simulated air is given smoke, heat, dye and speed, before each of its steps. What is not
// given stays as the air has it. Here the fields, cell by cell of the source's box, so many times a
// second of the simulation; pass/air/lbm/give.comp gives them to the air.
//@ option rule = auto {auto, solid, shell} : which cells its meshes are, as of `voxels`: auto is a shell, hollow, where a mesh is open; solid fills what is inside, even with holes, and keeps thin parts thin
//@ field float shape = 0 : the source is where this is above 0.5, and within its meshes and near its particles if it has any; without it, it is there
//@ field float density = 0 : smoke; up to 1e4, as temperature and dye: what is beyond counts as that
//@ field float temperature = 0 : heat
//@ field float dye = 0 : a second colour of smoke
//@ field vec3 velocity = {0, 0, 0} : of the air there (m/s)
//@ field float pressure = 0 : beyond that of the air around (Pa): a source that holds it blows new air out where otherwise it only pushes on what is there
uniform float rate;            //= 0 [0, 1e4] 1/s : how fast the air takes on these values; 0: at once
uniform vec2 during;           //= {-1e6, 1e6} [-1e6, 1e6] s : from when to when it gives
uniform float velocity_factor; //= 0 [-10, 10] : share of the meshes' or particles' own motion that is added to the velocity
#include "fields.glsl"
uniform vec3 box_min;    // corner of the lattice (m)
uniform float cell_size; // m
uniform vec3 first;      // cells of the source's box: of the first corner,
uniform vec3 count;      // and how many
// Halves: density and temperature, dye and 1 within the shape, velocity, pressure.
layout(std430) writeonly buffer SourceValues { uvec4 source_values[]; };

#include "source_particles.glsl"

#if defined(STAGE_EVALUATE)
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

// What is no number would spoil the air for good: it becomes 0. So would what is too large for the halves of its state.
vec4 numbers_of(vec4 v, float most) {
    v = mix(v, vec4(0.0), equal(floatBitsToUint(v) & 0x7f800000u, uvec4(0x7f800000u)));
    return clamp(v, -most, most);
}

void main() {
    uvec3 at = gl_GlobalInvocationID, n = uvec3(count);
    if (any(greaterThanEqual(at, n))) return;
    vec3 p = box_min + (first + vec3(at) + 0.5) * cell_size;
    uint cell = at.x + n.x * (at.y + n.y * at.z);
    uvec4 values = uvec4(0u);
    vec3 moves;
    if (source_is_near(cell, moves) && (HAS_SHAPE == 0 || field_shape(p) > 0.5)) {
        vec4 carried = numbers_of(vec4(field_density(p), field_temperature(p), field_dye(p), 0.0), 1e4);
        vec4 flow = numbers_of(vec4(field_velocity(p) + moves, field_pressure(p)), 65504.0);
        values = uvec4(packHalf2x16(carried.xy), packHalf2x16(vec2(carried.z, 1.0)), packHalf2x16(flow.xy),
                       packHalf2x16(flow.zw));
    }
    source_values[cell] = values;
}
#endif
