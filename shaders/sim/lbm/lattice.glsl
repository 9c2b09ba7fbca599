// Velocity sets, as lists X(i, x, y, z) of every second direction: direction i + 1 is the opposite
// of i. Direction 0 is rest. No i has a negative z, so that what lies across the end of the lattice
// along z is always the element above. Read by GLSL and by C alike.
#ifndef SIM_LBM_LATTICE_GLSL
#define SIM_LBM_LATTICE_GLSL

#define LBM_AXES(X) X(1, 1, 0, 0) X(3, 0, 1, 0) X(5, 0, 0, 1)
#define LBM_EDGES(X)                                                                               \
    X(7, 1, 1, 0) X(9, 1, -1, 0) X(11, 1, 0, 1) X(13, -1, 0, 1) X(15, 0, 1, 1) X(17, 0, -1, 1)
#define LBM_CORNERS(X) X(19, 1, 1, 1) X(21, -1, 1, 1) X(23, 1, -1, 1) X(25, -1, -1, 1)

#define LBM_D3Q7(X) LBM_AXES(X)
#define LBM_D3Q19(X) LBM_AXES(X) LBM_EDGES(X)
#define LBM_D3Q27(X) LBM_AXES(X) LBM_EDGES(X) LBM_CORNERS(X)

// Pairs M(a, b) that a mirror across an axis exchanges: a goes up along the axis, b down.
#define LBM_MIRRORS_19_X(M) M(1, 2) M(7, 10) M(9, 8) M(11, 13) M(14, 12)
#define LBM_MIRRORS_19_Y(M) M(3, 4) M(7, 9) M(10, 8) M(15, 17) M(18, 16)
#define LBM_MIRRORS_19_Z(M) M(5, 6) M(11, 14) M(13, 12) M(15, 18) M(17, 16)
#define LBM_MIRRORS_27_X(M) LBM_MIRRORS_19_X(M) M(19, 21) M(22, 20) M(23, 25) M(26, 24)
#define LBM_MIRRORS_27_Y(M) LBM_MIRRORS_19_Y(M) M(19, 23) M(24, 20) M(21, 25) M(26, 22)
#define LBM_MIRRORS_27_Z(M) LBM_MIRRORS_19_Z(M) M(19, 26) M(25, 20) M(21, 24) M(23, 22)

// Weights by how many of x, y and z are not 0.
#define LBM_D3Q7_REST (1.0 / 4.0)
#define LBM_D3Q7_AXIS (1.0 / 8.0)
#define LBM_D3Q19_REST (1.0 / 3.0)
#define LBM_D3Q19_AXIS (1.0 / 18.0)
#define LBM_D3Q19_EDGE (1.0 / 36.0)
#define LBM_D3Q27_REST (8.0 / 27.0)
#define LBM_D3Q27_AXIS (2.0 / 27.0)
#define LBM_D3Q27_EDGE (1.0 / 54.0)
#define LBM_D3Q27_CORNER (1.0 / 216.0)

#endif
