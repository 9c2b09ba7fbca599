// The host's depth buffer: whoever draws the frame says where it is (pass_host).
#include "base/memory.h"
#include "pass/pass_impl.h"

enum { N_given, N_depths, N_there, N_depth };
static const char *const names[] = {"given", "depths", "there", "depth"};
static const pass_kernel kernels[1];

static bool host_depth_record(pass *p) {
    gpu_image *given = p->host->given_depth;
    uint32_t size[3];
    if (!pass_prepare(p)) return false;
    pass_set(p, N_depths, p->host->given_depths, sizeof p->host->given_depths);
    pass_set_int(p, N_there, given != NULL);
    kernel *k = pass_use(p, 0);
    if (!k) return false;
    if (given) kernel_bind(k, N_given, (gpu_binding){.image = given, .sampler = GPU_NEAREST_CLAMP});
    graph_get_size(p->host->graph, *pass_image(p, N_depth), size);
    return kernel_run(k, p->host->device, size[0], size[1], 1);
}

const pass_type host_depth_type = {
    .name = "host_depth",
    .constructed = true,
    .shader = "pass/host/host_depth.comp",
    PASS_KERNELS,
    .record = host_depth_record,
};
