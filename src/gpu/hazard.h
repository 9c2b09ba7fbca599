// Which barrier an access needs, given what happened to a resource before. Needs no device.
//
// One hazard_state stands for one mip level of an image or one whole buffer. The cases:
//
//   before          now             barrier
//   nothing         read or write   none; an image gets its layout
//   write           read            RAW: waits for the write and makes it visible to the reader
//   write           write           WAW: waits for the first write and makes it visible
//   read            write           WAR: waits for the readers; nothing to make visible
//   read            read            none, if the stage has seen the last write already (RAR)
//   any             other layout    counts as a write: waits for readers and writer
#pragma once
#include <stdbool.h>
#include <vulkan/vulkan_core.h>

typedef struct hazard_access {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads, writes;
    VkImageLayout layout; // VK_IMAGE_LAYOUT_UNDEFINED: a buffer
} hazard_access;

typedef struct hazard_state {             // zero-initialised: never used
    VkPipelineStageFlags2 write_stages;   // of the last write or layout change
    VkAccessFlags2 write_access;          // 0: a layout change, there is nothing to flush
    VkPipelineStageFlags2 read_stages;    // all readers since
    VkPipelineStageFlags2 visible_stages; // stages that have waited for the last write ...
    VkAccessFlags2 visible_access;        // ... and the accesses that see it
    VkImageLayout layout;
} hazard_state;

typedef struct hazard_barrier {
    VkPipelineStageFlags2 source_stages, stages;
    VkAccessFlags2 source_access, access;
    VkImageLayout old_layout, layout;
} hazard_barrier;

// Notes the access in `state`. True when `out` must come first.
bool hazard_track(hazard_state *state, const hazard_access *access, hazard_barrier *out);

// Adds what the same command also does to the same resource. False on a contradiction: two layouts
// of which one is written in, or that no common layout serves.
bool hazard_merge(hazard_access *into, const hazard_access *add);
