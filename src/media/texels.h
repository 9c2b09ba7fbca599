// Values of a box of voxels as the texels of textures: halves, four channels to a texture, the axes
// turned where a file has Y up (our Y is then its -Z, and our Z its Y).
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TEXELS_IMAGES = 4 };
#define TEXELS_HALF_MAX 65504.0f // what lies beyond is cut off

typedef struct texels_shape {
    uint32_t size[3]; // voxels along the file's axes
    bool y_up;
    int width; // channels of all textures together; at most 4 * TEXELS_IMAGES
} texels_shape;

void texels_size(const texels_shape *s, uint32_t out[3]);      // of the textures
int texels_channels(const texels_shape *s, int image);         // 0 to 4
int texels_width(const texels_shape *s, int image);            // components of the texture
uint64_t texels_bytes(const texels_shape *s);                  // of a voxel, in all textures
uint64_t texels_image_bytes(const texels_shape *s, int image); // of a dense texture

typedef struct texels_active { // of what was packed
    uint32_t low[3], high[3];  // box of the texels that are not 0, exclusive; nothing: low > high
    uint64_t voxels;           // that are not 0, of the channel that has the most
} texels_active;
texels_active texels_nothing(void);

// Writes one component of `values`, x fastest along the file's axes and `stride` floats apart, to a
// channel of the dense texture that it belongs to. Finite values; zeros are left as they are.
void texels_pack(const texels_shape *s, const float *values, int stride, float gain,
                 uint16_t *texels, int channel, texels_active *active);
