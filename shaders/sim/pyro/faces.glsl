// The faces of the box, and those of a cell. All is written out by axis: software drivers keep what is
// indexed by a variable in memory.
#ifndef SIM_PYRO_FACES_GLSL
#define SIM_PYRO_FACES_GLSL

uniform vec3 inflow; // m/s, across faces that are PYRO_INFLOW

const bvec3 PYRO_PASSES_LOW = bvec3(PYRO_LOW_X == PYRO_OPEN || PYRO_LOW_X == PYRO_INFLOW,
                                    PYRO_LOW_Y == PYRO_OPEN || PYRO_LOW_Y == PYRO_INFLOW,
                                    PYRO_LOW_Z == PYRO_OPEN || PYRO_LOW_Z == PYRO_INFLOW);
const bvec3 PYRO_PASSES_HIGH = bvec3(PYRO_HIGH_X == PYRO_OPEN || PYRO_HIGH_X == PYRO_INFLOW,
                                     PYRO_HIGH_Y == PYRO_OPEN || PYRO_HIGH_Y == PYRO_INFLOW,
                                     PYRO_HIGH_Z == PYRO_OPEN || PYRO_HIGH_Z == PYRO_INFLOW);
// At the last face of an axis the velocity is known.
const bvec3 PYRO_ENDS = bvec3(PYRO_HIGH_X == PYRO_WALL || PYRO_HIGH_X == PYRO_INFLOW,
                              PYRO_HIGH_Y == PYRO_WALL || PYRO_HIGH_Y == PYRO_INFLOW,
                              PYRO_HIGH_Z == PYRO_WALL || PYRO_HIGH_Z == PYRO_INFLOW);
const vec3 PYRO_END_FLOWS = vec3(PYRO_HIGH_X == PYRO_INFLOW, PYRO_HIGH_Y == PYRO_INFLOW,
                                 PYRO_HIGH_Z == PYRO_INFLOW);
// The first face of each axis whose velocity is stored.
const ivec3 PYRO_FIRST = ivec3(PYRO_LOW_X == PYRO_OPEN, PYRO_LOW_Y == PYRO_OPEN, PYRO_LOW_Z == PYRO_OPEN);

// Places of a cell and of that before it, of the faces at its two ends.
struct pyro_near {
    ivec3 cell, below, face, next;
    bvec3 ends; // the face at the higher end is the last of the axis, whose velocity is known
};

pyro_near pyro_near_of(ivec3 c) {
    ivec3 last = PYRO_SIZE - 1;
    pyro_near n;
    n.cell = pyro_places(c);
    n.below = pyro_places(mix(max(c - 1, ivec3(0)), pyro_around(c - 1), PYRO_AROUND));
    n.face = pyro_places(mix(max(c, PYRO_FIRST), c, PYRO_AROUND));
    n.next = pyro_places(mix(clamp(c + 1, PYRO_FIRST, last), pyro_around(c + 1), PYRO_AROUND));
    n.ends = both(greaterThan(c + 1, last), PYRO_ENDS);
    return n;
}

// Velocities across the faces of a cell at its lower ends, and at its higher ones.
#define PYRO_FACES(from, n, low3, high3)                                                           \
    {                                                                                              \
        low3 = vec3(PYRO_X(from[n.face.x + n.cell.y + n.cell.z]),                                  \
                    PYRO_Y(from[n.cell.x + n.face.y + n.cell.z]),                                  \
                    PYRO_Z(from[n.cell.x + n.cell.y + n.face.z]));                                 \
        high3 = vec3(PYRO_X(from[n.next.x + n.cell.y + n.cell.z]),                                 \
                     PYRO_Y(from[n.cell.x + n.next.y + n.cell.z]),                                 \
                     PYRO_Z(from[n.cell.x + n.cell.y + n.next.z]));                                \
        high3 = mix(high3, inflow * PYRO_END_FLOWS, n.ends);                                       \
    }
#endif
