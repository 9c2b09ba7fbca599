// Describes what a SPIR-V module binds, by SPIRV-Cross.
//
// Only resources that the entry point uses count. They are numbered in order of first use, so that
// a module never has two resources at one binding, whatever its text says. Fragment shaders count
// from 16, so that they do not collide with a vertex shader. Unused resources are then removed from
// the code: what remains is exactly what `slots` lists.
#include "base/memory.h"
#include "shader/annotate.h"
#include <spirv_cross/spirv_cross_c.h>
#include <stdlib.h>
#include <string.h>

enum { FRAGMENT_BASE = GPU_MAX_SLOTS / 2 };

#define LOOSE_BLOCK "gl_DefaultUniformBlock" // glslang's name of the block of loose uniforms
#define UNIFORMS "Uniforms"

typedef struct resource {
    const spvc_reflected_resource *spvc;
    spvc_resource_type kind;
} resource;

typedef struct reflector {
    spvc_context context;
    spvc_compiler compiler;
    spirv *code;
    arena *memory;
    shader_stage stage;
    resource found[GPU_MAX_SLOTS];
    size_t count;
} reflector;

static bool reflect_fail(const reflector *r) {
    return err_set("SPIR-V: %s", spvc_context_get_last_error_string(r->context));
}

// ---- resources --------------------------------------------------------------------------------

static bool reflect_collect(reflector *r, spvc_resources resources, spvc_resource_type kind) {
    const spvc_reflected_resource *list;
    size_t count;
    if (spvc_resources_get_resource_list_for_type(resources, kind, &list, &count))
        return reflect_fail(r);
    bool bindable =
        kind == SPVC_RESOURCE_TYPE_UNIFORM_BUFFER || kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER ||
        kind == SPVC_RESOURCE_TYPE_SAMPLED_IMAGE || kind == SPVC_RESOURCE_TYPE_STORAGE_IMAGE;
    if (count && !bindable)
        return err_set("%s: a resource of this kind is not supported; accepted are uniform blocks, "
                       "storage buffers, samplers and images",
                       list[0].name);
    size_t capacity = r->stage == SHADER_COMPUTE ? GPU_MAX_SLOTS : FRAGMENT_BASE;
    if (r->count + count > capacity)
        return err_set("more than %zu blocks, samplers and images are used", capacity);
    for (size_t i = 0; i < count; i++)
        r->found[r->count++] = (resource){.spvc = &list[i], .kind = kind};
    return true;
}

static int by_id(const void *a, const void *b) {
    spvc_variable_id x = ((const resource *)a)->spvc->id, y = ((const resource *)b)->spvc->id;
    return (x > y) - (x < y);
}

static bool collect_all(reflector *r) {
    static const spvc_resource_type kinds[] = {
        SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,    SPVC_RESOURCE_TYPE_STORAGE_BUFFER,
        SPVC_RESOURCE_TYPE_SAMPLED_IMAGE,     SPVC_RESOURCE_TYPE_STORAGE_IMAGE,
        SPVC_RESOURCE_TYPE_SUBPASS_INPUT,     SPVC_RESOURCE_TYPE_PUSH_CONSTANT,
        SPVC_RESOURCE_TYPE_ATOMIC_COUNTER,    SPVC_RESOURCE_TYPE_SEPARATE_IMAGE,
        SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE,
    };
    spvc_set used;
    spvc_resources resources;
    if (spvc_compiler_get_active_interface_variables(r->compiler, &used) ||
        spvc_compiler_create_shader_resources_for_active_variables(r->compiler, &resources, used))
        return reflect_fail(r);
    for (size_t i = 0; i < COUNT_OF(kinds); i++)
        if (!reflect_collect(r, resources, kinds[i])) return false;
    qsort(r->found, r->count, sizeof *r->found, by_id);
    return true;
}

static bool reflect_patch(reflector *r, spvc_variable_id id, SpvDecoration decoration,
                          uint32_t value) {
    unsigned offset;
    bool known =
        spvc_compiler_get_binary_offset_for_decoration(r->compiler, id, decoration, &offset);
    if (!known || offset >= r->code->count) return err_set("SPIR-V: a resource has no binding");
    r->code->words[offset] = value;
    return true;
}

// ---- slots ------------------------------------------------------------------------------------

static void access_of(const reflector *r, const resource *found, gpu_slot *slot) {
    bool no_read =
        spvc_compiler_has_decoration(r->compiler, found->spvc->id, SpvDecorationNonReadable);
    bool no_write =
        spvc_compiler_has_decoration(r->compiler, found->spvc->id, SpvDecorationNonWritable);
    const SpvDecoration *block;
    size_t count;
    if (found->kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER &&
        !spvc_compiler_get_buffer_block_decorations(r->compiler, found->spvc->id, &block, &count)) {
        for (size_t i = 0; i < count; i++) {
            no_read |= block[i] == SpvDecorationNonReadable;
            no_write |= block[i] == SpvDecorationNonWritable;
        }
    }
    bool storage = slot->kind == GPU_SLOT_STORAGE_BUFFER || slot->kind == GPU_SLOT_STORAGE_IMAGE;
    slot->reads = !storage || !no_read;
    slot->writes = storage && !no_write;
}

static bool reflect_describe(reflector *r, const resource *found, uint32_t binding,
                             shader_slot *out) {
    spvc_type type = spvc_compiler_get_type_handle(r->compiler, found->spvc->type_id);
    const char *name = found->spvc->name;
    if (spvc_type_get_num_array_dimensions(type))
        return err_set("%s: arrays of blocks, samplers or images are not supported", name);
    *out = (shader_slot){.slot.binding = binding};
    out->name = arena_string(r->memory, strcmp(name, LOOSE_BLOCK) == 0 ? UNIFORMS : name);
    switch (found->kind) {
    case SPVC_RESOURCE_TYPE_UNIFORM_BUFFER: {
        size_t size;
        spvc_type block = spvc_compiler_get_type_handle(r->compiler, found->spvc->base_type_id);
        if (spvc_compiler_get_declared_struct_size(r->compiler, block, &size))
            return reflect_fail(r);
        out->slot.kind = GPU_SLOT_UNIFORM;
        out->size = (uint32_t)((size + 15) & ~(size_t)15); // std140 rounds blocks to a vec4
        break;
    }
    case SPVC_RESOURCE_TYPE_STORAGE_BUFFER:
        out->slot.kind = GPU_SLOT_STORAGE_BUFFER;
        break;
    case SPVC_RESOURCE_TYPE_SAMPLED_IMAGE:
        out->slot.kind = GPU_SLOT_SAMPLED_IMAGE;
        break;
    default:
        out->slot.kind = GPU_SLOT_STORAGE_IMAGE;
        break;
    }
    bool image =
        out->slot.kind == GPU_SLOT_SAMPLED_IMAGE || out->slot.kind == GPU_SLOT_STORAGE_IMAGE;
    if (image) {
        SpvDim dimension = spvc_type_get_image_dimension(type);
        out->volume = dimension == SpvDim3D;
        if ((dimension != SpvDim2D && dimension != SpvDim3D) || spvc_type_get_image_arrayed(type) ||
            spvc_type_get_image_multisampled(type))
            return err_set("%s: only 2D and 3D images are supported, no arrays", name);
    }
    access_of(r, found, &out->slot);
    return true;
}

// ---- members ----------------------------------------------------------------------------------

static bool type_of(spvc_type type, shader_type *out) {
    static const shader_type vectors[] = {SHADER_FLOAT, SHADER_VEC2, SHADER_VEC3, SHADER_VEC4};
    spvc_basetype base = spvc_type_get_basetype(type);
    unsigned size = spvc_type_get_vector_size(type), columns = spvc_type_get_columns(type);
    bool integer = base == SPVC_BASETYPE_INT32 || base == SPVC_BASETYPE_UINT32;
    *out = columns == 4 ? SHADER_MAT4 : integer ? SHADER_INT : vectors[(size - 1) & 3];
    if (integer) return size == 1 && columns == 1;
    return base == SPVC_BASETYPE_FP32 && size <= 4 && (columns == 1 || (columns == 4 && size == 4));
}

static bool describe_member(reflector *r, spvc_type_id block_id, spvc_type block, unsigned i,
                            shader_member *out) {
    spvc_type type =
        spvc_compiler_get_type_handle(r->compiler, spvc_type_get_member_type(block, i));
    const char *name = spvc_compiler_get_member_name(r->compiler, block_id, i);
    unsigned dimensions = spvc_type_get_num_array_dimensions(type);
    if (dimensions > 1 || !type_of(type, &out->type))
        return err_set("uniform %s: this type is not supported; accepted are float, vec2, vec3, "
                       "vec4, int, uint, bool, mat4 and arrays of them",
                       name);
    size_t size;
    unsigned offset;
    if (spvc_compiler_type_struct_member_offset(r->compiler, block, i, &offset) ||
        spvc_compiler_get_declared_struct_member_size(r->compiler, block, i, &size))
        return reflect_fail(r);
    out->name = declaration_public_name(r->memory, name);
    out->offset = offset;
    out->size = (uint32_t)size;
    out->array = dimensions ? spvc_type_get_array_dimension(type, 0) : 0;
    return true;
}

static bool describe_members(reflector *r, const resource *found, shader_binary *out) {
    if (out->members)
        return err_set("the block name \"" UNIFORMS "\" is taken by the loose uniforms");
    spvc_type_id id = found->spvc->base_type_id;
    spvc_type block = spvc_compiler_get_type_handle(r->compiler, id);
    unsigned count = spvc_type_get_num_member_types(block);
    shader_member *members = arena_alloc(r->memory, count * sizeof *members);
    for (unsigned i = 0; i < count; i++)
        if (!describe_member(r, id, block, i, &members[i])) return false;
    out->members = members;
    out->member_count = count;
    return true;
}

// ---- the whole --------------------------------------------------------------------------------

static bool local_size(reflector *r, uint32_t out[3]) {
    const SpvExecutionMode *modes;
    size_t count;
    if (spvc_compiler_get_execution_modes(r->compiler, &modes, &count)) return reflect_fail(r);
    for (size_t i = 0; i < count; i++) {
        if (modes[i] != SpvExecutionModeLocalSize && modes[i] != SpvExecutionModeLocalSizeId)
            continue;
        for (unsigned axis = 0; axis < 3; axis++) {
            unsigned value =
                spvc_compiler_get_execution_mode_argument_by_index(r->compiler, modes[i], axis);
            if (modes[i] == SpvExecutionModeLocalSizeId)
                value = spvc_constant_get_scalar_u32(
                    spvc_compiler_get_constant_handle(r->compiler, value), 0, 0);
            out[axis] = value;
        }
    }
    return true;
}

static bool reflect_all(reflector *r, shader_binary *out) {
    spvc_parsed_ir ir;
    if (spvc_context_parse_spirv(r->context, r->code->words, r->code->count, &ir) ||
        spvc_context_create_compiler(r->context, SPVC_BACKEND_NONE, ir,
                                     SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &r->compiler))
        return reflect_fail(r);
    if (!collect_all(r) || !local_size(r, out->local_size)) return false;
    shader_slot *slots = arena_alloc(r->memory, r->count * sizeof *slots);
    uint32_t live[GPU_MAX_SLOTS];
    for (size_t i = 0; i < r->count; i++) {
        uint32_t binding = (uint32_t)i + (r->stage == SHADER_FRAGMENT ? FRAGMENT_BASE : 0);
        const resource *found = &r->found[i];
        live[i] = found->spvc->id;
        if (!reflect_patch(r, live[i], SpvDecorationBinding, binding) ||
            !reflect_patch(r, live[i], SpvDecorationDescriptorSet, 0) ||
            !reflect_describe(r, found, binding, &slots[i]))
            return false;
        if (slots[i].slot.kind == GPU_SLOT_UNIFORM && strcmp(slots[i].name, UNIFORMS) == 0 &&
            !describe_members(r, found, out))
            return false;
    }
    spirv_clean(r->code, out->local_size, live, r->count);
    out->slots = slots;
    out->slot_count = r->count;
    return true;
}

bool spirv_reflect(spirv *code, shader_stage stage, arena *memory, shader_binary *out) {
    reflector r = {.code = code, .memory = memory, .stage = stage};
    *out = (shader_binary){0};
    if (!spirv_gate(code)) return false;
    if (spvc_context_create(&r.context)) return err_set("SPIR-V: cannot be read");
    bool done = reflect_all(&r, out);
    spvc_context_destroy(r.context);
    return done;
}
