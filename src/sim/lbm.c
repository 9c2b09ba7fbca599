// A lattice Boltzmann solver: the defines of its shaders, and its state on the device.
//
// The state is one row of slots, each of which is a direction of all elements: first those of
// pairs, then those at rest; first the air's, then each scalar's. Slots are stored in as few
// buffers as the device can bind as a whole, an even number in each. The two directions of a pair,
// which change places in each step, are therefore always in the same buffer, and a shader knows
// that buffer when it is compiled.
#include "sim/lbm.h"
#include "base/error.h"
#include "base/swap.h"
#include "sim/lbm_impl.h"
#include <string.h>

enum {
    GROUP = 64,  // threads, along x
    BLOCK = 512, // bytes: a power of two
};

// ---- structure --------------------------------------------------------------------------------

static uint32_t air_directions(const lbm_desc *desc) {
    return desc->set == LBM_D3Q27 ? 27 : 19;
}

static uint32_t scalar_directions(const lbm_desc *desc) {
    return desc->scalar_set == LBM_SCALAR_D3Q27 ? 27 : 7;
}

float lbm_scalar_speed(lbm_scalar_set set) {
    return set == LBM_SCALAR_D3Q27 ? 1.0f / 3 : 1.0f / 4;
}

static bool lbm_check(const lbm_desc *desc) {
    const uint32_t *size = desc->size;
    static const char *const axes[3] = {"x", "y", "z"};
    if (size[0] < 4 || size[1] < 4 || size[2] < 16)
        return err_set("a lattice of %u x %u x %u cells; at least 4 x 4 x 16 are needed", size[0],
                       size[1], size[2]);
    if (size[2] % LBM_ALONG_Z != 0)
        return err_set("a lattice of %u cells along z; a multiple of %d is needed", size[2],
                       LBM_ALONG_Z);
    if (desc->lanes != 0 && desc->lanes != 4 && !(desc->lanes == 2 && desc->precision == LBM_F16))
        return err_set("elements of %u cells; 4 are accepted, and 2 in half precision",
                       desc->lanes);
    if (size[0] > 4096 || size[1] > 4096 || size[2] > 4096)
        return err_set("a lattice of %u x %u x %u cells; at most 4096 along an axis are accepted",
                       size[0], size[1], size[2]);
    if (desc->scalars > LBM_MAX_SCALARS)
        return err_set("%u scalars; at most %d are accepted", desc->scalars, LBM_MAX_SCALARS);
    if (desc->forcing == LBM_WEIGHTS_ONLY && desc->collision != LBM_BGK)
        return err_set("forces by weights only are accepted with the collision BGK alone");
    for (int i = 0; i < 3; i++)
        if ((desc->faces[2 * i] == LBM_PERIODIC) != (desc->faces[2 * i + 1] == LBM_PERIODIC))
            return err_set("one face along %s is periodic and the other is not", axes[i]);
    return true;
}

static uint32_t choose_lanes(const lbm_desc *desc, const gpu_profile *device) {
    return desc->precision == LBM_F16 ? device->lbm_half_lanes : 4;
}

// Uses bundles of four elements of two cells where possible.
static uint32_t choose_bundle(const lbm_desc *desc) {
    return desc->lanes == 2 && desc->size[2] % 8 == 0 ? 4 : 1;
}

bool lbm_layout_find(const lbm_desc *desc, uint64_t range, lbm_layout *out) {
    const uint32_t *size = desc->size, lanes = desc->lanes;
    const uint32_t bytes = desc->precision == LBM_F16 ? 2 : 4;
    const uint64_t elements = (uint64_t)size[0] * size[1] * (size[2] / lanes);
    *out = (lbm_layout){.lanes = lanes, .element = lanes * bytes, .layers = size[2] / lanes};
    out->bundle = choose_bundle(desc);
    if (desc->order == LBM_BLOCKS) out->block = BLOCK / out->element;
    const uint64_t many = out->block ? out->block : 1, places = (elements + many - 1) / many * many;
    uint64_t fit = range / (places * out->element);
    out->slots = air_directions(desc) + desc->scalars * scalar_directions(desc);
    if (fit > UINT32_MAX / places) fit = UINT32_MAX / places; // indices are of 32 bits
    if (fit >= out->slots) fit = out->slots + 1;
    out->run = (uint32_t)(fit & ~1ull);
    out->elements = (uint32_t)elements;
    out->places = (uint32_t)places;
    out->buffers = out->run ? (out->slots + out->run - 1) / out->run : 0;
    if (out->run && out->buffers <= LBM_MAX_BUFFERS) return true;
    return err_set("a lattice of %u x %u x %u cells and %u directions is too large for buffers of "
                   "at most %llu MiB, %d of them",
                   size[0], size[1], size[2], out->slots, (unsigned long long)(range >> 20),
                   LBM_MAX_BUFFERS);
}

lbm *lbm_create(arena *memory, const lbm_desc *desc) {
    if (!lbm_check(desc)) return NULL;
    lbm *l = arena_alloc(memory, sizeof *l);
    *l = (lbm){.memory = memory,
               .desc = *desc,
               .chooses_lanes = desc->lanes == 0,
               .chooses_order = desc->order == LBM_ORDER_AUTO};
    return l;
}

const lbm_desc *lbm_get_desc(const lbm *l) {
    return &l->desc;
}

uint32_t lbm_depth(const lbm *l) {
    return l->layout.layers / l->layout.bundle;
}

// ---- shaders ----------------------------------------------------------------------------------

static void define(lbm *l, const char *name, uint32_t value) {
    l->defines[l->define_count++] = (shader_define){name, arena_format(l->memory, "%u", value)};
}

static void define_all(lbm *l) {
    const lbm_desc *desc = &l->desc;
    l->define_count = 0;
    define(l, "LBM_NX", desc->size[0]);
    define(l, "LBM_NY", desc->size[1]);
    define(l, "LBM_LAYERS", l->layout.layers);
    define(l, "LBM_LANES", l->layout.lanes);
    define(l, "LBM_BUNDLE", l->layout.bundle);
    define(l, "LBM_RUN", l->layout.run);
    define(l, "LBM_BLOCK", l->layout.block);
    define(l, "LBM_GROUP", GROUP);
    define(l, "LBM_Q", air_directions(desc));
    define(l, "LBM_SCALAR_Q", scalar_directions(desc));
    define(l, "LBM_SCALARS", desc->scalars);
    define(l, "LBM_HALF", desc->precision == LBM_F16);
    define(l, "LBM_TRT", desc->collision == LBM_TRT);
    define(l, "LBM_CENTRAL_MOMENTS", desc->collision == LBM_CENTRAL_MOMENTS);
    define(l, "LBM_BY_LINKS", desc->beside_bodies == LBM_BY_LINKS);
    define(l, "LBM_WEIGHTS_ONLY", desc->forcing == LBM_WEIGHTS_ONLY);
    define(l, "LBM_SUBGRID", desc->subgrid);
    define(l, "LBM_FORCE", desc->force);
    define(l, "LBM_OUTFLOW", desc->outflow);
    lbm_walls_define(l, define);
    l->defines[l->define_count++] = (shader_define){
        "LBM_EACH_BUFFER", arena_format(l->memory, "LBM_BUFFERS_%u", l->layout.buffers)};
}

// `g`: NULL, none in particular.
static bool lbm_compile_kernels(lbm *l, const gpu *g, shader_library *library,
                                const shader_reader *reader) {
    const gpu_profile *device = gpu_get_profile(g);
    if (l->chooses_lanes) l->desc.lanes = choose_lanes(&l->desc, device);
    if (l->chooses_order) l->desc.order = device->lbm_whole ? LBM_WHOLE : LBM_BLOCKS;
    if (!lbm_layout_find(&l->desc, g ? gpu_get_info(g)->max_storage_range : UINT32_MAX, &l->layout))
        return false;
    define_all(l);
    return lbm_kernel_compile(l, &l->reset, "sim/lbm/reset.comp", library, reader, NULL, 0) &&
           lbm_step_compile(l, device, library, reader) && lbm_walls_compile(l, library, reader);
}

bool lbm_build(lbm *l, gpu *g, shader_library *library, const shader_reader *reader) {
    return lbm_compile_kernels(l, g, library, reader) &&
           (!g ||
            (kernel_build(&l->reset.base, g) && lbm_step_build(l, g) && lbm_walls_build(l, g)));
}

size_t lbm_defines(const lbm *l, shader_define out[LBM_MAX_DEFINES]) {
    memcpy(out, l->defines, l->define_count * sizeof *out);
    return l->define_count;
}

// ---- state ------------------------------------------------------------------------------------

static uint64_t state_bytes(const lbm *l, uint32_t buffer) {
    const lbm_layout *layout = &l->layout;
    uint32_t left = layout->slots - buffer * layout->run;
    uint64_t slots = left < layout->run ? left : layout->run;
    return slots * layout->places * layout->element;
}

static uint64_t moments_bytes(const lbm *l) {
    return 16ull * l->desc.size[0] * l->desc.size[1] * l->desc.size[2];
}

bool lbm_allocate(lbm *l, gpu *g) {
    for (uint32_t i = 0; i < l->layout.buffers; i++)
        if (!gpu_buffer_make(g, &l->state[i], "lattice", state_bytes(l, i))) return false;
    return lbm_step_allocate(l, g) && lbm_walls_allocate(l, g);
}

void lbm_list_memory(const lbm *l, budget_list *out) {
    for (uint32_t i = 0; i < l->layout.buffers; i++)
        if (!l->state[i]) budget_list_add(out, "lattice", state_bytes(l, i));
    for (int i = 0; i < 2; i++)
        if (!l->moments[i]) budget_list_add(out, "lattice's moments", moments_bytes(l));
    lbm_step_list_memory(l, out);
    lbm_walls_list_memory(l, out);
}

void lbm_destroy(lbm *l, gpu *g) {
    kernel_destroy(&l->reset.base, g);
    lbm_step_destroy(l, g);
    lbm_walls_destroy(l, g);
    for (int i = 0; i < LBM_MAX_BUFFERS; i++) gpu_buffer_destroy(g, l->state[i]);
    for (int i = 0; i < 2; i++) gpu_buffer_destroy(g, l->moments[i]);
    memset(l->state, 0, sizeof l->state);
    memset(l->moments, 0, sizeof l->moments);
}

size_t lbm_buffers(const lbm *l, gpu_buffer **out, size_t capacity) {
    for (size_t i = 0; i < l->layout.buffers && i < capacity; i++) out[i] = l->state[i];
    return l->layout.buffers;
}

void lbm_bind(const lbm *l, kernel *k, const kernel_place *places) {
    gpu_buffer *own[LBM_OWN] = {
        [N_LbmSkin] = l->stepper.skin, [N_LbmMoments] = l->moments[l->kept % 2]};
    lbm_walls_list(l, own);
    memcpy(&own[N_LbmState0], l->state, sizeof l->state);
    for (int i = 0; i < LBM_OWN; i++)
        if (own[i]) kernel_bind_at(k, &places[i], (gpu_binding){.buffer = own[i]});
    if (l->force) kernel_bind_at(k, &places[N_force], (gpu_binding){.image = l->force});
}

void lbm_set_force(lbm *l, gpu_image *image, float scale, float outflow) {
    l->force = image;
    l->force_scale = scale;
    l->outflow_scale = outflow;
}

static bool same_structure(const lbm_desc *a, const lbm_desc *b) {
    return memcmp(a->size, b->size, sizeof a->size) == 0 &&
           memcmp(a->faces, b->faces, sizeof a->faces) == 0 && a->set == b->set &&
           a->scalar_set == b->scalar_set && a->precision == b->precision &&
           a->scalars == b->scalars && a->lanes == b->lanes && a->order == b->order;
}

bool lbm_exchange(lbm *a, lbm *b) {
    if (!same_structure(&a->desc, &b->desc)) return false;
    lbm_walls_exchange(a, b);
    SWAP(a->state, b->state);
    SWAP(a->moments, b->moments);
    SWAP(a->kept, b->kept);
    SWAP(a->steps, b->steps);
    return true;
}

// ---- steps ------------------------------------------------------------------------------------

uint64_t lbm_steps(const lbm *l) {
    return l->steps;
}

uint32_t lbm_parity(const lbm *l) {
    return (uint32_t)(l->steps % 2);
}

gpu_buffer *lbm_moments(const lbm *l, int which) {
    return l->kept > (uint64_t)which ? l->moments[(l->kept + 1 + (uint64_t)which) % 2] : NULL;
}

bool lbm_reset(lbm *l, gpu *g, const lbm_numbers *numbers) {
    l->steps = l->kept = 0;
    lbm_walls_reset(l, g);
    kernel_set(&l->reset.base, N_ambient, numbers->ambient, sizeof numbers->ambient);
    const uint32_t threads[3] = {l->desc.size[0] * l->desc.size[1], 1, lbm_depth(l)};
    memcpy(l->reset.threads, threads, sizeof threads);
    return lbm_kernel_run(l, &l->reset, g);
}

bool lbm_make_moments(lbm *l, gpu *g, uint32_t which) {
    const uint64_t size = moments_bytes(l);
    const uint64_t range = gpu_get_info(g)->max_storage_range;
    if (size > range)
        return err_set("moments of %u x %u x %u cells take %llu MiB; the device can bind %llu",
                       l->desc.size[0], l->desc.size[1], l->desc.size[2],
                       (unsigned long long)(size >> 20), (unsigned long long)(range >> 20));
    return gpu_buffer_make(g, &l->moments[which], "lattice's moments", size);
}
