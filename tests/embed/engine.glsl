// Shaders of the engine, by stage: VERTEX and FRAGMENT draw its triangles, COMPOSE lays the layers over them.
#version 450
#ifdef VERTEX
layout(push_constant) uniform Push { mat4 clip; };
layout(location = 0) out vec3 color;
const vec3 corners[9] = vec3[](vec3(-3.0, 0.0, -0.5), vec3(0.3, 0.0, -0.5), vec3(-3.0, 0.0, 1.6), // a wall
                               vec3(-3.0, 0.0, 1.6), vec3(0.3, 0.0, -0.5), vec3(0.3, 0.0, 1.6),
                               vec3(0.6, -1.0, -0.4), vec3(1.9, -0.2, -0.4), vec3(1.2, 1.2, 1.4)); // a sail
const vec3 colors[3] = vec3[](vec3(0.30, 0.26, 0.22), vec3(0.30, 0.26, 0.22), vec3(0.05, 0.12, 0.30));
void main() {
    color = colors[gl_VertexIndex / 3];
    gl_Position = clip * vec4(corners[gl_VertexIndex], 1.0);
}
#endif
#ifdef FRAGMENT
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 picture;
void main() { picture = vec4(color, 1.0); }
#endif
#ifdef COMPOSE
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform image2D picture;
layout(binding = 1, rgba16f) uniform readonly image2D far_color;
layout(binding = 2, rgba16f) uniform readonly image2D far_through;
layout(binding = 3, rgba16f) uniform readonly image2D near_color;
layout(binding = 4, rgba16f) uniform readonly image2D near_through;
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(picture)))) return;
    vec3 c = imageLoad(picture, p).rgb;
    c = imageLoad(far_color, p).rgb + imageLoad(far_through, p).rgb * c;
    c = imageLoad(near_color, p).rgb + imageLoad(near_through, p).rgb * c;
    imageStore(picture, p, vec4(c, 1.0));
}
#endif
