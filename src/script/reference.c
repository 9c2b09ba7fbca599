// The table of constructors. What a kind's row can say stands in field/kinds.c.
#include "script/reference.h"
#include "base/memory.h"
#include "scene/material.h"
#include "scene/scene.h"
#include <string.h>

// clang-format off
#define KEYS(...) (const script_key[]){__VA_ARGS__, {.name = NULL}}
#define KEY(NAME, VALUE, HELP) {.name = NAME, .value = VALUE, .help = HELP}
#define CHOICE(NAME, VALUE, HELP, ...)                                                             \
    {.name = NAME, .value = VALUE, .help = HELP, .words = {__VA_ARGS__}}
#define SLOT(TYPE, NAME, COMPONENTS, VALUE, HELP)                                                  \
    {.name = #NAME, .value = VALUE, .help = HELP, .components = COMPONENTS,                        \
     .offset = offsetof(TYPE, NAME)}

#define PLAYBACK                                                                                   \
    KEY("fps", "24 frames/s", "frames of the files a second of effect time"),                      \
    KEY("start", "0 s", "effect time at which the first frame is shown"),                          \
    KEY("speed", "1", "factor of the playing speed; negative: backwards"),                         \
    CHOICE("loop", "clip", "outside the range clip shows nothing, extend the nearest frame",       \
           "clip", "extend", "repeat", "ping_pong"),                                               \
    KEY("blend", "false", "mixes neighbouring frames at times between them"),                      \
    KEY("y_up", "false", "the files have Y up: turns them to Z up"),                               \
    KEY("scale", "1 m", "metres a unit of the file"),                                              \
    KEY("offset", "0, 0, 0 m", "added after scaling"),                                             \
    KEY("name", "the variable's", "for `roil export vdb`; numbered when taken")
#define LIGHT                                                                                      \
    SLOT(scene_light, position, 3, "{x, y, z} m", "where it stands; required"),                    \
    SLOT(scene_light, color, 3, "1, 1, 1", "multiplies the power"),                                \
    SLOT(scene_light, power, 1, "100 W",                                                           \
         "as light into all directions, of which a spot's cone is cut out"),                       \
    KEY("name", "the variable's", "for --set NAME.power=value and presets; numbered when taken")
#define SEQUENCE_MEMBERS KEYS(                                                                     \
    KEY("NAME", "field", "the grid of that name: density, temperature, flame, velocity ..."),      \
    KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "encloses all frames"),                   \
    KEY("frames", "number", "how many there are"),                                                 \
    KEY("duration", "number s", "of all frames at speed 1"))

#define LBM_KEYS KEYS(                                                                             \
    KEY("size", "{x, y, z} cells",                                                                 \
        "of the box: x a multiple of 4, z of 8 and at least 16; required"),                        \
    KEY("voxel_size", "m", "edge of a cell; required"),                                            \
    KEY("position", "0, 0, 0 m", "middle of the lowest face"),                                     \
    KEY("speed", "4 m/s", "that the air is expected to stay below: a step is the shorter for it"), \
    KEY("time_step", "0 s", "that a step takes; 0: by the speed"),                                 \
    KEY("warm_up", "0 s", "that are simulated before the first frame"),                            \
    KEY("boundary", "{ sides = \"open\", bottom = \"wall\", top = \"open\" }",                     \
        "a word for all faces, or one each for left, right, front, back, bottom, top; sides are "  \
        "the first four"),                                                                         \
    KEY("name", "\"lbm\"", "for --set NAME.key=value and statistics; numbered when taken"))

#define SLICES_KEYS KEYS(                                                                          \
    KEY("count", "2 [1, 32]", "slices; they stand at equal angles round the axis"),                \
    KEY("size", "{128, 128} cells [16, 2048]", "of a slice"),                                      \
    KEY("height", "1 m", "of a slice; its width follows from `size`"),                             \
    KEY("position", "0, 0, 0 m", "middle of the lower edge"),                                      \
    KEY("axis", "0, 0, 1", "that slices stand round; upwards in them"),                            \
    KEY("offset", "vec3 field m", "by which points are moved before they are turned into a slice: " \
        "a small fractal one hides that all sides are alike"),                                     \
    KEY("time_step", "1/60 s", "that a step takes"),                                               \
    KEY("warm_up", "0 s", "that are simulated before the first frame"),                            \
    KEY("max_iterations", "0", "of the pressure in a step; 0: what suits solver and size"),        \
    KEY("name", "\"slices\"", "for --set NAME.key=value and statistics; numbered when taken"))

static const script_object objects[] = {
    // ---- values
    {"param", "value", "param { \"density\", 20, min = 0, max = 100, unit = \"1/m\" }",
     "declares a parameter, which --set and `update` change. Its type is that of its default",
     .args = KEYS(
        KEY("name", "\"density\"", "letters, digits and _"),
        KEY("default", "20", "a number, true or false, \"#rrggbb\", {x, y, z} or a word")),
     .keys = KEYS(
        KEY("min", "number", "least value of each component; without: any"),
        KEY("max", "number", "greatest value of each component; without: any"),
        KEY("unit", "\"1/m\"", "shown with it"),
        KEY("help", "\"...\"", "shown with it"),
        KEY("group", "\"...\"", "shown with it"),
        KEY("log", "false", "moves by factors; needs min above 0"),
        KEY("integer", "false", "whole numbers only"),
        KEY("color", "false", "{r, g, b} is a linear colour, of any brightness"),
        KEY("words", "{\"one\", \"two\"}", "makes it a choice of 1 to 64 words")),
     .members = KEYS(
        KEY("get()", NULL, "its value now; of any field that does not vary in space"),
        KEY("set(value)", NULL, "for `update`"))},
    {"curve", "value", "curve { {0, 1}, {0.5, 3}, shape = \"cubic\" }",
     "keys over time: a number, vector or colour that moves",
     .args = KEYS(KEY("key ...", "{time, value}", "1 to 4096, of rising time (s)")),
     .keys = KEYS(
        CHOICE("shape", "linear", "between keys; cubic never overshoots (Fritsch and Carlson 1980)",
               "step", "linear", "cubic", "ease_in", "ease_out", "ease_in_out"),
        KEY("period", "0 s", "starts again after so long; 0: holds its first and last value"),
        KEY("name", "the variable's", "for --set and presets; numbered when taken"))},
    {"rgb", "value", "rgb(255, 128, 0)", "a colour from sRGB bytes, as picture editors show them",
     .args = KEYS(KEY("red", "[0, 255]", "sRGB"), KEY("green", "[0, 255]", "sRGB"),
                  KEY("blue", "[0, 255]", "sRGB"))},

    // ---- sources
    {"vdb", "source", "local burst = vdb { \"data/burst_*.vdb\", fps = 24 }",
     "a sequence of OpenVDB files; burst.density is a field, 0 outside the box",
     .args = KEYS(KEY("files", "\"data/burst_*.vdb\"", "one file, or many by *; sorted by name")),
     .keys = KEYS(
        CHOICE("storage", "auto",
               "on the device: the whole box, or only bricks of 8^3 voxels where there is something; "
               "auto takes these for large boxes that are mostly empty. The picture is the same",
               "auto", "dense", "sparse"),
        PLAYBACK),
     .members = SEQUENCE_MEMBERS},
    {"raw", "source", "local burst = raw { \"data/burst.raw\", size = {32, 32, 32} }",
     "a sequence of plain voxels in one file, little-endian, x fastest; burst.density is a field",
     .args = KEYS(KEY("file", "\"data/burst.raw\"", "all frames, one after another")),
     .keys = KEYS(
        KEY("size", "{x, y, z} voxels [1, 4096]", "of a frame; required"),
        CHOICE("type", "u8", "of a voxel; u8 and u16 become 0..1", "u8", "u16", "f16", "f32"),
        KEY("frames", "0", "how many there are; 0: as many as the file holds"),
        KEY("skip", "0 bytes", "before the first frame"),
        KEY("stride", "0 bytes", "from frame to frame; 0: without gaps"),
        KEY("voxel_size", "1 / size.x m", "edge of a voxel"),
        KEY("value_scale", "1", "factor of the values"),
        KEY("channel", "\"density\"", "name of its grid"),
        PLAYBACK),
     .members = SEQUENCE_MEMBERS},
    {"bake", "source", "bake(worley { 4 } * sphere { }, { size = 128 })",
     "computes a field into voxels, again when it has changed; gives a field that is cheap to sample",
     .args = KEYS(KEY("field", NULL, "what it computes")),
     .keys = KEYS(
        KEY("size", "64, 64, 64 voxels [1, 1024]", "a number, or one for each side"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m",
         "what the voxels cover; without: where the field is not zero, if that is known"),
        KEY("repeats", "false", "fills all of space with copies of the box"),
        KEY("levels", "false",
         "with `repeats`: adds mip levels, for where a pixel is wider than a voxel"),
        KEY("name", "the variable's", "for `roil export vdb`; numbered when taken"))},
    {"tile", "source", "worley { 1.4, octaves = 5 }:tile { resolution = 64 }",
     "noise, or an expression of noises, computed once into voxels that repeat: one sample instead "
     "of the noise. Its drift, frequency, persistence and amplitude may move; what changes its shape "
     "(speed, w, seed) computes it again",
     .args = KEYS(KEY("noise", NULL, "what it computes")),
     .keys = KEYS(
        KEY("resolution", "64 voxels [4, 512]", "along each side"),
        KEY("cells", "8 [1, 256]", "of the first noise along each side, after which it repeats; "
         "for simplex a multiple of 3"),
        KEY("octaves", "1 [1, 12]",
            "of a single noise that lie in the voxels, at whole lacunarities; the others are further "
            "samples of these, as many octaves each. Those of an expression all lie there"),
        KEY("levels", "true", "with mip levels"))},
    {"palette", "source", "palette { {0, \"#000\"}, {0.5, {1, 0.4, 0}}, {1, \"#fff3b0\", 0.5} }",
     "a number to colour and alpha. Called with a field it gives a field of colours: "
     "fire(burst.temperature). Instead of stops it takes `keys` or `blackbody`",
     .args = KEYS(KEY("stop ...", "{position, colour, alpha}",
                   "2 to 64 of rising position; \"#rrggbb\" is sRGB, {r, g, b} linear; alpha is 1 "
                   "if not given")),
     .keys = KEYS(
        CHOICE("space", "linear", "in which stops are mixed", "linear", "oklab"),
        KEY("min", "number", "position of its lower end; without: the first stop's"),
        KEY("max", "number", "position of its upper end; without: the last stop's"),
        KEY("keys", "{ {time, {stops}}, ... }", "1 to 64 palettes over time (s), mixed between"),
        KEY("blackbody", "{500, 3000} K", "glow of these temperatures; the position is in kelvin"),
        KEY("physical", "false", "of blackbody: brightness grows with the fourth power"),
        KEY("reference", "1500 K", "of physical: where the luminance is 1"),
        KEY("name", "the variable's", "for --set and presets; numbered when taken"))},
    {"image", "source", "image \"templates/source.exr\"",
     "a picture from a file, for what takes one",
     .args = KEYS(KEY("file", "\"templates/source.exr\"", ".exr or .png, up to 4096 pixels a side"))},
    {"glsl", "source", "glsl { \"swirl.glsl\", \"swirl\", 3, components = 1 }",
     "a GLSL function of yours as a field: float swirl(vec3 p, float turns)",
     .args = KEYS(
        KEY("file", "\"swirl.glsl\"", "in the effect's folder"),
        KEY("function", "\"swirl\"", "takes the point p (m), then the arguments"),
        KEY("argument ...", "field", "float, vec3 or vec4 as given; at most 16")),
     .keys = KEYS(KEY("components", "1", "of the result: 1, 3 or 4"))},

    {"lbm", "source", "local air = lbm { size = {64, 64, 96}, voxel_size = 0.05 }",
     "air that is simulated in a box, and carries smoke; air.density is a field, 0 outside the box. "
     "What else it takes is what `roil info passes lbm` lists: viscosity, buoyancy_heat ... Time "
     "passes in steps of its own, whatever is drawn: a frame that is jumped to is simulated from the "
     "first on",
     .keys = LBM_KEYS,
     .members = KEYS(
        KEY("source { }", "{ shape = field, density = 1, velocity = {0, 0, 2} }",
            "where the air is given smoke, heat and speed: where the shape is above 0.5, or within "
            "meshes, which come first and may move; `roil info passes lbm_source` lists the rest"),
        KEY("collider { }", "{ mesh { \"data/ball.obj\" } }",
            "meshes or instances, which may move, that the air flows around; rule = \"solid\" leaves gaps narrower "
            "than two cells open, as of `voxels`"),
        KEY("density", "field", "of smoke"),
        KEY("temperature", "field", "0 is that of the air around"),
        KEY("dye", "field", "a second colour of smoke"),
        KEY("velocity", "field m/s", "three components"),
        KEY("pressure", "field Pa", "beyond that of the air around"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "in which it is simulated"),
        KEY("time_step", "number s", "that a step takes"))},

    {"slices", "source", "local flow = slices { count = 4, size = {128, 128}, height = 4 }",
     "a few planes of simulated flow that stand round an axis, and what they hold turned round it; "
     "flow.density is a field, 0 outside. What else it takes is what `roil info passes slices` "
     "lists: reynolds, buoyancy_heat, vorticity, top = \"open\" ... Time passes in steps of its own, "
     "whatever is drawn",
     .keys = SLICES_KEYS,
     .members = KEYS(
        KEY("inflow { }", "{ shape = disc { 0.5, 0.05, radius = 0.06 }, density = 1, velocity = {0, 2} }",
            "where the flow is given density, temperature, dye and speed. Places are shares of the "
            "slice's width: x from 0 to 1, the axis at 1/2, y from 0 at the lower edge; "
            "`roil info passes slices_inflow` lists the rest"),
        KEY("obstacle { }", "{ image = image \"rock.png\" } or { shape = disc { }, velocity = {1, 0} }",
            "what stands in the way in all slices: what is dark in a picture that covers them, or a "
            "shape; `roil info passes slices_obstacle` lists the rest"),
        KEY("force { }", "{ force = {1, 0}, shape = disc { } }",
            "what pushes in some places (m/s^2); `roil info passes slices_force` lists the rest"),
        KEY("templates { }", "{ image \"templates/source.exr\", count = 40, size = {0.04, 0.12}, lifetime = {0.05, 0.4} }",
            "pictures of pressure or velocity that are put into the flow for a while, again and again: "
            "`count` in each slice, 20 if not given; `size` (widths of a slice) and `lifetime` (s) are "
            "one number, or {least, most}; center = {x, y} is that of align = \"radial\". "
            "`roil info passes slices_templates` lists the rest"),
        KEY("density", "field", "of smoke"),
        KEY("temperature", "field", "0 is that of the fluid around"),
        KEY("dye", "field", "a second colour of smoke"),
        KEY("velocity", "field m/s", "three components, turned with the arc"),
        KEY("pressure", "field m^2/s^2", "over the density of the fluid"),
        KEY("slice(1)", "its density, temperature, dye, velocity, pressure",
            "one slice as it is, its plane going on along its normal"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "around the cylinder that it fills"),
        KEY("time_step", "number s", "that a step takes"))},

    {"particles", "source", "local sparks = particles { count = 4096, rate = 2000, lifetime = {0.5, 2} }",
     "points that are born, are carried or thrown, meet what is solid and die; `splats` draws them. "
     "What else it takes is what `roil info passes particles` lists: rate, burst, velocity, speed, "
     "gravity, drag, collide ... Time passes in steps of its own, whatever is drawn",
     .args = KEYS(KEY("mesh", "mesh { \"data/ball.obj\" }", "on whose surface they are born; it may move")),
     .keys = KEYS(
        KEY("count", "65536 [1, 16777216]",
            "how many live at a time: of more, the oldest make room. 'rate' times 'lifetime', and "
            "those of bursts, are enough"),
        KEY("lifetime", "2 s", "or {0.5, 2}: the shortest and the longest"),
        KEY("shape", "field or mesh",
            "they are born where the field is above 0.5, evenly, or on the mesh, evenly; without: "
            "within 'radius' of 'position'"),
        KEY("above", "{field, threshold}", "instead of a shape: where the field is above that"),
        KEY("at", "instances { }",
            "they are born in the space of one of these, which moves, turns and scales the place; "
            "speed and quantity may use instance_state and the like there"),
        KEY("share", "1",
            "of each of these, as instance_state.x: 'rate' and 'burst' are times that, of all together; evaluated "
            "on the host"),
        KEY("time_step", "1/60 s", "that a step takes"),
        KEY("warm_up", "0 s", "that are simulated before the first frame, in air as it is then"),
        KEY("name", "\"particles\"", "for --set NAME.key=value and statistics; numbered when taken"))},

    {"explosions", "source", "local blasts = explosions { {0.5, position = {0, 0, 1}}, {1.2, size = 0.5} }",
     "a list of what bursts: when, where, how large; `shell` draws it. #list is how many there are. Up to 1024",
     .args = KEYS(KEY("explosion ...", "{ 0.5, position = {0, 0, 1} }",
                      "when (s), and the keys below; none: `add` brings them")),
     .keys = KEYS(
        KEY("position", "0, 0, 0 m", "where it bursts"),
        KEY("size", "1", "factor of the radius"),
        KEY("life", "1", "factor of how long it takes"),
        KEY("seed", "number [0, 16777215]", "no two look alike; without: its number in the list")),
     .members = KEYS(
        KEY("add", "blasts:add { position = {x, y, z}, size = 2 }",
            "one more from now on, while the effect runs: from a function of fx:on_frame, fx:on_key or "
            "fx:on_click. It is forgotten when time goes back"),
        KEY("get", "blasts:get(2)", "{ time, position, size, life, seed, shift, random } of the second, or nil; the last two are "
            "its shell_shift and shell_random"),
        KEY("latest", "blasts:latest(t, 2)",
            "the same of those that have begun by t: the second youngest, or nil. For lights: "
            "position = function(t) ... end"))},
    {"shell", "source", "local ball = shell { at = blasts, radius = 2, displacement = layers { {2, 1}, {7, 0.4} }, color = fire(shell_displacement + shell_depth).rgb }",
     "balls of fire and globes of smoke: spheres pushed out along their normals, one for each explosion; "
     "`over` lays them over a picture. What else it takes is what `roil info passes shell` lists: radius, "
     "displacement, color, clip, opacity, life ...",
     .keys = KEYS(
        KEY("at", "explosions { }", "when and where; without: once, at 0 s in the origin. The 64 youngest are drawn"),
        KEY("name", "\"shell\"", "for --set NAME.life=3 and statistics; numbered when taken"))},

    {"point_lights", "source", "local lamps = point_lights { count = 200, position = vec(3 * sin(time + light_index), 0, 2) }",
     "point lights by the hundred, for shade { from = {scene, lamps} } and forward { }: fields say how "
     "each of them shines, and may use light_index and light_random. What else it takes is what "
     "`roil info passes point_lights` lists: position, color, power, range, radius, falloff",
     .keys = KEYS(
        KEY("count", "number [1, 16384]", "how many there are"),
        KEY("at", "instances { }", "instead: one for each of these, in whose own space its position is; "
            "fields may use instance_state and the like, as in power = 200 * instance_state.x"),
        KEY("name", "\"point_lights\"", "for --set NAME.falloff=linear and statistics; numbered when taken"))},

    {"voxels", "source", "local body = voxels { mesh { \"data/ball.obj\" }, resolution = 64 }",
     "meshes as cells of a box: fields of what is inside of them, how far their surface is, how they "
     "move. Meshes that stand still are computed once",
     .args = KEYS(KEY("mesh ...", "mesh { \"data/ball.obj\" }", "1 to 63, which may move; instances are as many")),
     .keys = KEYS(
        KEY("resolution", "64 [8, 1024]", "cells along the longest side of the box"),
        KEY("size", "{x, y, z} [1, 1024]", "instead: cells along each side, x a multiple of 4"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m",
            "what the cells cover, at least; without: the meshes as they stand at first, and a margin"),
        CHOICE("rule", "auto",
               "solid fills what is inside, even where a mesh has holes; shell is every cell that a "
               "triangle touches; auto is solid where a mesh is closed, shell where it is open or thin",
               "auto", "solid", "shell"),
        KEY("name", "voxels", "for --set NAME.rule=shell and statistics; numbered when taken")),
     .members = KEYS(
        KEY("inside", "field", "1 in cells whose middle is inside, 0 elsewhere"),
        KEY("distance", "field m", "to the nearest surface, negative inside; beyond the box by way of it"),
        KEY("velocity", "field m/s", "of the mesh inside of it; 0 elsewhere"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "what the cells cover"))},
    {"deposit", "source", "local dust = deposit { chaff, box = { min = {-1, -1, 0}, max = {1, 1, 2} } }",
     "particles as the density of a volume: beside that of the smoke in `lighting` they cast shadows. "
     "Size, opacity and what else `roil info passes deposit` lists are set here too",
     .args = KEYS(KEY("particles", "particles { }", "which; or by the key `particles`, or `from`")),
     .keys = KEYS(
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "where they are counted; required"),
        KEY("resolution", "32 [4, 512]", "cells along the longest side of the box"),
        KEY("name", "deposit", "for --set NAME.amount=value and statistics; numbered when taken")),
     .members = KEYS(
        KEY("density", "field 1/m", "extinction of the particles in a cell; 0 outside of the box"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "as it was given"))},

    // ---- operators
    {"lerp", "operator", "lerp(a, b, 0.5)", "another name of mix",
     .args = KEYS(KEY("a", NULL, "result at t = 0"), KEY("b", NULL, "result at t = 1"),
                  KEY("t", "0.5", "share of b"))},
    {"over_age", "operator", "over_age { {0, 0.01}, {0.2, 0.1}, {1, 0} }",
     "a number or a colour over a particle's life: that of a palette at particle_age",
     .args = KEYS(KEY("key ...", "{age, value}", "2 to 64, of rising age in 0..1; values from 0 to 65504"))},
    {"quantise", "operator", "quantise(value, 4)",
     "the middle of the step that a value lies in: flat bands instead of shades",
     .args = KEYS(KEY("value", NULL, "0..1, or any"), KEY("steps", NULL, "how many there are from 0 to 1"))},
    {"saturate", "operator", "saturate(value)", "limits a value to 0..1",
     .args = KEYS(KEY("value", NULL, "what it limits"))},

    {"layers", "noise", "layers { {2, 1}, {7, 0.4}, seed = 3 }",
     "the layered noise of a layered explosion, 0..1: a sum over {scale, strength} of noise at each scale times "
     "its strength, divided by all strengths. Of a shell: at the unit sphere. Other keys are those of the noise",
     .args = KEYS(KEY("layer ...", "{scale, strength}", "1 to 8")),
     .keys = KEYS(
        KEY("noise", "perlin", "perlin, simplex, value or worley: what makes it"),
        KEY("dimensions", "3", "2: a picture that is wrapped around the origin, as published; scales are rounded"),
        KEY("shift", "shell_shift", "0..1 in x, y and z: moves it"))},

    // ---- the scene
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
        KEY("texture", "\"data/bark.png\"", "its colours, times `color`; by the file's coordinates"),
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
     "which may change at any time. When time goes back they are as they began. Numbers are said for "
     "all, as {low, high} for chance to pick from, as a list, or by a function(i, place)",
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

    // ---- the effect
    {"effect", "effect", "local fx = effect { name = \"explosion\", fps = 24, frames = 100 }",
     "declares the effect, once in a file. What it shows is assigned to its members",
     .keys = KEYS(
        KEY("name", "the file's", "shown in reports"),
        KEY("fps", "24 (0, 1000] frames/s", "frames a second"),
        KEY("frames", "1 [1, 1000000]", "length"),
        KEY("first", "1", "number of the first frame, whose time is 0"),
        KEY("seed", "0", "of math.random; shaders read it too")),
     .members = KEYS(
        KEY("output", "image", "the picture for a display; required"),
        KEY("linear", "image", "the picture for EXR: scene-linear"),
        KEY("depth", "image", "distance along the view axis (m), for EXR"),
        KEY("camera", "orbit { } or camera { }", "see there"),
        KEY("sun", "sun { }", "see there"),
        KEY("sky", "sky { }", "see there"),
        KEY("lights", "{ point_light { }, ... }", "up to 63 besides the sun"),
        KEY("update", "function(t, dt)", "runs before each frame, to set parameters"),
        KEY("events", "{ { 2.5, key = \"f\" }, { 3, click = {0.4, 0.6} } }",
            "what happens to it at which second; {x, y}: 0..1 from the top left of the picture, "
            "{x, y, z}: over that point; at = {x, y} gives a key a place, too. `--event` says "
            "another list"),
        KEY("on_start", "fx:on_start(function() end)",
            "runs at time 0, and again whenever time goes back: what the functions below keep "
            "begins anew there"),
        KEY("on_frame", "fx:on_frame(function(t, dt) end)",
            "runs at each frame of the timeline once, those left out too; several, in order"),
        KEY("on_key", "fx:on_key(\"f\", function(event) end, \"what it does\")",
            "runs when the key is pressed: event.time, event.key and what on_click has"),
        KEY("on_click", "fx:on_click(function(event) end, \"what it does\")",
            "runs at a click in the picture: event.x, event.y, event.ray { origin, direction }, "
            "event.hit { position, normal, distance, mesh, instances, index } or nil"),
        KEY("status", "fx:status(\"burning\", 12)", "a number for users to see while it runs"))},
    {"pick", "effect", "pick(0.5, 0.5), pick { {0, -5, 1}, {0, 1, 0} }",
     "what a ray meets first, through a place in the picture or from a point into a direction: as "
     "event.hit of fx:on_click. Meshes that are drawn, else the ground z = 0; else nil. While the "
     "effect runs, not while the file loads",
     .args = KEYS(KEY("x, y", NULL, "0..1 from the top left of the picture"),
                  KEY("ray", NULL, "instead: origin and direction"))},
    {"shader", "effect", "shader { \"haze.comp\", image, strength = 0.2 }",
     "a GLSL file of yours as a pass. Passes give images: the pass itself is its first output, "
     "result.NAME any. The keys below are every pass's; others are what the file declares",
     .args = KEYS(
        KEY("file", "\"haze.comp\"", "in the effect's folder"),
        KEY("image ...", NULL, "its inputs, in the order in which it declares them")),
     .keys = KEYS(
        KEY("name", "the type's", "for --set NAME.key=value and statistics; numbered when taken"),
        KEY("resolution", "1 (0, 1]", "size of its outputs relative to the picture"),
        KEY("format", "\"rgba16f\"", "of the first output; { NAME = \"r32f\", ... } of any"),
        KEY("from", "{lit, scene}",
            "passes, or one, from which it takes what is not given here: outputs of theirs as the "
            "inputs of that name; fields, options and numbers of that name, which go on moving. "
            "The first that has it counts"))},
    {"history", "effect", "history(volume.color)",
     "an image as it was in the last frame; zero in the first",
     .args = KEYS(KEY("image", NULL, "a pass or one of its outputs"))},
};
// clang-format on

const script_object *script_objects(size_t *count) {
    *count = COUNT_OF(objects);
    return objects;
}

const script_object *script_object_find(const char *name) {
    for (size_t i = 0; i < COUNT_OF(objects); i++)
        if (strcmp(objects[i].name, name) == 0) return &objects[i];
    return NULL;
}

const script_key *script_key_find(const script_key *keys, const char *name) {
    for (; keys && keys->name; keys++)
        if (strcmp(keys->name, name) == 0) return keys;
    return NULL;
}

bool script_has_kind(const field_kind *kind) {
    static const char *const nameless[] = {"constant", "call", "grid", "swizzle"};
    for (size_t i = 0; i < COUNT_OF(nameless); i++)
        if (strcmp(nameless[i], kind->name) == 0) return false;
    return !script_object_find(kind->name);
}
