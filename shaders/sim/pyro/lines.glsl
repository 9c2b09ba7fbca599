// The 32 lines along x of a half brick of 8 x 8 x 4 cells, for threads that are neighbours along x: they find
// what crosses the nine faces of each line, then what its eight cells hold.
#ifndef SIM_PYRO_LINES_GLSL
#define SIM_PYRO_LINES_GLSL
const int LINE_FACES = 9 * 32, LINE_CELLS = 8 * 32;

ivec3 line_face(int k) { // the cell above it
    return ivec3(k % 9, k / 9 & 7, k / 72);
}
ivec3 line_cell(int k) {
    return ivec3(k & 7, k >> 3 & 7, k >> 6);
}
int line_face_below(int k) { // of a cell
    return 9 * (k >> 3) + (k & 7);
}
#endif
