// Finds what is solid (Raseta et al. 2025, section 3.3) and tells of each pixel what the surface in
// it is like; `shade` lights it.
//
// This is the way by rays. The other draws triangles (geometry.vert, geometry.frag) and gives the
// same picture.
//@ option mode = auto {auto, rays, raster} : rays: by rays through the middles of pixels; raster: drawn; auto: drawn where the device is software (if it draws precisely) or a texture does not fit, else rays
#include "lib/frame.glsl"
#include "lib/surface.glsl"
uniform uint shown[8];              // a bit for each mesh, and for all instances of an object
uniform uint placed[8];             // the same of those that are such instances
uniform bool holes;                 // textures may be clear in places
uniform float max_distance;         //= 0 [0, inf] m : from the camera to the middle of an instance (of `instances`) beyond which it is left out, while its shadow stays; 0: none is
uniform float lod;                  //= 0 [0, 64] px : how far a simplified mesh may be off in the picture; 0: all are in full, as those rays meet them that look for light
writeonly uniform image2D albedo;   //= output rgba16f : base colour of the surface; alpha 0 where nothing is
writeonly uniform image2D normal;   //= output rgba16f : its normal in the world, towards the viewer
writeonly uniform image2D depth;    //= output r32f : distance along the view axis (m); 1e9 where nothing is
writeonly uniform image2D surface;  //= output rgba16f optional : specular, roughness, metallic; alpha 1 where model toon is allowed
writeonly uniform image2D emission; //= output rgba16f optional : radiance that the surface gives off

bool is_shown(uint mesh) {
    return (shown[mesh >> 5] >> (mesh & 31u) & 1u) != 0u;
}

// Looking at distances takes a ray a tenth more instructions even where none is asked for, so that
// there is a kernel for when max_distance or lod are above 0, and one without.
#if BY_DISTANCE
bool is_too_far(bvh_instance item) {
    if (max_distance == 0.0 || (placed[item.what.x >> 5] >> (item.what.x & 31u) & 1u) == 0u) return false;
    return distance(0.5 * (item.low + item.high), frame.eye.xyz) - frame.eye.w > max_distance;
}

// What the root of the item's tree has below it. The ray is in the space of its mesh.
uint below_root(bvh_ray ray, uint item) {
    return surface_level(ray, item, float(imageSize(depth).y) / (2.0 * frame.lens.y), lod);
}
#else
bool is_too_far(bvh_instance item) { return false; }
uint below_root(bvh_ray ray, uint item) { return bvh_instances[item].below; }
#endif

// One of what is placed.
void meet(uint item, int outer_top, inout bvh_ray ray, inout surface_hit hit) {
    if (!is_shown(bvh_instances[item].what.x) || is_too_far(bvh_instances[item])) return;
    if (!bvh_meets_box(ray, bvh_instances[item].low, bvh_instances[item].high)) return;
    bvh_ray inner = bvh_to_mesh(ray, item);
    int before = hit.triangle;
    hit.triangle = -1;
    surface_find(inner, item, below_root(inner, item), outer_top, holes, hit);
    if (hit.triangle < 0) {
        hit.triangle = before;
        return;
    }
    hit.instance = int(item);
    hit.way = inner.direction;
    ray.far = inner.far;
}

// Distances of the ray are depths, since its direction is one metre deep.
surface_hit find(inout bvh_ray ray) {
    surface_hit hit = surface_hit(-1, -1, vec2(0.0), vec3(0.0));
    bvh_walk w = bvh_begin(bvh_count.y, 0);
    for (uint leaf; (leaf = bvh_next_leaf(ray, w)) != 0u;)
        for (uint i = bvh_first(leaf); i < bvh_end(leaf); i++) meet(i, w.top, ray, hit);
    return hit;
}

// In the world, on the side of the triangle that is seen. Its front is where its corners turn to the
// left, of a mesh that is mirrored, too: the normals of its vertices are mirrored, its corners' turn
// is not.
vec3 normal_at(surface_hit hit, uvec4 corners) {
    vec3 a = surface_vertices[corners.x].normal_v.xyz, b = surface_vertices[corners.y].normal_v.xyz;
    vec3 c = surface_vertices[corners.z].normal_v.xyz;
    vec3 n = a + hit.where.x * (b - a) + hit.where.y * (c - a);
    vec3 x = bvh_instances[hit.instance].inverse[0].xyz, y = bvh_instances[hit.instance].inverse[1].xyz;
    vec3 z = bvh_instances[hit.instance].inverse[2].xyz;
    bvh_triangle t = bvh_triangles[hit.triangle];
    float towards = dot(cross(t.first.xyz, t.second.xyz), hit.way) * dot(x, cross(y, z));
    vec3 world = normalize(n.x * x + n.y * y + n.z * z);
    return towards < 0.0 ? world : -world;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(depth);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    bvh_ray ray = bvh_make_ray(frame.eye.xyz, frame_ray(uv), frame.lens.z, frame.lens.w);
    surface_hit hit = find(ray);
    vec4 color = vec4(0.0), facing = vec4(0.0), kind = vec4(0.0), glow = vec4(0.0);
    if (hit.instance >= 0) {
        uvec4 corners = surface_triangles[hit.triangle];
        surface_material m = surface_materials[bvh_instances[hit.instance].what.z + corners.w];
        color = m.texture.x == 0u ? m.color : surface_color(m, surface_uv(corners, hit.where));
        color = vec4(color.rgb * bvh_instances[hit.instance].color.rgb, 1.0);
        facing.xyz = normal_at(hit, corners);
        kind = m.surface;
        glow = m.emission * bvh_instances[hit.instance].color.w;
    }
    imageStore(albedo, pixel, color);
    imageStore(normal, pixel, facing);
    imageStore(surface, pixel, kind);
    imageStore(emission, pixel, glow);
    imageStore(depth, pixel, vec4(hit.instance >= 0 ? ray.far : 1e9));
}
