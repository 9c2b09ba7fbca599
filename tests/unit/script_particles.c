// particles { } in an effect file: what it takes, what can be set by name, and what is said after a
// mistake. Without a device.
#include "base/memory.h"
#include "script_helper.h"

#define HEAD "local fx = effect { name = 'sparks' }\n"
#define SPARKS "local sparks = particles { count = 64, rate = 10, "
#define TAIL "\nfx.output = sparks.particles\nreturn fx\n"

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static effect *load(const char *text, const effect_setting *settings, size_t count) {
    return helper_accepts(HEAD, text, TAIL, settings, count);
}

static const char TRIANGLE[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

static void mistakes_are_named(void **state) {
    (void)state;
    helper_put("triangle.obj", TRIANGLE);
    refused(SPARKS "mesh { 'triangle.obj' }, shape = mesh { 'triangle.obj' } }", "2 meshes; one");
    refused("local sparks = particles(3)", "particles takes named values");
    refused("local sparks = particles { count = 9 }", "neither 'rate' nor 'burst' is given");
    refused("local sparks = particles { count = 0, rate = 1 }", "'count' is 0; accepted: 1 to");
    refused("local sparks = particles { count = 2e7, rate = 1 }", "'count' is 20000000");
    refused(SPARKS "time_step = 0 }", "'time_step' is 0 s");
    refused(SPARKS "warm_up = -1 }", "'warm_up' is -1 s");
    refused(SPARKS "vellocity = 1 }", "unknown key 'vellocity'; did you mean 'velocity'?");
    refused(SPARKS "lifetimes = 1 }", "unknown key 'lifetimes'; did you mean 'lifetime'?");
    refused(SPARKS "lifetime = {1, 2, 3} }", "'lifetime' takes 1 component; this has 3");
    refused(SPARKS "lifetime = position.x }", "'lifetime' varies in space");
    refused(SPARKS "lifetime = -1 }", "'lifetime_min' is -1; accepted: 0 s or more");
    refused(SPARKS "above = position.x }", "'above' takes a field and a number");
    refused(SPARKS "above = {position.x, 1}, shape = sphere { } }", "beside 'shape'");
    refused(SPARKS "motion = 'fixed' }", "option 'motion' cannot be 'fixed'");
    refused(SPARKS "bounce = 2 }", "uniform 'bounce' is 2; accepted: 0 to 1");
    refused(SPARKS "from = 3 }", "'from' takes a pass");
    refused(SPARKS "}\nlocal b = shader { 'missing.comp', from = sparks }", "missing.comp");
}

static void all_of_it_can_be_set_by_name(void **state) {
    (void)state;
    const effect_setting settings[] = {
        {"particles.rate", "30", NULL},
        {"particles.lifetime_max", "7", NULL},
        {"particles.integrator", "euler", NULL},
    };
    effect *e = load(SPARKS "lifetime = {0.5, 2}, above = {sphere { }, 0.25}, drag = 3 }", settings,
                     COUNT_OF(settings));
    helper_is_set(e, "particles.rate", "30");
    helper_is_set(e, "particles.lifetime_min", "0.5");
    helper_is_set(e, "particles.lifetime_max", "7");
    helper_is_set(e, "particles.threshold", "0.25");
    helper_is_set(e, "particles.drag", "3");
    helper_is_set(e, "particles.integrator", "euler");
    if (!effect_check(e)) fail_msg("%s", err_get());
    effect_destroy(e);
}

// Every way to be born, to move and to meet something: the shader compiles with each.
static void all_of_it_compiles(void **state) {
    (void)state;
    helper_put("triangle.obj", TRIANGLE);
    static const char *const keys[] = {
        "position = {0, 0, 1}, radius = curve { {0, 0}, {1, 2} } }",
        "shape = sphere { }, velocity = vec(0, 0, 1) + 0.1 * position }",
        "velocity = {0, 0, 1}, integrator = 'euler', collide = position.z }",
        "gravity = 9.81, drag = 1, force = position, collide = position.z, quantity = position.x }",
        "speed = position, contact = 'die', collide = position.z, quantity_from = 'birth', "
        "quantity = 3 }",
        "count = 16777216, alive = 4 - position.z }",
        "mesh { 'triangle.obj' }, outward = 1 }",
        "shape = mesh { 'triangle.obj' }, mesh_factor = 1, quantity = 1, drag = 2 }",
        "mesh { 'triangle.obj' }, shape = sphere { } }",
    };
    for (size_t i = 0; i < COUNT_OF(keys); i++) {
        char text[512];
        snprintf(text, sizeof text, "local sparks = particles { rate = 1, %s", keys[i]);
        effect *e = load(text, NULL, 0);
        if (!effect_check(e)) fail_msg("in: %s\n got: %s", keys[i], err_get());
        effect_destroy(e);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(all_of_it_can_be_set_by_name),
        cmocka_unit_test(all_of_it_compiles),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
