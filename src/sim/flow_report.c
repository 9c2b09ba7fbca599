// Two dispatches per frame, whose result is read when the frame is done.
#include "sim/flow_impl.h"
#include <string.h>

bool flow_watch(flow *f, gpu *g) {
    if (f->steps == 0) return true;
    kernel *each = flow_use(f, FLOW_REPORT), *last = flow_use(f, FLOW_REPORT_LAST);
    kernel_bind_image(last, N_result, f->report.image);
    kernel_set_int(last, N_iterations, (int32_t)f->desc.max_iterations);
    return flow_run_tiles(f, g, each, f->desc.size) && kernel_run(last, g, f->group, 1, 1) &&
           kernel_readback_send(&f->report, g, f->steps);
}

bool flow_read(const flow *f, gpu *g, flow_report *out) {
    float words[FLOW_REPORT_WORDS];
    uint64_t step;
    const void *found = kernel_readback_newest(&f->report, g, &step);
    if (!found) return false;
    memcpy(words, found, sizeof words);
    *out = (flow_report){
        .step = step, .iterations = (uint32_t)words[0], .residual = words[1], .speed = words[2]};
    memcpy(out->sum, words + 3, sizeof out->sum);
    memcpy(out->most, words + 6, sizeof out->most);
    return true;
}
