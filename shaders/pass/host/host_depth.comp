// The depth buffer of a host's renderer, as metres, so that a medium stands behind its walls.
uniform sampler2D given;     //= input optional : the host's depth buffer, as it is in this frame
uniform vec2 depths;         // of the host's projection: metres are y / (depth + x)
uniform int there;           // 0: the host gives none in this frame
writeonly uniform image2D depth; //= output r32f : depth of the host's scene (m); 1e9 where nothing is

const float NOTHING = 1e9;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(depth);
    if (any(greaterThanEqual(pixel, size))) return;
    float metres = NOTHING;
    if (there != 0) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
        metres = depths.y / (texelFetch(given, ivec2(uv * vec2(textureSize(given, 0))), 0).r + depths.x);
        if (!(metres > 0.0 && metres < NOTHING)) metres = NOTHING; // beyond what is far, or of no number
    }
    imageStore(depth, pixel, vec4(metres));
}
