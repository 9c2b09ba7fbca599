// A thread for each shell: what of it is the same at all of its points.
layout(local_size_x = 64) in;
uniform vec4 shells[2 * 64]; // of each: place (m) and factor of its radius; age and seed

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= shell_count) return;
    vec4 place = shells[2u * i], own = shells[2u * i + 1u];
    uint chance = random_hash(uint(own.y));
    vec4 numbers;
    for (int k = 0; k < 4; k++) {
        numbers[k] = float(chance >> 8) / 16777216.0;
        chance = random_hash(chance);
    }
    shell_said = shell_facts(own.x, numbers.w, numbers.xyz, 0.0, 0.0, vec3(0.0), vec3(0.0));
    float far_away = 1e6;
    float depth = field_shell_depth(vec3(0.0));
    shell_said.depth = depth;
    vec3 centre = place.xyz + clamp(field_position(vec3(0.0)), vec3(-far_away), vec3(far_away));
    float radius = place.w * clamp(field_radius(vec3(0.0)), 0.0, far_away);
    shell_records[i] = shell_record(vec4(centre, radius), vec4(own.x, numbers.w, depth, 0.0),
                                    vec4(numbers.xyz, 0.0));
}
