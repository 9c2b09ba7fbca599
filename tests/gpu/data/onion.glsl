// Fields of a user, for tests.
float onion(vec3 p, float radius, vec3 centre) {
    float d = length(p - centre);
    return d < radius ? 0.5 + 0.5 * cos(20.0 * d) : 0.0;
}

vec3 stripes(vec3 p) {
    return 0.5 + 0.5 * sin(7.0 * p);
}
