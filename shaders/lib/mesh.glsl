// How a vertex shader gets at its vertex: out of storage buffers, by gl_VertexIndex, of the instance
// that the list names at gl_InstanceIndex (src/pass/surfaces/drawn.h).
#include "lib/mesh_part.glsl"
#include "lib/turn.glsl"
layout(std430) readonly buffer Vertices { surface_vertex mesh_vertices[]; };
layout(std430) readonly buffer Instances { instance_entry mesh_instances[]; };
layout(std430) readonly buffer InstanceList { uint mesh_list[]; };
#if WITHOUT_FIRST_INSTANCE // a draw is of one bucket, and its instances are counted from 0
layout(std430) readonly buffer DrawnFirsts { uint mesh_firsts[]; };
uint mesh_listed() { return mesh_list[mesh_firsts[part.flags.z] + uint(gl_InstanceIndex)]; }
#else
uint mesh_listed() { return mesh_list[gl_InstanceIndex]; }
#endif

struct mesh_point {
    vec3 position; // in the world (m)
    vec3 normal;   // not of length 1
    vec2 uv;
    vec4 tint;     // of the instance: rgb: factor of the colour; w: glow, factor of what is emitted
    uint instance; // its place in `mesh_instances`
};

mesh_point mesh_pull() {
    uint number = mesh_listed();
    surface_vertex v = mesh_vertices[gl_VertexIndex];
    vec4 place = mesh_instances[number].place, turn = mesh_instances[number].turn;
    vec3 within = turn_vector(turn, v.position_u.xyz) * place.w + place.xyz;
    // Turns and scales that are the same along all axes: normals go as directions do.
    vec3 normal = turn_vector(turn, v.normal_v.xyz) * sign(place.w);
    return mesh_point((part.place * vec4(within, 1.0)).xyz, mat3(part.place) * normal,
                      vec2(v.position_u.w, v.normal_v.w), mesh_instances[number].color, number);
}
