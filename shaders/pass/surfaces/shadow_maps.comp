// Draws what stands before the lights into maps, one for each view out of a light: `shade` and `forward` look there instead of following a ray.
//
// The sun has cascades, which follow the camera; a spot light has one view. The others (point lights,
// the volume's fire, and those of `point_lights`) compete for six views each, the faces of a cube: the
// strongest that the picture may show get them, found here on the device.
//@ option size = 2048 {256, 512, 1024, 2048, 4096} : texels along an edge of a cascade of the sun
//@ option cascades = 3 {0, 1, 2, 3, 4} : of the sun; each shows more, and less finely, than the one before
//@ option spot_size = 1024 {128, 256, 512, 1024, 2048} : texels along an edge of a spot light's view
//@ option points = 4 {0, 1, 2, 3, 4, 6, 8} : how many point lights get maps
//@ option point_size = 512 {64, 128, 256, 512, 1024} : texels along an edge of each of their faces
uniform float distance;            //= 80 [0.1, 100000] m : how far from the camera the sun's cascades reach, and from the other lights their shadows
uniform float split;               //= 0.8 [0, 1] : between cascades of even depth (0) and of even ratio (1)
uniform float shadow_radius;       //= 1.5 [0.5, 5] : texels that edges of shadows are softened by, to either side
uniform float bias;                //= 1 [0, 10] : factor of how far points are moved off their surface before the look: 1 is as much as a plane needs
uniform float point_fade;          //= 0.1 [0, 1] : a light that is stronger than the first without maps by less than this part of its strength has lighter shadows, so that none appear suddenly
uniform float lod;                 //= 0 [0, 16] : pixels of the camera's picture by which a simplified mesh may be off that casts a shadow; 0: none is simplified
uniform sampler2D lights;          //= input optional : the lights, the volume's fire among them (of the pass lighting)
uniform sampler2D point_lights;           //= input optional : many point lights (of the pass point_lights)
writeonly uniform image2D shadow_atlas; //= output r32f : depths of what is nearest to each light, as drawn
writeonly uniform image2D shadow_views; //= output rgba32f : where the views stand and lie, and which light has which
#include "lib/frame.glsl"
#include "lib/light.glsl"
#include "shadow_maps/table.glsl"
#include "shadow_maps/choose.glsl"
#include "shadow_maps/views.glsl"

layout(local_size_x = SHADOW_GROUP) in;

// One group does it all: there are few views, and what is chosen must be known before they are made.
void main() {
    int thread = int(gl_LocalInvocationIndex);
    choose_points(thread);
    if (thread == 0) imageStore(shadow_views, ivec2(0), vec4(shadow_radius, bias, light_count(), SHADOW_VIEWS));
    for (int i = thread; i < SHADOW_VIEWS; i += SHADOW_GROUP) write_view(i);
    for (int i = thread; i < shadow_candidates(); i += SHADOW_GROUP) write_light(i);
}
