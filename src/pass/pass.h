// Passes: work on the GPU. A pass is an instance of a shader file, built in or a user's own: what
// it takes, gives and can be tuned by is declared in the shader (shader/shader.h). A few built-in
// types add hooks in C: more than one dispatch, meshes, boxes computed on the host.
//
// Life: pass_create, any number of pass_set_*, pass_declare (into the graph), pass_build (shader
// and pipeline), pass_allocate, then per frame the graph records it.
#pragma once
#include "field/field.h"
#include "gpu/profile.h"
#include "graph/graph.h"
#include "kernel/kernel.h"
#include "scene/instances.h"

typedef struct pass pass;

typedef struct pass_grid { // an image of a grid that a pass of the graph fills
    const field_grid *grid;
    int index; // of the grid's images
    graph_image image;
} pass_grid;

typedef struct pass_host { // what all passes of one effect share
    gpu *device;           // NULL: declare only (check without a device)
    shader_library *library;
    graph *graph;
    arena *memory;
    const field_context *context;     // of the frame being recorded
    const struct frame_block *frame;  // of the frame being recorded
    const struct light_block *lights; // of the frame being recorded
    const scene *scene;               // for its sky
    struct scene_bvh *bvh;            // of all meshes; after pass_allocate
    struct pass_ranges *ranges;       // owned: of grids (pass/ranges.h)
    gpu_image *blue_noise;            // texture "BlueNoise" of lib/random.glsl
    gpu_image *given_depth;           // a host's depth buffer, of this frame; NULL: there is none
    float given_depths[2];            // by which its depths are metres: scene_lens.depths
    bool fresh;                       // histories begin with the frame being recorded
    bool ahead;       // the frame being recorded is not drawn: what simulates goes on alone
    bool hold;        // what simulates stays as it is
    bool brief;       // a submit is to be short, so that a window stays awake
    bool counters;    // compile counters in and read them
    bool interaction; // flows can be touched (pass/slices/slices_templates.h)
    const shader_reader *reader;                 // of all files of shaders; may be NULL
    bool (*before_declare)(void *user, pass *p); // last chance to change a pass; may be NULL
    void *user;
    pass_grid *grid_images; // owned: freed by pass_host_free
    size_t grid_image_count, grid_image_capacity;
    pass **declared; // owned: freed by pass_host_free
    size_t declared_count, declared_capacity;
    char warning[512]; // the first: a uniform beyond its range, lengths that do not fit; "": none
} pass_host;

// Makes passes whose fields sample that image of `grid` run after the pass that writes `image`.
void pass_host_add_grid_image(pass_host *host, const field_grid *grid, int index,
                              graph_image image);
void pass_host_free(pass_host *host);

struct checkpoint;
struct checkpoint_list;

typedef struct pass_readout { // what a pass can tell of itself
    const char *name, *unit;  // "Mach", ""
    double value;
} pass_readout;

// A type has one when its work goes on from frame to frame in steps of its own. `record` brings it
// toward the time of the frame, by as many steps as one submit may take.
typedef struct pass_simulation {
    int64_t (*left)(const pass *p, double time); // steps until it shows `time`; below 0: it is past
    int64_t (*most)(const pass *p);              // steps of one submit
    double (*reached)(const pass *p); // the latest time that it shows; -INFINITY: none yet
    void (*restart)(pass *p);         // begins anew with the next record
    // Called in a reload, before the new pass is allocated: exchanges the states of both. A second
    // call undoes it. False: they do not match. NULL: its grid does so.
    bool (*exchange)(pass *p, pass *other);
    // Write and read its state in a checkpoint (sim/checkpoint.h), after pass_allocate. When a
    // state does not load, the pass begins anew.
    void (*save)(const pass *p, struct checkpoint_list *out);
    bool (*load)(pass *p, struct checkpoint *from);
    // Fills in at most `capacity` and returns the count. Called after pass_allocate.
    size_t (*readouts)(const pass *p, pass_readout *out, size_t capacity);
    double (*work)(const pass *p);         // how much the last record brought a step on
    const char *work_name;                 // of what; NULL: "cell updates"
    const char *(*trouble)(const pass *p); // what is wrong and which key to change; NULL: nothing
} pass_simulation;

typedef enum pass_meshes_use { // what a type does with the meshes that it is given
    PASS_REFUSES_MESHES,
    PASS_DRAWS_MESHES, // rays meet them too
    PASS_USES_MESHES,  // as shapes that need not be seen
} pass_meshes_use;

typedef struct pass_kernel { // zero: the type's own shader, as it is
    const char *shader;      // NULL: the type's own; of what draws the fragment shader
    const char *vertex;      // of what draws; NULL: `shader` is a compute shader
    const char *define;      // defined as 1 in this kernel, and in no other of the type; NULL: none
    bool without_fields;     // it evaluates none: then its code is the same whatever they are
} pass_kernel;

typedef struct pass_defines { // of a kernel that is being compiled
    shader_define items[96];
    size_t count;
} pass_defines;

enum { PASS_BUFFERS = 16 };
typedef struct pass_buffer { // of a type's state
    gpu_buffer **at;
    const char *label;
    uint64_t size; // bytes; 0: it is not needed
} pass_buffer;

typedef struct pass_type {
    const char *name;   // "march"
    const char *shader; // "pass/march/march.comp"
    // What it runs. The first kernel is the one that user shaders have. NULL: hooks do its work. A
    // count of 0: the device runs nothing.
    const pass_kernel *kernels;
    size_t kernel_count;
    kernel_names names; // that its hooks use: of uniforms, options, fields, images and slots
    const kernel_table *solver; // whose slots its kernels may have (pass_solver_places); NULL: none
    pass_meshes_use meshes;
    bool unscaled;                     // what it writes has a size of its own
    bool runs_inside;                  // another pass runs it: it is not in the graph
    bool constructed;                  // by a function or method of Lua of its own, not by NAME { }
    const pass_simulation *simulation; // NULL: it does not simulate
    // Optional hooks.
    bool (*declare)(pass *p);  // instead of one image per output
    bool (*complete)(pass *p); // see pass_complete
    // Adds what a kernel is compiled with. False: it is left out until pass_make_kernel.
    bool (*defines)(pass *p, size_t index, pass_defines *out);
    // Returns whether frames may need a kernel, as far as that is known before the first. Other
    // kernels are compiled without a device alone, and built by pass_make_late. NULL: they need
    // all.
    bool (*foresees)(const pass *p, size_t index);
    // Says what a kernel that draws draws to: formats, depth, culling and blending.
    void (*target)(const pass *p, size_t index, gpu_graphics_desc *out);
    bool (*update)(pass *p); // numbers of a frame that the host computes, by pass_set
    // Instead of one pipeline; see pass_build. Without a device it compiles, and builds nothing.
    bool (*build)(pass *p);
    // Buffers of its state whose sizes are known once the graph is compiled: pass_allocate makes
    // those that are not there, pass_list_memory counts them, and they go with the pass.
    size_t (*buffers)(const pass *p, pass_buffer out[PASS_BUFFERS]);
    bool (*allocate)(pass *p); // besides what every pass needs; see pass_allocate
    void (*list_memory)(const pass *p, budget_list *out); // see pass_list_memory
    bool (*rehearse)(pass *p);                            // besides what every pass evaluates
    bool (*record)(pass *p); // instead of one dispatch over the first output
    void (*destroy)(pass *p);
} pass_type;

const pass_type *const *pass_types(size_t *count);
const pass_type *pass_type_find(const char *name); // NULL with a message that suggests

// Creates an instance of a built-in type, or of a shader file in the effect's folder (type NULL).
// `label` must be unique in the effect. NULL with a message.
pass *pass_create(pass_host *host, const pass_type *type, const char *shader, const char *label);
// Makes it stand for a pass of the type `other`: what only that type has may be set and is ignored,
// and its resolution stays 1.
bool pass_stand_for(pass *p, const pass_type *other);
bool pass_ignores(const pass *p, const char *name);
void pass_destroy(pass *p);
// Sets where the script made it, for messages: "file:line: ", or "", which it is at first.
void pass_set_place(pass *p, const char *place);
const char *pass_label(const pass *p);
const pass *pass_runner(const pass *p);        // the pass that it is a part of, else itself
bool pass_is(const pass *p, const char *type); // of the built-in type "march"
const shader_interface *pass_interface(const pass *p);

// Set what the script says. False with a message that names the pass and suggests the nearest right
// name.
bool pass_set_uniform(pass *p, const char *name, const field *value); // must not vary in space
bool pass_set_option(pass *p, const char *name, const char *word);
bool pass_set_field(pass *p, const char *name, const field *value);
bool pass_set_image(pass *p, const char *name, graph_image image);
extern const value_desc pass_scale_desc; // what pass_set_scale takes
bool pass_set_scale(pass *p,
                    float scale); // of its outputs, relative to the effect's output; (0, 1]
bool pass_set_format(pass *p, const char *output, gpu_format format);
bool pass_add_mesh(pass *p, scene_mesh *mesh); // of types that take them
size_t pass_meshes(const pass *p, scene_mesh *const **out);
bool pass_add_instances(pass *p, scene_instances *instances); // of types that take meshes
size_t pass_instances(const pass *p, scene_instances *const **out);
// Lets `p` take from `source`, a pass declared before, what it says nothing about itself, where
// both have something of that name and type: images that `p` reads and `source` writes; fields,
// options, and uniforms as they are in each frame. Of several sources the first that has it counts.
void pass_add_source(pass *p, pass *source);
// Does the same for uniforms alone, after pass_declare. A second call does no harm.
void pass_add_uniforms_of(pass *p, pass *source);
// Returns the pass that makes an image; NULL: none, or one declared later.
pass *pass_writer(const pass_host *host, graph_image image);
// Lets all passes but `but` read one image instead of another, after pass_declare.
void pass_redirect(pass_host *host, graph_image from, graph_image to, const pass *but);
// Returns whether a pass reads an image, or one that was made of it. Histories do not count.
bool pass_follows(const pass *p, graph_image image);
void pass_set_bake(pass *p, field_grid *grid); // bake only: the grid it fills
// Tells what `name` may be set as, for the generic setter of Lua and --set.
typedef enum pass_key { PASS_UNKNOWN, PASS_UNIFORM, PASS_OPTION, PASS_FIELD, PASS_IMAGE } pass_key;
pass_key pass_find_key(const pass *p, const char *name, size_t *index);
size_t pass_most_keys(const pass *p);                   // at least as many as there are
size_t pass_list_keys(const pass *p, const char **out); // such names; returns how many

bool pass_declare(pass *p); // checks that what is required is there; adds images and passes
// Called when all is declared, before check and build. A second call does nothing.
bool pass_complete(pass *p);
const pass_simulation *pass_get_simulation(const pass *p); // NULL: it does not simulate
bool pass_draws_meshes(const pass *p);
bool pass_traces_levels(const pass *p); // its rays meet meshes as they are simplified
// Compiles the shaders, all of them where the host has no device, and builds the pipelines where it
// has one. Any thread may do it; passes of one effect may be built side by side.
bool pass_build(pass *p);
// After pass_build: adds what the pass lacks of the device's memory, for pass_allocate and for
// frames. It counts its own memory only: the graph counts images, and the scene what
// `budget_list_first` is asked about. It leaves out what takes some texels, and what frames alone
// decide and are refused with the same message: masks of a body and values of a source that grow
// beyond what they are at first, and what a kernel reads that is built late (pass_make_late):
// ranges of grids, lists of shafts.
void pass_list_memory(const pass *p, budget_list *out);
// After pass_build, on the device's thread: allocates what the pass itself keeps on the device.
bool pass_allocate(pass *p);
// After pass_build: evaluates the numbers of a frame as recording it would. Any thread.
bool pass_rehearse(pass *p);
graph_image pass_input(const pass *p, const char *name);    // what it was given; zero: nothing
graph_image pass_output(const pass *p, const char *name);   // after pass_declare; zero when unknown
const field *pass_get_uniform(const pass *p, size_t index); // NULL: not set
// Returns what a uniform is while it is not set. `*declared` is its declaration, in this pass or in
// a source; the default there counts when the result is NULL.
const field *pass_inherited_uniform(const pass *p, size_t index, const value_desc **declared);
const field **pass_uniform_slot(pass *p, size_t index);    // where it is held, to be set unchecked
bool pass_refuse_uniform(const pass *p, const char *name); // the message for a name not known
const field *pass_get_field(const pass *p, size_t index);  // NULL: not given
size_t pass_get_option(const pass *p, size_t index);       // index of the chosen word
float pass_get_scale(const pass *p);
bool pass_is_scaled(const pass *p); // whether the scale means anything
// Reads the totals of a frame's counters after it finished: one value per counter of the interface.
bool pass_read_counters(pass *p, uint64_t *out);
// Returns whether it is a `reference`, and in `out` how many samples a pixel its picture holds
// after its last frame.
bool pass_samples(const pass *p, uint32_t *out);
