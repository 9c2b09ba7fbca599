// A march that tells more of the medium as it is seen than its colour: what engines want in the sheets of a flipbook (`roil export sheet`).
//
// Each output is a mean or a sum along the ray, in one march: of motion and temperature the mean by
// what each sample adds to the picture, its opacity and its light; of the rest what adds up to it.
// The six lights are two passes `lighting` with a `rig`, whose three colours are three lights; a third
// tells how the medium lights itself.
//@ option normals = off {off, on} : whether `normal` is found: four more looks at the density for each sample
//@ field vec3 velocity = {0, 0, 0} : of the medium (m/s)
uniform sampler2D lights_a;        //= input optional : of a pass lighting with rig = right_top_back
uniform sampler3D shadow_a;        //= input optional : the same
uniform sampler3D glow_a;          //= input optional : the same
uniform sampler2D lights_b;        //= input optional : of a pass lighting with rig = left_bottom_front
uniform sampler3D shadow_b;        //= input optional : the same
uniform sampler3D glow_b;          //= input optional : the same
uniform sampler2D lights_own;      //= input optional : of a pass lighting with rig = own
uniform sampler3D glow_own;        //= input optional : the same
writeonly uniform image2D motion;  //= output rgba16f optional : how what is seen moves: to the right and up in heights of the picture a second, towards the camera in m/s; its weight: opacity and light
writeonly uniform image2D right_top_back;    //= output rgba16f optional : premultiplied, of a white light of strength 1 from the right, from the top and from behind; opacity
writeonly uniform image2D left_bottom_front; //= output rgba16f optional : from the left, from below and from the camera's side; opacity
writeonly uniform image2D emission_seen;     //= output rgba16f optional : premultiplied radiance of the medium itself, and what it scatters of that; opacity
writeonly uniform image2D normal;  //= output rgba16f optional : to the right, up and towards the camera: away from where the medium is thicker; opacity
writeonly uniform image2D heat;    //= output rgba32f optional : temperature (K), how deep it lies (m from where the camera is said to stand), 0, opacity

void maps_store_nothing(ivec2 pixel) {
    imageStore(motion, pixel, vec4(0.0));
    imageStore(right_top_back, pixel, vec4(0.0));
    imageStore(left_bottom_front, pixel, vec4(0.0));
    imageStore(emission_seen, pixel, vec4(0.0));
    imageStore(normal, pixel, vec4(0.0));
    imageStore(heat, pixel, vec4(0.0));
}

#define MAPS 1
#include "pass/march/march.comp"
