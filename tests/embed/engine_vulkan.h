// What every engine has: an instance, images, two pipelines. Nothing here knows roil.
#pragma once
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#include "engine_compose.h" // these three of engine.glsl, by glslangValidator; they want uint32_t
#include "engine_fragment.h"
#include "engine_vertex.h"

#ifndef WIDTH // a host of another size says so before
enum { WIDTH = 96, HEIGHT = 54 };
#endif
enum { FRAMES = 60, EFFECTS = 2 };
static const VkFormat hdr = VK_FORMAT_R16G16B16A16_SFLOAT, deep = VK_FORMAT_D32_SFLOAT;

// Ends at once: the device may be at work, and drivers do not bear exit() then.
#define FAIL(...) (fprintf(stderr, "engine: " __VA_ARGS__), fputc('\n', stderr), _Exit(1))
#define VK(call)                                                                                   \
    do {                                                                                           \
        VkResult result = (call);                                                                  \
        if (result) FAIL("%s: %d", #call, (int)result);                                            \
    } while (0)

typedef struct image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
} image;

static VkInstance instance;
static VkDebugUtilsMessengerEXT messenger; // while the instance lives; null without validation
static VkPhysicalDevice physical;
static VkDevice device;
static VkQueue queue;
static VkCommandPool pool;
static VkCommandBuffer scene_commands, compose_commands;
static VkSemaphore timeline;
static VkBuffer host_buffer; // of the picture
static VkDeviceMemory host_memory;
static VkPipelineLayout draw_layout, compose_layout;
static VkPipeline draw_pipeline, compose_pipeline;
static VkDescriptorSetLayout set_layout;
static VkDescriptorPool sets;
static VkDescriptorSet set;
static image picture, depth, layers[EFFECTS][2]; // of each effect: colour, transmittance
static int complaints;

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user) {
    (void)severity, (void)types, (void)user;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    complaints++;
    return VK_FALSE;
}

static void open_instance(void) {
    static const char *const layer = "VK_LAYER_KHRONOS_validation";
    const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkValidationFeatureEnableEXT wanted =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                        .enabledValidationFeatureCount = 1,
                                        .pEnabledValidationFeatures = &wanted};
    VkDebugUtilsMessengerCreateInfoEXT told = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .pNext = &features,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message};
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "engine",
                                     .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pNext = &told,
                                 .pApplicationInfo = &application,
                                 .enabledLayerCount = 1,
                                 .ppEnabledLayerNames = &layer,
                                 .enabledExtensionCount = 2,
                                 .ppEnabledExtensionNames = extensions};
    if (getenv("ENGINE_BARE")) { // without validation
        info.pNext = NULL;
        info.enabledLayerCount = info.enabledExtensionCount = 0;
    }
    VK(vkCreateInstance(&info, NULL, &instance));
    PFN_vkCreateDebugUtilsMessengerEXT listen =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    told.pNext = NULL;
    if (info.enabledLayerCount) VK(listen(instance, &told, NULL, &messenger));
    uint32_t count = 1;
    VkResult result = vkEnumeratePhysicalDevices(instance, &count, &physical);
    if ((result != VK_SUCCESS && result != VK_INCOMPLETE) || !count) FAIL("there is no device");
}

// ---- what the engine draws with ---------------------------------------------------------------

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties all;
    VkDeviceMemory memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &all);
    uint32_t type = 0;
    while (!(needs.memoryTypeBits >> type & 1) ||
           (all.memoryTypes[type].propertyFlags & flags) != flags)
        type++;
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = needs.size,
                                 .memoryTypeIndex = type};
    VK(vkAllocateMemory(device, &info, NULL, &memory));
    return memory;
}

static image make_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    image i;
    VkMemoryRequirements needs;
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = format,
                              .extent = {WIDTH, HEIGHT, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = usage};
    VK(vkCreateImage(device, &info, NULL, &i.image));
    vkGetImageMemoryRequirements(device, i.image, &needs);
    i.memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(device, i.image, i.memory, 0));
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = i.image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = format,
                                  .subresourceRange = {aspect, 0, 1, 0, 1}};
    VK(vkCreateImageView(device, &view, NULL, &i.view));
    return i;
}

static VkShaderModule module_of(const uint32_t *code, size_t size) {
    VkShaderModule module;
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VK(vkCreateShaderModule(device, &info, NULL, &module));
    return module;
}

static VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage,
                                                VkShaderModule module) {
    return (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = stage,
        .module = module,
        .pName = "main"};
}

static void make_draw_pipeline(void) {
    VkPushConstantRange push = {VK_SHADER_STAGE_VERTEX_BIT, 0, 64};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    VK(vkCreatePipelineLayout(device, &layout, NULL, &draw_layout));
    VkPipelineShaderStageCreateInfo stages[] = {
        stage_of(VK_SHADER_STAGE_VERTEX_BIT, module_of(vertex, sizeof vertex)),
        stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, module_of(fragment, sizeof fragment))};
    VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport area = {0, 0, WIDTH, HEIGHT, 0, 1};
    VkRect2D scissor = {{0, 0}, {WIDTH, HEIGHT}};
    VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &area,
        .scissorCount = 1,
        .pScissors = &scissor};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo nearest = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER}; // depths are reversed
    VkPipelineColorBlendAttachmentState all = {.colorWriteMask = 15};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &all};
    VkPipelineRenderingCreateInfo targets = {.sType =
                                                 VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                             .colorAttachmentCount = 1,
                                             .pColorAttachmentFormats = &hdr,
                                             .depthAttachmentFormat = deep};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .pNext = &targets,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &nearest,
                                         .pColorBlendState = &blend,
                                         .layout = draw_layout};
    VK(vkCreateGraphicsPipelines(device, NULL, 1, &info, NULL, &draw_pipeline));
    for (int i = 0; i < 2; i++) vkDestroyShaderModule(device, stages[i].module, NULL);
}

static void make_compose_pipeline(void) {
    VkDescriptorSetLayoutBinding bindings[1 + 2 * EFFECTS];
    VkDescriptorImageInfo images[1 + 2 * EFFECTS];
    VkWriteDescriptorSet writes[1 + 2 * EFFECTS];
    const uint32_t count = 1 + 2 * EFFECTS;
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count};
    for (uint32_t i = 0; i < count; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){i, size.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings};
    VK(vkCreateDescriptorSetLayout(device, &set_info, NULL, &set_layout));
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &set_layout};
    VK(vkCreatePipelineLayout(device, &layout, NULL, &compose_layout));
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, module_of(compose, sizeof compose)),
        .layout = compose_layout};
    VK(vkCreateComputePipelines(device, NULL, 1, &info, NULL, &compose_pipeline));
    vkDestroyShaderModule(device, info.stage.module, NULL);
    VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 1,
                                            .poolSizeCount = 1,
                                            .pPoolSizes = &size};
    VK(vkCreateDescriptorPool(device, &pool_info, NULL, &sets));
    VkDescriptorSetAllocateInfo allocate_info = {.sType =
                                                     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = sets,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &set_layout};
    VK(vkAllocateDescriptorSets(device, &allocate_info, &set));
    for (uint32_t i = 0; i < count; i++) {
        VkImageView view = i ? layers[(i - 1) / 2][(i - 1) % 2].view : picture.view;
        images[i] =
            (VkDescriptorImageInfo){.imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = set,
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = size.type,
                                           .pImageInfo = &images[i]};
    }
    vkUpdateDescriptorSets(device, count, writes, 0, NULL);
}

static void open_engine(void) {
    VkCommandBuffer both[2];
    VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
    VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = pool,
                                        .commandBufferCount = 2};
    VK(vkAllocateCommandBuffers(device, &info, both));
    scene_commands = both[0];
    compose_commands = both[1];
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                       .pNext = &type};
    VK(vkCreateSemaphore(device, &semaphore, NULL, &timeline));
    const VkImageUsageFlags copied =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    picture =
        make_image(hdr, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | copied,
                   VK_IMAGE_ASPECT_COLOR_BIT);
    depth = make_image(
        deep, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | copied,
        VK_IMAGE_ASPECT_DEPTH_BIT);
    for (int i = 0; i < 2 * EFFECTS; i++)
        layers[i / 2][i % 2] =
            make_image(hdr, VK_IMAGE_USAGE_STORAGE_BIT | copied, VK_IMAGE_ASPECT_COLOR_BIT);
    make_draw_pipeline();
    make_compose_pipeline();
    VkMemoryRequirements needs;
    VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = 8 * WIDTH * HEIGHT,
                                 .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VK(vkCreateBuffer(device, &buffer, NULL, &host_buffer));
    vkGetBufferMemoryRequirements(device, host_buffer, &needs);
    host_memory =
        allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, host_buffer, host_memory, 0));
}

static void destroy_image(image *i) {
    vkDestroyImageView(device, i->view, NULL);
    vkDestroyImage(device, i->image, NULL);
    vkFreeMemory(device, i->memory, NULL);
}

static void close_engine(void) {
    vkDeviceWaitIdle(device);
    vkDestroyBuffer(device, host_buffer, NULL);
    vkFreeMemory(device, host_memory, NULL);
    destroy_image(&picture);
    destroy_image(&depth);
    for (int i = 0; i < 2 * EFFECTS; i++) destroy_image(&layers[i / 2][i % 2]);
    vkDestroyPipeline(device, draw_pipeline, NULL);
    vkDestroyPipeline(device, compose_pipeline, NULL);
    vkDestroyPipelineLayout(device, draw_layout, NULL);
    vkDestroyPipelineLayout(device, compose_layout, NULL);
    vkDestroyDescriptorPool(device, sets, NULL);
    vkDestroyDescriptorSetLayout(device, set_layout, NULL);
    vkDestroySemaphore(device, timeline, NULL);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyDevice(device, NULL);
    PFN_vkDestroyDebugUtilsMessengerEXT silence =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            instance, "vkDestroyDebugUtilsMessengerEXT");
    if (messenger) silence(instance, messenger, NULL);
    vkDestroyInstance(instance, NULL);
}

// ---- a frame ----------------------------------------------------------------------------------

static VkCommandBuffer begin_commands(VkCommandBuffer commands) {
    VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(commands, &info));
    return commands;
}

static void submit(VkCommandBuffer commands, uint64_t before, uint64_t after) {
    VK(vkEndCommandBuffer(commands));
    VkCommandBufferSubmitInfo one = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                     .commandBuffer = commands};
    VkSemaphoreSubmitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                  .semaphore = timeline,
                                  .value = before,
                                  .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    VkSemaphoreSubmitInfo signal = wait;
    signal.value = after;
    VkSubmitInfo2 info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                          .waitSemaphoreInfoCount = 1,
                          .pWaitSemaphoreInfos = &wait,
                          .commandBufferInfoCount = 1,
                          .pCommandBufferInfos = &one,
                          .signalSemaphoreInfoCount = 1,
                          .pSignalSemaphoreInfos = &signal};
    VK(vkQueueSubmit2(queue, 1, &info, NULL));
}

static void wait_for(uint64_t value) {
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &timeline,
                                .pValues = &value};
    VK(vkWaitSemaphores(device, &info, UINT64_MAX));
}

static void relayout(VkCommandBuffer commands, VkImage what, VkImageLayout from, VkImageLayout to,
                     VkImageAspectFlags aspect) {
    VkImageMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                     .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                     .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     .dstAccessMask =
                                         VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                     .oldLayout = from,
                                     .newLayout = to,
                                     .image = what,
                                     .subresourceRange = {aspect, 0, 1, 0, 1}};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .imageMemoryBarrierCount = 1,
                             .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &info);
}

static void draw_triangles(VkCommandBuffer commands, const float clip[16]) {
    VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                       .imageView = picture.view,
                                       .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                       .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    VkRenderingAttachmentInfo nearest = color;
    nearest.imageView = depth.view;
    nearest.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL; // cleared to 0: far away
    VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                            .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                            .layerCount = 1,
                            .colorAttachmentCount = 1,
                            .pColorAttachments = &color,
                            .pDepthAttachment = &nearest};
    vkCmdBeginRendering(commands, &info);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw_pipeline);
    vkCmdPushConstants(commands, draw_layout, VK_SHADER_STAGE_VERTEX_BIT, 0, 64, clip);
    vkCmdDraw(commands, 9, 1, 0, 0);
    vkCmdEndRendering(commands);
}

// Into the buffer, for the host to read.
static void copy_to_host(VkCommandBuffer commands, VkImage what, VkImageLayout layout) {
    VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                .imageExtent = {WIDTH, HEIGHT, 1}};
    vkCmdCopyImageToBuffer(commands, what, layout, host_buffer, 1, &region);
    VkMemoryBarrier2 read = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                             .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                             .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                             .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                             .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                             .memoryBarrierCount = 1,
                             .pMemoryBarriers = &read};
    vkCmdPipelineBarrier2(commands, &info);
}

static void compose_layers(uint64_t before, uint64_t after) {
    VkCommandBuffer commands = begin_commands(compose_commands);
    relayout(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
             VK_IMAGE_ASPECT_COLOR_BIT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compose_pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compose_layout, 0, 1, &set, 0,
                            NULL);
    vkCmdDispatch(commands, (WIDTH + 7) / 8, (HEIGHT + 7) / 8, 1);
    relayout(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
             VK_IMAGE_ASPECT_COLOR_BIT);
    copy_to_host(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL);
    submit(commands, before, after);
}

static float from_half(uint16_t h) {
    const int exponent = h >> 10 & 31;
    const float part = (float)(h & 1023) / 1024;
    const float value = exponent ? ldexpf(1 + part, exponent - 15) : ldexpf(part, -14);
    return h & 0x8000 ? -value : value;
}

// As PFM: linear, rows from the bottom.
static void write_picture(const char *path) {
    uint16_t *halves;
    FILE *file = fopen(path, "wb");
    VK(vkMapMemory(device, host_memory, 0, VK_WHOLE_SIZE, 0, (void **)&halves));
    if (!file) FAIL("%s cannot be written", path);
    fprintf(file, "PF\n%d %d\n-1.0\n", WIDTH, HEIGHT);
    for (int y = (int)HEIGHT - 1; y >= 0; y--)
        for (int x = 0; x < (int)WIDTH; x++) {
            float rgb[3];
            for (int c = 0; c < 3; c++) rgb[c] = from_half(halves[4 * (y * (int)WIDTH + x) + c]);
            fwrite(rgb, sizeof rgb, 1, file);
        }
    if (fclose(file) != 0) FAIL("%s cannot be written", path);
}
