// A device that hangs: who only asks whether a picture has arrived learns that it never will.
//
// In a child process, which takes the threads of the software driver with it when it ends; real
// devices are left alone.
#include "base/clock.h"
#include "roil_test.h"
#include <sys/wait.h>

enum { PATIENCE = 60 }; // seconds until the child counts as blocked

// Takes a minute: llvmpipe leaves loops, inner ones counted, after 65,535 turns in all.
static const char endless[] =
    "uniform float zero;               //= 0 [0, 1] : no compiler knows it\n"
    "writeonly uniform image2D color;  //= output rgba16f : nothing\n"
    "#define EIGHT(x) x x x x x x x x\n"
    "void main() {\n"
    "    float sum = 0.0;\n"
    "    for (float a = 0.0; a < 60000.0 + zero; a += 1.0) {\n"
    "        EIGHT(EIGHT(EIGHT(sum += sin(sum + a);)))\n"
    "    }\n"
    "    imageStore(color, ivec2(gl_GlobalInvocationID.xy), vec4(sum));\n"
    "}\n";

static const char effect[] = "local fx = effect { name = 'endless' }\n"
                             "fx.output = shader { 'endless.comp' }.color\n"
                             "return fx\n";

// NULL: there is none.
static const char *software(void) {
    static char index[16];
    gpu_info list[16];
    int count = gpu_list(list, (int)COUNT_OF(list));
    for (int i = 0; i < count && i < (int)COUNT_OF(list); i++) {
        snprintf(index, sizeof index, "%d", i);
        if (list[i].kind == GPU_CPU && list[i].usable) return index;
    }
    return NULL;
}

// For the child: says what is wrong and ends it.
#define need(condition)                                                                            \
    do {                                                                                           \
        if (condition) break;                                                                      \
        fprintf(stderr, "line %d: %s: '%s'\n", __LINE__, #condition, roil_error());                \
        _exit(1);                                                                                  \
    } while (0)

static void read_from_it(const char *path) {
    const char *device = software();
    if (!device) _exit(77);
    roil *r = roil_create(&(roil_desc){
        .device = device, .home = getenv("ROIL_SOURCE_DIR"), .validate = true, .timeout = 1});
    roil_effect *e = r ? roil_load(r, path, NULL, 0) : NULL;
    need(e && roil_prepare(e, 16, 16));
    need(roil_render(e, 1));
    roil_readback *b = roil_read_begin(e, NULL);
    float out[4 * 16 * 16];
    need(b && !roil_read_ready(b));
    const double began = clock_seconds();
    while (!roil_read_ready(b) && clock_seconds() - began < 10) usleep(10000);
    need(roil_read_ready(b) && roil_is_lost(r));
    need(!roil_read_end(b, out) && strstr(roil_error(), "finished no work in 1 s"));
    need(roil_validation_messages(r) == 0);
    roil_unload(e);
    roil_destroy(r);
    _exit(0);
}

static void who_waits_for_a_picture_learns_of_it(void **state) {
    (void)state;
    char path[512];
    int status = 0;
    write_text("endless.comp", endless, path);
    write_text("endless.lua", effect, path);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(PATIENCE);
        read_from_it(path);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) fail_msg("ended by signal %d", WTERMSIG(status));
    if (WEXITSTATUS(status) == 77) skip();
    assert_int_equal(WEXITSTATUS(status), 0);
}

static int make_folder(void **state) {
    const char *temporary = getenv("TMPDIR");
    snprintf(test_folder, sizeof test_folder, "%s/roil-test-XXXXXX",
             temporary ? temporary : "/tmp");
    *state = NULL;
    return mkdtemp(test_folder) ? 0 : 1;
}

static int remove_folder(void **state) {
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -r '%s'", test_folder);
    return system(command);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_waits_for_a_picture_learns_of_it),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
