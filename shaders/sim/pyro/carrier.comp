// The velocity that carries the gas, across the faces of its own cells, where these are half as large as
// those of the velocity. What flows through a large face is shared out to its four small ones by the
// velocity's slope along the face, so that as much flows as before. A small face half way between two large
// ones has the mean of both, and so much more that the eight small cells expand alike (Toth and Roe 2002,
// section 2.2).
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/faces.glsl"

layout(std430) readonly buffer PyroVelocity { PYRO_FOUR velocity[]; };
layout(std430) writeonly buffer PyroCarrier { PYRO_FOUR carrier[]; };
#if PYRO_SOLIDS
layout(std430) readonly buffer PyroCoefficients { PYRO_COEFFICIENTS coefficients[]; };
#define IS_OPEN(at, axis) float(pyro_coefficients(coefficients[at]).axis > 0.0)
#else
#define IS_OPEN(at, axis) 1.0
#endif

// Across the large face at a place along `axis`, and by how much more across its small faces that are
// higher along the two other axes, 1 and 2. A closed face is closed as a whole.
#define PLANE(component, axis, at, axis1, axis2, known, end_flow)                                  \
    known ? vec3(end_flow, 0.0, 0.0)                                                               \
          : vec3(PYRO_##component(velocity[at + n.cell.axis1 + n.cell.axis2]),                     \
                 IS_OPEN(at + n.cell.axis1 + n.cell.axis2, axis) * 0.125 *                    \
                     vec2(PYRO_##component(velocity[at + above.axis1 + n.cell.axis2]) -            \
                              PYRO_##component(velocity[at + n.below.axis1 + n.cell.axis2]),       \
                          PYRO_##component(velocity[at + n.cell.axis1 + above.axis2]) -            \
                              PYRO_##component(velocity[at + n.cell.axis1 + n.below.axis2])))

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    pyro_near n = pyro_near_of(c);
    ivec3 above = pyro_places(mix(min(c + 1, PYRO_SIZE - 1), pyro_around(c + 1), PYRO_AROUND));
    vec3 end_flow = inflow * PYRO_END_FLOWS;
    vec3 x0 = PLANE(X, x, n.face.x, y, z, false, 0.0), x1 = PLANE(X, x, n.next.x, y, z, n.ends.x, end_flow.x);
    vec3 y0 = PLANE(Y, y, n.face.y, z, x, false, 0.0), y1 = PLANE(Y, y, n.next.y, z, x, n.ends.y, end_flow.y);
    vec3 z0 = PLANE(Z, z, n.face.z, x, y, false, 0.0), z1 = PLANE(Z, z, n.next.z, x, y, n.ends.z, end_flow.z);
    vec3 more = 0.5 * vec3(y1.z - y0.z + z1.y - z0.y, x1.y - x0.y + z1.z - z0.z, x1.z - x0.z + y1.y - y0.y);
    vec3 y2 = y1, z2 = z1; // of the cell above
    x1 = 0.5 * (x0 + x1) + vec3(more.x, 0.0, 0.0);
    y1 = 0.5 * (y0 + y1) + vec3(more.y, 0.0, 0.0);
    z1 = 0.5 * (z0 + z1) + vec3(more.z, 0.0, 0.0);
    for (int i = 0; i < 8; i++) {
        ivec3 part = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec3 side = vec3(2 * part - 1);
        vec3 v = vec3(dot(part.x == 0 ? x0 : x1, vec3(1.0, side.yz)), dot(part.y == 0 ? y0 : y1, vec3(1.0, side.zx)),
                      dot(part.z == 0 ? z0 : z1, vec3(1.0, side.xy)));
        float spread = dot(part.y == 0 ? y1 : y2, vec3(1.0, side.zx)) - v.y +
                       dot(part.z == 0 ? z1 : z2, vec3(1.0, side.xy)) - v.z; // along y and z
        carrier[pyro_gas_at(2 * c + part)] = pyro_store(vec4(v, spread));
    }
}
