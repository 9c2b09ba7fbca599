// The directions that light is swept in.
#if defined(STAGE_AROUND) || defined(STAGE_SWEEP) || defined(STAGE_RESTRICT) || defined(STAGE_REDUCE) || defined(STAGE_PROLONG)
// 48 directions, all images of one under the symmetries of the cube. With equal weights they
// integrate polynomials of degree 7 exactly, since the mean of x^4 is 1/5 and that of (x y z)^2 is
// 1/105: the squares are the roots of x^3 - x^2 + x / 5 - 1 / 105.
const int WAYS = 48, TURNS = 6, SIGNS = WAYS / TURNS;
const int LOOKS = 64, LOOK_PARTS = 4; // of light that comes from around: rays, and groups that do them

// All of a turn differ in their signs only.
vec3 turn_of(int turn) {
    vec3 v = vec3(0.26663540, 0.42251865, 0.86624682);
    if (turn >= 3) v = v.yxz;
    return turn % 3 == 0 ? v : turn % 3 == 1 ? v.yzx : v.zxy;
}

bvec3 signs_of(int index) {
    return bvec3(index & 1, index & 2, index & 4);
}

vec3 way_of(int index) {
    vec3 v = turn_of(index / SIGNS);
    return mix(v, -v, signs_of(index));
}
#endif
