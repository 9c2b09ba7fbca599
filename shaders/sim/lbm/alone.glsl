// A step where all populations of a scalar and of the air are more than fit into registers: scalars go
// one by one, once the air is sent; those that make it rise are summed before, and loaded again. What
// one needs of the other waits in shared memory: what scalars have at faces that air passes, too, so that the
// air is first asked for its velocity there. A part of step.comp.
#ifndef SIM_LBM_ALONE_GLSL
#define SIM_LBM_ALONE_GLSL

#define PASSES (LBM_REGION == LBM_SKIN) // air passes a face
#define VALUE(s) (s)
#define VELOCITY LBM_SCALARS
#define EDDIES (LBM_SCALARS + 3)
#define LEFT (LBM_SCALARS + 4) // velocity, at faces
shared lbm_float waiting[LBM_ROWS][LEFT + (PASSES ? 3 : 0)][LBM_GROUP];
#define WAITING(row, k) waiting[row][k][gl_LocalInvocationIndex]
#define WAITING_VECTOR(row, k) lbm_vec(WAITING(row, k), WAITING(row, k + 1), WAITING(row, k + 2))

void put_vector(uint row, const int k, lbm_vec v) {
    WAITING(row, k) = v.x;
    WAITING(row, k + 1) = v.y;
    WAITING(row, k + 2) = v.z;
}

#if PASSES
void find_velocity_at_faces() {
    lbm_load_air(place, all_air);
    EACH_ELEMENT {
        take_air();
        if (has_air() && lbm_meets(at, site)) {
            lbm_find_bodies(at, site);
            meet_air(false);
            put_vector(row, LEFT, lbm_left);
        }
        give_air();
    }
    AGAIN
}
#endif

// The next element of a scalar: what arrives in it, and what it comes to.
void take_whole_scalar(const int s, uint row, bool flows) {
    take_scalar(0);
#if MEETS
    if (flows && lbm_meets(at, site)) {
        lbm_find_bodies(at, site);
#if PASSES
        lbm_left = WAITING_VECTOR(row, LEFT);
#endif
        meet_scalar(s, 0);
    }
#endif
    value[s] = lbm_sum_scalar(carried[0]);
}

// Of those that make the air rise, or are kept.
void sum_scalar(const int s) {
    const bool wanted = LBM_KEEP == 1 || buoyancy[s] != vec3(0.0);
    if (wanted) lbm_load_scalar(s, place, all_carried[0]);
    EACH_ELEMENT {
        value[s] = lbm_float(0.0);
        if (wanted) {
            take_whole_scalar(s, row, has_air());
            give_scalar(0);
        }
        WAITING(row, VALUE(s)) = value[s];
    }
    AGAIN
}

void step_air() {
    lbm_load_air(place, all_air);
    EACH_ELEMENT {
        take_air();
        if (has_air()) {
            lbm_vec u;
            lbm_float eddies;
            value[0] = value[1] = value[2] = lbm_float(0.0);
#define WAITED(s) value[s] = WAITING(row, VALUE(s));
            LBM_EACH_SCALAR(WAITED)
#undef WAITED
#if MEETS
            if (lbm_meets(at, site)) {
                lbm_find_bodies(at, site);
                meet_air(true);
            }
#endif
            collide_air(u, eddies);
            put_vector(row, VELOCITY, u);
            WAITING(row, EDDIES) = eddies;
#if LBM_KEEP
            keep_solid();
#endif
#if WALLED
            keep_air(site.solid);
#endif
        } else {
            keep_air(LBM_ALL_LANES);
        }
        give_air();
    }
    AGAIN
    lbm_send_air(place, all_air);
}

void step_scalar(const int s) {
    lbm_load_scalar(s, place, all_carried[0]);
    EACH_ELEMENT {
        const bool flows = has_air();
        take_whole_scalar(s, row, flows);
        if (flows) {
            collide_scalar(s, 0, WAITING_VECTOR(row, VELOCITY), WAITING(row, EDDIES));
#if WALLED
            keep_scalar(s, 0, site.solid);
#endif
        } else {
            keep_scalar(s, 0, LBM_ALL_LANES);
        }
        give_scalar(0);
    }
    AGAIN
    lbm_send_scalar(s, place, all_carried[0]);
}

void step_all() {
#if PASSES
    find_velocity_at_faces();
#endif
#define SUM(s) sum_scalar(s);
    LBM_EACH_SCALAR(SUM)
#undef SUM
    step_air();
    // The last first: it has just been summed, and caches may still know it.
#define STEP(s) step_scalar(s);
    LBM_EACH_SCALAR_BACK(STEP)
#undef STEP
}

#endif
