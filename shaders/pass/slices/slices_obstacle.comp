// What stands in the way of slices, before each of their steps: a shape, a painted picture, or both.
layout(local_size_x = 16, local_size_y = 8, local_size_z = 1) in;
//@ field float shape = 0 : how much of a place is solid, 0 to 1; places: shares of the slice's width
//@ field vec3 velocity = {0, 0, 0} : of what is solid (m/s): to the right, upwards. It moves the fluid; where the solid is, shape and offset say
uniform vec3 offset; //= {0, 0, 0} : where the picture is moved to: to the right, upwards, in shares of the slice's width
#define FLOW_OBSTACLES
#include "fields.glsl"
#include "pass/slices/place.glsl"

#if PICTURE
// Covers the slice; dark is solid, as ink on paper or on nothing.
uniform sampler2D Picture;

float painted_at(vec3 p) {
    vec2 uv = (p.xy - offset.xy) * vec2(1.0, float(FLOW_NX) / float(FLOW_NY));
    if (any(greaterThan(abs(uv - 0.5), vec2(0.5)))) return 0.0;
    vec4 ink = textureLod(Picture, vec2(uv.x, 1.0 - uv.y), 0.0);
    return clamp(ink.a * (1.0 - dot(ink.rgb, vec3(0.2126, 0.7152, 0.0722))), 0.0, 1.0);
}

float solid_at(vec3 p) {
    return max(field_shape(p), painted_at(p));
}
#else
float solid_at(vec3 p) {
    return field_shape(p);
}
#endif

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!flow_inside(at.xy) || at.z >= FLOW_SLICES) return;
    uint place = flow_cell(at.xy, at.z);
    float solid = SLICES_COVER(solid_at, at.xy);
    if (is_first == 0u && solid <= flow_obstacles[place].x) return;
    vec3 p = slices_place(vec2(at.xy) + 0.5);
    flow_obstacles[place] = vec4(solid, solid > 0.0 ? field_velocity(p).xy : vec2(0.0), 0.0);
}
