// What SPIR-V may contain (src/shader/gate.c): by GLSL that asks for too much, and by a module that
// was changed word by word.
#include "shader/unit.h"
#include "shader_helper.h"
#include <spirv_cross/GLSL.std.450.h>

typedef struct hostile {
    const char *globals, *body, *refusal;
} hostile;

// Of what glslang 12 compiles.
static const hostile texts[] = {
    {"#extension GL_EXT_buffer_reference : require\n#extension GL_ARB_gpu_shader_int64 : require\n"
     "layout(buffer_reference, std430) buffer P { uint v; };\n",
     "P p = P(uint64_t(4096)); c = vec4(p.v);", "pointers to memory (buffer_reference)"},
    {"#extension GL_EXT_spirv_intrinsics : require\n"
     "spirv_instruction(capabilities = [4], id = 131) float odd(float a, float b);\n",
     "c = vec4(odd(c.x, c.y));", "capability 4 of SPIR-V"}, // linkage
    {"#extension GL_EXT_spirv_intrinsics : require\n"
     "spirv_instruction(extensions = [\"SPV_KHR_expect_assume\"], id = 131) float odd(float a, "
     "float b);\n",
     "c = vec4(odd(c.x, c.y));", "SPIR-V extension SPV_KHR_expect_assume"},
    {"#extension GL_EXT_spirv_intrinsics : require\n"
     "spirv_instruction(id = 63) void copy(spirv_by_reference vec4 a, spirv_by_reference vec4 "
     "b);\n",
     "vec4 d = c; copy(c, d);", "instruction 63 of SPIR-V"}, // OpCopyMemory
    {"#extension GL_EXT_spirv_intrinsics : require\n"
     "spirv_instruction(set = \"OpenCL.std\", id = 1) float odd(float a);\n",
     "c = vec4(odd(c.x));", "SPIR-V extension OpenCL.std"},
    {"#extension GL_EXT_debug_printf : require\n", "debugPrintfEXT(\"%f\", c.x); c = vec4(1);",
     "SPIR-V extension SPV_KHR_non_semantic_info"},
    {"#pragma use_vulkan_memory_model\n", "c = vec4(1);", "the Vulkan memory model"},
    {"", "double d = double(c.x); c = vec4(float(sqrt(d)));", "double: not accepted"},
    {"#extension GL_EXT_shader_explicit_arithmetic_types : require\n",
     "float16_t h = float16_t(c.x); c = vec4(float(h * h));", "float16_t: not accepted"},
    {"#extension GL_ARB_shader_clock : require\n", "c = vec4(clock2x32ARB().x);",
     "not accepted in shaders"},
    {"#extension GL_EXT_ray_query : require\nuniform accelerationStructureEXT t;\n",
     "rayQueryEXT q; rayQueryInitializeEXT(q, t, 0u, 1u, vec3(0), 0.0, vec3(1), 1.0); "
     "c = vec4(rayQueryProceedEXT(q));",
     "ray queries"},
    {"layout(constant_id = 3) const int many = 4;\n", "c = vec4(many);",
     "constant_id: not accepted"},
    {"", "float t[8193]; for (int i = 0; i < 8193; i++) t[i] = c.x; c = vec4(t[int(c.y)]);",
     "a variable of more than 32 KiB"},
    {"float t[8193];\n", "t[int(c.x)] = c.x; c = vec4(t[int(c.y)]);",
     "a variable of more than 32 KiB"},
    {"float f(float x) { float t[1600]; for (int i = 0; i < 1600; i++) t[i] = x; "
     "return t[int(x)]; }\n",
     "c = vec4(f(1) + f(2) + f(3) + f(4) + f(5) + f(6) + f(7) + f(8));",
     "arrays of more than 48 KiB"},
};

static void write_text(place *p, const hostile *h) {
    strbuf text = {0};
    strbuf_add(&text, "%swriteonly uniform image2D to; //= output r32f : x\n", h->globals);
    strbuf_add(&text, "void main() {\nvec4 c = vec4(gl_GlobalInvocationID, 1);\n%s\n", h->body);
    strbuf_add(&text, "imageStore(to, ivec2(0), c);\n}\n");
    place_write(p, "program/a.comp", text.text);
    strbuf_free(&text);
}

static void what_reaches_too_far_is_refused(void **state) {
    place *p = *state;
    for (size_t i = 0; i < COUNT_OF(texts); i++) {
        write_text(p, &texts[i]);
        place_refuses(p, "a.comp", texts[i].refusal);
        assert_error("a.comp: ");
    }
}

static void what_just_fits_is_accepted(void **state) {
    static const hostile fits[] = {
        {"", "float t[8192]; for (int i = 0; i < 8192; i++) t[i] = c.x; c = vec4(t[int(c.y)]);",
         ""},
        {"#extension GL_ARB_gpu_shader_int64 : require\n",
         "uint64_t l = uint64_t(c.x); c = vec4(float(l * l));", ""},
        {"#extension GL_KHR_shader_subgroup_clustered : require\n",
         "c = vec4(subgroupClusteredAdd(c.x, 4u));", ""},
    };
    place *p = *state;
    for (size_t i = 0; i < COUNT_OF(fits); i++) {
        shader_binary binary;
        write_text(p, &fits[i]);
        place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    }
}

// ---- a module changed word by word -------------------------------------------------------------

typedef struct module {
    uint32_t words[512];
    spirv code;
} module;

static void make(place *p, module *m) {
    shader_binary binary;
    write_text(
        p,
        &(hostile){
            "shared float s[4];\n",
            "s[0] = c.x; barrier(); c *= sin(s[0]); c.y += uintBitsToFloat(floatBitsToUint(c.x));",
            ""});
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_true(binary.size + 8 <= sizeof m->words);
    memcpy(m->words, binary.code, binary.size);
    m->code = (spirv){.words = m->words, .count = binary.size / 4};
}

static uint32_t *first(module *m, SpvOp op) {
    for (size_t at = SPIRV_HEADER; at < m->code.count; at += m->words[at] >> 16)
        if ((m->words[at] & 0xffff) == (uint32_t)op) return m->words + at;
    fail_msg("the module has no instruction %d", op);
    return NULL;
}

// Writes `value` into word `index` of the first `op`; the gate must then say `part`.
static void refuses(const module *whole, SpvOp op, size_t index, uint32_t value, const char *part) {
    module m = *whole;
    m.code.words = m.words;
    first(&m, op)[index] = value;
    err_clear();
    assert_false(spirv_gate(&m.code));
    assert_error(part);
}

static void words_are_looked_at(void **state) {
    module m;
    make(*state, &m);
    assert_true(spirv_gate(&m.code));
    refuses(&m, SpvOpCapability, 1, SpvCapabilityAddresses, "capability 4");
    refuses(&m, SpvOpCapability, 1, SpvCapabilityVariablePointers, "capability 4442");
    refuses(&m, SpvOpMemoryModel, 1, SpvAddressingModelPhysicalStorageBuffer64, "memory models");
    refuses(&m, SpvOpMemoryModel, 2, SpvMemoryModelOpenCL, "memory models");
    refuses(&m, SpvOpEntryPoint, 1, SpvExecutionModelKernel, "entry point");
    refuses(&m, SpvOpEntryPoint, 3, 0x78, "entry point"); // "x"
    refuses(&m, SpvOpExecutionMode, 2, SpvExecutionModeXfb, "execution mode");
    refuses(&m, SpvOpTypePointer, 2, SpvStorageClassPhysicalStorageBuffer, "storage class 5349");
    refuses(&m, SpvOpTypePointer, 2, SpvStorageClassCrossWorkgroup, "storage class 5");
    refuses(&m, SpvOpTypePointer, 3, 0x7fffffff, "a pointer to no number");
    refuses(&m, SpvOpVariable, 3, SpvStorageClassGeneric, "a variable without a place");
    refuses(&m, SpvOpDecorate, 2, SpvDecorationSpecId, "constant_id");
    refuses(&m, SpvOpDecorate, 2, SpvDecorationAliasedPointer, "decoration");
    refuses(&m, SpvOpDecorate, 2, SpvDecorationFlat, "has no location");
    refuses(&m, SpvOpDecorate, 2, SpvDecorationLocation, "has no location"); // compute has none
    refuses(&m, SpvOpDecorate, 3, SpvBuiltInLocalInvocationIndex, "has no location"); // of 3
    refuses(&m, SpvOpDecorate, 3, SpvBuiltInLayer, "built-in variable 9");
    uint32_t pointer = first(&m, SpvOpAccessChain)[2];
    refuses(&m, SpvOpExtInst, 3, 0x7fffffff, "extended instruction");
    refuses(&m, SpvOpExtInst, 4, GLSLstd450InterpolateAtOffset, "extended instruction");
    refuses(&m, SpvOpLabel, 1, m.words[SPIRV_BOUND], "not a module");
    refuses(&m, SpvOpLabel, 0, 0, "not a module");
    refuses(&m, SpvOpLabel, 0, SpvOpLabel | 0xffffu << 16, "not a module");
    refuses(&m, SpvOpFunction, 2, first(&m, SpvOpTypeVoid)[1], "not a module");
    refuses(&m, SpvOpLoad, 1, first(&m, SpvOpTypePointer)[1], "a pointer that is not to a part");
    refuses(&m, SpvOpBitcast, 3, pointer, "a number made of a pointer");
    refuses(&m, SpvOpExecutionMode, 2, SpvExecutionModeLocalSizeId, "execution mode 38");
    refuses(&m, SpvOpExecutionMode, 0, 6u << 16 | SpvOpExecutionModeId, "execution mode 17");
    module far = m; // lavapipe crashes on a location beyond its table
    first(&far, SpvOpDecorate)[2] = SpvDecorationLocation;
    refuses(&far, SpvOpDecorate, 3, 262255, "location 262255");
    refuses(&far, SpvOpDecorate, 3, 32, "location 32");
    first(&far, SpvOpDecorate)[2] = SpvDecorationComponent;
    refuses(&far, SpvOpDecorate, 3, 4, "no such part");
    module by_id = m; // SPIRV-Cross crashes on a size that is a variable
    uint32_t *mode = first(&by_id, SpvOpExecutionMode);
    mode[0] = 6u << 16 | SpvOpExecutionModeId;
    mode[2] = SpvExecutionModeLocalSizeId;
    mode[3] = mode[4] = mode[5] = first(&m, SpvOpConstant)[2];
    refuses(&by_id, SpvOpExecutionModeId, 4, first(&m, SpvOpVariable)[2], "the size of a group");
    refuses(&by_id, SpvOpExecutionModeId, 5, m.words[SPIRV_BOUND], "the size of a group");
    m.words[SPIRV_BOUND] = UINT32_MAX;
    assert_false(spirv_gate(&m.code));
    m.words[0] = 0;
    assert_false(spirv_gate(&m.code));
}

// Of all instructions there are, and will be: what is not listed does not pass.
static void instructions_are_listed(void **state) {
    module m;
    make(*state, &m);
    size_t passed = 0, at = (size_t)(first(&m, SpvOpReturn) - m.words);
    memmove(m.words + at + 1, m.words + at, (m.code.count - at) * sizeof *m.words);
    m.code.count++;
    for (uint32_t op = 0; op < 0x10000; op++) {
        m.words[at] = 1u << 16 | op; // too short for most; the gate must stand that
        passed += spirv_gate(&m.code);
    }
    assert_true(passed > 10 && passed < 200);
    static const SpvOp never[] = {
        SpvOpTypeForwardPointer,
        SpvOpTypeEvent,
        SpvOpSpecConstantOp,
        SpvOpCopyMemory,
        SpvOpCopyMemorySized,
        SpvOpPtrAccessChain,
        SpvOpInBoundsPtrAccessChain,
        SpvOpConvertPtrToU,
        SpvOpConvertUToPtr,
        SpvOpGenericPtrMemSemantics,
        SpvOpImageSparseFetch,
        SpvOpAtomicFAddEXT,
        SpvOpCooperativeMatrixLoadNV,
        SpvOpReadClockKHR,
        SpvOpTraceRayKHR,
        SpvOpFunctionPointerCallINTEL,
        SpvOpAsmCallINTEL,
        SpvOpLifetimeStart,
    };
    for (size_t i = 0; i < COUNT_OF(never); i++) {
        char part[32];
        snprintf(part, sizeof part, "instruction %d of SPIR-V", never[i]);
        m.words[at] = 1u << 16 | never[i];
        err_clear();
        bool done = spirv_gate(&m.code);
        assert_false(done);
        if (!strstr(err_get(), "not a module")) assert_error(part);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(what_reaches_too_far_is_refused),
        PLACE_TEST(what_just_fits_is_accepted),
        PLACE_TEST(words_are_looked_at),
        PLACE_TEST(instructions_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
