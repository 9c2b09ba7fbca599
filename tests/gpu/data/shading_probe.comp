// What lib/shading.glsl says, pixel by pixel: of a white room (furnace), or of one light.
//@ option show = furnace {furnace, light} : furnace: part of even light from all sides that is sent back, mirrored alone, and the diffuse colour; across: angle of the view, down: roughness. light: radiance by its angle, across, seen from the normal and from the side it stands on
uniform vec3 base;           //= {1, 1, 1} [0, 1] : of the surface
uniform float specular;      //= 0 [0, 1] : of the surface
uniform float roughness;     //= 1 [0, 1] : of the surface, of show = light
uniform float metallic;      //= 0 [0, 1] : of the surface
uniform bool toon;           //= true : bands are allowed
writeonly uniform image2D color; //= output rgba32f : the answer
#include "lib/shading.glsl"

// Directions are those that GGX mirrors, drawn as it spreads its facets: each stands for as much of
// the sphere as they are few there.
vec3 mirrored(shaded s) {
    const int count = 96;
    float rough = max(s.roughness, SHADING_SHARPEST), a2 = rough * rough * rough * rough;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count * count; i++) {
        vec2 u = (vec2(i % count, i / count) + 0.5) / float(count);
        float up = sqrt((1.0 - u.x) / (1.0 + (a2 - 1.0) * u.x)), out_ = sqrt(1.0 - up * up);
        vec3 middle = vec3(out_ * cos(6.2831853 * u.y), out_ * sin(6.2831853 * u.y), up);
        float way = dot(middle, s.view), peak = 1.0 + up * up * (a2 - 1.0);
        vec3 light = 2.0 * way * middle - s.view;
        if (way <= 0.0 || light.z <= 0.0) continue;
        float density = a2 / (SHADING_PI * peak * peak) * up / (4.0 * way);
        sum += shading_respond(s, light, vec3(1.0 / (density * float(count * count)))).shine;
    }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec4 kind = vec4(specular, roughness, metallic, toon ? 1.0 : 0.0);
    vec3 n = vec3(0.0, 0.0, 1.0);
#if SHOW == SHOW_FURNACE
    kind.y = uv.y;
    shaded s = shading_of(vec3(0.0), n, vec3(sqrt(1.0 - uv.x * uv.x), 0.0, uv.x), base, kind);
    vec3 shine = mirrored(s);
    imageStore(color, pixel, vec4(shading_color(s).r + shine.r, shine.r, shading_color(s).r, 1.0));
#else
    float angle = 3.14159265 * (uv.x - 0.5);
    vec3 light = vec3(sin(angle), 0.0, cos(angle)), view = pixel.y == 0 ? n : normalize(vec3(1.0, 0.0, 1.0));
    shaded s = shading_of(vec3(0.0), n, view, base, kind);
    imageStore(color, pixel, vec4(shading_reflect(s, light, vec3(SHADING_PI)), 1.0));
#endif
}
