// Solids in burning gas: cells are solid or gas, and faces between them are closed.
#include "sim/pyro_impl.h"

void pyro_set_solids(pyro *p, const pyro_solids *solids) {
    p->solids = *solids;
    if (solids->changed) p->coefficients_known = false;
}

bool pyro_obstruct(pyro *p, gpu *g, const pyro_numbers *n) {
    if (!p->desc.solids) return true;
    kernel *k = pyro_use(p, PYRO_K_OBSTRUCT);
    kernel_set_float(k, N_cell, pyro_flow_cell(p, n));
    kernel_set(k, N_box_min, p->solids.corner, sizeof p->solids.corner);
    kernel_bind_buffer(k, N_SolidIds, p->solids.ids);
    kernel_bind_buffer(k, N_SolidMotions, p->solids.motions);
    kernel *fill = pyro_use(p, PYRO_K_FILL);
    kernel_bind_buffer(fill, N_SolidIds, p->solids.ids);
    return pyro_run(p, g, k) && pyro_run_gas(p, g, fill);
}
