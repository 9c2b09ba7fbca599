// What a script's author reads after a mistake: the line, the name at fault, what is accepted.
#include "script_helper.h"

// Every case begins with these lines, so its own first line is line 3.
#define START "local fx = effect { name = 'test' }\nlocal img = geometry {}\n"

typedef struct mistake {
    const char *text;    // follows START
    const char *message; // how the error goes on after "e.lua:3: "
} mistake;

static void check(const mistake *cases, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char text[2000], expected[PATH_CAP];
        snprintf(text, sizeof text, START "%s\nfx.output = img", cases[i].text);
        effect *e = helper_load(text);
        if (e) fail_msg("no error in: %s", cases[i].text);
        snprintf(expected, sizeof expected, "e.lua:3: %s", cases[i].message);
        const char *got = strstr(err_get(), "e.lua:");
        if (!got || strncmp(got, expected, strlen(expected)) != 0)
            fail_msg("in: %s\n got: %s\n wanted: %s", cases[i].text, err_get(), expected);
    }
}

#define CHECK(CASES) check(CASES, sizeof CASES / sizeof *CASES)

static void misspelt_names_get_the_nearest_right_one(void **state) {
    (void)state;
    static const mistake cases[] = {
        {"local a = wrley { }", "unknown name 'wrley'; did you mean 'worley'?"},
        {"local a = worley { freqency = 2 }",
         "worley: unknown key 'freqency'; did you mean 'frequency'?"},
        {"local a = worley { fractal = 'rigded' }",
         "worley: unknown value of 'fractal' 'rigded'; did you mean 'ridged'?"},
        {"local a = worley { }:wrap(curl { })",
         "field: unknown method 'wrap'; did you mean 'warp'?"},
        {"fx.ouptut = img", "effect: unknown field 'ouptut'; did you mean 'output'?"},
        {"local a = fx.nmae", "effect: unknown field 'nmae'; did you mean 'name'?"},
        {"param { 'x', 1, mni = 0 }", "param: unknown key 'mni'; did you mean 'min'?"},
        {"curve { {0, 1}, shpae = 'step' }", "curve: unknown key 'shpae'; did you mean 'shape'?"},
        {"palette { {0, '#000'}, {1, '#fff'}, spcae = 'oklab' }",
         "palette: unknown key 'spcae'; did you mean 'space'?"},
        {"vdb { 'x.vdb', fsp = 3 }", "vdb: unknown key 'fsp'; did you mean 'fps'?"},
        {"orbit { ptich = 3 }", "orbit: unknown key 'ptich'; did you mean 'pitch'?"},
        {"mesh { 'x.obj', roation = 3 }", "mesh: unknown key 'roation'; did you mean 'rotation'?"},
        {"march { densty = 1 }", "march: unknown key 'densty'; did you mean 'density'?"},
        {"march { density = 1, mode = 'papre' }", "march: option 'mode' cannot be 'papre'"},
        {"local a = img.deptj", "geometry: unknown output 'deptj'; did you mean 'depth'?"},
        {"bake(sphere { }, { szie = 3 })", "bake: unknown key 'szie'; did you mean 'size'?"},
        {"effect { fsp = 3 }", "effect: unknown key 'fsp'; did you mean 'fps'?"},
    };
    CHECK(cases);
}

static void values_of_the_wrong_kind_are_named(void **state) {
    (void)state;
    static const mistake cases[] = {
        {"worley(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18)", "worley"},
        {"worley { frequency = 'high' }", "worley: 'frequency' must be a colour as"},
        {"worley { frequency = {} }", "worley: 'frequency' must be a number, {x, y, z}"},
        {"worley { frequency = print }", "worley: the function for 'frequency' must return"},
        {"worley { frequency = function() return 0 / 0 end }",
         "worley: the function for 'frequency'"},
        {"worley { frequency = worley { } }", "worley: 'frequency' varies in space"},
        {"worley { frequency = 0 / 0 }", "worley: 'frequency' must be finite"},
        {"worley { 1, frequency = 2 }", "worley: 'frequency' is given twice"},
        {"worley { [2.5] = 2 }", "worley: a key is a number"},
        {"local a = worley { } < 1", "fields and parameters cannot be compared"},
        {"local a = worley { } .. 'x'", "attempt to concatenate"},
        {"local a = worley { } + {}", "+: 'right side' must be"},
        {"local a = (worley { }).q", "field: unknown method 'q'"},
        {"local a = (worley { }).y", "'y' does not choose"},
        {"local a = (worley { }):get()", "get: this field varies in space"},
        {"local a = (worley { } * 1):set(3)", "set: only a parameter"},
        {"worley { }.warp(1)", "warp"},
        {"march(3)", "march: values without a name are images"},
        {"march { density = img }", "march: 'density' must be"},
        {"march { density = 1, steps = worley { } }", "march: 'steps' varies in space"},
        {"march { density = 1, steps = 1e9 }",
         "march: uniform 'steps' is 1e+09; accepted: 1 to 4096"},
        {"march { density = 1, depth = 3 }", "march: input 'depth' takes an image"},
        {"march { density = 1, mode = {} }", "march: option 'mode' takes a word"},
        {"march { density = 1, resolution = 2 }", "march: resolution is 2; accepted"},
        {"march { density = 1, resolution = param { 'r', 1 } }",
         "march: 'resolution' must be a plain"},
        {"march { density = 1, name = 'a b' }", "pass name 'a b' is not a name"},
        {"march { density = 1, format = 'rgb' }", "march: 'rgb' is no format"},
        {"march { density = 1, format = {colr = 'r32f'} }", "march: no output 'colr'"},
        {"march { }", "march: field 'density' is missing"},
        {"over(img)", "over: input 'source' is missing"},
        {"bright { img, img }", "bright: too many images; it takes 1 without a name"},
        {"over { img, volume = img }", "over: input 'volume' is given twice"},
        {"bloom { mesh { 'none.obj' } }", ""},
        {"history(3)", "history takes an image"},
        {"fx.output = 3", "effect: 'output' takes an image"},
        {"fx.camera = sun { }", "effect: 'camera' takes orbit { } or camera { }"},
        {"fx.update = 3", "effect: 'update' takes a function"},
        {"camera { target = 3 }", "camera: 'eye' is missing"},
        {"orbit { 3 }", "orbit takes only named values"},
        {"orbit(3)", "orbit takes a table"},
        {"effect { }", "effect { } is called twice"},
        {"shader { }", "shader: its file comes first"},
        {"shader { 'none.comp' }", ""},
        {"shader { '../../etc/passwd' }", ""},
        {"glsl { }", "glsl: wanted are a file and a function"},
        {"setmetatable(img, {})", "bad argument #1 to 'setmetatable'"},
        {"img.x = 3", "attempt to index a pass result value"},
    };
    CHECK(cases);
}

static void declarations_are_checked(void **state) {
    (void)state;
    static const mistake cases[] = {
        {"param { }", "param: its name comes first"},
        {"param { 'x' }", "param 'x': the default must be"},
        {"param { 'x', {1, 2} }", "param 'x': the default must be"},
        {"param { 'x', 1.5, integer = true }", "param 'x': integer = true needs a whole number"},
        {"param { 'x', 5, max = 3 }", "parameter 'x' is 5; accepted: 3 or less"},
        {"param { 'x', 'c', words = {'a', 'b'} }", "x: unknown value of 'default' 'c'"},
        {"param { 'x', 1, log = true }", "param 'x': log = true needs min above 0"},
        {"param { 'a b', 1 }", "parameter name 'a b'"},
        {"param { 'x', 1 } param { 'x', 2 }", "parameter 'x' is declared twice"},
        {"param { 'x', 1, min = 'low' }", "param: 'min' must be a plain number"},
        {"curve { }", "curve: 1 to 4096 keys"},
        {"curve { {0, 1}, {1, {1, 2, 3}} }", "curve: key 2 has 3 components"},
        {"curve { {0, 1}, 3 }", "curve: key 2 must be {time, value}"},
        {"palette { }", "palette"},
        {"palette { {0, '#000'} }", "palette"},
        {"palette { {0, '#000'}, {1, 'red'} }", "palette: the colour of stop 2"},
        {"palette { blackbody = 3 }", "palette: 'blackbody' must be a range"},
        {"palette { {0, '#000'}, {1, '#fff'}, blackbody = {500, 3000} }", "palette: stops, 'keys'"},
        {"palette { blackbody = {500, 3000} }(curl { })", "palette: 'position' takes 1 component"},
        {"effect { fps = 0 }", "effect { } is called twice"},
        {"vdb { 'x.vdb', speed = 0 }", "vdb: 'speed' is 0; any other number is accepted"},
        {"vdb { 'x.vdb', fps = 0 }", "vdb: 'fps' is 0; any other number is accepted"},
        {"vdb { }", "vdb: its files come first"},
        {"vdb { '../*.vdb' }", ""},
        {"raw { 'x.raw' }", "raw: 'size' is missing"},
        {"raw { 'x.raw', size = {1, 2, 0} }", "raw: 'size' has 0"},
        {"raw { 'x.raw', size = 8, voxel_size = 1, box = { min = {0, 0, 0}, max = {1, 1, 1} } }",
         "raw: 'box' and 'voxel_size'"},
        {"raw { 'x.raw', size = 8, type = 'u32' }", "raw: unknown value of 'type' 'u32'"},
        {"mesh { }", "mesh: its file comes first"},
        {"mesh { '/etc/passwd' }", ""},
        {"bake(sphere { }, { size = 1e9 })", "bake: 'size' is 1e+09"},
        {"bake(perlin { })", "bake: the field has no finite bounds"},
        {"tile(sphere { })", "tile: there is no noise in it"},
        {"tile(perlin { } * sphere { })", "tile: 'sphere' does not repeat"},
        {"perlin { }:tile { resolution = 1000 }", "tile: 'resolution' is 1000; 4 to 512"},
        {"perlin { }:tile { octaves = 0 }", "tile: 'octaves' is 0; 1 to 12"},
    };
    CHECK(cases);
}

static void a_file_must_be_a_whole_effect(void **state) {
    (void)state;
    assert_null(helper_load(""));
    assert_non_null(strstr(err_get(), "no effect is declared"));
    assert_null(helper_load("effect { }"));
    assert_non_null(strstr(err_get(), "has no picture"));
    assert_null(helper_load("local fx = effect { } local img = geometry { }\n"
                            "pcall(march, { density = 1, depht = 2 }) fx.output = img"));
    assert_non_null(strstr(err_get(), "march failed, and the file went on"));
    assert_null(helper_load("effect { fps = 0 }"));
    assert_non_null(strstr(err_get(), "e.lua:1: fps is 0"));
}

static void endless_expressions_are_limited(void **state) {
    (void)state;
    assert_null(helper_load("local f = perlin { } while true do f = f + 1 end"));
    assert_non_null(strstr(err_get(), "nested deeper"));
    script_limits limits = {.memory = 8 << 20};
    assert_null(helper_load_with("while true do local f = perlin { } end", &limits, NULL, 0));
    assert_non_null(strstr(err_get(), "memory limit of 8 MiB exceeded"));
    assert_null(helper_load_with("for i = 1, 1e6 do param { 'p' .. i, 1 } end", &limits, NULL, 0));
    assert_non_null(strstr(err_get(), "memory limit of 8 MiB exceeded"));
    assert_null(helper_load_with("while true do geometry { } end", &limits, NULL, 0));
    assert_non_null(strstr(err_get(), "memory limit of 8 MiB exceeded"));
    assert_null(
        helper_load_with("while true do local c = curve { {0, 1}, {1, 2} } end", &limits, NULL, 0));
    assert_non_null(strstr(err_get(), "memory limit of 8 MiB exceeded"));
}

static void the_prelude_is_never_blamed(void **state) {
    (void)state;
    assert_null(helper_load("effect { }\nlocal x = smoothstep('a', 2, 3)"));
    assert_non_null(strstr(err_get(), "e.lua:2: smoothstep: 'low' must be"));
    assert_null(helper_load("effect { }\nlocal x = layers { {2, 1}, shift = { {} } }"));
    assert_non_null(strstr(err_get(), "e.lua:2: "));
}

static void a_module_of_the_library_is_not_blamed_alone(void **state) {
    (void)state;
    assert_null(
        helper_load("local fx = effect { }\nlocal spread = require 'spread'\n"
                    "local fire = spread { fx = fx, at = { {0, 0} } } fire.late_functions = 3 "
                    "fire:on_late(print)"));
    assert_non_null(strstr(err_get(), "e.lua:3: lib/spread.lua:"));
    assert_null(helper_load("local fx = effect { }\nlocal spread = require 'spread'\n"
                            "spread { fx = fx }"));
    assert_non_null(strstr(err_get(), "e.lua:3: spread: 'at' is missing"));
}

static void fails_to_build(const char *text, const char *message) {
    effect *e = helper_load(text);
    if (!e) fail_msg("%s", err_get());
    assert_false(effect_check(e));
    const char *got = strstr(err_get(), "e.lua:");
    if (!got || strncmp(got, message, strlen(message)) != 0)
        fail_msg("in: %s\n got: %s\n wanted: %s", text, err_get(), message);
    effect_destroy(e);
}

// What is found only when all is declared: by then no line runs any more.
static void passes_that_cannot_be_built_name_their_line(void **state) {
    (void)state;
    helper_put("bad.comp", "writeonly uniform image2D color; //= output rgba16f : a picture\n"
                           "void main() { imageStore(color, ivec2(0), vec4(tint)); }\n");
    helper_put("bad.glsl", "float dark(vec3 p) { return -1.0; }\n");
    fails_to_build("local fx = effect { }\n\nfx.output = shader { 'bad.comp' }", "e.lua:3: bad: ");
    fails_to_build("local fx = effect { }\nlocal lit =\n"
                   "  lighting { density = sphere { } * glsl { 'bad.glsl', 'light', 1 } }\n"
                   "fx.output = march { from = lit }",
                   "e.lua:3: lighting: ");
    // Of what stands for a value, and of a part of another pass: their own.
    fails_to_build("local fx = effect { }\nlocal box = { min = {0, 0, 0}, max = {1, 1, 1} }\n"
                   "local baked = glsl { 'bad.glsl', 'light', 1 }:bake {\n  box = box }\n"
                   "fx.output = march { density = baked }",
                   "e.lua:3: bake: ");
    fails_to_build("local fx = effect { }\n"
                   "local air = lbm { size = {16, 16, 16}, voxel_size = 0.1 }\n"
                   "air:source { shape = sphere { }, density = glsl { 'bad.glsl', 'light', 1 } }\n"
                   "fx.output = march { density = air.density }",
                   "e.lua:3: lbm_source: ");
}

// Grids hold nothing before the first frame, which is no end of what is made of them.
static void smoke_without_an_end_is_refused_where_it_is_said(void **state) {
    (void)state;
    helper_put("ones.raw", "11111111");
#define ENDLESS "raw { 'ones.raw', size = 2 }.density:warp(position)"
    static const mistake cases[] = {
        {"march { density = " ENDLESS " }", "march: field 'density' fills all of space"},
        {"march { mode = 'paper', density = " ENDLESS " }", "march: field 'density' fills"},
        {"lighting { density = " ENDLESS " }", "lighting: field 'density' fills"},
        {"stack { density = " ENDLESS " }", "stack: field 'density' fills"},
        {"reference { density = " ENDLESS " }", "reference: field 'density' fills"},
        {"local p = particles { count = 8, rate = 1 } splats { particles = p, density = " ENDLESS
         " }",
         "splats: field 'density' fills"},
        {"bake(" ENDLESS ")", "bake: "},
    };
    CHECK(cases);
#undef ENDLESS
}

// Whatever a script calls with whatever it likes: it may fail, with a message.
static void nothing_that_can_be_called_crashes(void **state) {
    (void)state;
    const char *text =
        "local fx = effect { name = 'test' }\n"
        "local wrong = { 'a', 1, true, print, {}, {1, 2}, {name = 1}, {[1] = node}, {{}}, fx,\n"
        "                sphere {}, setmetatable({}, {__index = 1}), math.huge, '' }\n"
        "local box = { size = {16, 16, 16}, voxel_size = 0.1 }\n"
        "local objects = { lbm(box), pyro(box), slices {}, particles { count = 8, rate = 1 },\n"
        "                  geometry {}, fx, sphere "
        "{},\n"
        "                  curve { {0, 1} }, param { 'p', 1 } }\n"
        "local methods = { 'source', 'collider', 'force', 'inflow', 'obstacle', 'templates', "
        "'slice',\n"
        "  'emit', 'burst', 'draw', 'tile', 'warp', 'remap', 'bake', 'advect', 'get', 'at', "
        "'bind',\n"
        "  'moved', 'turned', 'scaled', 'repeated', 'mirrored', 'spin', 'fps', 'snapshot', 'on' }\n"
        "local tried, failed = 0, 0\n"
        "local function try(call, ...)\n"
        "  tried = tried + 1\n"
        "  if not pcall(call, ...) then failed = failed + 1 end\n"
        "end\n"
        "local calls = {}\n"
        "for name, call in pairs(_G) do\n"
        "  if name ~= 'pcall' and name ~= 'xpcall' then calls[#calls + 1] = call end\n"
        "end\n"
        "for _, call in ipairs(calls) do\n"
        "  try(call)\n"
        "  for _, value in ipairs(wrong) do try(call, value) try(call, {}, value) try(call, value, "
        "value) end\n"
        "end\n"
        "for _, object in ipairs(objects) do\n"
        "  for _, method in ipairs(methods) do\n"
        "    for _, value in ipairs(wrong) do\n"
        "      try(function() object[method](object, value) end)\n"
        "      try(function() object[method](value, object) end)\n"
        "    end\n"
        "  end\n"
        "end\n"
        "error(('tried %d, failed %d'):format(tried, failed), 0)\n";
    assert_null(helper_load(text));
    int tried = 0, failed = 0;
    const char *said = strstr(err_get(), "tried ");
    if (!said || sscanf(said, "tried %d, failed %d", &tried, &failed) != 2)
        fail_msg("the script ended early: %s", err_get());
    print_message("tried %d calls, %d failed\n", tried, failed);
    assert_true(tried > 5000 && failed > 3000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misspelt_names_get_the_nearest_right_one),
        cmocka_unit_test(values_of_the_wrong_kind_are_named),
        cmocka_unit_test(declarations_are_checked),
        cmocka_unit_test(nothing_that_can_be_called_crashes),
        cmocka_unit_test(a_file_must_be_a_whole_effect),
        cmocka_unit_test(endless_expressions_are_limited),
        cmocka_unit_test(the_prelude_is_never_blamed),
        cmocka_unit_test(a_module_of_the_library_is_not_blamed_alone),
        cmocka_unit_test(passes_that_cannot_be_built_name_their_line),
        cmocka_unit_test(smoke_without_an_end_is_refused_where_it_is_said),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
