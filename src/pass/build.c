// From a pass to a pipeline: fields become GLSL, the shader is compiled with the pass's options,
// and what the host must keep (uniform blocks, palette textures, counters) is made.
#include "base/error.h"
#include "base/memory.h"
#include "pass/blue_noise.h"
#include "pass/pass_impl.h"
#include "pass/ranges.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

// A field that was not given is its default, as a constant.
static field_program *generate(pass *p) {
    const shader_interface *face = p->face;
    arena *memory = p->host->memory;
    field_root *roots = arena_alloc(memory, face->field_count * sizeof *roots);
    for (size_t i = 0; i < face->field_count; i++) {
        const shader_field *slot = &face->fields[i];
        const field *node = p->fields[i];
        if (!node) node = field_constant(memory, slot->components, slot->value);
        roots[i] = (field_root){slot->name, node, slot->components, slot->after};
    }
    return field_program_create(memory, roots, face->field_count);
}

// PREFIX_NAME, in capitals.
static shader_define define(arena *memory, const char *prefix, const char *name,
                            const char *value) {
    char *whole = arena_format(memory, "%s_%s", prefix, name);
    for (char *c = whole; *c; c++) *c = (char)toupper((unsigned char)*c);
    return (shader_define){whole, value};
}

// The pass's options as `shader` counts them, which may be another file than the pass's own. One
// that is of that file alone has its default.
static const size_t *options_of(pass *p, const char *shader, size_t *count) {
    *count = p->face->option_count;
    if (strcmp(shader, p->shader) == 0) return p->options;
    const shader_interface *face =
        shader_interface_load(p->host->library, p->host->memory, shader, p->host->reader);
    if (!face) return NULL;
    size_t *values = arena_alloc(p->host->memory, (face->option_count + 1) * sizeof *values), own;
    *count = face->option_count;
    for (size_t i = 0; i < face->option_count; i++) {
        values[i] = (size_t)face->options[i].value[0];
        if (pass_find_key(p, face->options[i].name, &own) == PASS_OPTION)
            values[i] = p->options[own];
    }
    return values;
}

static bool has_define(const pass_defines *defines, const char *name) {
    for (size_t i = 0; i < defines->count; i++)
        if (strcmp(defines->items[i].name, name) == 0) return true;
    return false;
}

static void define_interface(pass *p, pass_defines *out) {
    const shader_interface *face = p->face;
    arena *memory = p->host->memory;
    for (size_t i = 0; i < face->image_count; i++) {
        const shader_image *image = &face->images[i];
        shader_define d = {0};
        if (!image->output)
            d = define(memory, "HAS", image->name, p->images[i].id ? "1" : "0");
        else if (p->formats[i] != image->format)
            d = define(memory, "FORMAT", image->name, gpu_format_name(p->formats[i]));
        if (d.name) pass_define(out, d.name, d.value);
    }
    for (size_t i = 0; i < face->field_count; i++) {
        shader_define d = define(memory, "HAS", face->fields[i].name, p->fields[i] ? "1" : "0");
        pass_define(out, d.name, d.value);
    }
}

bool pass_describe_stage(pass *p, const char *shader, shader_stage stage,
                         const pass_defines *defines, shader_compile_desc *out) {
    arena *memory = p->host->memory;
    pass_defines *all = arena_alloc(memory, sizeof *all);
    if (defines) *all = *defines;
    define_interface(p, all);
    for (size_t i = 0; i < PASS_PROVIDERS; i++) {
        shader_define own[PASS_PROVIDER_DEFINES];
        const size_t added = pass_providers[i]->defines ? pass_providers[i]->defines(p, own) : 0;
        for (size_t k = 0; k < added; k++) pass_define(all, own[k].name, own[k].value);
    }
    if (all->count == COUNT_OF(all->items))
        return err_set("%s: more than %zu images, fields and defines", p->label, all->count - 1);
    shader_text *fields = arena_alloc(memory, sizeof *fields);
    const bool without = !p->program || has_define(all, "WITHOUT_FIELDS");
    *fields = (shader_text){"fields.glsl", without ? "" : field_program_text(p->program)};
    *out = (shader_compile_desc){.name = shader,
                                 .stage = stage,
                                 .defines = all->items,
                                 .define_count = all->count,
                                 .texts = fields,
                                 .text_count = 1,
                                 .counters = p->host->counters,
                                 .reader = p->host->reader};
    out->options = options_of(p, shader, &out->option_count);
    return out->options;
}

static void list_palettes(pass *p) {
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    p->palettes = arena_alloc(p->host->memory, count * sizeof *p->palettes);
    for (size_t i = 0; i < count; i++)
        if (textures[i].palette)
            p->palettes[p->palette_count++] =
                (pass_palette){.source = textures[i].palette, .time = (double)NAN};
}

static bool make_palettes(pass *p) {
    for (size_t i = 0; i < p->palette_count; i++) {
        if (p->palettes[i].image) continue;
        p->palettes[i].image = gpu_image_create(p->host->device, &(gpu_image_desc){
                                                                     .label = "palette",
                                                                     .format = GPU_RGBA16F,
                                                                     .width = PALETTE_SIZE,
                                                                     .height = 1,
                                                                     .use = GPU_USE_SAMPLED,
                                                                 });
        if (!p->palettes[i].image) return false;
    }
    return true;
}

// Missing optional inputs are bound to one black, transparent texel.
static bool make_blanks(pass *p) {
    const uint16_t texel[4] = {0};
    for (int i = 0; i < 2; i++) {
        if (p->blank[i]) continue;
        gpu_image *image = gpu_image_create(p->host->device, &(gpu_image_desc){
                                                                 .label = "blank",
                                                                 .format = GPU_RGBA16F,
                                                                 .width = 1,
                                                                 .height = 1,
                                                                 .depth = (uint32_t)i,
                                                                 .use = GPU_USE_SAMPLED,
                                                             });
        if (!image) return false;
        if (!gpu_image_write(p->host->device, image, 0, texel, sizeof texel)) {
            gpu_image_destroy(p->host->device, image);
            return false;
        }
        p->blank[i] = image;
    }
    return true;
}

// An optional output that nobody reads is one texel.
static bool make_unread(pass *p) {
    for (size_t i = 0; i < p->face->image_count; i++) {
        const shader_image *image = &p->face->images[i];
        if (!image->output || !image->optional || p->unread[i]) continue;
        p->unread[i] = gpu_image_create(p->host->device, &(gpu_image_desc){.label = "unread",
                                                                           .format = p->formats[i],
                                                                           .width = 1,
                                                                           .height = 1,
                                                                           .depth = image->volume,
                                                                           .use = GPU_USE_STORAGE});
        if (!p->unread[i]) return false;
    }
    return true;
}

// One texture for all passes of the effect.
static bool make_blue_noise(pass_host *host) {
    if (!host->blue_noise) host->blue_noise = blue_noise_create(host->device);
    return host->blue_noise != NULL;
}

static bool make_counters(pass *p) {
    if (p->counters || !p->host->counters || !p->face->counter_count) return true;
    p->counters = gpu_buffer_create(p->host->device, &(gpu_buffer_desc){
                                                         .label = "counters",
                                                         .size = p->face->counter_count * 8,
                                                         .kind = GPU_BUFFER_DEVICE,
                                                     });
    return p->counters != NULL;
}

static size_t list_buffers(const pass *p, pass_buffer out[PASS_BUFFERS]) {
    return p->type && p->type->buffers ? p->type->buffers(p, out) : 0;
}

static bool make_buffers(pass *p) {
    pass_buffer buffers[PASS_BUFFERS];
    const size_t count = list_buffers(p, buffers);
    for (p->buffer_count = 0; p->buffer_count < count;) {
        const pass_buffer *b = &buffers[p->buffer_count];
        p->buffers[p->buffer_count++] = b->at;
        if (!gpu_buffer_make(p->host->device, b->at, b->label, b->size))
            return err_prefix("%s: ", p->label);
    }
    return true;
}

bool pass_build(pass *p) {
    return p->runs_in || pass_build_part(p);
}

static bool build_one(pass *p) {
    p->program = generate(p);
    if (!p->program) return err_prefix("%s: ", p->label);
    if (!(p->type && p->type->build ? p->type->build(p) : pass_build_kernels(p))) return false;
    p->numbers = arena_alloc(p->host->memory, field_program_block_size(p->program) + 16);
    list_palettes(p);
    return true;
}

bool pass_build_part(pass *p) {
    return build_one(p) || pass_locate_error(p);
}

void pass_list_memory(const pass *p, budget_list *out) {
    pass_buffer buffers[PASS_BUFFERS];
    const size_t buffer_count = list_buffers(p, buffers);
    for (const pass_buffer *b = buffers; b < buffers + buffer_count; b++)
        if (!*b->at) budget_list_add(out, b->label, b->size);
    if (p->type && p->type->list_memory) p->type->list_memory(p, out);
    for (size_t i = 0; i < PASS_PROVIDERS; i++)
        if (pass_providers[i]->list_memory) pass_providers[i]->list_memory(p, out);
    pass_ranges_list_memory(p, out);
}

static bool allocate(pass *p) {
    if (p->type && p->type->allocate && !p->type->allocate(p)) return false;
    return make_buffers(p) && make_palettes(p) && make_blanks(p) && make_unread(p) &&
           make_blue_noise(p->host) && make_counters(p);
}

bool pass_allocate(pass *p) {
    return allocate(p) || pass_locate_error(p);
}

void pass_destroy(pass *p) {
    gpu *device = p->host->device;
    for (size_t i = 0; i < p->buffer_count; i++) gpu_buffer_destroy(device, *p->buffers[i]);
    if (p->type && p->type->destroy) p->type->destroy(p);
    for (size_t i = 0; i < p->palette_count; i++)
        if (p->palettes[i].image) gpu_image_destroy(device, p->palettes[i].image);
    for (int i = 0; i < 2; i++)
        if (p->blank[i]) gpu_image_destroy(device, p->blank[i]);
    for (size_t i = 0; i < p->face->image_count; i++)
        if (p->unread[i]) gpu_image_destroy(device, p->unread[i]);
    if (p->counters) gpu_buffer_destroy(device, p->counters);
    for (size_t i = 0; i < PASS_PROVIDERS; i++)
        if (pass_providers[i]->destroy) pass_providers[i]->destroy(p);
    pass_destroy_kernels(p);
    mem_free(p->meshes);
    mem_free(p->instances);
    mem_free(p->sources);
    *p = (pass){0};
}

void pass_host_free(pass_host *host) {
    pass_ranges_free(host);
    if (host->blue_noise) gpu_image_destroy(host->device, host->blue_noise);
    host->blue_noise = NULL;
    mem_free(host->declared);
    host->declared = NULL;
    host->declared_count = host->declared_capacity = 0;
    mem_free(host->grid_images);
    host->grid_images = NULL;
    host->grid_image_count = host->grid_image_capacity = 0;
}
