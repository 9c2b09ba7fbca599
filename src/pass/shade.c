// Shade: one shader, compiled with and without the loops over many rays. Which of them a frame
// needs its numbers say; a software device computes what it skips, so that loops for nothing cost
// it three times the rest.
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"

typedef struct shade_state {
    shader_binary binary[2]; // with few and with many rays
    gpu_pipeline *pipeline[2];
} shade_state;

static const shader_define variants[2] = {{"MANY_RAYS", "0"}, {"MANY_RAYS", "1"}};

static bool compile_both(pass *p, shader_binary out[2]) {
    return pass_compile(p, p->shader, SHADER_COMPUTE, &variants[0], 1, &out[0]) &&
           pass_compile(p, p->shader, SHADER_COMPUTE, &variants[1], 1, &out[1]);
}

bool shade_check(pass *p) {
    shader_binary binary[2];
    return compile_both(p, binary);
}

// The variant of this frame. The other one becomes a pipeline only when a number first asks for it.
static bool choose(pass *p) {
    shade_state *s = p->state;
    int many = pass_evaluate(p, "shadow_samples") > 1 || pass_evaluate(p, "sky_samples") > 0;
    if (!s->pipeline[many]) s->pipeline[many] = pass_create_compute(p, &s->binary[many]);
    p->binary = s->binary[many];
    p->pipeline = s->pipeline[many];
    return p->pipeline != NULL;
}

bool shade_build(pass *p) {
    shade_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    return compile_both(p, s->binary) && choose(p);
}

bool shade_record(pass *p) {
    return choose(p) && pass_record(p);
}

void shade_destroy(pass *p) {
    shade_state *s = p->state;
    for (int i = 0; s && i < 2; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
    p->pipeline = NULL; // one of these
}
