// The constructors of what fills space: files, noise in voxels, simulations, particles.
#include "script/reference_rows.h"

// clang-format off
#define PLAYBACK                                                                                   \
    KEY("fps", "24 frames/s", "frames of the files a second of effect time"),                      \
    KEY("start", "0 s", "effect time at which the first frame is shown; may move as `speed`"),      \
    KEY("speed", "1",                                                                              \
        "factor of the playing speed; negative: backwards. A parameter, curve or function of time " \
        "is added up from frame to frame of the effect: playing goes on from where it is, and 0 "   \
        "stops it"),                                                                               \
    CHOICE("loop", 0, "outside the range clip shows nothing, extend the nearest frame",       \
           "clip", "extend", "repeat", "ping_pong"),                                               \
    KEY("blend", "false", "mixes neighbouring frames at times between them"),                      \
    KEY("scale", "1 m", "metres a unit of the file"),                                              \
    KEY("offset", "0, 0, 0 m", "added after scaling"),                                             \
    KEY("name", "the variable's", "for `roil export vdb`; numbered when taken")
#define SEQUENCE_MEMBERS KEYS(                                                                     \
    KEY("NAME", "field", "the grid of that name: density, temperature, flame, velocity ..."),      \
    KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "encloses all frames"),                   \
    KEY("frames", "number", "of its timeline, those without a file included"),                                                 \
    KEY("duration", "number s", "of all frames at speed 1"))

#define LBM_KEYS KEYS(                                                                             \
    KEY("size", "{x, y, z} cells",                                                                 \
        "of the box, at least 4: x a multiple of 4, z of 8, z at least 16; required"),                        \
    KEY("voxel_size", "m", "edge of a cell; required"),                                            \
    KEY("position", "0, 0, 0 m", "middle of the lowest face"),                                     \
    KEY("speed", "4 m/s", "that the air is expected to stay below: a step is the shorter for it"), \
    KEY("time_step", "0 s", "that a step takes; 0: by the speed"),                                 \
    KEY("warm_up", "0 s", "that are simulated before the first frame"),                            \
    KEY("time_scale", "1", "seconds that are simulated in one of the effect: 12 is time lapse, 0.2 slow motion"), \
    KEY("boundary", "{ sides = \"open\", bottom = \"wall\", top = \"open\" }",                     \
        "a word for all faces, or one each for left, right, front, back, bottom, top; sides are "  \
        "the first four"),                                                                         \
    KEY("name", "\"lbm\"", "for --set NAME.key=value and statistics; numbered when taken"))

#define PYRO_KEYS KEYS(                                                                            \
    KEY("size", "{x, y, z} cells", "of the box: multiples of 8 from 16 to 1024, of 16 with velocity_cells = \"half\"; required"),        \
    KEY("voxel_size", "m", "edge of a cell; required"),                                            \
    KEY("position", "0, 0, 0 m", "middle of the lowest face"),                                     \
    KEY("speed", "12 m/s", "that the gas is expected to reach: a step is the shorter for it"),     \
    KEY("time_step", "0 s", "that a step takes; 0: in which the speed crosses 1.5 cells of the velocity"),         \
    KEY("warm_up", "0 s", "that are simulated before the first frame"),                            \
    KEY("time_scale", "1", "seconds that are simulated in one of the effect: 12 is time lapse, 0.2 slow motion"), \
    KEY("boundary", "{ sides = \"open\", bottom = \"wall\", top = \"open\" }",                     \
        "a word for all faces, or one each for left, right, front, back, bottom, top; sides are "  \
        "the first four"),                                                                         \
    KEY("name", "\"pyro\"", "for --set NAME.key=value and statistics; numbered when taken"))

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

const script_object reference_sources[] = {
    {"vdb", "source", "local burst = vdb { \"data/burst_*.vdb\", fps = 24 }",
     "a sequence of OpenVDB files; burst.density is a field, 0 outside the box",
     .args = KEYS(KEY("files", "\"data/burst_*.vdb\"",
                    "one file, or many by *. The last number in a name, if all else in the names is the "
                    "same, is the file's frame, and the least is the first; a frame without a file shows "
                    "the one before (`blend`: a mix of those around), and a warning names it")),
     .keys = KEYS(
        CHOICE("storage", 0,
               "on the device: the whole box, or only bricks of 8^3 voxels where there is something; "
               "auto takes these for large boxes that are mostly empty. The picture is the same",
               "auto", "dense", "sparse"),
        CHOICE("level_set", 0,
               "what a level set becomes, whose values are distances to a surface: solid is 1 inside and "
               "fades in the outer half of its band; fog is 0 outside and fades in the inner half",
               "solid", "fog"),
        KEY("y_up", "by their creator",
            "the files have Y up, as Houdini's: turns them to Z up; `roil info FILE` says so"),
        PLAYBACK),
     .members = SEQUENCE_MEMBERS},
    {"raw", "source", "local burst = raw { \"data/burst.raw\", size = {32, 32, 32} }",
     "a sequence of plain voxels in one file, little-endian; burst.density is a field",
     .args = KEYS(KEY("file", "\"data/burst.raw\"", "all frames, one after another")),
     .keys = KEYS(
        KEY("size", "{x, y, z} voxels [1, 4096]", "of a frame, along x, y and z; required"),
        KEY("axes", "\"xyz\"",
            "along which voxels follow each other in the file, the fastest first; '-' before one that "
            "runs backwards: \"zyx\", \"x-yz\""),
        CHOICE("type", 0, "of a voxel; u8 and u16 become 0..1", "u8", "u16", "f16", "f32"),
        KEY("frames", "0", "how many there are; 0: as many as the file holds"),
        KEY("skip", "0 bytes", "before the first frame"),
        KEY("stride", "0 bytes", "from frame to frame; 0: without gaps"),
        KEY("voxel_size", "1 / size.x m", "edge of a voxel"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m",
            "that the voxels of every frame cover, instead of `voxel_size` and a corner at 0"),
        KEY("padding", "0 voxels", "of nothing around that box, into which the values fade"),
        KEY("value_scale", "1", "factor of the values"),
        KEY("channel", "\"density\"", "name of its grid"),
        KEY("y_up", "false", "the file has Y up: turns it to Z up"),
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
        CHOICE("space", 0, "in which stops are mixed", "linear", "oklab"),
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
            "meshes, which come first and may move, each by its own position or all by motion = "
            "curve { ... }, or near particles, as in particles = debris, radius = 0.15; "
            "`roil info passes lbm_source` lists the rest"),
        KEY("collider { }", "{ mesh { \"data/ball.obj\" } }",
            "meshes or instances, any number, which may move, that the air flows around; motion = curve { ... } is the position of "
            "meshes that say none; rule = \"solid\" leaves gaps narrower than two cells open, as of `voxels`"),
        KEY("templates { }", "{ image \"templates/source.exr\", count = 40, size = {0.2, 0.6}, lifetime = {0.1, 0.5} }",
            "pictures of pressure or velocity that are put into the air for a while, again and again: "
            "`count` at a time, 20 if not given; `size` (m) and `lifetime` (s) are one number, or "
            "{least, most}; `roil info passes lbm_templates` lists the rest"),
        KEY("density", "field", "of smoke"),
        KEY("temperature", "field", "0 is that of the air around"),
        KEY("dye", "field", "a second colour of smoke"),
        KEY("velocity", "field m/s", "three components"),
        KEY("pressure", "field Pa", "beyond that of the air around"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "in which it is simulated"),
        KEY("time_step", "number s", "that a step takes"))},

    {"pyro", "source", "local fire = pyro { size = {64, 64, 96}, voxel_size = 0.05, fuel = \"petrol\" }",
     "gas that burns in a box: fuel that is hot and finds air becomes fire, which expands, rises and "
     "leaves soot; fire.soot is a field, 0 outside the box. What else it takes is what `roil info "
     "passes pyro` lists: burn_time, cooling, vorticity ... Time passes as in `lbm`",
     .keys = PYRO_KEYS,
     .members = KEYS(
        KEY("source { }", "{ shape = field, fuel = 2, temperature = 900, during = {0, 0.15} }",
            "where the gas is given fuel, heat, soot and speed: where the shape is above 0.5, within "
            "meshes, or near particles, as of `lbm`; `roil info passes pyro_source` lists the rest"),
        KEY("spark { }", "{ at = {0, 0, 0.2}, time = 0.1 }",
            "a ball of hot gas for a moment, which lights fuel: its radius is 2.5 cells, its "
            "temperature 1500 K, its duration 0.05 s, if not given"),
        KEY("templates { }", "{ image \"templates/source.exr\", count = 40, size = {0.2, 0.6}, lifetime = {0.1, 0.5} }",
            "pictures of pressure or velocity that are put into the gas for a while, again and again: "
            "`count` at a time, 20 if not given; `size` (m) and `lifetime` (s) are one number, or "
            "{least, most}; `roil info passes pyro_templates` lists the rest"),
        KEY("temperature", "field K", "0 outside the box"),
        KEY("fuel", "field kg/m^3", "that has not burnt"),
        KEY("soot", "field kg/m^3", "black smoke; 1 kg hides 8700 m^2"),
        KEY("burn", "field MW/m^3", "heat of burning"),
        KEY("velocity", "field m/s", "three components"),
        KEY("pressure", "field Pa", "beyond that of the air around"),
        KEY("divergence", "field 1/s", "how fast the gas expands, or comes out of templates"),
        KEY("vorticity", "field 1/s", "how fast it turns"),
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
     "a list of what bursts: when, where, how large; `shell` draws it: of those that go on, the 64 youngest. "
     "#list is how many there are, up to 1024: then the oldest that was added makes room",
     .args = KEYS(KEY("explosion ...", "{ 0.5, position = {0, 0, 1} }",
                      "when (s), and the keys below; none: `add` brings them")),
     .keys = KEYS(
        KEY("position", "0, 0, 0 m", "where it bursts"),
        KEY("size", "1", "factor of the radius"),
        KEY("life", "1", "factor of how long it takes"),
        KEY("seed", "number [0, 16777215]", "no two look alike; without: its number among all that the list has had")),
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
     .args = KEYS(KEY("mesh ...", "mesh { \"data/ball.obj\" }", "any number, which may move; of instances each is one")),
     .keys = KEYS(
        KEY("resolution", "64 [8, 1024]", "cells along the longest side of the box"),
        KEY("size", "{x, y, z} [1, 1024]", "instead: cells along each side, x a multiple of 4"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m",
            "what the cells cover, at least; without: the meshes as they stand at first, and a margin"),
        CHOICE("rule", 0,
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
        KEY("velocity", "field m/s", "mean of the particles in a cell; 0 where none is"),
        KEY("box", "{ min = {x, y, z}, max = {x, y, z} } m", "as it was given"))},
    {.name = NULL},
};
// clang-format on
