// Bloom: the bright picture is halved again and again into one image with mip
// levels, then added back up level by level. One shader, compiled for each kind
// of step.
//
// Level 0 is not written on the way down: the first step halves the picture,
// the last one adds to it. Where the picture comes from a pass `bright`, both
// do its work as well, and that pass is left out unless something else reads
// it. Mode gaussian stays in one size (bloom_gaussian.c).
#include "base/memory.h"
#include "pass/bloom_parts.h"
#include "pass/builtin.h"
#include <string.h>

// Levels of so few texels are done in one dispatch; with those below they fit
// into its shared memory (bloom/tail.glsl).
enum { TAIL_TEXELS = 2560 };

static const char *const stage_names[BLOOM_STAGES] = {
    "STAGE_FIRST", "STAGE_DOWN",       "STAGE_TAIL", "STAGE_UP",
    "STAGE_LAST",  "STAGE_BLUR_FIRST", "STAGE_BLUR"};

typedef struct levels { // of the bloom
    gpu_image *chain;
    uint32_t size[2];
    uint32_t last; // the widest that is added
    uint32_t tail; // the finest that BLOOM_TAIL does; `last`: it does none
} levels;

// ---- declaring
// --------------------------------------------------------------------------------

static void find_picture(pass *p) {
    bloom_state *s = p->state;
    s->picture = p->images[pass_find_image(p, "source")];
    pass *writer = pass_writer(p->host, s->picture);
    bool bright = writer && writer->type && strcmp(writer->type->name, "bright") == 0 &&
                  writer->scale == p->scale &&
                  writer->formats[pass_find_image(writer, "color")] == GPU_RGBA16F;
    if (bright) {
        s->bright = writer;
        s->picture = writer->images[pass_find_image(writer, "source")];
    }
    const graph_image_desc *desc = graph_get_desc(p->host->graph, s->picture);
    s->same_size = desc->scale == p->scale;
}

graph_image bloom_add_image(pass *p, const char *name, uint32_t mips) {
    return graph_add_image(p->host->graph,
                           &(graph_image_desc){
                               .name = arena_format(p->host->memory, "%s.%s", p->label, name),
                               .format = p->formats[pass_find_image(p, "color")],
                               .scale = p->scale,
                               .mips = mips,
                           });
}

bool bloom_declare(pass *p) {
    bloom_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    int output = pass_find_image(p, "color"), source = pass_find_image(p, "source");
    bool gaussian = pass_has_word(p, "mode", "gaussian");
    s->begin = gaussian ? BLOOM_BLUR_FIRST : BLOOM_FIRST;
    s->end = gaussian ? BLOOM_STAGES : BLOOM_BLUR_FIRST;
    if (p->images[source].id) find_picture(p);
    if (gaussian && !(s->across = bloom_add_image(p, "across", 1)).id) return false;
    p->images[output] = bloom_add_image(p, "color", gaussian ? 1 : GRAPH_ALL_MIPS);
    if (!p->images[output].id || !pass_declare_images(p)) return false;
    p->images[source] = s->picture;
    return pass_add_to_graph_with(p, &s->across, gaussian ? 1 : 0);
}

// ---- building
// ---------------------------------------------------------------------------------

static const char *word(bool is) {
    return is ? "1" : "0";
}

static bool compile(pass *p) {
    bloom_state *s = p->state;
    for (int i = s->begin; i < (int)s->end; i++) {
        shader_define defines[BLOOM_STAGES + 4] = {
            {"FROM_BRIGHT", word(s->bright)},
            {"BRIGHT_PAPER", word(s->bright && pass_has_word(s->bright, "mode", "paper"))},
            {"SAME_SIZE", word(s->same_size)},
            {"MOST_THREADS", pass_most_threads(p)}};
        for (int k = 0; k < BLOOM_STAGES; k++)
            defines[4 + k] = (shader_define){stage_names[k], word(i == k)};
        if (!pass_compile(p, p->shader, SHADER_COMPUTE, defines, COUNT_OF(defines), &s->binary[i]))
            return false;
    }
    p->binary = s->binary[s->begin];
    return true;
}

bool bloom_check(pass *p) {
    return compile(p);
}

bool bloom_build(pass *p) {
    bloom_state *s = p->state;
    if (!compile(p)) return false;
    for (int i = s->begin; i < (int)s->end; i++) {
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        if (!s->pipeline[i]) return false;
        s->block[i] = arena_alloc(p->host->memory, pass_block_size(&s->binary[i]) + 16);
    }
    return true;
}

// ---- in a frame
// -------------------------------------------------------------------------------

static uint32_t mip_size(uint32_t size, uint32_t mip) {
    return size >> mip ? size >> mip : 1;
}

void bloom_write_int(pass *p, bloom_stage stage, const char *name, uint32_t value) {
    bloom_state *s = p->state;
    pass_write_member(&s->binary[stage], s->block[stage], name, &value, sizeof value);
}

static bool fill_blocks(pass *p) {
    static const char *const names[] = {"threshold", "knee", "limit", "intensity"};
    bloom_state *s = p->state;
    for (int i = s->begin; i < (int)s->end; i++) {
        if (!pass_fill_block(p, &s->binary[i], s->block[i])) return false;
        for (size_t k = 0; s->bright && k < COUNT_OF(names); k++) {
            float value = pass_evaluate(s->bright, names[k]);
            pass_write_member(&s->binary[i], s->block[i], names[k], &value, sizeof value);
        }
    }
    return true;
}

// Reads level `from` of the chain, or what `picture` is bound to; writes level
// `to`.
static bool step(pass *p, bloom_stage stage, const levels *l, uint32_t from, uint32_t to) {
    bloom_state *s = p->state;
    gpu_image *picture = graph_get_image(p->host->graph, s->picture);
    const pass_override overrides[] = {
        {"source",
         {.image = l->last ? l->chain : picture,
          .mip = from,
          .one_mip = true,
          .sampler = GPU_LINEAR_CLAMP}},
        {"picture", {.image = picture, .one_mip = true, .sampler = GPU_LINEAR_CLAMP}},
        {"color", {.image = l->chain, .mip = to}},
    };
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = s->pipeline[stage], .bindings = bindings};
    for (int i = 0; i < 2; i++) desc.threads[i] = mip_size(l->size[i], to);
    return pass_bind(p, &s->binary[stage], s->block[stage], overrides, COUNT_OF(overrides),
                     bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

static bool halve(pass *p, const levels *l, uint32_t from) {
    bloom_stage stage = from ? BLOOM_DOWN : BLOOM_FIRST;
    bloom_write_int(p, stage, "width", mip_size(l->size[0], from));
    bloom_write_int(p, stage, "height", mip_size(l->size[1], from));
    return step(p, stage, l, from, from + 1);
}

static bool run_tail(pass *p, const levels *l) {
    const bloom_state *s = p->state;
    bloom_write_int(p, BLOOM_TAIL, "tail_levels", l->last - l->tail);
    gpu_binding bindings[GPU_MAX_SLOTS];
    const pass_override color = {"color", {.image = l->chain, .mip = l->tail}};
    gpu_dispatch_desc desc = {.pipeline = s->pipeline[BLOOM_TAIL], .bindings = bindings};
    return pass_bind(p, &s->binary[BLOOM_TAIL], s->block[BLOOM_TAIL], &color, 1, bindings,
                     &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

// The widest level is the one that `levels` says; 0 takes all, as the paper
// does (section 3.8.2).
static levels find_levels(pass *p) {
    levels l = {.chain = graph_get_image(p->host->graph, p->images[pass_find_image(p, "color")])};
    const gpu_image_desc *desc = gpu_image_get_desc(l.chain);
    uint32_t wanted = (uint32_t)pass_evaluate(p, "levels");
    l.size[0] = desc->width;
    l.size[1] = desc->height;
    l.last = desc->mips - 1;
    if (wanted && wanted < l.last) l.last = wanted;
    l.tail = l.last < 1 ? l.last : 1;
    while (l.tail < l.last &&
           mip_size(l.size[0], l.tail) * mip_size(l.size[1], l.tail) > TAIL_TEXELS)
        l.tail++;
    return l;
}

bool bloom_record(pass *p) {
    const bloom_state *s = p->state;
    if (!pass_prepare(p) || !fill_blocks(p)) return false;
    if (s->begin == BLOOM_BLUR_FIRST) return bloom_record_gaussian(p);
    levels l = find_levels(p);
    if (!l.last) { // one texel: nothing is wider
        bloom_write_int(p, BLOOM_LAST, "radius", 0);
        bloom_write_int(p, BLOOM_LAST, "alpha", 0);
    }
    for (uint32_t mip = 0; mip < l.tail; mip++)
        if (!halve(p, &l, mip)) return false;
    if (l.tail < l.last && !run_tail(p, &l)) return false;
    for (uint32_t mip = l.tail; mip > 1; mip--)
        if (!step(p, BLOOM_UP, &l, mip, mip - 1)) return false;
    return step(p, BLOOM_LAST, &l, l.last ? 1 : 0, 0);
}

void bloom_destroy(pass *p) {
    bloom_state *s = p->state;
    for (int i = 0; s && i < BLOOM_STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
}
