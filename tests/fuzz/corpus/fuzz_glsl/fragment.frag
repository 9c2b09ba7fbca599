layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;
layout(binding = 0) uniform sampler2D source;
void main() {
    if (at.x > 0.5) discard;
    color = texture(source, at) + dFdx(at.xyxy);
}
