// The inside of the pass shadow_maps: where its views stand, and where in the atlas they lie.
#pragma once
#include "base/hash.h"
#include "pass/pass_impl.h"
#include "shared.h"

#define SHADOW_MAPS_NAMES(NAME)                                                                    \
    NAME(cascades), NAME(points), NAME(size), NAME(spot_size), NAME(point_size), NAME(distance),   \
        NAME(split), NAME(shadow_radius), NAME(lod), NAME(lights), NAME(point_lights),             \
        NAME(shadow_atlas), NAME(shadow_views), NAME(places), NAME(fixed_views), NAME(margin),     \
        NAME(pixels), NAME(fixed_lights), NAME(Views)
enum { SHADOW_MAPS_NAMES(KERNEL_NAME_ID) };

// From how far meshes cast shadows into a cascade, in distances up to which there are cascades.
#define SHADOW_REACH 4.0f
// A wider cone has no map: what its edge would take of the texels leaves nothing for its middle.
#define SHADOW_WIDEST_SPOT 160.0f // degrees

// Where the cascades end: between even parts (mix 0) and even ratios (mix 1) of what lies between
// `near` and `far` (Zhang et al., "Parallel-split shadow maps for large-scale virtual
// environments", VRCIA 2006, section 4.2).
void shadow_maps_split(float near, float far, float mix, uint32_t count, float *ends);

// The view of the sun (unit, towards it) that holds what the camera of `frame` sees between the
// depths `near` and `far`, and what casts shadows on that from up to `reach` metres, in a square of
// `size` texels, `margin` of which are left at each edge. It is as large however the camera stands,
// and moves by whole texels, so that edges do not swim.
void shadow_maps_cascade(const struct frame_block *frame, const float sun[3], float near, float far,
                         float reach, uint32_t size, float margin, struct shadow_view *out);
// The view out of a spot light, up to `far` metres. False: its cone is too wide for one.
bool shadow_maps_spot(const struct light_entry *light, float far, uint32_t size, float margin,
                      struct shadow_view *out);

// Places squares, powers of two that do not grow, without gaps between those of a size: x, y,
// width and height of each. False when no atlas of at most `most` texels along an edge holds them.
bool shadow_maps_pack(const uint32_t *sizes, uint32_t count, uint32_t most, uint32_t (*places)[4],
                      uint32_t atlas[2]);

// What the maps of this frame follow from, after pass_prepare: the numbers of `places`, the kernel
// that places views, and more; `choice`: also from which lights are chosen for them. False: the
// device alone knows.
bool shadow_maps_content(const pass *p, const kernel *places, bool choice, hash128 *out);
