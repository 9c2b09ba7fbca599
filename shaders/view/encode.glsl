// Display encoding by the tables that files are made with, so that a window shows to the bit what one
// would hold.
uniform sampler2D srgb; // across the square root of the value: codes / 255, rounded or (compose.comp) not

float encode(float linear) {
    float last = float(textureSize(srgb, 0).x - 1);
    float root = linear > 0.0 ? sqrt(min(linear, 1.0)) : 0.0; // NaN becomes 0
    return texelFetch(srgb, ivec2(int(roundEven(root * last)), 0), 0).r;
}

vec3 encode(vec3 linear) { return vec3(encode(linear.r), encode(linear.g), encode(linear.b)); }
