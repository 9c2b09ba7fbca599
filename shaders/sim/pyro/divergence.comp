// What flows out of each cell, less its expansion: the pressure's right-hand side.
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
#include "sim/pyro/state.glsl"
#include "sim/pyro/sample.glsl"

layout(std430) readonly buffer PyroVelocityTo { PYRO_FOUR velocity_to[]; };
layout(std430) buffer PyroRight { float right[]; };
PYRO_FACE(face_to, velocity_to)

void main() {
    ivec3 c = ivec3(gl_GlobalInvocationID);
    float out_ = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 above = c;
        above[axis]++;
        out_ += face_to(axis, above) - face_to(axis, c);
    }
    right[pyro_at(c)] = out_ - right[pyro_at(c)];
}
