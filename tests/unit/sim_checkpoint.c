// Checkpoints: what was saved comes back; whatever else a file holds is refused, with a message and
// before anything is overwritten.
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "sim/lbm_state.h"
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[256], file[512];

static int set_up(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/roil-sim-XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(folder)) return -1;
    snprintf(file, sizeof file, "%s/a.state", folder);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}

static void assert_message(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("'%s' does not say '%s'", err_get(), part);
}

static checkpoint *open_file(void) {
    checkpoint *c = checkpoint_open(file);
    if (!c) fail_msg("%s", err_get());
    return c;
}

static void assert_refused(const char *part) {
    checkpoint *c = checkpoint_open(file);
    assert_null(c);
    assert_message(part);
}

static void *make(size_t size, bool noise) {
    unsigned char *bytes = mem_alloc(size);
    uint32_t state = 1;
    for (size_t i = 0; i < size; i++) {
        state = state * 1664525u + 1013904223u;
        bytes[i] = noise ? (unsigned char)(state >> 24) : (unsigned char)(i >> 16);
    }
    return bytes;
}

static void save_one(const char *name, void *bytes, uint64_t size) {
    checkpoint_part part = {.name = name, .size = size, .width = 2, .bytes = bytes};
    if (!checkpoint_save(file, NULL, &part, 1)) fail_msg("%s", err_get());
}

static void what_was_saved_comes_back(void **state) {
    (void)state;
    // Nothing, one byte, one chunk and a bit, more than are packed at once.
    static const uint64_t sizes[] = {0, 1, CHECKPOINT_CHUNK + 3, 9ull * CHECKPOINT_CHUNK - 2};
    static const char *const names[] = {"air/none", "air/one", "air/some", "air/many"};
    for (int noise = 0; noise < 2; noise++) {
        checkpoint_part parts[4];
        for (int i = 0; i < 4; i++)
            parts[i] = (checkpoint_part){.name = names[i],
                                         .size = sizes[i],
                                         .width = 1u << i,
                                         .bytes = make(sizes[i], noise)};
        if (!checkpoint_save(file, NULL, parts, 4)) fail_msg("%s", err_get());
        checkpoint *c = open_file();
        for (int i = 3; i >= 0; i--) { // in any order
            uint64_t size = 99;
            assert_true(checkpoint_has(c, names[i], &size));
            assert_int_equal(size, sizes[i]);
            checkpoint_part back = parts[i];
            back.bytes = mem_alloc(size);
            if (!checkpoint_load(c, NULL, &back)) fail_msg("%s", err_get());
            assert_memory_equal(back.bytes, parts[i].bytes, size);
            mem_free(back.bytes);
            mem_free(parts[i].bytes);
        }
        checkpoint_close(c);
    }
}

static size_t file_size(void) {
    void *data;
    size_t size;
    assert_true(file_read(file, 1 << 28, &data, &size));
    mem_free(data);
    return size;
}

static void what_is_regular_takes_less_room(void **state) {
    (void)state;
    size_t size = 3 << 20;
    void *plain = make(size, false), *noise = make(size, true);
    save_one("a", plain, size);
    assert_true(file_size() < size / 50);
    save_one("a", noise, size);
    assert_true(file_size() > size && file_size() < size + 1000);
    mem_free(plain);
    mem_free(noise);
}

static void parts_must_be_those_that_are_wanted(void **state) {
    (void)state;
    char bytes[64] = "x";
    save_one("air/state", bytes, sizeof bytes);
    checkpoint *c = open_file();
    checkpoint_part other = {.name = "smoke", .size = sizeof bytes, .bytes = bytes};
    assert_false(checkpoint_load(c, NULL, &other));
    assert_message("has no part 'smoke'");
    checkpoint_part shorter = {.name = "air/state", .size = 63, .bytes = bytes};
    assert_false(checkpoint_load(c, NULL, &shorter));
    assert_message("part 'air/state' has 64 bytes; 63 are accepted");
    checkpoint_close(c);
}

// ---- damage -----------------------------------------------------------------------------------

static void put(const void *data, size_t size) {
    FILE *f = fopen(file, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static unsigned char *save_and_read(size_t *size) {
    void *data, *plain = make(700, false);
    char noise[40];
    for (size_t i = 0; i < sizeof noise; i++) noise[i] = (char)(i * 37);
    checkpoint_part parts[] = {{.name = "packed", .size = 700, .width = 4, .bytes = plain},
                               {.name = "plain", .size = sizeof noise, .width = 1, .bytes = noise}};
    assert_true(checkpoint_save(file, NULL, parts, 2));
    assert_true(file_read(file, 1 << 20, &data, size));
    mem_free(plain);
    return data;
}

static void every_truncated_file_is_refused(void **state) {
    (void)state;
    size_t size;
    unsigned char *data = save_and_read(&size);
    for (size_t length = 0; length < size; length++) {
        put(data, length);
        assert_refused(file);
    }
    mem_free(data);
}

static void every_flipped_byte_is_noticed(void **state) {
    (void)state;
    size_t size;
    unsigned char *data = save_and_read(&size);
    for (size_t i = 0; i < size; i++) {
        data[i] ^= 1u << i % 8;
        put(data, size);
        assert_refused(file);
        data[i] ^= 1u << i % 8;
    }
    mem_free(data);
}

// The layout that the file has (checkpoint.c), to forge what only a stranger writes.
enum { TABLE = 24, ENTRY = 88, SIZE = 64, OFFSET = 72, WIDTH = 80, HASH = 16 };

static void seal(unsigned char *data, size_t count) {
    uint64_t hash = hash64(data + TABLE, count * ENTRY);
    memcpy(data + HASH, &hash, sizeof hash);
}

static void set64(unsigned char *at, uint64_t value) {
    memcpy(at, &value, sizeof value);
}

static void forged_tables_are_refused(void **state) {
    (void)state;
    static const struct {
        size_t at;
        uint64_t value;
        const char *says;
    } forgeries[] = {
        {TABLE + SIZE, UINT64_MAX, "too large"},
        {TABLE + SIZE, UINT64_C(1) << 40, "strange size"},
        {TABLE + SIZE, 701, "strange size"},
        {TABLE + SIZE, 0, "lies elsewhere"},
        {TABLE + OFFSET, UINT64_MAX, "lies elsewhere"},
        {TABLE + ENTRY + OFFSET, TABLE, "lies elsewhere"},
        {TABLE + WIDTH, 3, "strange width"},
        {TABLE, 0, "has no name"},
        {TABLE, UINT64_C(0x2e2e2f5c0a1b2e2e), "has no name"},
        {TABLE + ENTRY + SIZE, 0, "more than it says"},
    };
    size_t size;
    unsigned char *data = save_and_read(&size), *copy = mem_alloc(size);
    for (size_t i = 0; i < COUNT_OF(forgeries); i++) {
        memcpy(copy, data, size);
        set64(copy + forgeries[i].at, forgeries[i].value);
        seal(copy, 2);
        put(copy, size);
        assert_refused(forgeries[i].says);
    }
    memcpy(copy, data, size);
    memcpy(copy + TABLE + ENTRY, copy + TABLE, 64); // the name
    seal(copy, 2);
    put(copy, size);
    assert_refused("is there twice");
    mem_free(copy);
    mem_free(data);
}

static void forged_heads_are_refused(void **state) {
    (void)state;
    size_t size;
    unsigned char *data = save_and_read(&size);
    data[8] = 2;
    put(data, size);
    assert_refused("of version 2; 1 is accepted");
    data[8] = 1;
    memset(data + 12, 0xff, 4);
    put(data, size);
    assert_refused("table is too large");
    put("roil", 4);
    assert_refused("is no checkpoint");
    put("a long text that is something else, whatever it may be", 50);
    assert_refused("is no checkpoint");
    mem_free(data);
}

// A chunk whose hash is right, and whose content no packer has made.
static void forged_chunks_are_refused(void **state) {
    (void)state;
    size_t size, chunk = TABLE + 2 * ENTRY;
    uint32_t stored;
    unsigned char *data = save_and_read(&size), bytes[700];
    memcpy(&stored, data + chunk + 4, sizeof stored);
    assert_true(stored < 700); // it is packed
    for (uint32_t seed = 0; seed < 200; seed++) {
        uint32_t random = seed;
        for (uint32_t i = 0; i < stored; i++) {
            random = random * 1664525u + 1013904223u;
            // The packer's own head stays, so that its inside is reached.
            if (i >= 16 || seed < 10) data[chunk + 16 + i] = (unsigned char)(random >> 24);
        }
        set64(data + chunk + 8, hash64(data + chunk + 16, stored));
        put(data, size);
        checkpoint *c = open_file();
        checkpoint_part part = {.name = "packed", .size = 700, .bytes = bytes};
        if (!checkpoint_load(c, NULL, &part)) assert_message("cannot be unpacked");
        checkpoint_close(c);
    }
    mem_free(data);
}

static int save_on_a_full_disk(void) {
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit limit = {4096, 4096};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 10;
    void *noise = make(100000, true);
    checkpoint_part part = {.name = "a", .size = 100000, .width = 1, .bytes = noise};
    if (checkpoint_save(file, NULL, &part, 1)) return 11;
    return strstr(err_get(), "cannot be written: File too large") ? 0 : 12;
}

static void a_full_disk_keeps_the_old_file(void **state) {
    (void)state;
    char bytes[] = "old";
    save_one("a", bytes, sizeof bytes);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) _exit(save_on_a_full_disk());
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    checkpoint_close(open_file());
}

// ---- what must be the same ----------------------------------------------------------------------

static void save_text(const char *text) {
    save_one("air/lattice", (char *)(uintptr_t)text, strlen(text));
}

static void require(const char *ours, const char *says) {
    checkpoint *c = open_file();
    bool done = checkpoint_require(c, "air/lattice", ours);
    checkpoint_close(c);
    assert_true(done == !says);
    if (says) assert_message(says);
}

static void the_message_says_what_differs(void **state) {
    (void)state;
    save_text("size = 4 x 4 x 16\nprecision = f32\n");
    require("size = 4 x 4 x 16\nprecision = f32\n", NULL);
    require("size = 4 x 4 x 16\nprecision = f16\n",
            "made with precision = f32, the effect has precision = f16");
    require("size = 4 x 4 x 16\n", "made with precision = f32, the effect has nothing more");
    require("", "made with size = 4 x 4 x 16, the effect has nothing more");
    save_text("");
    require("size = 4", "made with nothing more, the effect has size = 4");
    save_text("size = \033[2J 4"); // not to be obeyed by a terminal
    require("size = 4", "made with size = ?[2J 4");
}

static void all_of_a_text_counts(void **state) {
    char text[201] = "";
    (void)state;
    memset(text, 'a', sizeof text - 1);
    save_text(text);
    require(text, NULL);
    text[sizeof text - 2] = 'b'; // beyond what a message shows
    require(text, "made with aaa");
    save_text("size = 4\n\nprecision = f32\n");
    require("size = 4\n\nprecision = f16\n",
            "made with precision = f32, the effect has precision = f16");
}

// Solvers that were never built: nothing of them is on a device, and nothing may be touched.
static void another_lattice_is_refused(void **state) {
    (void)state;
    arena memory = {0};
    checkpoint_list list = {0};
    lbm_desc desc = {.size = {8, 8, 16}, .precision = LBM_F16, .scalars = 2};
    lbm *one = lbm_create(&memory, &desc);
    lbm_state_list(one, "air", "voxel_size = 0.05\n", &list);
    assert_true(checkpoint_save(file, NULL, list.parts, list.count));
    checkpoint_list_free(&list);
    checkpoint *c = open_file();
    assert_true(lbm_state_load(one, NULL, "air", "voxel_size = 0.05\n", c));
    assert_false(lbm_state_load(one, NULL, "smoke", "voxel_size = 0.05\n", c));
    assert_message("has no part 'smoke/lattice'");
    assert_false(lbm_state_load(one, NULL, "air", "voxel_size = 0.1\n", c));
    assert_message("made with voxel_size = 0.05, the effect has voxel_size = 0.1");
    desc.precision = LBM_F32;
    assert_false(lbm_state_load(lbm_create(&memory, &desc), NULL, "air", "", c));
    assert_message("made with precision = f16, the effect has precision = f32");
    desc.precision = LBM_F16;
    desc.faces[4] = LBM_WALL, desc.faces[5] = LBM_OPEN;
    assert_false(lbm_state_load(lbm_create(&memory, &desc), NULL, "air", "", c));
    assert_message("made with boundary.bottom = periodic, the effect has boundary.bottom = wall");
    checkpoint_close(c);
    arena_free(&memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_saved_comes_back),
        cmocka_unit_test(what_is_regular_takes_less_room),
        cmocka_unit_test(parts_must_be_those_that_are_wanted),
        cmocka_unit_test(every_truncated_file_is_refused),
        cmocka_unit_test(every_flipped_byte_is_noticed),
        cmocka_unit_test(forged_tables_are_refused),
        cmocka_unit_test(forged_heads_are_refused),
        cmocka_unit_test(forged_chunks_are_refused),
        cmocka_unit_test(a_full_disk_keeps_the_old_file),
        cmocka_unit_test(the_message_says_what_differs),
        cmocka_unit_test(all_of_a_text_counts),
        cmocka_unit_test(another_lattice_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
