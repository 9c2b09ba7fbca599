// Kernels of a pass: compiled with its options, fields and what its type adds, and given by number
// what the pass knows. Each slot's source is found once, when the kernel is compiled.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "base/worker.h"
#include "pass/pass_impl.h"
#include "pass/ranges.h"
#include <math.h>
#include <string.h>

typedef enum source_kind {
    FROM_TYPE, // the type's hooks bind it
    FROM_KERNEL,
    FROM_FRAME,
    FROM_LIGHTS,
    FROM_NUMBERS,
    FROM_TEXTURE, // of the fields
    FROM_IMAGE,   // of the interface
    FROM_PROVIDER,
} source_kind;

typedef struct slot_source {
    source_kind kind;
    int16_t index, row; // of textures, images or the provider's slots; of providers
} slot_source;

enum { COMMON_BOX_MIN, COMMON_BOX_MAX, COMMON_NAMES };
static const char *const common_names[COMMON_NAMES] = {"box_min", "box_max"};

typedef struct value_copy { // of a uniform of the interface that the kernel has
    const kernel_place *to;
    uint16_t uniform;
    bool whole;
} value_copy;

typedef struct pass_built {
    kernel base;
    value_copy *copies;
    size_t copy_count;
    const kernel_place *common, *solver;
    const kernel_place *provided[PASS_PROVIDERS]; // NULL: nothing of that row's is in it
    slot_source sources[GPU_MAX_SLOTS];
} pass_built;

static const pass_kernel own_shader = {0};

static size_t count_own(const pass *p) { // of the type
    return p->type && p->type->kernels ? p->type->kernel_count : 1;
}

// Those of providers stand behind those of the type.
typedef struct kernel_row {
    const pass_kernel *kernel;
    const pass_provider *provider; // NULL: it is the type's
    size_t index;                  // in the list of either
} kernel_row;

// The kernels of providers up to one that is not used, or NULL.
static size_t count_provided(const pass *p, const pass_provider *until) {
    size_t found = 0;
    for (size_t i = 0; i < PASS_PROVIDERS && pass_providers[i] != until; i++)
        if (pass_providers[i]->uses && pass_providers[i]->uses(p))
            found += pass_providers[i]->kernel_count;
    return found;
}

static size_t count_kernels(const pass *p) {
    return count_own(p) + count_provided(p, NULL);
}

static kernel_row find_row(const pass *p, size_t index) {
    size_t left = index - count_own(p);
    if (index < count_own(p))
        return (kernel_row){p->type && p->type->kernels ? &p->type->kernels[index] : &own_shader,
                            NULL, index};
    for (size_t i = 0; i < PASS_PROVIDERS; i++) {
        const pass_provider *row = pass_providers[i];
        if (!row->uses || !row->uses(p)) continue;
        if (left < row->kernel_count) return (kernel_row){&row->kernels[left], row, left};
        left -= row->kernel_count;
    }
    return (kernel_row){&own_shader, NULL, 0};
}

// ---- compiling --------------------------------------------------------------------------------

void pass_define(pass_defines *out, const char *name, const char *value) {
    if (out->count < COUNT_OF(out->items)) out->items[out->count++] = (shader_define){name, value};
}

void pass_define_number(pass *p, pass_defines *out, const char *name, uint32_t value) {
    pass_define(out, name, arena_format(p->host->memory, "%u", value));
}

void pass_define_flag(pass_defines *out, const char *name, bool value) {
    pass_define(out, name, value ? "1" : "0");
}

static kernel_names solver_names(const pass *p) {
    return p->type && p->type->solver ? p->type->solver->names : (kernel_names){0};
}

static bool is_of_type(const pass *p, const char *name) {
    const kernel_names own = pass_names_of(p), solver = solver_names(p);
    return words_find(own.items, own.count, name) >= 0 ||
           words_find(solver.items, solver.count, name) >= 0;
}

static int find_texture(const pass *p, const char *name) {
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++)
        if (strcmp(textures[i].glsl_name, name) == 0) return (int)i;
    return -1;
}

static int find_glsl_image(const pass *p, const char *name) {
    for (size_t i = 0; i < p->face->image_count; i++)
        if (strcmp(p->face->images[i].glsl_name, name) == 0) return (int)i;
    return -1;
}

static bool find_provided(const char *name, slot_source *out) {
    for (size_t i = 0; i < PASS_PROVIDERS; i++) {
        const kernel_names slots = pass_providers[i]->slots;
        const int slot = words_find(slots.items, slots.count, name);
        if (slot < 0) continue;
        *out = (slot_source){FROM_PROVIDER, (int16_t)slot, (int16_t)i};
        return true;
    }
    return false;
}

static bool find_block(const pass *p, const char *name, slot_source *out) {
    static const struct {
        const char *name;
        source_kind kind;
    } blocks[] = {{"Uniforms", FROM_KERNEL},
                  {"Frame", FROM_FRAME},
                  {"Lights", FROM_LIGHTS},
                  {"FieldNumbers", FROM_NUMBERS}};
    for (size_t i = 0; i < COUNT_OF(blocks); i++) {
        if (strcmp(blocks[i].name, name) != 0) continue;
        out->kind = blocks[i].kind;
        return true;
    }
    if (is_of_type(p, name)) return true;
    return err_set("%s: uniform block '%s' is not known; declare loose uniforms instead", p->label,
                   name);
}

static bool find_source(const pass *p, const shader_slot *slot, slot_source *out) {
    int index = -1;
    *out = (slot_source){FROM_TYPE, 0, 0};
    if (slot->slot.kind == GPU_SLOT_UNIFORM) return find_block(p, slot->name, out);
    const bool image = slot->slot.kind != GPU_SLOT_STORAGE_BUFFER;
    if (image && (index = find_texture(p, slot->name)) >= 0)
        *out = (slot_source){FROM_TEXTURE, (int16_t)index, 0};
    else if (image && (index = find_glsl_image(p, slot->name)) >= 0)
        *out = (slot_source){FROM_IMAGE, (int16_t)index, 0};
    else if (!is_of_type(p, slot->name) && !find_provided(slot->name, out))
        return image ? err_set("%s: image '%s' has no annotation (//= input or //= output)",
                               p->label, slot->name)
                     : err_set("%s: storage buffer '%s' is neither a provider's nor among the "
                               "names of the pass's type",
                               p->label, slot->name);
    return true;
}

static bool has_any(const kernel_place *places, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (places[i].member[0] >= 0 || places[i].member[1] >= 0) return true;
    return false;
}

static void find_copies(pass *p, pass_built *b, const kernel_place *places) {
    b->copies = arena_alloc(p->host->memory, (p->face->uniform_count + 1) * sizeof *b->copies);
    for (size_t i = 0; i < p->face->uniform_count; i++) {
        if (!has_any(&places[i], 1)) continue;
        const int stage = places[i].member[0] < 0;
        const shader_member *member = &b->base.binaries[stage].members[places[i].member[stage]];
        b->copies[b->copy_count++] =
            (value_copy){&places[i], (uint16_t)i, member->type == SHADER_INT};
    }
}

static void find_places(pass *p, pass_built *b) {
    arena *memory = p->host->memory;
    const shader_interface *face = p->face;
    const char **names = mem_alloc((face->uniform_count + 1) * sizeof *names);
    for (size_t i = 0; i < face->uniform_count; i++) names[i] = face->uniforms[i].name;
    find_copies(p, b, kernel_find(&b->base, memory, (kernel_names){names, face->uniform_count}));
    b->common = kernel_find(&b->base, memory, (kernel_names){common_names, COMMON_NAMES});
    b->solver = kernel_find(&b->base, memory, solver_names(p));
    mem_free(names);
    for (size_t i = 0; i < PASS_PROVIDERS; i++) {
        const kernel_names uniforms = pass_providers[i]->uniforms;
        const kernel_place *places = kernel_find(&b->base, memory, uniforms);
        b->provided[i] = has_any(places, uniforms.count) ? places : NULL;
    }
}

static void note_wanted(pass *p, const pass_built *b) {
    for (size_t i = 0; i < b->copy_count; i++) p->wanted[b->copies[i].uniform] = true;
}

static bool add_stage(pass *p, kernel_source *source, const char *shader, shader_stage stage,
                      const pass_defines *defines) {
    return pass_describe_stage(p, shader, stage, defines, &source->stages[source->stage_count++]);
}

static bool is_left_out(pass *p, const kernel_row *at, pass_defines *out) {
    if (at->provider) return at->provider->wants && !at->provider->wants(p, at->index);
    return p->type && p->type->defines && !p->type->defines(p, at->index, out);
}

// `*left_out`: the type or the provider wants none.
static bool compile_kernel(pass *p, size_t index, pass_built *b, bool *left_out) {
    const kernel_row at = find_row(p, index);
    const pass_kernel *row = at.kernel;
    const char *shader = row->shader ? row->shader : p->shader;
    pass_defines defines = {.count = 0};
    kernel_source source = {.label = p->label,
                            .names = at.provider ? at.provider->names : pass_names_of(p)};
    *left_out = is_left_out(p, &at, &defines);
    if (*left_out) return true;
    if (row->define) pass_define(&defines, row->define, "1");
    if (row->without_fields) pass_define(&defines, "WITHOUT_FIELDS", "1");
    bool done;
    if (row->vertex) {
        done = add_stage(p, &source, row->vertex, SHADER_VERTEX, &defines) &&
               add_stage(p, &source, shader, SHADER_FRAGMENT, &defines);
    } else if (str_ends_with(shader, ".frag")) { // over the whole picture
        source.stages[source.stage_count++] = (shader_compile_desc){
            .name = "lib/fullscreen.vert", .stage = SHADER_VERTEX, .reader = p->host->reader};
        done = add_stage(p, &source, shader, SHADER_FRAGMENT, &defines);
    } else {
        done = add_stage(p, &source, shader, SHADER_COMPUTE, &defines);
    }
    if (!done || !kernel_compile(&b->base, p->host->library, p->host->memory, &source))
        return err_prefix("%s: ", p->label);
    for (size_t i = 0; i < b->base.slot_count; i++)
        if (!find_source(p, b->base.slots[i], &b->sources[i])) return false;
    find_places(p, b);
    return true;
}

static void describe_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    const kernel_row at = find_row(p, index);
    if (at.provider) {
        at.provider->target(p, at.index, out);
        return;
    }
    if (p->type && p->type->target) {
        p->type->target(p, index, out);
        return;
    }
    size_t count = 0;
    for (size_t i = 0; i < p->face->image_count && count < GPU_MAX_TARGETS; i++)
        if (p->face->images[i].output) out->colors[count++] = p->formats[i];
}

static bool build_kernel(pass *p, size_t index, pass_built *b) {
    gpu *device = p->host->device;
    for (int s = 0; s < b->base.stages; s++)
        if (!pass_ranges_build(p, &b->base.binaries[s])) return false;
    if (b->base.stages == 1) return kernel_build(&b->base, device);
    gpu_graphics_desc target = {0};
    describe_target(p, index, &target);
    return kernel_build_drawn(&b->base, device, target);
}

static void allocate(pass *p) {
    arena *memory = p->host->memory;
    const size_t uniforms = p->face->uniform_count + 1;
    if (!p->built) {
        p->built_count = count_kernels(p);
        p->built = arena_alloc(memory, p->built_count * sizeof *p->built);
    }
    if (p->values) return;
    p->values = arena_alloc(memory, uniforms * sizeof *p->values);
    p->wanted = arena_alloc(memory, uniforms * sizeof *p->wanted);
    for (size_t i = 0; i < pass_names_of(p).count; i++)
        if (p->names[i].uniform >= 0) p->wanted[p->names[i].uniform] = true;
}

// What is there stays until all of it is made anew.
static bool make(pass *p, size_t index) {
    pass_built made = {.base.pipeline = NULL};
    bool left_out;
    if (!compile_kernel(p, index, &made, &left_out)) return false;
    if (p->host->device && !left_out && !build_kernel(p, index, &made)) return false;
    kernel_destroy(&p->built[index].base, p->host->device);
    p->built[index] = made;
    return true;
}

static bool build_one(void *user, size_t index) {
    pass *p = user;
    const bool later = p->host->device && index < count_own(p) && p->type && p->type->foresees &&
                       !p->type->foresees(p, index);
    return later || make(p, index);
}

bool pass_build_kernels(pass *p) {
    allocate(p);
    if (!worker_each(p->built_count, build_one, p)) return false;
    for (size_t i = 0; i < p->built_count; i++)
        if (p->built[i].base.stages) note_wanted(p, &p->built[i]);
    return true;
}

bool pass_has_kernel(const pass *p, size_t index) {
    return p->built[index].base.pipeline;
}

bool pass_reads_frame(const pass *p, size_t index) {
    const pass_built *b = &p->built[index];
    for (size_t i = 0; i < b->base.slot_count; i++) {
        const source_kind kind = b->sources[i].kind;
        if (kind == FROM_FRAME || kind == FROM_LIGHTS || kind == FROM_PROVIDER) return true;
    }
    return false;
}

bool pass_reads_texture(const pass *p, size_t texture) {
    for (size_t k = 0; k < p->built_count; k++) {
        const pass_built *b = &p->built[k];
        for (size_t i = 0; i < b->base.slot_count; i++)
            if (b->sources[i].kind == FROM_TEXTURE && b->sources[i].index == (int16_t)texture)
                return true;
    }
    return false;
}

bool pass_make_kernel(pass *p, size_t index, bool again) {
    if (pass_has_kernel(p, index) && !again) return true;
    if (!make(p, index)) return false;
    note_wanted(p, &p->built[index]);
    return true;
}

void pass_destroy_kernels(pass *p) {
    for (size_t i = 0; i < p->built_count; i++) kernel_destroy(&p->built[i].base, p->host->device);
}

// ---- numbers ----------------------------------------------------------------------------------

bool pass_evaluate_values(pass *p) {
    for (size_t i = 0; i < p->face->uniform_count; i++)
        if (p->wanted[i] && !pass_evaluate_at(p, i, p->values[i])) return false;
    return true;
}

static void copy_value(kernel *k, const value_copy *copy, const float value[4]) {
    const int32_t whole = (int32_t)lrintf(value[0]);
    kernel_set_at(k, copy->to, copy->whole ? (const void *)&whole : value,
                  copy->whole ? sizeof whole : 4 * sizeof *value);
}

static void copy_provided(pass *p, const pass_provider *row, size_t index) {
    uint32_t values[PASS_PROVIDER_VALUES];
    if (!row->values || !row->values(p, values)) return;
    for (size_t i = 0; i < p->built_count; i++) {
        const kernel_place *places = p->built[i].provided[index];
        for (size_t u = 0; places && u < row->uniforms.count; u++)
            kernel_set_at(&p->built[i].base, &places[u], &values[u], sizeof values[u]);
    }
}

void pass_copy_values(pass *p) {
    for (size_t i = 0; i < p->built_count; i++) {
        pass_built *b = &p->built[i];
        for (size_t c = 0; c < b->copy_count; c++)
            copy_value(&b->base, &b->copies[c], p->values[b->copies[c].uniform]);
    }
    for (size_t r = 0; r < PASS_PROVIDERS; r++) copy_provided(p, pass_providers[r], r);
}

void pass_set(pass *p, int name, const void *data, size_t size) {
    for (size_t i = 0; i < count_own(p); i++) kernel_set(&p->built[i].base, name, data, size);
}

void pass_set_float(pass *p, int name, float value) {
    pass_set(p, name, &value, sizeof value);
}

void pass_set_int(pass *p, int name, int32_t value) {
    pass_set(p, name, &value, sizeof value);
}

void pass_set_box(pass *p, box3 box) {
    if (box3_is_empty(box)) box = (box3){{0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < p->built_count; i++) {
        pass_built *b = &p->built[i];
        if (!b->base.stages) continue;
        kernel_set_at(&b->base, &b->common[COMMON_BOX_MIN], &box.min, sizeof box.min);
        kernel_set_at(&b->base, &b->common[COMMON_BOX_MAX], &box.max, sizeof box.max);
    }
}

// ---- in a frame -------------------------------------------------------------------------------

static void uniform_of(gpu_binding *out, const void *data, size_t size) {
    out->uniform = data;
    out->uniform_size = size;
}

static bool bind(pass *p, slot_source from, gpu_binding *out) {
    const pass_provider *provider;
    switch (from.kind) {
    case FROM_FRAME:
        uniform_of(out, p->host->frame, sizeof *p->host->frame);
        return true;
    case FROM_LIGHTS:
        uniform_of(out, p->host->lights, sizeof *p->host->lights);
        return true;
    case FROM_NUMBERS:
        uniform_of(out, p->numbers, field_program_block_size(p->program));
        return true;
    case FROM_TEXTURE:
        return pass_bind_texture(p, (size_t)from.index, out);
    case FROM_IMAGE:
        return pass_bind_image(p, (size_t)from.index, out);
    case FROM_PROVIDER:
        provider = pass_providers[from.row];
        return provider->bind(p, from.index, out) ||
               err_set("%s: there is nothing to bind to '%s'", p->label,
                       provider->slots.items[from.index]);
    default:
        return true;
    }
}

kernel *pass_use(pass *p, size_t index) {
    pass_built *b = &p->built[index];
    for (size_t i = 0; i < b->base.slot_count; i++) {
        if (b->sources[i].kind <= FROM_KERNEL) continue;
        gpu_binding out = {0};
        if (!bind(p, b->sources[i], &out)) return NULL;
        out.binding = b->base.bindings[i].binding;
        b->base.bindings[i] = out;
    }
    return &b->base;
}

kernel *pass_use_provided(pass *p, const pass_provider *provider, size_t index) {
    return pass_use(p, count_own(p) + count_provided(p, provider) + index);
}

kernel *pass_get_kernel(pass *p, size_t index) {
    return &p->built[index].base;
}

const kernel_place *pass_solver_places(const pass *p, size_t index) {
    return p->built[index].solver;
}

bool pass_dispatch(pass *p, size_t index, uint32_t x, uint32_t y, uint32_t z) {
    kernel *k = pass_use(p, index);
    return k && kernel_run(k, p->host->device, x, y, z);
}
