// Diffusion of velocities by central differences, and what walls do to it.
#ifndef SIM_FLOW_FRICTION_GLSL
#define SIM_FLOW_FRICTION_GLSL

uniform vec4 wall_velocity[4]; // of the faces left, right, bottom, top: x, y
uniform float friction;

bool flow_is_blocked(ivec2 cell, int slice) { // a solid's
#if FLOW_WITH_OBSTACLES
    cell = ivec2(FLOW_AROUND_X ? (cell.x + FLOW_NX) % FLOW_NX : cell.x,
                 FLOW_AROUND_Y ? (cell.y + FLOW_NY) % FLOW_NY : cell.y);
    return flow_inside(cell) && flow_obstacles[flow_cell(cell, slice)].x >= 0.5;
#else
    return false;
#endif
}

// What stands in for a value beyond a wall that lies half way and has the velocity `wall`.
float flow_beyond(float own, float wall) {
    return own + 2.0 * friction * (wall - own);
}

// Sum of the neighbours less four times the value, of a buffer of velocities `from`: of the
// horizontal one (component x) whose neighbours above and below have walls between, or the vertical
// one, whose neighbours left and right do. `across`, `along`: (0, 1) and (1, 0), or the other way.
#define FLOW_LAPLACE(name, from, component)                                                        \
    float name(ivec2 face, ivec2 across, ivec2 along, ivec2 last, vec4 wall, int slice) {          \
        float own = from[flow_corner(face, slice)].component, sum = -4.0 * own;                    \
        for (int i = 0; i < 4; i++) {                                                              \
            bool beside = i < 2;                                                                   \
            ivec2 p = face + (i % 2 * 2 - 1) * (beside ? across : along);                          \
            if (FLOW_AROUND_X) p.x = (p.x + FLOW_NX) % FLOW_NX;                                    \
            if (FLOW_AROUND_Y) p.y = (p.y + FLOW_NY) % FLOW_NY;                                    \
            bool outside = any(lessThan(p, ivec2(0))) || any(greaterThan(p, last));                \
            float there = from[flow_corner(clamp(p, ivec2(0), last), slice)].component;            \
            if (beside && outside) there = mix(own, flow_beyond(own, wall[i]), wall[i + 2]);       \
            else if (beside && flow_is_blocked(p, slice) && flow_is_blocked(p - along, slice))     \
                there = flow_beyond(own, there);                                                   \
            sum += there;                                                                          \
        }                                                                                          \
        return sum;                                                                                \
    }

// Of the faces of both velocities of a cell.
#define FLOW_LAPLACE_BOTH(name, u, v)                                                              \
    vec2 name(ivec2 cell, int slice) {                                                             \
        const ivec2 x = ivec2(1, 0), y = ivec2(0, 1);                                              \
        const vec2 closed_x = vec2(FLOW_FACE_LEFT == FLOW_CLOSED, FLOW_FACE_RIGHT == FLOW_CLOSED); \
        const vec2 closed_y = vec2(FLOW_FACE_BOTTOM == FLOW_CLOSED, FLOW_FACE_TOP == FLOW_CLOSED); \
        vec4 beside_u = vec4(wall_velocity[2].x, wall_velocity[3].x, closed_y);                    \
        vec4 beside_v = vec4(wall_velocity[0].y, wall_velocity[1].y, closed_x);                    \
        return vec2(u(cell, y, x, ivec2(FLOW_NX, FLOW_NY - 1), beside_u, slice),                   \
                    v(cell, x, y, ivec2(FLOW_NX - 1, FLOW_NY), beside_v, slice));                  \
    }
#endif
