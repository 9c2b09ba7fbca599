// Building the pass type `slices`: its shader, its solver's, and those of the parts that it runs.
#include "base/error.h"
#include "base/memory.h"
#include "pass/slices/slices_templates_parts.h"

static bool each_part(const slices_flow *f, bool (*call)(pass *part)) {
    for (size_t i = 0; i < f->part_count; i++)
        if (!call(f->parts[i])) return false;
    return true;
}

bool slices_build(pass *p) {
    slices_flow *f = slices_of(p);
    const pass_host *host = p->host;
    if (!flow_build(f->solver, host->device, host->library, host->reader))
        return err_prefix("%s: ", p->label);
    return pass_build_kernels(p) && each_part(f, pass_build_part);
}

bool slices_allocate(pass *p) {
    slices_flow *f = slices_of(p);
    return (flow_allocate(f->solver, p->host->device) || err_prefix("%s: ", p->label)) &&
           (!f->templates || slices_templates_allocate(f));
}

void slices_list_memory(const pass *p, budget_list *out) {
    const slices_flow *f = slices_of(p);
    flow_list_memory(f->solver, out);
    if (f->templates) slices_templates_list_memory(f, out);
}

void slices_destroy(pass *p) {
    slices_flow *f = slices_of(p);
    if (!f) return;
    if (f->templates) slices_templates_destroy(f);
    if (f->solver) flow_destroy(f->solver, p->host->device);
    mem_free(f->parts);
}
