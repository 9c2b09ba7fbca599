// A thousand reloads, good and broken, in random order: the simulation goes on through all of them,
// and memory on the device and of the host stays as it is after the first two hundred.
#include "roil_live_test.h"

#include <malloc.h>

enum { WARM = 200, ROUNDS = 1000, VALIDATED = 50 };

static uint64_t seed = 12345;

static uint32_t chance(uint32_t count) { // splitmix64
    uint64_t z = (seed += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ (z >> 31)) % count);
}

// ---- the effect -------------------------------------------------------------------------------

typedef struct files { // what they say now; what draws is what they said when all were good
    double gain, more, part;
    bool doubled;
    const char *broken[5]; // by file: part of the message; NULL: it is good
} files;

enum { TEST_LUA, MORE_LUA, PART_GLSL, COUNT_COMP, QUAD_OBJ };

// The mesh is drawn too, though nothing shows it.
static const char SCENE[] = "fx.depth = geometry { mesh { 'quad.obj' } }.depth\n";

static void edit_script(files *f) {
    static const char *const faults[] = {"oops(", "count.nothing()", "error('on purpose')",
                                         "fx.update = function() error('on purpose') end"};
    static const char *const words[] = {"test.lua", "test.lua", "on purpose", "on purpose"};
    uint32_t fault = chance(12);
    char gain[16], end[256];
    f->gain = (1 + chance(4)) * 0.125;
    f->doubled = chance(2);
    bool bad = fault < COUNT_OF(faults);
    f->broken[TEST_LUA] = bad ? words[fault] : NULL;
    snprintf(gain, sizeof gain, "%g", f->gain);
    snprintf(end, sizeof end, "%s%s", SCENE, bad ? faults[fault] : "");
    put_script(gain, f->doubled ? "mode = 'double'" : "", end);
}

static void edit_module(files *f) {
    char text[64], path[512];
    f->more = chance(2) ? 1 : 0.5;
    snprintf(text, sizeof text, "return %g", f->more);
    write_text("more.lua", text, path);
    bool gone = chance(4) == 0;
    f->broken[MORE_LUA] = gone ? "no module 'more'" : NULL;
    if (gone) assert_int_equal(unlink(path), 0);
}

static void edit_part(files *f) { // one in two is code that was never compiled
    char text[64];
    f->part = chance(2) ? 0.25 : (1 + chance(10000)) / 10001.0;
    bool bad = chance(4) == 0;
    f->broken[PART_GLSL] = bad ? "part.glsl" : NULL;
    snprintf(text, sizeof text, "%.6f%s", f->part, bad ? " +" : "");
    put_part(text);
}

static void edit_shader(files *f) {
    bool bad = chance(3) == 0;
    f->broken[COUNT_COMP] = bad ? "count.comp" : NULL;
    put("count.comp", bad ? "void main() { misspelt(); }\n" : SHADER);
}

static void edit_mesh(files *f) {
    bool bad = chance(2) == 0;
    f->broken[QUAD_OBJ] = bad ? "quad.obj" : NULL;
    put("quad.obj", bad ? "v nothing\n" : "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nf 1 2 3\n");
}

static void edit(files *f) {
    static void (*const edits[])(files * f) = {
        [TEST_LUA] = edit_script,   [MORE_LUA] = edit_module, [PART_GLSL] = edit_part,
        [COUNT_COMP] = edit_shader, [QUAD_OBJ] = edit_mesh,
    };
    static const int shares[16] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4};
    int which = shares[chance(16)];          // meshes are dear: each forks a process
    for (int i = 0; i < 5 && chance(8); i++) // mostly what is broken is mended next
        if (f->broken[i]) which = i;
    edits[which](f);
}

static const char *what_is_broken(const files *f) {
    for (size_t i = 0; i < COUNT_OF(f->broken); i++)
        if (f->broken[i]) return f->broken[i];
    return NULL;
}

// ---- the soak ---------------------------------------------------------------------------------

typedef struct memory {
    uint64_t device;
    double host; // MB
} memory;

static memory memory_now(roil *r) {
    unsigned long pages = 0, resident = 0;
    malloc_trim(0); // the more threads run at once, the more free memory the allocator keeps
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%lu %lu", &pages, &resident), 2);
    fclose(file);
    return (memory){roil_get_memory(r).device,
                    (double)resident * (double)sysconf(_SC_PAGESIZE) / (1 << 20)};
}

typedef struct soak {
    session s;
    files now, shown;
    int frames;
} soak;

static void draw_shown(soak *k) {
    double gain = k->shown.gain * k->shown.more * (k->shown.doubled ? 2 : 1);
    k->frames += k->frames < 1024; // no picture is brighter
    draw(&k->s, k->frames, gain, k->shown.part);
}

static void reload(soak *k, void (*change)(files *f)) {
    change(&k->now);
    const char *part = what_is_broken(&k->now);
    if (part) {
        assert_true(update(&k->s));
        if (!roil_live_message(k->s.live)) fail_msg("no message; expected '%s'", part);
    } else {
        expect_good(&k->s);
        k->shown = k->now;
    }
    draw_shown(k);
}

static void put_good(files *f) {
    *f = (files){.gain = 0.5, .more = 1, .part = 0.25};
    put_all();
    put_script("0.5", "", SCENE);
    put("quad.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nf 1 2 3\n");
}

static memory rest(soak *k, roil *r) { // what a good effect takes
    reload(k, put_good);
    for (int i = 0; i < 4; i++) draw_shown(k); // what was let go dies with its frames
    return memory_now(r);
}

static void soak_for(roil *r, int warm, int rounds) {
    soak k = {.s = {.frame = 1}};
    put_good(&k.now);
    k.shown = k.now;
    k.s.live = roil_live_create(r, &(roil_live_desc){.file = script_path});
    ok(k.s.live);
    expect_good(&k.s);
    for (int i = 0; i < warm; i++) reload(&k, edit);
    memory before = rest(&k, r);
    for (int i = 0; i < rounds; i++) reload(&k, edit);
    memory after = rest(&k, r);
    roil_live_count counts = roil_live_counts(k.s.live);
    printf("%llu reloads, %llu broken; device %llu -> %llu bytes; host %.1f -> %.1f MB\n",
           (unsigned long long)counts.reloads, (unsigned long long)counts.failures,
           (unsigned long long)before.device, (unsigned long long)after.device, before.host,
           after.host);
    assert_int_equal(before.device, after.device);
#ifndef __SANITIZE_ADDRESS__                   // which keeps what was freed
    assert_true(after.host < before.host + 8); // MB: between blocks in use the allocator keeps some
#endif
    assert_true(counts.reloads > (uint64_t)rounds / 4 && counts.failures > (uint64_t)rounds / 4);
    end(&k.s);
}

static void memory_stays_flat_through_a_thousand_reloads(void **state) {
    (void)state;
    const char *validate = getenv("ROIL_VALIDATE");
    char *kept = validate ? mem_copy(validate, strlen(validate) + 1) : NULL;
    unsetenv("ROIL_VALIDATE"); // for speed
    roil *r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR")});
    ok(r);
    soak_for(r, WARM, ROUNDS);
    roil_destroy(r);
    if (kept) setenv("ROIL_VALIDATE", kept, 1);
    mem_free(kept);
}

static void no_reload_gives_a_validation_message(void **state) {
    soak_for(*state, 10, VALIDATED);
    assert_int_equal(roil_validation_messages(*state), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_reload_gives_a_validation_message),
        cmocka_unit_test(memory_stays_flat_through_a_thousand_reloads),
    };
    return test_run(tests);
}
