// A small GPU interface over Vulkan 1.3: the only layer that knows Vulkan, and no Vulkan type
// leaves it.
//
// One `gpu` is one device with one queue. Work is recorded into the open frame in program order;
// barriers follow from what each dispatch or draw binds (gpu/hazard.c), so callers never write one.
// Destroyed objects die when the last frame that used them has finished. A `gpu` belongs to one
// thread at a time; gpu_pipeline_* may also be called from other threads.
//
// Errors (bad input, missing device, no device memory) are NULL or false plus err_get().
#pragma once
#include "base/budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct gpu gpu;
typedef struct gpu_image gpu_image;
typedef struct gpu_buffer gpu_buffer;
typedef struct gpu_pipeline gpu_pipeline;

// ---- device -----------------------------------------------------------------------------------

typedef enum gpu_kind { GPU_DISCRETE, GPU_INTEGRATED, GPU_VIRTUAL, GPU_CPU, GPU_OTHER } gpu_kind;

typedef struct gpu_info {
    char name[256];
    char driver[256]; // driver name and version, as the driver words it
    char uuid[37];    // "01234567-89ab-..."; the same after a restart; "" before Vulkan 1.2
    gpu_kind kind;
    uint64_t memory;            // bytes of the largest device-local heap
    uint64_t max_storage_range; // bytes of one storage buffer binding
    uint32_t api_major, api_minor;
    uint32_t subgroup_size;
    uint32_t subpixel_bits; // corners of triangles are drawn at places rounded to these
    float timestamp_period; // nanoseconds a tick; 0: no timestamps
    bool int64;             // shaders may use integers of 64 bits
    bool usable;            // has all that roil needs
    char missing[256];      // what it lacks, when not usable
} gpu_info;

// A window to show frames in, whichever library made it. It must outlive the device.
typedef struct gpu_window {
    const char *const *extensions; // of the Vulkan instance, that the surface needs
    uint32_t extension_count;
    // Makes the VkSurfaceKHR `*surface` of the VkInstance `instance`; again when it was lost. False
    // with a message.
    bool (*create_surface)(void *user, void *instance, void *surface);
    void *user;
} gpu_window;

// The Vulkan device of a program that embeds roil, which makes and destroys it. Handles are
// Vulkan's own, as pointers; those that need not be pointers there are numbers here.
typedef struct gpu_host {
    // Its vkGetInstanceProcAddr; NULL: that of the loader which roil is linked to.
    void (*(*get_proc)(void *instance, const char *name))(void);
    void *instance, *physical, *device;
    uint32_t family, index; // of the queue: graphics and compute
    const void *features;   // VkPhysicalDeviceFeatures2 and its chain, as enabled; NULL: what
                            // gpu_host_find_needs asks for
    const char *const *extensions; // of the device, as enabled; only read by gpu_create
    uint32_t extension_count;
    bool labels; // VK_EXT_debug_utils is enabled in the instance
    // Called around submissions to the queue, where others submit to it. Both or none.
    void (*lock)(void *user, uint32_t family, uint32_t index);
    void (*unlock)(void *user, uint32_t family, uint32_t index);
    void *user;
} gpu_host;

enum { GPU_MAX_NEEDS = 4, GPU_MAX_SYNC = 8 };
typedef struct gpu_host_needs {
    const char *extensions[GPU_MAX_NEEDS]; // of the device, those that it has; static
    uint32_t extension_count;
} gpu_host_needs;
// Tells what a host should make its device with. `core`, `v11`, `v12` and `v13` are Vulkan's
// structs of features, which are filled and chained in this order. False with a message: the device
// cannot run roil. Any thread.
bool gpu_host_find_needs(const gpu_host *host, void *core, void *v11, void *v12, void *v13,
                         gpu_host_needs *out);

typedef struct gpu_desc {
    const gpu_host *host;  // whose device to use; NULL: one of its own, as follows
    const char *device;    // part of a name (any case) or an index as `gpu_list` counts; NULL: best
    uint64_t memory;       // bytes that it may take of the device's memory; 0: as budget.h says
    const char *cache_dir; // folder of the pipeline cache; NULL: no cache
    bool validate; // Khronos validation with synchronization validation; also $ROIL_VALIDATE=1
    const gpu_window *window; // NULL: nothing is shown; else the device can present to it
    bool small;     // it has the limits of a small device (profile.h); also $ROIL_SMALL_DEVICE=1
    bool yields;    // threads of the driver are nicer than the caller, so that others go first
    double timeout; // seconds that submitted work may take before the device counts as lost; 0: 30,
                    // 300 on a software device
    // Called ten times a second by the thread that created the device, while that waits for work
    // that takes longer than a second. False gives the device up, as if it hung. May be NULL.
    bool (*waiting)(void *user, double seconds);
    void *user;
} gpu_desc;

// Devices the loader offers, real GPUs before software ones, at most `capacity` written.
// Returns the count, or -1 with a message when there is no Vulkan loader or driver.
int gpu_list(gpu_info *out, int capacity);

gpu *gpu_create(const gpu_desc *desc);
// Waits for the device; saves the pipeline cache. A device whose work does not end is left as it is
// to the end of the process.
void gpu_destroy(gpu *g);
bool gpu_left_any(void); // such a device; any thread
const gpu_info *gpu_get_info(const gpu *g);
// Messages of severity warning or error that the validation layers gave so far.
uint64_t gpu_validation_messages(const gpu *g);
// The device is gone, or did not finish in time; all that can be done is gpu_destroy. The message
// of the call that found it out names the pass that was running, where that is known.
bool gpu_is_lost(const gpu *g);

typedef struct gpu_memory_use {
    uint64_t used, reserved; // bytes handed out, bytes taken from the driver
    uint32_t blocks;
} gpu_memory_use;
gpu_memory_use gpu_get_memory_use(const gpu *g);
// What its images and buffers are taken from before they are made: a budget of its own, or the
// host's where the device shares the host's memory.
budget *gpu_get_budget(const gpu *g);

// ---- resources --------------------------------------------------------------------------------

typedef enum gpu_format {
    GPU_FORMAT_NONE,
    GPU_R8,
    GPU_RGBA8,
    GPU_RGBA8_SRGB, // sampled only
    GPU_R16F,
    GPU_RG16F,
    GPU_RGBA16F,
    GPU_R32F,
    GPU_RG32F,
    GPU_RGBA32F,
    GPU_R32U,
    GPU_D32F, // depth target
    GPU_FORMAT_COUNT
} gpu_format;

uint32_t gpu_format_size(gpu_format format);       // bytes a texel
const char *gpu_format_name(gpu_format format);    // "rgba16f", as GLSL writes it
gpu_format gpu_format_from_name(const char *name); // GPU_FORMAT_NONE when unknown
uint32_t gpu_format_channels(gpu_format format);

typedef enum gpu_image_use {
    GPU_USE_SAMPLED = 1, // read with a sampler
    GPU_USE_STORAGE = 2, // read or written by image load and store
    GPU_USE_TARGET = 4,  // drawn to (colour or depth)
} gpu_image_use;

typedef struct gpu_image_desc {
    const char *label; // for messages and debuggers; copied
    gpu_format format;
    uint32_t width, height, depth; // texels; depth 0: 2D image, 1 or more: 3D image
    uint32_t mips;                 // 0 means 1
    uint32_t use;                  // gpu_image_use bits
} gpu_image_desc;

uint64_t gpu_image_bytes(const gpu_image_desc *desc); // of all mip levels
// Whether the device's memory has room for all of these, if `freed` bytes were let go before; false
// with a message that has the sum.
bool gpu_memory_fits(gpu *g, const budget_list *wanted, uint64_t freed);
// These images are about to go: until this is called with none, others may be made beside them.
void gpu_lend_memory(gpu *g, const gpu_image_desc *going, size_t count);
gpu_image *gpu_image_create(gpu *g, const gpu_image_desc *desc); // contents undefined
void gpu_image_destroy(gpu *g, gpu_image *image);                // NULL is fine
const gpu_image_desc *gpu_image_get_desc(const gpu_image *image);

// Replaces mip level `mip`; `data` is tightly packed and copied before the call returns. Later
// dispatches see it. May be called with or without an open frame.
bool gpu_image_write(gpu *g, gpu_image *image, uint32_t mip, const void *data, size_t size);
// Reads mip 0 back, waiting for all submitted work. Not inside a frame.
bool gpu_image_read(gpu *g, gpu_image *image, void *out, size_t size);

typedef enum gpu_buffer_kind {
    GPU_BUFFER_DEVICE,   // storage buffer in device memory
    GPU_BUFFER_READBACK, // host-visible, cached: the target of copies, read by the host
} gpu_buffer_kind;

typedef struct gpu_buffer_desc {
    const char *label;
    uint64_t size; // bytes
    gpu_buffer_kind kind;
} gpu_buffer_desc;

gpu_buffer *gpu_buffer_create(gpu *g, const gpu_buffer_desc *desc);
// Makes a buffer in device memory. One of that size stays, another is replaced; at size 0 nothing
// is done. False with a message.
bool gpu_buffer_make(gpu *g, gpu_buffer **buffer, const char *label, uint64_t size);
void gpu_buffer_destroy(gpu *g, gpu_buffer *buffer);
uint64_t gpu_buffer_size(const gpu_buffer *buffer);
bool gpu_buffer_write(gpu *g, gpu_buffer *buffer, uint64_t offset, const void *data, size_t size);
bool gpu_buffer_read(gpu *g, gpu_buffer *buffer, uint64_t offset, void *out, size_t size); // waits
// Host address of a readback buffer; valid data once the frame that copied into it has finished.
const void *gpu_buffer_map(gpu_buffer *buffer);

// ---- transfers --------------------------------------------------------------------------------

// Host memory that is copied into images beside the frames, on a queue of its own where the device
// has one: for what is too large to be written within a frame.
typedef struct gpu_transfer gpu_transfer;

enum { GPU_TRANSFER_ALIGN = 16 };

typedef struct gpu_transfer_part {
    gpu_image *image; // 3D: the first `slices` of its mip 0 are replaced, the others lose contents
    uint64_t offset;  // of its bytes in the transfer, tightly packed; of GPU_TRANSFER_ALIGN
    uint32_t slices;
} gpu_transfer_part;

gpu_transfer *gpu_transfer_create(gpu *g, uint64_t size); // bytes
void gpu_transfer_destroy(gpu *g, gpu_transfer *t);       // waits for its copies; NULL is fine
uint64_t gpu_transfer_size(const gpu_transfer *t);
// Any thread may write there, unless copies are under way.
void *gpu_transfer_map(gpu_transfer *t);
// Begins the copies, with or without an open frame; a frame that is open must not have used the
// images. They can be bound again after gpu_transfer_finish.
bool gpu_transfer_start(gpu *g, gpu_transfer *t, const gpu_transfer_part *parts, size_t count);
bool gpu_transfer_done(gpu *g, const gpu_transfer *t); // no copies are under way
// What is recorded from here on sees the images; never waits on the host.
bool gpu_transfer_finish(gpu *g, gpu_transfer *t);

// ---- pipelines --------------------------------------------------------------------------------

typedef enum gpu_slot_kind {
    GPU_SLOT_UNIFORM, // uniform block
    GPU_SLOT_STORAGE_BUFFER,
    GPU_SLOT_SAMPLED_IMAGE, // sampler2D, sampler3D
    GPU_SLOT_STORAGE_IMAGE,
} gpu_slot_kind;

enum { GPU_MAX_SLOTS = 32, GPU_MAX_TARGETS = 8 };

typedef enum gpu_stage { GPU_STAGE_ALL, GPU_STAGE_VERTEX, GPU_STAGE_FRAGMENT } gpu_stage;

typedef struct gpu_slot { // one binding of descriptor set 0, as reflection found it
    uint32_t binding;
    gpu_slot_kind kind;
    bool reads, writes; // of storage slots; uniform and sampled slots read
    gpu_stage stage;    // of a pipeline that draws: which stage sees it
} gpu_slot;

typedef struct gpu_compute_desc {
    const char *label;
    const uint32_t *code; // SPIR-V
    size_t code_size;     // bytes
    const gpu_slot *slots;
    size_t slot_count;
    uint32_t local_size[3]; // of the shader, so that dispatches count threads
} gpu_compute_desc;

typedef enum gpu_cull { GPU_CULL_NONE, GPU_CULL_BACK } gpu_cull;

typedef struct gpu_graphics_desc { // vertices are pulled from storage buffers: no vertex input
                                   // state
    const char *label;
    const uint32_t *vertex_code, *fragment_code;
    size_t vertex_size, fragment_size;
    const gpu_slot *slots; // union of both stages
    size_t slot_count;
    gpu_format colors[GPU_MAX_TARGETS]; // of the targets; GPU_FORMAT_NONE ends the list
    gpu_format depth; // GPU_FORMAT_NONE: no depth test; else test less-equal and write
    gpu_cull cull;    // front faces are counter-clockwise seen in the picture
    bool blend;       // colours are premultiplied and laid over what is there
} gpu_graphics_desc;

// Pipelines are shared: a description equal to one that is still alive, or was until lately, costs
// no compile. Each create has its own destroy.
gpu_pipeline *gpu_pipeline_create_compute(gpu *g, const gpu_compute_desc *desc);
gpu_pipeline *gpu_pipeline_create_graphics(gpu *g, const gpu_graphics_desc *desc);
void gpu_pipeline_destroy(gpu *g, gpu_pipeline *pipeline);

// ---- frames -----------------------------------------------------------------------------------

// A window that is drawn takes up to three: the effect, the inspected image, the interface.
enum { GPU_FRAMES_IN_FLIGHT = 4, GPU_MAX_PASSES = 256 };

// Opens a frame, waiting for the one GPU_FRAMES_IN_FLIGHT before it. Returns its number (from 1),
// or 0 when the device is lost.
uint64_t gpu_frame_begin(gpu *g);
bool gpu_frame_end(gpu *g);                  // submits
bool gpu_frame_wait(gpu *g, uint64_t frame); // until that frame has finished
bool gpu_frame_done(gpu *g, uint64_t frame); // it has finished; never waits
uint64_t gpu_frame_open(const gpu *g);       // number of the open frame; 0: none is
bool gpu_idle(gpu *g);                       // until all has finished
// How many submissions have not finished. Never waits; a device that is asked again and again and
// has finished nothing for gpu_desc.timeout counts as lost.
uint64_t gpu_pending(gpu *g);
void gpu_give_up(gpu *g); // what it works on hangs: the device counts as lost

// Brackets the work of one pass: its GPU time is measured and debuggers see the label.
void gpu_pass_begin(gpu *g, const char *label);
void gpu_pass_end(gpu *g);
// Within a pass: what follows is timed as a pass of its own. The same label again changes nothing.
void gpu_pass_next(gpu *g, const char *label);

typedef struct gpu_pass_time {
    char label[64];
    double milliseconds;
} gpu_pass_time;
// Times of a frame in order of recording, at most `capacity`. Waits for the frame; only the last
// GPU_FRAMES_IN_FLIGHT frames are kept (count 0 for older ones).
size_t gpu_frame_times(gpu *g, uint64_t frame, gpu_pass_time *out, size_t capacity);

typedef enum gpu_sampler {
    GPU_LINEAR_CLAMP,
    GPU_NEAREST_CLAMP,
    GPU_LINEAR_REPEAT,
    GPU_LINEAR_ZERO, // outside the image: 0 (transparent black border)
    GPU_SAMPLER_COUNT
} gpu_sampler;

typedef struct gpu_binding {
    uint32_t binding;
    gpu_image *image;    // image slots
    uint32_t mip;        // storage images, and sampled ones when one_mip
    bool one_mip;        // sampled: bind only `mip` (false: all levels)
    gpu_sampler sampler; // sampled images
    gpu_buffer *buffer;  // storage buffer slots, whole buffer
    const void *uniform; // uniform slots: copied at once
    size_t uniform_size; // bytes
} gpu_binding;

typedef struct gpu_dispatch_desc {
    gpu_pipeline *pipeline;
    const gpu_binding *bindings;
    size_t binding_count; // every slot of the pipeline must be bound
    uint32_t threads[3];  // invocations wanted; 0 means 1
} gpu_dispatch_desc;
bool gpu_dispatch(gpu *g, const gpu_dispatch_desc *desc);

enum { GPU_MAX_AREAS = 8 };
typedef struct gpu_area { // of an image, pixels
    uint32_t x, y, width, height;
} gpu_area;

// What the device reads where the numbers of a draw are left to it. `first_instance` is 0 where
// gpu_limits.first_instance (profile.h) is false.
typedef struct gpu_draw_command { // without indices
    uint32_t vertices, instances, first_vertex, first_instance;
} gpu_draw_command;

typedef struct gpu_draw_indexed_command {
    uint32_t indices, instances, first_index, vertex_offset, first_instance;
} gpu_draw_indexed_command;

typedef struct gpu_draw { // one draw call inside a gpu_draw_desc
    const gpu_binding *bindings;
    size_t binding_count;
    uint32_t vertices;     // how many times the vertex shader runs; of indices: how many are drawn
    uint32_t first_vertex; // what gl_VertexIndex begins with; of indices: the first of them
    uint32_t instances;    // 0 means 1
    gpu_buffer *indices;   // of 32 bits, which gl_VertexIndex runs through; NULL: none
    gpu_buffer *commands;  // a command that is read by the device instead of these numbers ...
    uint64_t command;      // ... from this byte on, a multiple of 4; NULL: there is none
    uint32_t commands_drawn; // so many, one behind the other; 0 means 1
    uint32_t viewport[4];    // x, y, width, height in pixels; width 0: the whole target
    uint32_t scissor[4];     // the same; width 0: the viewport
} gpu_draw;

typedef struct gpu_draw_desc {
    gpu_pipeline *pipeline;
    gpu_image *colors[GPU_MAX_TARGETS]; // targets, mip 0; NULL ends the list
    gpu_image *depth;
    bool clear; // clear before drawing: colours to clear_color[i], depth to clear_depth
    float clear_color[GPU_MAX_TARGETS][4];
    float clear_depth;
    const gpu_draw *draws;
    size_t draw_count; // 0 just clears
} gpu_draw_desc;
bool gpu_draw_all(gpu *g, const gpu_draw_desc *desc);

// Inside a frame, once: shows the image (mip 0, 2D, encoded for display) in the window, scaled to
// it, when the frame is done. Outside of `changed` it is the image that was shown last, as it was
// then; NULL: nothing is known of that. Waits for the display's turn. A window without an area
// (minimised), and one whose surface is being replaced, is passed over. False when the device or
// surface is lost.
bool gpu_present(gpu *g, gpu_image *image, const gpu_area *changed, size_t count);

// ---- images and semaphores of a host ----------------------------------------------------------

typedef struct gpu_semaphore {
    uint64_t handle; // VkSemaphore
    uint64_t value;  // of a timeline; of a binary one it does not count
} gpu_semaphore;
// The open frame waits for these before it begins, and signals those when all its work is done.
// False with a message: they are more than GPU_MAX_SYNC, with what was asked for before.
bool gpu_frame_sync(gpu *g, const gpu_semaphore *waits, size_t wait_count,
                    const gpu_semaphore *signals, size_t signal_count);

typedef struct gpu_host_image {
    uint64_t image; // VkImage, of one level and one layer; 0: none
    int format;     // VkFormat
    uint32_t width, height;
    int before, after; // VkImageLayout: as it is handed over, and as it is given back
    bool external;     // it is given to another process or API, and never comes back with content
    const char *label; // for messages
} gpu_host_image;
// An image over a host's image of depths, in an open frame, for shaders to sample. NULL with a
// message. Whoever borrows it gives it back in the same frame, which destroys it.
gpu_image *gpu_image_borrow(gpu *g, const gpu_host_image *from);
void gpu_image_give_back(gpu *g, gpu_image *borrowed, const gpu_host_image *to);
// In an open frame: copies an image of colours to a host's, scaled and converted where these
// differ. `from` NULL: only the layout changes.
bool gpu_image_hand_out(gpu *g, gpu_image *from, const gpu_host_image *to);

// ---- for other processes ----------------------------------------------------------------------

typedef struct gpu_shared { // an image with memory of its own, or a semaphore, that others can open
    uint64_t image;         // VkImage, to copy to and to be sampled; 0: it is a semaphore
    uint64_t semaphore;     // VkSemaphore, a timeline
    int fd;                 // opaque; whoever imports or closes it owns it
    uint64_t size;          // bytes of the image's memory, which is for it alone
    uint32_t type;          // of the memory, among those of the device
    uint8_t device[16], driver[16]; // UUIDs that whoever imports it must have, too
    void *inside;
} gpu_shared;
// False with a message, as where the device cannot share such a thing.
bool gpu_share_image(gpu *g, int format, uint32_t width, uint32_t height, gpu_shared *out);
bool gpu_share_semaphore(gpu *g, gpu_shared *out);
void gpu_unshare(gpu *g, gpu_shared *shared); // once no submission uses it; `fd` is not closed

void gpu_image_clear(gpu *g, gpu_image *image, const float color[4]); // inside a frame, all mips
void gpu_buffer_fill(gpu *g, gpu_buffer *buffer, uint32_t word);      // inside a frame
// Copies mip 0, tightly packed, to `offset` of the buffer.
bool gpu_image_copy_to_buffer(gpu *g, gpu_image *image, gpu_buffer *buffer, uint64_t offset);
bool gpu_buffer_copy(gpu *g, gpu_buffer *from, gpu_buffer *to, uint64_t size); // from the beginning
// Copies mip 0 between two images of one format and size: all of it, or the areas, of which each
// must lie inside.
bool gpu_image_copy(gpu *g, gpu_image *from, gpu_image *to);
bool gpu_image_copy_areas(gpu *g, gpu_image *from, gpu_image *to, const gpu_area *areas,
                          size_t count);
