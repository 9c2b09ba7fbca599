// Finds out, once a frame, what light reaches where in the volume: shadows of all lights through it and past meshes, light of its fire, and light scattered in it.
//
// Readers include lib/lighting.glsl. Each output costs only when something reads it.
//@ option shadow_resolution = 96 {16, 32, 48, 64, 96, 128, 192, 256} : texels of `shadow` along each edge, for each light
//@ option glow_resolution = 32 {8, 16, 24, 32, 48} : voxels of `glow` along each edge of the volume's box
//@ option fire_lights = 8 {0, 1, 8} : lights that stand for the volume's fire where it falls on meshes
//@ counter samples : points at which the density was evaluated
uniform vec3 box_min;
uniform vec3 box_max;
writeonly uniform image2D lights;  //= output rgba32f : a row for each light: what it is and how its shadow lies in space
writeonly uniform image3D shadow;  //= output rg16f : N x N x N texels for each light: density times metres that its rays have passed, and the part that no mesh hides
writeonly uniform image3D glow;    //= output rgba16f : mean and first moment of the radiance from all sides, but straight from the lights; a third for each colour

#include "lib/medium.glsl"
#include "lib/light.glsl"
#include "lib/shadow_map.glsl"
#include "lib/bvh.glsl"

// What an earlier stage wrote; SHADOW_SIZE, GLOW_SIZE and FIRE_COUNT are the options as numbers.
uniform sampler2D lights_made;
uniform sampler3D shadow_made;

#include "lighting/lights.glsl"
#include "lighting/shadow.glsl"
