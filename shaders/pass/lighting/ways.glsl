// The directions that light is swept in.
#if defined(STAGE_AROUND) || defined(STAGE_SWEEP) || defined(STAGE_REDUCE)
// 48 directions, all images of one under the symmetries of the cube. With equal weights they
// integrate polynomials of degree 7 exactly, since the mean of x^4 is 1/5 and that of (x y z)^2 is
// 1/105: the squares are the roots of x^3 - x^2 + x / 5 - 1 / 105.
const int WAYS = 48;
vec3 way_of(int index) {
    vec3 v = vec3(0.26663540, 0.42251865, 0.86624682);
    int turn = index >> 3;
    if (turn >= 3) v = v.yxz;
    if (turn % 3 == 1) v = v.yzx;
    if (turn % 3 == 2) v = v.zxy;
    return mix(v, -v, bvec3(index & 1, index & 2, index & 4));
}
#endif
