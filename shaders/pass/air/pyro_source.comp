// Where burning gas is given fuel, heat, soot and speed, before each of its steps. What is not given
// stays as the gas has it. Here the fields, cell by cell of the source's box, so many times a second
// of the simulation; pass/air/pyro/give.comp gives them to the gas.
//@ option rule = auto {auto, solid, shell} : which cells its meshes are, as of `voxels`: auto is a shell, hollow, where a mesh is open; solid fills what is inside, even with holes, and keeps thin parts thin
//@ field float shape = 0 : the source is where this is above 0.5, and within its meshes and near its particles if it has any; without it, it is there
//@ field float fuel = 0 : vapour or mist of fuel (kg/m^3): 2 is a rich cloud that burns as it mixes, air burns 0.07 of petrol
//@ field float temperature = 0 : kelvin; fuel lights above its temperature of ignition
//@ field float soot = 0 : black smoke (kg/m^3): 0.001 hides what is a few metres behind it
//@ field float smoke = 0 : smoke that does not glow or burn (kg/m^3): steam, dust
//@ field vec3 velocity = {0, 0, 0} : of the gas there (m/s)
uniform float rate;            //= 0 [0, 1e4] 1/s : how fast the gas takes on these values; 0: at once
uniform vec2 during;           //= {-1e6, 1e6} [-1e6, 1e6] s : from when to when it gives
uniform float velocity_factor; //= 0 [-10, 10] : share of the meshes' or particles' own motion that is added to the velocity
#include "fields.glsl"
uniform vec3 box_min;    // corner of the box (m)
uniform float cell_size; // m
uniform vec3 first;      // cells of the source's box: of the first corner,
uniform vec3 count;      // and how many
// Halves: fuel and temperature, soot and 1 within the shape, velocity and smoke.
layout(std430) writeonly buffer SourceValues { uvec4 source_values[]; };

#include "source_particles.glsl"

#if defined(STAGE_EVALUATE)
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

// What is no number would spoil the gas for good: it becomes 0.
vec4 numbers_of(vec4 v, vec4 least, vec4 most) {
    v = mix(v, vec4(0.0), equal(floatBitsToUint(v) & 0x7f800000u, uvec4(0x7f800000u)));
    return clamp(v, least, most);
}

void main() {
    uvec3 at = gl_GlobalInvocationID, n = uvec3(count);
    if (any(greaterThanEqual(at, n))) return;
    vec3 p = box_min + (first + vec3(at) + 0.5) * cell_size;
    uint cell = at.x + n.x * (at.y + n.y * at.z);
    uvec4 values = uvec4(0u);
    vec3 moves;
    if (source_is_near(cell, moves) && (HAS_SHAPE == 0 || field_shape(p) > 0.5)) {
        vec4 gas = numbers_of(vec4(field_fuel(p), field_temperature(p), field_soot(p), field_smoke(p)), vec4(0.0),
                              vec4(1e3, 1e4, 1e3, 1e3));
        vec4 flow = numbers_of(vec4(field_velocity(p) + moves, 0.0), vec4(-1e4), vec4(1e4));
        values = uvec4(packHalf2x16(gas.xy), packHalf2x16(vec2(gas.z, 1.0)), packHalf2x16(flow.xy),
                       packHalf2x16(vec2(flow.z, gas.w)));
    }
    source_values[cell] = values;
}
#endif
