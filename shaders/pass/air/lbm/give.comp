// Gives the air what a source holds (pass/air/lbm_source.comp), as the state of the solver: cells that
// are inside take on its values, as equilibria. Meshes are where they are at the step.
//
// A thread does one element of the state, cells that lie apart along z, or the elements of a bundle.
layout(local_size_x = 32, local_size_y = 2, local_size_z = 1) in;
#define LBM_BUNDLED (LBM_BUNDLE > 1)
#include "sim/lbm/cells.glsl"
#define AIR_NX LBM_NX
#define AIR_NY LBM_NY
#include "pass/air/source.glsl"
uniform float step_speed;      // cells a step of 1 m/s
uniform float clamp_speed;     // cells a step: what is faster is slowed down to it, as in the air
uniform float pascal;          // excess of density of a pascal
uniform uint note;             // bit of the source, 0: it has none
layout(std430) buffer SourceNotes { uint notes[2]; }; // bits of sources that hold something; that give it to air

#define EACH_LANE for (int l = 0; l < LBM_LANES; l++)
#define EACH_ROW for (int row = 0; row < LBM_ROWS; row++)

struct Held { // of the cells of an element
    lbm_float some; // how much they take on
    lbm_float density, temperature, dye, pressure;
    lbm_vec velocity; // cells a step
};

void tell(int which) {
    if ((notes[which] & note) != note) atomicOr(notes[which], note);
}

// `solid`: bits of lanes. Nothing comes out of walls and colliders.
Held held_by(uvec3 at, uint solid) {
    Held h;
    EACH_LANE {
        uvec3 cell = uvec3(at.xy, at.z + uint(l) * LBM_LAYERS);
        uvec4 values = values_at(cell);
        bool gives = (solid >> l & 1u) == 0u;
        if (unpackHalf2x16(values.y).y > 0.0) {
            tell(0);
            if (gives) tell(1);
        }
        if (!gives) values = uvec4(0u);
        vec2 a = unpackHalf2x16(values.x), b = unpackHalf2x16(values.y), d = unpackHalf2x16(values.w);
        vec3 v = vec3(unpackHalf2x16(values.z), d.x);
#if MESHES
        if (b.y > 0.0) v += motion_at(cell);
#endif
        v *= step_speed;
        v *= min(1.0, clamp_speed * inversesqrt(max(dot(v, v), 1e-20)));
        h.some[l] = b.y * share;
        h.density[l] = a.x;
        h.temperature[l] = a.y;
        h.dye[l] = b.x;
        h.pressure[l] = d.y * pascal;
        h.velocity.x[l] = v.x;
        h.velocity.y[l] = v.y;
        h.velocity.z[l] = v.z;
    }
    return h;
}

// Density less 1, and velocity, of the cells of an element.
lbm_float excess_of(lbm_element q[LBM_Q], out lbm_vec u) {
    lbm_float excess = lbm_unpack(q[0], LBM_AIR_SCALE);
    u = lbm_vec_all(vec3(0.0));
#define SUM(i, dx, dy, dz)                                                                         \
    {                                                                                              \
        lbm_float a = lbm_unpack(q[i], LBM_AIR_SCALE), b = lbm_unpack(q[i + 1], LBM_AIR_SCALE);    \
        excess += a + b;                                                                           \
        u.x += float(dx) * (a - b);                                                                \
        u.y += float(dy) * (a - b);                                                                \
        u.z += float(dz) * (a - b);                                                                \
    }
    LBM_PAIRS(SUM)
#undef SUM
    lbm_float density = 1.0 + excess;
    u = lbm_vec(u.x / density, u.y / density, u.z / density);
    return excess;
}

// ---- elements one after the other -------------------------------------------------------------

Held held[LBM_ROWS];
lbm_vec velocity[LBM_ROWS]; // of the air, then
uint given = 0u; // rows that take on anything, as bits

// Whether cells of an element, whose column is in the box, are in it.
bool meets_box(uvec3 at) {
    bool any_ = false;
    EACH_LANE any_ = any_ || at.z + uint(l) * LBM_LAYERS - uint(first.z) < uint(count.z);
    return any_;
}

void find_held(uvec3 at) {
    EACH_ROW {
        if (meets_box(at)) {
            held[row] = held_by(at, lbm_site_at(at, lbm_element_at(at)).solid);
            given |= uint(any(greaterThan(held[row].some, lbm_float(0.0)))) << row;
        }
        at.z += LBM_SPAN;
    }
}

bool is_given(int row) {
    return LBM_ROWS == 1 || (given >> row & 1u) != 0u;
}

// What is not given stays as it is: the pressure, above all, so that as much air is drawn in as is
// blown out.
void push(inout lbm_element q[LBM_Q], Held h, out lbm_vec u) {
    lbm_float f[LBM_Q], excess = excess_of(q, u);
#if HAS_PRESSURE
    excess = mix(excess, h.pressure, h.some);
#endif
    if (HAS_VELOCITY == 1 || velocity_factor != 0.0) {
        u.x = mix(u.x, h.velocity.x, h.some);
        u.y = mix(u.y, h.velocity.y, h.some);
        u.z = mix(u.z, h.velocity.z, h.some);
    }
    lbm_set_equilibrium(excess, u, f);
    for (int i = 0; i < LBM_Q; i++)
        q[i] = lbm_pack(LBM_AIR_SCALE, mix(lbm_unpack(q[i], LBM_AIR_SCALE), f[i], h.some));
}

void push_air(lbm_place place) {
    const bool pushes = HAS_VELOCITY == 1 || HAS_PRESSURE == 1 || (MESHES == 1 || HAS_PARTICLES == 1) && velocity_factor != 0.0;
    lbm_access all_[LBM_Q];
    lbm_element q[LBM_Q];
    lbm_load_air(place, all_);
    EACH_ROW {
        for (int i = 0; i < LBM_Q; i++) q[i] = lbm_take(all_[i]);
        if (is_given(row)) {
            if (pushes) push(q, held[row], velocity[row]);
            else excess_of(q, velocity[row]);
        }
        for (int i = 0; i < LBM_Q; i++) lbm_give(all_[i], q[i]);
    }
    if (pushes) lbm_replace_air(place, all_);
}

void carry(inout lbm_element q[LBM_SCALAR_Q], lbm_float some, lbm_float value, lbm_vec u) {
    lbm_float g[LBM_SCALAR_Q];
    lbm_set_scalar_equilibrium(value, u, g);
    for (int i = 0; i < LBM_SCALAR_Q; i++)
        q[i] = lbm_pack(LBM_SCALAR_SCALE, mix(lbm_unpack(q[i], LBM_SCALAR_SCALE), g[i], some));
}

#define GIVE(s, VALUE)                                                                             \
    {                                                                                              \
        lbm_access all_[LBM_SCALAR_Q];                                                             \
        lbm_element q[LBM_SCALAR_Q];                                                               \
        lbm_load_scalar(s, place, all_);                                                           \
        EACH_ROW {                                                                                 \
            for (int i = 0; i < LBM_SCALAR_Q; i++) q[i] = lbm_take(all_[i]);                       \
            if (is_given(row)) carry(q, held[row].some, held[row].VALUE, velocity[row]);           \
            for (int i = 0; i < LBM_SCALAR_Q; i++) lbm_give(all_[i], q[i]);                        \
        }                                                                                          \
        lbm_replace_scalar(s, place, all_);                                                        \
    }

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (any(greaterThanEqual(vec3(at), min(count, vec3(count.xy, LBM_DEPTH))))) return;
    at += uvec3(first);
    at.z %= LBM_DEPTH;
    find_held(at);
    if (given == 0u) return;
    lbm_place place = lbm_place_at(at);
    push_air(place);
#if HAS_DENSITY
    GIVE(0, density)
#endif
#if HAS_TEMPERATURE
    GIVE(1, temperature)
#endif
#if HAS_DYE
    GIVE(2, dye)
#endif
}
