// A full-screen fragment shader as a pass: multiplies by a colour.
uniform sampler2D source;                 //= input : the picture
uniform vec3 tint;                        //= {1, 0.5, 0.25} : factor by channel
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;      //= output rgba16f : the tinted picture
void main() { color = texture(source, uv) * vec4(tint, 1.0); }
