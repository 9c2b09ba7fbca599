// Colours. OKLab is Ottosson's ("A perceptual color space for image processing", 2020). A black
// body's colour is Planck's law integrated against the CIE 1931 colour matching functions, these by
// the piecewise Gaussian fits of Wyman, Sloan and Shirley ("Simple analytic approximations to the
// CIE XYZ color matching functions", JCGT 2013).
#include "field/color.h"
#include "field/palette.h"
#include <math.h>
#include <pthread.h>

void color_to_oklab(const float c[3], float lab[3]) {
    float l = cbrtf(0.4122214708f * c[0] + 0.5363325363f * c[1] + 0.0514459929f * c[2]);
    float m = cbrtf(0.2119034982f * c[0] + 0.6806995451f * c[1] + 0.1073969566f * c[2]);
    float s = cbrtf(0.0883024619f * c[0] + 0.2817188376f * c[1] + 0.6299787005f * c[2]);
    lab[0] = 0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s;
    lab[1] = 1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s;
    lab[2] = 0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s;
}

void color_from_oklab(const float lab[3], float out[3]) {
    float l = lab[0] + 0.3963377774f * lab[1] + 0.2158037573f * lab[2];
    float m = lab[0] - 0.1055613458f * lab[1] - 0.0638541728f * lab[2];
    float s = lab[0] - 0.0894841775f * lab[1] - 1.2914855480f * lab[2];
    l = l * l * l;
    m = m * m * m;
    s = s * s * s;
    out[0] = 4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s;
    out[1] = -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s;
    out[2] = -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s;
}

static double lobe(double x, double centre, double below, double above) {
    double t = (x - centre) / (x < centre ? below : above);
    return exp(-0.5 * t * t);
}

static void match(double nm, double xyz[3]) {
    xyz[0] = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
             0.065 * lobe(nm, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
}

// Of all wavelengths: what depends on no temperature, which is most of the work.
typedef struct sample {
    double nm, scale, xyz[3];
} sample;

enum { NM_MIN = 380, NM_MAX = 780, NM_STEP = 5, SAMPLES = (NM_MAX - NM_MIN) / NM_STEP + 1 };
static sample samples[SAMPLES];
static pthread_once_t sampled = PTHREAD_ONCE_INIT;

static void find_samples(void) {
    for (int i = 0; i < SAMPLES; i++) {
        sample *s = &samples[i];
        s->nm = NM_MIN + NM_STEP * i;
        s->scale = pow(560 / s->nm, 5);
        match(s->nm, s->xyz);
    }
}

void palette_blackbody(float kelvin, float out[3]) {
    const double second = 1.438776877e7; // second radiation constant, nm K
    double t = kelvin > 500 ? fmin((double)kelvin, 20000.0) : 500.0;
    double xyz[3] = {0, 0, 0};
    pthread_once(&sampled, find_samples);
    for (const sample *s = samples; s < samples + SAMPLES; s++) {
        double radiance = s->scale / (exp(second / (s->nm * t)) - 1); // the exponent is 0.9 to 76
        for (int i = 0; i < 3; i++) xyz[i] += radiance * s->xyz[i];
    }
    double rgb[3] = {
        3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
        -0.9692660 * xyz[0] + 1.8760108 * xyz[1] + 0.0415560 * xyz[2],
        0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2],
    };
    for (int i = 0; i < 3; i++) rgb[i] = fmax(rgb[i], 0); // deep reds leave the gamut
    double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    for (int i = 0; i < 3; i++) out[i] = (float)(rgb[i] / luminance);
}
