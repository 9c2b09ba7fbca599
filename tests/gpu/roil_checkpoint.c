// Checkpoints through the public interface: a run that was restored is the one that never stopped.
#include "base/memory.h"
#include "roil_test.h"

enum { SIDE = 24 };

// A beam that is longer than the box: it moves along itself, so that no cell becomes another.
static const char BEAM[] = "v -3 -0.3 -0.2\nv 3 -0.3 -0.2\nv -3 0.3 -0.2\nv 3 0.3 -0.2\n"
                           "v -3 -0.3 0.2\nv 3 -0.3 0.2\nv -3 0.3 0.2\nv 3 0.3 0.2\n"
                           "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

// %s: edge of a cell, more keys, more of the file.
static const char AIR[] =
    "local fx = effect { name = 'air', fps = 60, frames = 100 }\n"
    "fx.camera = orbit { target = {0, 0, 1.2}, distance = 5 }\n"
    "local air = lbm { size = {16, 16, 24}, voxel_size = %s, speed = 2, buoyancy_heat = 6,\n"
    "                  collision = 'bgk', viscosity = 0.01, smagorinsky = 0, boundary = 'open', %s "
    "}\n"
    "air:source { shape = box { position = {0, 0, 0.5}, size = {0.6, 0.6, 0.4} }, density = 1,\n"
    "             temperature = perlin { frequency = 3, speed = 5 } * 2 }\n"
    "%s\n"
    "fx.output = final { march { density = air.density * 20, steps = 16 } }.color\n"
    "return fx\n";

// What moves besides the noise of the source.
static const char FORCE[] = "force = curl { frequency = 1, speed = 3 } * 4";
static const char STIRRED[] =
    "air:collider { mesh { 'beam.obj', position = curve { {0, {-0.5, 0, 1}}, {0.05, {-0.2, 0, 1}}, "
    "{0.2, {0.5, 0, 1}} } } }\n"
    "air:templates { image 'source.exr', size = {0.3, 0.8}, lifetime = {0.03, 0.1}, strength = 5,\n"
    "                within = 'density', above = 0.1, scale_by = 'density' }";

static const char STILL[] =
    "local fx = effect { name = 'still' }\n"
    "fx.output = final { march { density = sphere { radius = 1 }, steps = 4 } }.color\n"
    "return fx\n";

typedef uint8_t picture[SIDE * SIDE * 4];

static roil_effect *open(roil *r, const char *cell, const char *force, const char *collider) {
    char text[2048], path[512];
    snprintf(text, sizeof text, AIR, cell, force, collider);
    write_text("beam.obj", BEAM, path);
    copy_template("source.exr");
    roil_effect *e = load_text(r, "air.lua", text);
    ok(roil_prepare(e, SIDE, SIDE));
    return e;
}

static const char *in_folder(const char *name) {
    static char paths[4][512];
    static int turn;
    char *out = paths[turn++ % 4];
    snprintf(out, sizeof paths[0], "%s/%s", test_folder, name);
    return out;
}

static void draw(roil_effect *e, int first, int last, picture out) {
    for (int frame = first; frame <= last; frame++) ok(roil_render(e, frame));
    ok(roil_read(e, false, out));
}

static void assert_same_file(const char *a, const char *b) {
    void *data[2];
    size_t size[2];
    assert_true(file_read(in_folder(a), 1 << 28, &data[0], &size[0]));
    assert_true(file_read(in_folder(b), 1 << 28, &data[1], &size[1]));
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    mem_free(data[0]);
    mem_free(data[1]);
}

static void a_restored_run_is_the_one_that_never_stopped(void **state) {
    picture through, again;
    roil_effect *e = open(*state, "0.1", FORCE, STIRRED);
    draw(e, 1, 4, through);
    ok(roil_checkpoint(e, in_folder("middle")));
    draw(e, 5, 8, through);
    ok(roil_checkpoint(e, in_folder("end")));
    roil_unload(e);
    e = open(*state, "0.1", FORCE, STIRRED);
    double last = 0;
    ok(roil_restore(e, in_folder("middle"), &last));
    assert_float_equal(last, 4, 0);
    draw(e, 5, 8, again);
    ok(roil_checkpoint(e, in_folder("again")));
    assert_same_file("end", "again");
    assert_memory_equal(through, again, sizeof again);
    // Back in the same effect, and a frame left out: it is simulated all the same.
    ok(roil_restore(e, in_folder("middle"), NULL));
    draw(e, 8, 8, again);
    assert_memory_equal(through, again, sizeof again);
    roil_unload(e);
}

// Nothing is stepped for it, so that nothing but the restored state can be looked over and shown.
static void the_frame_of_a_checkpoint_is_shown_again(void **state) {
    picture first, fourth, again;
    roil_effect *e = open(*state, "0.1", FORCE, STIRRED);
    draw(e, 1, 1, first);
    draw(e, 2, 4, fourth);
    assert_memory_not_equal(first, fourth, sizeof first);
    ok(roil_checkpoint(e, in_folder("fourth")));
    roil_unload(e);
    e = open(*state, "0.1", FORCE, STIRRED);
    ok(roil_restore(e, in_folder("fourth"), NULL));
    draw(e, 4, 4, again);
    assert_memory_equal(fourth, again, sizeof again);
    roil_unload(e);
}

static void what_does_not_fit_is_refused(void **state) {
    picture first, second;
    roil_effect *e = open(*state, "0.1", FORCE, STIRRED);
    expect_error(roil_checkpoint(e, in_folder("a")), "nothing is simulated yet");
    draw(e, 1, 2, first);
    ok(roil_checkpoint(e, in_folder("a")));
    roil_effect *other = open(*state, "0.2", FORCE, STIRRED);
    expect_error(roil_restore(other, in_folder("a"), NULL),
                 "made with voxel_size = 0.1, the effect has voxel_size = 0.2");
    roil_unload(other);
    expect_error(roil_restore(e, in_folder("none"), NULL), "No such file");
    write_text("text", "something else, long enough", (char[512]){0});
    expect_error(roil_restore(e, in_folder("text"), NULL), "is no checkpoint");
    draw(e, 1, 2, second); // a refused file does no harm
    assert_memory_equal(first, second, sizeof first);
    roil_unload(e);
    e = load_text(*state, "still.lua", STILL);
    ok(roil_prepare(e, SIDE, SIDE));
    expect_error(roil_checkpoint(e, in_folder("b")), "nothing in it simulates");
    expect_error(roil_restore(e, in_folder("a"), NULL), "nothing in it simulates");
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_restored_run_is_the_one_that_never_stopped),
        cmocka_unit_test(the_frame_of_a_checkpoint_is_shown_again),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return test_run(tests);
}
