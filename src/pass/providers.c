// What shaders may ask for by including a file of lib/.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "scene/bvh.h"
#include "scene/sky_image.h"

// ---- counters ---------------------------------------------------------------------------------

static const char *const counter_slots[] = {"Counters"};

static bool bind_counters(pass *p, int slot, gpu_binding *out) {
    (void)slot;
    out->buffer = p->counters;
    return out->buffer;
}

static const pass_provider counters = {.slots = {counter_slots, COUNT_OF(counter_slots)},
                                       .bind = bind_counters};

// ---- trees that rays go through ---------------------------------------------------------------

static const char *const ray_slots[BVH_PARTS] = {"BvhNodes",    "BvhTriangles", "BvhInstances",
                                                 "BvhSurfaces", "BvhVertices",  "BvhMaterials",
                                                 "BvhTexels",   "BvhLevels"};

static bool bind_rays(pass *p, int slot, gpu_binding *out) {
    out->buffer = scene_bvh_buffer(p->host->bvh, (scene_bvh_part)slot);
    return out->buffer;
}

static const pass_provider rays = {.slots = {ray_slots, BVH_PARTS}, .bind = bind_rays};

// ---- blue noise -------------------------------------------------------------------------------

static const char *const noise_slots[] = {"BlueNoise"};

static bool bind_noise(pass *p, int slot, gpu_binding *out) {
    (void)slot;
    out->sampler = GPU_NEAREST_CLAMP;
    out->image = p->host->blue_noise;
    return out->image;
}

static const pass_provider blue_noise = {.slots = {noise_slots, COUNT_OF(noise_slots)},
                                         .bind = bind_noise};

// ---- sky --------------------------------------------------------------------------------------

enum { SKY, SKY_DISTRIBUTION, SKY_SLOTS };
static const char *const sky_slots[SKY_SLOTS] = {"Sky", "SkyDistribution"};

static bool bind_sky(pass *p, int slot, gpu_binding *out) {
    const sky_image *sky = p->host->scene->sky.image;
    out->sampler = slot == SKY ? GPU_LINEAR_REPEAT : GPU_NEAREST_CLAMP;
    out->image = !sky          ? p->blank[0]
                 : slot == SKY ? sky_image_texture(sky)
                               : sky_image_distribution(sky);
    return out->image;
}

static size_t define_sky(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    const scene *around = p->host->scene;
    out[0] = (shader_define){"SKY_IMAGE", around && around->sky.image ? "1" : "0"};
    out[1] = (shader_define){"SKY_NIGHT", around && around->sky.night ? "1" : "0"};
    return 2;
}

static const pass_provider sky = {
    .slots = {sky_slots, SKY_SLOTS}, .defines = define_sky, .bind = bind_sky};

// ---- what is drawn ----------------------------------------------------------------------------

static size_t define_drawn(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]) {
    const bool counts = gpu_get_profile(p->host->device)->limits.first_instance;
    out[0] = (shader_define){"WITHOUT_FIRST_INSTANCE", counts ? "0" : "1"};
    return 1;
}

static const pass_provider drawn = {.defines = define_drawn};

// ---- all --------------------------------------------------------------------------------------

const pass_provider *const pass_providers[PASS_PROVIDERS] = {&pass_particles_provider,
                                                             &pass_point_lights_provider,
                                                             &pass_shadow_maps_provider,
                                                             &counters,
                                                             &rays,
                                                             &blue_noise,
                                                             &sky,
                                                             &drawn};
