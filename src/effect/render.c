// An effect at work: built once for a size, then one frame after the other.
#include "base/error.h"
#include "base/memory.h"
#include "effect/effect_impl.h"
#include <math.h>

bool effect_check(effect *e) {
    if (!e->pictures[EFFECT_OUTPUT].id)
        return err_set("%s: the effect has no output; set `output` of the effect to an image",
                       e->file);
    for (size_t i = 0; i < e->pass_count; i++)
        if (!pass_check(e->passes[i])) return false;
    for (int i = 0; i < 3; i++)
        if (e->pictures[i].id && !graph_add_output(e->graph, e->pictures[i])) return false;
    return graph_compile(e->graph, 64, 64);
}

bool effect_build(effect *e, uint32_t width, uint32_t height) {
    if (!e->pictures[EFFECT_OUTPUT].id)
        return err_set("%s: the effect has no output; set `output` of the effect to an image",
                       e->file);
    for (int i = 0; !e->built && i < 3; i++)
        if (e->pictures[i].id && !graph_add_output(e->graph, e->pictures[i])) return false;
    if (!graph_compile(e->graph, width, height)) return false;
    for (size_t i = 0; !e->built && i < e->pass_count; i++)
        if (!pass_build(e->passes[i])) return false;
    if (!graph_allocate(e->graph, e->device)) return false;
    e->width = width;
    e->height = height;
    e->built = true;
    return true;
}

static bool evaluate(effect *e, double frame) {
    double time = (frame - e->first) / e->fps;
    double dt = e->counter ? (frame - e->last_frame) / e->fps : 0;
    e->context.time = time;
    if (e->hooks.update && !e->hooks.update(e->hooks.user, time, dt)) return false;
    if (!scene_fill_frame(&e->scene, &e->context, (float)e->width / (float)e->height, &e->frame))
        return false;
    e->frame.time = (shared_vec4){{(float)time, (float)dt, (float)frame, 0}};
    e->frame.size = (shared_uvec4){{e->width, e->height, (uint32_t)llrint(frame), e->seed}};
    for (size_t i = 0; i < e->grid_count; i++)
        if (!e->grids[i]->update(e->grids[i], e->device, time)) return false;
    return true;
}

uint64_t effect_render(effect *e, double frame, bool jump) {
    if (e->counter && !jump && frame != e->last_frame + 1) graph_reset_history(e->graph);
    uint64_t number = gpu_frame_begin(e->device);
    if (!number) return 0;
    bool done = evaluate(e, frame) && graph_execute(e->graph, e->device);
    if (!gpu_frame_end(e->device)) done = false;
    if (!done) { // what it may have left in a history is of no frame
        graph_reset_history(e->graph);
        return 0;
    }
    e->counter++;
    e->last_frame = frame;
    return number;
}
