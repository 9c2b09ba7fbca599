// lbm { } in an effect file: what it gives, what can be set by name, and what is said after a
// mistake. Without a device.
#include "script_helper.h"

#define HEAD "local fx = effect { name = 'air' }\n"
#define AIR "local air = lbm { size = {16, 16, 24}, voxel_size = 0.1, "
#define TAIL "\nfx.output = march { density = air.density }.color\nreturn fx\n"

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static effect *load(const char *text, const effect_setting *settings, size_t count) {
    return helper_accepts(HEAD, text, TAIL, settings, count);
}

static void mistakes_are_named(void **state) {
    (void)state;
    refused("local air = lbm { voxel_size = 0.1 }", "lbm: 'size' is missing");
    refused("local air = lbm { size = {16, 16, 24} }", "lbm: 'voxel_size' is missing");
    refused("local air = lbm { size = {15, 16, 24}, voxel_size = 1 }", "x = 15; a multiple of 4");
    refused("local air = lbm { size = {16, 16, 20}, voxel_size = 1 }", "z = 20; a multiple of 8");
    refused("local air = lbm { size = {16, 2, 24}, voxel_size = 1 }", "'size' has 2");
    refused(AIR "viscosty = 1 }", "lbm: unknown key 'viscosty'; did you mean 'viscosity'?");
    refused(AIR "warmup = 1 }", "lbm: unknown key 'warmup'; did you mean 'warm_up'?");
    refused(AIR "viscosity = -1 }", "uniform 'viscosity' is -1; accepted: 0 m^2/s or more");
    refused(AIR "speed = 0 }", "'speed' is 0 m/s");
    refused(AIR "collision = 'trt2' }", "option 'collision' cannot be 'trt2'");
    refused(AIR "boundary = { tpo = 'open' } }",
            "boundary: unknown key 'tpo'; did you mean 'top'?");
    refused(AIR "boundary = { top = 'opne' } }",
            "lbm: unknown value of 'top' 'opne'; did you mean 'open'?");
    refused(AIR "boundary = 'opn' }",
            "lbm: unknown value of 'boundary' 'opn'; did you mean 'open'?");
    refused(AIR "boundary = { 'open', 'wall' } }", "boundary: a value has no name");
    refused("local air = lbm { size = {16, 16, 24}, voxel_size = 0 }", "'voxel_size' is 0 m");
    refused(AIR "position = {0, 0 / 0, 0} }", "'position' has ");
    refused(AIR "}\nair.density = 3", "air.density cannot be set");
    refused(AIR "}\nair:source { shape = sphere { } }", "lbm_source: it gives the air nothing");
    refused(AIR "}\nair:source { shape = sphere { }, velocity = -0.5 * air.velocity }",
            "lbm_source: 'velocity' reads the air that it is given to");
    refused(AIR "boundary = { top = 3 } }", "boundary: 'top' takes a word");
    refused(AIR "}\nlocal a = air.densty", "no field 'densty'; did you mean 'density'?");
    refused(AIR "}\nair:colider { }", "no method or field 'colider'; did you mean 'collider'?");
    refused(AIR "}\nlocal a = air.timestep", "did you mean 'time_step'?");
    refused(AIR "}\nair:source { densty = 1 }",
            "source: unknown key 'densty'; did you mean 'density'?");
    refused(AIR "}\nair:source { density = 1 }", "it has no place; give it a mesh, shape = sphere");
    refused(AIR "}\nair.source { density = 1 }", "mind the ':'");
    refused(AIR "}\nair:collider { }", "collider takes meshes");
    refused(AIR "}\nair:collider { rule = 'thin' }", "unknown value of 'rule' 'thin'");
    refused(AIR "}\nair:collider { ruel = 'solid' }", "unknown key 'ruel'; did you mean 'rule'?");
    refused(AIR "}\nair:collider { sphere { } }",
            "collider takes meshes and instances; got a field");
}

static void options_go_together(void **state) {
    (void)state;
    refused(AIR "boundary = { back = 'periodic' } }",
            "e.lua:2: lbm: 'boundary_back' is periodic and 'boundary_front' is not");
    refused(AIR "forcing = 'weights_only' }", "wants collision = \"bgk\"");
    const effect_setting both = {"lbm.boundary_back", "periodic", NULL};
    effect_destroy(load(AIR "boundary = { front = 'periodic' } }", &both, 1));
    effect_destroy(load(AIR "forcing = 'weights_only', collision = 'bgk' }", NULL, 0));
}

// What meshes do is said in the mesh, or together: not both.
static void motion_moves_meshes(void **state) {
    (void)state;
    refused(AIR "}\nair:collider { motion = curve { {0, {0, 0, 0}}, {1, {1, 0, 0}} } }",
            "collider takes meshes");
    refused(AIR "}\nair:source { shape = sphere { }, density = 1, motion = {1, 0, 0} }",
            "source: 'motion' moves meshes");
}

static void all_of_it_can_be_set_by_name(void **state) {
    (void)state;
    const effect_setting settings[] = {{"lbm.viscosity", "0.5", NULL},
                                       {"lbm.boundary_top", "wall", NULL},
                                       {"lbm_source.rate", "3", NULL},
                                       {"lbm.precision", "f32", NULL}};
    effect *e = load(AIR "boundary = 'slip', viscosity = 2 }\n"
                         "air:source { shape = sphere { }, density = 1, rate = 7 }",
                     settings, 4);
    if (!effect_check(e)) fail_msg("%s", err_get());
    helper_is_set(e, "lbm.viscosity", "0.5");
    helper_is_set(e, "lbm.boundary_top", "wall");
    helper_is_set(e, "lbm.boundary_left", "slip");
    helper_is_set(e, "lbm_source.rate", "3");
    helper_is_set(e, "lbm.precision", "f32");
    effect_destroy(e);
}

static void faces_can_be_said_together(void **state) {
    (void)state;
    effect *e = load(AIR "boundary = { sides = 'inflow', top = 'slip', back = 'wall' } }", NULL, 0);
    helper_is_set(e, "lbm.boundary_left", "inflow");
    helper_is_set(e, "lbm.boundary_front", "inflow");
    helper_is_set(e, "lbm.boundary_back", "wall");
    helper_is_set(e, "lbm.boundary_top", "slip");
    helper_is_set(e, "lbm.boundary_bottom", "wall");
    effect_destroy(e);
}

// No device binds buffers of half of it.
static void a_lattice_that_is_too_large_names_its_line(void **state) {
    (void)state;
    effect *e = load("local air = lbm { size = {1024, 1024, 1024}, voxel_size = 1,\n"
                     "  velocity_set = 'd3q27', scalar_set = 'd3q27', precision = 'f32' }",
                     NULL, 0);
    assert_false(effect_check(e));
    if (!strstr(err_get(), "e.lua:2: lbm: a lattice of 1024 x 1024 x 1024 cells"))
        fail_msg("%s", err_get());
    effect_destroy(e);
}

static void a_script_knows_its_box_and_step(void **state) {
    (void)state;
    effect *e =
        load(AIR "position = {1, 2, 3}, speed = 5 }\n"
                 "assert(math.abs(air.time_step - 0.002) < 1e-9)\n"
                 "local b = air.box\n"
                 "assert(math.abs(b.min[1] - 0.2) < 1e-6 and math.abs(b.max[3] - 5.4) < 1e-6)\n"
                 "local dark = air.dye + air.temperature * length(air.velocity) + air.pressure",
             NULL, 0);
    effect_destroy(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(options_go_together),
        cmocka_unit_test(motion_moves_meshes),
        cmocka_unit_test(all_of_it_can_be_set_by_name),
        cmocka_unit_test(faces_can_be_said_together),
        cmocka_unit_test(a_lattice_that_is_too_large_names_its_line),
        cmocka_unit_test(a_script_knows_its_box_and_step),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
