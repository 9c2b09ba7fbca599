// Sequences without a device: files, boxes, channels, frames by time, and what decoding makes.
#include "field_build.h"

#include "base/file.h"
#include "field/sequence_parts.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static const char *in_folder(const char *name) {
    return arena_format(build_memory(), "%s/%s", folder, name);
}

enum { SIDE = 4 };

// A block of SIDE^3 voxels of 0.5 m whose lowest voxel has index `at` on every axis; voxel i holds
// base + i.
static void write_block(const char *file, const char *grid, int at, float base) {
    float values[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) values[i] = base + (float)i;
    float origin = 0.5f * (float)at;
    vdb_write_grid desc = {.name = grid,
                           .size = {SIDE, SIDE, SIDE},
                           .values = values,
                           .components = 1,
                           .voxel_size = 0.5f,
                           .origin = {origin, origin, origin},
                           .grid_class = VDB_FOG};
    if (!vdb_write(in_folder(file), &desc, 1)) fail_msg("%s", err_get());
}

static sequence *opened[128]; // destroyed after the tests
static size_t opened_count;

static sequence *open_or_fail(sequence_desc desc) {
    desc.pattern = in_folder(desc.pattern);
    sequence *s = sequence_create(build_memory(), &desc);
    if (!s) fail_msg("%s", err_get());
    assert_true(opened_count < COUNT_OF(opened));
    opened[opened_count++] = s;
    return s;
}

static void refuses(sequence_desc desc, const char *part) {
    desc.pattern = in_folder(desc.pattern);
    err_clear();
    assert_null(sequence_create(build_memory(), &desc));
    assert_error(part);
}

static void a_file_lies_in_the_root(void **state) {
    (void)state;
    write_block("outside.vdb", "density", 0, 0);
    const char *root = in_folder("root"), *link = in_folder("root/in1.vdb");
    assert_int_equal(mkdir(root, 0700), 0);
    assert_int_equal(symlink("../outside.vdb", link), 0);
    refuses((sequence_desc){.pattern = "root/in1.vdb", .root = root}, "leads out");
    refuses((sequence_desc){.pattern = "root/in*.vdb", .root = root}, "leads out");
    refuses((sequence_desc){.pattern = "outside.vdb", .root = root}, "leads out");
    refuses((sequence_desc){.pattern = "root/in1.vdb",
                            .raw = {.type = "u8", .size = {1, 1, 1}},
                            .root = root},
            "leads out");
    assert_int_equal(unlink(link), 0);
    assert_int_equal(rmdir(root), 0);
}

static float texel(const sequence *s, const sequence_texels *t, int x, int y, int z, int channel) {
    int count = sequence_image_channels(s->data, channel / 4), width = count == 3 ? 4 : count;
    size_t at = ((size_t)z * s->grid.size[1] + (size_t)y) * s->grid.size[0] + (size_t)x;
    return half_to_float(t->images[channel / 4][at * (size_t)width + (size_t)(channel % 4)]);
}

static void one_box_encloses_all_frames(void **state) {
    (void)state;
    write_block("a1.vdb", "density", 0, 1);
    write_block("a2.vdb", "density", 3, 100);
    sequence *s = open_or_fail((sequence_desc){.pattern = "a*.vdb"});
    assert_int_equal(sequence_frame_count(s), 2);
    // Voxels 0..6, borders half a voxel outside, and a voxel of nothing around.
    const field_grid *grid = sequence_grid(s);
    for (int i = 0; i < 3; i++) assert_int_equal(grid->size[i], 9);
    assert_true(fabsf(grid->box.min.x + 0.75f) < 1e-6f);
    assert_true(fabsf(grid->box.max.z - 3.75f) < 1e-6f);
    assert_true(fabs(sequence_duration(s) - 2.0 / 24) < 1e-9);
    const char *const *files;
    assert_int_equal(sequence_files(s, &files), 2);
    assert_string_equal(path_name(files[1]), "a2.vdb");
}

static void voxels_on_the_lattice_are_copied_exactly(void **state) {
    (void)state;
    sequence *s = open_or_fail((sequence_desc){.pattern = "a*.vdb"});
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    assert_int_equal(components, 1);
    for (uint32_t frame = 0; frame < 2; frame++) {
        sequence_texels t;
        assert_true(sequence_decode(s->data, frame, &t));
        int at = frame == 0 ? 1 : 4;
        float base = frame == 0 ? 1 : 100;
        for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
            int x = i % SIDE, y = i / SIDE % SIDE, z = i / SIDE / SIDE;
            float got = texel(s, &t, at + x, at + y, at + z, 0);
            assert_true(got == half_to_float(half_from_float(base + (float)i)));
        }
        assert_true(texel(s, &t, 0, 0, 0, 0) == 0);
        // From half a voxel before the first border to half a voxel after the last.
        float low = frame == 0 ? -0.5f : 1;
        assert_true(fabsf(t.active.min.x - low) < 1e-5f);
        assert_true(fabsf(t.active.max.y - (low + 2.5f)) < 1e-5f);
        sequence_texels_free(&t);
    }
}

static void a_frame_without_the_grid_is_empty(void **state) {
    (void)state;
    write_block("m1.vdb", "density", 0, 1);
    write_block("m2.vdb", "flame", 0, 1);
    sequence *s = open_or_fail((sequence_desc){.pattern = "m*.vdb"});
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 1, &t));
    assert_true(box3_is_empty(t.active));
    assert_true(texel(s, &t, 2, 2, 2, 0) == 0);
    sequence_texels_free(&t);
}

static void channels_are_found_by_alias(void **state) {
    (void)state;
    write_block("alias.vdb", "smoke", 0, 1);
    sequence *s = open_or_fail((sequence_desc){.pattern = "alias.vdb"});
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    assert_int_equal(sequence_channel(s, "density", &components), 0); // the same again
    assert_int_equal(sequence_channel(s, "smoke", &components), 1);
    assert_int_equal(sequence_channel(s, "heat", &components), -1);
    assert_error("'heat'");
    assert_error("smoke");
}

static void three_scalar_grids_make_a_vector(void **state) {
    (void)state;
    float values[3][8];
    vdb_write_grid grids[3];
    static const char *const names[] = {"vel.x", "vel.y", "vel.z"};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 8; k++) values[i][k] = (float)(10 * (i + 1) + k);
        grids[i] = (vdb_write_grid){.name = names[i],
                                    .size = {2, 2, 2},
                                    .values = values[i],
                                    .components = 1,
                                    .voxel_size = 1};
    }
    assert_true(vdb_write(in_folder("split.vdb"), grids, 3));
    sequence *s = open_or_fail((sequence_desc){.pattern = "split.vdb", .y_up = true, .scale = 2});
    int components;
    assert_int_equal(sequence_channel(s, "velocity", &components), 0);
    assert_int_equal(components, 3);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    // The file's voxel (1, 0, 0) is value 1; Y up turned to Z up: y = -z, z = y; metres a second.
    assert_true(texel(s, &t, 2, 2, 1, 0) == 2 * 11);
    assert_true(texel(s, &t, 2, 2, 1, 1) == 2 * -31);
    assert_true(texel(s, &t, 2, 2, 1, 2) == 2 * 21);
    sequence_texels_free(&t);
}

static void y_up_turns_box_and_voxels(void **state) {
    (void)state;
    float values[2 * 3 * 4];
    for (int i = 0; i < 24; i++) values[i] = (float)(i + 1);
    vdb_write_grid grid = {.name = "density",
                           .size = {2, 3, 4},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1,
                           .origin = {10, 20, 30}};
    assert_true(vdb_write(in_folder("up.vdb"), &grid, 1));
    sequence *s = open_or_fail(
        (sequence_desc){.pattern = "up.vdb", .y_up = true, .scale = 0.5f, .offset = {1, 2, 3}});
    int components;
    sequence_channel(s, "density", &components);
    const field_grid *g = sequence_grid(s);
    assert_int_equal(g->size[0], 4);
    assert_int_equal(g->size[1], 6);
    assert_int_equal(g->size[2], 5);
    assert_true(fabsf(g->box.min.x - (8.5f * 0.5f + 1)) < 1e-5f);
    assert_true(fabsf(g->box.min.y - (-34.5f * 0.5f + 2)) < 1e-5f);
    assert_true(fabsf(g->box.max.z - (23.5f * 0.5f + 3)) < 1e-5f);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    for (int i = 0; i < 24; i++) {
        int x = i % 2, y = i / 2 % 3, z = i / 6;
        assert_true(texel(s, &t, 1 + x, 4 - z, 1 + y, 0) == (float)(i + 1));
    }
    sequence_texels_free(&t);
}

// Whether voxel (0, 1, 0) of the file comes to lie above voxel (0, 0, 0).
static bool is_turned(const char *creator, bool said, bool y_up) {
    const vdb_entry entries[] = {{.key = "creator", .text = creator}};
    const float values[] = {1, 2};
    const vdb_write_grid grid = {
        .name = "density", .size = {1, 2, 1}, .values = values, .components = 1, .voxel_size = 1};
    assert_true(vdb_write_with(in_folder("by.vdb"), &grid, 1, entries, 1));
    sequence *s =
        open_or_fail((sequence_desc){.pattern = "by.vdb", .y_up = y_up, .up_by_creator = !said});
    int components;
    sequence_channel(s, "density", &components);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    bool turned = sequence_grid(s)->size[2] == 4;
    assert_true(texel(s, &t, 1, 1, 1, 0) == 1);
    assert_true(texel(s, &t, 1, turned ? 1 : 2, turned ? 2 : 1, 0) == 2);
    sequence_texels_free(&t);
    return turned;
}

static void the_creator_says_what_is_up_unless_the_script_does(void **state) {
    (void)state;
    assert_true(is_turned("Houdini 20.5.332/SOP_OpenVDB_Write", false, false));
    assert_true(is_turned("Houdini/GEO_VDBTranslator", false, false));
    assert_false(is_turned("Houdini/GEO_VDBTranslator", true, false));
    assert_false(is_turned("Blender/OpenVDBWriter", false, false));
    assert_false(is_turned("Not by Houdini", false, false));
    assert_true(is_turned("Blender/OpenVDBWriter", true, true));
}

static void grids_that_are_not_read_say_why(void **state) {
    (void)state;
    const char *data = getenv("ROIL_TEST_DATA") ? getenv("ROIL_TEST_DATA") : ".";
    static const char *const cases[][2] = {
        {"frustum", "frustum (has a frustum transform; resample it to boxes of voxels first)"},
        {"points", "(has values of type "},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const char *path =
            arena_format(build_memory(), "%s/fuzz/corpus/fuzz_vdb/%s.vdb", data, cases[i][0]);
        assert_null(sequence_create(build_memory(), &(sequence_desc){.pattern = path}));
        assert_error("no grid that can be read in this file");
        assert_error(cases[i][1]);
    }
    const char *types = arena_format(build_memory(), "%s/fuzz/corpus/fuzz_vdb/types.vdb", data);
    sequence *s = sequence_create(build_memory(), &(sequence_desc){.pattern = types});
    assert_non_null(s);
    int components;
    assert_int_equal(sequence_channel(s, "mask", &components), -1);
    assert_error("no grid named 'mask' can be read");
    assert_error("mask (has values of type mask)");
    sequence_grid(s)->destroy(sequence_grid(s), NULL);
}

static void values_that_are_not_finite_count_as_zero(void **state) {
    (void)state;
    float values[8] = {1, INFINITY, 2, 3, -INFINITY, 4, 5, 6};
    vdb_write_grid grid = {
        .name = "density", .size = {2, 2, 2}, .values = values, .components = 1, .voxel_size = 1};
    assert_true(vdb_write(in_folder("nan.vdb"), &grid, 1));
    sequence *s = open_or_fail((sequence_desc){.pattern = "nan.vdb"});
    int components;
    sequence_channel(s, "density", &components);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 0, &t));
    assert_int_equal(t.bad, 2);
    assert_true(texel(s, &t, 2, 1, 1, 0) == 0 && texel(s, &t, 1, 1, 2, 0) == 0);
    assert_true(texel(s, &t, 1, 2, 1, 0) == 2);
    sequence_texels_free(&t);
}

static bool show_at(const sequence *s, double time, uint32_t frames[2], float *blend) {
    return sequence_frames_at(s->data, sequence_position(s->data, time), frames, blend);
}

static void loops_fold_time(void **state) {
    (void)state;
    for (int i = 1; i <= 3; i++)
        write_block(arena_format(build_memory(), "loop%d.vdb", i), "density", 0, (float)i);
    static const struct {
        sequence_loop loop;
        int frame; // of playback
        uint32_t shown;
        bool visible;
    } cases[] = {
        {SEQUENCE_CLIP, -1, 0, false},     {SEQUENCE_CLIP, 0, 0, true},
        {SEQUENCE_CLIP, 2, 2, true},       {SEQUENCE_CLIP, 3, 2, false},
        {SEQUENCE_EXTEND, -5, 0, true},    {SEQUENCE_EXTEND, 9, 2, true},
        {SEQUENCE_REPEAT, 3, 0, true},     {SEQUENCE_REPEAT, 7, 1, true},
        {SEQUENCE_REPEAT, -1, 2, true},    {SEQUENCE_PING_PONG, 3, 1, true},
        {SEQUENCE_PING_PONG, 4, 0, true},  {SEQUENCE_PING_PONG, 5, 1, true},
        {SEQUENCE_PING_PONG, -1, 1, true},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        sequence *s = open_or_fail(
            (sequence_desc){.pattern = "loop*.vdb", .fps = 30, .start = 2, .loop = cases[i].loop});
        uint32_t frames[2];
        float blend;
        bool visible = show_at(s, 2 + cases[i].frame / 30.0, frames, &blend);
        assert_int_equal(frames[0], cases[i].shown);
        assert_int_equal(visible, cases[i].visible);
        assert_true(blend == 0);
    }
    assert_string_equal(sequence_loop_name(SEQUENCE_PING_PONG), "ping_pong");
}

// 1/24 is no binary fraction: the product of a frame's time and the rate may fall below the frame.
static void frames_are_hit_in_spite_of_rounding(void **state) {
    (void)state;
    float zeros[100] = {0};
    assert_true(file_write(in_folder("many.raw"), zeros, sizeof zeros));
    sequence *s = open_or_fail(
        (sequence_desc){.pattern = "many.raw", .raw = {.type = "u8", .size = {1, 1, 1}}});
    assert_int_equal(sequence_frame_count(s), 400);
    for (uint32_t i = 0; i < 400; i++) {
        uint32_t frames[2];
        float blend;
        show_at(s, i / 24.0, frames, &blend);
        assert_int_equal(frames[0], i);
    }
}

static void times_between_frames_blend(void **state) {
    (void)state;
    sequence *s = open_or_fail((sequence_desc){
        .pattern = "loop*.vdb", .fps = 10, .speed = 2, .blend = true, .loop = SEQUENCE_EXTEND});
    assert_true(sequence_grid(s)->blends);
    uint32_t frames[2];
    float blend;
    show_at(s, 0.0625, frames, &blend); // frame 1.25
    assert_int_equal(frames[0], 1);
    assert_int_equal(frames[1], 2);
    assert_true(fabsf(blend - 0.25f) < 1e-5f);
    show_at(s, 0.13, frames, &blend); // the last holds
    assert_int_equal(frames[0], 2);
    assert_true(blend == 0);
}

// What a call writes to stderr.
static const char *warnings_of(sequence_desc desc, sequence **out) {
    static char text[4096];
    fflush(stderr);
    FILE *file = tmpfile();
    int kept = dup(STDERR_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    *out = open_or_fail(desc);
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return text;
}

static const char *file_shown(const sequence *s, double time) {
    uint32_t frames[2];
    float blend;
    show_at(s, time, frames, &blend);
    return path_name(s->data->files[frames[0]]);
}

static void numbers_in_names_are_frames(void **state) {
    (void)state;
    static const struct {
        const char *pattern, *files[4];
        const char *shown[8]; // at every frame of the timeline
        const char *warning;  // NULL: none
    } cases[] = {
        {"odd*.vdb",
         {"odd1.vdb", "odd3.vdb", "odd5.vdb"},
         {"odd1.vdb", "odd1.vdb", "odd3.vdb", "odd3.vdb", "odd5.vdb"},
         "odd*.vdb: there is no file for frames 2, 4; the file before goes on"},
        {"wide*.vdb",
         {"wide10.vdb", "wide8.vdb", "wide9.vdb"},
         {"wide8.vdb", "wide9.vdb", "wide10.vdb"},
         NULL},
        {"zero*.vdb", {"zero.0009.vdb", "zero.0010.vdb"}, {"zero.0009.vdb", "zero.0010.vdb"}, NULL},
        {"neg*.vdb",
         {"neg.-002.vdb", "neg.-001.vdb", "neg.0000.vdb", "neg.0003.vdb"},
         {"neg.-002.vdb", "neg.-001.vdb", "neg.0000.vdb", "neg.0000.vdb", "neg.0000.vdb",
          "neg.0003.vdb"},
         "there is no file for frames 1 to 2; the"},
        {"dash*.vdb", {"dash-2.vdb", "dash-1.vdb"}, {"dash-1.vdb", "dash-2.vdb"}, NULL},
        {"v2_*.vdb",
         {"v2_7_high.vdb", "v2_9_high.vdb"},
         {"v2_7_high.vdb", "v2_7_high.vdb", "v2_9_high.vdb"},
         "for frame 8; the"},
        {"word*.vdb", {"word_a.vdb", "word_b.vdb"}, {"word_a.vdb", "word_b.vdb"}, NULL},
        {"some*.vdb",
         {"some.vdb", "some_5.vdb"},
         {"some.vdb", "some_5.vdb"},
         "'some_5.vdb' and 'some.vdb' do not both have a number"},
        {"two*.vdb",
         {"two_a1.vdb", "two_b1.vdb", "two_b7.vdb"},
         {"two_a1.vdb", "two_b1.vdb", "two_b7.vdb"},
         "differ in more than their last number"},
        {"same*.vdb",
         {"same01.vdb", "same1.vdb", "same2.vdb"},
         {"same01.vdb", "same1.vdb", "same2.vdb"},
         "have the same number"},
        {"long*.vdb",
         {"long1234567890123456.vdb", "long1234567890123457.vdb"},
         {"long1234567890123456.vdb", "long1234567890123457.vdb"},
         NULL},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        for (int k = 0; k < 4 && cases[i].files[k]; k++)
            write_block(cases[i].files[k], "density", 0, 1);
        sequence *s;
        const char *told = warnings_of((sequence_desc){.pattern = cases[i].pattern, .fps = 10}, &s);
        if (cases[i].warning ? !strstr(told, cases[i].warning) : told[0])
            fail_msg("%s: '%s'", cases[i].pattern, told);
        int frames = 0;
        for (; frames < 8 && cases[i].shown[frames]; frames++)
            assert_string_equal(file_shown(s, frames / 10.0), cases[i].shown[frames]);
        assert_int_equal(sequence_frame_count(s), frames);
        assert_true(fabs(sequence_duration(s) - frames / 10.0) < 1e-9);
    }
}

// "odd" has the frames 1, 3 and 5; time is in frames since the first.
static void gaps_are_mixed_by_how_near_their_ends_are(void **state) {
    (void)state;
    static const struct {
        sequence_loop loop;
        double frame;
        uint32_t before, after;
        float blend;
    } cases[] = {
        {SEQUENCE_CLIP, 0, 0, 0, 0},
        {SEQUENCE_CLIP, 0.5, 0, 1, 0.25f},
        {SEQUENCE_CLIP, 1.5, 0, 1, 0.75f},
        {SEQUENCE_CLIP, 3, 1, 2, 0.5f},
        {SEQUENCE_CLIP, 4.5, 2, 2, 0},
        {SEQUENCE_REPEAT, 4.5, 2, 0, 0.5f},
        {SEQUENCE_REPEAT, 6, 0, 1, 0.5f},
        {SEQUENCE_PING_PONG, 4.5, 2, 1, 0.25f},
        {SEQUENCE_PING_PONG, 5, 2, 1, 0.5f},
        {SEQUENCE_PING_PONG, 6.5, 1, 0, 0.25f},
        {SEQUENCE_PING_PONG, -0.5, 1, 0, 0.75f},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        sequence *s;
        const char *told = warnings_of(
            (sequence_desc){.pattern = "odd*.vdb", .fps = 1, .blend = true, .loop = cases[i].loop},
            &s);
        assert_non_null(strstr(told, "the files around are mixed"));
        uint32_t frames[2];
        float blend;
        show_at(s, cases[i].frame, frames, &blend);
        assert_int_equal(frames[0], cases[i].before);
        if (cases[i].blend > 0) assert_int_equal(frames[1], cases[i].after);
        assert_true(fabsf(blend - cases[i].blend) < 1e-5f);
    }
}

static void missing_and_damaged_files_are_named(void **state) {
    (void)state;
    refuses((sequence_desc){.pattern = "nothing*.vdb"}, "nothing*.vdb: no file has such a name");
    refuses((sequence_desc){.pattern = "nothing%04d.vdb"}, "'*' stands for the number of a frame");
    assert_true(file_write(in_folder("bad.vdb"), "not a vdb file", 14));
    refuses((sequence_desc){.pattern = "bad.vdb"}, "bad.vdb");
    refuses((sequence_desc){.pattern = "a1.vdb", .fps = -1}, "frames a second");
    refuses((sequence_desc){.pattern = "a*.vdb", .max_frame_bytes = 1000}, "9 x 9 x 9 voxels");
}

static void far_apart_frames_do_not_ask_for_all_memory(void **state) {
    (void)state;
    write_block("far1.vdb", "density", 0, 1);
    write_block("far2.vdb", "density", 2000000, 1);
    refuses((sequence_desc){.pattern = "far*.vdb"}, "spans");
    write_block("far2.vdb", "density", 100000, 1);
    refuses((sequence_desc){.pattern = "far*.vdb"}, "limit of");
}

// ---- raw --------------------------------------------------------------------------------------

static void raw_types_are_normalised(void **state) {
    (void)state;
    static const struct {
        const char *type;
        uint8_t bytes[4];
        float value;
    } cases[] = {
        {"u8", {255}, 1},
        {"u16", {0xff, 0x7f}, 32767.0f / 65535},
        {"f16", {0x00, 0x40}, 2},
        {"f32", {0x00, 0x00, 0x40, 0x40}, 3},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        assert_true(file_write(in_folder("type.raw"), cases[i].bytes, 4));
        sequence *s = open_or_fail((sequence_desc){
            .pattern = "type.raw",
            .raw = {.type = cases[i].type, .size = {1, 1, 1}, .frames = 1, .value_scale = 10}});
        float value;
        uint64_t bad = 0;
        assert_true(sequence_raw_read(s->data, 0, &value, &bad));
        assert_true(fabsf(value - 10 * cases[i].value) < 1e-5f);
    }
}

static void raw_frames_lie_at_their_stride(void **state) {
    (void)state;
    uint8_t bytes[64];
    for (int i = 0; i < 64; i++) bytes[i] = (uint8_t)i;
    assert_true(file_write(in_folder("stride.raw"), bytes, sizeof bytes));
    sequence *s = open_or_fail((sequence_desc){
        .pattern = "stride.raw",
        .raw = {.type = "u8", .size = {2, 2, 2}, .offset = 4, .stride = 20, .value_scale = 255}});
    assert_int_equal(sequence_frame_count(s), 3); // the last without the gap after it
    int components;
    assert_int_equal(sequence_channel(s, "density", &components), 0);
    assert_int_equal(sequence_channel(s, "smoke", &components), -1);
    sequence_texels t;
    assert_true(sequence_decode(s->data, 2, &t));
    for (int i = 0; i < 8; i++)
        assert_true(texel(s, &t, i % 2, i / 2 % 2, i / 4, 0) == (float)(44 + i));
    assert_true(fabsf(sequence_grid(s)->box.max.y - 1) < 1e-6f); // 2 voxels of 1/2 m
    sequence_texels_free(&t);
}

// Voxel (x, y, z) of 2 x 3 x 4 holds 1 + x + 10 y + 100 z, in every order and direction of axes.
static void raw_axes_go_in_any_order_and_direction(void **state) {
    (void)state;
    static const char *const orders[] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};
    enum { X = 2, Y = 3, Z = 4, PAD = 2 };
    const uint32_t size[3] = {X, Y, Z};
    for (int i = 0; i < 6 * 8; i++) {
        float values[X * Y * Z];
        char axes[8] = "";
        uint32_t n[3], at[3];
        for (int k = 0; k < 3; k++) {
            char c = orders[i / 8][k];
            snprintf(axes + strlen(axes), 3, "%s%c", i >> k & 1 ? "-" : "", c);
            n[k] = size[c - 'x'];
        }
        for (uint32_t v = 0; v < X * Y * Z; v++) {
            const uint32_t along[3] = {v % n[0], v / n[0] % n[1], v / n[0] / n[1]};
            for (int k = 0; k < 3; k++)
                at[orders[i / 8][k] - 'x'] = i >> k & 1 ? n[k] - 1 - along[k] : along[k];
            values[v] = (float)(1 + at[0] + 10 * at[1] + 100 * at[2]);
        }
        assert_true(file_write(in_folder("axes.raw"), values, sizeof values));
        sequence *s = open_or_fail((sequence_desc){.pattern = "axes.raw",
                                                   .raw = {.type = "f32",
                                                           .size = {X, Y, Z},
                                                           .axes = axes,
                                                           .padding = PAD,
                                                           .box = {{1, 2, 3}, {2, 5, 7}}}});
        int components;
        sequence_channel(s, "density", &components);
        sequence_texels t;
        assert_true(sequence_decode(s->data, 0, &t));
        const field_grid *g = sequence_grid(s);
        assert_int_equal(g->size[0], X + 2 * PAD);
        assert_true(g->box.min.x == 0 && g->box.min.y == 0 && g->box.min.z == 1);
        assert_true(g->box.max.x == 3 && g->box.max.y == 7 && g->box.max.z == 9);
        for (int z = 0; z < Z + 2 * PAD; z++)
            for (int y = 0; y < Y + 2 * PAD; y++)
                for (int x = 0; x < X + 2 * PAD; x++) {
                    int p[3] = {x - PAD, y - PAD, z - PAD};
                    bool inside =
                        p[0] >= 0 && p[0] < X && p[1] >= 0 && p[1] < Y && p[2] >= 0 && p[2] < Z;
                    float wanted = inside ? (float)(1 + p[0] + 10 * p[1] + 100 * p[2]) : 0;
                    assert_true(texel(s, &t, x, y, z, 0) == wanted);
                }
        sequence_texels_free(&t);
    }
}

static void raw_descriptions_are_checked(void **state) {
    (void)state;
#define RAW(...)                                                                                   \
    (sequence_desc) {                                                                              \
        .pattern = "stride.raw", .raw = { __VA_ARGS__ }                                            \
    }
    refuses(RAW(.type = "u32", .size = {2, 2, 2}), "'u32'");
    refuses(RAW(.size = {2, 2, 2}), "u8, u16, f16 and f32");
    refuses(RAW(.type = "u8", .size = {2, 0, 2}), "2 x 0 x 2");
    refuses(RAW(.type = "u8", .size = {5000, 1, 1}), "4096");
    refuses(RAW(.type = "f32", .size = {4, 4, 4}), "its first frame needs 256");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .frames = 9), "9 frames");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .stride = 7), "7 bytes apart");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .offset = 57), "from byte 57");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .offset = UINT64_MAX), "holds 64 bytes");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .stride = UINT64_MAX, .frames = 2), "2 frames");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .voxel_size = -1), "voxel size");
    static const char *const axes[] = {"", "xy", "xxz", "xyzx", "x--yz", "XYZ", "xyz-", "xyw"};
    for (size_t i = 0; i < COUNT_OF(axes); i++)
        refuses(RAW(.type = "u8", .size = {2, 2, 2}, .axes = axes[i]), "as in \"x-yz\"");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .padding = 2048), "2048 of padding");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .padding = UINT32_MAX), "of padding");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .padding = 1000), "limit of");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .box = {{0, 0, 0}, {1, 1, 0}}), "along z");
    refuses(RAW(.type = "u8", .size = {2, 2, 2}, .box = {{NAN, 0, 0}, {1, 1, 1}}), "along x");
    refuses(RAW(.type = "f32", .size = {4096, 4096, 4096}), "limit of");
}

static void a_raw_file_that_shrinks_is_an_error(void **state) {
    (void)state;
    uint8_t bytes[16] = {1};
    assert_true(file_write(in_folder("shrink.raw"), bytes, sizeof bytes));
    sequence *s = open_or_fail(
        (sequence_desc){.pattern = "shrink.raw", .raw = {.type = "u8", .size = {2, 2, 2}}});
    assert_int_equal(truncate(in_folder("shrink.raw"), 12), 0);
    int components;
    sequence_channel(s, "density", &components);
    sequence_texels t;
    assert_false(sequence_decode(s->data, 1, &t));
    assert_error("became shorter");
}

static int make_folder(void **state) {
    (void)state;
    strcpy(folder, "/tmp/roil-sequence-XXXXXX");
    return mkdtemp(folder) ? 0 : 1;
}

static int remove_folder(void **state) {
    while (opened_count) {
        field_grid *grid = sequence_grid(opened[--opened_count]);
        grid->destroy(grid, NULL);
    }
    (void)state;
    file_list list;
    if (file_glob(in_folder("*"), &list))
        for (size_t i = 0; i < list.count; i++) remove(list.paths[i]);
    file_list_free(&list);
    arena_free(build_memory());
    return rmdir(folder);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_lies_in_the_root),
        cmocka_unit_test(one_box_encloses_all_frames),
        cmocka_unit_test(voxels_on_the_lattice_are_copied_exactly),
        cmocka_unit_test(a_frame_without_the_grid_is_empty),
        cmocka_unit_test(channels_are_found_by_alias),
        cmocka_unit_test(three_scalar_grids_make_a_vector),
        cmocka_unit_test(y_up_turns_box_and_voxels),
        cmocka_unit_test(the_creator_says_what_is_up_unless_the_script_does),
        cmocka_unit_test(grids_that_are_not_read_say_why),
        cmocka_unit_test(values_that_are_not_finite_count_as_zero),
        cmocka_unit_test(loops_fold_time),
        cmocka_unit_test(frames_are_hit_in_spite_of_rounding),
        cmocka_unit_test(times_between_frames_blend),
        cmocka_unit_test(numbers_in_names_are_frames),
        cmocka_unit_test(gaps_are_mixed_by_how_near_their_ends_are),
        cmocka_unit_test(missing_and_damaged_files_are_named),
        cmocka_unit_test(far_apart_frames_do_not_ask_for_all_memory),
        cmocka_unit_test(raw_types_are_normalised),
        cmocka_unit_test(raw_frames_lie_at_their_stride),
        cmocka_unit_test(raw_axes_go_in_any_order_and_direction),
        cmocka_unit_test(raw_descriptions_are_checked),
        cmocka_unit_test(a_raw_file_that_shrinks_is_an_error),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
