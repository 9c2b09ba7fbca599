// Draws spheres whose surface is pushed out along its normals: the balls of fire and globes of smoke of a layered explosion (Avalos 2019).
//
// shell { at = explosions { {0.5, position = {0, 0, 1}} }, radius = 2, displacement = layers { {2, 1}, {7, 0.4} } }
// Each explosion of the list is a sphere. All fields are evaluated at the direction from its centre, a
// point of the unit sphere, and may use what they are told of it: shell_age (0..1 over its life),
// shell_random, shell_shift (three numbers of its own, by which noise is moved so that no two look
// alike), shell_depth, and, but for the displacement, shell_displacement, shell_normal and shell_view
// (unit, towards the eye). over { ball, picture, from = {ball, scene} } lays it over a picture.
#include "face.glsl"
writeonly uniform image2D image;   //= output rgba16f : premultiplied radiance and opacity
writeonly uniform image2D front;   //= output r32f optional : depth of the scene, or of a shell before it that hides half of what is behind (m): another shell, or a march, stops there by `depth = ball.front`

#include "surface.glsl"
#if defined(STAGE_GATHER)
#include "gather.glsl"
#elif defined(STAGE_VERTICES)
#include "vertices.glsl"
#elif defined(STAGE_FRONT)
#include "front.glsl"
#elif defined(STAGE_RAYS)
#include "rays.glsl"
#endif
