// Pipelines. Descriptors are one set (0), vertices pulled from buffers, rendering is dynamic: a
// pipeline is its shaders, its slots and its target formats. What the driver makes of them is
// shared (share.c); label and slots, which messages and barriers want, are each pipeline's own.
//
// May be called from any thread: creation touches only its own objects, the locked table of share.c
// and the pipeline cache, which the driver locks; destruction goes through the locked queue of
// destroy.c.
#include "base/memory.h"
#include "gpu/spirv.h"
#include "gpu/vk.h"
#include <string.h>

static bool create_layout(gpu *g, const gpu_pipeline *pipeline, VkShaderStageFlags stages,
                          vk_built *out) {
    const VkShaderStageFlags flags[] = {[GPU_STAGE_ALL] = stages,
                                        [GPU_STAGE_VERTEX] = VK_SHADER_STAGE_VERTEX_BIT,
                                        [GPU_STAGE_FRAGMENT] = VK_SHADER_STAGE_FRAGMENT_BIT};
    VkDescriptorSetLayoutBinding bindings[GPU_MAX_SLOTS];
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = pipeline->slots[i].binding,
            .descriptorType = vk_descriptor_type(pipeline->slots[i].kind),
            .descriptorCount = 1,
            .stageFlags = flags[pipeline->slots[i].stage]};
    }
    VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .flags = g->push_descriptors ? VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR : 0,
        .bindingCount = pipeline->slot_count,
        .pBindings = bindings};
    if (!vk_check(g, g->vk.CreateDescriptorSetLayout(g->device, &set, NULL, &out->set_layout),
                  "creating the slots of pipeline '%s'", pipeline->label)) {
        return false;
    }
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 1,
                                       .pSetLayouts = &out->set_layout};
    return vk_check(g, g->vk.CreatePipelineLayout(g->device, &info, NULL, &out->layout),
                    "creating the layout of pipeline '%s'", pipeline->label) &&
           vk_create_template(g, pipeline, out);
}

static bool check_count(const char *label, const char *limit, const char *what, uint32_t wanted,
                        uint32_t most) {
    return wanted <= most ||
           err_set("pipeline '%s' has %u %s in a stage; the device allows %u (%s)", label, wanted,
                   what, most, limit);
}

// Of a compute shader all slots are of both.
static bool check_stage(gpu *g, const char *label, const gpu_slot *slots, size_t count,
                        gpu_stage stage) {
    uint32_t kinds[4] = {0};
    for (size_t i = 0; i < count; i++)
        if (slots[i].stage == GPU_STAGE_ALL || slots[i].stage == stage) kinds[slots[i].kind]++;
    const gpu_demand demand = {.storage_buffers = kinds[GPU_SLOT_STORAGE_BUFFER],
                               .storage_images = kinds[GPU_SLOT_STORAGE_IMAGE]};
    return check_count(label, "maxPerStageDescriptorUniformBuffers", "uniform blocks",
                       kinds[GPU_SLOT_UNIFORM], g->limits.maxPerStageDescriptorUniformBuffers) &&
           check_count(label, "maxPerStageDescriptorSampledImages", "sampled images",
                       kinds[GPU_SLOT_SAMPLED_IMAGE],
                       g->limits.maxPerStageDescriptorSampledImages) &&
           gpu_meets_limits(&g->profile.limits, label, &demand);
}

static bool check_slots(gpu *g, const char *label, const gpu_slot *slots, size_t count) {
    if (count > GPU_MAX_SLOTS) {
        return err_set("pipeline '%s' has %zu bindings; at most %d are accepted", label, count,
                       GPU_MAX_SLOTS);
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            if (slots[i].binding == slots[j].binding) {
                return err_set("pipeline '%s' has binding %u twice", label, slots[i].binding);
            }
        }
    }
    return check_stage(g, label, slots, count, GPU_STAGE_VERTEX) &&
           check_stage(g, label, slots, count, GPU_STAGE_FRAGMENT);
}

static gpu_pipeline *pipeline_new(const char *label, const gpu_slot *slots, size_t count) {
    gpu_pipeline *pipeline = mem_alloc(sizeof *pipeline);
    pipeline->label = mem_copy(label, strlen(label) + 1);
    if (count > 0) memcpy(pipeline->slots, slots, count * sizeof *slots);
    pipeline->slot_count = (uint32_t)count;
    return pipeline;
}

static void pipeline_free(gpu_pipeline *pipeline) {
    mem_free(pipeline->label);
    mem_free(pipeline);
}

static bool check_code(const char *label, const uint32_t *code, size_t size) {
    static const uint32_t magic = 0x07230203;
    if (code && size >= 20 && size % 4 == 0 && code[0] == magic) return true;
    return err_set("pipeline '%s': the shader code is not SPIR-V", label);
}

static bool create_module(gpu *g, const char *label, const uint32_t *code, size_t size,
                          VkShaderModule *out) {
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    return vk_check(g, g->vk.CreateShaderModule(g->device, &info, NULL, out),
                    "loading the shader of pipeline '%s'", label);
}

// Of all but the shaders and the rasteriser's settings: what slots read and write does not matter
// to the driver.
static hash128 hash_interface(const gpu_pipeline *pipeline) {
    uint32_t words[2 + GPU_MAX_TARGETS + 3 * GPU_MAX_SLOTS] = {pipeline->bind_point,
                                                               pipeline->depth};
    uint32_t count = 2;
    for (uint32_t i = 0; i < GPU_MAX_TARGETS; i++) words[count++] = pipeline->colors[i];
    for (uint32_t i = 0; i < pipeline->slot_count; i++) {
        words[count++] = pipeline->slots[i].binding;
        words[count++] = pipeline->slots[i].kind;
        words[count++] = pipeline->slots[i].stage;
    }
    return hash_bytes(words, count * sizeof *words);
}

// What a driver gets for a module of ours, for mem_free.
typedef struct rewritten {
    uint32_t *clamped, *hoisted, *hidden; // NULL: left as it was
    const uint32_t *code;
    size_t size;
} rewritten;

static bool clamp(const char *label, rewritten *r) {
    if (!vk_clamp_indices(r->code, r->size, &r->clamped, &r->size))
        return err_set("pipeline '%s': the indices in its code cannot be kept in bounds", label);
    if (r->clamped) r->code = r->clamped;
    return true;
}

static void rewrite_uniforms(const gpu_profile *profile, rewritten *r) {
    if (profile->hoists_uniforms) r->hoisted = vk_hoist_uniforms(r->code, r->size, &r->size);
    if (r->hoisted) r->code = r->hoisted;
    if (profile->hides_uniforms) r->hidden = vk_hide_uniforms(r->code, r->size, &r->size);
    if (r->hidden) r->code = r->hidden;
}

// `vertex`: the shader is short, and keeps its uniforms.
static bool create_rewritten_module(gpu *g, const char *label, const uint32_t *code, size_t size,
                                    bool vertex, VkShaderModule *out) {
    rewritten r = {.code = code, .size = size};
    bool created = !g->profile.clamps_indices || clamp(label, &r);
    if (created && !vertex) rewrite_uniforms(&g->profile, &r);
    created = created && create_module(g, label, r.code, r.size, out);
    mem_free(r.hidden);
    mem_free(r.hoisted);
    mem_free(r.clamped);
    return created;
}

// Gives the pipeline what the driver makes of it: what there is of an equal description, or what
// `build` makes of `desc`. `shaders`: the hash of all that the pipeline does not hold. NULL with a
// message: it could not be built, and the pipeline is gone.
static gpu_pipeline *complete(gpu *g, gpu_pipeline *pipeline, hash128 shaders,
                              bool (*build)(gpu *g, const gpu_pipeline *pipeline, const void *desc,
                                            vk_built *out),
                              const void *desc) {
    hash128 key = hash_combine(shaders, hash_interface(pipeline));
    vk_built *built = vk_built_find(g, key);
    if (!built) {
        built = mem_alloc(sizeof *built);
        built->key = key;
        if (!build(g, pipeline, desc, built)) {
            vk_built_free(g, built);
            pipeline_free(pipeline);
            return NULL;
        }
        vk_name(g, VK_OBJECT_TYPE_PIPELINE, VK_HANDLE(built->handle), pipeline->label);
        built = vk_built_add(g, built);
    }
    pipeline->built = built;
    return pipeline;
}

// ---- compute ----------------------------------------------------------------------------------

static bool check_local_size(gpu *g, const char *label, const uint32_t size[3]) {
    const uint32_t *most = g->limits.maxComputeWorkGroupSize;
    bool fits = true;
    for (int i = 0; i < 3; i++) fits = fits && size[i] > 0 && size[i] <= most[i];
    if (!fits)
        return err_set("pipeline '%s' has groups of %ux%ux%u threads; the device allows %ux%ux%u "
                       "(maxComputeWorkGroupSize)",
                       label, size[0], size[1], size[2], most[0], most[1], most[2]);
    const gpu_demand demand = {.threads = size[0] * size[1] * size[2]};
    return gpu_meets_limits(&g->profile.limits, label, &demand);
}

// Asked once for what the driver is to build; groups of more do not start, or end the driver.
static bool check_shared_memory(gpu *g, const char *label, const uint32_t *code, size_t size) {
    gpu_demand demand = {0};
    if (!spirv_shared_bytes(code, size / 4, &demand.shared_bytes))
        return err_set("pipeline '%s': the shader code is not SPIR-V", label);
    return gpu_meets_limits(&g->profile.limits, label, &demand);
}

// Whether a shader asks how many groups there are (gl_NumWorkGroups): slices have fewer.
static bool counts_groups(const uint32_t *code, size_t size) {
    size_t count = size / 4, words;
    for (size_t at = SPIRV_HEADER; at < count; at += words) {
        const uint32_t *w = code + at;
        words = w[0] >> 16;
        if (!words || words > count - at) return true;
        if (words == 4 && (w[0] & 0xffff) == SpvOpDecorate && w[2] == SpvDecorationBuiltIn &&
            w[3] == SpvBuiltInNumWorkgroups)
            return true;
    }
    return false;
}

static bool build_compute(gpu *g, const gpu_pipeline *pipeline, const void *from, vk_built *out) {
    const gpu_compute_desc *desc = from;
    VkShaderModule module;
    out->sliced = g->profile.slices_dispatches && !counts_groups(desc->code, desc->code_size);
    if (!check_shared_memory(g, pipeline->label, desc->code, desc->code_size)) return false;
    if (!create_layout(g, pipeline, VK_SHADER_STAGE_COMPUTE_BIT, out)) return false;
    if (!create_rewritten_module(g, pipeline->label, desc->code, desc->code_size, false, &module))
        return false;
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = out->sliced ? VK_PIPELINE_CREATE_DISPATCH_BASE_BIT : 0,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = out->layout};
    VkResult result =
        g->vk.CreateComputePipelines(g->device, g->cache, 1, &info, NULL, &out->handle);
    g->vk.DestroyShaderModule(g->device, module, NULL);
    return vk_check(g, result, "creating pipeline '%s'", pipeline->label);
}

gpu_pipeline *gpu_pipeline_create_compute(gpu *g, const gpu_compute_desc *desc) {
    const char *label = desc->label ? desc->label : "compute";
    if (!vk_alive(g) || !check_slots(g, label, desc->slots, desc->slot_count) ||
        !check_local_size(g, label, desc->local_size) ||
        !check_code(label, desc->code, desc->code_size)) {
        return NULL;
    }
    gpu_pipeline *pipeline = pipeline_new(label, desc->slots, desc->slot_count);
    pipeline->bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
    memcpy(pipeline->local_size, desc->local_size, sizeof pipeline->local_size);
    return complete(g, pipeline, hash_bytes(desc->code, desc->code_size), build_compute, desc);
}

// ---- graphics ---------------------------------------------------------------------------------

// Premultiplied colours over what is there: the new colour is c + (1 - a) * old, alpha alike.
static VkPipelineColorBlendAttachmentState blend_state(bool blend) {
    return (VkPipelineColorBlendAttachmentState){
        .blendEnable = blend,
        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .colorBlendOp = VK_BLEND_OP_ADD,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .alphaBlendOp = VK_BLEND_OP_ADD,
        .colorWriteMask = 0xf};
}

static VkResult create_graphics(gpu *g, const gpu_pipeline *pipeline, const gpu_graphics_desc *desc,
                                const VkPipelineShaderStageCreateInfo stages[2], vk_built *out) {
    VkFormat formats[GPU_MAX_TARGETS];
    VkPipelineColorBlendAttachmentState blends[GPU_MAX_TARGETS];
    for (uint32_t i = 0; i < pipeline->color_count; i++) {
        formats[i] = vk_format_get(pipeline->colors[i])->format;
        blends[i] = blend_state(desc->blend);
    }
    bool depth = pipeline->depth != GPU_FORMAT_NONE;
    VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = pipeline->color_count,
        .pColorAttachmentFormats = formats,
        .depthAttachmentFormat = vk_format_get(pipeline->depth)->format};
    VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = desc->cull == GPU_CULL_BACK ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE,
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1.0f};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo test = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = depth,
        .depthWriteEnable = depth,
        .depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = pipeline->color_count,
        .pAttachments = blends};
    static const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT,
                                                    VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = COUNT_OF(dynamic_states),
        .pDynamicStates = dynamic_states};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .pNext = &rendering,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &vertices,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &test,
                                         .pColorBlendState = &blend,
                                         .pDynamicState = &dynamic,
                                         .layout = out->layout};
    return g->vk.CreateGraphicsPipelines(g->device, g->cache, 1, &info, NULL, &out->handle);
}

static bool build_graphics(gpu *g, const gpu_pipeline *pipeline, const void *from, vk_built *out) {
    const gpu_graphics_desc *desc = from;
    VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .pName = "main"}};
    bool ok = create_layout(g, pipeline, both, out) &&
              create_rewritten_module(g, pipeline->label, desc->vertex_code, desc->vertex_size,
                                      true, &stages[0].module) &&
              create_rewritten_module(g, pipeline->label, desc->fragment_code, desc->fragment_size,
                                      false, &stages[1].module) &&
              vk_check(g, create_graphics(g, pipeline, desc, stages, out), "creating pipeline '%s'",
                       pipeline->label);
    g->vk.DestroyShaderModule(g->device, stages[0].module, NULL);
    g->vk.DestroyShaderModule(g->device, stages[1].module, NULL);
    return ok;
}

static bool check_targets(gpu *g, const char *label, const gpu_graphics_desc *desc) {
    for (uint32_t i = 0; i < GPU_MAX_TARGETS && desc->colors[i]; i++) {
        if (i == g->limits.maxColorAttachments)
            return err_set("pipeline '%s': the device draws to at most %u colour targets at once",
                           label, i);
        if (desc->colors[i] >= GPU_FORMAT_COUNT ||
            !(g->format_features[desc->colors[i]] & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) {
            return err_set("pipeline '%s': colour target %u has a format that cannot be drawn to",
                           label, i);
        }
        if (desc->blend &&
            !(g->format_features[desc->colors[i]] & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {
            return err_set("pipeline '%s': the device cannot blend colour target %u of format %s",
                           label, i, gpu_format_name(desc->colors[i]));
        }
    }
    if (desc->depth != GPU_FORMAT_NONE && desc->depth != GPU_D32F) {
        return err_set("pipeline '%s': the depth target must have format d32f", label);
    }
    return true;
}

gpu_pipeline *gpu_pipeline_create_graphics(gpu *g, const gpu_graphics_desc *desc) {
    const char *label = desc->label ? desc->label : "graphics";
    if (!vk_alive(g) || !check_slots(g, label, desc->slots, desc->slot_count) ||
        !check_targets(g, label, desc) ||
        !check_code(label, desc->vertex_code, desc->vertex_size) ||
        !check_code(label, desc->fragment_code, desc->fragment_size)) {
        return NULL;
    }
    gpu_pipeline *pipeline = pipeline_new(label, desc->slots, desc->slot_count);
    pipeline->bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
    pipeline->depth = desc->depth;
    for (int i = 0; i < GPU_MAX_TARGETS && desc->colors[i]; i++) {
        pipeline->colors[pipeline->color_count++] = desc->colors[i];
    }
    const uint32_t raster[2] = {desc->cull, desc->blend};
    hash128 key = hash_combine(hash_bytes(desc->vertex_code, desc->vertex_size),
                               hash_bytes(desc->fragment_code, desc->fragment_size));
    key = hash_combine(key, hash_bytes(raster, sizeof raster));
    return complete(g, pipeline, key, build_graphics, desc);
}

void gpu_pipeline_destroy(gpu *g, gpu_pipeline *pipeline) {
    if (!pipeline) return;
    vk_built_release(g, pipeline->built);
    pipeline_free(pipeline);
}
