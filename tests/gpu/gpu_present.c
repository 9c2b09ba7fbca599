// Showing images in a window, on an X server of the test's own: pixels arrive, and neither resizing
// nor hiding nor losing the surface is an error or a validation message.
#define GLFW_INCLUDE_NONE
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <GLFW/glfw3.h>
#include <X11/Xutil.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { W = 64, H = 48 };

// GLFW/glfw3native.h has them, but wants the headers of X extensions that nothing here needs.
Display *glfwGetX11Display(void);
Window glfwGetX11Window(GLFWwindow *window);

static GLFWwindow *window;
static int surfaces_made;
static bool refuse_surface;

// ---- the server -------------------------------------------------------------------------------

// Returns its process, or 0 when Xvfb is not installed. $DISPLAY names it.
static pid_t start_server(void) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return 0;
    pid_t server = fork();
    if (server == 0) {
        char fd[16];
        snprintf(fd, sizeof fd, "%d", pipe_ends[1]);
        close(pipe_ends[0]);
        prctl(PR_SET_PDEATHSIG, SIGKILL); // also when the test crashes
        execlp("Xvfb", "Xvfb", "-displayfd", fd, "-screen", "0", "640x480x24", "-nolisten", "tcp",
               (char *)NULL);
        _exit(127);
    }
    close(pipe_ends[1]);
    char display[16] = ":";
    ssize_t size = 0; // the server writes its number when it is ready, or closes the pipe
    while (size < 14 && read(pipe_ends[0], display + 1 + size, 1) == 1) {
        if (display[1 + size++] == '\n') break;
    }
    close(pipe_ends[0]);
    display[strcspn(display, "\n")] = '\0';
    setenv("DISPLAY", display, 1);
    if (size > 0) return server;
    waitpid(server, NULL, 0);
    return 0;
}

static void stop_server(pid_t server) {
    kill(server, SIGTERM);
    waitpid(server, NULL, 0);
}

// ---- the device -------------------------------------------------------------------------------

static bool make_surface(void *user, void *instance, void *surface) {
    if (refuse_surface) return err_set("not today");
    surfaces_made++;
    VkResult result = glfwCreateWindowSurface(instance, user, NULL, surface);
    return result == VK_SUCCESS || err_set("glfw gives error %d", (int)result);
}

static gpu_window describe_window(void) {
    gpu_window w = {.create_surface = make_surface, .user = window};
    w.extensions = glfwGetRequiredInstanceExtensions(&w.extension_count);
    assert_non_null(w.extensions);
    return w;
}

static void open_window(void) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window = glfwCreateWindow(W, H, "roil test", NULL, NULL);
    assert_non_null(window);
}

static int open_all(void **state) {
    open_window();
    gpu_window w = describe_window();
    gpu *g = gpu_create(&(gpu_desc){.validate = true, .window = &w});
    gpu_test_ok(g);
    *state = g;
    return 0;
}

static int close_all(void **state) {
    gpu_test_teardown(state);
    glfwDestroyWindow(window);
    return 0;
}

// ---- showing and looking ----------------------------------------------------------------------

static gpu_image *make_image(gpu *g, gpu_format format, uint32_t width, uint32_t height) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "picture",
                                                             .format = format,
                                                             .width = width,
                                                             .height = height,
                                                             .use = GPU_USE_SAMPLED});
    gpu_test_ok(image);
    return image;
}

static void show_changed(gpu *g, gpu_image *image, const gpu_area *changed, size_t count) {
    gpu_test_ok(gpu_frame_begin(g));
    gpu_test_ok(gpu_present(g, image, changed, count));
    gpu_test_ok(gpu_frame_end(g));
}

static void show(gpu *g, gpu_image *image) {
    show_changed(g, image, NULL, 0);
}

// As 0xrrggbb.
static uint32_t pixel(int x, int y) {
    Display *display = glfwGetX11Display();
    XImage *image = XGetImage(display, glfwGetX11Window(window), x, y, 1, 1, AllPlanes, ZPixmap);
    assert_non_null(image);
    uint32_t color = (uint32_t)XGetPixel(image, 0, 0) & 0xffffff;
    XDestroyImage(image);
    return color;
}

// A picture is on the screen some time after it was handed over: shows on until it is.
static void expect_pixel(gpu *g, gpu_image *image, int x, int y, uint32_t color) {
    for (int i = 0; i < 100; i++) {
        show(g, image);
        gpu_test_ok(gpu_idle(g));
        if (pixel(x, y) == color) return;
    }
    fail_msg("pixel %d,%d is %06x instead of %06x", x, y, pixel(x, y), color);
}

static void set_size(int width, int height) {
    glfwSetWindowSize(window, width, height);
    glfwPollEvents();
}

static gpu_image *make_ramp(gpu *g) {
    static uint8_t texels[H][W][4];
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            texels[y][x][0] = (uint8_t)(4 * x);
            texels[y][x][1] = (uint8_t)(5 * y);
            texels[y][x][2] = 77;
            texels[y][x][3] = 0; // the window is opaque all the same
        }
    }
    gpu_image *image = make_image(g, GPU_RGBA8, W, H);
    gpu_test_ok(gpu_image_write(g, image, 0, texels, sizeof texels));
    return image;
}

static gpu_image *make_plain_of(gpu *g, gpu_format format, const float color[4], uint32_t width,
                                uint32_t height) {
    gpu_image *image = make_image(g, format, width, height);
    gpu_test_ok(gpu_frame_begin(g));
    gpu_image_clear(g, image, color);
    gpu_test_ok(gpu_frame_end(g));
    return image;
}

static gpu_image *make_plain(gpu *g, gpu_format format, const float color[4]) {
    return make_plain_of(g, format, color, 3, 2);
}

// ---- tests ------------------------------------------------------------------------------------

static void pixels_arrive_one_by_one(void **state) {
    gpu *g = *state;
    set_size(W, H);
    gpu_image *ramp = make_ramp(g);
    expect_pixel(g, ramp, W - 1, H - 1, 0xfceb4d);
    for (int y = 0; y < H; y += 7) {
        for (int x = 0; x < W; x += 5) {
            assert_int_equal(pixel(x, y), (uint32_t)(4 * x) << 16 | (uint32_t)(5 * y) << 8 | 77);
        }
    }
    gpu_image_destroy(g, ramp);
}

static void pictures_follow_each_other(void **state) {
    gpu *g = *state;
    gpu_image *red = make_plain(g, GPU_RGBA8, (const float[4]){1, 0, 0, 1});
    gpu_image *half = make_plain(g, GPU_RGBA16F, (const float[4]){0, 0.6f, 2, 1});
    for (int i = 0; i < 20; i++) show(g, i % 2 ? red : half);
    expect_pixel(g, half, W / 2, H / 2, 0x0099ff); // floats are clamped, and scaled up here
    expect_pixel(g, red, W / 2, H / 2, 0xff0000);
    gpu_image_destroy(g, red);
    gpu_image_destroy(g, half);
}

static void window_changes_its_size(void **state) {
    static const int sizes[][2] = {{200, 100}, {1, 1},   {300, 7}, {2, 200},
                                   {1, 1},     {64, 48}, {65, 48}, {640, 480}};
    gpu *g = *state;
    gpu_image *ramp = make_ramp(g);
    gpu_image *blue = make_plain(g, GPU_RGBA8, (const float[4]){0, 0, 1, 1});
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        set_size(sizes[i][0], sizes[i][1]);
        for (int frame = 0; frame < 3; frame++) show(g, ramp);
        expect_pixel(g, blue, sizes[i][0] - 1, sizes[i][1] - 1, 0x0000ff);
        VkExtent2D size = g->window.swapchain->size;
        assert_true(size.width == (uint32_t)sizes[i][0] && size.height == (uint32_t)sizes[i][1]);
    }
    for (int i = 0; i < 40; i++) { // as when its corner is dragged: another size each frame
        set_size(100 + 3 * i, 90 + i % 7);
        show(g, ramp);
    }
    expect_pixel(g, blue, 100, 80, 0x0000ff);
    gpu_image_destroy(g, ramp);
    gpu_image_destroy(g, blue);
}

// Each image of the window gets what has changed since it was shown, and a software device copies
// no more than that: here the rest of the image is not as it is said to be.
static void what_has_changed_is_copied(void **state) {
    static const gpu_area changed[] = {{4, 8, 16, 10}, {40, 30, 4, 4}}, later = {50, 0, 3, 3};
    gpu *g = *state;
    set_size(W, H);
    gpu_image *red = make_plain_of(g, GPU_RGBA8, (const float[4]){1, 0, 0, 1}, W, H);
    gpu_image *blue = make_plain_of(g, GPU_RGBA8, (const float[4]){0, 0, 1, 1}, W, H);
    uint32_t rest = gpu_get_profile(g)->keeps_shown ? 0xff0000 : 0x0000ff;
    expect_pixel(g, red, 0, 0, 0xff0000);
    for (int i = 0; i < VK_MAX_SHOWN; i++) show(g, red);
    vk_swapchain *chain = g->window.swapchain; // a driver may lend one image again and again:
    for (uint32_t i = 0; i < chain->count; i++) chain->missing[i].count = 0; // as if all were shown
    show_changed(g, blue, changed, 2);
    for (uint32_t i = 0; i < chain->count; i++)
        assert_int_equal(chain->missing[i].count, i == g->window.image ? 0 : 2);
    show_changed(g, blue, &later, 1);
    for (int i = 0; i < 7; i++) { // with all images of the window in turn
        show_changed(g, blue, &later, 0);
        gpu_test_ok(gpu_idle(g));
        glfwWaitEventsTimeout(0.02); // a picture is on the screen some time later
        assert_int_equal(pixel(4, 8), 0x0000ff);
        assert_int_equal(pixel(19, 17), 0x0000ff);
        assert_int_equal(pixel(43, 33), 0x0000ff);
        assert_int_equal(pixel(51, 1), 0x0000ff);
        assert_int_equal(pixel(3, 8), rest);
        assert_int_equal(pixel(44, 33), rest);
        assert_int_equal(pixel(30, 25), rest); // between them
    }
    expect_pixel(g, blue, 3, 8, 0x0000ff);
    gpu_test_ok(gpu_frame_begin(g));
    assert_false(gpu_present(g, blue, &(gpu_area){W - 3, 0, 4, 4}, 1));
    assert_non_null(strstr(err_get(), "what has changed lies outside of it"));
    gpu_test_ok(gpu_frame_end(g));
    gpu_image_destroy(g, red);
    gpu_image_destroy(g, blue);
}

static void hidden_window_is_no_error(void **state) {
    gpu *g = *state;
    gpu_image *green = make_plain(g, GPU_RGBA8, (const float[4]){0, 1, 0, 1});
    glfwIconifyWindow(window);
    glfwPollEvents();
    for (int i = 0; i < 5; i++) show(g, green);
    glfwRestoreWindow(window);
    glfwHideWindow(window);
    glfwPollEvents();
    for (int i = 0; i < 5; i++) show(g, green);
    glfwShowWindow(window);
    glfwPollEvents();
    expect_pixel(g, green, 3, 3, 0x00ff00);
    gpu_image_destroy(g, green);
}

static void swapchain_is_replaced_when_it_does_not_fit(void **state) {
    gpu *g = *state;
    gpu_image *red = make_plain(g, GPU_RGBA8, (const float[4]){1, 0, 0, 1});
    for (int i = 0; i < 10; i++) {
        show(g, red);
        const vk_swapchain *old = g->window.swapchain;
        g->window.swapchain->stale = true; // what the driver's "out of date" sets
        show(g, red);
        assert_ptr_not_equal(g->window.swapchain, old);
    }
    expect_pixel(g, red, 0, 0, 0xff0000);
    gpu_image_destroy(g, red);
}

static void lost_surface_is_made_anew(void **state) {
    gpu *g = *state;
    gpu_image *green = make_plain(g, GPU_RGBA8, (const float[4]){0, 1, 0, 1});
    gpu_image *blue = make_plain(g, GPU_RGBA8, (const float[4]){0, 0, 1, 1});
    expect_pixel(g, green, 0, 0, 0x00ff00);
    int made = surfaces_made;
    g->window.lost = true; // what the driver's "surface lost" sets
    show(g, blue);         // passed over: the old one may still be in use
    expect_pixel(g, blue, 0, 0, 0x0000ff);
    assert_int_equal(surfaces_made, made + 1);

    refuse_surface = true;
    g->window.lost = true;
    show(g, blue);
    gpu_test_ok(gpu_idle(g));
    gpu_test_ok(gpu_frame_begin(g));
    assert_false(gpu_present(g, blue, NULL, 0));
    assert_string_equal(err_get(), "the window gives no surface to draw to: not today");
    refuse_surface = false;
    gpu_test_ok(gpu_frame_end(g));
    expect_pixel(g, green, 0, 0, 0x00ff00);
    gpu_image_destroy(g, green);
    gpu_image_destroy(g, blue);
}

static void expect_refusal(gpu *g, gpu_image *image, const char *part) {
    assert_false(gpu_present(g, image, NULL, 0));
    if (!strstr(err_get(), part)) fail_msg("'%s' does not say '%s'", err_get(), part);
}

static void what_cannot_be_shown_is_named(void **state) {
    gpu *g = *state;
    gpu_image *counts = make_image(g, GPU_R32U, 4, 4);
    gpu_image *plain = make_plain(g, GPU_RGBA8, (const float[4]){1, 1, 1, 1});
    expect_refusal(g, plain, "'picture' cannot be shown: no frame is open");
    gpu_test_ok(gpu_frame_begin(g));
    expect_refusal(g, counts, "'picture' (r32ui) cannot be shown; a 2D image of colours");
    gpu_test_ok(gpu_present(g, plain, NULL, 0));
    expect_refusal(g, plain, "the frame shows another one");
    gpu_test_ok(gpu_frame_end(g));
    gpu_image_destroy(g, counts);
    gpu_image_destroy(g, plain);

    gpu *blind = gpu_test_open(NULL);
    gpu_image *unseen = make_image(blind, GPU_RGBA8, 4, 4);
    gpu_test_ok(gpu_frame_begin(blind));
    expect_refusal(blind, unseen, "was created without a window");
    gpu_test_ok(gpu_frame_end(blind));
    gpu_image_destroy(blind, unseen);
    gpu_test_close(blind);
}

static void impossible_windows_are_refused(void **state) {
    (void)state;
    gpu_window w = describe_window();
    refuse_surface = true;
    assert_null(gpu_create(&(gpu_desc){.window = &w}));
    assert_string_equal(err_get(), "the window gives no surface to draw to: not today");
    refuse_surface = false;
    const char *extension = "VK_EXT_of_no_driver";
    w.extensions = &extension;
    w.extension_count = 1;
    assert_null(gpu_create(&(gpu_desc){.window = &w}));
    assert_non_null(strstr(err_get(), "VK_EXT_of_no_driver is missing"));
}

// ---- a hang -----------------------------------------------------------------------------------

// Software drivers wait inside the present call for the work of the frame. In a process of its own,
// which takes the driver's spinning threads with it when it ends: 0 when all is as it should be.
static int hang_while_showing(void) {
    static const gpu_slot slot = {.kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true};
    gpu_window w = describe_window();
    gpu *g = gpu_create(&(gpu_desc){.window = &w, .timeout = 1.0});
    gpu_test_ok(g);
    if (gpu_get_info(g)->kind != GPU_CPU) return 77;
    gpu_compute_desc desc = {.label = "endless",
                             .code = endless_comp_code,
                             .code_size = sizeof endless_comp_code,
                             .slots = &slot,
                             .slot_count = 1,
                             .local_size = {1, 1, 1}};
    gpu_pipeline *pipeline = gpu_pipeline_create_compute(g, &desc);
    gpu_binding data = {.buffer =
                            gpu_buffer_create(g, &(gpu_buffer_desc){.label = "data", .size = 8})};
    gpu_image *image = make_image(g, GPU_RGBA8, W, H);
    show(g, image);
    gpu_test_ok(gpu_frame_begin(g));
    gpu_pass_begin(g, "spin");
    gpu_buffer_fill(g, data.buffer, 0);
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = &data,
                                                     .binding_count = 1,
                                                     .threads = {65535, 65535, 65535}}));
    gpu_pass_end(g);
    gpu_test_ok(gpu_present(g, image, NULL, 0));
    bool told = !gpu_frame_end(g) && strstr(err_get(), "was lost in pass 'spin'");
    told = told && gpu_is_lost(g);
    gpu_destroy(g);
    return told ? 0 : 1;
}

static int main_of_hang(void) {
    alarm(30); // ends a call that blocks
    if (!glfwInit()) return 1;
    open_window();
    return hang_while_showing();
}

static void hang_is_noticed_while_showing(void **state) {
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        execl("/proc/self/exe", "gpu_present", "hang", (char *)NULL);
        _exit(127);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) fail_msg("ended by signal %d", WTERMSIG(status));
    if (WEXITSTATUS(status) == 77) skip();
    assert_int_equal(WEXITSTATUS(status), 0);
}

int main(int count, char **arguments) {
    (void)arguments;
    if (count > 1) _exit(main_of_hang());
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_arrive_one_by_one),
        cmocka_unit_test(pictures_follow_each_other),
        cmocka_unit_test(window_changes_its_size),
        cmocka_unit_test(what_has_changed_is_copied),
        cmocka_unit_test(hidden_window_is_no_error),
        cmocka_unit_test(swapchain_is_replaced_when_it_does_not_fit),
        cmocka_unit_test(lost_surface_is_made_anew),
        cmocka_unit_test(what_cannot_be_shown_is_named),
        cmocka_unit_test(impossible_windows_are_refused),
        cmocka_unit_test(hang_is_noticed_while_showing),
    };
    gpu_test_keep_driver();
    gpu_test_need_device();
    pid_t server = start_server();
    if (!server) {
        fprintf(stderr, "skipped: Xvfb does not start\n");
        return 77;
    }
    int failed = !glfwInit() || cmocka_run_group_tests(tests, open_all, close_all);
    glfwTerminate();
    stop_server(server);
    return failed || gpu_test_messages > 0;
}
