// Draws particles: as soft round spots, pictures or streaks, in front of what is solid and behind the smoke that is before them.
//
// splats { from = {sparks, scene, lit} } takes depth from a pass geometry, smoke and its shadows from a
// pass lighting; over { drawn, picture, from = {drawn, scene} } lays the result over a picture that has
// the smoke in it already. Fields are evaluated for each particle at its place; they may use
// particle_age (0..1 over its life), particle_quantity, particle_random and particle_velocity, as in
// size = 0.02 * (1 - particle_age).
//
// Spots of up to two pixels, and short streaks, are added to pixels in whole numbers, which no order
// changes. Larger ones are listed by the tiles of the picture that they touch. Nothing is drawn
// smaller than a pixel can show: it becomes fainter instead.
//@ option blend = additive {additive, weighted, sorted} : additive: light alone, which hides nothing; weighted: hides what is behind, by a mean that needs no order (McGuire and Bavoil 2013); sorted: hides exactly, nearest first, of up to 2097152 particles
//@ option lit = off {off, on} : the colour is what light of the scene makes of it, dimmed by the smoke and the meshes that the pass lighting knows; off: the colour is light itself
//@ option entries = 4 {1, 2, 4, 8, 16, 32} : places in the tiles' lists, for each particle. Where they do not suffice, sorted leaves particles out, and the others take longer
//@ field float size = 0.02 : diameter (m)
//@ field vec3 color = {1, 1, 1} : radiance in the middle, or, if lit, the part of the light that it scatters
//@ field float opacity = 1 : of its middle, 0..1; of blend = additive: factor of the light
//@ field float angle = 0 : by which its picture is turned to the left (degrees)
//@ field float cell = 0 : of a flipbook: the number of the image, from 0 on. Without it the images follow each other over a particle's life
//@ field float density = 0 : of smoke that dims what is behind it (1/m), as the pass lighting has it
//@ counter small : particles added to pixels
//@ counter large : particles drawn pixel by pixel
//@ counter left_out : places in lists that were missing (see `entries`)
uniform float brightness;          //= 1 [0, 1e6] : factor of the colour
uniform float streak;              //= 0 [0, 10] s : how much of its way a particle is drawn along, backwards; it gets as much fainter as it gets longer
uniform float soften;              //= 0 [0, 100] m : distance before a surface over which it fades
uniform vec2 flipbook;             //= {1, 1} [1, 64] : columns and rows of images in `sprite`
uniform float ambient;             //= 1 [0, 10] : factor of the light from the sky, if lit without `glow`
uniform float anisotropy;          //= 0.2 [-0.95, 0.95] : if lit: whether light goes on forward or back, as in smoke
uniform vec3 extinction;           //= {1, 1, 1} [0, 1000] : of the smoke: factor of the density, by colour
uniform vec3 albedo;               //= {0.5, 0.5, 0.5} [0, 1] color : of the smoke
uniform vec3 absorption_color;     //= {0, 0, 0} [0, 1] color : of the smoke
uniform int view_steps;            //= 8 [0, 64] : samples of the smoke between the eye and each particle; 0: none dims it
uniform float weight_distance;     //= 5 [0.01, 10000] m : of blend = weighted: about how far away the particles are
#include "lib/particles.glsl"
uniform sampler2D depth;           //= input optional : depth of the scene (m)
uniform sampler2D sprite;          //= input optional : what a particle looks like: its opacity, times its colour
writeonly uniform image2D image;   //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D edge;    //= output r32f optional : depth of the scene that was tested (m)
uniform vec2 picture;   // pixels
uniform uint tiles_across;
uniform uint tiles_down;
uniform uint records_most;
uniform uint entries_most;
uniform vec3 box_min;   // of the smoke
uniform vec3 box_max;

#include "lib/frame.glsl"
#include "lib/random.glsl"
#include "lib/particle.glsl"
#include "fields.glsl"
#include "lib/box.glsl"
#include "lib/phase.glsl"
#include "lib/sky.glsl"
#include "lib/lighting.glsl"
#include "lib/light.glsl"

// Stages: project, scan, list, draw; sorted has one more before the last, bounds.
#include "splats/shape.glsl"
#include "splats/look.glsl"
#include "splats/group.glsl"
#include "splats/project.glsl"
#include "splats/list.glsl"
#include "splats/order.glsl"
#include "splats/draw.glsl"
