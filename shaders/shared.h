// Constants and structures that C and GLSL both read.
#ifdef GL_core_profile
#define SHARED_VEC4 vec4
#define SHARED_UVEC4 uvec4
#define SHARED_MAT4 mat4
#else
#pragma once
#include <stdint.h>
typedef struct shared_vec4 { float v[4]; } shared_vec4;
typedef struct shared_uvec4 { uint32_t v[4]; } shared_uvec4;
typedef struct shared_mat4 { float m[16]; } shared_mat4; // column-major
#define SHARED_VEC4 shared_vec4
#define SHARED_UVEC4 shared_uvec4
#define SHARED_MAT4 shared_mat4
#endif

// Uniform block "Frame" of every shader that includes lib/frame.glsl.
struct frame_block {
    SHARED_MAT4 view;           // world to camera; the camera looks along -z
    SHARED_MAT4 projection;     // camera to clip; depth 0 near, 1 far
    SHARED_MAT4 view_inverse;   // camera to world
    SHARED_VEC4 eye;            // xyz: metres; w: 0
    SHARED_VEC4 lens;           // tan(half width), tan(half height), near, far (metres)
    SHARED_VEC4 time;           // seconds, seconds since the last frame, frame number, 0
    SHARED_UVEC4 size;          // output width, height, frame counter, seed
    SHARED_VEC4 sun_direction;  // xyz: towards the sun, unit
    SHARED_VEC4 sun_radiance;   // rgb: irradiance at normal incidence over pi
    SHARED_VEC4 sky_zenith;     // rgb: radiance straight up
    SHARED_VEC4 sky_horizon;    // rgb: radiance at the horizon
};
