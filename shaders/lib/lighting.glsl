// Reads what the pass `lighting` left: what reaches a point from each light through the volume and
// past the meshes, and the light that the volume itself sends around.
uniform sampler2D lights;  //= input optional : the lights, the volume's fire among them, and how `shadow` lies in space (of the pass lighting)
uniform sampler3D shadow;  //= input optional : what stands between each light and the points of the volume (of the pass lighting)
uniform sampler3D glow;    //= input optional : light from all sides: fire, sky and what is scattered (of the pass lighting)

#ifndef LIB_LIGHTING_GLSL
#define LIB_LIGHTING_GLSL
#include "lib/light.glsl"
#if HAS_LIGHTS && HAS_SHADOW

// x: density times metres between p and light `index`; y: part of the light that no mesh hides.
vec2 lighting_shadow(int index, vec3 p);

// Extinction of density 1 by colour, of the medium that was lit: transmittance to a light is
// exp(-lighting_extinction() * lighting_shadow(index, p).x).
vec3 lighting_extinction();
#endif
#if HAS_LIGHTS && HAS_GLOW

// Radiance scattered at p into the direction `way` by a medium of scattering coefficient 1 (1/m)
// and mean cosine g, from all light but what comes straight from the lights.
vec3 lighting_scattered(vec3 p, vec3 way, float g);
#endif
#endif
