// Solves for the pressure without iterations. Along x the solutions are sums of modes, which are
// known and independent, so that one equation along y is left for each (Hockney, "A fast direct
// solution of Poisson's equation using Fourier analysis", 1965). The modes depend on the faces:
// cosines between closed ones, sines between open ones, quarter waves between the two.
//
// Sums of modes are products of matrices here, not fast transforms. This works for any faces and
// any number of cells, and takes microseconds for up to 1024 cells. Obstacles and templates are not
// represented in the modes: with those this is a preconditioner, and multigrid a better one.
#include "base/memory.h"
#include "sim/flow_impl.h"
#include <math.h>

static const double pi = 3.14159265358979323846;

// With two faces of the same kind, modes are symmetric or antisymmetric: half of each row is
// enough, and half of the products.
bool flow_transform_folds(const flow_desc *desc, uint32_t tile) {
    return desc->faces[0] == desc->faces[1] && desc->size[0] % (2 * tile) == 0;
}

// Returns mode k of n cells at cell i, not normalised, and how many waves it has in 2 n cells.
// Modes of even k are the symmetric ones, if any are.
static double mode_of(const flow_desc *desc, uint32_t k, double i, double *waves) {
    const double n = desc->size[0], middle = pi * (i + 0.5) / n;
    const bool open[2] = {desc->faces[0] == FLOW_OPEN, desc->faces[1] == FLOW_OPEN};
    if (desc->faces[0] == FLOW_PERIODIC) {
        *waves = 2.0 * ((k + 1) / 2);
        return k % 2 ? sin(*waves * middle) : cos(*waves * middle);
    }
    *waves = open[0] != open[1] ? k + 0.5 : open[0] ? k + 1.0 : (double)k;
    return open[0] ? sin(*waves * middle) : cos(*waves * middle);
}

// size[0] modes of size[0] cells, each of length 1, and by what the equation multiplies each.
static void flow_transform_modes(const flow_desc *desc, bool folds, float *out) {
    const uint32_t n = desc->size[0];
    for (uint32_t k = 0; k < n; k++) {
        double waves = 0, square = 0;
        const uint32_t place = folds ? k % 2 * (n / 2) + k / 2 : k;
        float *mode = out + (size_t)place * n;
        for (uint32_t i = 0; i < n; i++) {
            const double value = mode_of(desc, k, i, &waves);
            mode[i] = (float)value;
            square += value * value;
        }
        for (uint32_t i = 0; i < n; i++) mode[i] /= (float)sqrt(square);
        out[(size_t)n * n + place] = (float)(2 - 2 * cos(waves * pi / n));
    }
}

uint64_t flow_transform_bytes(const flow *f) {
    const uint64_t n = f->desc.size[0];
    return n * (n + 1) * sizeof(float);
}

bool flow_transform_allocate(flow *f, gpu *g) {
    const uint64_t size = flow_transform_bytes(f);
    if (f->desc.solver != FLOW_TRANSFORM || f->modes) return true;
    float *modes = mem_alloc(size);
    flow_transform_modes(&f->desc, flow_transform_folds(&f->desc, f->tile), modes);
    bool done = gpu_buffer_make(g, &f->modes, "modes of a flow", size) &&
                gpu_buffer_write(g, f->modes, 0, modes, size);
    mem_free(modes);
    return done;
}

static kernel *transform_use(flow *f, flow_kernel which, gpu_buffer *residual) {
    kernel *k = flow_use(f, which);
    kernel_bind_buffer(k, N_FlowModes, f->modes);
    kernel_bind_buffer(k, N_FlowResidual, residual);
    kernel_bind_buffer(k, N_FlowLines, f->buffers[FLOW_MEM_LINES]);
    return k;
}

bool flow_transform(flow *f, gpu *g, gpu_buffer *residual) {
    const uint32_t *size = f->desc.size;
    const bool folds = flow_transform_folds(&f->desc, f->tile);
    const uint32_t back[2] = {folds ? size[0] / 2 : size[0], size[1]}; // a group does both ends
    return flow_run_tiles(f, g, transform_use(f, FLOW_TO_MODES, residual), size) &&
           kernel_run(transform_use(f, FLOW_SOLVE_LINES, residual), g, size[0] * f->group,
                      f->desc.slices, 1) &&
           flow_run_tiles(f, g, transform_use(f, FLOW_FROM_MODES, residual), back);
}
