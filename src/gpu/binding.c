// Bindings of a dispatch or draw: checked against the slots that reflection found, translated to
// accesses for the hazard tracker, handed over as descriptors: pushed where the device can, else by
// a set of the batch that is bound. In both cases the pipeline's template reads them from an array,
// which takes a driver half the work of a list of writes.
#include "base/memory.h"
#include "gpu/vk.h"

enum { SETS_OF_POOL = 64 };

static const char *const slot_names[] = {[GPU_SLOT_UNIFORM] = "a uniform block",
                                         [GPU_SLOT_STORAGE_BUFFER] = "a storage buffer",
                                         [GPU_SLOT_SAMPLED_IMAGE] = "a sampled image",
                                         [GPU_SLOT_STORAGE_IMAGE] = "a storage image"};

// Of a slot; a kernel's bindings stand in the order of the slots.
static const gpu_binding *find(const gpu_binding *list, size_t count, uint32_t slot,
                               uint32_t binding) {
    if (slot < count && list[slot].binding == binding) return &list[slot];
    for (size_t i = 0; i < count; i++) {
        if (list[i].binding == binding) return &list[i];
    }
    return NULL;
}

// ---- check ------------------------------------------------------------------------------------

static bool check_image(gpu *g, const gpu_pipeline *pipeline, const gpu_slot *slot,
                        const gpu_binding *b) {
    bool sampled = slot->kind == GPU_SLOT_SAMPLED_IMAGE;
    const gpu_image_desc *d = &b->image->desc;
    gpu_image_use use = sampled ? GPU_USE_SAMPLED : GPU_USE_STORAGE;
    if (!(d->use & use)) {
        return err_set("pipeline '%s', binding %u: image '%s' was not created for use as %s",
                       pipeline->label, b->binding, d->label, slot_names[slot->kind]);
    }
    if ((!sampled || b->one_mip) && b->mip >= d->mips) {
        return err_set("pipeline '%s', binding %u: image '%s' has no level %u, only %u levels",
                       pipeline->label, b->binding, d->label, b->mip, d->mips);
    }
    if (!sampled) return true;
    if (b->sampler >= GPU_SAMPLER_COUNT) {
        return err_set("pipeline '%s', binding %u: there is no sampler %d", pipeline->label,
                       b->binding, (int)b->sampler);
    }
    if (b->sampler != GPU_NEAREST_CLAMP &&
        !(g->format_features[d->format] & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT)) {
        return err_set("pipeline '%s', binding %u: image '%s' of format %s cannot be filtered; "
                       "the nearest sampler is accepted",
                       pipeline->label, b->binding, d->label, gpu_format_name(d->format));
    }
    return true;
}

static bool check_buffer(const gpu_pipeline *pipeline, const gpu_binding *b) {
    if (b->buffer->kind == GPU_BUFFER_DEVICE) return true;
    return err_set("pipeline '%s', binding %u: buffer '%s' is for reading back; a device buffer is "
                   "needed",
                   pipeline->label, b->binding, b->buffer->label);
}

static bool check_slot(gpu *g, const gpu_pipeline *pipeline, const gpu_slot *slot,
                       const gpu_binding *b) {
    bool given = false;
    if (b) {
        switch (slot->kind) {
        case GPU_SLOT_UNIFORM:
            given = b->uniform && b->uniform_size > 0;
            break;
        case GPU_SLOT_STORAGE_BUFFER:
            given = b->buffer != NULL;
            break;
        case GPU_SLOT_SAMPLED_IMAGE:
        case GPU_SLOT_STORAGE_IMAGE:
            given = b->image != NULL;
            break;
        }
    }
    if (!given) {
        const char *other = !b           ? "nothing"
                            : b->image   ? "an image"
                            : b->buffer  ? "a buffer"
                            : b->uniform ? "uniform data"
                                         : "nothing";
        return err_set("pipeline '%s', binding %u: %s is needed, %s is bound", pipeline->label,
                       slot->binding, slot_names[slot->kind], other);
    }
    if (slot->kind == GPU_SLOT_UNIFORM) return true;
    if (slot->kind == GPU_SLOT_STORAGE_BUFFER) return check_buffer(pipeline, b);
    return check_image(g, pipeline, slot, b);
}

bool vk_bindings_check(gpu *g, const gpu_pipeline *pipeline, const gpu_binding *list,
                       size_t count) {
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        const gpu_slot *slot = &pipeline->slots[i];
        if (!check_slot(g, pipeline, slot, find(list, count, i, slot->binding))) return false;
    }
    return true;
}

// ---- use --------------------------------------------------------------------------------------

static hazard_access access_of(const gpu_pipeline *pipeline, const gpu_slot *slot) {
    hazard_access a = {.stages = pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE
                                     ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
                                     : VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                           VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT};
    if (slot->kind == GPU_SLOT_SAMPLED_IMAGE) {
        a.reads = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        a.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return a;
    }
    if (slot->kind == GPU_SLOT_STORAGE_IMAGE) a.layout = VK_IMAGE_LAYOUT_GENERAL;
    if (slot->writes) a.writes = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    // A slot that does neither (only its size is asked) still needs the layout.
    if (slot->reads || !slot->writes) a.reads = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    return a;
}

bool vk_bindings_use(gpu *g, const gpu_pipeline *pipeline, const gpu_binding *list, size_t count) {
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        const gpu_slot *slot = &pipeline->slots[i];
        const gpu_binding *b = find(list, count, i, slot->binding);
        hazard_access access = access_of(pipeline, slot);
        bool ok = true;
        if (slot->kind == GPU_SLOT_STORAGE_BUFFER) {
            ok = vk_use_buffer(g, b->buffer, access);
        } else if (slot->kind == GPU_SLOT_STORAGE_IMAGE || b->one_mip) {
            if (slot->kind != GPU_SLOT_UNIFORM) ok = vk_use_image(g, b->image, b->mip, 1, access);
        } else if (slot->kind == GPU_SLOT_SAMPLED_IMAGE) {
            ok = vk_use_image(g, b->image, 0, b->image->desc.mips, access);
        }
        if (!ok) return err_prefix("pipeline '%s', binding %u: ", pipeline->label, slot->binding);
    }
    return true;
}

// ---- bind -------------------------------------------------------------------------------------

typedef union descriptor {
    VkDescriptorImageInfo image;
    VkDescriptorBufferInfo buffer;
} descriptor;

static VkDescriptorImageInfo image_info(gpu *g, const gpu_slot *slot, const gpu_binding *b) {
    bool sampled = slot->kind == GPU_SLOT_SAMPLED_IMAGE;
    bool one = !sampled || b->one_mip;
    // An image that is sampled and loaded from at once is in the general layout (hazard_merge).
    const vk_tracked *tracked = &b->image->tracked[one ? b->mip : 0];
    return (VkDescriptorImageInfo){.sampler = sampled ? g->samplers[b->sampler] : VK_NULL_HANDLE,
                                   .imageView = one ? b->image->mips[b->mip] : b->image->all,
                                   .imageLayout = tracked->state.layout};
}

static bool buffer_info(gpu *g, const gpu_pipeline *pipeline, const gpu_slot *slot,
                        const gpu_binding *b, VkDescriptorBufferInfo *out) {
    if (slot->kind == GPU_SLOT_STORAGE_BUFFER) {
        *out = (VkDescriptorBufferInfo){.buffer = b->buffer->handle, .range = VK_WHOLE_SIZE};
        return true;
    }
    return vk_uniforms_add(g, b->uniform, b->uniform_size, out) ||
           err_prefix("pipeline '%s', binding %u: ", pipeline->label, b->binding);
}

VkDescriptorType vk_descriptor_type(gpu_slot_kind kind) {
    static const VkDescriptorType types[] = {
        [GPU_SLOT_UNIFORM] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
        [GPU_SLOT_STORAGE_BUFFER] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [GPU_SLOT_SAMPLED_IMAGE] = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        [GPU_SLOT_STORAGE_IMAGE] = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    return types[kind];
}

static bool add_pool(gpu *g, vk_sets *sets) {
    VkDescriptorPoolSize sizes[4];
    for (uint32_t kind = 0; kind < COUNT_OF(sizes); kind++) {
        sizes[kind].type = vk_descriptor_type((gpu_slot_kind)kind);
        sizes[kind].descriptorCount = SETS_OF_POOL * GPU_MAX_SLOTS;
    }
    VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = SETS_OF_POOL,
                                       .poolSizeCount = COUNT_OF(sizes),
                                       .pPoolSizes = sizes};
    VkDescriptorPool pool;
    if (!vk_check(g, g->vk.CreateDescriptorPool(g->device, &info, NULL, &pool),
                  "creating a pool of descriptors")) {
        return false;
    }
    *MEM_ADD(sets->pools, sets->count, sets->capacity) = pool;
    return true;
}

// Pools hold as many sets whatever these are like, so that no driver need say that one is full.
static bool take_set(gpu *g, const gpu_pipeline *pipeline, VkDescriptorSet *out) {
    vk_sets *sets = g->frame ? &g->frame->batch.sets : &g->batch->sets;
    size_t pool = sets->taken / SETS_OF_POOL;
    if (pool == sets->count && !add_pool(g, sets)) return false;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = sets->pools[pool],
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &pipeline->built->set_layout};
    sets->taken++;
    return vk_check(g, g->vk.AllocateDescriptorSets(g->device, &info, out),
                    "taking descriptors for pipeline '%s'", pipeline->label);
}

// Pools are kept: a batch that needed them once will do so again.
bool vk_sets_reset(gpu *g, vk_sets *sets) {
    for (size_t i = 0; i * SETS_OF_POOL < sets->taken; i++) {
        if (!vk_check(g, g->vk.ResetDescriptorPool(g->device, sets->pools[i], 0),
                      "emptying a pool of descriptors")) {
            return false;
        }
    }
    sets->taken = 0;
    return true;
}

void vk_sets_free(gpu *g, vk_sets *sets) {
    for (size_t i = 0; i < sets->count; i++) {
        g->vk.DestroyDescriptorPool(g->device, sets->pools[i], NULL);
    }
    mem_free(sets->pools);
}

bool vk_create_template(gpu *g, const gpu_pipeline *pipeline, vk_built *out) {
    VkDescriptorUpdateTemplateEntry entries[GPU_MAX_SLOTS];
    if (pipeline->slot_count == 0) return true;
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        entries[i] = (VkDescriptorUpdateTemplateEntry){
            .dstBinding = pipeline->slots[i].binding,
            .descriptorCount = 1,
            .descriptorType = vk_descriptor_type(pipeline->slots[i].kind),
            .offset = i * sizeof(descriptor)};
    }
    VkDescriptorUpdateTemplateCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO,
        .descriptorUpdateEntryCount = pipeline->slot_count,
        .pDescriptorUpdateEntries = entries,
        .templateType = g->push_descriptors
                            ? VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_PUSH_DESCRIPTORS_KHR
                            : VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_DESCRIPTOR_SET,
        .descriptorSetLayout = out->set_layout,
        .pipelineBindPoint = pipeline->bind_point,
        .pipelineLayout = out->layout};
    return vk_check(g,
                    g->vk.CreateDescriptorUpdateTemplate(g->device, &info, NULL, &out->descriptors),
                    "creating the template of pipeline '%s'", pipeline->label);
}

static bool hand_over(gpu *g, VkCommandBuffer commands, const gpu_pipeline *pipeline,
                      const descriptor *all) {
    const vk_built *built = pipeline->built;
    if (g->push_descriptors) {
        g->push_descriptors(commands, built->descriptors, built->layout, 0, all);
        return true;
    }
    VkDescriptorSet set;
    if (!take_set(g, pipeline, &set)) return false;
    g->vk.UpdateDescriptorSetWithTemplate(g->device, set, built->descriptors, all);
    g->vk.CmdBindDescriptorSets(commands, pipeline->bind_point, built->layout, 0, 1, &set, 0, NULL);
    return true;
}

bool vk_bindings_bind(gpu *g, VkCommandBuffer commands, const gpu_pipeline *pipeline,
                      const gpu_binding *list, size_t count) {
    descriptor all[GPU_MAX_SLOTS];
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        const gpu_slot *slot = &pipeline->slots[i];
        const gpu_binding *b = find(list, count, i, slot->binding);
        if (slot->kind == GPU_SLOT_SAMPLED_IMAGE || slot->kind == GPU_SLOT_STORAGE_IMAGE)
            all[i].image = image_info(g, slot, b);
        else if (!buffer_info(g, pipeline, slot, b, &all[i].buffer))
            return false;
    }
    return pipeline->slot_count == 0 || hand_over(g, commands, pipeline, all);
}
