// roil on a host's Vulkan device: what it needs, the lock of the queue, the host's depths, formats
// and layouts, failures, images for other processes, and a limit on the device's memory.
#pragma GCC diagnostic ignored "-Wunused-function" // an engine uses more of it
#include "embed/engine_vulkan.h"

#include "roil_test.h"
#include "roil_vulkan.h"
#include <pthread.h>

// A ball of smoke, 4.2 m to 5.8 m before the camera of `straight`.
static const char ball[] =
    "local fx = effect { name = 'ball', fps = 10, first = 0 }\n"
    "local b = sphere { radius = 0.8 }\n"
    "local smoke = march { density = b * 20, albedo = {0, 0, 0}, emission = b * vec(8, 4, 2),\n"
    "                      steps = 16 }\n"
    "fx.camera = camera { eye = function(t) assert(t < 1, 'no time left'); return {0, -5, 0} end,\n"
    "                     target = {0, 0, 0} }\n"
    "fx.output = final { smoke }.color\n"
    "return fx\n";

static roil_vulkan_needs needs;
static struct { int locked, unlocked; } lock_count;

static void lock(void *user, uint32_t family, uint32_t index) {
    (void)user;
    assert_true(family == 0 && index == 0 && lock_count.locked == lock_count.unlocked);
    lock_count.locked++;
}

static void unlock(void *user, uint32_t family, uint32_t index) {
    (void)user, (void)family, (void)index;
    lock_count.unlocked++;
}

static roil_vulkan host(void) {
    return (roil_vulkan){.get = vkGetInstanceProcAddr,
                         .instance = instance,
                         .physical = physical,
                         .device = device,
                         .features = &needs.features,
                         .extensions = needs.extensions,
                         .extension_count = needs.extension_count,
                         .labels = !getenv("ENGINE_BARE"),
                         .lock = lock,
                         .unlock = unlock};
}

static roil *open_roil(const char *memory) {
    const roil_vulkan vulkan = host();
    return roil_create(&(roil_desc){
        .vulkan = &vulkan, .home = getenv("ROIL_SOURCE_DIR"), .device_memory = memory});
}

static roil_view seen;

static roil_effect *open_ball(roil *r) {
    roil_effect *e = load_text(r, "ball.lua", ball);
    ok(roil_make_layer(e, NULL));
    ok(roil_prepare(e, WIDTH, HEIGHT));
    const float half = tanf(20 * 3.14159265f / 180);
    roil_view v = {.view = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, -5, 1}};
    v.projection[0] = 1 / (half * WIDTH / HEIGHT);
    v.projection[5] = -1 / half;
    v.projection[11] = -1;
    v.projection[14] = 0.1f; // depths are reversed: 0.1 / m
    seen = v;
    ok(roil_set_view(e, &v));
    return e;
}

static uint64_t now; // of the timeline

static roil_vulkan_image image_of(const image *i, VkImageLayout before, VkImageLayout after) {
    return (roil_vulkan_image){i->image, hdr, WIDTH, HEIGHT, before, after, false};
}

static VkImageAspectFlags aspect_of(VkFormat format) {
    return format >= VK_FORMAT_D16_UNORM_S8_UINT
               ? VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT
               : VK_IMAGE_ASPECT_DEPTH_BIT;
}

// The depth buffer is one wall, so many metres away.
static void clear_depth(const roil_vulkan_image *i, float metres, uint64_t after) {
    VkCommandBuffer commands = begin_commands(scene_commands);
    VkImageSubresourceRange range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    VkClearDepthStencilValue value = {seen.projection[14] / metres - seen.projection[10], 0};
    relayout(commands, i->image, VK_IMAGE_LAYOUT_UNDEFINED, i->before, aspect_of(i->format));
    vkCmdClearDepthStencilImage(commands, i->image, i->before, &value, 1, &range);
    submit(commands, 0, after);
}

// Draws behind a wall of depths of a format into the colour of a layer, which is left in a layout
// to be copied from.
static bool draw_behind(roil_effect *e, double frame, const image *walls, VkFormat format,
                        VkImageLayout after, float metres) {
    const roil_vulkan_semaphore wait = {timeline, now + 1}, signal = {timeline, now + 2};
    roil_vulkan_frame f = {.waits = &wait, .wait_count = 1, .signals = &signal, .signal_count = 1};
    f.depth = image_of(walls, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, after);
    f.depth.format = format;
    clear_depth(&f.depth, metres, now + 1);
    f.images[ROIL_LAYER_COLOR] =
        image_of(&layers[0][0], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    f.images[ROIL_LAYER_TRANSMITTANCE] =
        image_of(&layers[0][1], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    bool done = roil_vulkan_render(e, frame, &f);
    now += 2;
    return done;
}

static bool draw(roil_effect *e, double frame, float wall) {
    return draw_behind(e, frame, &depth, deep, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                       wall);
}

// Red in the middle of an image of halves.
static float middle(VkImage what, VkImageLayout layout) {
    uint16_t *halves;
    VkCommandBuffer commands = begin_commands(compose_commands);
    relayout(commands, what, layout, layout, VK_IMAGE_ASPECT_COLOR_BIT);
    copy_to_host(commands, what, layout);
    submit(commands, now, now + 1);
    wait_for(++now);
    VK(vkMapMemory(device, host_memory, 0, VK_WHOLE_SIZE, 0, (void **)&halves));
    const float red = from_half(halves[4 * (HEIGHT / 2 * WIDTH + WIDTH / 2)]);
    vkUnmapMemory(device, host_memory);
    return red;
}

static float color_now(void) {
    return middle(layers[0][0].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

static void what_a_device_lacks_is_named(void **state) {
    (void)state;
    roil_vulkan_needs without = needs;
    without.features.pNext = &without.v11;
    without.v11.pNext = &without.v12;
    without.v12.pNext = &without.v13;
    without.v13.synchronization2 = VK_FALSE;
    roil_vulkan vulkan = host();
    vulkan.features = &without.features;
    expect_error(roil_create(&(roil_desc){.vulkan = &vulkan}), "it lacks synchronization2");
    // The feature's own struct, of before 1.3, says it as well; and then nothing is missing.
    VkPhysicalDeviceSynchronization2Features apart = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
        .synchronization2 = VK_TRUE};
    without.v13.pNext = &apart;
    roil *r = roil_create(&(roil_desc){.vulkan = &vulkan, .home = getenv("ROIL_SOURCE_DIR")});
    ok(r);
    roil_destroy(r);
    vulkan = host();
    vulkan.index = 999;
    expect_error(roil_create(&(roil_desc){.vulkan = &vulkan}), "no queue 999 of family 0");
    vulkan = host();
    vulkan.unlock = NULL;
    expect_error(roil_create(&(roil_desc){.vulkan = &vulkan}), "`lock` and `unlock` go together");
}

static void walls_hide_what_is_behind_them(void **state) {
    (void)state;
    roil *r = open_roil(NULL);
    ok(r);
    roil_effect *e = open_ball(r);
    ok(draw(e, 0, 9));
    const float whole = color_now();
    ok(draw(e, 1, 4.3f));
    const float part = color_now();
    ok(draw(e, 2, 4));
    assert_true(whole > 0.3f);
    assert_true(part > 0.05f * whole && part < 0.95f * whole);
    assert_true(color_now() == 0);
    seen.projection[10] = -20 / 19.9f; // ordinary, from 0.1 m to 20 m
    seen.projection[14] = -2 / 19.9f;
    ok(roil_set_view(e, &seen));
    ok(draw(e, 0, 4.3f));
    assert_true(fabsf(color_now() - part) < 0.02f * whole);
    ok(draw(e, 1, 4));
    assert_true(color_now() == 0);
    assert_true(lock_count.locked > 3 && lock_count.locked == lock_count.unlocked);
    roil_unload(e);
    roil_destroy(r);
}

static bool has_depths(VkFormat format) {
    const VkFormatFeatureFlags wanted = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                        VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                        VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    VkFormatProperties p;
    vkGetPhysicalDeviceFormatProperties(physical, format, &p);
    return (p.optimalTilingFeatures & wanted) == wanted;
}

// A stencil stays in its own layout where the depths have one of theirs.
static void depths_of_every_format_are_read(void **state) {
    (void)state;
    roil *r = open_roil(NULL);
    ok(r);
    roil_effect *e = open_ball(r);
    ok(draw(e, 0, 4.3f));
    const float expected = color_now();
    for (VkFormat format = VK_FORMAT_D16_UNORM; format <= VK_FORMAT_D32_SFLOAT_S8_UINT; format++) {
        if (format == VK_FORMAT_S8_UINT) continue;
        if (!has_depths(format)) print_message("no depths of format %d here\n", (int)format);
        if (!has_depths(format)) continue;
        image walls =
            make_image(format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                       aspect_of(format));
        ok(draw_behind(e, 1, &walls, format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 4.3f));
        assert_true(fabsf(color_now() - expected) < 0.02f * expected);
        if (needs.v12.separateDepthStencilLayouts &&
            aspect_of(format) & VK_IMAGE_ASPECT_STENCIL_BIT) {
            ok(draw_behind(e, 2, &walls, format, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, 4.3f));
            assert_true(fabsf(color_now() - expected) < 0.02f * expected);
            relayout(begin_commands(scene_commands), walls.image,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_ASPECT_STENCIL_BIT);
            submit(scene_commands, now, now + 1);
            wait_for(++now);
        }
        destroy_image(&walls);
    }
    roil_unload(e);
    roil_destroy(r);
}

// A script's mistake in a frame: the images come back all the same, and nobody waits for ever.
static void what_fails_is_given_back(void **state) {
    (void)state;
    roil *r = open_roil(NULL);
    ok(r);
    roil_effect *e = open_ball(r);
    expect_error(draw(e, 12, 9), "no time left");
    color_now(); // in the layout that it was to have, once the timeline has come there
    ok(draw(e, 0, 9));
    assert_true(color_now() > 0.3f);
    roil_vulkan_frame f = {0};
    f.images[ROIL_LAYER_MOTION] =
        image_of(&layers[0][0], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    expect_error(roil_vulkan_render(e, 0, &f), "roil_layer_desc did not ask for it");
    f = (roil_vulkan_frame){
        .images[ROIL_LAYER_COLOR] =
            image_of(&layers[0][0], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED)};
    expect_error(roil_vulkan_render(e, 0, &f), "a layout that no image can be given");
    f.images[ROIL_LAYER_COLOR].after = VK_IMAGE_LAYOUT_GENERAL;
    f.images[ROIL_LAYER_COLOR].format = VK_FORMAT_R16G16B16A16_UINT;
    expect_error(roil_vulkan_render(e, 0, &f), "cannot convert rgba16f to Vulkan format 95");
    f.images[ROIL_LAYER_COLOR].image = depth.image;
    f.images[ROIL_LAYER_COLOR].format = deep;
    expect_error(roil_vulkan_render(e, 0, &f), "cannot convert rgba16f to Vulkan format 126");
    f = (roil_vulkan_frame){.wait_count = 9};
    expect_error(roil_vulkan_render(e, 0, &f), "9 semaphores to wait for");
    roil_unload(e);
    roil_destroy(r);
}

static bool refuses; // submissions of roil's

static VKAPI_ATTR VkResult VKAPI_CALL submit_or_refuse(VkQueue to, uint32_t count,
                                                       const VkSubmitInfo2 *infos, VkFence fence) {
    return refuses ? VK_ERROR_OUT_OF_HOST_MEMORY : vkQueueSubmit2(to, count, infos, fence);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice of, const char *name) {
    return strcmp(name, "vkQueueSubmit2") == 0 ? (PFN_vkVoidFunction)submit_or_refuse
                                               : vkGetDeviceProcAddr(of, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_instance(VkInstance of, const char *name) {
    return strcmp(name, "vkGetDeviceProcAddr") == 0 ? (PFN_vkVoidFunction)get_of_device
                                                    : vkGetInstanceProcAddr(of, name);
}

static void *signal_later(void *user) {
    const VkSemaphoreSignalInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO,
                                        .semaphore = timeline,
                                        .value = *(const uint64_t *)user};
    usleep(300000);
    VK(vkSignalSemaphore(device, &info));
    return NULL;
}

// Nothing is destroyed that a frame before is still at: here it waits for the host.
static void what_is_at_work_is_waited_for_when_no_more_is_taken(void **state) {
    (void)state;
    roil_vulkan vulkan = host();
    vulkan.get = get_of_instance;
    roil *r = roil_create(&(roil_desc){.vulkan = &vulkan, .home = getenv("ROIL_SOURCE_DIR")});
    ok(r);
    roil_effect *e = open_ball(r);
    const roil_vulkan_semaphore wait = {timeline, now + 1}, signal = {timeline, now + 2};
    roil_vulkan_frame f = {.waits = &wait, .wait_count = 1, .signals = &signal, .signal_count = 1};
    ok(roil_vulkan_render(e, 0, &f));
    refuses = true;
    expect_error(roil_vulkan_render(e, 1, &(roil_vulkan_frame){0}), "has no host memory left");
    refuses = false;
    assert_true(roil_is_lost(r));
    pthread_t thread;
    uint64_t value = now + 1;
    assert_int_equal(pthread_create(&thread, NULL, signal_later, &value), 0);
    roil_unload(e);
    roil_destroy(r);
    pthread_join(thread, NULL);
    now += 2;
}

// ---- other processes: this test's device stands for that of one, and roil has its own ----------

static VkImage import_image(const roil_vulkan_shared *from, VkDeviceMemory *memory) {
    VkImage out;
    VkExternalMemoryImageCreateInfo by = {
        .sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO,
        .handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .pNext = &by,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = from->image.format,
                              .extent = {from->image.width, from->image.height, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                       VK_IMAGE_USAGE_SAMPLED_BIT};
    VK(vkCreateImage(device, &info, NULL, &out));
    VkMemoryDedicatedAllocateInfo own = {.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                         .image = out};
    VkImportMemoryFdInfoKHR fd = {.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR,
                                  .pNext = &own,
                                  .handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT,
                                  .fd = from->fd};
    VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .pNext = &fd,
                                       .allocationSize = from->size,
                                       .memoryTypeIndex = from->memory_type};
    VK(vkAllocateMemory(device, &allocation, NULL, memory));
    VK(vkBindImageMemory(device, out, *memory, 0));
    return out;
}

static VkSemaphore import_semaphore(const roil_vulkan_shared *from) {
    VkSemaphore out;
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    VK(vkCreateSemaphore(device, &info, NULL, &out));
    VkImportSemaphoreFdInfoKHR fd = {.sType = VK_STRUCTURE_TYPE_IMPORT_SEMAPHORE_FD_INFO_KHR,
                                     .semaphore = out,
                                     .handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT,
                                     .fd = from->fd};
    PFN_vkImportSemaphoreFdKHR import =
        (PFN_vkImportSemaphoreFdKHR)vkGetDeviceProcAddr(device, "vkImportSemaphoreFdKHR");
    assert_non_null(import);
    VK(import(device, &fd));
    return out;
}

// Acquires the image and copies it to the host's memory: once `shared` has come to `from`, and then
// it comes to `from + 1`; VK_NULL_HANDLE: at once.
static void begin_reading(VkImage what, VkSemaphore shared, uint64_t from) {
    VkCommandBuffer commands = begin_commands(compose_commands);
    VkImageMemoryBarrier2 acquire = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                     .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                     .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT,
                                     .oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                     .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL,
                                     .dstQueueFamilyIndex = 0,
                                     .image = what,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .imageMemoryBarrierCount = 1,
                             .pImageMemoryBarriers = &acquire};
    vkCmdPipelineBarrier2(commands, &info);
    copy_to_host(commands, what, VK_IMAGE_LAYOUT_GENERAL);
    VK(vkEndCommandBuffer(commands));
    VkCommandBufferSubmitInfo one = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                     .commandBuffer = commands};
    VkSemaphoreSubmitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                  .semaphore = shared,
                                  .value = from,
                                  .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    VkSemaphoreSubmitInfo signals[] = {wait, wait};
    signals[0].semaphore = timeline;
    signals[0].value = ++now;
    signals[1].value = from + 1;
    VkSubmitInfo2 all = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                         .waitSemaphoreInfoCount = shared ? 1 : 0,
                         .pWaitSemaphoreInfos = &wait,
                         .commandBufferInfoCount = 1,
                         .pCommandBufferInfos = &one,
                         .signalSemaphoreInfoCount = shared ? 2 : 1,
                         .pSignalSemaphoreInfos = signals};
    VK(vkQueueSubmit2(queue, 1, &all, NULL));
}

// What begin_reading has read is this frame, in every pixel.
static void expect_frame(const float *frame) {
    uint16_t *halves;
    assert_true(frame[4 * (HEIGHT / 2 * WIDTH + WIDTH / 2)] > 0.3f);
    wait_for(now);
    VK(vkMapMemory(device, host_memory, 0, VK_WHOLE_SIZE, 0, (void **)&halves));
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        if (from_half(halves[i]) != frame[i])
            fail_msg("channel %d of pixel %d, %d: %g of the other device is %g here", i % 4,
                     i / 4 % WIDTH, i / 4 / WIDTH, (double)from_half(halves[i]), (double)frame[i]);
    vkUnmapMemory(device, host_memory);
}

// Two frames, of which each is drawn once the one before was read, and read once it was drawn: by
// the semaphore, for which the other device waits before anything will signal it, else by the host.
static void read_frames(roil_effect *e, const roil_vulkan_shared *into, VkImage opened,
                        const roil_vulkan_shared *semaphore, VkSemaphore shared) {
    float *frame = mem_alloc(sizeof *frame * 4 * WIDTH * HEIGHT);
    for (uint64_t i = 0; i < 2; i++) {
        const roil_vulkan_semaphore wait = {semaphore->semaphore.semaphore, 2 * i},
                                    signal = {semaphore->semaphore.semaphore, 2 * i + 1};
        const uint32_t count = shared ? 1 : 0;
        const roil_vulkan_frame f = {.images[ROIL_LAYER_COLOR] = into->image,
                                     .waits = &wait,
                                     .wait_count = count,
                                     .signals = &signal,
                                     .signal_count = count};
        seen.view[12] = 0.3f * (float)i;
        ok(roil_set_view(e, &seen));
        if (shared) begin_reading(opened, shared, 2 * i + 1);
        ok(roil_vulkan_render(e, (double)i, &f));
        roil_readback *done = roil_read_begin(e, NULL);
        ok(done && roil_read_end(done, frame));
        if (!shared) begin_reading(opened, VK_NULL_HANDLE, 0);
        expect_frame(frame);
    }
    mem_free(frame);
}

static bool is_this_device(const roil_vulkan_shared *s) {
    VkPhysicalDeviceVulkan11Properties v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &v11};
    vkGetPhysicalDeviceProperties2(physical, &two);
    return memcmp(v11.deviceUUID, s->device_uuid, VK_UUID_SIZE) == 0 &&
           memcmp(v11.driverUUID, s->driver_uuid, VK_UUID_SIZE) == 0;
}

static void images_are_read_by_another_device(void **state) {
    (void)state;
    VkPhysicalDeviceProperties named;
    vkGetPhysicalDeviceProperties(physical, &named);
    roil *r = roil_create(&(roil_desc){
        .device = named.deviceName, .home = getenv("ROIL_SOURCE_DIR"), .validate = true});
    ok(r);
    roil_effect *e = open_ball(r);
    roil_vulkan_shared into, semaphore;
    VkSemaphore shared = VK_NULL_HANDLE;
    if (roil_vulkan_share_semaphore(r, &semaphore)) {
        assert_true(is_this_device(&semaphore));
        shared = import_semaphore(&semaphore);
    } else { // as Mesa's lavapipe
        expect_error(false, "cannot share");
        print_message("skipped: semaphores: %s\n", roil_error());
    }
    if (roil_vulkan_share_image(r, hdr, WIDTH, HEIGHT, &into)) {
        assert_true(is_this_device(&into));
        VkDeviceMemory memory;
        VkImage opened = import_image(&into, &memory);
        read_frames(e, &into, opened, &semaphore, shared);
        vkDestroyImage(device, opened, NULL);
        vkFreeMemory(device, memory, NULL);
        roil_vulkan_unshare(r, &into);
    } else {
        expect_error(false, "cannot share images");
        print_message("skipped: images: %s\n", roil_error());
    }
    if (shared) {
        vkDestroySemaphore(device, shared, NULL);
        roil_vulkan_unshare(r, &semaphore);
    }
    expect_error(roil_vulkan_share_image(r, hdr, 0, 1, &into), "a shared image of 0 x 1");
    roil_unload(e);
    assert_int_equal(roil_validation_messages(r), 0);
    roil_destroy(r);
}

// ---- memory -----------------------------------------------------------------------------------

// What a card has is limited; what is reserved is also the host's memory, beside it.
static bool keeps_to_its_limit(const roil_memory *m) {
    VkPhysicalDeviceProperties is;
    vkGetPhysicalDeviceProperties(physical, &is);
    const bool beside = is.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    return m->sum <= m->limit && (beside || m->reserved <= m->limit);
}

static void a_limit_on_memory_is_kept(void **state) {
    (void)state;
    roil *r = open_roil("1M");
    ok(r);
    roil_effect *e = load_text(r, "ball.lua", ball);
    ok(roil_make_layer(e, NULL));
    expect_error(roil_prepare(e, 1024, 1024), "`device_memory` of roil_desc sets another limit");
    roil_unload(e);
    roil_destroy(r);
    r = open_roil("24M"); // another roil has another limit
    ok(r);
    e = open_ball(r);
    ok(draw(e, 0, 9));
    assert_true(color_now() > 0.3f);
    roil_memory m = roil_get_memory(r);
    assert_int_equal(m.limit, 24 << 20);
    assert_true(m.sum > 0 && keeps_to_its_limit(&m));
    roil_effect *large = load_text(r, "large.lua", ball); // is left out, and the first goes on
    ok(roil_make_layer(large, NULL));
    expect_error(roil_prepare(large, 2048, 2048), "large.lua: ");
    expect_error(roil_prepare(large, 2048, 2048), "the largest parts: march_2.color ");
    roil_unload(large);
    ok(draw(e, 1, 9));
    assert_true(color_now() > 0.3f);
    m = roil_get_memory(r);
    assert_true(keeps_to_its_limit(&m));
    roil_unload(e);
    roil_destroy(r);
    expect_error(open_roil("much"), "an amount of memory 'much'");
}

// Frames that would be kept are brought to the device again where it has no memory for all.
static void a_sequence_keeps_to_the_limit(void **state) {
    (void)state;
    enum { COUNT = 128, SIDE = 64 };
    char path[512];
    uint8_t *voxels = mem_alloc((size_t)COUNT * SIDE * SIDE * SIDE);
    memset(voxels, 99, (size_t)COUNT * SIDE * SIDE * SIDE);
    write_text("long.raw", "", path);
    FILE *file = fopen(path, "wb");
    assert_true(fwrite(voxels, (size_t)SIDE * SIDE * SIDE, COUNT, file) == COUNT);
    assert_int_equal(fclose(file), 0);
    mem_free(voxels);
    roil *r = open_roil("24M");
    ok(r);
    roil_effect *e = load_text(
        r, "long.lua",
        "local fx = effect { name = 'long', frames = 128 }\n"
        "local cloud = raw { 'long.raw', type = 'u8', size = {64, 64, 64}, frames = 128 }\n"
        "fx.output = final { march { density = cloud.density, steps = 4 } }.color\n"
        "return fx\n");
    ok(roil_prepare(e, 16, 16));
    test_listen(ROIL_INFO);
    for (int i = 1; i <= COUNT; i++) ok(roil_render(e, i));
    roil_set_log(NULL, NULL, ROIL_INFO);
    assert_non_null(strstr(test_said, "long.raw: memory is there for "));
    roil_memory m = roil_get_memory(r);
    assert_true(keeps_to_its_limit(&m));
    roil_unload(e);
    roil_destroy(r);
}

static int open_host(void **state) {
    *state = NULL;
    open_instance();
    VkPhysicalDeviceVulkan12Features there = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = &there};
    vkGetPhysicalDeviceFeatures2(physical, &all);
    ok(roil_vulkan_find_needs(vkGetInstanceProcAddr, instance, physical, &needs));
    needs.v12.separateDepthStencilLayouts = there.separateDepthStencilLayouts; // a host wants more
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
    const char *temporary = getenv("TMPDIR");
    snprintf(test_folder, sizeof test_folder, "%s/roil-test-XXXXXX",
             temporary ? temporary : "/tmp");
    return mkdtemp(test_folder) ? 0 : 1;
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_device_lacks_is_named),
        cmocka_unit_test(walls_hide_what_is_behind_them),
        cmocka_unit_test(depths_of_every_format_are_read),
        cmocka_unit_test(what_fails_is_given_back),
        cmocka_unit_test(what_is_at_work_is_waited_for_when_no_more_is_taken),
        cmocka_unit_test(images_are_read_by_another_device),
        cmocka_unit_test(a_limit_on_memory_is_kept),
        cmocka_unit_test(a_sequence_keeps_to_the_limit),
    };
    gpu_test_need_device();
    if (getenv("ROIL_TEST")) cmocka_set_test_filter(getenv("ROIL_TEST"));
    int failed = cmocka_run_group_tests(tests, open_host, NULL);
    if (!failed) close_engine();
    char command[300];
    snprintf(command, sizeof command, "rm -r '%s'", test_folder);
    return failed + complaints + (system(command) != 0);
}
