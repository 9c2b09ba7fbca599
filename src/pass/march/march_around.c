#include "pass/march/march_around.h"
#include "base/maths.h"
#include <math.h>

enum { GROUP_SIDE = 16 };

static const float worth = 0.8f; // of a picture: where more of it is inside, all is

// ---- in a frame -------------------------------------------------------------------------------

// Where a point lies in the picture, 0..1, y down; false for one that is not in front of the
// camera.
static bool project(const struct frame_block *f, const float at[3], float out[2]) {
    float eye[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = f->view.m[12 + i];
        for (int k = 0; k < 3; k++) eye[i] += f->view.m[4 * k + i] * at[k];
    }
    if (!(eye[2] < -f->lens.v[2])) return false;
    out[0] = 0.5f - 0.5f * (eye[0] / (eye[2] * f->lens.v[0]) - f->shift.v[0]);
    out[1] = 0.5f + 0.5f * (eye[1] / (eye[2] * f->lens.v[1]) - f->shift.v[1]);
    return true;
}

// Whole groups, and a pixel more than the box's corners span; false: the camera is too near.
static bool find_inside(const struct frame_block *f, box3 box, const uint32_t size[3],
                        march_part *out) {
    float low[2] = {1, 1}, high[2] = {0, 0};
    for (int i = 0; i < 8; i++) {
        const float corner[3] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                 i & 4 ? box.max.z : box.min.z};
        float at[2];
        if (!project(f, corner, at)) return false;
        for (int k = 0; k < 2; k++) {
            low[k] = fminf(low[k], clampf(at[k], 0, 1));
            high[k] = fmaxf(high[k], clampf(at[k], 0, 1));
        }
    }
    for (int k = 0; k < 2; k++) {
        int32_t first = (int32_t)(low[k] * (float)size[k]) - 1;
        int32_t end = (int32_t)(high[k] * (float)size[k]) + 2;
        out->low[k] = first > 0 ? first / GROUP_SIDE * GROUP_SIDE : 0;
        out->high[k] = (end + GROUP_SIDE - 1) / GROUP_SIDE * GROUP_SIDE;
        if (out->high[k] > (int32_t)size[k]) out->high[k] = (int32_t)size[k];
    }
    return true;
}

void march_set_corner(kernel *k, march_part part) {
    const float corner[2] = {(float)part.low[0], (float)part.low[1]};
    kernel_set(k, N_corner, corner, sizeof corner);
}

static bool fill(pass *p, march_part part) {
    const int32_t width = part.high[0] - part.low[0], height = part.high[1] - part.low[1];
    if (width <= 0 || height <= 0) return true;
    kernel *k = pass_use(p, MARCH_AROUND);
    if (!k) return false;
    march_set_corner(k, part);
    return kernel_run(k, p->host->device, (uint32_t)width, (uint32_t)height, 1);
}

bool march_around_record(pass *p, box3 box, march_part *inside) {
    uint32_t size[3];
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    const int32_t width = (int32_t)size[0], height = (int32_t)size[1];
    march_part in;
    if (box3_is_empty(box) || !find_inside(p->host->frame, box, size, &in)) return true;
    float pixels = (float)(in.high[0] - in.low[0]) * (float)(in.high[1] - in.low[1]);
    if (pixels > worth * (float)width * (float)height) return true;
    *inside = in;
    return fill(p, (march_part){{0, 0}, {width, in.low[1]}}) &&
           fill(p, (march_part){{0, in.low[1]}, {in.low[0], in.high[1]}}) &&
           fill(p, (march_part){{in.high[0], in.low[1]}, {width, in.high[1]}}) &&
           fill(p, (march_part){{0, in.high[1]}, {width, height}});
}
