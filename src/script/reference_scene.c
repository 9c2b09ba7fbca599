// The constructors of what stands around it: meshes, instances, camera, lights.
#include "scene/material.h"
#include "scene/scene.h"
#include "script/reference_rows.h"

// clang-format off
#define LIGHT                                                                                      \
    SLOT(scene_light, position, 3, "{x, y, z} m", "where it stands; required"),                    \
    SLOT(scene_light, color, 3, "1, 1, 1", "multiplies the power"),                                \
    SLOT(scene_light, power, 1, "100 W",                                                           \
         "as light into all directions, of which a spot's cone is cut out"),                       \
    SLOT(scene_light, range, 1, "0 m", "beyond which nothing is lit; 0: none"),                    \
    CHOICE("falloff", "inverse_square",                                                            \
           "as light does, let down smoothly to 0 at the range; linear: 1 - distance / range, times "  \
           "what the other gives at a metre",                                                      \
           "inverse_square", "linear"),                                                            \
    KEY("name", "the variable's", "for --set NAME.power=value and presets; numbered when taken")

const script_object reference_scene[] = {
    {"mesh", "scene", "geometry { mesh { \"data/ground.obj\" } }",
     "something solid, for geometry",
     .args = KEYS(KEY("file", "\"data/ground.obj\"", ".obj, .gltf or .glb")),
     .keys = KEYS(
        SLOT(scene_mesh, position, 3, "0, 0, 0 m", "where its origin goes"),
        SLOT(scene_mesh, rotation, 3, "0, 0, 0 degrees", "about X, then Y, then Z"),
        SLOT(scene_mesh, scale, 1, "1", "factor of its size"),
        SLOT(scene_mesh, color, 3, "1, 1, 1", "multiplies the material's"),
        KEY("material", "material { }", "of all of it; without: what the file says"),
        KEY("parent", "node { }", "that it stands in"))},
    {"material", "scene", "mesh { \"data/barrel.obj\", material = material { metallic = 1, roughness = 0.3 } }",
     "what a surface is like. What is not given is as the file has it; a file that says nothing is matte",
     .keys = KEYS(
        SLOT(scene_material, color, 3, "the file's", "of the whole mesh"),
        KEY("texture", "\"data/bark.png\"", "PNG or JPEG: its colours, times `color`; by the file's coordinates"),
        SLOT(scene_material, specular, 1, "0.5 with roughness or metallic, else the file's [0, 1]",
             "how much is mirrored: 0.5 is 4 percent of what comes head on, as of most things; 0: matte"),
        SLOT(scene_material, roughness, 1, "the file's [0, 1]", "0: polished; 1: highlights spread over all"),
        SLOT(scene_material, metallic, 1, "the file's [0, 1]", "1: mirrors in its colour, and does nothing else"),
        SLOT(scene_material, emission, 3, "the file's", "radiance that it gives off; of instances times `glow`"),
        KEY("toon", "true", "false: it keeps smooth light where model = \"toon\""),
        KEY("name", "the variable's", "for --set NAME.roughness=value and presets; numbered when taken"))},
    {"node", "scene", "local boat = node { position = {0, 0, 2} }; mesh { \"data/mast.obj\", parent = boat }",
     "a place for meshes and instances to stand in: they move, turn and grow with it",
     .keys = KEYS(
        SLOT(scene_node, position, 3, "0, 0, 0 m", "where its origin goes"),
        SLOT(scene_node, rotation, 3, "0, 0, 0 degrees", "about X, then Y, then Z"),
        SLOT(scene_node, scale, 1, "1", "factor of its size"),
        KEY("parent", "node { }", "that it stands in"),
        KEY("name", "the variable's", "for messages"))},
    {"instances", "scene", "geometry { instances { mesh { \"data/pine.obj\" }, at = scatter { count = 500, size = {120, 120} } } }",
     "many copies of a few meshes, for geometry: each with a place, a look and four numbers of yours, "
     "which may change at any time. When time goes back, and after a reload, they are as they began. Numbers are said for "
     "all, as {low, high} for chance to pick from, as a list (so is a pair for two of them), or by a function(i, place)",
     .args = KEYS(KEY("mesh ...", "mesh { \"data/pine.obj\" }", "1 to 64: the kinds 1, 2, 3 ...")),
     .keys = KEYS(
        KEY("at", "scatter { }, { {x, y, z}, ... } m", "where they stand; required"),
        KEY("kind", "1", "which of the meshes; a list: of each, or the share of each mesh; 0: not shown"),
        KEY("scale", "1", "factor of their size"),
        KEY("yaw", "0 degrees", "how they are turned about +Z"),
        KEY("lean", "0 degrees", "how far at most they lean, each into a direction of its own"),
        KEY("color", "1, 1, 1", "multiplies that of the mesh; two colours: between them"),
        KEY("glow", "1", "factor of what the mesh emits"),
        KEY("state", "0, 0, 0, 0", "numbers of yours, which fields read as instance_state"),
        KEY("seed", "1", "of chance"),
        KEY("position", "0, 0, 0 m", "of all together; may move"),
        KEY("rotation", "0, 0, 0 degrees", "of all together: about X, then Y, then Z; may move"),
        KEY("tint", "1, 1, 1", "of all together; may move"),
        KEY("parent", "node { }", "that all stand in"),
        KEY("name", "the variable's", "for messages")),
     .members = KEYS(
        KEY("get(i)", NULL, "{ position, yaw, scale, kind, color, glow, state, random } of one; #forest is how many"),
        KEY("set(i, { })", "{ kind = 3, scale = 1, state = {1} }",
            "any of position, rotation, yaw, scale, kind, color, glow, state; of a list of i, too; "
            "numbers of the state that are not given stay"),
        KEY("set_all { }", "{ glow = 2, state = { {1, 0}, {0, 3}, ... } }", "of all: one value, or a list of as many"),
        KEY("near({x, y, z}, radius)", NULL, "numbers of those that stand there, the nearest first"),
        KEY("reset()", NULL, "all are as they began"))},
    {"scatter", "scene", "scatter { count = 500, size = {120, 120}, distance = 2.2 }",
     "a list of places {x, y, z} by chance, none too near to another: for `at` of instances. Fewer "
     "when no more find room",
     .keys = KEYS(
        KEY("count", "number [1, 131072]", "how many; with a distance, without: all that have room"),
        KEY("size", "{x, y} m", "sides of the rectangle that is filled; required"),
        KEY("position", "0, 0, 0 m", "its middle"),
        KEY("distance", "0 m", "between two, at least"),
        KEY("inside", "field", "places where it is above 0 stay"),
        KEY("density", "field", "0..1: how likely a place stays"),
        KEY("height", "field m", "of the ground: lifts them"),
        KEY("seed", "1", "of chance"))},
    {"camera", "scene", "fx.camera = camera { eye = {0, -6, 2} }",
     "a camera that stands somewhere and looks at a target",
     .keys = KEYS(
        SLOT(scene_camera, eye, 3, "{x, y, z} m", "where it stands; required"),
        SLOT(scene_camera, target, 3, "0, 0, 1 m", "what it looks at"),
        SLOT(scene_camera, fov, 1, "40 degrees", "vertical field of view"),
        SLOT(scene_camera, near, 1, "0.1 m", "nothing nearer is seen"),
        SLOT(scene_camera, far, 1, "1000 m", "nothing solid farther away is seen"))},
    {"orbit", "scene", "fx.camera = orbit { target = {0, 0, 1}, distance = 6, yaw = 30 }",
     "a camera that circles a target",
     .keys = KEYS(
        SLOT(scene_camera, target, 3, "0, 0, 1 m", "what it looks at"),
        SLOT(scene_camera, distance, 1, "6 m", "from the target"),
        SLOT(scene_camera, yaw, 1, "0 degrees", "about +Z; 0 looks along +Y"),
        SLOT(scene_camera, pitch, 1, "10 degrees", "height of the eye above the target's horizon"),
        SLOT(scene_camera, fov, 1, "40 degrees", "vertical field of view"),
        SLOT(scene_camera, near, 1, "0.1 m", "nothing nearer is seen"),
        SLOT(scene_camera, far, 1, "1000 m", "nothing solid farther away is seen"))},
    {"sun", "scene", "fx.sun = sun { azimuth = 120, elevation = 30 }", "the sun's light",
     .keys = KEYS(
        SLOT(scene_sun, azimuth, 1, "240 degrees", "where it stands: about +Z, from +X"),
        SLOT(scene_sun, elevation, 1, "44 degrees", "above the horizon"),
        SLOT(scene_sun, color, 3, "1, 1, 1", "multiplies the strength"),
        SLOT(scene_sun, strength, 1, "2.5 W/m^2", "irradiance of what faces it"),
        SLOT(scene_sun, angle, 1, "0.53 degrees", "how wide it looks: softens shadows"))},
    {"sky", "scene", "fx.sky = sky { zenith = \"#4060a0\", strength = 0.5 }",
     "the light of the sky, and what is seen of it: two colours, or an image",
     .keys = KEYS(
        SLOT(scene_sky, zenith, 3, "0.22, 0.32, 0.48", "radiance straight up"),
        SLOT(scene_sky, horizon, 3, "0.22, 0.32, 0.48", "radiance at the horizon and below"),
        KEY("image", "\"data/sky.exr\"",
            "instead of the colours: an equirectangular .exr of up to 8192x4096, whose middle is "
            "+Y"),
        SLOT(scene_sky, rotation, 1, "0 degrees", "of the image, about +Z"),
        SLOT(scene_sky, night, 1, "none [0, 1]", "how much of the sky is night, over its colours or its image: dark, with stars"),
        SLOT(scene_sky, night_zenith, 3, "0.003, 0.006, 0.016", "radiance of the night straight up"),
        SLOT(scene_sky, night_horizon, 3, "0.012, 0.018, 0.034", "radiance of the night at the horizon"),
        SLOT(scene_sky, stars, 1, "1", "factor of what stars and moon shine"),
        SLOT(scene_sky, moon, 1, "0 degrees", "how wide the moon looks, which stands where the sun does; 0: none"),
        SLOT(scene_sky, strength, 1, "0.6; 1 of an image", "factor of its light"))},
    {"point_light", "scene", "fx.lights = { point_light { position = {2, 0, 3}, power = 200 } }",
     "a light that shines from a point into all directions",
     .keys = KEYS(LIGHT)},
    {"sphere_light", "scene", "fx.lights = { sphere_light { position = {2, 0, 3}, radius = 0.5 } }",
     "a glowing sphere: its shadows are soft",
     .keys = KEYS(LIGHT,
        SLOT(scene_light, radius, 1, "m", "of the sphere; required"))},
    {"spot_light", "scene", "fx.lights = { spot_light { position = {0, 0, 5}, angle = 30 } }",
     "a light that shines into a cone",
     .keys = KEYS(LIGHT,
        SLOT(scene_light, target, 3, "0, 0, 0 m", "where it shines"),
        SLOT(scene_light, angle, 1, "45 degrees", "across the cone"),
        SLOT(scene_light, softness, 1, "0.15 [0, 1]", "part of the cone over which it fades"),
        SLOT(scene_light, radius, 1, "0 m", "of the sphere that glows: softens shadows"))},
    {.name = NULL},
};
// clang-format on
