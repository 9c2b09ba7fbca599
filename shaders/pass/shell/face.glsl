//@ option mode = rays {rays, mesh} : rays: a ray for each pixel finds the surface itself; mesh: vertices of a sphere are pushed out and drawn, as published: the outline has corners, and shells are laid over each other as a whole
//@ option sides = both {both, front} : both: where the surface is cut away, its inside is seen; front: never
//@ option corners = 64 {16, 32, 64, 128} : of mode = mesh: vertices along each side of the cube that the sphere is made of
//@ field float radius = 1 : of the sphere before it is pushed out (m); once for each
//@ field vec3 position = {0, 0, 0} : of its centre, from the place of the explosion (m); once for each
//@ field float shell_depth = 0 : what shell_depth is for the other fields; once for each
//@ field float displacement = 0 : how far the surface is pushed out, in radii
//@ field float clip = 1 : where it is not above 0 nothing is drawn
//@ field float opacity after clip = 1 : 0..1; what lies beyond is limited to that
//@ field vec3 color after opacity = {0, 0, 0} : radiance of the surface
//@ field vec3 albedo after opacity = {0, 0, 0} : part of the light of the scene that it scatters back
//@ counter evaluated : points at which the displacement was found, of mode = rays
uniform float life;               //= 2 [0.001, 1e6] s : how long a shell is there
uniform float brightness;         //= 1 [0, 1e6] : factor of the colour
uniform float reach;              //= 2 [0, 100] : the displacement is kept from -0.95 to this, in radii
uniform float wrap;               //= 0.3 [0, 1] : how far light reaches round to the side that faces away, as in smoke
uniform float soften;             //= 0 [0, 100] m : distance before a surface of the scene over which it fades
uniform float stride;             //= 0.6 [0.05, 1] : of mode = rays: part of the way to the surface that a step goes; less finds thinner bumps
uniform int steps;                //= 48 [4, 256] : of mode = rays: along a ray through a shell, at most
uniform int surfaces;             //= 8 [1, 16] : of mode = rays: that a ray looks through, one behind the other
uniform sampler2D depth;           //= input optional : of the scene (m); `from` a pass geometry gives it
