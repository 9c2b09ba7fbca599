// For glsl.lua.
float swirl(vec3 p, float turns, vec3 tint) {
    return fract(turns * atan(p.y, p.x)) * tint.x;
}

vec3 spin(vec3 p) {
    return vec3(-p.y, p.x, 0);
}
