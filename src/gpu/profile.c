// The rows of the profile. Figures were measured on lavapipe (Mesa 22.3.6, 2 to 4 cores), on an
// NVIDIA H200, or on both; scripts/bench/README.md says how.
#include "gpu/profile.h"
#include "base/memory.h"
#include "gpu/vk.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- drivers that shaders are rewritten for ---------------------------------------------------

#define VERSION(major, minor, patch) ((uint32_t)(major) << 20 | (uint32_t)(minor) << 10 | (patch))

// The driver's own versions that a rewriting was measured on, first and last. Others get the code
// as it is: what a newer one gains by it is not known, and what it costs (a longer build) is.
typedef struct rewrite_row {
    VkDriverId driver;
    uint32_t first, last;
    bool hoists, hides, slices;
} rewrite_row;

static const rewrite_row rewrites[] = {
    {VK_DRIVER_ID_MESA_LLVMPIPE, VERSION(22, 3, 0), VERSION(22, 3, 1023), true, true, true},
};

// Of a text like "Mesa 22.3.6 (LLVM 15.0.6)", the first version in it. Mesa's software driver says
// nothing in driverVersion. 0: there is none.
static uint32_t find_version(const char *text) {
    unsigned major, minor, patch;
    for (; *text; text++)
        if (sscanf(text, "%u.%u.%u", &major, &minor, &patch) == 3 && major < 4096 && minor < 1024 &&
            patch < 1024)
            return VERSION(major, minor, patch);
    return 0;
}

// 960x540 on 2 cores, ms a frame as the code is, with hidden uniforms, and with both: explosion
// 1118, 880, 828; night 2077, 1900, 2013; plume 2170, 1657, 1507; cloud 2231, 1640, 1851.
static rewrite_row find_rewrite(VkDriverId driver, const char *driver_info) {
    const uint32_t version = find_version(driver_info);
    for (size_t i = 0; i < COUNT_OF(rewrites); i++) {
        const rewrite_row *row = &rewrites[i];
        if (row->driver == driver && version >= row->first && version <= row->last) return *row;
    }
    return (rewrite_row){.driver = driver};
}

static void choose_driver(gpu_profile *p, gpu_kind kind, VkDriverId driver, const char *info) {
    const rewrite_row rewrite = find_rewrite(driver, info);
    const bool software = kind == GPU_CPU;
    // A processor's drivers do not check indices into variables: lavapipe reads and writes the
    // memory of the process there.
    p->clamps_indices = software;
    p->hoists_uniforms = rewrite.hoists;
    p->hides_uniforms = rewrite.hides;
    // A march on 2 cores: 71 ms with one dispatch, 30 with slices.
    p->slices_dispatches = rewrite.slices;
    p->waits_in_calls = software; // seen of lavapipe and of SwiftShader
    // There is one queue, and frames take seconds. The system shares cores among threads; a picture
    // goes from one device to the other through memory that both have.
    p->shows_apart = software;
    // To fill an image of 1400x900 takes lavapipe 4 ms, and a GPU nothing that is worth a way of
    // its own.
    p->keeps_shown = software;
    p->shares_memory = software || kind == GPU_INTEGRATED;
    p->timeout = software ? 300 : 30; // frames are slow there, and a hang freezes no desktop
}

// ---- what one submit may hold -----------------------------------------------------------------

static void choose_amounts(gpu_profile *p, bool software) {
    // About 0.1 s of a large device, half a second of a processor. The least of a step is what its
    // dispatches take by themselves.
    p->lattice_updates = software ? 1.5e7 : 2e9;
    // lavapipe, 64^3: 59 million updates of a lattice a second, 2.2 of burning gas. H200, 256^3: 20
    // thousand million, and 5 to 9 with what effects ask for.
    p->burning_cost = software ? 20 : 4;
    p->least_updates = software ? 2e4 : 2e6;
    p->brief_updates = software ? 20 : 64;
    // About 0.1 s of a large device, 2 s of a processor.
    p->particle_moves = software ? 2e7 : 1e9;
    // A processor's textures are the host's memory. Not measured: a frame of 512^3 in bricks has
    // 31 MB.
    p->sequence_bytes = (software ? 192ull : 512ull) << 20;
    // llvmpipe ends all loops of a thread once they have made 65535 turns together, so that each
    // path gets a thread of its own. A GPU is busy longest with all paths of a pixel in one.
    p->reference_single_paths = software;
}

// ---- which way is taken -----------------------------------------------------------------------

// `checked`: there is no device. The ways are then those whose kernels are most.
static void choose_surfaces(gpu_profile *p, gpu_kind kind, uint32_t subpixel_bits, bool checked) {
    // lavapipe draws triangles many times faster than it traces rays. SwiftShader rounds corners to
    // 1/16 of a pixel (4 bits) and tilts a triangle by that: in a small picture what is shown by it
    // lies as deep below its surface as rays for shadows begin above. GPUs for computing have few
    // processors that draw; none was seen to trace slowly, among 100,000 instances neither.
    p->geometry_traces = !checked && (kind != GPU_CPU || subpixel_bits < 8);
    // Drawing the maps counts, too: on a processor they take as long as rays in a small picture,
    // and win in a large one, or among many trees. On an H200 maps that are kept beat rays (a
    // forest: 0.3 ms against 1.0), those that something moves in do not (3.3): drawing them takes 3
    // ms.
    p->shadow_maps_win = kind != GPU_DISCRETE && kind != GPU_VIRTUAL;
}

static void choose_volumes(gpu_profile *p, bool software, bool checked) {
    // lavapipe computes both sides of each branch. Of explosion at 960x540 smoke that is looked for
    // in a loop of its own took the march from 127 to 81 ms; rays beside the box in a kernel of
    // their own took another from 37 to 33.5.
    p->march_by_sides = software || checked;
    // Where threads are few, looking for what is empty takes more than it saves: fewer blocks, and
    // none on GPUs for cheap densities of few samples (below 4e7).
    p->bricks_dear = software ? 11 : 15;
    p->bricks_cheap = software ? 5 : 0;
    p->bricks_many = software ? 5 : 15;
    // Each thread of a processor costs by itself: 13 frames of explosion took lavapipe 3.2 s with 8
    // threads a ray, 4.4 with 24.
    p->lighting_parts = software ? 8 : 0;
    // Rays of one subgroup wait for each other; a processor's threads that wait for one cost as
    // much as those that trace. Not timed by itself.
    p->lighting_apart = software ? 1 : 32;
}

static void choose_points(gpu_profile *p, bool software) {
    // 16384 splats in 480x270 on lavapipe, read by each pixel's thread from the list of its tile,
    // and drawn by their own: 4 pixels wide 114 and 17 ms, 8 wide 211 and 95, 25 wide 572 and 440.
    p->draws_by_groups = !software;
    p->splats_direct = software ? 24 : 0;
    // Threads of a processor's group take turns at each barrier. Not timed by itself.
    p->sort_threads = software ? 32 : 256;
    // More cells look at each template less often, fewer wait for fewer pictures one after the
    // other: 200 templates in 256 x 256 cells took an H200 0.030 ms with 4 cells, 0.018 with 1.
    p->templates_cells = software ? 4 : 1;
    p->previews = software; // a frame of explosion at 960x540 takes lavapipe 0.8 s
}

static void choose_flow(gpu_profile *p, bool software) {
    // A step's pressure on llvmpipe: 21, 20, 21 ms with groups of 64, 32, 128 threads, 24.5 with
    // 256; 20 to 25 ms with two sweeps, 17 to 22 with one; 56 with tiles of 16 cells, 256 threads
    // and two sweeps, which are best on an H200, where a dispatch that waits takes 4 us.
    p->flow_group = software ? 64 : 256;
    p->flow_coarse_side = software ? 8 : 16;
    p->flow_sweeps = software ? 1 : 2;
    p->flow_small_tiles = !software;
    // A transform of 512 x 512 takes an H200 0.13 ms where multigrid takes 0.44; lavapipe is faster
    // with it up to 128 cells (15.4 ms of the processor).
    p->flow_transform = software ? 128 : UINT32_MAX;
}

static void choose_lattice(gpu_profile *p, bool software, bool int64) {
    // Million updates a processor second of lavapipe, 96^3: 16 bytes as two words of 64 bits
    // instead of four of 32 took FP32 from 24 to 35, halves converted by hand FP16 from 28.5 to 39.
    // It moves words, so that FP16 has elements of four cells there.
    p->lbm_half_lanes = software ? 4 : 2;
    p->lbm_whole = software;
    p->lbm_software_step = software && int64;
}

static void choose_pyro(gpu_profile *p, bool software, bool int64) {
    p->pyro_half = !software;
    // Sweeps along x of gas and velocity, 64^3, half the velocity: lavapipe 13.3 and 7.9 ms
    // so, 10.9 and 5.1 with a line of cells a thread.
    p->pyro_side_by_side = !software;
    p->pyro_wide_words = software && int64;
}

// ---- limits -----------------------------------------------------------------------------------

static const gpu_limits small_device = {.group_threads = 256,
                                        .shared_bytes = 16384,
                                        .storage_buffers = 8,
                                        .storage_images = 4,
                                        .first_instance = false};

// What a shader is compiled for when there is no device to ask: none is refused then.
static const gpu_limits no_limits = {.group_threads = UINT32_MAX,
                                     .shared_bytes = UINT32_MAX,
                                     .storage_buffers = UINT32_MAX,
                                     .storage_images = UINT32_MAX,
                                     .first_instance = true};

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

// What would not fit is cut smaller, or done in another way.
static void fit_limits(gpu_profile *p) {
    const gpu_limits *l = &p->limits;
    // Of a thread that sorts: 16 counts and a sum, and 16 more of the group (splats/sort.comp).
    while (p->sort_threads * 68 + 64 > l->shared_bytes || p->sort_threads > l->group_threads)
        p->sort_threads /= 2;
    while (p->flow_group > l->group_threads) p->flow_group /= 2;
    while (p->flow_coarse_side * p->flow_coarse_side > l->group_threads) p->flow_coarse_side /= 2;
    // The first of a second sweep's buffers is one too many, and levels of 32 x 32 cells with those
    // below take 28 KiB.
    if (l->storage_buffers < 9) p->flow_sweeps = 1;
    p->flow_coarse = l->shared_bytes < 28672 ? 16 : 32;
    // Rays read eight buffers of trees and surfaces, besides counters, and write five images.
    if (l->storage_buffers < 9 || l->storage_images < 5) p->geometry_traces = false;
}

void vk_profile_make_small(gpu_profile *p) {
    gpu_limits *l = &p->limits;
    l->group_threads = least(l->group_threads, small_device.group_threads);
    l->shared_bytes = least(l->shared_bytes, small_device.shared_bytes);
    l->storage_buffers = least(l->storage_buffers, small_device.storage_buffers);
    l->storage_images = least(l->storage_images, small_device.storage_images);
    l->first_instance = l->first_instance && small_device.first_instance;
    fit_limits(p);
}

bool vk_small_device_wanted(void) {
    const char *set = getenv("ROIL_SMALL_DEVICE");
    return set && strcmp(set, "1") == 0;
}

static bool meets(const char *label, const char *limit, const char *what, uint32_t wanted,
                  uint32_t most) {
    return wanted <= most || err_set("pipeline '%s' has %u %s; the device allows %u (%s)", label,
                                     wanted, what, most, limit);
}

bool gpu_meets_limits(const gpu_limits *limits, const char *label, const gpu_demand *demand) {
    return meets(label, "maxComputeWorkGroupInvocations", "threads in a work group",
                 demand->threads, limits->group_threads) &&
           meets(label, "maxComputeSharedMemorySize", "bytes of shared memory in a work group",
                 demand->shared_bytes, limits->shared_bytes) &&
           meets(label, "maxPerStageDescriptorStorageBuffers", "storage buffers in a stage",
                 demand->storage_buffers, limits->storage_buffers) &&
           meets(label, "maxPerStageDescriptorStorageImages", "storage images in a stage",
                 demand->storage_images, limits->storage_images);
}

// ---- all --------------------------------------------------------------------------------------

gpu_profile vk_profile_find(const gpu_info *info, VkDriverId driver, const char *driver_info,
                            const gpu_limits *limits) {
    const bool software = info->kind == GPU_CPU;
    gpu_profile p = {.limits = *limits};
    choose_driver(&p, info->kind, driver, driver_info);
    choose_amounts(&p, software);
    choose_surfaces(&p, info->kind, info->subpixel_bits, false);
    choose_volumes(&p, software, false);
    choose_points(&p, software);
    choose_flow(&p, software);
    choose_lattice(&p, software, info->int64);
    choose_pyro(&p, software, info->int64);
    fit_limits(&p);
    return p;
}

static gpu_profile of_none;

static void find_of_none(void) {
    of_none.limits = no_limits;
    choose_amounts(&of_none, false);
    choose_surfaces(&of_none, GPU_OTHER, 8, true);
    choose_volumes(&of_none, false, true);
    choose_points(&of_none, false);
    choose_flow(&of_none, false);
    choose_lattice(&of_none, false, false);
    choose_pyro(&of_none, false, false);
    fit_limits(&of_none);
    if (vk_small_device_wanted()) vk_profile_make_small(&of_none);
}

const gpu_profile *gpu_get_profile(const gpu *g) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    if (g) return &g->profile;
    pthread_once(&once, find_of_none);
    return &of_none;
}
