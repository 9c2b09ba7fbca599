// Private to src/gpu: the structs behind gpu.h and the calls between its files.
//
// A `serial` counts submissions to the queue, from 1; the timeline semaphore holds the serial of
// the last finished one. At most one command buffer is open at a time: that of the open frame, or a
// batch of work recorded between frames, which is submitted before the next frame or read.
#pragma once
#include "base/budget.h"
#include "base/error.h"
#include "base/hash.h"
#include "gpu/allocator.h"
#include "gpu/calls.h"
#include "gpu/gpu.h"
#include "gpu/hazard.h"
#include "gpu/profile.h"
#include <pthread.h>
#include <stdatomic.h>

enum {
    VK_MAX_MIPS = 16,
    VK_MAX_DEVICES = 16,
    VK_BATCHES = 4,
    VK_BUILT_ROWS = 64,
    VK_BUILT_IDLE = 16,
    VK_MAX_SHOWN = 16
};

// ---- instance and device ----------------------------------------------------------------------

typedef struct vk_instance {
    VkInstance handle;
    VkDebugUtilsMessengerEXT messenger;
    bool validating, labels;
} vk_instance;

// Finds the calls of an instance, too. Counts messages in `*messages`, which must outlive the
// instance; may be NULL without validation. `window` may be NULL.
bool vk_instance_create(vk_instance *out, vk_calls *vk, bool validate, const gpu_window *window,
                        _Atomic uint64_t *messages);
void vk_instance_destroy(vk_instance *instance, const vk_calls *vk);

// Features that roil requires and those it takes when they are there (features.c lists them).
typedef struct vk_features {
    VkPhysicalDeviceFeatures2 core;
    VkPhysicalDeviceVulkan11Features v11;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
} vk_features;
void vk_features_chain(vk_features *f); // its parts to each other
void vk_features_read(const vk_calls *vk, VkPhysicalDevice physical, vk_features *out);
void vk_features_choose(const vk_features *there, vk_features *out); // what a device is made with
void vk_features_of_host(const void *chain, vk_features *out);       // as far as roil knows them
// The next feature that should be enabled and is not: needed, or wanted and there. `*at`, which
// begins with 0, counts. NULL: none.
const char *vk_features_missing(const vk_features *there, const vk_features *enabled, size_t *at);

typedef struct vk_choice { // a device as found; real GPUs first
    VkPhysicalDevice physical;
    gpu_info info;
    gpu_profile profile;
    bool pushes; // descriptors: VK_KHR_push_descriptor is there, and not turned down
} vk_choice;
// At most VK_MAX_DEVICES; -1 with a message when there is none. With a surface, a device that
// cannot present to it is not usable.
int vk_choices_find(const vk_calls *vk, VkInstance instance, VkSurfaceKHR surface, vk_choice *out);
const vk_choice *vk_choice_pick(const vk_choice *choices, int count, const char *device);
// Graphics and compute, and presenting when there is a surface. -1: none.
int vk_queue_family_find(const vk_calls *vk, VkPhysicalDevice physical, VkSurfaceKHR surface);
// Describes a device whose `features` are enabled, and push descriptors, where `pushes`.
void vk_choice_describe(const vk_calls *vk, VkPhysicalDevice physical, VkSurfaceKHR surface,
                        const vk_features *features, bool pushes, vk_choice *out);
bool vk_can_push(const vk_calls *vk, VkPhysicalDevice physical);
bool vk_has_extension(const vk_calls *vk, VkPhysicalDevice physical, const char *name);

gpu_profile vk_profile_find(const gpu_info *info, VkDriverId driver, const char *driver_info,
                            const gpu_limits *limits);
bool vk_small_device_wanted(void); // by the environment
// Its limits are at most those of a small device.
void vk_profile_make_small(gpu_profile *p);

// True for VK_SUCCESS; else false with "what: why", and notes a lost device.
bool vk_check(gpu *g, VkResult result, const char *what, ...) PRINTF_LIKE(3, 4);
bool vk_alive(gpu *g); // false with a message once the device is lost
// Notes that the device is lost, by the driver's word (VK_ERROR_DEVICE_LOST) or because work did
// not finish in time (VK_TIMEOUT). False with the message that all later calls will repeat.
bool vk_lose(gpu *g, VkResult how);
void vk_name(gpu *g, VkObjectType type, uint64_t handle, const char *label);
// Handles are pointers or integers, by platform.
#define VK_HANDLE(handle) ((uint64_t)(uintptr_t)(handle))

// ---- memory -----------------------------------------------------------------------------------

typedef enum vk_memory_kind {
    VK_MEMORY_DEVICE,
    VK_MEMORY_UPLOAD,   // the host writes, the device reads once
    VK_MEMORY_UNIFORM,  // the host writes, the device reads many times
    VK_MEMORY_READBACK, // the device writes, the host reads
} vk_memory_kind;

typedef struct vk_block {
    VkDeviceMemory memory;
    allocator spans;
    uint8_t *map; // NULL: not host-visible
    uint32_t type;
    bool image;  // holds images, else buffers
    bool single; // made for one large object
} vk_block;

typedef struct vk_memory {
    vk_block *block; // NULL: none
    allocator_place place;
    uint64_t size;
    budget_part *part; // of its size
} vk_memory;

typedef struct vk_pool {
    vk_block **blocks;
    size_t count, capacity;
    uint64_t used, reserved;
    // By whether the heap is the device's own. Of a device that shares the host's memory both are
    // the host's budget.
    budget *budgets[2];
    budget *whole; // of which the device's is a part with a limit of its own; NULL: it is not
    budget_part *spare[2]; // of blocks: what no object has
} vk_pool;

void vk_pool_init(gpu *g, uint64_t limit); // once the device is known; bytes, 0: none of its own
// `label` is for messages, and for the account of memory.
bool vk_memory_alloc(gpu *g, const VkMemoryRequirements *needs, vk_memory_kind kind, bool image,
                     const char *label, vk_memory *out);
void vk_memory_free(gpu *g, vk_memory *memory);
void *vk_memory_map(const vk_memory *memory);
void vk_pool_deinit(gpu *g);

// ---- resources --------------------------------------------------------------------------------

typedef struct vk_tracked {
    hazard_state state;
    hazard_access wanted; // by the command with that stamp
    uint64_t stamp;
} vk_tracked;

struct gpu_image {
    gpu_image_desc desc; // label owned
    VkImage handle;
    VkImageView all;               // every level
    VkImageView mips[VK_MAX_MIPS]; // one level each
    VkImageAspectFlags aspect;
    bool borrowed; // a host's: only the views are ours
    vk_memory memory;
    vk_tracked tracked[VK_MAX_MIPS];
};

struct gpu_buffer {
    char *label;
    uint64_t size;
    gpu_buffer_kind kind;
    VkBuffer handle;
    vk_memory memory;
    vk_tracked tracked;
};

// What the driver made of a pipeline's description: one for all pipelines of equal descriptions.
typedef struct vk_built {
    VkPipeline handle;
    VkPipelineLayout layout;
    VkDescriptorSetLayout set_layout;
    VkDescriptorUpdateTemplate descriptors; // of all slots, in their order; none: there are none
    bool sliced;                            // may go in several dispatches (dispatch.c)
    hash128 key;                            // of the description, without its label
    uint32_t references;
    struct vk_built *next; // in its row of the table
} vk_built;

struct gpu_pipeline {
    char *label;
    vk_built *built;
    VkPipelineBindPoint bind_point;
    gpu_slot slots[GPU_MAX_SLOTS];
    uint32_t slot_count;
    uint32_t local_size[3];
    gpu_format colors[GPU_MAX_TARGETS], depth;
    uint32_t color_count;
};

typedef struct vk_format {
    const char *name;
    VkFormat format;
    uint32_t size, channels;
} vk_format;
const vk_format *vk_format_get(gpu_format format);

// From any thread. One more reference to what was built of that description, or NULL.
vk_built *vk_built_find(gpu *g, hash128 key);
// Takes over a new one. Returns the one to use: an equal one that another thread has just added, if
// there is one.
vk_built *vk_built_add(gpu *g, vk_built *built);
void vk_built_release(gpu *g, vk_built *built);
void vk_built_free(gpu *g, void *built); // at once: no submission may use it
void vk_built_close(gpu *g);             // the same for all that are idle

gpu_buffer *vk_buffer_create(gpu *g, uint64_t size, VkBufferUsageFlags usage, vk_memory_kind kind,
                             const char *label);
// Texels and bytes of one level.
void vk_image_extent(const gpu_image *image, uint32_t mip, VkExtent3D *extent, uint64_t *bytes);
VkClearColorValue vk_clear_color(const gpu_image *image, const float color[4]);
bool vk_samplers_create(gpu *g);

// ---- destruction ------------------------------------------------------------------------------

typedef struct vk_retired {
    uint64_t serial; // dies when this submission has finished
    void (*destroy)(gpu *g, void *object);
    void *object;
} vk_retired;

void vk_retire(gpu *g, void (*destroy)(gpu *g, void *object), void *object); // from any thread
void vk_collect(gpu *g);     // destroys what no unfinished submission can use
void vk_collect_all(gpu *g); // the device is idle

// ---- commands ---------------------------------------------------------------------------------

typedef struct vk_sets { // of descriptors; none where these are pushed
    VkDescriptorPool *pools;
    size_t count, capacity;
    size_t taken; // sets, since the last reset
} vk_sets;

bool vk_sets_reset(gpu *g, vk_sets *sets); // no submission uses them any more
void vk_sets_free(gpu *g, vk_sets *sets);

typedef struct vk_batch {
    VkCommandPool pool;
    VkCommandBuffer commands;
    vk_sets sets;             // that the commands use
    uint64_t serial;          // of its last submission
    VkSemaphore wait, signal; // of the next one, beside the timeline; NULL: none. Transfers wait
    bool syncs;               // the next one waits for and signals what the host asked for
} vk_batch;

// A command buffer for queues of that family, and its pool.
bool vk_commands_create(gpu *g, uint32_t family, VkCommandPool *pool, VkCommandBuffer *commands);
bool vk_batch_create(gpu *g, vk_batch *out);
void vk_batch_destroy(gpu *g, vk_batch *batch);
bool vk_batch_begin(gpu *g, vk_batch *batch); // waits until it is free
bool vk_batch_submit(gpu *g, vk_batch *batch);
// The open command buffer; opens a batch when no frame is open. NULL when the device is lost.
VkCommandBuffer vk_commands(gpu *g);
bool vk_flush(gpu *g); // submits the batch between frames, if one is open
// Loses the device when none of its work was finished in gpu_desc.timeout.
bool vk_wait(gpu *g, uint64_t serial);
// Software drivers wait, without a limit, for all that was submitted in calls that should only ask
// or hand over. Before such a call: the same wait with a limit. Nothing on real devices.
bool vk_wait_where_driver_would(gpu *g);
uint64_t vk_completed(gpu *g);

// What one command touches: begin, use, ..., then flush records the barriers it needs.
void vk_uses_begin(gpu *g);
bool vk_use_image(gpu *g, gpu_image *image, uint32_t mip, uint32_t count, hazard_access access);
bool vk_use_buffer(gpu *g, gpu_buffer *buffer, hazard_access access);
void vk_uses_flush(gpu *g, VkCommandBuffer commands);
// What copies, clears and fills do to their source and destination.
extern const hazard_access vk_image_from, vk_image_to, vk_buffer_from, vk_buffer_to;

typedef struct vk_use {
    gpu_image *image; // or
    gpu_buffer *buffer;
    uint32_t mip;
} vk_use;

typedef struct vk_uses {
    vk_use *list;
    VkImageMemoryBarrier2 *images;
    VkBufferMemoryBarrier2 *buffers;
    size_t count, capacity, image_capacity, buffer_capacity;
    uint64_t stamp;
} vk_uses;

VkDescriptorType vk_descriptor_type(gpu_slot_kind kind);
// The same code for a driver that gains by it, for mem_free: with uniforms read once (hoist.c),
// with their blocks hidden (hide.c). NULL: there are none, or it is left as it is. Sizes in bytes;
// `*out_size` is set with the code only.
uint32_t *vk_hoist_uniforms(const uint32_t *code, size_t size, size_t *out_size);
uint32_t *vk_hide_uniforms(const uint32_t *code, size_t size, size_t *out_size);
// The same with each index into variables kept in bounds (clamp.c). `*out`, for mem_free, is NULL
// where all are; `*out_size` is set anyway. False, without a message, for what cannot be rewritten.
bool vk_clamp_indices(const uint32_t *code, size_t size, uint32_t **out, size_t *out_size);

// Validates bindings against the slots of a pipeline; then notes what they touch; then binds them.
bool vk_bindings_check(gpu *g, const gpu_pipeline *pipeline, const gpu_binding *list, size_t count);
bool vk_bindings_use(gpu *g, const gpu_pipeline *pipeline, const gpu_binding *list, size_t count);
bool vk_bindings_bind(gpu *g, VkCommandBuffer commands, const gpu_pipeline *pipeline,
                      const gpu_binding *list, size_t count);
bool vk_create_template(gpu *g, const gpu_pipeline *pipeline, vk_built *out); // by its layout

typedef struct vk_ring { // staging: positions only grow, the offset is the position modulo size
    gpu_buffer *buffer;
    uint64_t size, head, tail;
    struct {
        uint64_t head, serial;
    } marks[16]; // up to `head` is free once `serial` has finished
    uint32_t mark_count;
} vk_ring;

void vk_ring_mark(gpu *g); // after each submission

typedef struct vk_uniforms { // of one frame
    gpu_buffer **chunks;
    size_t count, capacity;
    size_t chunk;    // in use
    uint64_t offset; // in it
} vk_uniforms;

bool vk_uniforms_add(gpu *g, const void *data, size_t size, VkDescriptorBufferInfo *out);

typedef struct vk_timer { // of one frame
    VkQueryPool queries;
    uint32_t count;
    char labels[GPU_MAX_PASSES][64];
    VkEvent ends[GPU_MAX_PASSES]; // set when the pass has ended; made when first needed
    double began, longest;        // host clock; milliseconds no pass can exceed, 0: not known yet
} vk_timer;

bool vk_timer_create(gpu *g, vk_timer *out);
void vk_timer_destroy(gpu *g, vk_timer *timer);
void vk_timer_begin(gpu *g, vk_timer *timer, VkCommandBuffer commands);
// The first pass of an unfinished frame that has not ended, or NULL when that cannot be known.
const char *vk_timer_running(gpu *g, const vk_timer *timer);

typedef struct vk_frame {
    vk_batch batch;
    uint64_t number;
    vk_uniforms uniforms;
    vk_timer timer;
    VkSemaphore acquired; // the window's image is ours; NULL without a window
} vk_frame;

// ---- copies beside the frames -----------------------------------------------------------------

typedef struct vk_copier {
    int family; // -1: the device has no queue for copies alone, and nothing below is used
    VkQueue queue;
    VkSemaphore timeline;
    uint64_t submitted; // on that timeline
    uint64_t wait;      // the next submission to the other queue waits for this; 0: for nothing
} vk_copier;

// -1: none.
int vk_transfer_family_find(const vk_calls *vk, VkPhysicalDevice physical);
bool vk_copier_open(gpu *g);
void vk_copier_close(gpu *g); // the device is idle

// ---- the window -------------------------------------------------------------------------------

typedef struct vk_areas { // they may overlap
    gpu_area list[GPU_MAX_AREAS];
    uint32_t count;
} vk_areas;

typedef struct vk_swapchain {
    VkSwapchainKHR handle;
    VkExtent2D size;
    uint32_t count;
    VkImage images[VK_MAX_SHOWN];
    VkSemaphore drawn[VK_MAX_SHOWN]; // the frame that fills the image is done
    vk_areas missing[VK_MAX_SHOWN];  // where an image does not show what it should
    bool kept[VK_MAX_SHOWN];         // ... and elsewhere it shows that
    bool fitted;                     // the window took an image without complaint
    bool stale;                      // does not fit the window any more
} vk_swapchain;

typedef struct vk_window {
    gpu_window maker; // create_surface NULL: there is no window
    VkSurfaceKHR surface;
    VkSurfaceFormatKHR format; // of what is shown
    bool lost;                 // the surface
    VkSurfaceKHR old_surface;  // a lost one that may still be in use
    vk_swapchain *swapchain;   // NULL: none yet
    uint32_t image;            // of the swapchain, that the open frame shows ...
    bool shows;                // ... if it shows one
} vk_window;

bool vk_window_open(gpu *g, const gpu_window *window); // makes the surface
bool vk_window_prepare(gpu *g);                        // once the device is there
void vk_window_close(gpu *g);                          // the device is idle
// Inside a frame: retires a lost surface, and makes another one when that has gone.
// `window.surface` is NULL in between.
bool vk_window_revive(gpu *g);
// Makes a swapchain unless there is one that fits. `size` is taken where the window leaves the
// choice. VK_NOT_READY: the window has no area.
VkResult vk_swapchain_fit(gpu *g, VkExtent2D size);
bool vk_present(gpu *g); // hands the image of the submitted frame to the window, if it shows one

// ---- a host's device --------------------------------------------------------------------------

typedef struct vk_syncs { // of the open frame, with the host
    gpu_semaphore waits[GPU_MAX_SYNC], signals[GPU_MAX_SYNC];
    uint32_t wait_count, signal_count;
} vk_syncs;

// Takes over what the host gives: finds the calls, and describes its device. False with a message.
bool vk_host_open(gpu *g, const gpu_host *host, vk_choice *out);
// Forgets calls of extensions that the host has not enabled, which drivers may have all the same.
void vk_host_forget_calls(gpu *g, const gpu_host *host);
// Moves the frame's semaphores into a submission.
void vk_host_add_syncs(gpu *g, VkSemaphoreSubmitInfo *waits, uint32_t *wait_count,
                       VkSemaphoreSubmitInfo *signals, uint32_t *signal_count);
VkResult vk_host_submit(gpu *g, const VkSubmitInfo2 *info); // under the host's lock
// Lists the extensions that roil uses where a device has them. Returns how many there are.
uint32_t vk_host_extensions(const vk_calls *vk, VkPhysicalDevice physical, bool pushes,
                            const char *out[GPU_MAX_NEEDS]);

// ---- the device -------------------------------------------------------------------------------

struct gpu {
    gpu_info info;
    vk_calls vk;
    vk_instance instance; // no handle: the host's
    gpu_host host;        // device NULL: there is none
    vk_syncs syncs;
    _Atomic uint64_t messages;
    atomic_bool lost;
    atomic_bool loss_written; // `loss` is written
    char loss[512];           // how and where the device was lost
    bool hung;                // work did not finish in time, and may never
    uint64_t timeout;         // nanoseconds
    bool given_up;            // by `waiting` or gpu_give_up, sooner than that
    double stalled;           // clock_seconds when gpu_pending first saw no progress; 0: it did not
    bool (*waiting)(void *user, double seconds);
    void *waiting_user;
    pthread_t owner; // which calls it

    vk_window window;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    uint32_t timestamp_bits;
    VkPhysicalDeviceLimits limits;
    uint64_t max_allocation, max_buffer;
    VkPhysicalDeviceMemoryProperties heaps;
    VkFormatFeatureFlags format_features[GPU_FORMAT_COUNT];
    gpu_profile profile;
    bool draws_many;                                            // commands in buffers, at once
    PFN_vkCmdPushDescriptorSetWithTemplateKHR push_descriptors; // NULL: sets of the batch are bound
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
    PFN_vkSetDebugUtilsObjectNameEXT set_name;

    vk_pool pool;
    VkSampler samplers[GPU_SAMPLER_COUNT];

    pthread_mutex_t built_lock;
    vk_built *built[VK_BUILT_ROWS]; // by hash
    vk_built *idle[VK_BUILT_IDLE];  // of no pipeline any more; the oldest first
    uint32_t idle_count;

    VkPipelineCache cache;
    char *cache_path;
    uint64_t cache_hash; // of what the file holds

    vk_copier copier;
    VkSemaphore timeline;
    uint64_t submitted, completed; // serials
    _Atomic uint64_t open_serial;  // of the open command buffer, else the last submitted
    vk_frame frames[GPU_FRAMES_IN_FLIGHT];
    uint64_t frame_number; // of the last frame begun
    vk_frame *frame;       // open, or NULL
    vk_batch batches[VK_BATCHES];
    uint32_t batch_next;
    vk_batch *batch; // open between frames, or NULL
    bool host_reads; // the open command buffer writes memory that the host will read
    bool in_pass;
    vk_uses uses;
    vk_ring ring;

    pthread_mutex_t retire_lock;
    vk_retired *retired; // queue, oldest first
    size_t retired_first, retired_count, retired_capacity;
};

bool vk_cache_create(gpu *g, const char *dir);
void vk_cache_destroy(gpu *g); // saves it
bool vk_cache_pack(const void *data, size_t size, void **out, size_t *out_size);
const void *vk_cache_unpack(const void *file, size_t size, const VkPhysicalDeviceProperties *device,
                            size_t *out_size);
