// Templates at work in a flow, as they lie on the device (src/pass/slices_templates.c): for each
// slice those of all groups one after the other, and four rows of these.
//
//   0  middle (cells), half of its side (cells; 0: nothing is drawn), what its picture is times
//   1  cos and sin of its turn, what its alpha is times, its tile; -1 - tile: velocity
//   2  age and lifetime (s), number of its life (0: it has had none), side (widths of a slice)
//   3  turn as it was put there (radians), middle (cells), 1: it has been put somewhere
#ifndef PASS_SLICES_TEMPLATES_GLSL
#define PASS_SLICES_TEMPLATES_GLSL

layout(std430) TEMPLATES_USE buffer Templates { vec4 templates[]; };
uniform uint total; // of a slice

uint template_at(uint row, int slice, uint which) {
    return (row * uint(FLOW_SLICES) + uint(slice)) * total + which;
}
#endif
