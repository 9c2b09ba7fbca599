// What a ray from the camera sees of the meshes (src/scene/surfaces.h): unlike lib/bvh.glsl it minds
// the textures, their holes and the normals of the vertices, and lets no ray through where triangles
// meet.
#ifndef LIB_SURFACE_GLSL
#define LIB_SURFACE_GLSL
#include "lib/bvh.glsl"
#include "lib/level.glsl"
layout(std430) readonly buffer BvhSurfaces { uvec4 surface_triangles[]; };
layout(std430) readonly buffer BvhVertices { surface_vertex surface_vertices[]; };
layout(std430) readonly buffer BvhMaterials { surface_material surface_materials[]; };
layout(std430) readonly buffer BvhTexels { uvec2 surface_texels[]; };
layout(std430) readonly buffer BvhLevels { bvh_levels surface_levels[]; };

// Radiance that a triangle of what is placed gives off.
vec3 surface_emission(ivec2 what) {
    uint material = bvh_instances[what.x].what.z + surface_triangles[what.y].w;
    return surface_materials[material].emission.rgb * bvh_instances[what.x].color.w;
}

// Of a material with a texture, which is repeated and linear between texels.
vec4 surface_color(surface_material m, vec2 uv) {
    ivec2 size = ivec2(m.texture.xy);
    vec2 at = fract(uv) * vec2(size) - 0.5, part = at - floor(at);
    ivec2 low = ivec2(floor(at)), high = low + 1;
    low += size * ivec2(lessThan(low, ivec2(0)));
    high -= size * ivec2(greaterThanEqual(high, size));
    ivec4 row = int(m.texture.z) + ivec4(low.y, low.y, high.y, high.y) * size.x;
    ivec4 texel = row + ivec4(low.x, high.x, low.x, high.x);
    vec4 c[4];
    for (int i = 0; i < 4; i++) {
        uvec2 packed = surface_texels[texel[i]];
        c[i] = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
    }
    return m.color * mix(mix(c[0], c[1], part.x), mix(c[2], c[3], part.x), part.y);
}

vec2 surface_uv(uvec4 corners, vec2 where) {
    vec4 a_position = surface_vertices[corners.x].position_u, a_normal = surface_vertices[corners.x].normal_v;
    vec4 b_position = surface_vertices[corners.y].position_u, b_normal = surface_vertices[corners.y].normal_v;
    vec4 c_position = surface_vertices[corners.z].position_u, c_normal = surface_vertices[corners.z].normal_v;
    vec2 a = vec2(a_position.w, a_normal.w), b = vec2(b_position.w, b_normal.w);
    vec2 c = vec2(c_position.w, c_normal.w);
    return a + where.x * (b - a) + where.y * (c - a);
}

// `materials`: the first of those of its mesh.
bool surface_has_hole(uint materials, uint triangle, vec2 where) {
    uvec4 corners = surface_triangles[triangle];
    surface_material m = surface_materials[materials + corners.w];
    return m.texture.w != 0u && surface_color(m, surface_uv(corners, where)).a < 0.5;
}

// Distance to a triangle, -1 if the ray misses it, as in bvh_meet_triangle, and where it was hit. What
// rounding can do to the edges belongs to the triangle: the two at an edge overlap a little instead of
// leaving a gap.
float surface_meet(bvh_ray ray, bvh_triangle t, out vec2 where) {
    vec3 from = ray.origin - t.corner.xyz;
    vec3 across_second = cross(ray.direction, t.second.xyz), across_first = cross(t.first.xyz, ray.direction);
    float scale = 1.0 / dot(t.first.xyz, across_second);
    where = vec2(dot(from, across_second), dot(from, across_first)) * scale;
    vec2 slack = vec2(dot(abs(from), abs(across_second)), dot(abs(from), abs(across_first))) * abs(5e-7 * scale);
    float distance = dot(from, cross(t.first.xyz, t.second.xyz)) * scale;
    bool inside = where.x >= -slack.x && where.y >= -slack.y && where.x + where.y <= 1.0 + slack.x + slack.y;
    return inside && distance >= ray.near ? distance : -1.0;
}

struct surface_hit {
    int instance, triangle; // -1: none
    vec2 where;             // on it: parts of its first and second edge
    vec3 way;               // of the ray, in the space of the mesh
};

// What the root of a mesh's tree has below it, of the mesh as simplified as it may be for a ray from the
// eye, which is in its space. `pixels`: of a metre at 1 m; `lod`: those that it may be off.
uint surface_level(bvh_ray ray, uint instance, float pixels, float lod) {
    if (lod <= 0.0) return bvh_instances[instance].below;
    bvh_levels mesh = surface_levels[bvh_instances[instance].what.w];
    return mesh.below[level_of(mesh.errors, pixels, lod, distance(ray.origin, mesh.ball.xyz), mesh.ball.w)];
}

// The nearest triangle of the tree that the root has below it; the ray is in the space of what is placed.
// `outer_top`: of the walk that found it.
void surface_find(inout bvh_ray ray, uint instance, uint below, int outer_top, bool holes, inout surface_hit hit) {
    bvh_walk w = bvh_begin(below, outer_top);
    uint materials = bvh_instances[instance].what.z;
    for (uint leaf; (leaf = bvh_next_leaf(ray, w)) != 0u;) {
        for (uint i = bvh_first(leaf); i < bvh_end(leaf); i++) {
            vec2 where;
            float distance = surface_meet(ray, bvh_triangles[i], where);
            if (distance < 0.0 || distance > ray.far) continue;
            if (holes && surface_has_hole(materials, i, where)) continue;
            ray.far = distance;
            hit.triangle = int(i);
            hit.where = where;
        }
    }
}
#endif
