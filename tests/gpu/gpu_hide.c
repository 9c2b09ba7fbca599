// Uniforms that a branch depends on: any value counts at once, and none stays behind. A software
// driver would make a shader of its own for every dispatch (src/gpu/hide.c), and read them anew in
// every branch (src/gpu/hoist.c).
#include "gpu/spirv.h"
#include "gpu/vk.h"
#include "gpu_test.h"
#include <string.h>
#include <unistd.h>

// clang-format off

/* way.comp
   #version 460
   layout(local_size_x = 8) in;
   layout(binding = 0) uniform Params { float scale; int way; };
   layout(binding = 1) buffer Values { float values[]; };
   float mixed(float v) {
       float a = sin(v + 1.0), b = cos(v * 2.0), c = fract(v * 3.0), d = sqrt(abs(v) + 4.0);
       return fract(a * b + c * d + a * c + b * d) + scale;
   }
   float dear(float v) {
       return mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(v))))))));
   }
   void main() {
       uint i = gl_GlobalInvocationID.x;
       float v = scale * float(way);
       if (way > 2) v = dear(dear(float(i)));
       values[i] = v;
   } */
static const uint32_t way_comp_code[] = {
    0x07230203, 0x00010600, 0x0008000b, 0x0000007d, 0x00000000, 0x00020011, 0x00000001, 0x0006000b,
    0x00000001, 0x4c534c47, 0x6474732e, 0x3035342e, 0x00000000, 0x0003000e, 0x00000000, 0x00000001,
    0x0008000f, 0x00000005, 0x00000004, 0x6e69616d, 0x00000000, 0x0000003a, 0x00000059, 0x00000077,
    0x0006014b, 0x00000004, 0x00000026, 0x00000007, 0x00000008, 0x00000008, 0x00030003, 0x00000002,
    0x000001cc, 0x00040005, 0x00000004, 0x6e69616d, 0x00000000, 0x00050005, 0x0000000d, 0x6578696d,
    0x31662864, 0x0000003b, 0x00030005, 0x0000000c, 0x00000076, 0x00050005, 0x00000010, 0x72616564,
    0x3b316628, 0x00000000, 0x00030005, 0x0000000f, 0x00000076, 0x00030005, 0x00000012, 0x00000061,
    0x00030005, 0x00000017, 0x00000062, 0x00030005, 0x0000001c, 0x00000063, 0x00030005, 0x00000021,
    0x00000064, 0x00040005, 0x00000038, 0x61726150, 0x0000736d, 0x00050006, 0x00000038, 0x00000000,
    0x6c616373, 0x00000065, 0x00040006, 0x00000038, 0x00000001, 0x00796177, 0x00030005, 0x0000003a,
    0x00000000, 0x00040005, 0x00000042, 0x61726170, 0x0000006d, 0x00040005, 0x00000045, 0x61726170,
    0x0000006d, 0x00040005, 0x00000047, 0x61726170, 0x0000006d, 0x00040005, 0x00000049, 0x61726170,
    0x0000006d, 0x00040005, 0x0000004b, 0x61726170, 0x0000006d, 0x00040005, 0x0000004d, 0x61726170,
    0x0000006d, 0x00040005, 0x0000004f, 0x61726170, 0x0000006d, 0x00040005, 0x00000051, 0x61726170,
    0x0000006d, 0x00030005, 0x00000056, 0x00000069, 0x00080005, 0x00000059, 0x475f6c67, 0x61626f6c,
    0x766e496c, 0x7461636f, 0x496e6f69, 0x00000044, 0x00030005, 0x0000005e, 0x00000076, 0x00040005,
    0x00000070, 0x61726170, 0x0000006d, 0x00040005, 0x00000072, 0x61726170, 0x0000006d, 0x00040005,
    0x00000075, 0x756c6156, 0x00007365, 0x00050006, 0x00000075, 0x00000000, 0x756c6176, 0x00007365,
    0x00030005, 0x00000077, 0x00000000, 0x00050048, 0x00000038, 0x00000000, 0x00000023, 0x00000000,
    0x00050048, 0x00000038, 0x00000001, 0x00000023, 0x00000004, 0x00030047, 0x00000038, 0x00000002,
    0x00040047, 0x0000003a, 0x00000022, 0x00000000, 0x00040047, 0x0000003a, 0x00000021, 0x00000000,
    0x00040047, 0x00000059, 0x0000000b, 0x0000001c, 0x00040047, 0x00000074, 0x00000006, 0x00000004,
    0x00050048, 0x00000075, 0x00000000, 0x00000023, 0x00000000, 0x00030047, 0x00000075, 0x00000002,
    0x00040047, 0x00000077, 0x00000022, 0x00000000, 0x00040047, 0x00000077, 0x00000021, 0x00000001,
    0x00020013, 0x00000002, 0x00030021, 0x00000003, 0x00000002, 0x00040015, 0x00000006, 0x00000020,
    0x00000000, 0x0004002b, 0x00000006, 0x00000007, 0x00000008, 0x0004002b, 0x00000006, 0x00000008,
    0x00000001, 0x00030016, 0x00000009, 0x00000020, 0x00040020, 0x0000000a, 0x00000007, 0x00000009,
    0x00040021, 0x0000000b, 0x00000009, 0x0000000a, 0x0004002b, 0x00000009, 0x00000014, 0x3f800000,
    0x0004002b, 0x00000009, 0x00000019, 0x40000000, 0x0004002b, 0x00000009, 0x0000001e, 0x40400000,
    0x0004002b, 0x00000009, 0x00000024, 0x40800000, 0x00040015, 0x00000037, 0x00000020, 0x00000001,
    0x0004001e, 0x00000038, 0x00000009, 0x00000037, 0x00040020, 0x00000039, 0x00000002, 0x00000038,
    0x0004003b, 0x00000039, 0x0000003a, 0x00000002, 0x0004002b, 0x00000037, 0x0000003b, 0x00000000,
    0x00040020, 0x0000003c, 0x00000002, 0x00000009, 0x00040020, 0x00000055, 0x00000007, 0x00000006,
    0x00040017, 0x00000057, 0x00000006, 0x00000003, 0x00040020, 0x00000058, 0x00000001, 0x00000057,
    0x0004003b, 0x00000058, 0x00000059, 0x00000001, 0x0004002b, 0x00000006, 0x0000005a, 0x00000000,
    0x00040020, 0x0000005b, 0x00000001, 0x00000006, 0x0004002b, 0x00000037, 0x00000061, 0x00000001,
    0x00040020, 0x00000062, 0x00000002, 0x00000037, 0x0004002b, 0x00000037, 0x00000069, 0x00000002,
    0x00020014, 0x0000006a, 0x0003001d, 0x00000074, 0x00000009, 0x0003001e, 0x00000075, 0x00000074,
    0x00040020, 0x00000076, 0x0000000c, 0x00000075, 0x0004003b, 0x00000076, 0x00000077, 0x0000000c,
    0x00040020, 0x0000007a, 0x0000000c, 0x00000009, 0x0006002c, 0x00000057, 0x0000007c, 0x00000007,
    0x00000008, 0x00000008, 0x00050036, 0x00000002, 0x00000004, 0x00000000, 0x00000003, 0x000200f8,
    0x00000005, 0x0004003b, 0x00000055, 0x00000056, 0x00000007, 0x0004003b, 0x0000000a, 0x0000005e,
    0x00000007, 0x0004003b, 0x0000000a, 0x00000070, 0x00000007, 0x0004003b, 0x0000000a, 0x00000072,
    0x00000007, 0x00050041, 0x0000005b, 0x0000005c, 0x00000059, 0x0000005a, 0x0004003d, 0x00000006,
    0x0000005d, 0x0000005c, 0x0003003e, 0x00000056, 0x0000005d, 0x00050041, 0x0000003c, 0x0000005f,
    0x0000003a, 0x0000003b, 0x0004003d, 0x00000009, 0x00000060, 0x0000005f, 0x00050041, 0x00000062,
    0x00000063, 0x0000003a, 0x00000061, 0x0004003d, 0x00000037, 0x00000064, 0x00000063, 0x0004006f,
    0x00000009, 0x00000065, 0x00000064, 0x00050085, 0x00000009, 0x00000066, 0x00000060, 0x00000065,
    0x0003003e, 0x0000005e, 0x00000066, 0x00050041, 0x00000062, 0x00000067, 0x0000003a, 0x00000061,
    0x0004003d, 0x00000037, 0x00000068, 0x00000067, 0x000500ad, 0x0000006a, 0x0000006b, 0x00000068,
    0x00000069, 0x000300f7, 0x0000006d, 0x00000000, 0x000400fa, 0x0000006b, 0x0000006c, 0x0000006d,
    0x000200f8, 0x0000006c, 0x0004003d, 0x00000006, 0x0000006e, 0x00000056, 0x00040070, 0x00000009,
    0x0000006f, 0x0000006e, 0x0003003e, 0x00000070, 0x0000006f, 0x00050039, 0x00000009, 0x00000071,
    0x00000010, 0x00000070, 0x0003003e, 0x00000072, 0x00000071, 0x00050039, 0x00000009, 0x00000073,
    0x00000010, 0x00000072, 0x0003003e, 0x0000005e, 0x00000073, 0x000200f9, 0x0000006d, 0x000200f8,
    0x0000006d, 0x0004003d, 0x00000006, 0x00000078, 0x00000056, 0x0004003d, 0x00000009, 0x00000079,
    0x0000005e, 0x00060041, 0x0000007a, 0x0000007b, 0x00000077, 0x0000003b, 0x00000078, 0x0003003e,
    0x0000007b, 0x00000079, 0x000100fd, 0x00010038, 0x00050036, 0x00000009, 0x0000000d, 0x00000000,
    0x0000000b, 0x00030037, 0x0000000a, 0x0000000c, 0x000200f8, 0x0000000e, 0x0004003b, 0x0000000a,
    0x00000012, 0x00000007, 0x0004003b, 0x0000000a, 0x00000017, 0x00000007, 0x0004003b, 0x0000000a,
    0x0000001c, 0x00000007, 0x0004003b, 0x0000000a, 0x00000021, 0x00000007, 0x0004003d, 0x00000009,
    0x00000013, 0x0000000c, 0x00050081, 0x00000009, 0x00000015, 0x00000013, 0x00000014, 0x0006000c,
    0x00000009, 0x00000016, 0x00000001, 0x0000000d, 0x00000015, 0x0003003e, 0x00000012, 0x00000016,
    0x0004003d, 0x00000009, 0x00000018, 0x0000000c, 0x00050085, 0x00000009, 0x0000001a, 0x00000018,
    0x00000019, 0x0006000c, 0x00000009, 0x0000001b, 0x00000001, 0x0000000e, 0x0000001a, 0x0003003e,
    0x00000017, 0x0000001b, 0x0004003d, 0x00000009, 0x0000001d, 0x0000000c, 0x00050085, 0x00000009,
    0x0000001f, 0x0000001d, 0x0000001e, 0x0006000c, 0x00000009, 0x00000020, 0x00000001, 0x0000000a,
    0x0000001f, 0x0003003e, 0x0000001c, 0x00000020, 0x0004003d, 0x00000009, 0x00000022, 0x0000000c,
    0x0006000c, 0x00000009, 0x00000023, 0x00000001, 0x00000004, 0x00000022, 0x00050081, 0x00000009,
    0x00000025, 0x00000023, 0x00000024, 0x0006000c, 0x00000009, 0x00000026, 0x00000001, 0x0000001f,
    0x00000025, 0x0003003e, 0x00000021, 0x00000026, 0x0004003d, 0x00000009, 0x00000027, 0x00000012,
    0x0004003d, 0x00000009, 0x00000028, 0x00000017, 0x00050085, 0x00000009, 0x00000029, 0x00000027,
    0x00000028, 0x0004003d, 0x00000009, 0x0000002a, 0x0000001c, 0x0004003d, 0x00000009, 0x0000002b,
    0x00000021, 0x00050085, 0x00000009, 0x0000002c, 0x0000002a, 0x0000002b, 0x00050081, 0x00000009,
    0x0000002d, 0x00000029, 0x0000002c, 0x0004003d, 0x00000009, 0x0000002e, 0x00000012, 0x0004003d,
    0x00000009, 0x0000002f, 0x0000001c, 0x00050085, 0x00000009, 0x00000030, 0x0000002e, 0x0000002f,
    0x00050081, 0x00000009, 0x00000031, 0x0000002d, 0x00000030, 0x0004003d, 0x00000009, 0x00000032,
    0x00000017, 0x0004003d, 0x00000009, 0x00000033, 0x00000021, 0x00050085, 0x00000009, 0x00000034,
    0x00000032, 0x00000033, 0x00050081, 0x00000009, 0x00000035, 0x00000031, 0x00000034, 0x0006000c,
    0x00000009, 0x00000036, 0x00000001, 0x0000000a, 0x00000035, 0x00050041, 0x0000003c, 0x0000003d,
    0x0000003a, 0x0000003b, 0x0004003d, 0x00000009, 0x0000003e, 0x0000003d, 0x00050081, 0x00000009,
    0x0000003f, 0x00000036, 0x0000003e, 0x000200fe, 0x0000003f, 0x00010038, 0x00050036, 0x00000009,
    0x00000010, 0x00000000, 0x0000000b, 0x00030037, 0x0000000a, 0x0000000f, 0x000200f8, 0x00000011,
    0x0004003b, 0x0000000a, 0x00000042, 0x00000007, 0x0004003b, 0x0000000a, 0x00000045, 0x00000007,
    0x0004003b, 0x0000000a, 0x00000047, 0x00000007, 0x0004003b, 0x0000000a, 0x00000049, 0x00000007,
    0x0004003b, 0x0000000a, 0x0000004b, 0x00000007, 0x0004003b, 0x0000000a, 0x0000004d, 0x00000007,
    0x0004003b, 0x0000000a, 0x0000004f, 0x00000007, 0x0004003b, 0x0000000a, 0x00000051, 0x00000007,
    0x0004003d, 0x00000009, 0x00000043, 0x0000000f, 0x0003003e, 0x00000042, 0x00000043, 0x00050039,
    0x00000009, 0x00000044, 0x0000000d, 0x00000042, 0x0003003e, 0x00000045, 0x00000044, 0x00050039,
    0x00000009, 0x00000046, 0x0000000d, 0x00000045, 0x0003003e, 0x00000047, 0x00000046, 0x00050039,
    0x00000009, 0x00000048, 0x0000000d, 0x00000047, 0x0003003e, 0x00000049, 0x00000048, 0x00050039,
    0x00000009, 0x0000004a, 0x0000000d, 0x00000049, 0x0003003e, 0x0000004b, 0x0000004a, 0x00050039,
    0x00000009, 0x0000004c, 0x0000000d, 0x0000004b, 0x0003003e, 0x0000004d, 0x0000004c, 0x00050039,
    0x00000009, 0x0000004e, 0x0000000d, 0x0000004d, 0x0003003e, 0x0000004f, 0x0000004e, 0x00050039,
    0x00000009, 0x00000050, 0x0000000d, 0x0000004f, 0x0003003e, 0x00000051, 0x00000050, 0x00050039,
    0x00000009, 0x00000052, 0x0000000d, 0x00000051, 0x000200fe, 0x00000052, 0x00010038,
};

// clang-format on

enum { COUNT = 8, MANY = 1001 * COUNT, WARM = 200, TURNS = 800 };

typedef struct params {
    float scale;
    int32_t way;
} params;

static void run_threads(gpu *g, gpu_pipeline *pipeline, gpu_buffer *values, params p,
                        uint32_t threads) {
    const gpu_binding bindings[] = {{.binding = 0, .uniform = &p, .uniform_size = sizeof p},
                                    {.binding = 1, .buffer = values}};
    gpu_test_ok(gpu_frame_begin(g));
    gpu_test_ok(gpu_dispatch(g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                     .bindings = bindings,
                                                     .binding_count = COUNT_OF(bindings),
                                                     .threads = {threads, 1, 1}}));
    gpu_test_ok(gpu_frame_end(g));
}

static void run(gpu *g, gpu_pipeline *pipeline, gpu_buffer *values, params p) {
    run_threads(g, pipeline, values, p, COUNT);
}

static gpu_pipeline *make_pipeline(gpu *g) {
    const gpu_slot slots[] = {
        {.binding = 0, .kind = GPU_SLOT_UNIFORM},
        {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    gpu_pipeline *pipeline =
        gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "way",
                                                           .code = way_comp_code,
                                                           .code_size = sizeof way_comp_code,
                                                           .slots = slots,
                                                           .slot_count = COUNT_OF(slots),
                                                           .local_size = {8, 1, 1}});
    gpu_test_ok(pipeline);
    return pipeline;
}

static gpu_buffer *make_values(gpu *g, size_t count) {
    gpu_buffer *values = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "values", .size = count * 4, .kind = GPU_BUFFER_DEVICE});
    gpu_test_ok(values);
    return values;
}

static void values_count_at_once(void **state) {
    gpu *g = *state;
    gpu_pipeline *pipeline = make_pipeline(g);
    gpu_buffer *values = make_values(g, COUNT);
    for (int32_t way = 0; way < 5; way++) {
        float got[COUNT];
        run(g, pipeline, values, (params){0.5f, way});
        gpu_test_ok(gpu_buffer_read(g, values, 0, got, sizeof got));
        for (int i = 0; i < COUNT; i++) { // the dear branch gives 0.5 to 1.5, each its own
            if (way <= 2) assert_true(got[i] == 0.5f * (float)way);
            if (way > 2) assert_true(got[i] >= 0.5f && got[i] < 1.5f);
        }
        if (way > 2) assert_true(got[0] != got[1]);
    }
    gpu_buffer_destroy(g, values);
    gpu_pipeline_destroy(g, pipeline);
}

// Of a dispatch that goes in slices on a software driver (src/gpu/dispatch.c).
static void every_group_of_many_runs(void **state) {
    gpu *g = *state;
    static float got[MANY];
    gpu_pipeline *pipeline = make_pipeline(g);
    gpu_buffer *values = make_values(g, MANY);
    for (int32_t way = 1; way < 3; way++) { // what the first round left does not pass the second
        run_threads(g, pipeline, values, (params){0.5f, way}, MANY);
        gpu_test_ok(gpu_buffer_read(g, values, 0, got, sizeof got));
        for (int i = 0; i < MANY; i++)
            if (got[i] != 0.5f * (float)way) fail_msg("thread %d gave %g", i, (double)got[i]);
    }
    gpu_buffer_destroy(g, values);
    gpu_pipeline_destroy(g, pipeline);
}

static long resident(void) { // bytes
    FILE *f = fopen("/proc/self/statm", "r");
    long all, now;
    assert_non_null(f);
    assert_int_equal(fscanf(f, "%ld %ld", &all, &now), 2);
    fclose(f);
    return now * sysconf(_SC_PAGESIZE);
}

static void memory_does_not_grow(void **state) {
    gpu *g = *state;
    gpu_pipeline *pipeline = make_pipeline(g);
    gpu_buffer *values = make_values(g, COUNT);
    for (int i = 0; i < WARM; i++) run(g, pipeline, values, (params){0.5f, i % 3});
    long before = resident();
    for (int i = 0; i < TURNS; i++) run(g, pipeline, values, (params){0.5f, i % 3});
    gpu_test_ok(gpu_idle(g));
    long grown = resident() - before; // 115 MB, when each dispatch left a shader behind
    if (grown > 16 << 20) fail_msg("%ld bytes more after %d dispatches", grown, TURNS);
    gpu_buffer_destroy(g, values);
    gpu_pipeline_destroy(g, pipeline);
}

enum { PARAMS = 0x3a }; // the id of the block

// Chains into the block, and the first branch, in words; 0: none.
static size_t count_reads(const uint32_t *code, size_t count, size_t *last, size_t *branch) {
    size_t reads = 0;
    *last = *branch = 0;
    for (size_t at = SPIRV_HEADER; at < count; at += code[at] >> 16) {
        uint32_t op = code[at] & 0xffff;
        if (op == 250 && !*branch) *branch = at; // OpBranchConditional
        if (op != SpvOpAccessChain || code[at + 3] != PARAMS) continue;
        *last = at;
        reads++;
    }
    return reads;
}

static void each_number_is_read_once_before_branches(void **state) {
    (void)state;
    size_t size = 0, last, branch;
    uint32_t *code = vk_hoist_uniforms(way_comp_code, sizeof way_comp_code, &size);
    assert_non_null(code);
    assert_int_equal(count_reads(way_comp_code, COUNT_OF(way_comp_code), &last, &branch), 4);
    assert_true(last > branch);
    assert_int_equal(count_reads(code, size / 4, &last, &branch), 2);
    assert_true(last < branch);
    mem_free(code);
}

// Where a chain is more than read (here its pointer is copied), it stays.
static void what_is_not_only_read_stays(void **state) {
    (void)state;
    static uint32_t copied[COUNT_OF(way_comp_code)];
    memcpy(copied, way_comp_code, sizeof copied);
    for (size_t at = SPIRV_HEADER; at < COUNT_OF(copied); at += copied[at] >> 16)
        if ((copied[at] & 0xffff) == SpvOpLoad && copied[at + 3] == 0x67)
            copied[at] = 4 << 16 | SpvOpCopyObject;
    size_t size = 0, last, branch;
    uint32_t *code = vk_hoist_uniforms(copied, sizeof copied, &size);
    assert_non_null(code);
    assert_int_equal(count_reads(code, size / 4, &last, &branch), 3);
    mem_free(code);
}

static void broken_code_is_left(void **state) {
    (void)state;
    static uint32_t broken[COUNT_OF(way_comp_code)];
    size_t size = 77;
    for (size_t i = SPIRV_HEADER; i < COUNT_OF(broken); i++) { // an id that cannot be, a long end
        memcpy(broken, way_comp_code, sizeof broken);
        broken[i] = UINT32_MAX;
        uint32_t *code = vk_hoist_uniforms(broken, sizeof broken, &size);
        mem_free(code);
    }
    memcpy(broken, way_comp_code, sizeof broken);
    assert_null(vk_hoist_uniforms(broken, SPIRV_HEADER * 4, &(size_t){0}));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_number_is_read_once_before_branches),
    cmocka_unit_test(what_is_not_only_read_stays),
    cmocka_unit_test(broken_code_is_left),
    cmocka_unit_test(values_count_at_once),
    cmocka_unit_test(every_group_of_many_runs),
    cmocka_unit_test(memory_does_not_grow),
};

int main(void) {
    return gpu_test_run(tests, COUNT_OF(tests));
}
