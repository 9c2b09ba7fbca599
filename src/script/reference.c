// The table of constructors: values, operators and the effect. field/kinds.c describes kinds of
// fields.
#include "base/memory.h"
#include "base/words.h"
#include "script/reference_rows.h"
#include <string.h>

// clang-format off
static const script_object reference_words[] = {
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
        CHOICE("shape", 1, "between keys; cubic never overshoots (Fritsch and Carlson 1980)",
               "step", "linear", "cubic", "ease_in", "ease_out", "ease_in_out"),
        KEY("period", "0 s", "starts again after so long; 0: holds its first and last value"),
        KEY("name", "the variable's", "for --set and presets; numbered when taken"))},
    {"rgb", "value", "rgb(255, 128, 0)", "a colour from sRGB bytes, as picture editors show them",
     .args = KEYS(KEY("red", "[0, 255]", "sRGB"), KEY("green", "[0, 255]", "sRGB"),
                  KEY("blue", "[0, 255]", "sRGB"))},

    // ---- operators
    {"lerp", "operator", "lerp(a, b, 0.5)", "another name of mix",
     .args = KEYS(KEY("a", NULL, "result at t = 0"), KEY("b", NULL, "result at t = 1"),
                  KEY("t", "0.5", "share of b"))},
    {"over_age", "operator", "over_age { {0, 0.01}, {0.2, 0.1}, {1, 0} }",
     "a number or a colour over a particle's life: a control, a curve or a palette at particle_age, "
     "that is called what it is given to",
     .args = KEYS(KEY("key ...", "{age, value}", "2 to 64, of rising age in 0..1; values from 0 to 65504"))},
    {"quantise", "operator", "quantise(value, 4)",
     "the middle of the step that a value lies in: flat bands instead of shades",
     .args = KEYS(KEY("value", NULL, "0..1, or any"), KEY("steps", NULL, "how many there are from 0 to 1"))},
    {"saturate", "operator", "saturate(value)", "limits a value to 0..1",
     .args = KEYS(KEY("value", NULL, "what it limits"))},

    {"layers", "noise", "layers { {2, 1}, {7, 0.4}, seed = 3 }",
     "the layered noise of a layered explosion, 0..1: a sum over {scale, strength} of noise at each scale times "
     "its strength, divided by all strengths. Of a shell: at the unit sphere. Other keys are those of the noise",
     .args = KEYS(KEY("layer ...", "{scale, strength}", "1 to 64")),
     .keys = KEYS(
        KEY("noise", "perlin", "perlin, simplex, value or worley: what makes it"),
        KEY("dimensions", "3", "2: a picture that is wrapped around the origin, as published; scales are rounded"),
        KEY("shift", "shell_shift", "0..1 in x, y and z: moves it"))},

    {"blast", "blast", "local burst = blast { position = {0, 0, 1}, time = 0.2, charge = 2 }",
     "a burst as an event: what it does to the air around, as fields of the distance from it and of time, that throw "
     "particles, tear up dust and bend what is near. It is in free air and meets nothing; the gas of `pyro` does not know it",
     .keys = KEYS(
        KEY("position", "0, 0, 0 m", "where it bursts"), KEY("time", "0 s", "when"),
        KEY("charge", "1 kg", "TNT that is as strong; on the ground a burst is as one of 1.8 times the charge in free air")),
     .members = KEYS(
        KEY("pressure", "field Pa", "beyond that of the air: a front, then a pulse that ends in suction; 0 before it arrives"),
        KEY("velocity", "field m/s", "of the air behind the front: outwards, then back"),
        KEY("impulse", "field Pa s",
            "of the overpressure: what is thrown goes at that times its area by its mass, so that steps need not be as "
            "short as the pulse: a few milliseconds for 1 kg"),
        KEY("arrival", "field s", "time at which the front arrives"))},

    // ---- the effect
    {"effect", "effect", "local fx = effect { name = \"explosion\", fps = 24, frames = 100 }",
     "declares the effect, once in a file. What it shows is assigned to its members",
     .keys = KEYS(
        KEY("name", "the file's", "shown in reports"),
        KEY("author", NULL, "who made it, in a line: for `roil info` and bundles"),
        KEY("licence", NULL, "under which others may use it, in a line: \"MIT\", \"CC BY 4.0\""),
        KEY("fps", "24 (0, 1000] frames/s", "frames a second"),
        KEY("frames", "1 [1, 1000000]", "length"),
        KEY("first", "1", "number of the first frame, whose time is 0"),
        KEY("seed", "0", "of math.random; shaders read it too")),
     .members = KEYS(
        KEY("output", "image", "the picture for a display; required"),
        KEY("linear", "image", "the picture for EXR: scene-linear"),
        KEY("depth", "image", "distance along the view axis (m), for EXR"),
        KEY("antialias", "false", "edges are smooth: what is seen is gathered over frames, by a pass "
            "`accumulate` before the last `final`, while the camera moves within a pixel"),
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
    {"spread", "effect", "local spread = require \"spread\"; local fire = spread { fx = fx, at = forest }",
     "a module: fire, or whatever passes from one thing to the next, by a queue of events. Each is normal, "
     "then burning, then burned; fire:on_ignite(function(i, t) end), on_late and on_burned are told",
     .module = true,
     .keys = KEYS(
        KEY("fx", "effect { }", "required"),
        KEY("at", "instances { }, { {x, y, z}, ... } m", "what burns; required"),
        KEY("reach", "4 m", "how far away one lights another: what lies farther off stops it"),
        KEY("wind", "0, 0, 0 m/s", "a parameter or a function(t), too"),
        KEY("speed", "1 m/s", "of the fire, without wind"),
        KEY("gain", "0.3", "of the speed with the wind: this share for each m/s of it"),
        KEY("shelter", "0.3", "part of the wind that shapes it: the more, the slower against the wind and across"),
        KEY("lean", "0.1 s", "how far the wind carries the reach"),
        KEY("burn", "{4, 6} s", "that one burns: the shortest and the longest"),
        KEY("fuel", "1", "a list or function(i): factor of that; 0: it is never lit"),
        KEY("variation", "0.3 [0, 1]", "by how much times differ"),
        CHOICE("pass", 0, "when it is passed on: ignite: while one burns; burned: when it has, as of what bursts", "ignite", "burned"),
        KEY("late", "0.5 s", "before its end, at which on_late runs"),
        KEY("most", "64", "changes in a frame; others come in the next"),
        KEY("seed", "0", "of chance")),
     .members = KEYS(
        KEY("ignite(i)", NULL, "lights one; false where it cannot"),
        KEY("ignite_near({x, y, z}, radius)", NULL, "the nearest that can be lit: its number, or nil"),
        KEY("put_out(i)", NULL, "it lights nothing any more, and counts as burned"),
        KEY("state(i)", "\"normal\"", "or \"burning\", \"burned\""),
        KEY("progress(i)", "0..1", "part of its fire that has passed"),
        KEY("burning", "number", "how many burn"), KEY("burned", "number", "how many have"),
        KEY("lit", "list s", "when each was lit; ends: when it is burnt out"))},
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
    {.name = NULL},
};
// clang-format on

const script_object *script_object_at(size_t index) {
    static const script_object *const tables[] = {reference_words, reference_sources,
                                                  reference_scene};
    for (size_t i = 0; i < COUNT_OF(tables); i++)
        for (const script_object *row = tables[i]; row->name; row++)
            if (index-- == 0) return row;
    return NULL;
}

const script_object *script_object_find(const char *name) {
    const script_object *object;
    for (size_t i = 0; (object = script_object_at(i)); i++)
        if (strcmp(object->name, name) == 0) return object;
    return NULL;
}

const value_desc *script_key_find(const value_desc *keys, const char *name) {
    for (; keys && keys->name; keys++)
        if (strcmp(keys->name, name) == 0) return keys;
    return NULL;
}

const scene_value *script_object_value(const script_object *object, const scene_value *last) {
    const scene_value *next = last ? last + 1 : object->values;
    while (next && next->desc.name && (next->need & ~object->takes)) next++;
    return next && next->desc.name ? next : NULL;
}

const value_desc *script_object_key(const script_object *object, size_t index) {
    const scene_value *v = NULL;
    while ((v = script_object_value(object, v)))
        if (index-- == 0) return &v->desc;
    for (const value_desc *key = object->keys; key && key->name; key++)
        if (index-- == 0) return key;
    return NULL;
}

bool script_has_kind(const field_kind *kind) {
    static const char *const nameless[] = {"constant", "call", "grid", "swizzle"};
    return words_find(nameless, COUNT_OF(nameless), kind->name) < 0 &&
           !script_object_find(kind->name);
}
