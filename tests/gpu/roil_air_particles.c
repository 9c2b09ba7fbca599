// Particles as sources of simulated air: where, when and what they give, by theory.
#include "roil_air_test.h"

// Air at rest, and what is given to it at one end; the mid plane is shown.
// %s: the type of air, its keys; the particles; keys of the source; what is shown.
static const char FLIGHT[] =
    "local fx = effect { name = 'flight', fps = 24, frames = 100 }\n"
    "local air = %s { size = {16, 16, 24}, voxel_size = 0.1, time_step = 1 / 96, speed = 2, %s }\n"
    "local dart = particles { %s }\n"
    "air:source { particles = dart, %s }\n"
    "local shown = shader { 'slice.comp', value = %s }\n"
    "fx.output = shown.color\n"
    "return fx\n";

// One that flies along a row of cells.
enum { ROW = HIGH - 13 };
static const double start = -0.65, step = 1.0 / 96, life = 0.5;
static const char DART[] = "count = 1, burst = 1, lifetime = 0.5, position = {-0.65, 0.05, 1.25}";

typedef struct medium {
    const char *type, *keys, *given, *shown; // with one %s: what is given, of 1
} medium;
enum { LBM, PYRO };
static const medium media[] = {
    {"lbm", "buoyancy_density = 0", "density = %s", "air.density"},
    {"pyro", "boundary = 'wall'", "soot = 0.001 * (%s)", "air.soot * 1000"},
};

static roil_effect *launch(roil *r, const char *type, const char *keys, const char *particles,
                           const char *source, const char *shown) {
    char text[2048], path[512];
    snprintf(text, sizeof text, FLIGHT, type, keys, particles, source, shown);
    write_text("slice.comp", SLICE, path);
    roil_effect *e = load_text(r, "flight.lua", text);
    ok(roil_prepare(e, WIDE, HIGH));
    return e;
}

static double linear(int shown) {
    double low = 0, high = 1;
    for (int i = 0; i < 30; i++) {
        double middle = (low + high) / 2;
        if (srgb_exact((float)middle) * 255 < (float)shown)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double middle_of(int x) {
    return -0.75 + 0.1 * x;
}

// How far from what theory says a trail is in the gas, at most. Its youth is what it gives: so a
// cell tells the time at which the particle left it, whatever the frames are. The last step of
// which the way passes within 0.867 cells has its middle up to half a step before or after. Soot
// stays where it is; smoke on a lattice does not.
static double error_of_trail(roil *r, double fast, int frame) {
    const double seconds = (frame - 1) / 24.0;
    char dart[256];
    picture p;
    double worst = 0;
    snprintf(dart, sizeof dart, "%s, speed = {%g, 0, 0}", DART, fast);
    roil_effect *e = launch(r, media[PYRO].type, media[PYRO].keys, dart,
                            "radius = 0.05, soot = 0.001 * (1 - particle_age)", media[PYRO].shown);
    draw(e, frame, p);
    for (int x = 0; x < WIDE; x++) {
        const double left = (middle_of(x) + 0.0867 - start) / fast;
        const double wanted = 1 - left / life, seen = linear(at(p, x, ROW));
        if (left < 0 || middle_of(x) - 0.0867 > start + fast * (seconds + step)) {
            if (seen > 0.05) fail_msg("%d has %g", x, seen);
        } else if (left > step && left < seconds) { // born in the first step, it gives in the next
            worst = fmax(worst, fabs(seen - wanted));
        }
    }
    for (int y = 0; y < HIGH; y++)
        if (y != ROW) assert_true(at(p, 8, y) < 20);
    print_message("at %g m/s what a trail holds is off by %.4f at most\n", fast, worst);
    roil_unload(e);
    return worst;
}

// Half a step is 0.0104. The faster goes 2.5 cells a step.
static void a_trail_tells_when_it_was_there(void **state) {
    assert_true(error_of_trail(*state, 3, 9) < 0.02);
    assert_true(error_of_trail(*state, 24, 3) < 0.03);
}

static void both_show(roil *r, const char *type, const char *keys, const char *one,
                      const char *other, const char *shown) {
    picture p[2];
    char dart[256];
    snprintf(dart, sizeof dart, "%s, speed = {3, 0, 0}", DART);
    for (int i = 0; i < 2; i++) {
        roil_effect *e = launch(r, type, keys, dart, i ? other : one, shown);
        draw(e, 7, p[i]);
        roil_unload(e);
    }
    assert_true(brightest(p[0]) > 188); // of 187 at rest
    is_same(p[0], p[1], 0);
}

// A share of their motion is the same as that velocity, as the air counts seconds.
static void they_give_their_motion(void **state) {
    for (size_t m = 0; m < COUNT_OF(media); m++) {
        both_show(*state, media[m].type, media[m].keys, "radius = 0.2, velocity_factor = 0.25",
                  "radius = 0.2, velocity = {0.75, 0, 0}", "0.5 + 0.5 * air.velocity.x");
        both_show(*state, media[m].type, "time_scale = 2", "radius = 0.2, velocity_factor = 0.5",
                  "radius = 0.2, velocity = {0.75, 0, 0}", "0.5 + 0.5 * air.velocity.x");
    }
}

// Two that stand beside each other, one frame apart in age: each cell is as the nearer one says,
// within the radius, and within the shape.
static void cells_take_from_the_nearest(void **state) {
    static const char PAIR[] =
        "count = 3, burst = 1, burst_period = 1 / 24, lifetime = 1, position = function(t) return "
        "{t < 0.03 and -0.35 or t < 0.07 and 0.35 or 9, 0.05, 1.25} end";
    for (size_t m = 0; m < COUNT_OF(media); m++) {
        char source[256] = "radius = 0.5, shape = step(0.9, position.z), ";
        const size_t used = strlen(source);
        snprintf(source + used, sizeof source - used, media[m].given, "0.2 + 8 * particle_age");
        roil_effect *e = launch(*state, media[m].type, media[m].keys, PAIR, source, media[m].shown);
        picture p;
        draw(e, 3, p);
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++) {
                const double z = 2.35 - 0.1 * y;
                const double away = hypot(fabs(middle_of(x)) - 0.35, z - 1.25);
                const double seen = linear(at(p, x, y)), wanted = 0.2 + 8 * (x < 8 ? 2 : 1) / 24.0;
                const bool given = away < 0.5 && z > 0.9;
                if (fabs(away - 0.5) < 0.005) continue;
                if (given ? fabs(seen - wanted) > 0.02 + 8 * step
                          : m == PYRO && seen > 0.01) // a lattice mixes
                    fail_msg("%s: %d, %d: %g, not %g", media[m].type, x, y, seen,
                             given ? wanted : 0);
            }
        roil_unload(e);
    }
}

// Frames that are left out, a run from its checkpoint, and particles that the air carries and that
// give to it.
static void which_frames_are_drawn_changes_nothing(void **state) {
    static const char *const carried[] = {"", ", velocity = air.velocity, drag = 2"};
    for (size_t m = 0; m < COUNT_OF(media); m++)
        for (size_t i = 0; i < COUNT_OF(carried); i++) {
            char particles[256], path[512], source[256] = "radius = 0.2, velocity_factor = 0.5, ";
            const size_t used = strlen(source);
            picture each, jump;
            snprintf(particles, sizeof particles, "%s, speed = {3, 0, 0}%s", DART, carried[i]);
            snprintf(source + used, sizeof source - used, media[m].given, "0.9");
            roil_effect *e =
                launch(*state, media[m].type, media[m].keys, particles, source, media[m].shown);
            for (int frame = 1; frame <= 9; frame++) draw(e, frame, each);
            draw(e, 3, jump);
            snprintf(path, sizeof path, "%s/third", test_folder);
            ok(roil_checkpoint(e, path));
            draw(e, 9, jump);
            assert_true(brightest(each) > 200);
            is_same(each, jump, 0);
            roil_unload(e);
            e = launch(*state, media[m].type, media[m].keys, particles, source, media[m].shown);
            ok(roil_restore(e, path, NULL));
            draw(e, 9, jump);
            is_same(each, jump, 0);
            roil_unload(e);
        }
}

// What carries them is slowed by drag as it is sped up by them: they end in it later than in air
// that they do not move.
static void what_is_carried_gives(void **state) {
    double sums[2];
    for (int i = 0; i < 2; i++) {
        char particles[256];
        picture p;
        snprintf(particles, sizeof particles,
                 "%s, speed = {3, 0, 0}, velocity = air.velocity, drag = 6", DART);
        roil_effect *e =
            launch(*state, "pyro", "boundary = 'open'", particles,
                   i ? "radius = 0.3, velocity_factor = 1, soot = 0.0003 * step(0.8, particle_age)"
                     : "radius = 0.3, soot = 0.0003 * step(0.8, particle_age)",
                   "air.soot * 1000");
        draw(e, 12, p);
        sums[i] = 0;
        double all = 0;
        for (int x = 0; x < WIDE; x++) {
            sums[i] += middle_of(x) * linear(at(p, x, ROW));
            all += linear(at(p, x, ROW));
        }
        assert_true(all > 0);
        sums[i] /= all;
        roil_unload(e);
    }
    print_message("they end at %.3f m, and by air that goes with them at %.3f m\n", sums[0],
                  sums[1]);
    assert_true(sums[1] > sums[0] + 0.3);
}

// Where they were before the first frame is not known.
static void they_give_nothing_while_air_warms_up(void **state) {
    picture first, later;
    roil_effect *e =
        launch(*state, media[PYRO].type, "boundary = 'wall', warm_up = 0.25",
               "count = 64, rate = 60, lifetime = 1, warm_up = 0.5, position = {0, 0, 1}",
               "radius = 0.2, soot = 0.0009", media[PYRO].shown);
    draw(e, 1, first);
    draw(e, 3, later);
    assert_true(brightest(first) == 0 && brightest(later) > 200);
    roil_unload(e);
}

static void what_is_wrong_is_said(void **state) {
    static const struct {
        const char *particles, *source, *message;
    } rows[] = {
        {"rate = 9", "radiu = 0.1, density = 1", "did you mean 'radius'?"},
        {"rate = 9", "particles = air.density, density = 1", "'particles' takes an image"},
        {"rate = 9", "", "it gives the air nothing"},
    };
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        char text[2048], path[512];
        snprintf(text, sizeof text, FLIGHT, "lbm", "", rows[i].particles, rows[i].source, "0");
        write_text("wrong.lua", text, path);
        expect_error(roil_load(*state, path, NULL, 0) != NULL, rows[i].message);
    }
    static const char *const sources[][2] = {
        {"radius = 0.1, shape = sphere { radius = 1 }, density = 1", "'radius' is of particles"},
        {"particles = seen, density = 1", "'particles' is missing: a pass particles { }"},
        {"density = 1", "it has no place; give it a mesh, shape = sphere { ... } or particles"},
    };
    for (size_t i = 0; i < COUNT_OF(sources); i++) {
        char text[2048], path[512];
        snprintf(text, sizeof text,
                 "local fx = effect { name = 'wrong' }\n"
                 "local air = lbm { size = {16, 16, 16}, voxel_size = 0.1 }\n"
                 "local seen = march { density = sphere { radius = 1 } }\n"
                 "air:source { %s }\n"
                 "fx.output = final { seen }.color\n"
                 "return fx\n",
                 sources[i][0]);
        write_text("wrong.lua", text, path);
        expect_error(roil_load(*state, path, NULL, 0) != NULL, sources[i][1]);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trail_tells_when_it_was_there),
        cmocka_unit_test(they_give_their_motion),
        cmocka_unit_test(cells_take_from_the_nearest),
        cmocka_unit_test(which_frames_are_drawn_changes_nothing),
        cmocka_unit_test(what_is_carried_gives),
        cmocka_unit_test(they_give_nothing_while_air_warms_up),
        cmocka_unit_test(what_is_wrong_is_said),
    };
    return test_run(tests);
}
