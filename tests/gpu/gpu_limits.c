// Limits of a small device: reported, and held to by our own check, whatever the driver would take.
#include "gpu/profile.h"
#include "gpu/vk.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <string.h>

// clang-format off

/* shared.comp, 16388 bytes
   #version 460
   layout(local_size_x = 8) in;
   layout(binding = 1) buffer Values { uint values[]; };
   shared uint kept[4097];
   void main() {
       uint i = gl_LocalInvocationIndex;
       kept[i + values[0]] = i;
       barrier();
       values[i] = kept[i];
   } */
static const uint32_t shared_comp_code[] = {
    0x07230203, 0x00010600, 0x0008000b, 0x00000029, 0x00000000, 0x00020011, 0x00000001, 0x0006000b,
    0x00000001, 0x4c534c47, 0x6474732e, 0x3035342e, 0x00000000, 0x0003000e, 0x00000000, 0x00000001,
    0x0008000f, 0x00000005, 0x00000004, 0x6e69616d, 0x00000000, 0x0000000c, 0x00000011, 0x00000016,
    0x0006014b, 0x00000004, 0x00000026, 0x00000007, 0x00000008, 0x00000008, 0x00040047, 0x0000000c,
    0x0000000b, 0x0000001d, 0x00040047, 0x00000013, 0x00000006, 0x00000004, 0x00050048, 0x00000014,
    0x00000000, 0x00000023, 0x00000000, 0x00030047, 0x00000014, 0x00000002, 0x00040047, 0x00000016,
    0x00000022, 0x00000000, 0x00040047, 0x00000016, 0x00000021, 0x00000001, 0x00020013, 0x00000002,
    0x00030021, 0x00000003, 0x00000002, 0x00040015, 0x00000006, 0x00000020, 0x00000000, 0x0004002b,
    0x00000006, 0x00000007, 0x00000008, 0x0004002b, 0x00000006, 0x00000008, 0x00000001, 0x00040020,
    0x00000009, 0x00000007, 0x00000006, 0x00040020, 0x0000000b, 0x00000001, 0x00000006, 0x0004003b,
    0x0000000b, 0x0000000c, 0x00000001, 0x0004002b, 0x00000006, 0x0000000e, 0x00001001, 0x0004001c,
    0x0000000f, 0x00000006, 0x0000000e, 0x00040020, 0x00000010, 0x00000004, 0x0000000f, 0x0004003b,
    0x00000010, 0x00000011, 0x00000004, 0x0003001d, 0x00000013, 0x00000006, 0x0003001e, 0x00000014,
    0x00000013, 0x00040020, 0x00000015, 0x0000000c, 0x00000014, 0x0004003b, 0x00000015, 0x00000016,
    0x0000000c, 0x00040015, 0x00000017, 0x00000020, 0x00000001, 0x0004002b, 0x00000017, 0x00000018,
    0x00000000, 0x00040020, 0x00000019, 0x0000000c, 0x00000006, 0x00040020, 0x0000001e, 0x00000004,
    0x00000006, 0x0004002b, 0x00000006, 0x00000020, 0x00000002, 0x0004002b, 0x00000006, 0x00000021,
    0x00000108, 0x00040017, 0x00000027, 0x00000006, 0x00000003, 0x0006002c, 0x00000027, 0x00000028,
    0x00000007, 0x00000008, 0x00000008, 0x00050036, 0x00000002, 0x00000004, 0x00000000, 0x00000003,
    0x000200f8, 0x00000005, 0x0004003b, 0x00000009, 0x0000000a, 0x00000007, 0x0004003d, 0x00000006,
    0x0000000d, 0x0000000c, 0x0003003e, 0x0000000a, 0x0000000d, 0x0004003d, 0x00000006, 0x00000012,
    0x0000000a, 0x00060041, 0x00000019, 0x0000001a, 0x00000016, 0x00000018, 0x00000018, 0x0004003d,
    0x00000006, 0x0000001b, 0x0000001a, 0x00050080, 0x00000006, 0x0000001c, 0x00000012, 0x0000001b,
    0x0004003d, 0x00000006, 0x0000001d, 0x0000000a, 0x00050041, 0x0000001e, 0x0000001f, 0x00000011,
    0x0000001c, 0x0003003e, 0x0000001f, 0x0000001d, 0x000400e0, 0x00000020, 0x00000020, 0x00000021,
    0x0004003d, 0x00000006, 0x00000022, 0x0000000a, 0x0004003d, 0x00000006, 0x00000023, 0x0000000a,
    0x00050041, 0x0000001e, 0x00000024, 0x00000011, 0x00000023, 0x0004003d, 0x00000006, 0x00000025,
    0x00000024, 0x00060041, 0x00000019, 0x00000026, 0x00000016, 0x00000018, 0x00000022, 0x0003003e,
    0x00000026, 0x00000025, 0x000100fd, 0x00010038,
};

// clang-format on

static gpu *open_small(void) {
    gpu *g = gpu_create(&(gpu_desc){.validate = true, .small = true});
    if (!g) fail_msg("no device: %s", err_get());
    return g;
}

static void close_small(gpu *g) {
    assert_int_equal(gpu_test_finish(g), 0);
}

static void small_devices_report_small_limits(void **state) {
    gpu *g = open_small();
    const gpu_limits *has = &gpu_get_profile(*state)->limits, *l = &gpu_get_profile(g)->limits;
    assert_true(has->group_threads >= l->group_threads);
    assert_true(l->group_threads <= 256);
    assert_true(l->shared_bytes <= 16384);
    assert_true(l->storage_buffers <= 8);
    assert_true(l->storage_images <= 4);
    assert_false(l->first_instance);
    close_small(g);
}

static void what_does_not_fit_is_cut_smaller(void **state) {
    (void)state;
    gpu *g = open_small();
    const gpu_profile *p = gpu_get_profile(g);
    assert_true(p->sort_threads * 68 + 64 <= p->limits.shared_bytes);
    assert_true(p->flow_group <= p->limits.group_threads);
    assert_true(p->flow_coarse_side * p->flow_coarse_side <= p->limits.group_threads);
    assert_int_equal(p->flow_sweeps, 1);
    assert_false(p->geometry_traces);
    close_small(g);
}

// `count` slots of a kind from binding 2 on, beside those of the shader.
static gpu_pipeline *make(gpu *g, gpu_slot_kind kind, uint32_t count, const uint32_t local[3]) {
    gpu_slot slots[GPU_MAX_SLOTS] = {
        {.binding = 0, .kind = GPU_SLOT_UNIFORM},
        {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    for (uint32_t i = 0; i < count; i++) slots[2 + i] = (gpu_slot){.binding = 2 + i, .kind = kind};
    gpu_compute_desc desc = {.label = "step",
                             .code = step_comp_code,
                             .code_size = sizeof step_comp_code,
                             .slots = slots,
                             .slot_count = 2 + count};
    memcpy(desc.local_size, local, sizeof desc.local_size);
    return gpu_pipeline_create_compute(g, &desc);
}

static void assert_refused(gpu_pipeline *pipeline, const char *wanted, const char *there,
                           const char *limit) {
    assert_null(pipeline);
    const char *texts[] = {"pipeline 'step'", wanted, there, limit};
    for (size_t i = 0; i < COUNT_OF(texts); i++)
        if (!strstr(err_get(), texts[i])) fail_msg("'%s' is not in: %s", texts[i], err_get());
}

static void more_buffers_than_there_are_is_refused(void **state) {
    const uint32_t local[3] = {64, 1, 1};
    gpu *g = open_small();
    gpu_pipeline *fits = make(g, GPU_SLOT_STORAGE_BUFFER, 7, local);
    gpu_test_ok(fits);
    gpu_pipeline_destroy(g, fits);
    assert_refused(make(g, GPU_SLOT_STORAGE_BUFFER, 8, local), "has 9 storage buffers", "allows 8",
                   "maxPerStageDescriptorStorageBuffers");
    close_small(g);
    gpu_pipeline *other = make(*state, GPU_SLOT_STORAGE_BUFFER, 8, local);
    if (gpu_get_profile(*state)->limits.storage_buffers >= 9) gpu_test_ok(other);
    gpu_pipeline_destroy(*state, other);
}

static void more_images_than_there_are_is_refused(void **state) {
    (void)state;
    const uint32_t local[3] = {64, 1, 1};
    gpu *g = open_small();
    gpu_pipeline *fits = make(g, GPU_SLOT_STORAGE_IMAGE, 4, local);
    gpu_test_ok(fits);
    gpu_pipeline_destroy(g, fits);
    assert_refused(make(g, GPU_SLOT_STORAGE_IMAGE, 5, local), "has 5 storage images", "allows 4",
                   "maxPerStageDescriptorStorageImages");
    close_small(g);
}

static void larger_groups_are_refused(void **state) {
    (void)state;
    const uint32_t local[3] = {16, 16, 2};
    gpu *g = open_small();
    assert_refused(make(g, GPU_SLOT_UNIFORM, 0, local), "has 512 threads", "allows 256",
                   "maxComputeWorkGroupInvocations");
    close_small(g);
}

static void more_shared_memory_is_refused(void **state) {
    const gpu_slot slot = {
        .binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true};
    const gpu_compute_desc desc = {.label = "step",
                                   .code = shared_comp_code,
                                   .code_size = sizeof shared_comp_code,
                                   .slots = &slot,
                                   .slot_count = 1,
                                   .local_size = {8, 1, 1}};
    gpu *g = open_small();
    assert_refused(gpu_pipeline_create_compute(g, &desc), "has 16388 bytes of shared memory",
                   "allows 16384", "maxComputeSharedMemorySize");
    close_small(g);
    if (gpu_get_profile(*state)->limits.shared_bytes < 16388) return;
    gpu_pipeline *other = gpu_pipeline_create_compute(*state, &desc);
    gpu_test_ok(other);
    gpu_pipeline_destroy(*state, other);
}

// Each stage has as many.
static gpu_pipeline *draw(gpu *g, uint32_t of_vertices, uint32_t of_fragments) {
    gpu_slot slots[GPU_MAX_SLOTS] = {
        {.binding = 0, .kind = GPU_SLOT_STORAGE_BUFFER, .stage = GPU_STAGE_VERTEX, .reads = true},
        {.binding = 1, .kind = GPU_SLOT_UNIFORM}};
    uint32_t count = 2;
    for (uint32_t i = 1; i < of_vertices + of_fragments; i++, count++)
        slots[count] = (gpu_slot){.binding = count,
                                  .kind = GPU_SLOT_STORAGE_BUFFER,
                                  .stage = i < of_vertices ? GPU_STAGE_VERTEX : GPU_STAGE_FRAGMENT,
                                  .reads = true};
    return gpu_pipeline_create_graphics(
        g, &(gpu_graphics_desc){.label = "step",
                                .vertex_code = triangle_vert_code,
                                .vertex_size = sizeof triangle_vert_code,
                                .fragment_code = triangle_frag_code,
                                .fragment_size = sizeof triangle_frag_code,
                                .slots = slots,
                                .slot_count = count,
                                .colors = {GPU_RGBA8}});
}

static void stages_count_by_themselves(void **state) {
    (void)state;
    gpu *g = open_small();
    gpu_pipeline *fits = draw(g, 8, 8);
    gpu_test_ok(fits);
    gpu_pipeline_destroy(g, fits);
    assert_refused(draw(g, 8, 9), "has 9 storage buffers", "allows 8",
                   "maxPerStageDescriptorStorageBuffers");
    assert_refused(draw(g, 9, 8), "has 9 storage buffers", "allows 8",
                   "maxPerStageDescriptorStorageBuffers");
    close_small(g);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_devices_report_small_limits),
        cmocka_unit_test(what_does_not_fit_is_cut_smaller),
        cmocka_unit_test(more_buffers_than_there_are_is_refused),
        cmocka_unit_test(more_images_than_there_are_is_refused),
        cmocka_unit_test(larger_groups_are_refused),
        cmocka_unit_test(more_shared_memory_is_refused),
        cmocka_unit_test(stages_count_by_themselves),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
