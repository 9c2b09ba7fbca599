// OpenVDB files from strangers: cut short, overwritten, absurd. Each gives a message that names it.
#include "media_test.h"

#include "media/vdb_decode.h"
#include <math.h>
#include <pthread.h>
#include <sched.h>

static arena memory;
static float out[16 * 16 * 16 * 3];

// Of a grid that can be sampled, and of its file.
static vdb_sample_desc desc_of(const char *path, const vdb_grid_info *g) {
    vdb_sample_desc desc = {path,          g->name, g->box, {16, 16, 16},
                            g->components, out,     NULL,   VDB_SET_SOLID};
    if (box3_is_empty(desc.box)) desc.box.max = (float3){8, 8, 8};
    return desc;
}

// By the reader: info, and every grid that can be sampled. True when all of it worked.
static bool read_all(const char *path) {
    vdb_info info;
    arena_free(&memory);
    if (!vdb_read_info(path, &memory, &info)) return false;
    bool good = true;
    for (size_t i = 0; i < info.count; i++) {
        const vdb_sample_desc desc = desc_of(path, &info.grids[i]);
        if (desc.components) good = vdb_sample(&desc, NULL) && good;
    }
    return good;
}

// The same in this process, where a fault of memory shows, and thousands are soon done.
static bool decode_all(const char *name, const void *bytes, size_t size) {
    vdb_info info;
    arena_free(&memory);
    vdb_file *f = vdb_file_open(name, bytes, size);
    bool good = f && vdb_file_info(f, &memory, &info);
    for (size_t i = 0; f && good && i < info.count; i++) {
        const vdb_sample_desc desc = desc_of(name, &info.grids[i]);
        if (desc.components) good = vdb_file_sample(f, &desc, NULL) && good;
    }
    vdb_file_close(f);
    return good;
}

static void load(const char *name, void **data, size_t *size) {
    static float values[12 * 12 * 12];
    for (int i = 0; i < 12 * 12 * 12; i++) values[i] = sinf((float)i);
    vdb_write_grid grids[2] = {
        {.name = "density",
         .size = {12, 12, 12},
         .values = values,
         .components = 1,
         .voxel_size = 0.1f,
         .half = true},
        {.name = "heat", .size = {5, 5, 5}, .values = values, .components = 1, .voxel_size = 0.1f}};
    assert_true(vdb_write(test_path(name), grids, 2));
    assert_true(read_all(test_path(name)));
    assert_true(file_read(test_path(name), 1 << 24, data, size));
}

static void every_truncation_is_an_error(void **state) {
    (void)state;
    void *data;
    size_t size;
    load("whole.vdb", &data, &size);
    for (size_t n = 0; n < size; n += n < 1500 ? 1 : 61) {
        assert_false(decode_all("cut.vdb", data, n));
        assert_message("cut.vdb");
        if (n % 64) continue;
        test_put("cut.vdb", data, n);
        assert_false(read_all(test_path("cut.vdb")));
        assert_message("cut.vdb");
    }
    mem_free(data);
}

static void two_thousand_damaged_files_end_in_values_or_messages(void **state) {
    (void)state;
    static const uint32_t ODD[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x10000, 1000000};
    void *data;
    size_t size, refused = 0;
    load("whole.vdb", &data, &size);
    uint32_t random = 2024;
    for (int i = 0; i < 2000; i++) {
        uint8_t *copy = mem_copy(data, size);
        size_t reach = i % 2 ? size : 1400; // every second time in the head of the file
        for (uint32_t k = 0; k < 1 + test_random(&random) % 6; k++) {
            size_t at = test_random(&random) % (reach - 4);
            if (test_random(&random) % 2)
                copy[at] = (uint8_t)test_random(&random);
            else
                memcpy(copy + at, &ODD[test_random(&random) % 7], 4);
        }
        bool good = decode_all("bad.vdb", copy, size);
        if (!good) {
            assert_message("bad.vdb");
            refused++;
        }
        if (i % 50 == 0) {
            test_put("bad.vdb", copy, size);
            assert_int_equal(read_all(test_path("bad.vdb")), good);
        }
        mem_free(copy);
    }
    assert_true(refused > 500); // else the damage does not reach what matters
    mem_free(data);
}

static void random_bytes_are_no_vdb_file(void **state) {
    (void)state;
    uint8_t noise[4096];
    uint32_t random = 1;
    for (size_t i = 0; i < sizeof noise; i++) noise[i] = (uint8_t)test_random(&random);
    test_put("noise.vdb", noise, sizeof noise);
    assert_false(read_all(test_path("noise.vdb")));
    assert_message("is not a VDB file");
    static const uint8_t HEAD[20] = {0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0, 224, 0, 0, 0, 10};
    memcpy(noise, HEAD, sizeof HEAD);
    test_put("noise.vdb", noise, sizeof noise);
    assert_false(read_all(test_path("noise.vdb")));
    assert_message("noise.vdb");
    noise[8] = 100;
    test_put("old.vdb", noise, sizeof noise);
    assert_false(read_all(test_path("old.vdb")));
    assert_message("format 100 is not supported");
    test_put("empty.vdb", "", 0);
    assert_false(read_all(test_path("empty.vdb")));
    assert_false(read_all(test_path("absent.vdb")));
    assert_message("absent.vdb");
    assert_false(read_all(test_folder));
}

static void absurd_boxes_are_refused(void **state) {
    (void)state;
    static const char *const NAMES[] = {"far.vdb", "wide.vdb"};
    for (int i = 0; i < 2; i++) {
        char name[64];
        snprintf(name, sizeof name, "tests/fuzz/corpus/fuzz_vdb/%s", NAMES[i]);
        const char *path = test_source(name);
        if (!path) skip();
        assert_false(read_all(path));
        assert_message("impossible active box");
    }
}

static void absurd_requests_are_refused(void **state) {
    (void)state;
    void *data;
    size_t size;
    load("whole.vdb", &data, &size);
    mem_free(data);
    vdb_sample_desc desc = {
        test_path("whole.vdb"), "heat", {{0, 0, 0}, {1, 1, 1}}, {65536, 65536, 65536}, 1, out, NULL,
        VDB_SET_SOLID};
    assert_false(vdb_sample(&desc, NULL));
    assert_message("2^31");
    desc.size[0] = desc.size[1] = desc.size[2] = 0;
    assert_false(vdb_sample(&desc, NULL));
    desc.size[0] = desc.size[1] = desc.size[2] = 4;
    desc.box.max.x = 1e30f;
    assert_false(vdb_sample(&desc, NULL));
    assert_message("too far");
    desc.box.max.x = NAN;
    assert_false(vdb_sample(&desc, NULL));
}

static bool write_noise(void) {
    enum { SIDE = 64 };
    float *values = mem_alloc(SIDE * SIDE * SIDE * sizeof *values);
    uint32_t random = 9;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) values[i] = (float)test_random(&random);
    vdb_write_grid grid = {.name = "n",
                           .size = {SIDE, SIDE, SIDE},
                           .values = values,
                           .components = 1,
                           .voxel_size = 1.0f};
    bool done = vdb_write(test_path("full.vdb"), &grid, 1);
    mem_free(values);
    return done;
}

static void a_full_disk_is_an_error_and_leaves_nothing(void **state) {
    (void)state;
    assert_true(test_fails_on_full_disk(write_noise, 100000));
    assert_false(file_exists(test_path("full.vdb")));
    assert_int_equal(symlink("/dev/full", test_path("dev.vdb")), 0);
    float one = 1.0f;
    vdb_write_grid grid = {
        .name = "n", .size = {1, 1, 1}, .values = &one, .components = 1, .voxel_size = 1.0f};
    assert_false(vdb_write(test_path("dev.vdb"), &grid, 1));
    assert_message("dev.vdb");
    assert_false(vdb_write(test_path("no/such/folder.vdb"), &grid, 1));
}

// ---- the reader's processes --------------------------------------------------------------------

// The last child of any of its threads; 0: none.
static pid_t child_of(pid_t parent) {
    char pattern[64];
    file_list threads = {0};
    int child = 0;
    snprintf(pattern, sizeof pattern, "/proc/%d/task/*", (int)parent);
    if (parent == 0 || !file_glob(pattern, &threads)) return 0;
    for (size_t i = 0; i < threads.count; i++) {
        char path[PATH_CAP];
        FILE *file = path_join(path, threads.paths[i], "children") ? fopen(path, "r") : NULL;
        while (file && fscanf(file, "%d", &child) == 1) {
        }
        if (file) fclose(file);
    }
    file_list_free(&threads);
    return child;
}

// The first of all: nothing has been read or written by OpenVDB yet.
static void openvdb_starts_for_voxels_or_when_it_is_told_to(void **state) {
    (void)state;
    const char *path = test_source("tests/fuzz/corpus/fuzz_vdb/float.vdb");
    arena *const memories[] = {&memory};
    vdb_info info;
    if (!path) skip();
    if (!vdb_read_infos(NULL, &path, 1, memories, &info)) fail_msg("%s", err_get());
    assert_int_equal(info.count, 1);
    pid_t reader = child_of(getpid());
    if (!reader) skip(); // a kernel without lists of children
    assert_int_equal(child_of(reader), 0);
    vdb_warm_up();
    assert_true(vdb_read_infos(NULL, &path, 1, memories, &info)); // after that, by the same process
    pid_t decoder = child_of(reader);
    assert_int_not_equal(decoder, 0);
    vdb_warm_up();
    assert_true(read_all(path));
    assert_int_equal(child_of(reader), decoder);
}

typedef struct slow { // much to do for a small file
    pthread_t thread;
    bool running, done;
    char message[512];
    float *out;
} slow;

static void *sample_slowly(void *user) {
    slow *s = user;
    vdb_sample_desc desc = {
        test_folder, "heat",       {{0, 0, 0}, {0.3f, 0.3f, 0.3f}}, {200, 200, 200}, 1, s->out,
        NULL,        VDB_SET_SOLID};
    char path[PATH_CAP + 16];
    snprintf(path, sizeof path, "%s/whole.vdb", test_folder);
    desc.path = path;
    s->done = vdb_sample(&desc, NULL);
    snprintf(s->message, sizeof s->message, "%s", err_get());
    __atomic_store_n(&s->running, false, __ATOMIC_RELEASE);
    return NULL;
}

static void start_slowly(slow *s) {
    *s = (slow){.running = true, .out = mem_alloc((size_t)200 * 200 * 200 * sizeof(float))};
    assert_int_equal(pthread_create(&s->thread, NULL, sample_slowly, s), 0);
}

static void end_slowly(slow *s) {
    pthread_join(s->thread, NULL);
    mem_free(s->out);
}

static void a_crash_fails_one_file_only(void **state) {
    (void)state;
    void *data;
    size_t size;
    load("whole.vdb", &data, &size);
    mem_free(data);
    pid_t decoder = child_of(child_of(getpid()));
    if (!decoder) skip(); // a kernel without lists of children
    slow s;
    for (int attempt = 0; attempt < 20; attempt++) { // until a worker was met at its work
        pid_t worker = 0;
        start_slowly(&s);
        while (__atomic_load_n(&s.running, __ATOMIC_ACQUIRE) && !worker) {
            worker = child_of(decoder);
            if (worker) kill(worker, SIGABRT); // which no sanitizer handles
            sched_yield();
        }
        end_slowly(&s);
        if (!s.done) break;
    }
    assert_false(s.done);
    if (!strstr(s.message, "whole.vdb: the reader crashed (signal 6)")) fail_msg("%s", s.message);
    assert_int_equal(child_of(child_of(getpid())), decoder);
    assert_true(read_all(test_path("whole.vdb")));
}

static void a_decoder_that_was_lost_is_replaced(void **state) {
    (void)state;
    void *data;
    size_t size;
    load("whole.vdb", &data, &size);
    mem_free(data);
    pid_t reader = child_of(getpid()), decoder = child_of(reader);
    if (!decoder) skip();
    assert_int_equal(kill(decoder, SIGSTOP), 0); // so that the request waits in it
    slow s;
    start_slowly(&s);
    sched_yield();
    assert_int_equal(kill(decoder, SIGKILL), 0);
    end_slowly(&s);
    if (!s.done) fail_msg("%s", s.message);
    assert_true(read_all(test_path("whole.vdb")));
    assert_int_not_equal(child_of(reader), decoder);
    assert_int_equal(child_of(getpid()), reader);
}

static int teardown(void **state) {
    arena_free(&memory);
    return test_teardown(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(openvdb_starts_for_voxels_or_when_it_is_told_to),
        cmocka_unit_test(every_truncation_is_an_error),
        cmocka_unit_test(two_thousand_damaged_files_end_in_values_or_messages),
        cmocka_unit_test(random_bytes_are_no_vdb_file),
        cmocka_unit_test(absurd_boxes_are_refused),
        cmocka_unit_test(absurd_requests_are_refused),
        cmocka_unit_test(a_crash_fails_one_file_only),
        cmocka_unit_test(a_decoder_that_was_lost_is_replaced),
        cmocka_unit_test(a_full_disk_is_an_error_and_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, test_setup, teardown);
}
