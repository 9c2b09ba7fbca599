// Reads what the pass `lighting` left: what reaches a point from each light through the volume and
// past the meshes, and the light that the volume itself sends around.
uniform sampler2D lights;  //= input optional : the lights, the volume's fire among them, and how `shadow` lies in space (of the pass lighting)
uniform sampler3D shadow;  //= input optional : what stands between each light and the points of the volume (of the pass lighting)
uniform sampler3D glow;    //= input optional : light from all sides: fire, sky and what is scattered (of the pass lighting)

#ifndef LIB_LIGHTING_GLSL
#define LIB_LIGHTING_GLSL
#include "lib/light.glsl"
#include "lib/shadow_map.glsl"
#if HAS_LIGHTS

// The first so many lights are the scene's; the others stand for the volume's fire, which is in
// `glow` already.
int lighting_declared() {
    return int(texelFetch(lights, ivec2(8, 0), 0).w);
}

// Extinction of density 1 by colour, of the medium that was lit: transmittance to a light is
// exp(-lighting_extinction() * lighting_shadow(index, p).x).
vec3 lighting_extinction() {
    return texelFetch(lights, ivec2(10, 0), 0).rgb;
}
#endif
#if HAS_LIGHTS && HAS_SHADOW

// x: density times metres between p and light `index`; y: part of the light that no mesh hides.
vec2 lighting_shadow(int index, vec3 p) {
    return shadow_map_read(shadow, shadow_map_of(lights, index), p);
}
#endif

// Radiance scattered at p into the direction `way` by a medium of scattering coefficient 1 (1/m)
// and mean cosine g, from all light but what comes straight from the lights: of a pass whose
// outputs are `rows` and `around`.
vec3 lighting_scattered_by(sampler2D rows, sampler3D around, vec3 p, vec3 way, float g) {
    vec3 low = texelFetch(rows, ivec2(8, 0), 0).xyz, high = texelFetch(rows, ivec2(9, 0), 0).xyz;
    vec3 size = vec3(textureSize(around, 0)) / vec3(1.0, 1.0, 3.0), sum;
    vec3 at = clamp((p - low) / max(high - low, vec3(1e-6)), 0.5 / size, 1.0 - 0.5 / size);
    for (int i = 0; i < 3; i++) { // a third of the image for each colour
        vec4 moments = textureLod(around, vec3(at.xy, (at.z + float(i)) / 3.0), 0.0);
        sum[i] = moments.x + 3.0 * g * dot(moments.yzw, way);
    }
    return max(sum, vec3(0.0));
}
#if HAS_LIGHTS && HAS_GLOW

vec3 lighting_scattered(vec3 p, vec3 way, float g) {
    return lighting_scattered_by(lights, glow, p, way, g);
}
#endif
#endif
