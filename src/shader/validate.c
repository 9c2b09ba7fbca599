// Validates SPIR-V with SPIRV-Tools. A driver does not do this: what glslang makes of unusual
// texts, or of instructions that a shader gives by number (GL_EXT_spirv_intrinsics), can crash it.
#include "shader/unit.h"
#include <spirv-tools/libspirv.h>

bool spirv_validate(const spirv *code) {
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
    spv_validator_options options = spvValidatorOptionsCreate();
    spv_diagnostic why = NULL;
    spv_const_binary_t binary = {.code = code->words, .wordCount = code->count};
    spvValidatorOptionsSetScalarBlockLayout(options, true); // as the device is opened
    bool valid = spvValidateWithOptions(context, options, &binary, &why) == SPV_SUCCESS;
    if (!valid)
        err_set("the compiler made code that is not valid: %.300s",
                why && why->error ? why->error : "");
    spvDiagnosticDestroy(why);
    spvValidatorOptionsDestroy(options);
    spvContextDestroy(context);
    return valid;
}
