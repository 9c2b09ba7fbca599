// Colours of a user interface are mixed as they are encoded, sRGB; blending wants them premultiplied.
uniform sampler2D image;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 shown;

void main() {
    vec4 c = color * textureLod(image, uv, 0.0);
    shown = vec4(c.rgb * c.a, c.a);
}
