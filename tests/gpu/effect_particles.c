// How particles move: carried, thrown, slowed, and what they do where they meet something.
#include "particles_test.h"

static const float PI = 3.14159265f;

// ---- carried ----------------------------------------------------------------------------------

// Once round in a second: velocity = 2 pi (-y, x, 0).
static const field *vortex(effect *e) {
    const field *here = make(e, "position", NULL);
    const field *x = field_swizzle(effect_memory(e), here, "x");
    const field *y = field_swizzle(effect_memory(e), here, "y");
    return make(e, "vec", make(e, "mul", y, number(e, -2 * PI)),
                make(e, "mul", x, number(e, 2 * PI)), number(e, 0));
}

// How far a particle is from where it was, in radii, after a turn.
static double turn_error(gpu *device, const char *integrator, double step) {
    swarm s = swarm_open(device, 64, step);
    swarm_set(&s, "burst", 64);
    swarm_live(&s, 100, 100);
    swarm_set3(&s, "position", 2, 0, 0);
    swarm_set(&s, "radius", 1);
    swarm_field(&s, "velocity", vortex(s.e));
    gpu_test_ok(pass_set_option(s.pass, "integrator", integrator));
    swarm_build(&s);
    double worst = 0;
    float begin[64][2];
    for (int turn = 0; turn < 2; turn++) {
        swarm_run(&s, (turn + 0.25) * RATE_OF_FRAMES);
        assert_int_equal(s.used, 64);
        for (int i = 0; i < 64; i++) {
            const float *p = s.at[i];
            if (turn == 0) {
                memcpy(begin[i], p, sizeof begin[i]);
                continue;
            }
            float x = p[0] - begin[i][0], y = p[1] - begin[i][1];
            worst = fmax(worst, (double)(hypotf(x, y) / hypotf(begin[i][0], begin[i][1])));
            assert_true(fabsf(p[2]) <= 1);
        }
    }
    swarm_close(&s);
    return worst;
}

static void a_way_round_a_vortex_closes(void **state) {
    double euler = turn_error(*state, "euler", 1.0 / 60), rk2 = turn_error(*state, "rk2", 1.0 / 60);
    double half = turn_error(*state, "rk2", 1.0 / 120);
    printf("a turn in 60 steps: Euler is %.3g radii off, RK2 %.3g, in 120 steps %.3g\n", euler, rk2,
           half);
    is_near(euler, 0.389, 0.02, "Euler"); // (1 + (2 pi / 60)^2)^30 - 1
    assert_true(rk2 < 0.0125);            // (2 pi)^3 / 6 / 60^2 = 0.0115, of phase
    assert_true(half < rk2 / 3.5 && half > rk2 / 4.5);
}

// What a field says of a particle is that particle's own, as long as it lives.
static void a_field_may_be_of_the_particle(void **state) {
    swarm s = swarm_open(*state, 300, 0);
    float first[300];
    swarm_set(&s, "burst", 300);
    swarm_live(&s, 4, 4);
    const field *own = make(s.e, "particle_random", NULL), *age = make(s.e, "particle_age", NULL);
    swarm_field(&s, "velocity", make(s.e, "vec", own, make(s.e, "mul", age, number(s.e, 8)), own));
    swarm_build(&s);
    double sum = 0;
    swarm_run(&s, 30);
    for (uint32_t i = 0; i < s.used; i++) {
        first[i] = s.at[i][0] * 2; // after half a second
        assert_true(first[i] >= 0 && first[i] < 1);
        sum += (double)first[i];
    }
    is_near(sum / 300, 0.5, 0.06, "mean");
    swarm_run(&s, 120);
    for (uint32_t i = 0; i < s.used; i++) {
        is_near((double)s.at[i][0], 2 * (double)first[i], 1e-3, "a way of its own");
        is_near((double)s.at[i][1], 4, 1e-3, "by age"); // the integral of 8 t / 4 up to 2
    }
    swarm_close(&s);
}

// ---- thrown -----------------------------------------------------------------------------------

// One particle from (0, 0, height), for ever.
static swarm one(gpu *device, float height, double step) {
    swarm s = swarm_open(device, 1, step);
    swarm_set(&s, "burst", 1);
    swarm_live(&s, 1e6f, 1e6f);
    swarm_set3(&s, "position", 0, 0, height);
    return s;
}

static void what_is_thrown_flies_a_parabola(void **state) {
    swarm s = one(*state, 5, 0);
    swarm_set(&s, "gravity", 10);
    swarm_field(&s, "speed", triple(s.e, 3, 0, 4));
    swarm_field(&s, "force", triple(s.e, 0, 2, 0));
    swarm_build(&s);
    swarm_run(&s, 60);
    is_near((double)s.at[0][0], 3, 1e-4, "x");
    is_near((double)s.at[0][1], 1, 1e-4, "y");
    is_near((double)s.at[0][2], 4, 1e-4, "z"); // 5 + 4 - 5
    is_near((double)s.move[0][2], -6, 1e-4, "speed");
    is_near((double)s.at[0][3], 1, 1e-5, "age");
    swarm_close(&s);
}

// Where a step is as long as the time that drag takes, too.
static void drag_leads_to_the_terminal_velocity(void **state) {
    for (int i = 0; i < 2; i++) {
        swarm s = one(*state, 0, i ? 0.25 : 0);
        swarm_set(&s, "gravity", 10);
        swarm_set(&s, "drag", 4);
        swarm_field(&s, "velocity", triple(s.e, 3, 0, 0));
        swarm_build(&s);
        swarm_run(&s, 30);
        double left = exp(-2.0); // after half a second
        is_near((double)s.move[0][2], -2.5 * (1 - left), 1e-4, "speed on the way");
        is_near((double)s.at[0][2], -2.5 * (0.5 - (1 - left) / 4), 1e-4, "depth on the way");
        swarm_run(&s, 600);
        is_near((double)s.move[0][2], -2.5, 1e-4, "terminal velocity");
        is_near((double)s.move[0][0], 3, 1e-4, "wind");
        swarm_close(&s);
    }
    // By the square of the speed against the wind, not against the ground.
    swarm s = one(*state, 0, 0);
    swarm_set(&s, "gravity", 9);
    swarm_set(&s, "drag_square", 1);
    swarm_field(&s, "velocity", triple(s.e, 4, 0, 0));
    swarm_build(&s);
    swarm_run(&s, 300);
    is_near((double)s.move[0][2], -3, 1e-3, "terminal velocity by the square");
    is_near((double)s.move[0][0], 4, 1e-3, "wind");
    swarm_close(&s);
}

// ---- contact ----------------------------------------------------------------------------------

static const field *height(effect *e) {
    return field_swizzle(effect_memory(e), make(e, "position", NULL), "z");
}

static double energy(const swarm *s, double g) {
    const float *v = s->move[0];
    return g * (double)s->at[0][2] + 0.5 * (double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// Falls 1 m in 0.447 s: after each touch a share bounce^2 of the energy is left. Four of them.
static void a_bounce_leaves_the_energy_that_it_says(void **state) {
    static const float shares[] = {1, 0.8f};
    for (int i = 0; i < 2; i++) {
        swarm s = one(*state, 1, 0);
        swarm_set(&s, "gravity", 10);
        swarm_set(&s, "bounce", shares[i]);
        swarm_field(&s, "collide", height(s.e));
        swarm_build(&s);
        double wanted = 10, last = -1;
        int touches = 0;
        for (int frame = 0; frame <= (i ? 150 : 240); frame += 2) {
            swarm_run(&s, frame);
            if (!s.used) continue;
            assert_true(s.at[0][2] > -1e-4f);
            double speed = (double)s.move[0][2];
            if (speed > 0 && last < 0 && frame > 2) {
                touches++;
                wanted *= (double)(shares[i] * shares[i]);
            }
            last = speed;
            is_near(energy(&s, 10), wanted, 0.01 * wanted, "energy");
        }
        printf("bounce %.1f: %d touches, energy %.4f J/kg, %.4f wanted\n", (double)shares[i],
               touches, energy(&s, 10), wanted);
        assert_int_equal(touches, 4);
        swarm_close(&s);
    }
}

static void friction_takes_speed_along_the_surface(void **state) {
    swarm s = one(*state, 1, 0);
    swarm_field(&s, "speed", triple(s.e, 3, 0, -4));
    swarm_field(&s, "collide", height(s.e));
    swarm_set(&s, "bounce", 0.5f);
    swarm_set(&s, "friction", 0.25f);
    swarm_set(&s, "clearance", 0.1f);
    swarm_build(&s);
    swarm_run(&s, 60); // at 0.1 m after 0.225 s
    is_near((double)s.move[0][2], 2, 1e-4, "upwards");
    is_near((double)s.move[0][0], 3 - 0.25 * 1.5 * 4, 1e-3, "along");
    is_near((double)s.at[0][2], 0.1 + 2 * 0.775, 1e-3, "height");
    swarm_close(&s);
}

static void what_comes_to_rest_stays(void **state) {
    swarm s = one(*state, 0.5f, 0);
    swarm_set(&s, "gravity", 10);
    swarm_set(&s, "bounce", 0.3f);
    swarm_field(&s, "collide", height(s.e));
    swarm_build(&s);
    swarm_run(&s, 300);
    is_near((double)s.at[0][2], 0, 1e-3, "height");
    is_near((double)s.move[0][2], 0, 0.05, "speed");
    swarm_close(&s);
}

// 0.2 m in a step, and a wall of 2 cm at x = 1.03.
static void a_thin_wall_is_not_stepped_over(void **state) {
    swarm s = one(*state, 0, 0);
    const field *x = field_swizzle(effect_memory(s.e), make(s.e, "position", NULL), "x");
    const field *from = make(s.e, "abs", make(s.e, "sub", x, number(s.e, 1.03f)));
    swarm_field(&s, "collide", make(s.e, "sub", from, number(s.e, 0.01f)));
    swarm_field(&s, "speed", triple(s.e, 12, 0, 0));
    swarm_set(&s, "bounce", 1);
    swarm_build(&s);
    swarm_run(&s, 8);
    is_near((double)s.move[0][0], -12, 1e-3, "speed");
    is_near((double)s.at[0][0], 1.02 - (1.6 - 1.02), 1e-3, "place");
    swarm_close(&s);
}

static void a_wall_that_moves_pushes(void **state) {
    swarm s = one(*state, 1, 0);
    swarm_field(&s, "collide", height(s.e));
    swarm_field(&s, "collide_velocity", triple(s.e, 0, 0, 3));
    swarm_field(&s, "speed", triple(s.e, 0, 0, -4));
    swarm_set(&s, "bounce", 0.5f);
    swarm_build(&s);
    swarm_run(&s, 30);
    is_near((double)s.move[0][2], 3 + 0.5 * 7, 1e-3, "speed");
    swarm_close(&s);
}

static void contact_may_be_the_end(void **state) {
    for (int carried = 0; carried < 2; carried++) {
        swarm s = one(*state, 1, 0);
        swarm_field(&s, "collide", height(s.e));
        swarm_field(&s, carried ? "velocity" : "speed", triple(s.e, 0, 0, -4));
        gpu_test_ok(pass_set_option(s.pass, "contact", "die"));
        swarm_build(&s);
        swarm_run(&s, 14);
        assert_true(swarm_lives(&s, 0));
        swarm_run(&s, 16);
        assert_false(swarm_lives(&s, 0));
        swarm_close(&s);
    }
}

// Air that blows into a ball carries them along it.
static void what_is_carried_slides_along(void **state) {
    swarm s = swarm_open(*state, 256, 0);
    swarm_set(&s, "burst", 256);
    swarm_live(&s, 100, 100);
    swarm_set3(&s, "position", 0, 0, 2);
    swarm_set(&s, "radius", 0.5f);
    swarm_field(&s, "velocity", triple(s.e, 0, 0, -2));
    const field *away = make(s.e, "length", make(s.e, "position", NULL));
    swarm_field(&s, "collide", make(s.e, "sub", away, number(s.e, 1)));
    swarm_build(&s);
    for (int frame = 30; frame <= 150; frame += 30) {
        swarm_run(&s, frame);
        for (uint32_t i = 0; i < s.used; i++) {
            const float *p = s.at[i];
            double far = sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
            if (far < 0.995) fail_msg("%u is %g m within", i, 1 - far);
        }
    }
    int below = 0;
    for (uint32_t i = 0; i < s.used; i++) below += s.at[i][2] < -0.5f;
    assert_true(below > 230); // the others stay near the top for long
    swarm_close(&s);
}

// A ground that only the picture knows of, with its normals and without.
static void they_bounce_off_what_the_picture_shows(void **state) {
    for (int normals = 0; normals < 2; normals++) {
        swarm s = one(*state, 0, 0);
        pass *solid = add(s.e, "geometry", NULL);
        scene_mesh *mesh = effect_add_mesh(s.e, "crate.obj"); // 2 m wide
        gpu_test_ok(mesh && pass_add_mesh(solid, mesh));
        gpu_test_ok(pass_declare(solid));
        effect_scene(s.e)->camera.eye = triple(s.e, 0, -6, 4);
        gpu_test_ok(pass_set_image(s.pass, "depth", pass_output(solid, "depth")));
        if (normals) gpu_test_ok(pass_set_image(s.pass, "normal", pass_output(solid, "normal")));
        swarm_set3(&s, "position", 0.3f, -0.2f, 2);
        swarm_set(&s, "gravity", 10);
        swarm_set(&s, "bounce", 1);
        swarm_declare(&s);
        gpu_test_ok(effect_build(s.e, 256, 256));
        swarm_run(&s, 20);
        double before = energy(&s, 10);
        swarm_run(&s, 40); // it is above the crate again
        assert_true(s.move[0][2] > 0 && s.at[0][2] > 1);
        is_near(energy(&s, 10), before, 0.02 * before, "energy");
        is_near((double)s.at[0][0], 0.3, 0.03, "x");
        swarm_close(&s);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_way_round_a_vortex_closes),
        cmocka_unit_test(a_field_may_be_of_the_particle),
        cmocka_unit_test(what_is_thrown_flies_a_parabola),
        cmocka_unit_test(drag_leads_to_the_terminal_velocity),
        cmocka_unit_test(a_bounce_leaves_the_energy_that_it_says),
        cmocka_unit_test(friction_takes_speed_along_the_surface),
        cmocka_unit_test(what_comes_to_rest_stays),
        cmocka_unit_test(a_thin_wall_is_not_stepped_over),
        cmocka_unit_test(a_wall_that_moves_pushes),
        cmocka_unit_test(contact_may_be_the_end),
        cmocka_unit_test(what_is_carried_slides_along),
        cmocka_unit_test(they_bounce_off_what_the_picture_shows),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
