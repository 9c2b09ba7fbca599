// Shade: one shader, in two variants (rays.h). Before many rays it is found out what may stand
// between each tile of the picture and each light; for single rays that takes longer than it saves.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "pass/surfaces/rays.h"

enum {
    TILE = 16, // as in shade/shafts.glsl
    LIST_WORDS = 16,
    MAX_LISTED = 64, // threads of a tile, in shade_shafts.comp
};
enum { SHADE_SHAFTS = RAYS_VARIANTS, SHADE_KERNELS };

static const pass_kernel kernels[SHADE_KERNELS] = {
    [SHADE_SHAFTS] = {.shader = "pass/surfaces/shade_shafts.comp"},
};

#define NAMES(NAME)                                                                                \
    RAYS_NAMES(NAME), NAME(lights), NAME(color), NAME(width), NAME(height), NAME(shaft_lights),    \
        NAME(Shafts)
KERNEL_NAMES(NAMES);

typedef struct shade_state {
    gpu_buffer *lists; // of leaves, for each tile and light
} shade_state;

static bool shade_declare(pass *p) {
    p->state = arena_alloc(p->host->memory, sizeof(shade_state));
    pass_drop_matte(p, "surface", "emission");
    return pass_declare_images(p) && pass_add_to_graph(p);
}

static bool shade_defines(pass *p, size_t index, pass_defines *out) {
    (void)p;
    if (index < RAYS_VARIANTS) pass_rays_define(out, index);
    return true;
}

static bool shade_foresees(const pass *p, size_t index) {
    return pass_rays_foresee(p, index == SHADE_SHAFTS ? RAYS_MANY : index);
}

static void shade_destroy(pass *p) {
    shade_state *s = p->state;
    if (s) gpu_buffer_destroy(p->host->device, s->lists);
}

// ---- lists of what casts shadows --------------------------------------------------------------

static const char lists_label[] = "shafts";

// How many lights get lists. The sun and all of the scene's always count as lights.
static uint64_t count_listed(const pass *p, uint64_t each) {
    const graph_image lights = *pass_image(p, N_lights);
    const uint64_t most = gpu_get_info(p->host->device)->max_storage_range / each;
    uint32_t size[3] = {1, (uint32_t)p->host->scene->light_count + 1, 1};
    if (lights.id) graph_get_size(p->host->graph, lights, size);
    const uint64_t wanted = size[1] < MAX_LISTED ? size[1] : MAX_LISTED;
    return wanted < most ? wanted : most;
}

// Bytes of the lists of one light.
static uint64_t list_bytes(const pass *p) {
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    const uint64_t across = (size[0] + TILE - 1) / TILE, down = (size[1] + TILE - 1) / TILE;
    return across * down * LIST_WORDS * sizeof(uint32_t);
}

static void shade_list_memory(const pass *p, budget_list *out) {
    const shade_state *s = p->state;
    const uint64_t each = list_bytes(p), size = count_listed(p, each) * each;
    if (!pass_has_kernel(p, SHADE_SHAFTS)) return;
    if (!s->lists || gpu_buffer_size(s->lists) < size) budget_list_add(out, lists_label, size);
}

static bool make_lists(pass *p, int32_t *lights) {
    shade_state *s = p->state;
    const uint64_t each = list_bytes(p);
    const uint64_t listed = pass_value(p, N_shadow_samples) < 2 ? 0 : count_listed(p, each);
    *lights = (int32_t)listed;
    uint64_t size = listed ? listed * each : LIST_WORDS * sizeof(uint32_t);
    if (s->lists && gpu_buffer_size(s->lists) >= size) return true;
    gpu_buffer_destroy(p->host->device, s->lists);
    s->lists = gpu_buffer_create(
        p->host->device,
        &(gpu_buffer_desc){.label = lists_label, .size = size, .kind = GPU_BUFFER_DEVICE});
    return s->lists != NULL;
}

// ---- in a frame -------------------------------------------------------------------------------

static bool shade_run(pass *p, size_t index, uint32_t width, uint32_t height) {
    kernel *k = pass_use(p, index);
    if (!k) return false;
    kernel_bind_buffer(k, N_Shafts, ((const shade_state *)p->state)->lists);
    return kernel_run(k, p->host->device, width, height, 1);
}

static bool shade_record(pass *p) {
    uint32_t size[3], across, down;
    int32_t listed;
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    across = (size[0] + TILE - 1) / TILE;
    down = (size[1] + TILE - 1) / TILE;
    if (!pass_prepare(p) || !make_lists(p, &listed)) return false;
    const size_t index = pass_rays_choose(p);
    if (!pass_make_late(p, index, false)) return false;
    if (listed && !pass_make_late(p, SHADE_SHAFTS, false)) return false;
    pass_set_int(p, N_width, (int32_t)size[0]);
    pass_set_int(p, N_height, (int32_t)size[1]);
    pass_set_int(p, N_shaft_lights, listed);
    return (!listed || shade_run(p, SHADE_SHAFTS, across * MAX_LISTED, down)) &&
           shade_run(p, index, size[0], size[1]);
}

const pass_type shade_type = {
    .name = "shade",
    .shader = "pass/surfaces/shade.comp",
    PASS_KERNELS,
    .declare = shade_declare,
    .defines = shade_defines,
    .foresees = shade_foresees,
    .list_memory = shade_list_memory,
    .record = shade_record,
    .destroy = shade_destroy,
};
