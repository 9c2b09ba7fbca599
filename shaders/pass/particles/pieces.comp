// Particles as small solid bodies: a mesh stands at each of them, before and behind the surfaces of a scene.
//
// pieces { shards, mesh { "data/ball.obj" }, from = scene } gives what `geometry` gives, the scene and
// the pieces: shade { from = drawn } lights both. Triangles are drawn whole, each by a few threads, in one
// colour and flat: made for many small ones. They throw shadows by way of `deposit` only.
//@ option turn = random {random, along} : random: about an axis of their own; along: with x along their way
//@ field float size = 1 : metres a unit of the mesh
//@ field vec3 color = {1, 1, 1} : factor of the mesh's colours
//@ field float glow = 1 : factor of what the mesh's material gives off
//@ field float angle = 0 : how far a piece is turned about its axis (degrees)
//@ counter triangles : drawn
#include "lib/particles.glsl"
uniform sampler2D scene_albedo;   //= input optional : of what is solid besides; `from` a pass geometry gives all three
uniform sampler2D scene_normal;   //= input optional : how that is turned
uniform sampler2D scene_depth;    //= input optional : how far away that is (m)
uniform sampler2D scene_surface;  //= input optional : how that reflects
uniform sampler2D scene_emission; //= input optional : what light that gives off
writeonly uniform image2D albedo; //= output rgba16f : base colour of the surface; alpha 0 where nothing is
writeonly uniform image2D normal; //= output rgba16f : its normal in the world, towards the viewer
writeonly uniform image2D depth;  //= output r32f : distance along the view axis (m); 1e9 where nothing is
writeonly uniform image2D surface;  //= output rgba16f optional : specular, roughness, metallic; alpha 1 where model toon is allowed
writeonly uniform image2D emission; //= output rgba16f optional : radiance that the surface gives off
uniform vec2 picture;             // pixels

#include "shared.h"
#include "lib/frame.glsl"
#include "lib/random.glsl"
#include "lib/particle.glsl"
#include "fields.glsl"

layout(std430) readonly buffer PieceTriangles { bvh_triangle piece_triangles[]; };
layout(std430) readonly buffer PieceMaterials { surface_material piece_materials[]; }; // one for each of these
layout(std430) buffer PieceDepths { uint piece_depths[]; };   // of each pixel: bits of the least depth
layout(std430) buffer PieceNumbers { uint piece_numbers[]; }; // and the first triangle there
const uint NONE = 0xffffffffu;
const float SAME = 1.00001; // one depth, as two shaders compute it

struct triangle {
    bool seen;
    vec3 corner[3]; // pixels, and depth in metres
    vec3 normal;    // in the world
    vec3 color;
    vec4 surface, emission;
};

// Rows of the rotation about an axis (Rodrigues).
mat3 turn_about(vec3 axis, float angle) {
    float c = cos(angle), s = sin(angle);
    mat3 across = mat3(0.0, axis.z, -axis.y, -axis.z, 0.0, axis.x, axis.y, -axis.x, 0.0);
    return c * mat3(1.0) + s * across + (1.0 - c) * outerProduct(axis, axis);
}

mat3 turn_of(particle p) {
    float angle = radians(field_angle(p.position));
#if TURN == TURN_ALONG
    float speed = length(p.velocity);
    vec3 x = speed > 0.0 ? p.velocity / speed : vec3(1.0, 0.0, 0.0);
    vec3 side = cross(abs(x.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0), x);
    vec3 y = normalize(side);
    return turn_about(x, angle) * mat3(x, y, cross(x, y));
#else
    float z = 2.0 * particle_random(p.id, 66u) - 1.0, around = 6.2831853 * particle_random(p.id, 67u);
    return turn_about(vec3(sqrt(1.0 - z * z) * vec2(cos(around), sin(around)), z), angle);
#endif
}

vec3 seen_at(vec3 p) {
    vec3 v = (frame.view * vec4(p, 1.0)).xyz;
    return vec3(picture * frame_seen(v.xy, max(-v.z, 1e-6)), -v.z);
}

triangle triangle_of(uint number) {
    triangle t;
    particle p;
    uint slot = number / uint(TRIANGLES);
    t.seen = false;
    if (slot >= particle_used || !particle_read(slot, p)) return t;
    particle_say(p);
    float size = field_size(p.position);
    if (!(size > 0.0 && size < 1e6)) return t;
    bvh_triangle own = piece_triangles[number % uint(TRIANGLES)];
    mat3 turn = size * turn_of(p);
    vec3 first = turn * own.first.xyz, second = turn * own.second.xyz;
    vec3 corner = p.position + turn * own.corner.xyz;
    t.corner[0] = seen_at(corner);
    t.corner[1] = seen_at(corner + first);
    t.corner[2] = seen_at(corner + second);
    float near = min(t.corner[0].z, min(t.corner[1].z, t.corner[2].z));
    vec3 face = cross(first, second);
    t.seen = near > frame.lens.z && dot(face, face) > 0.0;
    t.normal = normalize(face);
    if (dot(t.normal, frame.eye.xyz - corner) < 0.0) t.normal = -t.normal;
    surface_material m = piece_materials[number % uint(TRIANGLES)];
    t.color = m.color.rgb * max(field_color(p.position), vec3(0.0));
    t.surface = m.surface;
    t.emission = m.emission * max(field_glow(p.position), 0.0);
    return t;
}

float turned(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Depth of a triangle in a pixel; 0: it is not there.
float depth_in(triangle t, ivec2 pixel) {
    vec2 at = vec2(pixel) + 0.5, a = t.corner[0].xy - at, b = t.corner[1].xy - at, c = t.corner[2].xy - at;
    vec3 parts = vec3(turned(b, c), turned(c, a), turned(a, b));
    float all = parts.x + parts.y + parts.z;
    if (all == 0.0 || any(lessThan(parts * sign(all), vec3(0.0)))) return 0.0;
    return all / dot(parts, 1.0 / vec3(t.corner[0].z, t.corner[1].z, t.corner[2].z));
}

ivec2 scene_pixel(ivec2 pixel, ivec2 size) {
    return ivec2((vec2(pixel) + 0.5) / picture * vec2(size));
}

float scene_depth_in(ivec2 pixel) {
#if HAS_SCENE_DEPTH
    return texelFetch(scene_depth, scene_pixel(pixel, textureSize(scene_depth, 0)), 0).r;
#else
    return 1e9;
#endif
}

uint pixel_number(ivec2 pixel) {
    return uint(pixel.y * int(picture.x) + pixel.x);
}

#if defined(STAGE_DEPTH) || defined(STAGE_NUMBER)
layout(local_size_x = 256) in;

// THREADS of them share a triangle's rows, so that one near the camera does not keep all others waiting.
void main() {
    uint thread = 256u * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    uint number = thread / uint(THREADS);
    int row = int(thread % uint(THREADS));
    triangle t = triangle_of(number);
    if (!t.seen) return;
    vec2 low = min(t.corner[0].xy, min(t.corner[1].xy, t.corner[2].xy));
    vec2 high = max(t.corner[0].xy, max(t.corner[1].xy, t.corner[2].xy));
    ivec2 begin = ivec2(max(floor(low), vec2(0.0))), end = ivec2(min(ceil(high), picture));
    for (int y = begin.y + row; y < end.y; y += THREADS)
        for (int x = begin.x; x < end.x; x++) {
            float away = depth_in(t, ivec2(x, y));
            uint pixel = pixel_number(ivec2(x, y));
            if (away <= 0.0 || away >= scene_depth_in(ivec2(x, y))) continue;
#if defined(STAGE_DEPTH)
            atomicMin(piece_depths[pixel], floatBitsToUint(away));
#else
            if (away <= SAME * uintBitsToFloat(piece_depths[pixel])) atomicMin(piece_numbers[pixel], number);
#endif
        }
#if defined(STAGE_DEPTH)
    if (row == 0) count_triangles(1);
#endif
}
#endif

#if defined(STAGE_LOOK) || defined(STAGE_SHOW)
layout(local_size_x = 16, local_size_y = 16) in;

#if defined(STAGE_LOOK)
void look(ivec2 pixel, uint number) {
    vec4 kind = vec4(0.0), glow = vec4(0.0);
    if (number != NONE) {
        triangle t = triangle_of(number);
        kind = t.surface;
        glow = t.emission;
    } else {
#if HAS_SCENE_ALBEDO && HAS_SCENE_NORMAL
        kind = vec4(0.0, 1.0, 0.0, 1.0); // matte
#endif
#if HAS_SCENE_ALBEDO && HAS_SCENE_SURFACE
        kind = texelFetch(scene_surface, scene_pixel(pixel, textureSize(scene_surface, 0)), 0);
#endif
#if HAS_SCENE_ALBEDO && HAS_SCENE_EMISSION
        glow = texelFetch(scene_emission, scene_pixel(pixel, textureSize(scene_emission, 0)), 0);
#endif
    }
    imageStore(surface, pixel, kind);
    imageStore(emission, pixel, glow);
}
#else
// Leaves both buffers empty for the next frame.
void show(ivec2 pixel, uint at, uint number) {
    float away = number == NONE ? scene_depth_in(pixel) : uintBitsToFloat(piece_depths[at]);
    vec4 base = vec4(0.0), facing = vec4(0.0);
    piece_numbers[at] = NONE;
    piece_depths[at] = NONE;
    if (number != NONE) {
        triangle t = triangle_of(number);
        base = vec4(t.color, 1.0);
        facing = vec4(t.normal, 0.0);
    } else {
#if HAS_SCENE_ALBEDO && HAS_SCENE_NORMAL
        base = texelFetch(scene_albedo, scene_pixel(pixel, textureSize(scene_albedo, 0)), 0);
        facing = texelFetch(scene_normal, scene_pixel(pixel, textureSize(scene_normal, 0)), 0);
#endif
    }
    imageStore(albedo, pixel, base);
    imageStore(normal, pixel, facing);
    imageStore(depth, pixel, vec4(away));
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(picture)))) return;
    uint at = pixel_number(pixel), number = piece_numbers[at];
#if defined(STAGE_LOOK)
    look(pixel, number);
#else
    show(pixel, at, number);
#endif
}
#endif
