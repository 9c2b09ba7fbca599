// Particles as time goes on: what is drawn, and how often, changes nothing; a reload, and a
// checkpoint, go on; who reads them sees them as of the frame.
#include "particles_test.h"
#include <stdlib.h>

static const field *height(effect *e) {
    return field_swizzle(effect_memory(e), make(e, "position", NULL), "z");
}

// A bit of everything, moving with time: a rate, wind, gravity, drag and a ground.
static swarm fountain_as(const effect_desc *desc, double fps, uint32_t count) {
    swarm s = swarm_open_as(desc, count, 0);
    effect *e = s.e;
    gpu_test_ok(effect_set_timeline(e, fps, 100000, 0));
    const field *time = field_time(effect_memory(e));
    gpu_test_ok(pass_set_uniform(
        s.pass, "rate", make(e, "add", number(e, 300), make(e, "mul", time, number(e, 400)))));
    swarm_live(&s, 0.3f, 0.9f);
    swarm_set(&s, "burst", 40);
    swarm_set(&s, "burst_period", 0.31f);
    swarm_set(&s, "radius", 0.1f);
    swarm_set(&s, "gravity", 10);
    swarm_set(&s, "drag", 0.5f);
    swarm_set(&s, "spread", 20);
    swarm_field(&s, "speed", triple(e, 1, 0, 4));
    swarm_field(&s, "velocity", make(e, "mul", time, triple(e, 3, 0, 0)));
    swarm_field(&s, "collide", height(e));
    swarm_field(&s, "quantity", height(e));
    return s;
}

static swarm fountain(gpu *device, double fps, uint32_t count) {
    return fountain_as(&(effect_desc){.device = device}, fps, count);
}

static void is_same(const swarm *a, const swarm *b) {
    assert_int_equal(a->used, b->used);
    assert_true(a->used > 100);
    assert_memory_equal(a->at, b->at, a->used * sizeof *a->at);
    assert_memory_equal(a->move, b->move, a->used * sizeof *a->move);
}

static void how_often_is_drawn_changes_no_byte(void **state) {
    swarm each = fountain(*state, 60, 700);
    swarm_build(&each);
    for (int frame = 0; frame <= 120; frame++) gpu_test_ok(effect_render(each.e, frame, false));
    swarm_run(&each, 120);
    static const double rates[] = {24, 60, 7}; // every frame, then the last one alone
    for (int i = 0; i < 3; i++) {
        swarm other = fountain(*state, rates[i], 700);
        swarm_build(&other);
        for (int frame = 0; i == 0 && frame <= 48; frame++)
            gpu_test_ok(effect_render(other.e, frame, false));
        swarm_run(&other, 2 * rates[i]);
        is_same(&each, &other);
        swarm_close(&other);
    }
    swarm_run(&each, 30); // back
    swarm_run(&each, 120);
    swarm anew = fountain(*state, 60, 700);
    swarm_build(&anew);
    swarm_run(&anew, 120);
    is_same(&each, &anew);
    swarm_close(&anew);
    swarm_close(&each);
}

// What a window keeps now and then, so that a jump back is a short way.
static void a_window_goes_back(void **state) {
    swarm window = fountain_as(&(effect_desc){.device = *state, .never_waits = true}, 60, 700);
    swarm anew = fountain(*state, 60, 700);
    swarm_build(&window);
    swarm_build(&anew);
    for (int frame = 0; frame <= 150; frame++) gpu_test_ok(effect_render(window.e, frame, false));
    effect_simulation now;
    do {
        swarm_run(&window, 100);
        assert_true(effect_get_simulation(window.e, &now));
    } while (now.waiting);
    swarm_run(&anew, 100);
    is_same(&window, &anew);
    swarm_close(&window);
    swarm_close(&anew);
}

static void another_seed_gives_others(void **state) {
    swarm a = fountain(*state, 60, 700), b = fountain(*state, 60, 700);
    swarm_set(&b, "seed", 5);
    swarm_build(&a);
    swarm_build(&b);
    swarm_run(&a, 20);
    swarm_run(&b, 20);
    assert_int_equal(a.used, b.used);
    for (uint32_t i = 0; i < a.used; i++) assert_true(a.at[i][0] != b.at[i][0]);
    swarm_close(&a);
    swarm_close(&b);
}

// Another number goes on with the old particles; another count begins anew.
static void a_reload_goes_on(void **state) {
    swarm whole = fountain(*state, 60, 300), old = fountain(*state, 60, 300);
    swarm_build(&whole);
    swarm_run(&whole, 60);
    swarm_build(&old);
    swarm_run(&old, 33);
    for (int i = 0; i < 2; i++) {
        swarm next = fountain(*state, 60, i ? 400 : 300);
        swarm_declare(&next);
        gpu_test_ok(effect_compile(next.e) && effect_adopt(next.e, old.e, 16, 16));
        swarm_close(&old);
        assert_int_equal(pass_particles_used(next.pass) > 0, i == 0);
        swarm_run(&next, 60);
        if (i == 0)
            is_same(&whole, &next);
        else
            assert_true(next.used == 400);
        old = next;
    }
    swarm_close(&old);
    swarm_close(&whole);
}

static void a_checkpoint_goes_on(void **state) {
    char path[] = "/tmp/roil-particles-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    swarm whole = fountain(*state, 60, 700), rest = fountain(*state, 60, 700);
    swarm_build(&whole);
    swarm_build(&rest);
    double frame;
    for (int i = 0; i < 2; i++) { // before the first birth, too
        swarm_run(&whole, i ? 25 : 0);
        gpu_test_ok(effect_save_state(whole.e, path));
        gpu_test_ok(effect_load_state(rest.e, path, &frame));
        assert_true(frame == (i ? 25 : 0));
    }
    swarm_run(&whole, 60);
    swarm_run(&rest, 60);
    is_same(&whole, &rest);
    swarm other = fountain(*state, 60, 800);
    swarm_build(&other);
    assert_false(effect_load_state(other.e, path, &frame));
    if (!strstr(err_get(), "count")) fail_msg("%s", err_get());
    remove(path);
    swarm_close(&other);
    swarm_close(&rest);
    swarm_close(&whole);
}

// A shader of the user's counts them and says where the middle is: between steps, too.
static void who_reads_them_sees_them_as_of_the_frame(void **state) {
    swarm s = swarm_open(*state, 500, 0.1);
    gpu_test_ok(effect_set_timeline(s.e, 40, 1000, 0));
    swarm_set(&s, "rate", 100);
    swarm_live(&s, 1, 1);
    swarm_field(&s, "velocity", triple(s.e, 0, 0, 2));
    swarm_field(&s, "quantity", height(s.e));
    gpu_test_ok(pass_declare(s.pass));
    pass *reader = add(s.e, NULL, "particles.comp");
    pass_add_source(reader, s.pass);
    finish(s.e, reader, 4, 4);
    for (int frame = 0; frame <= 90; frame += 9) {
        double time = frame / 40.0, alive = fmin(time, 1);
        gpu_test_ok(effect_render(s.e, frame, true));
        float *pixels = read_picture(s.e);
        is_near((double)pixels[0], 100 * alive, 1, "alive");
        if (frame) {
            is_near((double)pixels[1], alive, 0.02, "middle"); // 2 m/s for half as long
            is_near((double)pixels[2], alive / 2, 0.02, "mean age");
            is_near((double)pixels[3], alive, 0.21, "mean quantity"); // as of the end of the step
        }
        mem_free(pixels);
    }
    swarm_close(&s);
}

static void a_reader_without_particles_is_told(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    pass *reader = add(e, NULL, "particles.comp");
    assert_false(pass_declare(reader));
    if (!strstr(err_get(), "from = sparks")) fail_msg("%s", err_get());
    effect_destroy(e);
}

// A million at a time, and one step of them all.
static void a_million_fit(void **state) {
    swarm s = swarm_open(*state, 1 << 20, 0);
    swarm_set(&s, "burst", 1 << 20);
    swarm_live(&s, 10, 10);
    swarm_set(&s, "radius", 1);
    swarm_field(&s, "velocity", triple(s.e, 1, 0, 0));
    swarm_build(&s);
    swarm_run(&s, 2);
    assert_int_equal(s.used, 1 << 20);
    double sum = 0;
    for (uint32_t i = 0; i < s.used; i++) {
        assert_true(swarm_lives(&s, i));
        sum += (double)s.at[i][0];
    }
    is_near(sum / s.used, 2 / 60.0, 2e-3, "middle");
    swarm_close(&s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(how_often_is_drawn_changes_no_byte),
        cmocka_unit_test(a_window_goes_back),
        cmocka_unit_test(another_seed_gives_others),
        cmocka_unit_test(a_reload_goes_on),
        cmocka_unit_test(a_checkpoint_goes_on),
        cmocka_unit_test(who_reads_them_sees_them_as_of_the_frame),
        cmocka_unit_test(a_reader_without_particles_is_told),
        cmocka_unit_test(a_million_fit),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
