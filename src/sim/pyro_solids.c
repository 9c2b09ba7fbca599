// Solids in burning gas: cells are solid or gas, and faces between them are closed.
#include "base/error.h"
#include "sim/pyro_impl.h"

static bool openings_find(pyro *p, gpu *g) {
    kernel *k = pyro_use(p, PYRO_K_SOLIDS);
    kernel_bind_buffer(k, N_SolidIds, p->solids.ids);
    if (!pyro_run(p, g, k)) return false;
    for (uint32_t level = 0; level + 1 < p->level_count; level++) {
        const uint32_t *size = p->levels[level + 1].size;
        k = pyro_use(p, level == 0 ? PYRO_K_SOLIDS_FINEST : PYRO_K_SOLIDS_COARSE);
        pyro_set_level(p, k, level);
        if (level > 0) kernel_bind_buffer(k, N_PyroOpenings, p->buffers[PYRO_MEM_COARSE_OPENINGS]);
        if (!kernel_run(k, g, size[0], size[1], size[2])) return false;
    }
    p->solids_known = true;
    return true;
}

bool pyro_set_solids(pyro *p, gpu *g, const pyro_solids *solids) {
    p->solids = *solids;
    return (p->solids_known && !solids->changed) || openings_find(p, g);
}

bool pyro_obstruct(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!p->desc.solids) return true;
    if (!p->solids.ids) return err_set("solids are wanted, and none were given");
    kernel *k = pyro_use(p, PYRO_K_OBSTRUCT);
    kernel_set_float(k, N_cell, pyro_flow_cell(p, n));
    kernel_set(k, N_box_min, p->solids.corner, sizeof p->solids.corner);
    kernel_bind_buffer(k, N_SolidIds, p->solids.ids);
    kernel_bind_buffer(k, N_SolidMotions, p->solids.motions);
    kernel *fill = pyro_use(p, PYRO_K_FILL);
    kernel_bind_buffer(fill, N_SolidIds, p->solids.ids);
    return pyro_run(p, g, k) && pyro_run_gas(p, g, fill);
}
