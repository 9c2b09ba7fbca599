// What two effects cost in the frame of an engine, as layers on its device, against what each costs
// as a picture of the program's own, at the same size, frames, camera and settings.
//
//   bench_host [-s WIDTHxHEIGHT] [-f FIRST-LAST] [-t SECONDS] FAR.lua NEAR.lua
//
// Draws the frames over and over for so many seconds, each once the one before is done, and prints
// for each effect, twice: the time of its passes on the GPU, by roil_times; how long the device was
// at it, by timestamps of the engine before and after, with what it waited for the host; and the
// host's time in the calls of roil that draw it. All are medians of frames, of which the first
// quarter of a second is left out, since clocks of a GPU rise slowly. Then it draws them in a row,
// without waiting, and prints the time of a frame: that of the host or of the device, whichever is
// longer. A layer lacks what the picture has besides its media: surfaces, bloom, tone mapping.
//
// With ENGINE_BARE=1, since validation takes time.
#include <stdint.h>
static uint32_t width = 1920, height = 1080;
#define WIDTH width
#define HEIGHT height
#pragma GCC diagnostic ignored "-Wunused-function" // of what an engine has
#include "embed/engine_vulkan.h"
#include <roil_vulkan.h>
#include <time.h>
#include <unistd.h>

enum { MOST_FRAMES = 8192, MOST_PASSES = 48, MARKS = EFFECTS + 3 };

typedef struct row { // medians, of one effect drawn one way
    char pass[MOST_PASSES][64];
    double *times[MOST_PASSES]; // milliseconds, by frame
    size_t pass_count;
    double gpu[MOST_FRAMES], span[MOST_FRAMES];       // milliseconds
    double processor[MOST_FRAMES], wall[MOST_FRAMES]; // microseconds
    size_t count;
} row;

static roil *r;
static roil_effect *layered[EFFECTS], *own[EFFECTS];
static roil_view views[EFFECTS];
static row in_engine[EFFECTS], alone[EFFECTS];
static double whole[MOST_FRAMES], host_whole[MOST_FRAMES];
static double in_a_row[EFFECTS + 1];       // milliseconds of a frame
static VkCommandBuffer command_sets[2][2]; // of frames in turn: scene, composition
static uint64_t now;
static VkQueryPool marks;
static VkCommandBuffer mark_commands[MARKS];
static float nanoseconds; // of a tick

static void check(bool done) {
    if (!done) FAIL("%s", roil_error());
}

static double seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---- the engine -------------------------------------------------------------------------------

static void open_all(void) {
    static roil_vulkan_needs needs;
    VkPhysicalDeviceProperties named;
    open_instance();
    check(roil_vulkan_find_needs(vkGetInstanceProcAddr, instance, physical, &needs));
    float priority = 1;
    VkDeviceQueueCreateInfo queues = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &needs.features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queues,
                               .enabledExtensionCount = needs.extension_count,
                               .ppEnabledExtensionNames = needs.extensions};
    VK(vkCreateDevice(physical, &info, NULL, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);
    open_engine();
    vkGetPhysicalDeviceProperties(physical, &named);
    nanoseconds = named.limits.timestampPeriod;
    printf("%s, %u x %u\n", named.deviceName, width, height);
    const roil_vulkan vulkan = {.instance = instance,
                                .physical = physical,
                                .device = device,
                                .features = &needs.features,
                                .extensions = needs.extensions,
                                .extension_count = needs.extension_count};
    r = roil_create(&(roil_desc){.vulkan = &vulkan, .home = getenv("ROIL_SOURCE_DIR")});
    check(r);
    VkQueryPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                       .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                       .queryCount = MARKS};
    VK(vkCreateQueryPool(device, &pool_info, NULL, &marks));
    VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = pool,
                                            .commandBufferCount = MARKS};
    VK(vkAllocateCommandBuffers(device, &commands, mark_commands));
    command_sets[0][0] = scene_commands;
    command_sets[0][1] = compose_commands;
    commands.commandBufferCount = 2;
    VK(vkAllocateCommandBuffers(device, &commands, command_sets[1]));
}

static void mark(uint32_t index) {
    VkCommandBuffer commands = begin_commands(mark_commands[index]);
    vkCmdResetQueryPool(commands, marks, index, 1);
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, marks, index);
    submit(commands, now, now + 1);
    now++;
}

// Milliseconds from one mark to another, of a frame that is done.
static double between(uint32_t first, uint32_t last) {
    uint64_t ticks[MARKS];
    VK(vkGetQueryPoolResults(device, marks, 0, MARKS, sizeof ticks, ticks, sizeof *ticks,
                             VK_QUERY_RESULT_64_BIT));
    return 1e-6 * (double)nanoseconds * (double)(ticks[last] - ticks[first]);
}

static void cross(const float a[3], const float b[3], float out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalize(float v[3]) {
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
}

// The camera that the effect has by its script, with depths that are reversed.
static void place_camera(roil_effect *e, roil_view *v) {
    roil_camera c;
    float axes[3][3]; // right, up, back
    check(roil_get_camera(e, &c));
    for (int i = 0; i < 3; i++) axes[2][i] = c.eye[i] - c.target[i];
    normalize(axes[2]);
    cross((const float[3]){0, 0, 1}, axes[2], axes[0]);
    normalize(axes[0]);
    cross(axes[2], axes[0], axes[1]);
    memset(v, 0, sizeof *v);
    for (int y = 0; y < 3; y++)
        for (int i = 0; i < 3; i++) {
            v->view[4 * i + y] = axes[y][i];
            v->view[12 + y] -= axes[y][i] * c.eye[i];
        }
    v->view[15] = 1;
    const float half = tanf(c.fov * 3.14159265f / 360);
    v->projection[0] = 1 / (half * (float)WIDTH / (float)HEIGHT);
    v->projection[5] = -1 / half;
    v->projection[11] = -1;
    v->projection[14] = 0.1f;
}

static void draw_scene(const roil_view *view) {
    float clip[16] = {0};
    for (int c = 0; c < 4; c++)
        for (int y = 0; y < 4; y++)
            for (int k = 0; k < 4; k++)
                clip[4 * c + y] += view->projection[4 * k + y] * view->view[4 * c + k];
    VkCommandBuffer commands = begin_commands(scene_commands);
    relayout(commands, picture.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
             VK_IMAGE_ASPECT_COLOR_BIT);
    relayout(commands, depth.image, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_ASPECT_DEPTH_BIT);
    draw_triangles(commands, clip);
    submit(commands, now, now + 1);
    now++;
}

static void draw_layer(int i, double frame) {
    const roil_vulkan_semaphore wait = {timeline, now}, signal = {timeline, now + 1};
    roil_vulkan_frame f = {.waits = &wait, .wait_count = 1, .signals = &signal, .signal_count = 1};
    f.depth = (roil_vulkan_image){.image = depth.image,
                                  .format = deep,
                                  .width = WIDTH,
                                  .height = HEIGHT,
                                  .before = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                  .after = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    for (int k = 0; k < 2; k++)
        f.images[k] = (roil_vulkan_image){.image = layers[i][k].image,
                                          .format = hdr,
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .after = VK_IMAGE_LAYOUT_GENERAL};
    check(roil_set_view(layered[i], &views[i]) && roil_vulkan_render(layered[i], frame, &f));
    now++;
}

// ---- what is measured -------------------------------------------------------------------------

typedef struct watch {
    double processor, wall;
} watch;

static watch start(void) {
    return (watch){seconds(CLOCK_THREAD_CPUTIME_ID), seconds(CLOCK_MONOTONIC)};
}

static void stop(row *to, watch since) {
    to->processor[to->count] = 1e6 * (seconds(CLOCK_THREAD_CPUTIME_ID) - since.processor);
    to->wall[to->count] = 1e6 * (seconds(CLOCK_MONOTONIC) - since.wall);
}

// A pass that did nothing in a frame, or has not begun to, took no time in it.
static double *times_of(row *to, const char *pass) {
    for (size_t i = 0; i < to->pass_count; i++)
        if (strcmp(to->pass[i], pass) == 0) return to->times[i];
    if (to->pass_count == MOST_PASSES) FAIL("more passes than %d", MOST_PASSES);
    snprintf(to->pass[to->pass_count], sizeof *to->pass, "%.63s", pass);
    double *times = calloc(MOST_FRAMES, sizeof *times);
    if (!times) FAIL("no memory");
    return to->times[to->pass_count++] = times;
}

static void take_times(row *to, roil_effect *e, double span) {
    roil_time all[MOST_PASSES];
    size_t count = roil_times(e, all, MOST_PASSES);
    to->gpu[to->count] = 0;
    for (size_t i = 0; i < count && i < MOST_PASSES; i++) {
        times_of(to, all[i].pass)[to->count] = all[i].milliseconds;
        to->gpu[to->count] += all[i].milliseconds;
    }
    to->span[to->count] = span;
    to->count++;
}

static void draw_engine(double frame) {
    const size_t n = in_engine[0].count;
    watch since[EFFECTS];
    wait_for(now);
    const double begin = seconds(CLOCK_THREAD_CPUTIME_ID);
    mark(0);
    draw_scene(&views[0]);
    mark(1);
    for (int i = 0; i < EFFECTS; i++) {
        since[i] = start();
        draw_layer(i, frame);
        stop(&in_engine[i], since[i]);
        mark(2 + (uint32_t)i);
    }
    compose_layers(now, now + 1);
    now++;
    mark(MARKS - 1);
    host_whole[n] = 1e6 * (seconds(CLOCK_THREAD_CPUTIME_ID) - begin);
    wait_for(now);
    whole[n] = between(0, MARKS - 1);
    for (uint32_t i = 0; i < EFFECTS; i++)
        take_times(&in_engine[i], layered[i], between(1 + i, 2 + i));
}

// The picture of the program's own: marks stand around it on the one queue.
static void draw_own(int i, double frame) {
    wait_for(now);
    mark(0);
    const watch since = start();
    check(roil_render(own[i], frame));
    stop(&alone[i], since);
    for (uint32_t k = 1; k < MARKS; k++) mark(k);
    wait_for(now);
    take_times(&alone[i], own[i], between(0, 1));
}

static void forget(row *all) {
    all->count = 0;
    for (size_t i = 0; i < all->pass_count; i++)
        memset(all->times[i], 0, MOST_FRAMES * sizeof(double));
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count) {
    qsort(values, count, sizeof *values, by_size);
    return count ? values[count / 2] : 0;
}

static void print_row(const char *name, const char *how, row *all) {
    printf(
        "%s, %s: passes %.3f ms, device %.3f ms, host %.0f us of the processor, %.0f us in all\n",
        name, how, median(all->gpu, all->count), median(all->span, all->count),
        median(all->processor, all->count), median(all->wall, all->count));
    for (size_t i = 0; i < all->pass_count; i++)
        printf("    %-20s %8.3f ms\n", all->pass[i], median(all->times[i], all->count));
}

// ---- all of it --------------------------------------------------------------------------------

static void open_effect(int i, const char *file, double frame) {
    own[i] = roil_load(r, file, NULL, 0);
    layered[i] = own[i] ? roil_load(r, file, NULL, 0) : NULL;
    check(layered[i] && roil_make_layer(layered[i], NULL) &&
          roil_prepare(layered[i], WIDTH, HEIGHT) && roil_prepare(own[i], WIDTH, HEIGHT) &&
          roil_render(own[i], frame));
    place_camera(own[i], &views[i]);
}

// Once through the frames and then for so long, without waiting for more than the frame before the
// last. The same frames are in the mean of all.
static void measure_in_a_row(int which, double first, double last, double time) {
    uint64_t ends[2] = {now, now}, count = 0;
    double begin = 0;
    for (uint64_t turn = 0;; turn++) {
        const double frame = first + (double)(turn % (uint64_t)(last - first + 1));
        if (frame == first && turn > 0) {
            wait_for(ends[(turn - 1) % 2]);
            const double passed = seconds(CLOCK_MONOTONIC) - begin;
            if (count > 0) in_a_row[which] = 1e3 * passed / (double)count;
            if (count > 0 && passed > time) break;
            if (count == 0) begin = seconds(CLOCK_MONOTONIC);
        }
        if (begin > 0) count++;
        wait_for(ends[turn % 2]);
        scene_commands = command_sets[turn % 2][0];
        compose_commands = command_sets[turn % 2][1];
        if (which < EFFECTS) {
            check(roil_render(own[which], frame));
            begin_commands(scene_commands);
            submit(scene_commands, now, now + 1);
            now++;
        } else {
            draw_scene(&views[0]);
            for (int i = 0; i < EFFECTS; i++) draw_layer(i, frame);
            compose_layers(now, now + 1);
            now++;
        }
        ends[turn % 2] = now;
    }
    scene_commands = command_sets[0][0];
    compose_commands = command_sets[0][1];
}

// `which`: an effect by itself; EFFECTS: the engine's frame.
static void measure(int which, double first, double last, double time) {
    const double begin = seconds(CLOCK_MONOTONIC);
    row *rows = which < EFFECTS ? &alone[which] : in_engine;
    bool settled = false;
    for (double frame = first;; frame = frame < last ? frame + 1 : first) {
        const double passed = seconds(CLOCK_MONOTONIC) - begin;
        if (settled && (rows->count >= MOST_FRAMES || (passed > time && frame == first))) return;
        if (!settled && passed > 0.25 && frame == first) {
            for (int i = 0; i < (which < EFFECTS ? 1 : EFFECTS); i++) forget(&rows[i]);
            settled = true;
        }
        if (which < EFFECTS)
            draw_own(which, frame);
        else
            draw_engine(frame);
    }
}

int main(int argc, char **argv) {
    double first = 26, last = 45, time = 2;
    for (int c; (c = getopt(argc, argv, "s:f:t:")) != -1;) {
        if (c == 's' && sscanf(optarg, "%ux%u", &width, &height) != 2) FAIL("-s WIDTHxHEIGHT");
        if (c == 'f' && sscanf(optarg, "%lf-%lf", &first, &last) != 2) FAIL("-f FIRST-LAST");
        if (c == 't') time = atof(optarg);
        if (c == '?') return 2;
    }
    if (argc - optind != EFFECTS) FAIL("FAR.lua NEAR.lua are expected");
    open_all();
    for (int i = 0; i < EFFECTS; i++) open_effect(i, argv[optind + i], first);
    for (int i = 0; i <= EFFECTS; i++) {
        measure(i, first, last, time);
        measure_in_a_row(i, first, last, time);
    }
    for (int i = 0; i < EFFECTS; i++) {
        print_row(argv[optind + i], "as a layer", &in_engine[i]);
        print_row(argv[optind + i], "by itself", &alone[i]);
    }
    const size_t count = in_engine[0].count;
    printf("the engine's frame, of %zu: device %.3f ms, host %.0f us of the processor\n", count,
           median(whole, count), median(host_whole, count));
    printf("in a row: the engine's frame %.3f ms, the effects by themselves %.3f + %.3f ms\n",
           in_a_row[EFFECTS], in_a_row[0], in_a_row[1]);
    for (int i = 0; i < EFFECTS; i++) {
        roil_unload(layered[i]);
        roil_unload(own[i]);
    }
    roil_destroy(r);
    vkDestroyQueryPool(device, marks, NULL);
    close_engine();
    return complaints ? 2 : 0;
}
