// Bloom: the bright picture is halved again and again into one image with mip levels, then added
// back up level by level. One shader, compiled for each kind of step.
//
// Level 0 is not written on the way down: the first step halves the picture, the last one adds to
// it. Where the picture comes from a pass `bright`, both do its work as well, and that pass is left
// out unless something else reads it. Mode gaussian stays in one size: a separable
// blur of nine taps, across and down, as often as `passes` says, to and fro between two images. The
// width of the light grows with the square root of that.
#include "base/memory.h"
#include "pass/pass_impl.h"

typedef enum bloom_stage {
    BLOOM_FIRST,
    BLOOM_DOWN,
    BLOOM_TAIL,
    BLOOM_UP,
    BLOOM_LAST,
    BLOOM_BLUR_FIRST, // from here on: of mode gaussian
    BLOOM_BLUR,
    BLOOM_STAGES,
} bloom_stage;

#define BLOOM_NAMES(NAME)                                                                          \
    NAME(mode), NAME(source), NAME(picture), NAME(color), NAME(levels), NAME(passes), NAME(width), \
        NAME(height), NAME(tail_levels), NAME(radius), NAME(alpha), NAME(down), NAME(threshold),   \
        NAME(knee), NAME(limit), NAME(intensity)
KERNEL_NAMES(BLOOM_NAMES);
enum { BLOOM_TAKEN = 4 };

typedef struct bloom_state {
    pass *bright; // whose work is done here; NULL: none
    size_t bright_uniforms[BLOOM_TAKEN];
    graph_image picture; // that is read
    bool same_size;      // as the bloom
    bool gaussian;       // the mode
    graph_image across;  // of mode gaussian: blurred across, not yet down
} bloom_state;

enum { TAIL_ROOM = 4096, TAIL_BYTES = 8 }; // texels in shared memory, of one (bloom/tail.glsl)

static const char *const stage_names[BLOOM_STAGES] = {
    "STAGE_FIRST", "STAGE_DOWN",       "STAGE_TAIL", "STAGE_UP",
    "STAGE_LAST",  "STAGE_BLUR_FIRST", "STAGE_BLUR"};
static const pass_kernel kernels[BLOOM_STAGES]; // all of the type's shader

typedef struct levels { // of the bloom
    gpu_image *chain;
    uint32_t size[2];
    uint32_t last; // the widest that is added
    uint32_t tail; // the finest that BLOOM_TAIL does; `last`: it does none
} levels;

// Texels of all levels that one dispatch does.
static uint32_t tail_room(const pass *p) {
    const uint32_t most = gpu_get_profile(p->host->device)->limits.shared_bytes / TAIL_BYTES;
    return most < TAIL_ROOM ? most : TAIL_ROOM;
}

// ---- declaring --------------------------------------------------------------------------------

static const int taken[BLOOM_TAKEN] = {N_threshold, N_knee, N_limit, N_intensity};

static void find_picture(pass *p) {
    bloom_state *s = p->state;
    s->picture = *pass_image(p, N_source);
    pass *writer = pass_writer(p->host, s->picture);
    bool bright = writer && pass_is(writer, "bright") && writer->scale == p->scale &&
                  writer->formats[pass_image_index(writer, "color")] == GPU_RGBA16F;
    if (bright) {
        s->bright = writer;
        for (size_t i = 0; i < COUNT_OF(taken); i++)
            pass_find_key(writer, names[taken[i]], &s->bright_uniforms[i]);
        s->picture = writer->images[pass_image_index(writer, "source")];
    }
    const graph_image_desc *desc = graph_get_desc(p->host->graph, s->picture);
    s->same_size = desc->scale == p->scale;
}

static graph_image bloom_add_image(pass *p, const char *name, uint32_t mips) {
    return graph_add_image(p->host->graph,
                           &(graph_image_desc){
                               .name = arena_format(p->host->memory, "%s.%s", p->label, name),
                               .format = p->formats[p->names[N_color].image],
                               .scale = p->scale,
                               .mips = mips,
                           });
}

static bool bloom_declare(pass *p) {
    bloom_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    graph_image *source = pass_image(p, N_source), *color = pass_image(p, N_color);
    s->gaussian = pass_option_is(p, N_mode, "gaussian");
    if (source->id) find_picture(p);
    if (s->gaussian && !(s->across = bloom_add_image(p, "across", 1)).id) return false;
    *color = bloom_add_image(p, "color", s->gaussian ? 1 : GRAPH_ALL_MIPS);
    if (!color->id || !pass_declare_images(p)) return false;
    *source = s->picture;
    return pass_add_to_graph_with(p, &s->across, s->gaussian ? 1 : 0);
}

static bool bloom_defines(pass *p, size_t index, pass_defines *out) {
    const bloom_state *s = p->state;
    if ((index >= BLOOM_BLUR_FIRST) != s->gaussian) return false;
    pass_define_flag(out, "FROM_BRIGHT", s->bright);
    pass_define_flag(out, "BRIGHT_PAPER", s->bright && pass_has_word(s->bright, "mode", "paper"));
    pass_define_flag(out, "SAME_SIZE", s->same_size);
    pass_define_number(p, out, "TAIL_ROOM", tail_room(p));
    pass_define(out, "MOST_THREADS", pass_most_threads(p));
    for (size_t i = 0; i < BLOOM_STAGES; i++) pass_define_flag(out, stage_names[i], i == index);
    return true;
}

// ---- in a frame -------------------------------------------------------------------------------

static uint32_t mip_size(uint32_t size, uint32_t mip) {
    return size >> mip ? size >> mip : 1;
}

// Numbers of the pass `bright` whose work is done here, if any is.
static bool bloom_update(pass *p) {
    const bloom_state *s = p->state;
    for (size_t i = 0; s->bright && i < COUNT_OF(taken); i++) {
        float value[4];
        if (!pass_evaluate_at(s->bright, s->bright_uniforms[i], value)) return false;
        pass_set_float(p, taken[i], value[0]);
    }
    return true;
}

// Reads level `from` of the chain, or what `picture` is bound to; writes level `to`.
static bool step(pass *p, bloom_stage stage, const levels *l, uint32_t from, uint32_t to) {
    const bloom_state *s = p->state;
    gpu_image *picture = graph_get_image(p->host->graph, s->picture);
    kernel *k = pass_use(p, stage);
    if (!k) return false;
    kernel_bind(k, N_source,
                (gpu_binding){.image = l->last ? l->chain : picture, .mip = from, .one_mip = true});
    kernel_bind(k, N_picture, (gpu_binding){.image = picture, .one_mip = true});
    kernel_bind(k, N_color, (gpu_binding){.image = l->chain, .mip = to});
    kernel_set_int(k, N_width, (int32_t)mip_size(l->size[0], from));
    kernel_set_int(k, N_height, (int32_t)mip_size(l->size[1], from));
    if (!l->last) { // one texel: nothing is wider
        kernel_set_float(k, N_radius, 0);
        kernel_set_float(k, N_alpha, 0);
    }
    return kernel_run(k, p->host->device, mip_size(l->size[0], to), mip_size(l->size[1], to), 1);
}

static bool run_tail(pass *p, const levels *l) {
    kernel *k = pass_use(p, BLOOM_TAIL);
    if (!k) return false;
    kernel_bind(k, N_color, (gpu_binding){.image = l->chain, .mip = l->tail});
    kernel_set_int(k, N_tail_levels, (int32_t)(l->last - l->tail));
    return kernel_run(k, p->host->device, 1, 1, 1); // one group
}

// The widest level is the one that `levels` says; 0 takes all, as the paper does (section 3.8.2).
static levels find_levels(pass *p) {
    levels l = {.chain = pass_get_image(p, N_color)};
    const gpu_image_desc *desc = gpu_image_get_desc(l.chain);
    uint32_t wanted = (uint32_t)pass_value(p, N_levels);
    l.size[0] = desc->width;
    l.size[1] = desc->height;
    l.last = desc->mips - 1;
    if (wanted && wanted < l.last) l.last = wanted;
    l.tail = l.last < 1 ? l.last : 1;
    // With those below it a level of so many texels has room.
    const uint32_t most = tail_room(p) / 8 * 5;
    while (l.tail < l.last && mip_size(l.size[0], l.tail) * mip_size(l.size[1], l.tail) > most)
        l.tail++;
    return l;
}

static bool blur(pass *p, bloom_stage stage, gpu_image *from, gpu_image *to, bool down) {
    const gpu_image_desc *size = gpu_image_get_desc(to);
    kernel *k = pass_use(p, stage);
    if (!k) return false;
    kernel_bind(k, N_source, (gpu_binding){.image = from, .one_mip = true});
    kernel_bind(k, N_picture, (gpu_binding){.image = from, .one_mip = true});
    kernel_bind_image(k, N_color, to);
    kernel_set_int(k, N_down, down);
    return kernel_run(k, p->host->device, size->width, size->height, 1);
}

static bool bloom_record_gaussian(pass *p) {
    const bloom_state *s = p->state;
    gpu_image *across = graph_get_image(p->host->graph, s->across);
    gpu_image *color = pass_get_image(p, N_color);
    int passes = (int)pass_value(p, N_passes);
    for (int i = 0; i < passes; i++) {
        gpu_image *from = i == 0 ? graph_get_image(p->host->graph, s->picture) : color;
        if (!blur(p, i == 0 ? BLOOM_BLUR_FIRST : BLOOM_BLUR, from, across, false) ||
            !blur(p, BLOOM_BLUR, across, color, true))
            return false;
    }
    return true;
}

static bool bloom_record(pass *p) {
    const bloom_state *s = p->state;
    if (!pass_prepare(p)) return false;
    if (s->gaussian) return bloom_record_gaussian(p);
    levels l = find_levels(p);
    for (uint32_t mip = 0; mip < l.tail; mip++)
        if (!step(p, mip ? BLOOM_DOWN : BLOOM_FIRST, &l, mip, mip + 1)) return false;
    if (l.tail < l.last && !run_tail(p, &l)) return false;
    for (uint32_t mip = l.tail; mip > 1; mip--)
        if (!step(p, BLOOM_UP, &l, mip, mip - 1)) return false;
    return step(p, BLOOM_LAST, &l, l.last ? 1 : 0, 0);
}

const pass_type bloom_type = {
    .name = "bloom",
    .shader = "pass/picture/bloom.comp",
    PASS_KERNELS,
    .declare = bloom_declare,
    .defines = bloom_defines,
    .update = bloom_update,
    .record = bloom_record,
};
