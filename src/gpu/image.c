// Images: 2D and 3D, with a view of all levels and one of each.
#include "base/memory.h"
#include "gpu/vk.h"
#include <inttypes.h>
#include <string.h>

static uint32_t vk_mip_size(uint32_t size, uint32_t mip) {
    uint32_t half = size >> mip;
    return half ? half : 1;
}

void vk_image_extent(const gpu_image *image, uint32_t mip, VkExtent3D *extent, uint64_t *bytes) {
    const gpu_image_desc *d = &image->desc;
    extent->width = vk_mip_size(d->width, mip);
    extent->height = vk_mip_size(d->height, mip);
    extent->depth = d->depth ? vk_mip_size(d->depth, mip) : 1;
    *bytes = (uint64_t)extent->width * extent->height * extent->depth * gpu_format_size(d->format);
}

VkClearColorValue vk_clear_color(const gpu_image *image, const float color[4]) {
    VkClearColorValue value;
    for (int i = 0; i < 4; i++) {
        if (image->desc.format == GPU_R32U) {
            // Beyond the range the conversion would be undefined.
            value.uint32[i] = !(color[i] > 0.0f)    ? 0
                              : color[i] >= 0x1p32f ? UINT32_MAX
                                                    : (uint32_t)color[i];
        } else {
            value.float32[i] = color[i];
        }
    }
    return value;
}

static uint32_t max_mips(const gpu_image_desc *d) {
    uint32_t size = d->width > d->height ? d->width : d->height;
    if (d->depth > size) size = d->depth;
    uint32_t mips = 0;
    for (; size > 0; size >>= 1) mips++;
    return mips;
}

static bool check_desc(const gpu_image_desc *d) {
    if (d->format <= GPU_FORMAT_NONE || d->format >= GPU_FORMAT_COUNT) {
        return err_set("image '%s': unknown format %d", d->label, (int)d->format);
    }
    if (d->width == 0 || d->height == 0) {
        return err_set("image '%s': size %ux%u; at least 1x1 is needed", d->label, d->width,
                       d->height);
    }
    uint32_t most = max_mips(d) < VK_MAX_MIPS ? max_mips(d) : VK_MAX_MIPS;
    if (d->mips > most) {
        return err_set("image '%s': %u levels; %ux%ux%u texels have at most %u", d->label, d->mips,
                       d->width, d->height, d->depth ? d->depth : 1, most);
    }
    if (!(d->use & (GPU_USE_SAMPLED | GPU_USE_STORAGE | GPU_USE_TARGET))) {
        return err_set("image '%s' has no use: sampled, storage or target is needed", d->label);
    }
    if ((d->use & GPU_USE_TARGET) && d->depth > 0) {
        return err_set("image '%s' is 3D and cannot be a target", d->label);
    }
    if ((d->use & ~(uint32_t)GPU_USE_SAMPLED) && d->format == GPU_RGBA8_SRGB) {
        return err_set("image '%s': format rgba8_srgb can only be sampled", d->label);
    }
    if ((d->use & GPU_USE_STORAGE) && d->format == GPU_D32F) {
        return err_set("image '%s': format d32f cannot be used for image load and store", d->label);
    }
    return true;
}

static VkImageUsageFlags usage_of(const gpu_image_desc *d) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (d->use & GPU_USE_SAMPLED) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (d->use & GPU_USE_STORAGE) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (d->use & GPU_USE_TARGET) {
        usage |= d->format == GPU_D32F ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                       : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    }
    return usage;
}

static bool check_device(gpu *g, const gpu_image_desc *d, const VkImageCreateInfo *info) {
    VkImageFormatProperties p;
    VkResult result = g->vk.GetPhysicalDeviceImageFormatProperties(
        g->physical, info->format, info->imageType, info->tiling, info->usage, 0, &p);
    if (!vk_check(g, result, "image '%s' of format %s", d->label, gpu_format_name(d->format))) {
        return false;
    }
    const VkExtent3D *e = &info->extent, *most = &p.maxExtent;
    if (e->width > most->width || e->height > most->height || e->depth > most->depth) {
        return err_set("image '%s': size %ux%ux%u; the device allows at most %ux%ux%u", d->label,
                       e->width, e->height, e->depth, most->width, most->height, most->depth);
    }
    uint64_t bytes = (uint64_t)e->width * e->height * e->depth * gpu_format_size(d->format);
    if (bytes > p.maxResourceSize) {
        return err_set("image '%s': %" PRIu64 " MiB; the device allows at most %" PRIu64 " MiB",
                       d->label, bytes >> 20, (uint64_t)p.maxResourceSize >> 20);
    }
    return true;
}

static void image_free(gpu *g, void *object) {
    gpu_image *image = object;
    g->vk.DestroyImageView(g->device, image->all, NULL);
    for (uint32_t i = 0; i < VK_MAX_MIPS; i++) {
        g->vk.DestroyImageView(g->device, image->mips[i], NULL);
    }
    if (!image->borrowed) g->vk.DestroyImage(g->device, image->handle, NULL);
    vk_memory_free(g, &image->memory);
    mem_free((char *)image->desc.label);
    mem_free(image);
}

static bool create_view(gpu *g, gpu_image *image, uint32_t mip, uint32_t count, VkImageView *out) {
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image->handle,
                                  .viewType = image->desc.depth ? VK_IMAGE_VIEW_TYPE_3D
                                                                : VK_IMAGE_VIEW_TYPE_2D,
                                  .format = vk_format_get(image->desc.format)->format,
                                  .subresourceRange = {.aspectMask = image->aspect,
                                                       .baseMipLevel = mip,
                                                       .levelCount = count,
                                                       .layerCount = 1}};
    if (!vk_check(g, g->vk.CreateImageView(g->device, &info, NULL, out),
                  "creating a view of image '%s'", image->desc.label)) {
        return false;
    }
    vk_name(g, VK_OBJECT_TYPE_IMAGE_VIEW, VK_HANDLE(*out), image->desc.label);
    return true;
}

static bool create_views(gpu *g, gpu_image *image) {
    if (!create_view(g, image, 0, image->desc.mips, &image->all)) return false;
    for (uint32_t i = 0; i < image->desc.mips; i++) {
        if (!create_view(g, image, i, 1, &image->mips[i])) return false;
    }
    return true;
}

static bool image_build(gpu *g, gpu_image *image) {
    const gpu_image_desc *d = &image->desc;
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = d->depth ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
                              .format = vk_format_get(d->format)->format,
                              .extent = {d->width, d->height, d->depth ? d->depth : 1},
                              .mipLevels = d->mips,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .tiling = VK_IMAGE_TILING_OPTIMAL,
                              .usage = usage_of(d)};
    if (!check_device(g, d, &info)) return false;
    if (!vk_check(g, g->vk.CreateImage(g->device, &info, NULL, &image->handle),
                  "creating image '%s'", d->label)) {
        return false;
    }
    vk_name(g, VK_OBJECT_TYPE_IMAGE, VK_HANDLE(image->handle), d->label);
    VkMemoryRequirements needs;
    g->vk.GetImageMemoryRequirements(g->device, image->handle, &needs);
    if (!vk_memory_alloc(g, &needs, VK_MEMORY_DEVICE, true, d->label, &image->memory)) return false;
    return vk_check(g,
                    g->vk.BindImageMemory(g->device, image->handle, image->memory.block->memory,
                                          image->memory.place.offset),
                    "binding memory to image '%s'", d->label) &&
           create_views(g, image);
}

gpu_image *gpu_image_create(gpu *g, const gpu_image_desc *desc) {
    if (!vk_alive(g)) return NULL;
    vk_collect(g);
    gpu_image_desc d = *desc;
    if (!d.label) d.label = "image";
    if (d.mips == 0) d.mips = 1;
    if (!check_desc(&d)) return NULL;
    gpu_image *image = mem_alloc(sizeof *image);
    image->desc = d;
    image->desc.label = mem_copy(d.label, strlen(d.label) + 1);
    image->aspect = d.format == GPU_D32F ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    if (!image_build(g, image)) {
        image_free(g, image);
        return NULL;
    }
    return image;
}

void gpu_image_destroy(gpu *g, gpu_image *image) {
    if (!image) return;
    vk_retire(g, image_free, image);
}

const gpu_image_desc *gpu_image_get_desc(const gpu_image *image) {
    return &image->desc;
}
