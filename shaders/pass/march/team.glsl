#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_basic : require
// A ray has one thread or several, its team: of each run of its samples every thread takes one, so
// that they do not wait for each other. That is for devices with more threads than the picture has
// pixels. What lies before a sample within its run is summed over the team.
#ifndef TEAMS
#define TEAMS 0
#endif
#if TEAMS
uniform int team; // threads: a power of two, at most as many as a subgroup has

int team_place() { return int(gl_SubgroupInvocationID) & (team - 1); }

float team_greatest(float v) {
    for (int i = 1; i < team; i *= 2) v = max(v, subgroupShuffleXor(v, uint(i)));
    return v;
}

float team_sum(float v) {
    for (int i = 1; i < team; i *= 2) v += subgroupShuffleXor(v, uint(i));
    return v;
}

vec3 team_sum(vec3 v) { return vec3(team_sum(v.x), team_sum(v.y), team_sum(v.z)); }

float team_product(float v) {
    for (int i = 1; i < team; i *= 2) v *= subgroupShuffleXor(v, uint(i));
    return v;
}

// Of the threads before this one.
float team_sum_before(float v) {
    for (int i = 1; i < team; i *= 2) {
        float other = subgroupShuffleUp(v, uint(i));
        v += team_place() >= i ? other : 0.0;
    }
    float before = subgroupShuffleUp(v, 1u);
    return team_place() > 0 ? before : 0.0;
}

float team_product_before(float v) {
    for (int i = 1; i < team; i *= 2) {
        float other = subgroupShuffleUp(v, uint(i));
        v *= team_place() >= i ? other : 1.0;
    }
    float before = subgroupShuffleUp(v, 1u);
    return team_place() > 0 ? before : 1.0;
}
#else
const int team = 1;
int team_place() { return 0; }
float team_greatest(float v) { return v; }
#endif
