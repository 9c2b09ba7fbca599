// Finds out, once a frame, what light reaches where in the volume: shadows of all lights through it and past meshes, light of its fire, and light scattered in it.
//
// Readers include lib/lighting.glsl. Each output costs only when something reads it.
//@ option shadow_resolution = 96 {16, 32, 48, 64, 96, 128, 192, 256} : texels of `shadow` along each edge, for each light
//@ option glow_resolution = 32 {8, 16, 24, 32} : voxels of `glow` along each edge of the volume's box
//@ option fire_lights = 8 {0, 1, 8} : lights that stand for the volume's fire where it falls on meshes
//@ option rig = none {none, right_top_back, left_bottom_front, own} : instead of the scene's lights, sky and meshes: three suns of pi W/m^2, red, green and blue, from the right, the top and behind of what the camera sees, or from the left, below and the camera's side, on the medium in grey and without its fire, a channel for each; or (own) nothing but its fire: what `export sheet` keeps
//@ counter samples : points at which the density was evaluated
uniform int sweeps;                //= 3 [0, 32] : of light through `glow` at most, each of which scatters it once more, and a coarser grid after each brings it far; 0: light that nothing has scattered yet
uniform float ambient;             //= 1 [0, 10] : factor of the light from the sky
uniform vec3 box_min;
uniform vec3 box_max;
uniform int hastened;    // sweeps that were hastened before this one
uniform bool last_sweep; // none of the finer level follows
writeonly uniform image2D lights;  //= output rgba32f : a row for each light: what it is and how its shadow lies in space
writeonly uniform image3D shadow;  //= output rg16f : N x N x N texels for each light: density times metres that its rays have passed, and the part that no mesh hides
writeonly uniform image3D glow;    //= output rgba16f : mean and first moment of the radiance from all sides, but straight from the lights; a third for each colour


uniform sampler2D lights_made;
uniform sampler3D shadow_made;
uniform sampler3D medium_made;
uniform sampler3D scattering_made;
uniform sampler3D around_made;
uniform sampler3D fire_made;
layout(rgba32f) writeonly uniform image3D medium_kept;     // emission (W/m^3/sr) and density
layout(rgba32f) writeonly uniform image3D scattering_kept; // coefficient of density 1
layout(rgba32f) writeonly uniform image3D around_kept;     // light that enters the box, in each of the directions
layout(rgba32f) writeonly uniform image3D fire_kept;       // light that leaves the volume (W/m^3/sr); which way

#include "lib/frame.glsl"
#include "lib/medium.glsl"
#include "lib/light.glsl"
#include "lib/shadow_map.glsl"
#include "lib/bvh.glsl"
#include "lib/sky.glsl"

const float HALF_MOST = 6e4; // what a half float holds
const float PI = 3.14159265;

#include "lighting/lights.glsl"
#include "lighting/fire.glsl"
#include "lighting/shadow.glsl"
#include "lighting/medium.glsl"
#include "lighting/ways.glsl"
#include "lighting/around.glsl"
#include "lighting/state.glsl"
#include "lighting/first.glsl"
#include "lighting/sweep.glsl"
#include "lighting/level.glsl"
