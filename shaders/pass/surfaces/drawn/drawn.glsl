// What is drawn of a body (meshes, or instances of several meshes) in each view, as lists of its
// instances: one for each bucket, which is a mesh at one of its levels (src/pass/surfaces/drawn_cull.c). In
// three steps, so that lists keep the order of the instances and no frame depends on chance: choose
// (a bucket for each), count (places in the list, and the commands), list.
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
#include "shared.h"
uniform uint instance_count;
uniform uint bucket_count;
uniform uint block_count; // of DRAWN_BLOCK instances each

// In lists of buckets, and of blocks of buckets.
uint bucket_at(uint view, uint bucket) {
    return view * bucket_count + bucket;
}
uint block_at(uint view, uint bucket, uint block) {
    return bucket_at(view, bucket) * block_count + block;
}
