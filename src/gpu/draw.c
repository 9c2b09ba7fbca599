// Draws into targets. All barriers come before rendering begins, so the draws of one call are
// unordered among each other but for what the targets order.
#include "gpu/vk.h"

static uint32_t color_count(const gpu_draw_desc *desc) {
    uint32_t count = 0;
    while (count < GPU_MAX_TARGETS && desc->colors[count]) count++;
    return count;
}

static bool check_target(const gpu_draw_desc *desc, const gpu_image *image, bool depth) {
    const gpu_image *first = desc->colors[0] ? desc->colors[0] : desc->depth;
    const gpu_image_desc *d = &image->desc;
    if (!(d->use & GPU_USE_TARGET)) {
        return err_set("image '%s' was not created for use as a target", d->label);
    }
    if ((d->format == GPU_D32F) != depth) {
        return err_set("image '%s' of format %s cannot be a %s target", d->label,
                       gpu_format_name(d->format), depth ? "depth" : "colour");
    }
    if (d->width != first->desc.width || d->height != first->desc.height) {
        return err_set("targets '%s' and '%s' differ in size: %ux%u and %ux%u", first->desc.label,
                       d->label, first->desc.width, first->desc.height, d->width, d->height);
    }
    return true;
}

static bool check_pipeline(const gpu_draw_desc *desc, uint32_t colors) {
    const gpu_pipeline *p = desc->pipeline;
    if (!p) return err_set("draws need a pipeline");
    if (p->bind_point != VK_PIPELINE_BIND_POINT_GRAPHICS) {
        return err_set("pipeline '%s' is a compute pipeline and cannot draw", p->label);
    }
    if (p->color_count != colors || (p->depth != GPU_FORMAT_NONE) != (desc->depth != NULL)) {
        return err_set("pipeline '%s' draws to %u colour targets%s; %u%s are given", p->label,
                       p->color_count, p->depth ? " and depth" : "", colors,
                       desc->depth ? " and depth" : "");
    }
    for (uint32_t i = 0; i < colors; i++) {
        if (p->colors[i] != desc->colors[i]->desc.format) {
            return err_set("pipeline '%s' draws to format %s; target '%s' has %s", p->label,
                           gpu_format_name(p->colors[i]), desc->colors[i]->desc.label,
                           gpu_format_name(desc->colors[i]->desc.format));
        }
    }
    return true;
}

static uint64_t command_size(const gpu_draw *draw) {
    return draw->indices ? sizeof(gpu_draw_indexed_command) : sizeof(gpu_draw_command);
}

static uint32_t command_count(const gpu_draw *draw) {
    return draw->commands_drawn ? draw->commands_drawn : 1;
}

// What a command of the device draws cannot be checked here: who wrote it must know.
static bool check_buffers(const gpu_pipeline *p, const gpu_draw *draw) {
    const gpu_buffer *indices = draw->indices, *commands = draw->commands;
    if ((indices && indices->kind != GPU_BUFFER_DEVICE) ||
        (commands && commands->kind != GPU_BUFFER_DEVICE))
        return err_set("pipeline '%s': indices and commands must lie in device buffers", p->label);
    if (commands && (draw->command % 4 != 0 || draw->command > commands->size ||
                     commands->size - draw->command < command_count(draw) * command_size(draw)))
        return err_set("pipeline '%s': the command at byte %llu of buffer '%s' is not whole words "
                       "inside it",
                       p->label, (unsigned long long)draw->command, commands->label);
    uint64_t end = (uint64_t)draw->first_vertex + draw->vertices;
    if (indices && !commands && end * sizeof(uint32_t) > indices->size)
        return err_set("pipeline '%s': indices up to %llu are drawn; buffer '%s' holds %llu",
                       p->label, (unsigned long long)end, indices->label,
                       (unsigned long long)(indices->size / sizeof(uint32_t)));
    return true;
}

static bool draw_check(gpu *g, const gpu_draw_desc *desc) {
    if (!vk_alive(g)) return false;
    if (!g->frame) return err_set("drawing: no frame is open");
    uint32_t colors = color_count(desc);
    if (colors == 0 && !desc->depth) return err_set("drawing needs a target");
    for (uint32_t i = 0; i < colors; i++) {
        if (!check_target(desc, desc->colors[i], false)) return false;
    }
    if (desc->depth && !check_target(desc, desc->depth, true)) return false;
    if (desc->draw_count == 0) return true;
    if (!check_pipeline(desc, colors)) return false;
    for (size_t i = 0; i < desc->draw_count; i++) {
        const gpu_draw *draw = &desc->draws[i];
        if (!check_buffers(desc->pipeline, draw) ||
            !vk_bindings_check(g, desc->pipeline, draw->bindings, draw->binding_count)) {
            return false;
        }
    }
    return true;
}

static bool use_buffers(gpu *g, const gpu_draw *draw) {
    static const hazard_access indices = {.stages = VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                          .reads = VK_ACCESS_2_INDEX_READ_BIT};
    static const hazard_access commands = {.stages = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                           .reads = VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};
    return (!draw->indices || vk_use_buffer(g, draw->indices, indices)) &&
           (!draw->commands || vk_use_buffer(g, draw->commands, commands));
}

static bool use_all(gpu *g, const gpu_draw_desc *desc) {
    static const hazard_access color = {.stages = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                        .reads = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                                        .writes = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                        .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    static const hazard_access depth = {.stages = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                        .reads = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                                        .writes = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                        .layout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    uint32_t colors = color_count(desc);
    for (uint32_t i = 0; i < colors; i++) {
        if (!vk_use_image(g, desc->colors[i], 0, 1, color)) return false;
    }
    if (desc->depth && !vk_use_image(g, desc->depth, 0, 1, depth)) return false;
    for (size_t i = 0; i < desc->draw_count; i++) {
        const gpu_draw *draw = &desc->draws[i];
        if (!use_buffers(g, draw) ||
            !vk_bindings_use(g, desc->pipeline, draw->bindings, draw->binding_count))
            return false;
    }
    return true;
}

static VkRenderingAttachmentInfo attachment(const gpu_image *image, bool clear,
                                            VkClearValue value) {
    return (VkRenderingAttachmentInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                       .imageView = image->mips[0],
                                       .imageLayout = image->tracked[0].state.layout,
                                       .loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                       : VK_ATTACHMENT_LOAD_OP_LOAD,
                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                       .clearValue = value};
}

// Returns the size of the targets.
static VkExtent2D begin(const gpu *g, VkCommandBuffer commands, const gpu_draw_desc *desc) {
    VkRenderingAttachmentInfo colors[GPU_MAX_TARGETS], depth;
    const gpu_image *first = desc->colors[0] ? desc->colors[0] : desc->depth;
    VkExtent2D size = {first->desc.width, first->desc.height};
    VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                            .renderArea = {.extent = size},
                            .layerCount = 1,
                            .colorAttachmentCount = color_count(desc),
                            .pColorAttachments = colors};
    for (uint32_t i = 0; i < info.colorAttachmentCount; i++) {
        VkClearValue value = {.color = vk_clear_color(desc->colors[i], desc->clear_color[i])};
        colors[i] = attachment(desc->colors[i], desc->clear, value);
    }
    if (desc->depth) {
        VkClearValue value = {.depthStencil = {.depth = desc->clear_depth}};
        depth = attachment(desc->depth, desc->clear, value);
        info.pDepthAttachment = &depth;
    }
    g->vk.CmdBeginRendering(commands, &info);
    return size;
}

// Clipped to the target. One that lies outside is empty, and nothing is drawn.
static VkRect2D scissor_of(const gpu_draw *draw, VkExtent2D size) {
    const uint32_t *s = draw->scissor[2] > 0 ? draw->scissor : draw->viewport;
    if (s[2] == 0) return (VkRect2D){.extent = size};
    uint32_t x = s[0] < size.width ? s[0] : size.width;
    uint32_t y = s[1] < size.height ? s[1] : size.height;
    uint32_t width = s[2] < size.width - x ? s[2] : size.width - x;
    uint32_t height = s[3] < size.height - y ? s[3] : size.height - y;
    return (VkRect2D){{(int32_t)x, (int32_t)y}, {width, height}};
}

static void place(const gpu *g, VkCommandBuffer commands, const gpu_draw *draw, VkExtent2D size) {
    const uint32_t *v = draw->viewport;
    VkViewport viewport = {
        .width = (float)size.width, .height = (float)size.height, .maxDepth = 1.0f};
    if (v[2] > 0)
        viewport = (VkViewport){(float)v[0], (float)v[1], (float)v[2], (float)v[3], 0.0f, 1.0f};
    VkRect2D scissor = scissor_of(draw, size);
    g->vk.CmdSetViewport(commands, 0, 1, &viewport);
    g->vk.CmdSetScissor(commands, 0, 1, &scissor);
}

// A device that takes one command at a time says so by its limit.
static void draw_commands(const gpu *g, VkCommandBuffer commands, const gpu_draw *draw) {
    uint32_t stride = (uint32_t)command_size(draw), left = command_count(draw);
    for (uint64_t at = draw->command; left > 0;) {
        uint32_t most = g->limits.maxDrawIndirectCount, count = left < most ? left : most;
        if (draw->indices)
            g->vk.CmdDrawIndexedIndirect(commands, draw->commands->handle, at, count, stride);
        else
            g->vk.CmdDrawIndirect(commands, draw->commands->handle, at, count, stride);
        at += (uint64_t)count * stride;
        left -= count;
    }
}

static bool record(gpu *g, VkCommandBuffer commands, const gpu_pipeline *pipeline,
                   const gpu_draw *draw, VkExtent2D size) {
    if (!vk_bindings_bind(g, commands, pipeline, draw->bindings, draw->binding_count)) return false;
    place(g, commands, draw, size);
    uint32_t instances = draw->instances ? draw->instances : 1;
    if (draw->indices)
        g->vk.CmdBindIndexBuffer(commands, draw->indices->handle, 0, VK_INDEX_TYPE_UINT32);
    if (draw->commands)
        draw_commands(g, commands, draw);
    else if (draw->indices)
        g->vk.CmdDrawIndexed(commands, draw->vertices, instances, draw->first_vertex, 0, 0);
    else
        g->vk.CmdDraw(commands, draw->vertices, instances, draw->first_vertex, 0);
    return true;
}

bool gpu_draw_all(gpu *g, const gpu_draw_desc *desc) {
    if (!draw_check(g, desc)) return false;
    VkCommandBuffer commands = g->frame->batch.commands;
    vk_uses_begin(g);
    if (!use_all(g, desc)) return false;
    vk_uses_flush(g, commands);
    VkExtent2D size = begin(g, commands, desc);
    bool ok = true;
    if (desc->draw_count > 0) {
        g->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                              desc->pipeline->built->handle);
    }
    for (size_t i = 0; i < desc->draw_count && ok; i++) {
        ok = record(g, commands, desc->pipeline, &desc->draws[i], size);
    }
    g->vk.CmdEndRendering(commands);
    return ok;
}
