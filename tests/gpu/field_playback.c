// Playing back without waiting: another frame stands in for one that is late, and the right one
// comes on as soon as it can; what is broken is told; the counts are true.
#include "../unit/field_build.h"
#include "field_probe.h"

#include "base/clock.h"
#include "field/sequence_parts.h"
#include "media/vdb.h"
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { SIDE = 40, FRAMES = 12 };

static char folder[64];

static const char *file_of(int frame) {
    return arena_format(build_memory(), "%s/f%02d.vdb", folder, frame);
}

// Frame f: 1 + f in a slab, whose place and thickness change from frame to frame.
static void write_frame(int f) {
    static float density[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        int y = i / SIDE % SIDE, z = i / SIDE / SIDE;
        density[i] = z >= 8 && z < 12 + 2 * f && y > f ? 1 + (float)f : 0;
    }
    vdb_write_grid grid = {.name = "density",
                           .size = {SIDE, SIDE, SIDE},
                           .values = density,
                           .components = 1,
                           .voxel_size = 1};
    if (!vdb_write(file_of(f), &grid, 1)) exit(1);
}

typedef struct player {
    sequence *sequence;
    field_grid *grid;
    field *density;
} player;

static player open_player(sequence_desc desc, bool never_waits) {
    player p;
    int components;
    desc.pattern = arena_format(build_memory(), "%s/f*.vdb", folder);
    desc.fps = 10;
    p.sequence = sequence_create(build_memory(), &desc);
    gpu_test_ok(p.sequence);
    p.grid = sequence_grid(p.sequence);
    p.grid->never_waits = never_waits;
    assert_int_equal(sequence_channel(p.sequence, "density", &components), 0);
    p.density = field_grid_channel(build_memory(), p.grid, 0, 1);
    return p;
}

static float look(gpu *g, const player *p) {
    float point[1][4] = {{20, 30, 9}}, out[1][4];
    probe(g, p->density, &(field_context){0}, (const float(*)[4])point, 1, out);
    return out[0][0];
}

static void wait_a_little(void) {
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

// Until the frame that is wanted is on show; whichever stands in is a whole frame.
static void come_to(gpu *g, const player *p, int frame) {
    double end = clock_seconds() + 20;
    for (;;) {
        uint64_t late = p->grid->playback(p->grid)->late;
        gpu_test_ok(p->grid->update(p->grid, g, frame / 10.0));
        const field_playback *counts = p->grid->playback(p->grid);
        assert_int_equal(counts->late, late + counts->waiting);
        float shown = look(g, p);
        if (!counts->waiting) {
            assert_true(shown == 1 + (float)frame);
            return;
        }
        assert_true(shown >= 1 && shown <= FRAMES && shown == floorf(shown));
        if (clock_seconds() > end) fail_msg("frame %d does not come", frame);
        wait_a_little();
    }
}

static void late_frames_come_on(void **state) {
    static const int order[] = {0, 1, 2, 5, 11, 3, 4, 0, 10, 9, 8, 1};
    for (int sparse = 0; sparse < 2; sparse++) {
        sequence_desc desc = {.storage = sparse ? SEQUENCE_SPARSE : SEQUENCE_DENSE};
        player p = open_player(desc, true);
        for (size_t i = 0; i < COUNT_OF(order); i++) come_to(*state, &p, order[i]);
        const field_playback *counts = p.grid->playback(p.grid);
        assert_true(counts->shown >= COUNT_OF(order) - 1);
        assert_true(counts->uploaded >= 9 && counts->uploaded <= counts->decoded);
        assert_true(counts->uploaded_bytes > 0 && counts->threads > 0);
        assert_true(counts->largest_voxels > SIDE * SIDE && counts->device_bytes > 0);
        p.grid->destroy(p.grid, *state);
    }
}

static void a_player_that_waits_is_never_late(void **state) {
    player p = open_player((sequence_desc){.storage = SEQUENCE_SPARSE}, false);
    for (int i = 0; i < 40; i++) {
        int frame = i * 7 % FRAMES;
        gpu_test_ok(p.grid->update(p.grid, *state, frame / 10.0));
        assert_true(look(*state, &p) == 1 + (float)frame);
    }
    assert_int_equal(p.grid->playback(p.grid)->late, 0);
    assert_false(p.grid->playback(p.grid)->waiting);
    p.grid->destroy(p.grid, *state);
}

static size_t frames_kept(const player *p) {
    const sequence_cache *c = &p->sequence->data->cache;
    size_t count = 0;
    for (size_t i = 0; i < c->slot_count; i++) count += c->slots[i].used > 0;
    return count;
}

static void few_frames_are_kept_of_what_does_not_fit(void **state) {
    for (int never_waits = 0; never_waits < 2; never_waits++) {
        player p = open_player((sequence_desc){.storage = SEQUENCE_SPARSE}, never_waits);
        const field_playback *counts = p.grid->playback(p.grid);
        for (int i = 0; i < FRAMES; i++) come_to(*state, &p, i);
        assert_int_equal(frames_kept(&p), FRAMES);
        uint64_t all = counts->device_bytes, decoded = counts->decoded;
        for (int i = 0; i < FRAMES; i++) come_to(*state, &p, i);
        assert_int_equal(counts->decoded, decoded); // nothing anew
        p.sequence->data->cache.budget = 1;         // now it does not fit any more
        p.sequence->data->desc.loop = SEQUENCE_REPEAT;
        p.sequence->data->cache.slots[0].used = 0; // so that one frame is missing
        for (int i = 0; i < 3 * FRAMES; i++) come_to(*state, &p, i % FRAMES);
        assert_true(counts->decoded > decoded + FRAMES);
        assert_true(frames_kept(&p) <= 7);
        assert_true(counts->device_bytes < 2 * all); // textures for the largest, but few of them
        p.grid->destroy(p.grid, *state);
    }
}

static void frames_blend_when_both_are_there(void **state) {
    player p = open_player((sequence_desc){.blend = true}, true);
    double end = clock_seconds() + 20;
    do {
        gpu_test_ok(p.grid->update(p.grid, *state, 0.65));
        float shown = look(*state, &p);
        assert_true(shown >= 1 && shown <= FRAMES);
        wait_a_little();
    } while (p.grid->playback(p.grid)->waiting && clock_seconds() < end);
    assert_true(fabsf(look(*state, &p) - 7.5f) < 0.02f);
    p.grid->destroy(p.grid, *state);
}

static void broken_frames_are_told(void **state) {
    char kept[PATH_CAP];
    for (int never_waits = 0; never_waits < 2; never_waits++) {
        player p = open_player((sequence_desc){.storage = SEQUENCE_SPARSE}, never_waits);
        snprintf(kept, sizeof kept, "%s.kept", file_of(7));
        assert_int_equal(rename(file_of(7), kept), 0);
        gpu_test_ok(file_write(file_of(7), "no longer", 9));
        gpu_test_ok(p.grid->update(p.grid, *state, 0));
        double end = clock_seconds() + 20;
        bool fine = true;
        while (fine && clock_seconds() < end) {
            fine = p.grid->update(p.grid, *state, 0.7);
            wait_a_little();
        }
        assert_false(fine);
        assert_non_null(strstr(err_get(), "f07.vdb"));
        assert_int_equal(rename(kept, file_of(7)), 0);
        come_to(*state, &p, 8); // and on it goes
        come_to(*state, &p, 7);
        p.grid->destroy(p.grid, *state);
    }
}

static void it_can_end_at_any_time(void **state) {
    for (int i = 0; i < 12; i++) {
        player p = open_player((sequence_desc){.storage = SEQUENCE_SPARSE}, true);
        for (int k = 0; k < i; k++) gpu_test_ok(p.grid->update(p.grid, *state, k / 10.0));
        p.grid->destroy(p.grid, *state);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(late_frames_come_on),
        cmocka_unit_test(a_player_that_waits_is_never_late),
        cmocka_unit_test(few_frames_are_kept_of_what_does_not_fit),
        cmocka_unit_test(frames_blend_when_both_are_there),
        cmocka_unit_test(broken_frames_are_told),
        cmocka_unit_test(it_can_end_at_any_time),
    };
    strcpy(folder, "/tmp/roil-gpu-playback-XXXXXX");
    if (!mkdtemp(folder)) return 1;
    for (int f = 0; f < FRAMES; f++) write_frame(f);
    int failed = gpu_test_run(tests, COUNT_OF(tests));
    for (int f = 0; f < FRAMES; f++) unlink(file_of(f));
    rmdir(folder);
    arena_free(build_memory());
    return failed;
}
