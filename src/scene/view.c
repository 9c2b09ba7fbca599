// A host's matrices as the block "Frame" has them. Both ways of y and of depth are understood: up
// in the camera's space is up in the picture, and depths are turned into metres by the projection.
#include "scene/view.h"
#include "base/error.h"
#include "base/maths.h"
#include <math.h>
#include <string.h>

static const float farthest = 1e9f; // m

static bool is_finite(const float *m, int count) {
    bool all = true;
    for (int i = 0; i < count; i++) all = all && isfinite(m[i]);
    return all;
}

static bool is_perspective(const float *p) {
    return p[3] == 0 && p[7] == 0 && p[15] == 0 && fabsf(p[11]) > 1e-12f && p[0] > 0 &&
           fabsf(p[5]) > 0 && p[1] == 0 && p[4] == 0;
}

bool scene_view_lens(const scene_view *v, scene_lens *out) {
    const float *p = v->projection;
    if (!is_finite(v->view, 16) || !is_finite(p, 16) || !is_finite(v->jitter, 2))
        return err_set("the host's view: a matrix or the jitter has a number that is not finite");
    if (!is_perspective(p))
        return err_set(
            "the host's projection is no perspective; accepted: one whose w is the depth "
            "in the camera's space alone, with x to the right");
    mat4 view;
    memcpy(view, v->view, sizeof view);
    if (!(fabsf(glm_mat4_det(view)) > 1e-20f)) return err_set("the host's view has no inverse");
    const float scale = 1 / fabsf(p[11]), z = p[11] < 0 ? 1 : -1; // of p[11]: w is -z, or z
    const float x = p[8] * z * scale, y = p[9] * z * scale, a = p[10] * z * scale,
                b = p[14] * scale;
    out->z = z;
    out->across[0] = 1 / (p[0] * scale);
    out->across[1] = 1 / (fabsf(p[5]) * scale);
    out->shift[0] = -x;
    out->shift[1] = p[5] < 0 ? y : -y;
    out->depths[0] = a;
    out->depths[1] = b;
    const float ends[2] = {b / a, b / (1 + a)}; // metres at depths 0 and 1
    const float first = ends[0] > 0 ? fminf(ends[0], farthest) : farthest;
    const float second = ends[1] > 0 ? fminf(ends[1], farthest) : farthest;
    out->near = fmaxf(fminf(first, second), 1e-4f);
    out->far = fmaxf(fmaxf(first, second), 2 * out->near);
    return b != 0 || err_set("the host's projection gives every point one depth");
}

// As a camera of roil projects: y down, depth from 0 to 1, for what it draws and looks back by.
static void fill_projection(const scene_lens *l, mat4 out) {
    glm_mat4_zero(out);
    out[0][0] = 1 / l->across[0];
    out[1][1] = -1 / l->across[1];
    out[2][0] = -l->shift[0];
    out[2][1] = l->shift[1];
    out[2][2] = l->far / (l->near - l->far);
    out[2][3] = -1;
    out[3][2] = l->near * l->far / (l->near - l->far);
}

void scene_view_fill(const scene_view *v, const uint32_t size[2], struct frame_block *out) {
    scene_lens l;
    mat4 view, inverse, projection, last;
    if (!scene_view_lens(v, &l)) return;
    memcpy(view, v->view, sizeof view);
    for (int i = 0; i < 4; i++) view[i][2] *= l.z;
    glm_mat4_inv_precise(view, inverse);
    l.shift[0] += 2 * v->jitter[0] / (float)size[0];
    l.shift[1] -= 2 * v->jitter[1] / (float)size[1];
    fill_projection(&l, projection);
    glm_mat4_mul(projection, view, last);
    memcpy(out->last.m, last, sizeof last);
    memcpy(out->view.m, view, sizeof view);
    memcpy(out->projection.m, projection, sizeof projection);
    memcpy(out->view_inverse.m, inverse, sizeof inverse);
    out->eye = (shared_vec4){{inverse[3][0], inverse[3][1], inverse[3][2], 0}};
    out->lens = (shared_vec4){{l.across[0], l.across[1], l.near, l.far}};
    out->shift = (shared_vec4){
        {l.shift[0], l.shift[1], v->jitter[0] / (float)size[0], v->jitter[1] / (float)size[1]}};
}
