// Reference: bounds of the extinction first, then paths through them. What it has gathered holds as
// long as nothing changes that the picture depends on.
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "scene/bvh.h"
#include "shared.h"

enum { CELLS = 32 }; // along each side of the box, of the bounds

typedef enum reference_kernel {
    REFERENCE_PATHS,
    REFERENCE_BOUNDS,
    REFERENCE_KERNELS
} reference_kernel;

static const pass_kernel kernels[REFERENCE_KERNELS] = {
    [REFERENCE_BOUNDS] = {.shader = "pass/march/reference_majorants.comp"},
};

#define NAMES(NAME)                                                                                \
    NAME(majorants), NAME(color), NAME(samples), NAME(executed), NAME(paths), NAME(part)
KERNEL_NAMES(NAMES);

typedef struct reference_state {
    hash128 seen;     // of all that the picture depends on, in the last execution
    int32_t executed; // times, since it changed
    uint32_t samples; // a pixel, since then
} reference_state;

static bool reference_declare(pass *p) {
    graph_image *bounds = pass_image(p, N_majorants);
    p->state = arena_alloc(p->host->memory, sizeof(reference_state));
    if (!pass_check_density(p)) return false;
    *bounds = graph_add_image(p->host->graph,
                              &(graph_image_desc){
                                  .name = arena_format(p->host->memory, "%s.majorants", p->label),
                                  .format = p->formats[p->names[N_majorants].image],
                                  .width = CELLS,
                                  .height = CELLS,
                                  .depth = CELLS,
                              });
    return bounds->id && pass_declare_images(p) && pass_add_to_graph(p);
}

static bool meshes_glow(const pass *p) {
    return p->host->bvh && scene_bvh_glows(p->host->bvh);
}

static bool reference_defines(pass *p, size_t index, pass_defines *out) {
    if (index == REFERENCE_PATHS) pass_define_flag(out, "MESHES_GLOW", meshes_glow(p));
    return true;
}

static bool reference_allocate(pass *p) {
    return !meshes_glow(p) || scene_bvh_allocate_surfaces(p->host->bvh, p->host->device);
}

static void reference_list_memory(const pass *p, budget_list *out) {
    if (meshes_glow(p) && budget_list_first(out, p->host->bvh))
        scene_bvh_list_surfaces(p->host->bvh, out);
}

// ---- in a frame -------------------------------------------------------------------------------

// Parameters stand for all that moves by them without being a number of this pass, such as meshes.
static hash128 hash_inputs(const pass *p, const kernel *k) {
    const struct frame_block *f = p->host->frame;
    const field_context *c = p->host->context;
    const struct {
        shared_mat4 view;
        shared_vec4 eye, lens, shift, sight, sun, sun_radiance, zenith, horizon, night[2];
        shared_uvec4 size;
        double time;
    } camera = {f->view,         f->eye,
                f->lens,         f->shift,
                f->sight,        f->sun_direction,
                f->sun_radiance, f->sky_zenith,
                f->sky_horizon,  {f->night_zenith, f->night_horizon},
                f->size,         c->time};
    hash128 all = hash_bytes(&camera, sizeof camera);
    all = hash_combine(all, hash_bytes(p->host->lights, sizeof *p->host->lights));
    all = hash_combine(all, hash_bytes(k->blocks[0], k->block_sizes[0]));
    all = hash_combine(all, hash_bytes(p->numbers, field_program_block_size(p->program)));
    if (p->host->bvh) {
        uint64_t version = scene_bvh_version(p->host->bvh);
        all = hash_combine(all, hash_bytes(&version, sizeof version));
    }
    if (c->param_count)
        all = hash_combine(all, hash_bytes(c->params, c->param_count * sizeof *c->params));
    for (size_t i = 0; i < p->palette_count; i++) {
        uint32_t version = p->palettes[i].version;
        all = hash_combine(all, hash_bytes(&version, sizeof version));
    }
    return all;
}

// How far the picture is: `part` of the parts of an execution, each of so many paths a pixel.
static void set_progress(pass *p, int32_t executed, int32_t paths, int32_t part) {
    pass_set_int(p, N_executed, executed);
    pass_set_int(p, N_paths, paths);
    pass_set_int(p, N_part, part);
}

static bool reference_update(pass *p) {
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_set_box(p, box);
    set_progress(p, 0, 0, 0); // blocks are compared
    return true;
}

static void count_execution(pass *p, const kernel *k) {
    reference_state *s = p->state;
    hash128 seen = hash_inputs(p, k);
    bool same = !p->host->fresh && hash_equal(seen, s->seen);
    s->executed = same ? s->executed + 1 : 0;
    s->samples = (uint32_t)(s->executed + 1) * (uint32_t)pass_value(p, N_samples);
    s->seen = seen;
}

static bool reference_run(pass *p, reference_kernel index, int over) {
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, over), size);
    return pass_dispatch(p, index, size[0], size[1], size[2]);
}

static bool trace(pass *p) {
    const reference_state *s = p->state;
    int32_t samples = (int32_t)pass_value(p, N_samples);
    int32_t paths = gpu_get_profile(p->host->device)->reference_single_paths ? 1 : samples;
    for (int32_t part = 0; part < samples / paths; part++) {
        set_progress(p, s->executed, paths, part);
        if (!reference_run(p, REFERENCE_PATHS, N_color)) return false;
    }
    return true;
}

static bool reference_record(pass *p) {
    const reference_state *s = p->state;
    const kernel *k = pass_prepare(p) ? pass_use(p, REFERENCE_PATHS) : NULL;
    if (!k) return false;
    count_execution(p, k);
    set_progress(p, s->executed, 0, 0);
    return reference_run(p, REFERENCE_BOUNDS, N_majorants) && trace(p);
}

const pass_type reference_type = {
    .name = "reference",
    .shader = "pass/march/reference.comp",
    PASS_KERNELS,
    .declare = reference_declare,
    .defines = reference_defines,
    .update = reference_update,
    .allocate = reference_allocate,
    .list_memory = reference_list_memory,
    .record = reference_record,
};

bool pass_samples(const pass *p, uint32_t *out) {
    const reference_state *s = p->state;
    if (p->type != &reference_type) return false;
    *out = s->samples;
    return true;
}
