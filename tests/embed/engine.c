// An engine with a Vulkan device, a camera and a picture of its own, and two effects of roil in it:
// one behind a wall and one before. It draws 60 frames, or so many, and writes the last one:
//
//   engine FAR.lua NEAR.lua PICTURE.pfm [FRAMES]
//
// engine_vulkan.h has what every engine has; all that concerns roil is here. Both are C17 and
// C++20.
#include "engine_vulkan.h"
#include <roil_vulkan.h>

static roil *r;
static roil_effect *effects[EFFECTS];
static uint64_t now; // of the timeline, once all that was submitted is done
static long blocks;  // of memory that roil has, in all of its threads

static void *allocate_for_roil(void *user, void *block, size_t size) {
    (void)user;
    void *given = size ? realloc(block, size) : NULL;
    if (!size) free(block);
    if (!size || (given && !block)) __atomic_fetch_add(&blocks, size ? 1 : -1, __ATOMIC_RELAXED);
    return given;
}

// Validation tells what roil has left on the device.
static void close_all(void) {
    for (int i = 0; i < EFFECTS; i++) roil_unload(effects[i]);
    roil_destroy(r);
    close_engine();
    if (blocks) fprintf(stderr, "%ld blocks were not freed\n", blocks);
    if (blocks) complaints++;
}

static bool tell(void) {
    fprintf(stderr, "engine: %s\n", roil_error());
    return false;
}

static void stop(void) {
    close_all();
    exit(complaints ? 2 : 1);
}

// The device is the engine's own, made with what roil asks for besides.
static void open_roil(void) {
    static roil_vulkan_needs needs;
    const roil_allocator allocator = {.allocate = allocate_for_roil};
    if (!roil_set_allocator(&allocator)) FAIL("%s", roil_error());
    if (!roil_vulkan_find_needs(vkGetInstanceProcAddr, instance, physical, &needs))
        FAIL("%s", roil_error());
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
    roil_vulkan vulkan = {.get = vkGetInstanceProcAddr,
                          .instance = instance,
                          .physical = physical,
                          .device = device,
                          .features = &needs.features,
                          .extensions = needs.extensions,
                          .extension_count = needs.extension_count};
    open_engine(); // what is left of it
    const roil_desc desc = {.vulkan = &vulkan, .device_memory = getenv("ENGINE_MEMORY")};
    r = roil_create(&desc);
    if (r) return;
    tell();
    stop();
}

static void open_effect(int i, const char *file) {
    effects[i] = roil_load(r, file, NULL, 0);
    if (!effects[i] || !roil_make_layer(effects[i], NULL) ||
        !roil_prepare(effects[i], WIDTH, HEIGHT)) {
        tell();
        stop();
    }
}

// ---- a frame ----------------------------------------------------------------------------------

// A camera that circles the origin, as `orbit` of the effects does: z is up, y down in clip space,
// and depths are reversed, with no end.
static void place_camera(int frame, roil_view *view) {
    const float radians = 3.14159265f / 180, yaw = (-90 + 0.25f * (float)frame) * radians,
                pitch = 10 * radians;
    const float away = 7, half = tanf(22.5f * radians), near = 0.1f;
    const float back[3] = {cosf(pitch) * cosf(yaw), cosf(pitch) * sinf(yaw), sinf(pitch)};
    const float right[3] = {-sinf(yaw), cosf(yaw), 0};
    const float up[3] = {back[1] * right[2] - back[2] * right[1],
                         back[2] * right[0] - back[0] * right[2],
                         back[0] * right[1] - back[1] * right[0]};
    memset(view, 0, sizeof *view);
    for (int i = 0; i < 3; i++) {
        view->view[4 * i] = right[i];
        view->view[4 * i + 1] = up[i];
        view->view[4 * i + 2] = back[i];
    }
    view->view[14] = -away;
    view->view[15] = 1;
    view->projection[0] = 1 / (half * (float)WIDTH / (float)HEIGHT);
    view->projection[5] = -1 / half;
    view->projection[11] = -1;
    view->projection[14] = near;
}

// The engine's triangles, in the frame's picture and depths; `after` is signalled.
static void draw_scene(const roil_view *view, uint64_t after) {
    float clip[16] = {0};
    for (int c = 0; c < 4; c++)
        for (int row = 0; row < 4; row++)
            for (int k = 0; k < 4; k++)
                clip[4 * c + row] += view->projection[4 * k + row] * view->view[4 * c + k];
    VkCommandBuffer commands = begin_commands(scene_commands);
    relayout(commands, picture.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
             VK_IMAGE_ASPECT_COLOR_BIT);
    relayout(commands, depth.image, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_ASPECT_DEPTH_BIT);
    draw_triangles(commands, clip);
    submit(commands, 0, after);
}

// One effect into its two images, between the engine's own work, which goes on where it fails.
static bool draw_effect(int i, int frame, const roil_view *view, uint64_t before, uint64_t after) {
    const roil_vulkan_semaphore wait = {timeline, before}, signal = {timeline, after};
    roil_vulkan_frame f = {.waits = &wait, .signals = &signal, .wait_count = 1, .signal_count = 1};
    f.depth = (roil_vulkan_image){.image = depth.image,
                                  .format = deep,
                                  .width = WIDTH,
                                  .height = HEIGHT,
                                  .before = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                  .after = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    for (int k = 0; k < 2; k++) // ROIL_LAYER_COLOR, ROIL_LAYER_TRANSMITTANCE
        f.images[k] = (roil_vulkan_image){.image = layers[i][k].image,
                                          .format = hdr,
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .after = VK_IMAGE_LAYOUT_GENERAL};
    return (roil_set_view(effects[i], view) && roil_vulkan_render(effects[i], frame, &f)) || tell();
}

static bool draw_frame(int frame) {
    bool done = true;
    roil_view view;
    place_camera(frame, &view);
    wait_for(now);
    draw_scene(&view, ++now);
    for (int i = 0; i < EFFECTS && !roil_is_lost(r); i++, now++)
        if (!draw_effect(i, frame, &view, now, now + 1)) done = false;
    if (roil_is_lost(r)) { // what it was to signal never comes
        if (done) tell();  // found after the effects were drawn
        stop();
    }
    compose_layers(now, now + 1);
    now++;
    return done;
}

int main(int count, char **arguments) {
    if (count < 2 + EFFECTS) FAIL("FAR.lua NEAR.lua PICTURE.pfm are expected");
    const int frames = count > 2 + EFFECTS ? atoi(arguments[2 + EFFECTS]) : FRAMES;
    open_instance();
    open_roil();
    for (int i = 0; i < EFFECTS; i++) open_effect(i, arguments[1 + i]);
    for (int frame = 0; frame < frames; frame++) // one that failed is drawn again, once
        if (!draw_frame(frame) && !draw_frame(frame)) stop();
    wait_for(now);
    write_picture(arguments[1 + EFFECTS]);
    close_all();
    return complaints ? 2 : 0;
}
