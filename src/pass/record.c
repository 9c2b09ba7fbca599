// A pass in a frame: what its kernels are given, and its work.
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "pass/ranges.h"
#include <math.h>
#include <string.h>

// ---- bindings ---------------------------------------------------------------------------------

static bool update_palettes(pass *p) {
    double time = p->host->context->time;
    for (size_t i = 0; i < p->palette_count; i++) {
        pass_palette *slot = &p->palettes[i];
        uint32_t version = palette_version(slot->source);
        bool same = slot->version == version;
        if (same &&
            (slot->time == time || (!isnan(slot->time) && !palette_is_animated(slot->source))))
            continue;
        uint16_t texels[PALETTE_SIZE * 4];
        palette_bake(slot->source, time, texels);
        if (!gpu_image_write(p->host->device, slot->image, 0, texels, sizeof texels)) return false;
        slot->time = time;
        slot->version = version;
    }
    return true;
}

static gpu_image *palette_image(const pass *p, const palette *source) {
    for (size_t i = 0; i < p->palette_count; i++)
        if (p->palettes[i].source == source) return p->palettes[i].image;
    return NULL;
}

gpu_image *pass_field_image(const pass *p, const field_texture *t) {
    graph_image made = pass_grid_image(p->host, t->grid, t->image);
    if (made.id) return graph_get_image(p->host->graph, made);
    gpu_image *image = t->grid->state.images[t->set][t->image];
    return image ? image : t->grid->state.images[0][t->image];
}

bool pass_bind_texture(pass *p, size_t index, gpu_binding *out) {
    const field_texture *textures;
    field_program_textures(p->program, &textures);
    const field_texture *t = &textures[index];
    out->sampler = GPU_NEAREST_CLAMP; // of what is fetched
    if (t->palette) {
        out->image = palette_image(p, t->palette);
        out->sampler = GPU_LINEAR_CLAMP;
    } else if (t->ranges) {
        out->image = pass_ranges_get(p, t);
    } else if (t->index) {
        out->image = t->grid->state.index[t->set][t->image];
    } else {
        out->image = pass_field_image(p, t);
        if (!out->image) out->image = p->blank[1];
        out->sampler = t->grid->repeats ? GPU_LINEAR_REPEAT : GPU_LINEAR_CLAMP;
    }
    return out->image || !t->ranges;
}

bool pass_bind_image(pass *p, size_t index, gpu_binding *out) {
    const shader_image *image = &p->face->images[index];
    out->image = p->images[index].id ? graph_get_image(p->host->graph, p->images[index])
                                     : p->blank[image->volume];
    if (!out->image) out->image = p->unread[index];
    // Depths are compared, not mixed, and few devices could filter them.
    bool depth = out->image && gpu_image_get_desc(out->image)->format == GPU_D32F;
    out->sampler = depth ? GPU_NEAREST_CLAMP : GPU_LINEAR_CLAMP;
    return true;
}

// ---- recording --------------------------------------------------------------------------------

static bool fill_kernels(pass *p) {
    if (!pass_evaluate_values(p)) return false;
    pass_copy_values(p);
    return !p->type || !p->type->update || p->type->update(p);
}

bool pass_make_late(pass *p, size_t index, bool again) {
    if (pass_has_kernel(p, index) && !again) return true;
    return pass_make_kernel(p, index, again) && fill_kernels(p);
}

static bool fill_numbers(pass *p) {
    return field_program_fill(p->program, p->host->context, p->numbers) &&
           (!p->built || fill_kernels(p));
}

static bool prepare_providers(pass *p) {
    for (size_t i = 0; i < PASS_PROVIDERS; i++)
        if (pass_providers[i]->prepare && !pass_providers[i]->prepare(p)) return false;
    return true;
}

bool pass_is_watched(const pass *p) {
    bool feeds = false;
    for (size_t i = 0; i < p->face->image_count && !feeds; i++)
        feeds = p->face->images[i].output && graph_feeds_simulation(p->host->graph, p->images[i]);
    return feeds || !p->host->ahead;
}

// Air that a field samples and that has not come to the frame yet, as where a submit was too short.
static bool waits_for(const pass *p, const field_grid *grid) {
    for (int k = 0; k < FIELD_GRID_IMAGES; k++) {
        graph_image image = pass_grid_image(p->host, grid, k);
        const pass *writer = image.id ? pass_writer(p->host, image) : NULL;
        const pass_simulation *simulation = writer ? pass_get_simulation(writer) : NULL;
        if (simulation && simulation->left(writer, p->host->context->time) > 0) return true;
    }
    return false;
}

bool pass_waits(const pass *p) {
    for (size_t i = 0; i < p->face->field_count; i++) {
        const field_grid *grids[64];
        size_t count = p->fields[i] ? field_grids(p->fields[i], grids, COUNT_OF(grids)) : 0;
        for (size_t g = 0; g < count && g < COUNT_OF(grids); g++)
            if (waits_for(p, grids[g])) return true;
    }
    return false;
}

bool pass_has_content(const pass *p) {
    for (size_t i = 0; i < p->face->image_count; i++) {
        graph_image image = p->images[i];
        if (graph_get_image(p->host->graph, image) && !graph_has_content(p->host->graph, image))
            return false;
    }
    return true;
}

bool pass_clear_outputs(pass *p) {
    static const float zero[4] = {0};
    for (size_t i = 0; i < p->face->image_count; i++) {
        gpu_image *image = graph_get_image(p->host->graph, p->images[i]);
        if (image) gpu_image_clear(p->host->device, image, zero);
    }
    return true;
}

bool pass_prepare(pass *p) {
    if (p->counters) gpu_buffer_fill(p->host->device, p->counters, 0);
    return update_palettes(p) && fill_numbers(p) && prepare_providers(p);
}

bool pass_rehearse(pass *p) {
    for (size_t i = 0; i < p->mesh_count; i++) {
        mat4 transform;
        float tint[4];
        if (!scene_mesh_place(p->meshes[i], p->host->context, transform, tint)) return false;
    }
    for (size_t i = 0; i < p->instances_count; i++) {
        mat4 transform;
        float tint[4];
        if (!scene_instances_place(p->instances[i], p->host->context, transform, tint))
            return false;
    }
    return fill_numbers(p) && (!p->type || !p->type->rehearse || p->type->rehearse(p));
}

static bool draw_fullscreen(pass *p, const kernel *k) {
    gpu_binding kept[GPU_MAX_SLOTS];
    gpu_draw draw = kernel_draw(k, kept);
    gpu_draw_desc desc = {.pipeline = k->pipeline, .draws = &draw, .draw_count = 1};
    size_t targets = 0;
    draw.vertices = 3;
    for (size_t i = 0; i < p->face->image_count && targets < GPU_MAX_TARGETS; i++)
        if (p->face->images[i].output)
            desc.colors[targets++] = graph_get_image(p->host->graph, p->images[i]);
    return gpu_draw_all(p->host->device, &desc);
}

bool pass_run(pass *p) {
    uint32_t size[3] = {1, 1, 1};
    kernel *k = pass_use(p, 0);
    if (!k) return false;
    if (k->stages > 1) return draw_fullscreen(p, k);
    for (size_t i = p->face->image_count; i-- > 0;)
        if (p->face->images[i].output) graph_get_size(p->host->graph, p->images[i], size);
    return kernel_run(k, p->host->device, size[0], size[1], size[2]);
}

bool pass_record(pass *p) {
    return pass_prepare(p) && pass_run(p);
}

bool pass_read_counters(pass *p, uint64_t *out) {
    memset(out, 0, p->face->counter_count * sizeof *out);
    if (!p->counters) return true;
    return gpu_buffer_read(p->host->device, p->counters, 0, out, p->face->counter_count * 8);
}
