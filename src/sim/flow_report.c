// Two dispatches per frame, and a copy of their result to one of as many places as frames can be in
// flight (as in lbm_guard.c).
#include "sim/flow_impl.h"
#include <string.h>

enum { WORDS = 9 };

bool flow_report_allocate(flow *f, gpu *g) {
    flow_reporter *r = &f->reporter;
    if (r->result) return true;
    r->found = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "flow's report",
                                                       .size = FLOW_REPORT_PLACES * WORDS * 4,
                                                       .kind = GPU_BUFFER_READBACK});
    r->result = gpu_image_create(g, &(gpu_image_desc){.label = "flow's report",
                                                      .format = GPU_R32U,
                                                      .width = WORDS,
                                                      .height = 1,
                                                      .use = GPU_USE_STORAGE});
    return r->found && r->result;
}

void flow_report_destroy(flow *f, gpu *g) {
    gpu_buffer_destroy(g, f->reporter.found);
    gpu_image_destroy(g, f->reporter.result);
    f->reporter = (flow_reporter){0};
}

bool flow_watch(flow *f, gpu *g) {
    flow_reporter *r = &f->reporter;
    const uint32_t place = r->next;
    if (f->steps == 0) return true;
    kernel *each = flow_use(f, FLOW_REPORT), *last = flow_use(f, FLOW_REPORT_LAST);
    kernel_bind_image(last, N_result, r->result);
    kernel_set_int(last, N_iterations, (int32_t)f->desc.max_iterations);
    if (!flow_run_tiles(f, g, each, f->desc.size) || !kernel_run(last, g, f->group, 1, 1) ||
        !gpu_image_copy_to_buffer(g, r->result, r->found, place * WORDS * 4))
        return false;
    r->places[place] = (flow_place){gpu_frame_open(g), f->steps};
    r->next = (place + 1) % FLOW_REPORT_PLACES;
    return true;
}

bool flow_read(const flow *f, gpu *g, flow_report *out) {
    const flow_reporter *r = &f->reporter;
    for (uint32_t age = 1; age <= FLOW_REPORT_PLACES; age++) {
        const uint32_t place = (r->next + FLOW_REPORT_PLACES - age) % FLOW_REPORT_PLACES;
        const flow_place *at = &r->places[place];
        if (at->frame == 0 || !gpu_frame_done(g, at->frame)) continue;
        float words[WORDS];
        memcpy(words, (const char *)gpu_buffer_map(r->found) + place * sizeof words, sizeof words);
        *out = (flow_report){.step = at->step,
                             .iterations = (uint32_t)words[0],
                             .residual = words[1],
                             .speed = words[2]};
        memcpy(out->sum, words + 3, sizeof out->sum);
        memcpy(out->most, words + 6, sizeof out->most);
        return true;
    }
    return false;
}
