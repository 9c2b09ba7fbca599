// Lamps: their fields, evaluated once for each and frame into an image.
#include "pass/lamps.h"
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"

enum { TEXELS = 4 }; // of a light_entry

typedef struct lamps_state {
    uint32_t count;
} lamps_state;

static lamps_state *state_of(const pass *p) {
    return p->state;
}

bool pass_lamps_open(pass *p, uint32_t count) {
    if (count < 1 || count > PASS_LAMPS_MOST)
        return err_set("%s: 'count' is %u; 1 to %d are accepted", p->label, count, PASS_LAMPS_MOST);
    lamps_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->count = count;
    return true;
}

bool lamps_declare(pass *p) {
    int output = pass_find_image(p, "lamps");
    p->images[output] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.lamps", p->label),
                            .format = p->formats[output],
                            .width = TEXELS,
                            .height = state_of(p)->count,
                        });
    return p->images[output].id && pass_declare_images(p) && pass_add_to_graph(p);
}

bool lamps_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    pass_write_member(binary, block, "lamp_total", &state_of(p)->count, sizeof(uint32_t));
    return true;
}

bool lamps_record(pass *p) {
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = p->pipeline, .bindings = bindings, .threads = {state_of(p)->count, 1, 1}};
    return pass_prepare(p) &&
           pass_bind(p, &p->binary, p->block, NULL, 0, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}
