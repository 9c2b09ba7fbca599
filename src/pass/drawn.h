// Meshes and instances as triangles: what `geometry` draws where it does not trace rays, what is in
// the maps of shadows, what `forward` lights. A view says from where; several may share a target.
//
// Before they are drawn, the device leaves out of each view what lies outside of it, and chooses
// for the rest how far its mesh is simplified (shaders/pass/drawn/): their number costs the host
// nothing, and views may be placed on the device, too. In a view there is one draw for each kind
// and part.
//
// Shaders include lib/mesh.glsl (a vertex shader, for its vertex) and lib/mesh_color.glsl (a
// fragment shader). All else that they bind is bound by name as in any pass.
//
// Life: drawn_create when the pass is declared, drawn_check or drawn_build, drawn_allocate; in a
// frame, after pass_prepare, drawn_cull once with all views, then any number of drawn_record.
#pragma once
#include "pass/pass_impl.h"

typedef struct drawn drawn;

enum { DRAWN_MAX_VIEWS = 64 };

typedef struct drawn_stages { // a vertex and a fragment shader, and what they draw to
    shader_binary vertex, fragment;
    gpu_pipeline *pipeline;
    unsigned char *blocks[2]; // host copies of their "Uniforms"
    bool alike; // no stage asks which part it draws: those of a mesh and its levels are one draw
} drawn_stages;

typedef struct drawn_target {           // beside a depth buffer
    gpu_format colors[GPU_MAX_TARGETS]; // GPU_FORMAT_NONE ends the list
    gpu_cull cull;
} drawn_target;

// Compiles both; `fragment` may be p->shader. Needs no device.
bool drawn_check(pass *p, const char *vertex, const char *fragment, const shader_define *defines,
                 size_t define_count, drawn_stages *out);
bool drawn_build(pass *p, const drawn_target *target, drawn_stages *stages); // checked before
void drawn_stages_destroy(pass *p, drawn_stages *stages);

drawn *drawn_create(pass *p);    // of all meshes and instances that the pass was given
bool drawn_check_cull(drawn *d); // compiles what chooses; needs no device
bool drawn_build_cull(drawn *d);
bool drawn_allocate(drawn *d); // again: does nothing
// Memory of the device that drawn_allocate will take, and drawing for so many views.
void drawn_list_memory(const drawn *d, size_t views, budget_list *out);
void drawn_destroy(drawn *d); // NULL is fine

// Chooses what is drawn in each view. `views`: storage buffer of view_entry (shared.h), of which
// `count` are used; NULL: the camera's of this frame, in a picture of `height` pixels. `lod`: how
// far (pixels) a simplified mesh may be off; 0: all is drawn in full. `most`: instances whose
// middle is farther (m) from the eye of a view are left out; 0: none for that.
bool drawn_cull(drawn *d, gpu_buffer *views, size_t count, uint32_t height, float lod, float most);

// Draws `count` of those views, from `first` on, to the target, whose pipeline and draws are set
// here. `places`: x, y, width, height of each in the target; NULL: each has all of it.
bool drawn_record(drawn *d, drawn_stages *stages, gpu_draw_desc *target, size_t first, size_t count,
                  const uint32_t (*places)[4]);
