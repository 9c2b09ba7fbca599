// The image formats by name and in Vulkan's words.
#include "gpu/vk.h"
#include <assert.h>
#include <string.h>

static const vk_format formats[GPU_FORMAT_COUNT] = {
    [GPU_FORMAT_NONE] = {"none", VK_FORMAT_UNDEFINED, 0, 0},
    [GPU_R8] = {"r8", VK_FORMAT_R8_UNORM, 1, 1},
    [GPU_RGBA8] = {"rgba8", VK_FORMAT_R8G8B8A8_UNORM, 4, 4},
    [GPU_RGBA8_SRGB] = {"rgba8_srgb", VK_FORMAT_R8G8B8A8_SRGB, 4, 4},
    [GPU_R16F] = {"r16f", VK_FORMAT_R16_SFLOAT, 2, 1},
    [GPU_RG16F] = {"rg16f", VK_FORMAT_R16G16_SFLOAT, 4, 2},
    [GPU_RGBA16F] = {"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 4},
    [GPU_R32F] = {"r32f", VK_FORMAT_R32_SFLOAT, 4, 1},
    [GPU_RG32F] = {"rg32f", VK_FORMAT_R32G32_SFLOAT, 8, 2},
    [GPU_RGBA32F] = {"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT, 16, 4},
    [GPU_R32U] = {"r32ui", VK_FORMAT_R32_UINT, 4, 1},
    [GPU_D32F] = {"d32f", VK_FORMAT_D32_SFLOAT, 4, 1},
};

const vk_format *vk_format_get(gpu_format format) {
    assert(format < GPU_FORMAT_COUNT);
    return &formats[format];
}

uint32_t gpu_format_size(gpu_format format) {
    return vk_format_get(format)->size;
}

const char *gpu_format_name(gpu_format format) {
    return vk_format_get(format)->name;
}

uint32_t gpu_format_channels(gpu_format format) {
    return vk_format_get(format)->channels;
}

gpu_format gpu_format_from_name(const char *name) {
    for (int i = 1; i < GPU_FORMAT_COUNT; i++) {
        if (strcmp(formats[i].name, name) == 0) return (gpu_format)i;
    }
    return GPU_FORMAT_NONE;
}
