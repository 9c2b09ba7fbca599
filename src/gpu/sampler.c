// The few ways to read between texels.
#include "gpu/vk.h"

bool vk_samplers_create(gpu *g) {
    static const struct {
        VkFilter filter;
        VkSamplerMipmapMode mipmap;
        VkSamplerAddressMode address;
    } kinds[GPU_SAMPLER_COUNT] = {
        [GPU_LINEAR_CLAMP] = {VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR,
                              VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
        [GPU_NEAREST_CLAMP] = {VK_FILTER_NEAREST, VK_SAMPLER_MIPMAP_MODE_NEAREST,
                               VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
        [GPU_LINEAR_REPEAT] = {VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR,
                               VK_SAMPLER_ADDRESS_MODE_REPEAT},
        [GPU_LINEAR_ZERO] = {VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR,
                             VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER},
    };
    for (int i = 0; i < GPU_SAMPLER_COUNT; i++) {
        VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                    .magFilter = kinds[i].filter,
                                    .minFilter = kinds[i].filter,
                                    .mipmapMode = kinds[i].mipmap,
                                    .addressModeU = kinds[i].address,
                                    .addressModeV = kinds[i].address,
                                    .addressModeW = kinds[i].address,
                                    .maxLod = VK_LOD_CLAMP_NONE,
                                    .borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK};
        if (!vk_check(g, g->vk.CreateSampler(g->device, &info, NULL, &g->samplers[i]),
                      "creating a sampler")) {
            return false;
        }
    }
    return true;
}
