// What a host's renderer needs of a medium besides its colour: how deep it lies and how it moves, at the place
// where its opacity is on average.
#include "lib/frame.glsl"
uniform sampler2D reach;     //= input : distance along the ray at which the opacity lies (m), of a pass march or maps
uniform sampler2D moves;     //= input optional : image motion of a pass maps; without it nothing moves but the camera
writeonly uniform image2D depth;  //= output r32f : depth of that place (m); where the medium is not, that of the host's scene
writeonly uniform image2D motion; //= output rg16f optional : where that place is in the picture, less where it was in the frame before: parts of the picture's width to the right and of its height down, without the camera's jitter
#ifndef HAS_MOVES
#define HAS_MOVES 0
#endif

// In metres of the camera's space: where it was by its own motion.
vec3 moved_from(vec2 uv, vec3 at) {
#if HAS_MOVES
    vec4 m = texelFetch(moves, ivec2(uv * vec2(textureSize(moves, 0))), 0);
    vec3 back = m.xyz * frame.time.y; // heights of the picture, metres towards the camera
    float deep = max(-at.z, 1e-6), then = max(deep + back.z, 1e-6);
    return vec3((at.xy / deep - 2.0 * frame.lens.y * back.xy) * then, -then);
#else
    return at;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(depth);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 along = frame_ray(uv);
    float deep = texelFetch(reach, ivec2(uv * vec2(textureSize(reach, 0))), 0).r / length(along);
    imageStore(depth, pixel, vec4(deep));
    vec3 at = (frame.view * vec4(frame.eye.xyz + deep * along, 1.0)).xyz;
    vec4 then = frame.last * frame.view_inverse * vec4(moved_from(uv, at), 1.0);
    vec2 way = then.w > 0.0 ? uv - (0.5 * then.xy / then.w + 0.5) - frame.shift.zw : vec2(0.0);
    imageStore(motion, pixel, vec4(way, 0.0, 0.0));
}
