// Shaders that are made to hang, exhaust or crash a compiler fail with a message; all others
// compile as they would in process.
#include "base/memory.h"
#include "reader_child.h"
#include "shader/compiler.h"
#include "shader_helper.h"
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

static const char output[] = "writeonly uniform image2D c; //= output r32f : x\n";

static int teardown(void **state) {
    compiler_set_limits(COMPILER_MILLISECONDS, COMPILER_MEGABYTES);
    return place_teardown(state);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, place_setup, teardown)

// Each macro is the one before, twice: 2^63 times the first.
static void add_bomb(strbuf *text, const char *first, const char *between) {
    strbuf_add(text, "#define A0 %s\n", first);
    for (int i = 1; i < 64; i++)
        strbuf_add(text, "#define A%d A%d%sA%d\n", i, i - 1, between, i - 1);
}

static void write_bomb(place *p, const char *name, const char *use) {
    strbuf text = {0};
    add_bomb(&text, "1", "+");
    strbuf_add(&text, "%s", use);
    place_write(p, name, text.text);
    strbuf_free(&text);
}

static void add_many(strbuf *text, const char *part, int times) {
    for (int i = 0; i < times; i++) strbuf_add(text, "%s", part);
}

static void a_macro_bomb_runs_out_of_time(void **state) {
    place *p = *state;
    compiler_set_limits(150, COMPILER_MEGABYTES);
    write_bomb(p, "effect/a.comp", "#if A63\n#endif\nvoid main() {}\n");
    place_refuses(p, "a.comp", "effect/a.comp: the compiler ran out of time (0.15 s)");
    write_bomb(p, "effect/lib/bomb.glsl", "int bomb() { return A63; }\n");
    place_write(p, "effect/b.comp", "#include \"lib/bomb.glsl\"\nvoid main() { bomb(); }\n");
    place_refuses(p, "b.comp", "effect/b.comp: the compiler ran out of ");
}

static void a_shader_that_needs_much_memory_runs_out_of_it(void **state) {
    place *p = *state;
    strbuf text = {0};
    strbuf_add(&text, "#define F0(x) x x\n");
    for (int i = 1; i < 20; i++) strbuf_add(&text, "#define F%d(x) F%d(F%d(x))\n", i, i - 1, i - 1);
    strbuf_add(&text, "void main() { F19(1;) }\n");
    place_write(p, "effect/a.comp", text.text);
    strbuf_free(&text);
    compiler_set_limits(1000, 32);
    place_refuses(p, "a.comp", "effect/a.comp: the compiler ran out of "); // sanitizers: of time
}

static void calls_that_double_are_refused(void **state) {
    place *p = *state;
    strbuf text = {0};
    strbuf_add(&text, "%svoid f0() { imageStore(c, ivec2(0), vec4(1)); }\n", output);
    for (int i = 1; i < 40; i++)
        strbuf_add(&text, "void f%d() { f%d(); f%d(); }\n", i, i - 1, i - 1);
    strbuf_add(&text, "void main() { f39(); }\n");
    place_write(p, "effect/a.comp", text.text);
    strbuf_free(&text);
    place_refuses(p, "a.comp", "effect/a.comp: with every call inlined");
}

static void calls_of_functions_that_follow_are_counted(void **state) {
    place *p = *state;
    shader_binary binary;
    strbuf text = {0};
    strbuf_add(&text, "%svoid last();\nvoid early() { last(); last(); }\n", output);
    strbuf_add(&text, "void main() { early(); last(); }\n"
                      "void last() { imageStore(c, ivec2(0), vec4(1)); }\n");
    place_write(p, "effect/a.comp", text.text);
    strbuf_free(&text);
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
}

static void deep_nesting_is_refused_or_compiled(void **state) {
    static const char *const cases[][4] = {
        {"void main() { float a = ", "(", "1", ")"}, {"void main() ", "{", "", "}"},
        {"void main() ", "{ if (true) ", ";", "}"},  {"#if ", "(", "1", ")"},
        {"void main() { int a = ", "-(", "1", ")"},  {"int a", "[2", "", "]"},
    };
    enum { DEPTH = 20000 };
    place *p = *state;
    compiler_set_limits(1000, 256);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        strbuf text = {0};
        strbuf_add(&text, "%s", cases[i][0]);
        add_many(&text, cases[i][1], DEPTH);
        strbuf_add(&text, "%s", cases[i][2]);
        add_many(&text, cases[i][3], DEPTH);
        place_write(p, "effect/a.comp", text.text);
        strbuf_free(&text);
        place_refuses(p, "a.comp", "effect/a.comp");
    }
}

// The conditions of #if are read by recursion, for which a million brackets are too many.
static void a_crash_is_a_message(void **state) {
    place *p = *state;
    strbuf text = {0};
    strbuf_add(&text, "#if ");
    add_many(&text, "((((((((((((((((((((", 200000);
    strbuf_add(&text, "\n#endif\nvoid main() {}\n");
    place_write(p, "effect/a.comp", text.text);
    strbuf_free(&text);
    place_refuses(p, "a.comp", "effect/a.comp: the compiler crashed (");
    place_write(p, "effect/a.comp", "void main() {}\n");
    shader_binary binary;
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
}

static void keep(void *user, const glsl_answer *answer) {
    glsl_answer *kept = user;
    *kept = *answer;
    kept->data = mem_copy(answer->data, answer->size + (answer->outcome != GLSL_DONE));
}

static void answers_are_those_of_a_compiler_in_process(void **state) {
    (void)state;
    static const char *const sources[] = {
        "#version 460\nlayout(r32f) uniform image2D c;\nuniform float x;\n"
        "void main() { imageStore(c, ivec2(0), vec4(sin(x))); }\n",
        "#version 460\nvoid main() { x }\n",
        "#version 460\nuniform float x = 1;\nvoid main() { float y = x; }\n",
        "#version 460\n",
        "",
    };
    for (size_t i = 0; i < COUNT_OF(sources); i++) {
        glsl_answer here, there;
        glsl_run(sources[i], SHADER_COMPUTE, keep, &here);
        assert_true(compiler_run(sources[i], &(compiler_order){SHADER_COMPUTE, true}, &there));
        assert_int_equal(here.outcome, there.outcome);
        assert_int_equal(here.size, there.size);
        assert_memory_equal(here.data, there.data, here.size);
        assert_int_equal(here.outcome == GLSL_DONE, i == 0);
        mem_free(here.data);
        mem_free(there.data);
    }
}

static void *compile_many(void *user) {
    static const char *const names[] = {"good.comp", "wrong.comp", "bomb.comp"};
    static const char *const parts[] = {NULL, "wrong.comp:1: ", "bomb.comp: the compiler ran out"};
    place *p = user;
    arena memory = {0};
    void *failed = NULL;
    for (int i = 0; i < 6; i++) {
        shader_binary binary;
        bool done = shader_compile(p->library, &memory,
                                   &(shader_compile_desc){.name = names[i % 3]}, &binary);
        const char *part = parts[i % 3];
        if (part ? done || !strstr(err_get(), part) : !done) failed = user;
    }
    arena_free(&memory);
    return failed;
}

static void threads_do_not_suffer_from_each_others_shaders(void **state) {
    place *p = *state;
    pthread_t threads[4];
    place_write(p, "effect/good.comp", "void main() {}\n");
    place_write(p, "effect/wrong.comp", "void main() { x }\n");
    write_bomb(p, "effect/bomb.comp", "#if A63\n#endif\nvoid main() {}\n");
    compiler_set_limits(100, COMPILER_MEGABYTES);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, compile_many, p), 0);
    for (int i = 0; i < 4; i++) {
        void *failed;
        pthread_join(threads[i], &failed);
        assert_null(failed);
    }
}

static void a_reader_that_was_killed_is_replaced(void **state) {
    place *p = *state;
    shader_binary binary;
    sigset_t all, before;
    place_write(p, "effect/a.comp", output);
    place_refuses(p, "a.comp", "Missing entry point");
    pid_t first = find_reader();
    if (!first) skip();
    // A host may do this with its signals.
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    void (*handler)(int) = signal(SIGCHLD, SIG_IGN);
    assert_int_equal(kill(first, SIGKILL), 0);
    place_write(p, "effect/a.comp", "void main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    pid_t second = find_reader();
    assert_int_not_equal(second, first);
    compiler_set_limits(100, COMPILER_MEGABYTES);
    write_bomb(p, "effect/bomb.comp", "#if A63\n#endif\nvoid main() {}\n");
    place_refuses(p, "bomb.comp", "ran out of time");
    assert_int_equal(find_reader(), second);
    signal(SIGCHLD, handler);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(a_macro_bomb_runs_out_of_time),
        TEST(a_shader_that_needs_much_memory_runs_out_of_it),
        TEST(calls_that_double_are_refused),
        TEST(calls_of_functions_that_follow_are_counted),
        TEST(deep_nesting_is_refused_or_compiled),
        TEST(a_crash_is_a_message),
        TEST(answers_are_those_of_a_compiler_in_process),
        TEST(threads_do_not_suffer_from_each_others_shaders),
        TEST(a_reader_that_was_killed_is_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
