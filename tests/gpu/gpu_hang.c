// Work that does not end: it is noticed in time, told with the pass it is in, and blocks nothing,
// not even the destruction of its device.
//
// Each case runs in a child process, which takes the threads of the software driver with it when it
// ends; real devices are left alone.
#include "base/clock.h"
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATIENCE = 60 }; // seconds until a child counts as blocked

typedef struct stuck {
    gpu *g;
    gpu_pipeline *pipeline;
    gpu_buffer *buffer;
} stuck;

// For the child: says what is wrong and ends it.
#define need(condition)                                                                            \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: %s: '%s'\n", __func__, __LINE__, #condition, err_get());       \
            _exit(1);                                                                              \
        }                                                                                          \
    } while (0)

// False when there is none.
static bool find_software(char index[16]) {
    gpu_info list[16];
    int count = gpu_list(list, (int)COUNT_OF(list));
    for (int i = 0; i < count && i < (int)COUNT_OF(list); i++) {
        snprintf(index, 16, "%d", i);
        if (list[i].kind == GPU_CPU && list[i].usable) return true;
    }
    return false;
}

static stuck open_stuck(double timeout) {
    static const gpu_slot slots[] = {
        {.binding = 0, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    char index[16];
    if (!find_software(index)) _exit(77);
    stuck s = {.g = gpu_create(&(gpu_desc){.device = index, .validate = true, .timeout = timeout})};
    need(s.g);
    s.buffer = gpu_buffer_create(s.g, &(gpu_buffer_desc){.label = "data", .size = 8});
    s.pipeline =
        gpu_pipeline_create_compute(s.g, &(gpu_compute_desc){.label = "endless",
                                                             .code = endless_comp_code,
                                                             .code_size = sizeof endless_comp_code,
                                                             .slots = slots,
                                                             .slot_count = 1,
                                                             .local_size = {1, 1, 1}});
    need(s.buffer && s.pipeline);
    return s;
}

// llvmpipe leaves any loop after 65,535 turns, as the shader does on all devices, so there must be
// many loops. `groups` cubed.
static void dispatch(stuck *s, uint32_t groups) {
    gpu_binding binding = {.binding = 0, .buffer = s->buffer};
    need(gpu_dispatch(s->g, &(gpu_dispatch_desc){.pipeline = s->pipeline,
                                                 .bindings = &binding,
                                                 .binding_count = 1,
                                                 .threads = {groups, groups, groups}}));
}

// Three passes, of which the second never ends.
static uint64_t submit_endless(stuck *s) {
    uint64_t frame = gpu_frame_begin(s->g);
    need(frame);
    gpu_pass_begin(s->g, "before");
    gpu_buffer_fill(s->g, s->buffer, 0);
    gpu_pass_end(s->g);
    gpu_pass_begin(s->g, "spin");
    dispatch(s, 65535);
    gpu_pass_end(s->g);
    gpu_pass_begin(s->g, "after");
    gpu_buffer_fill(s->g, s->buffer, 1);
    gpu_pass_end(s->g);
    need(gpu_frame_end(s->g));
    return frame;
}

static uint64_t submit_short(stuck *s) {
    uint64_t frame = gpu_frame_begin(s->g);
    need(frame);
    gpu_pass_begin(s->g, "short");
    gpu_buffer_fill(s->g, s->buffer, 0);
    gpu_pass_end(s->g);
    need(gpu_frame_end(s->g));
    return frame;
}

static void need_lost_within(stuck *s, double began, double seconds) {
    need(clock_seconds() - began < seconds);
    need(gpu_is_lost(s->g));
    need(strstr(err_get(), "was lost in pass 'spin'"));
    need(strstr(err_get(), "finished no work in 1 s"));
    need(gpu_frame_begin(s->g) == 0);
    need(strstr(err_get(), "in pass 'spin'")); // told by every later call too
    need(gpu_validation_messages(s->g) == 0);
}

static void destroy_all(stuck *s) {
    gpu_pipeline_destroy(s->g, s->pipeline);
    gpu_buffer_destroy(s->g, s->buffer);
    gpu_destroy(s->g);
}

static void child_waits_for_a_frame(void) {
    stuck s = open_stuck(1.0);
    need(gpu_frame_wait(s.g, submit_short(&s)));
    need(!gpu_is_lost(s.g));
    double began = clock_seconds();
    need(!gpu_frame_wait(s.g, submit_endless(&s)));
    need_lost_within(&s, began, 10.0);
    destroy_all(&s);
}

static void child_begins_frames(void) {
    stuck s = open_stuck(1.0);
    submit_endless(&s);
    for (int i = 1; i < GPU_FRAMES_IN_FLIGHT; i++) submit_short(&s);
    double began = clock_seconds();
    need(gpu_frame_begin(s.g) == 0);
    need_lost_within(&s, began, 10.0);
    destroy_all(&s);
}

static void child_reads_back(void) {
    stuck s = open_stuck(1.0);
    submit_endless(&s);
    double began = clock_seconds();
    uint32_t word;
    need(!gpu_buffer_read(s.g, s.buffer, 0, &word, sizeof word));
    need_lost_within(&s, began, 10.0);
    destroy_all(&s);
}

static void child_asks_for_times(void) {
    stuck s = open_stuck(1.0);
    uint64_t frame = submit_short(&s);
    need(gpu_frame_wait(s.g, frame));
    submit_endless(&s);
    double began = clock_seconds();
    gpu_pass_time time;
    gpu_frame_times(s.g, frame, &time,
                    1); // real drivers answer at once, software ones wait for all
    need(!gpu_idle(s.g));
    need_lost_within(&s, began, 10.0);
    destroy_all(&s);
}

// Nobody has noticed yet when the device is destroyed.
static void child_just_leaves(void) {
    stuck s = open_stuck(1.0);
    submit_endless(&s);
    destroy_all(&s);
}

static void child_gets_another_device(void) {
    stuck s = open_stuck(1.0);
    need(!gpu_frame_wait(s.g, submit_endless(&s)));
    destroy_all(&s);
    s = open_stuck(1.0);
    uint32_t word = 1;
    submit_short(&s);
    need(gpu_buffer_read(s.g, s.buffer, 0, &word, sizeof word) && word == 0);
    need(gpu_validation_messages(s.g) == 0);
    destroy_all(&s);
}

// The same work between frames, where gpu_dispatch may not be called: in a submission of its own.
static void submit_between_frames(stuck *s, uint32_t groups) {
    gpu_binding binding = {.binding = 0, .buffer = s->buffer};
    VkCommandBuffer commands = vk_commands(s->g);
    need(commands);
    vk_uses_begin(s->g);
    need(vk_bindings_use(s->g, s->pipeline, &binding, 1));
    vk_uses_flush(s->g, commands);
    s->g->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, s->pipeline->built->handle);
    need(vk_bindings_bind(s->g, commands, s->pipeline, &binding, 1));
    s->g->vk.CmdDispatch(commands, groups, groups, groups);
    need(vk_flush(s->g));
}

// Six submissions are waited for at once: each is done in a third of the timeout, all together take
// twice the timeout.
static void child_is_only_slow(void) {
    stuck s = open_stuck(30.0);
    gpu_buffer_fill(s.g, s.buffer, 0);
    double took = 0.0;
    uint32_t groups = 1;
    while (took < 0.3) { // what takes this machine about that long?
        double began = clock_seconds();
        submit_between_frames(&s, ++groups);
        need(gpu_idle(s.g));
        took = clock_seconds() - began;
    }
    s.g->timeout = (uint64_t)(3e9 * took);
    for (int i = 0; i < VK_BATCHES; i++) submit_between_frames(&s, groups);
    for (int i = 0; i < GPU_FRAMES_IN_FLIGHT; i++) {
        need(gpu_frame_begin(s.g));
        dispatch(&s, groups);
        need(gpu_frame_end(s.g));
    }
    need(gpu_idle(s.g));
    need(gpu_validation_messages(s.g) == 0);
    destroy_all(&s);
}

static void expect_child(void (*run)(void)) {
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(PATIENCE); // a call that blocks ends the child by a signal
        run();
        _exit(0);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) fail_msg("ended by signal %d", WTERMSIG(status));
    if (WEXITSTATUS(status) == 77) skip();
    assert_int_equal(WEXITSTATUS(status), 0);
}

#define HANG_TEST(name)                                                                            \
    static void name(void **state) {                                                               \
        (void)state;                                                                               \
        expect_child(child_##name);                                                                \
    }
HANG_TEST(waits_for_a_frame)
HANG_TEST(begins_frames)
HANG_TEST(reads_back)
HANG_TEST(asks_for_times)
HANG_TEST(just_leaves)
HANG_TEST(gets_another_device)
HANG_TEST(is_only_slow)

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(waits_for_a_frame), cmocka_unit_test(begins_frames),
        cmocka_unit_test(reads_back),        cmocka_unit_test(asks_for_times),
        cmocka_unit_test(just_leaves),       cmocka_unit_test(gets_another_device),
        cmocka_unit_test(is_only_slow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
