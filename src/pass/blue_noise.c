// The texture "BlueNoise" on the device.
#include "pass/blue_noise.h"

gpu_image *blue_noise_create(gpu *device) {
    gpu_image *image = gpu_image_create(device, &(gpu_image_desc){
                                                    .label = "blue noise",
                                                    .format = GPU_R8,
                                                    .width = BLUE_NOISE_SIZE,
                                                    .height = BLUE_NOISE_SIZE,
                                                    .depth = BLUE_NOISE_FRAMES,
                                                    .use = GPU_USE_SAMPLED,
                                                });
    if (!image) return NULL;
    if (gpu_image_write(device, image, 0, blue_noise_texels, sizeof blue_noise_texels))
        return image;
    gpu_image_destroy(device, image);
    return NULL;
}
