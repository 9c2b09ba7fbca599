// From one picture to another by a slanted line that sweeps across, with an edge of bare paper.
uniform sampler2D before;        //= input : where the line has not been yet
uniform sampler2D after;         //= input : where it has been
uniform float share;             //= 0 [0, 1] : how far it has come
uniform float slant;             //= 0.35 [-2, 2] : how much the line leans, as a part of the picture's height
uniform float edge;              //= 7 [0, 100] pixels : thickness of the line, of a picture of 1080 rows
uniform vec3 paper;              //= {0.9, 0.82, 0.66} [0, 1] color : its colour
writeonly uniform image2D color; //= output rgba16f : the mixed picture

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    float rows = float(size.y), lean = slant * (0.5 - uv.y) * rows, way = float(size.x) + abs(slant) * rows + 2.0 * edge;
    float past = share * way - 0.5 * (way - float(size.x)) - float(pixel.x) + lean; // pixels behind the line
    vec4 mixed = mix(textureLod(before, uv, 0.0), textureLod(after, uv, 0.0), clamp(past + 0.5, 0.0, 1.0));
    float line = clamp(0.5 * edge * rows / 1080.0 + 0.5 - abs(past), 0.0, 1.0) * float(share > 0.0 && share < 1.0);
    imageStore(color, pixel, vec4(mix(mixed.rgb, paper, line), mixed.a));
}
