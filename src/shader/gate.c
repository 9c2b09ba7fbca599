// Decides what SPIR-V may contain before a driver sees it.
//
// A driver trusts its input, and a shader may come from a stranger: through physical pointers, for
// example, it could read and write the memory of this process. Only what is listed here passes, and
// each row gives the reason. Everything else is refused, including future extensions.
//
// The memory that a shader keeps for itself is bounded as well. Drivers allocate each thread's
// arrays on a stack or in registers, and take seconds to compile large ones (lavapipe 22.3: 6 s for
// 16 KiB).
//
// The rules concern single instructions; whether the module is valid as a whole is checked by the
// validator, in the compiler's process (glsl.c).
#include "shader/unit.h"
#include <spirv_cross/GLSL.std.450.h>
#include <string.h>

enum { MOST_OFFSET = 1 << 28, MOST_NAME = 4096 };
enum { MOST_LOCATIONS = 32, MOST_TARGETS = 8 }; // every device has as many, or says so itself

typedef struct range { // of words of one sort, both included
    uint32_t first, last;
} range;

#define HAS(table, value) table_has(table, COUNT_OF(table), value)

static bool table_has(const range *table, size_t count, uint32_t value) {
    for (size_t i = 0; i < count; i++)
        if (value >= table[i].first && value <= table[i].last) return true;
    return false;
}

// ---- what is accepted -------------------------------------------------------------------------

static const range instructions[] = {
    {SpvOpUndef, SpvOpName},              // sources and names: nothing is done with them
    {SpvOpMemberName, SpvOpLine},         //
    {SpvOpNoLine, SpvOpNoLine},           //
    {SpvOpExtension, SpvOpExecutionMode}, // each looked at below
    {SpvOpCapability, SpvOpCapability},   //
    {SpvOpExecutionModeId, SpvOpExecutionModeId},
    {SpvOpDecorate, SpvOpMemberDecorate},
    {SpvOpTypeVoid, SpvOpTypeImage}, // no separate samplers: nothing binds them
    {SpvOpTypeSampledImage, SpvOpTypeStruct},
    {SpvOpTypePointer, SpvOpTypeFunction},
    {SpvOpConstantTrue, SpvOpConstantComposite}, // nobody sets specialisation constants
    {SpvOpConstantNull, SpvOpConstantNull},
    {SpvOpFunction, SpvOpFunctionCall},
    {SpvOpVariable, SpvOpStore}, // by pointers that the module makes of its own variables;
    {SpvOpAccessChain, SpvOpInBoundsAccessChain}, // no arithmetic with them, no copies by size
    {SpvOpArrayLength, SpvOpArrayLength},
    {SpvOpVectorExtractDynamic, SpvOpTranspose}, // values: parts, whole, copies
    {SpvOpCopyLogical, SpvOpCopyLogical},
    {SpvOpImageSampleImplicitLod, SpvOpImageSampleExplicitLod}, // no comparing: samplers do not
    {SpvOpImageSampleProjImplicitLod, SpvOpImageSampleProjExplicitLod},
    {SpvOpImageFetch, SpvOpImageGather}, // robust access keeps them in bounds
    {SpvOpImageRead, SpvOpImage},
    {SpvOpImageQuerySizeLod, SpvOpImageQueryLevels},
    {SpvOpConvertFToU, SpvOpQuantizeToF16}, // arithmetic of numbers
    {SpvOpBitcast, SpvOpBitcast},
    {SpvOpSNegate, SpvOpSMulExtended},
    {SpvOpAny, SpvOpIsInf},
    {SpvOpLogicalEqual, SpvOpFUnordGreaterThanEqual},
    {SpvOpShiftRightLogical, SpvOpBitCount},
    {SpvOpExtInst, SpvOpExtInst}, // of GLSL.std.450
    {SpvOpDPdx, SpvOpFwidthCoarse},
    {SpvOpControlBarrier, SpvOpMemoryBarrier},
    {SpvOpAtomicLoad, SpvOpAtomicCompareExchange}, // of whole numbers
    {SpvOpAtomicIIncrement, SpvOpAtomicXor},
    {SpvOpPhi, SpvOpUnreachable}, // the flow of control
    {SpvOpTerminateInvocation, SpvOpTerminateInvocation},
    {SpvOpGroupNonUniformElect, SpvOpGroupNonUniformQuadSwap}, // among the threads of a subgroup
};

static const range capabilities[] = {
    {SpvCapabilityMatrix, SpvCapabilityShader}, // what every shader is made of
    {SpvCapabilityInt64, SpvCapabilityInt64},   // two words at once; the device says if it can
    {SpvCapabilityImageGatherExtended, SpvCapabilityImageGatherExtended}, // textureGatherOffset
    {SpvCapabilityStorageImageExtendedFormats, SpvCapabilityDerivativeControl}, // r16f, textureSize
    {SpvCapabilityStorageImageReadWithoutFormat, SpvCapabilityStorageImageWriteWithoutFormat},
    {SpvCapabilityGroupNonUniform, SpvCapabilityGroupNonUniformQuad}, // subgroups
};

static const range storages[] = {
    {SpvStorageClassUniformConstant, SpvStorageClassOutput}, // bound by us, or between the stages
    {SpvStorageClassWorkgroup, SpvStorageClassWorkgroup},    // indices are clamped: gpu/clamp.c
    {SpvStorageClassPrivate, SpvStorageClassFunction},       // the same
    {SpvStorageClassPushConstant, SpvStorageClassPushConstant}, // reflect.c refuses it by name
    {SpvStorageClassImage, SpvStorageClassStorageBuffer},
};

static const range modes[] = {
    {SpvExecutionModeOriginUpperLeft, SpvExecutionModeOriginUpperLeft},
    {SpvExecutionModeEarlyFragmentTests, SpvExecutionModeEarlyFragmentTests},
    {SpvExecutionModeDepthReplacing, SpvExecutionModeDepthUnchanged}, // gl_FragDepth
    {SpvExecutionModeLocalSize, SpvExecutionModeLocalSize},           // the device's limits hold
    {SpvExecutionModeLocalSizeId, SpvExecutionModeLocalSizeId},
};

static const range decorations[] = {
    {SpvDecorationRelaxedPrecision, SpvDecorationRelaxedPrecision},
    {SpvDecorationBlock, SpvDecorationMatrixStride}, // layouts; offsets are looked at below
    {SpvDecorationBuiltIn, SpvDecorationBuiltIn},
    {SpvDecorationNoPerspective, SpvDecorationFlat},
    {SpvDecorationCentroid, SpvDecorationCentroid},
    {SpvDecorationInvariant, SpvDecorationNonReadable},
    {SpvDecorationLocation, SpvDecorationOffset}, // places among slots, targets and in blocks
    {SpvDecorationNoContraction, SpvDecorationNoContraction},
};

typedef struct built_in { // what its variable is, or a member of such a struct
    uint32_t word, storage, scalar, components;
} built_in;

#define BUILT_IN(name, storage, scalar, components)                                                \
    { SpvBuiltIn##name, SpvStorageClass##storage, SpvOpType##scalar, components }

static const built_in built_ins[] = {
    BUILT_IN(Position, Output, Float, 4),
    BUILT_IN(PointSize, Output, Float, 1),
    BUILT_IN(ClipDistance, Output, Array, 0), // stand in gl_PerVertex, unused:
    BUILT_IN(CullDistance, Output, Array, 0), // using them is a capability
    BUILT_IN(FragDepth, Output, Float, 1),
    BUILT_IN(FragCoord, Input, Float, 4),
    BUILT_IN(PointCoord, Input, Float, 2),
    BUILT_IN(FrontFacing, Input, Bool, 1),
    BUILT_IN(HelperInvocation, Input, Bool, 1),
    BUILT_IN(NumWorkgroups, Input, Int, 3),
    BUILT_IN(WorkgroupId, Input, Int, 3),
    BUILT_IN(LocalInvocationId, Input, Int, 3),
    BUILT_IN(GlobalInvocationId, Input, Int, 3),
    BUILT_IN(LocalInvocationIndex, Input, Int, 1),
    BUILT_IN(SubgroupSize, Input, Int, 1),
    BUILT_IN(NumSubgroups, Input, Int, 1),
    BUILT_IN(SubgroupId, Input, Int, 1),
    BUILT_IN(SubgroupLocalInvocationId, Input, Int, 1),
    BUILT_IN(VertexIndex, Input, Int, 1),
    BUILT_IN(InstanceIndex, Input, Int, 1),
    BUILT_IN(SubgroupEqMask, Input, Int, 4),
    BUILT_IN(SubgroupGeMask, Input, Int, 4),
    BUILT_IN(SubgroupGtMask, Input, Int, 4),
    BUILT_IN(SubgroupLeMask, Input, Int, 4),
    BUILT_IN(SubgroupLtMask, Input, Int, 4),
    BUILT_IN(WorkgroupSize, Max, Int, 3), // of a constant
};

static const built_in *find_built_in(uint32_t word) {
    for (size_t i = 0; i < COUNT_OF(built_ins); i++)
        if (built_ins[i].word == word) return &built_ins[i];
    return NULL;
}

// Only these make pointers: to the module's own variables, within their bounds.
static const range pointer_makers[] = {
    {SpvOpFunctionParameter, SpvOpFunctionParameter},
    {SpvOpVariable, SpvOpImageTexelPointer},
    {SpvOpAccessChain, SpvOpInBoundsAccessChain},
};

// ---- names for messages -----------------------------------------------------------------------

typedef struct known { // what shaders ask for most among what is refused
    uint32_t capability;
    const char *words;
} known;

static const known refused[] = {
    {SpvCapabilityPhysicalStorageBufferAddresses, "pointers to memory (buffer_reference)"},
    {SpvCapabilityFloat64, "double"},
    {SpvCapabilityFloat16, "float16_t"},
    {SpvCapabilityInt16, "int16_t"},
    {SpvCapabilityInt8, "int8_t"},
    {SpvCapabilityInt64Atomics, "atomics of 64 bits"},
    {SpvCapabilityStorageBuffer16BitAccess, "numbers of 16 bits in buffers"},
    {SpvCapabilityStorageBuffer8BitAccess, "numbers of 8 bits in buffers"},
    {SpvCapabilityClipDistance, "gl_ClipDistance"},
    {SpvCapabilityCullDistance, "gl_CullDistance"},
    {SpvCapabilityGeometry, "gl_PrimitiveID and gl_Layer"},
    {SpvCapabilityShaderViewportIndexLayerEXT, "gl_Layer"},
    {SpvCapabilitySampleRateShading, "gl_SampleID and interpolateAt..."},
    {SpvCapabilityInputAttachment, "subpassInput"},
    {SpvCapabilityDrawParameters, "gl_BaseInstance, gl_BaseVertex and gl_DrawID"},
    {SpvCapabilityShaderClockKHR, "clocks"},
    {SpvCapabilityRayQueryKHR, "ray queries"},
    {SpvCapabilityVulkanMemoryModel, "the Vulkan memory model"},
    {SpvCapabilityRuntimeDescriptorArray, "arrays of samplers or images without a size"},
};

static const char *name_capability(uint32_t capability) {
    for (size_t i = 0; i < COUNT_OF(refused); i++)
        if (refused[i].capability == capability) return refused[i].words;
    return NULL;
}

// ---- judging ----------------------------------------------------------------------------------

typedef struct gate {
    spirv_module module;
    uint32_t set;     // the id of GLSL.std.450
    uint32_t entries; // entry points
    uint32_t model;   // execution model of the last one
    uint8_t *located; // by id: 1 + its location; 1: it holds built-ins or members with a location
    uint8_t *built;   // by id: the built-in that it is, as 1 + index of the table; 0: none
} gate;

static bool is_size(const gate *g, uint32_t type, uint32_t most) {
    return type < g->module.bound && g->module.ids[type].size <= most;
}

static bool judge_capability(uint32_t capability) {
    if (HAS(capabilities, capability)) return true;
    const char *name = name_capability(capability);
    if (name) return err_set("%s: not accepted in shaders", name);
    return err_set("capability %u of SPIR-V: not accepted in shaders", capability);
}

// Reads a literal string at `w`, of at most `words`. "" when it is not terminated.
static const char *string_at(const uint32_t *w, uint32_t words, char out[MOST_NAME]) {
    size_t size = (size_t)words * sizeof *w;
    if (size > MOST_NAME) size = MOST_NAME;
    memcpy(out, w, size);
    if (!size || !memchr(out, 0, size)) out[0] = '\0';
    for (char *c = out; *c; c++)
        if (*c < ' ' || *c > '~') *c = '?';
    return out;
}

static bool judge_import(gate *g, const uint32_t *w, uint32_t length) {
    char name[MOST_NAME] = "";
    if (length > 2) string_at(w + 2, length - 2, name);
    if (g->set || strcmp(name, "GLSL.std.450") != 0)
        return err_set("instructions of '%s': not accepted in shaders", name);
    g->set = w[1];
    return true;
}

static bool judge_extension(const uint32_t *w, uint32_t length) {
    char name[MOST_NAME] = "";
    return err_set("SPIR-V extension %s: not accepted in shaders",
                   string_at(w + 1, length - 1, name));
}

// Checks a decoration of `id`, or of a member of it. `w` begins at the decoration.
static bool judge_decoration(gate *g, uint32_t id, bool member, const uint32_t *w,
                             uint32_t length) {
    if (w[0] == SpvDecorationSpecId)
        return err_set("constant_id: not accepted in shaders; '//@ option' is");
    if (!HAS(decorations, w[0]))
        return err_set("decoration %u of SPIR-V: not accepted in shaders", w[0]);
    bool place = w[0] == SpvDecorationOffset || w[0] == SpvDecorationArrayStride ||
                 w[0] == SpvDecorationMatrixStride;
    if (place && (length != 2 || w[1] > MOST_OFFSET))
        return err_set("a block is larger than %d MiB", MOST_OFFSET >> 20);
    const built_in *b = length == 2 ? find_built_in(w[1]) : NULL;
    if (w[0] == SpvDecorationBuiltIn && !b)
        return err_set("built-in variable %u of SPIR-V: not accepted in shaders",
                       length == 2 ? w[1] : 0);
    bool location = w[0] == SpvDecorationLocation;
    if (location && (length != 2 || w[1] >= MOST_LOCATIONS))
        return err_set("location %u of SPIR-V: 0 to %d are accepted", length == 2 ? w[1] : 0,
                       MOST_LOCATIONS - 1);
    bool part = w[0] == SpvDecorationComponent || w[0] == SpvDecorationIndex;
    if (part && (length != 2 || w[1] > (w[0] == SpvDecorationComponent ? 3 : 1)))
        return err_set("SPIR-V: a location has no such part");
    if (id >= g->module.bound) return true;
    if (location || (w[0] == SpvDecorationBuiltIn && member))
        g->located[id] = (uint8_t)(location && !member ? 1 + w[1] : 1);
    else if (w[0] == SpvDecorationBuiltIn)
        g->built[id] = (uint8_t)(1 + (b - built_ins));
    return true;
}

static bool judge_entry(gate *g, const uint32_t *w, uint32_t length) {
    char name[MOST_NAME] = "";
    bool model =
        length > 3 && (w[1] == SpvExecutionModelVertex || w[1] == SpvExecutionModelFragment ||
                       w[1] == SpvExecutionModelGLCompute);
    if (model) string_at(w + 3, length - 3, name);
    g->model = length > 1 ? w[1] : 0;
    return (g->entries++ == 0 && strcmp(name, "main") == 0) ||
           err_set("SPIR-V: not one entry point 'main' of a vertex, fragment or compute shader");
}

// A group size given by ids must be given by constants: SPIRV-Cross crashes on other ids, which
// SPIRV-Tools 2023.1 accepts.
static bool judge_mode(const gate *g, const uint32_t *w, uint32_t length) {
    uint32_t mode = length > 2 ? w[2] : UINT32_MAX, size;
    bool by_id = (w[0] & SpvOpCodeMask) == SpvOpExecutionModeId;
    if (!HAS(modes, mode) || by_id != (mode == SpvExecutionModeLocalSizeId))
        return err_set("execution mode %u of SPIR-V: not accepted in shaders", mode);
    for (uint32_t i = 3; by_id && i < 6; i++)
        if (length != 6 || !spirv_constant(&g->module, w[i], &size))
            return err_set("SPIR-V: the size of a group is no constant");
    return true;
}

static uint32_t opcode_of(const gate *g, uint32_t type) { // 0: nothing is defined there
    bool defined = type < g->module.bound && g->module.ids[type].at;
    return defined ? g->module.words[g->module.ids[type].at] & SpvOpCodeMask : 0;
}

// Members of structs and elements of arrays must be numbers, or contain such: no pointers, no
// images.
static bool is_plain(const gate *g, uint32_t type) {
    uint32_t op = opcode_of(g, type);
    return (op >= SpvOpTypeBool && op <= SpvOpTypeMatrix) ||
           (op >= SpvOpTypeArray && op <= SpvOpTypeStruct);
}

static bool judge_pointer(const gate *g, const uint32_t *w, uint32_t length) {
    if (length != 4) return err_set("SPIR-V: a pointer of %u words, not 4", length);
    if (!HAS(storages, w[2]))
        return err_set("storage class %u of SPIR-V: not accepted in shaders", w[2]);
    bool opaque = w[2] == SpvStorageClassUniformConstant || w[2] == SpvStorageClassImage;
    return opaque || is_plain(g, w[3]) || err_set("SPIR-V: a pointer to no number");
}

static bool judge_type(const gate *g, const uint32_t *w, uint32_t length) {
    uint32_t op = w[0] & SpvOpCodeMask, element = length > 2 ? opcode_of(g, w[2]) : 0;
    if (op == SpvOpTypePointer) return judge_pointer(g, w, length);
    // Arrays of images are refused by reflect.c, which knows their names.
    bool images = element == SpvOpTypeImage || element == SpvOpTypeSampledImage;
    bool holds = op == SpvOpTypeArray || op == SpvOpTypeRuntimeArray || op == SpvOpTypeStruct;
    uint32_t last = op == SpvOpTypeStruct ? length : 3;
    for (uint32_t i = 2; holds && i < last; i++)
        if (i >= length || !(is_plain(g, w[i]) || (images && op != SpvOpTypeStruct)))
            return err_set("arrays and structs may hold numbers only");
    return true;
}

static bool fits_built_in(const gate *g, const uint32_t *variable, uint32_t type) {
    const built_in *b = g->built[variable[2]] ? &built_ins[g->built[variable[2]] - 1] : NULL;
    if (!b || b->storage != variable[3]) return false;
    const uint32_t *vector = spirv_find(&g->module, type, SpvOpTypeVector);
    uint32_t components = vector ? vector[3] : 1, scalar = opcode_of(g, vector ? vector[2] : type);
    return b->scalar == scalar && b->components == components;
}

// Drivers store outputs in a table by location, and do not check whether a location lies in it. An
// element of an array takes a location, however small it is.
static bool fits_locations(const gate *g, const uint32_t *variable, uint32_t type) {
    uint32_t at = g->located[variable[2]] ? g->located[variable[2]] - 1u : 0;
    const spirv_id *t = &g->module.ids[type];
    uint32_t taken = t->array ? t->size / 4 : t->size > 16 ? 4 : 1;
    bool target = g->model == SpvExecutionModelFragment && variable[3] == SpvStorageClassOutput;
    uint32_t most = target ? MOST_TARGETS : MOST_LOCATIONS;
    return at < most && taken <= most - at;
}

// The variables of a thread or a group must have a size; expand.c adds up those of threads.
static bool judge_variable(const gate *g, const uint32_t *w, uint32_t length) {
    const uint32_t *pointer = spirv_find(&g->module, w[1], SpvOpTypePointer);
    if (length < 4 || !pointer || pointer[2] != w[3] || pointer[3] >= g->module.bound)
        return err_set("SPIR-V: a variable without a place");
    bool handed = w[3] == SpvStorageClassInput || w[3] == SpvStorageClassOutput;
    bool own = handed || w[3] == SpvStorageClassFunction || w[3] == SpvStorageClassPrivate;
    bool located = g->located[w[2]] || g->located[pointer[3]];
    bool placed = g->model == SpvExecutionModelGLCompute
                      ? fits_built_in(g, w, pointer[3])
                      : located || fits_built_in(g, w, pointer[3]);
    if (handed && !placed) return err_set("SPIR-V: a variable that is handed on has no location");
    if (handed && located && !fits_locations(g, w, pointer[3]))
        return err_set("what is handed on takes more than %d locations", MOST_LOCATIONS);
    return !own || is_size(g, pointer[3], SPIRV_MAX_VARIABLE) ||
           err_set("a variable of more than %d KiB; a thread may have as much in arrays",
                   SPIRV_MAX_VARIABLE >> 10);
}

static bool judge_value(const gate *g, const uint32_t *w, uint32_t length) {
    uint32_t type = w[1], op = w[0] & SpvOpCodeMask;
    if (opcode_of(g, type) == SpvOpTypePointer && !HAS(pointer_makers, op))
        return err_set("SPIR-V: a pointer that is not to a part of a variable");
    uint32_t from = op == SpvOpBitcast && length > 3 && w[3] < g->module.bound ? w[3] : 0;
    if (from && opcode_of(g, g->module.ids[from].type) == SpvOpTypePointer)
        return err_set("SPIR-V: a number made of a pointer");
    return !g->module.ids[type].array || is_size(g, type, SPIRV_MAX_VARIABLE) ||
           err_set("an array of more than %d KiB is copied", SPIRV_MAX_VARIABLE >> 10);
}

static bool gate_judge(gate *g, const uint32_t *w, uint32_t length) {
    uint32_t op = w[0] & SpvOpCodeMask;
    if (!HAS(instructions, op))
        return err_set("instruction %u of SPIR-V: not accepted in shaders", op);
    if (op >= SpvOpTypeVoid && op <= SpvOpTypeFunction) return judge_type(g, w, length);
    uint32_t id = length > 2 ? w[2] : 0;
    bool value = id < g->module.bound && g->module.ids[id].type &&
                 g->module.ids[id].at == (size_t)(w - g->module.words);
    switch (op) {
    case SpvOpCapability:
        return judge_capability(length > 1 ? w[1] : UINT32_MAX);
    case SpvOpExtension:
        return judge_extension(w, length);
    case SpvOpExtInstImport:
        return judge_import(g, w, length);
    case SpvOpExtInst:
        return (length > 4 && g->set && w[3] == g->set && w[4] <= GLSLstd450FindUMsb) ||
               err_set("extended instruction of SPIR-V: not accepted in shaders");
    case SpvOpMemoryModel:
        return (length == 3 && w[1] == SpvAddressingModelLogical &&
                w[2] == SpvMemoryModelGLSL450) ||
               err_set("memory models other than GLSL's: not accepted in shaders");
    case SpvOpEntryPoint:
        return judge_entry(g, w, length);
    case SpvOpExecutionMode:
    case SpvOpExecutionModeId:
        return judge_mode(g, w, length);
    case SpvOpDecorate:
        return length > 2 ? judge_decoration(g, w[1], false, w + 2, length - 2)
                          : err_set("SPIR-V: a decoration is cut off");
    case SpvOpMemberDecorate:
        return length > 3 ? judge_decoration(g, w[1], true, w + 3, length - 3)
                          : err_set("SPIR-V: a decoration is cut off");
    case SpvOpVariable:
        return judge_variable(g, w, length);
    default:
        return !value || judge_value(g, w, length);
    }
}

bool spirv_gate(const spirv *code) {
    gate g = {0};
    bool passed =
        spirv_module_read(&g.module, code->words, code->count) || err_set("SPIR-V: not a module");
    g.located = mem_alloc(g.module.bound * sizeof *g.located);
    g.built = mem_alloc(g.module.bound * sizeof *g.built);
    for (size_t at = SPIRV_HEADER; passed && at < code->count;) {
        uint32_t length = code->words[at] >> SpvWordCountShift;
        passed = gate_judge(&g, code->words + at, length);
        at += length;
    }
    passed = passed && spirv_can_expand(&g.module);
    mem_free(g.located);
    mem_free(g.built);
    spirv_module_free(&g.module);
    return passed;
}
