// The last pass: adds the bloom, exposes, tone maps.
#include "lib/color.glsl"
#include "lib/tonemap.glsl"
//@ option tonemap = agx {agx, aces, reinhard, exponential, none, display} : how scene light becomes display light: none: light is cut off at 1; display: so are the values, and they are shown as they are, without the curve of a display (sRGB), as by programs that know none
//@ option bloom_mix = add {add, luminance} : add: all of the bloom; luminance: the less of it, the brighter the picture is already, down to none where that is 2, so that lights keep their colours
//@ option saturate = scene {scene, display} : which light `saturation` changes: before or after the tone map
uniform sampler2D source;         //= input : the picture, scene-linear
uniform sampler2D bloom;          //= input optional : added to it
uniform sampler2D exposure;       //= input optional : stops of exposure besides `exposure_ev` (of the pass meter)
uniform float bloom_intensity;    //= 0.8 [0, 10] : factor of the bloom
uniform float exposure_ev;        //= 0 [-20, 20] EV : stops of exposure
uniform float saturation;         //= 1 [0, 4] : 0: grey, 1: as it is
uniform float subtract;           //= 0 [0, 1] : taken from each channel of what a display is given (0 to 1, sRGB), down to black: a flash that is not of light is a moment with less of it
writeonly uniform image2D color;  //= output rgba16f : display-linear, alpha kept
writeonly uniform image2D linear; //= output rgba16f : scene-linear with the bloom, alpha kept

vec3 saturate(vec3 c) { return max(mix(vec3(luminance(c)), c, saturation), 0.0); }

vec3 encode(vec3 c) { return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308))); }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec4 c = textureLod(source, uv, 0.0);
#if HAS_BLOOM
    vec3 halo = bloom_intensity * textureLod(bloom, uv, 0.0).rgb;
#if BLOOM_MIX == BLOOM_MIX_LUMINANCE
    halo *= max(1.0 - 0.5 * luminance(c.rgb), 0.0);
#endif
    c.rgb += halo;
#endif
    imageStore(linear, pixel, c);
    float stops = exposure_ev;
#if HAS_EXPOSURE
    stops += texelFetch(exposure, ivec2(0), 0).r;
#endif
    vec3 exposed = max(c.rgb * exp2(stops), 0.0);
#if SATURATE == SATURATE_SCENE
    exposed = saturate(exposed);
#endif
#if TONEMAP == TONEMAP_AGX
    exposed = tonemap_agx(exposed);
#elif TONEMAP == TONEMAP_ACES
    exposed = tonemap_aces(exposed);
#elif TONEMAP == TONEMAP_REINHARD
    exposed = tonemap_reinhard(exposed);
#elif TONEMAP == TONEMAP_EXPONENTIAL
    exposed = tonemap_exponential(exposed);
#endif
#if SATURATE == SATURATE_DISPLAY
    exposed = saturate(max(exposed, 0.0));
#endif
    exposed = clamp(exposed, 0.0, 1.0);
#if TONEMAP == TONEMAP_DISPLAY
    exposed = tonemap_decode(exposed);
#endif
    if (subtract > 0.0) exposed = tonemap_decode(max(encode(exposed) - subtract, 0.0));
    imageStore(color, pixel, vec4(exposed, c.a));
}
