// The inside of a pass, for the files of this layer only.
#pragma once
#include "field/program.h"
#include "kernel/kernel.h"
#include "pass/pass.h"

typedef struct pass_provider pass_provider;

typedef struct pass_palette { // a palette's texture, one per pass that uses it
    const palette *source;
    gpu_image *image;
    double time;      // of its content; NAN: none yet
    uint32_t version; // of its content (palette_version)
} pass_palette;

typedef struct pass_parent { // where a uniform comes from while it is not set
    const pass *pass;        // NULL: it is its default
    size_t index;
} pass_parent;

struct pass {
    pass_host *host;
    const pass_type *type; // NULL: a user's shader
    const char *label, *shader, *place;
    const shader_interface *face;
    const shader_interface *stands_for; // of the type that it does; NULL: none

    // As set; one per entry of `face`.
    const field **uniforms; // NULL: the default
    bool *warned;           // of a uniform that went beyond its range
    size_t *options;
    bool *chosen;         // options that were set, or taken from a source
    const field **fields; // NULL: the default
    graph_image *images;  // inputs, and outputs once declared
    gpu_format *formats;  // outputs
    float scale;
    scene_mesh **meshes;
    size_t mesh_count, mesh_capacity;
    scene_instances **instances;
    size_t instances_count, instances_capacity;
    pass **sources; // asked, in order, for what this pass says nothing about
    size_t source_count, source_capacity;
    const pass *particles; // behind the input of that name; NULL: it has none
    struct pass_point_lights
        *point_lights; // of the input of that name (pass/light/point_lights.h); NULL: it has none

    // After pass_build.
    field_program *program;
    unsigned char *numbers; // the host's copy of "FieldNumbers"
    pass_palette *palettes;
    size_t palette_count;
    gpu_buffer *counters;
    gpu_image *blank[2]; // what missing optional inputs read: 2D, 3D
    gpu_image **unread;  // one per entry of `face`: what an optional output is while unread
    field_grid *baked;   // bake only: the grid it fills
    void *state;         // of the type's hooks
    gpu_buffer **buffers[PASS_BUFFERS]; // in it, since pass_allocate
    size_t buffer_count;
    bool completed;
    const struct pass_name *names; // what the type's names are in `face`
    int density;                   // of that name, in face->fields; -1: none
    pass_parent *parents;          // of uniforms (source.c); NULL: nothing is taken from others
    struct pass_built *built;      // kernels, as the type lists them, then those of providers
    size_t built_count;
    float (*values)[4]; // of uniforms, in this frame
    bool *wanted;       // of uniforms: a kernel or the type reads it
    pass *runs_in;      // the pass that builds and runs this one; NULL: the graph does
};

// Puts the line that made it before the message, unless one stands there. Always returns false.
bool pass_locate_error(const pass *p);

// Does what pass_build does, for a pass that runs in another.
bool pass_build_part(pass *p);

// ---- kernels ----------------------------------------------------------------------------------

// Add to a kernel's defines.
void pass_define(pass_defines *out, const char *name, const char *value);
void pass_define_number(pass *p, pass_defines *out, const char *name, uint32_t value);
void pass_define_flag(pass_defines *out, const char *name, bool value); // 1 or 0

// The kernels of a type or a provider: its table `kernels`, and KERNEL_NAMES.
#define PASS_KERNELS                                                                               \
    .kernels = kernels, .kernel_count = COUNT_OF(kernels), .names = {names, COUNT_OF(names)}

// Returns kernel `index` of the type's list and binds all that the pass itself knows: blocks,
// textures of fields, images, and what providers have. The type binds the rest by the numbers of
// its names. All numbers are 0 before pass_prepare. NULL with a message.
kernel *pass_use(pass *p, size_t index);
kernel *pass_get_kernel(pass *p, size_t index); // with what was bound last
// Does the same for kernel `index` of a provider that the pass uses. Its names are the provider's.
kernel *pass_use_provided(pass *p, const pass_provider *provider, size_t index);
bool pass_dispatch(pass *p, size_t index, uint32_t x, uint32_t y, uint32_t z); // and runs it
// Compiles and builds a kernel as the type's hooks want it now, inside or outside a frame, if that
// was not done yet or if `again` is set.
bool pass_make_kernel(pass *p, size_t index, bool again);
// Does the same after pass_prepare, and gives the kernel the numbers of the frame.
bool pass_make_late(pass *p, size_t index, bool again);
bool pass_has_kernel(const pass *p, size_t index); // it is built
// Returns whether a kernel, once it is compiled, reads more than numbers, fields and images: blocks
// of the frame, or what a provider has.
bool pass_reads_frame(const pass *p, size_t index);
// Returns whether a kernel that is compiled reads that texture of the fields.
bool pass_reads_texture(const pass *p, size_t texture);

// Returns where the names of the type's solver are in a kernel.
const kernel_place *pass_solver_places(const pass *p, size_t index);

// Numbers go to all kernels that have a uniform of that name, and names are numbers:
// KERNEL_NAME_ID.
void pass_set(pass *p, int name, const void *data, size_t size);
void pass_set_float(pass *p, int name, float value);
void pass_set_int(pass *p, int name, int32_t value);
void pass_set_box(pass *p, box3 box); // uniforms box_min and box_max; an empty box is a point

// Evaluates the uniforms of the interface at the context's time. pass_prepare does so once a frame.
bool pass_evaluate_values(pass *p);
const float *pass_vector(const pass *p, int name); // as evaluated last: 4 components
float pass_value(const pass *p, int name);
// Evaluates one at the context's time. False when a script's function failed.
bool pass_evaluate_now(const pass *p, int name, float out[4]);
// Return what else a type's names may be. A name that the shader does not declare as such is a bug.
size_t pass_option(const pass *p, int name); // index of the word that it has
bool pass_option_is(const pass *p, int name, const char *word);
uint32_t pass_option_number(const pass *p, int name);   // of words that are numbers
const field *pass_given_field(const pass *p, int name); // NULL: not given
bool pass_gives(const pass *p, int name); // it, or a source, says what that uniform is
// Whether a number can be above `limit`, or can be no more than that, as far as that is known
// before a frame: passes are built side by side, where no Lua may run.
bool pass_may_be(const pass *p, int name, float limit, bool above);
graph_image *pass_image(const pass *p, int name);
gpu_image *pass_get_image(const pass *p, int name); // on the device, in a frame; may be NULL

// What shaders may ask for by including a file of lib/: one row for each, in providers.c. A kernel
// that has a slot or uniform of a row's names is given it.
enum { PASS_PROVIDERS = 8, PASS_PROVIDER_DEFINES = 4, PASS_PROVIDER_VALUES = 8 };
struct pass_provider {
    kernel_names slots, uniforms;
    bool (*find)(pass *p); // when the pass is declared; may be NULL, as all of these
    size_t (*defines)(const pass *p, shader_define out[PASS_PROVIDER_DEFINES]);
    // Kernels of its own, with their names, that a pass has besides its type's where `uses` says
    // so. They are run by `prepare`, with pass_use_provided.
    const pass_kernel *kernels;
    size_t kernel_count;
    kernel_names names;
    bool (*uses)(const pass *p);
    bool (*wants)(const pass *p, size_t index); // false: that kernel is left out
    void (*target)(const pass *p, size_t index, gpu_graphics_desc *out);
    void (*list_memory)(const pass *p, budget_list *out); // see pass_list_memory
    bool (*prepare)(pass *p);                             // in a frame, before the pass's work
    // Fills in the uniforms, 32 bits each, once a frame for all kernels. False: it has none for
    // this pass.
    bool (*values)(const pass *p, uint32_t out[PASS_PROVIDER_VALUES]);
    bool (*bind)(pass *p, int slot, gpu_binding *out); // false: it has none for this pass
    uint32_t (*count)(const pass *p); // of what there is of it in this frame, for threads
    void (*destroy)(pass *p);
};
extern const pass_provider *const pass_providers[PASS_PROVIDERS];
extern const pass_provider pass_particles_provider, pass_point_lights_provider,
    pass_shadow_maps_provider;

// The rest of this part is for the core alone.
typedef struct pass_name { // what a type's name is in the interface; -1: not that
    int16_t uniform, option, field, image;
} pass_name;
bool pass_describe_stage(pass *p, const char *shader, shader_stage stage,
                         const pass_defines *defines, shader_compile_desc *out);
kernel_names pass_names_of(const pass *p); // the type's; none of a user's shader
void pass_find_names(pass *p);
bool pass_build_kernels(pass *p); // without a device only compiles them
void pass_destroy_kernels(pass *p);
void pass_copy_values(pass *p); // of uniforms into all kernels
// Find what a texture of the fields, or an image of the interface, is now.
bool pass_bind_texture(pass *p, size_t index, gpu_binding *out);
bool pass_bind_image(pass *p, size_t index, gpu_binding *out);

// ---- help for hooks ---------------------------------------------------------------------------

// Returns the word that an option has now; "": the pass has no such option.
const char *pass_word(const pass *p, const char *option);
bool pass_has_word(const pass *p, const char *option, const char *word);

// Returns the define MOST_THREADS of a shader that would have large groups: 512, or the next
// smaller power of two that the device allows.
const char *pass_most_threads(const pass *p);

// Returns whether the images of a pass that simulates are looked at in this frame, by the picture
// or by something else that simulates.
bool pass_is_watched(const pass *p);
// Whether what simulates has to wait: a field samples air that has not come to the frame yet. So
// who is faster changes nothing.
bool pass_waits(const pass *p);
bool pass_has_content(const pass *p); // all its images have, that are there
bool pass_clear_outputs(pass *p);     // to 0; always true

// Returns an image of a grid that fields sample, as it is now; NULL: there is none just now. A
// second set is the first when it is not blended.
gpu_image *pass_field_image(const pass *p, const field_texture *texture);
bool pass_prepare(pass *p); // uniforms, field numbers, palettes and counters of this frame
bool pass_run(pass *p);     // one dispatch or full-screen draw over the first output
bool pass_record(pass *p);  // both
// Returns that image of a grid; zero: it is not of the graph.
graph_image pass_grid_image(const pass_host *host, const field_grid *grid, int index);
int pass_find_image(const pass *p, const char *name);     // index in face->images, -1: none
size_t pass_image_index(const pass *p, const char *name); // the same; aborts where there is none
// Adds an image that the pass alone draws to, at its scale.
graph_image pass_add_target(pass *p, const char *name, gpu_format format);
// Adds an output of a size of its own. `desc` counts but for its format; its name may be NULL.
bool pass_add_output(pass *p, int name, graph_image_desc desc);
bool pass_declare_images(pass *p); // histories, and the other outputs at the pass's scale
// The same, with images of its own that it writes besides.
bool pass_add_to_graph_with(pass *p, const graph_image *more, size_t more_count);
// The same, with images of its own that it reads besides.
bool pass_add_to_graph_after(pass *p, const graph_image *more, size_t more_count);
bool pass_add_to_graph(pass *p); // reads and writes by its images and fields

// Forgets inputs of these names where they come from a pass that shows nothing but matte surfaces
// (matte.c), so that nobody makes or asks them.
void pass_drop_matte(pass *p, const char *surface, const char *emission);

// One of several passes of the graph that a pass consists of: "label.name".
typedef struct pass_part {
    const char *name;
    const graph_image *reads, *writes;
    size_t read_count, write_count;
    bool fields;       // it evaluates the pass's fields, and so reads the grids that they sample
    pass *const *with; // passes whose fields it evaluates too
    size_t with_count;
    bool simulates; // graph_pass_desc
    bool (*record)(pass *p);
} pass_part;
bool pass_add_part(pass *p, const pass_part *part);

// The box of a volume: of the pass's field "density" as of now; or whatever the grids hold that it
// samples. An error when it has no end. `pass_check_density` is for a pass that is being declared,
// when grids hold nothing yet.
const field *pass_density(const pass *p);
bool pass_check_density(const pass *p);
bool pass_density_box(const pass *p, box3 *box);
bool pass_density_box_of_grids(const pass *p, box3 *box);

// Who says that uniform of a pass: the pass itself or a source, whose `*index` it is then. It says
// nothing either, when nobody does.
const pass *pass_uniform_owner(const pass *p, size_t *index);
// The current value of a uniform, within its range; beyond it the user is told, once.
bool pass_evaluate_at(const pass *p, size_t index, float out[4]);
