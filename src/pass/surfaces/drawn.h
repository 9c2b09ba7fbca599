// Meshes and instances as triangles: what `geometry` draws where it does not trace rays, what is in
// the maps of shadows, what `forward` lights. A view says from where; several may share a target.
//
// Before they are drawn, the device leaves out of each view what lies outside of it, and chooses
// for the rest how far its mesh is simplified (shaders/pass/drawn/): their number costs the host
// nothing, and views may be placed on the device, too. In a view there is one draw for each kind
// and part.
//
// Shaders include lib/mesh.glsl (a vertex shader, for its vertex) and lib/mesh_color.glsl (a
// fragment shader). All else that they bind is bound as in any pass.
//
// A type that draws lists DRAWN_KERNELS behind its own kernels, of which those that draw are drawn
// to a depth buffer, and has drawn_kernel_table as its solver's.
//
// Life: drawn_create when the pass is declared, drawn_allocate; in a frame, after pass_prepare,
// drawn_cull once with all views, then any number of drawn_record.
#pragma once
#include "pass/pass_impl.h"

typedef struct drawn drawn;

enum { DRAWN_MAX_VIEWS = 64, DRAWN_STEPS = 3 };

// The kernels that choose, of a type's list from `first` on.
#define DRAWN_KERNELS(FIRST)                                                                       \
    [FIRST] = {.shader = "pass/surfaces/drawn/choose.comp", .without_fields = true},               \
    [(FIRST) + 1] = {.shader = "pass/surfaces/drawn/count.comp", .without_fields = true},          \
    [(FIRST) + 2] = {.shader = "pass/surfaces/drawn/list.comp", .without_fields = true}

extern const kernel_table drawn_kernel_table;

// Of all meshes and instances that the pass was given; `first`: as the type has DRAWN_KERNELS.
// `alike`: no kernel asks which part it draws, so that those of a mesh and its levels are one draw.
drawn *drawn_create(pass *p, size_t first, bool alike);
bool drawn_allocate(drawn *d); // again: does nothing
// Memory of the device that drawn_allocate will take, and drawing for so many views.
void drawn_list_memory(const drawn *d, size_t views, budget_list *out);
void drawn_destroy(drawn *d); // NULL is fine

// Chooses what is drawn in each view. `views`: storage buffer of view_entry (shared.h), of which
// `count` are used; NULL: the camera's of this frame, in a picture of `height` pixels. `lod`: how
// far (pixels) a simplified mesh may be off; 0: all is drawn in full. `most`: instances whose
// middle is farther (m) from the eye of a view are left out; 0: none for that.
bool drawn_cull(drawn *d, gpu_buffer *views, size_t count, uint32_t height, float lod, float most);

// Draws `count` of those views with the pass's kernel `index`, from view `first` on, to the target,
// whose pipeline and draws are set here. `places`: x, y, width, height of each in the target; NULL:
// each has all of it.
bool drawn_record(drawn *d, size_t index, gpu_draw_desc *target, size_t first, size_t count,
                  const uint32_t (*places)[4]);
