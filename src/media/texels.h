// Conversion of the values of a box of voxels to texels: halves, four channels per texture. Where a
// file has Y up its axes are rotated: our Y is its -Z, and our Z its Y.
#pragma once
#include <stdbool.h>
#include <stdint.h>

enum { TEXELS_IMAGES = 4 };
#define TEXELS_HALF_MAX 65504.0f // greater values are clamped

typedef struct texels_shape {
    uint32_t size[3]; // voxels along the file's axes
    bool y_up;
    int width; // channels of all textures together; at most 4 * TEXELS_IMAGES
} texels_shape;

void texels_size(const texels_shape *s, uint32_t out[3]);      // size of the textures
int texels_channels(const texels_shape *s, int image);         // 0 to 4
int texels_width(const texels_shape *s, int image);            // components of the texture
uint64_t texels_bytes(const texels_shape *s);                  // bytes of a voxel in all textures
uint64_t texels_image_bytes(const texels_shape *s, int image); // bytes of a dense texture

typedef struct texels_active { // extent of the packed values
    uint32_t low[3], high[3];  // box of the texels that are not 0, exclusive; none: low > high
    uint64_t voxels;           // number of nonzero voxels of the channel that has the most
} texels_active;
texels_active texels_nothing(void);

// Writes one component of `values`, x fastest along the file's axes and `stride` floats apart, to
// its channel of a dense texture. Values must be finite; zeros are not written.
void texels_pack(const texels_shape *s, const float *values, int stride, float gain,
                 uint16_t *texels, int channel, texels_active *active);
