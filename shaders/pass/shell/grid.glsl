// The sphere as a cube that is blown up: six faces of CORNERS x CORNERS vertices.
const int SHELL_SIDE = int(SHELL_CORNERS), SHELL_FACE = SHELL_SIDE * SHELL_SIDE;

// Direction of a vertex. The tangent makes the squares about equal on the sphere. Of each face the
// first axis, the second and the direction outwards turn to the left.
vec3 shell_way(int vertex) {
    int face = vertex / SHELL_FACE, row = vertex % SHELL_FACE / SHELL_SIDE, column = vertex % SHELL_SIDE;
    vec2 at = tan((2.0 * vec2(column, row) / float(SHELL_SIDE - 1) - 1.0) * 0.78539816);
    vec3 way = vec3(at, 1.0);
    if (face >= 3) way = vec3(at.y, at.x, -1.0);
    return normalize(face % 3 == 0 ? way : face % 3 == 1 ? way.zxy : way.yzx);
}

// Of the corner of a triangle, in the order in which they are drawn: two triangles a square.
int shell_corner(int index) {
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
    int square = index / 6, squares = SHELL_SIDE - 1;
    ivec2 at = ivec2(square % squares, square / squares % squares) + corners[index % 6];
    return square / (squares * squares) * SHELL_FACE + at.y * SHELL_SIDE + at.x;
}
