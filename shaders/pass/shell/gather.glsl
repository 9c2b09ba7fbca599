// A thread for each shell: what of it is the same at all of its points.
layout(local_size_x = 64) in;
uniform vec4 shells[3 * 64]; // of each: place (m) and factor of its radius; age; shift and random number

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= shell_count) return;
    vec4 place = shells[3u * i], own = shells[3u * i + 1u], chance = shells[3u * i + 2u];
    const float FAR = 1e6;
    shell_said = shell_facts(own.x, chance.w, chance.xyz, 0.0, 0.0, vec3(0.0), vec3(0.0));
    shell_said.depth = field_shell_depth(vec3(0.0));
    vec3 centre = place.xyz + clamp(field_position(vec3(0.0)), vec3(-FAR), vec3(FAR));
    float radius = place.w * clamp(field_radius(vec3(0.0)), 0.0, FAR);
    shell_records[i] = shell_record(vec4(centre, radius), vec4(own.x, chance.w, shell_said.depth, 0.0),
                                    vec4(chance.xyz, 0.0));
}
