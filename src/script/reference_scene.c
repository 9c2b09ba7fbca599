// The constructors of what stands around it: meshes, instances, camera, lights.
#include "script/reference_rows.h"

// clang-format off
#define LIGHT KEYS(                                                                                \
    CHOICE("falloff", 0,                                                                           \
           "as light does, let down smoothly to 0 at the range; linear: 1 - distance / range, times "  \
           "what the other gives at a metre",                                                      \
           "inverse_square", "linear"),                                                            \
    KEY("name", "the variable's", "for --set NAME.power=value and presets; numbered when taken"))

const script_object reference_scene[] = {
    {"mesh", "scene", "geometry { mesh { \"data/ground.obj\" } }",
     "something solid, for geometry",
     .args = KEYS(KEY("file", "\"data/ground.obj\"", ".obj, .gltf or .glb")),
     .values = scene_mesh_values,
     .keys = KEYS(
        KEY("material", "material { }", "of all of it; without: what the file says"),
        KEY("parent", "node { }", "that it stands in"))},
    {"material", "scene", "mesh { \"data/barrel.obj\", material = material { metallic = 1, roughness = 0.3 } }",
     "what a surface is like. What is not given is as the file has it; a file that says nothing is matte",
     .values = scene_material_values,
     .keys = KEYS(
        KEY("texture", "\"data/bark.png\"", "PNG or JPEG: its colours, times `color`; by the file's coordinates"),
        KEY("toon", "true", "false: it keeps smooth light where model = \"toon\""),
        KEY("name", "the variable's", "for --set NAME.roughness=value and presets; numbered when taken"))},
    {"node", "scene", "local boat = node { position = {0, 0, 2} }; mesh { \"data/mast.obj\", parent = boat }",
     "a place for meshes and instances to stand in: they move, turn and grow with it",
     .values = scene_node_values,
     .keys = KEYS(
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
     .values = scene_camera_values},
    {"orbit", "scene", "fx.camera = orbit { target = {0, 0, 1}, distance = 6, yaw = 30 }",
     "a camera that circles a target",
     .values = scene_camera_values + 1, .takes = SCENE_ORBIT}, // all but the eye
    {"sun", "scene", "fx.sun = sun { azimuth = 120, elevation = 30 }", "the sun's light",
     .values = scene_sun_values},
    {"sky", "scene", "fx.sky = sky { zenith = \"#4060a0\", strength = 0.5 }",
     "the light of the sky, and what is seen of it: two colours, or an image",
     .values = scene_sky_values, .takes = SCENE_ALL,
     .keys = KEYS(
        KEY("image", "\"data/sky.exr\"",
            "instead of the colours: an equirectangular .exr of up to 8192x4096, whose middle is "
            "+Y"))},
    {"point_light", "scene", "fx.lights = { point_light { position = {2, 0, 3}, power = 200 } }",
     "a light that shines from a point into all directions",
     .values = scene_light_values, .keys = LIGHT},
    {"sphere_light", "scene", "fx.lights = { sphere_light { position = {2, 0, 3}, radius = 0.5 } }",
     "a glowing sphere: its shadows are soft",
     .values = scene_light_values, .takes = SCENE_SPHERE, .keys = LIGHT},
    {"spot_light", "scene", "fx.lights = { spot_light { position = {0, 0, 5}, angle = 30 } }",
     "a light that shines into a cone",
     .values = scene_light_values, .takes = SCENE_SPHERE | SCENE_CONE, .keys = LIGHT},
    {.name = NULL},
};
// clang-format on
