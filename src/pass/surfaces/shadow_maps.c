// Maps of what stands before the lights: views are placed (those of sun and spots on the host,
// those of the point lights that matter most on the device, where point lights move), then meshes
// and instances are drawn in each, into one atlas.
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "pass/surfaces/drawn.h"
#include "pass/surfaces/shadow_maps_parts.h"
#include "scene/surfaces.h"
#include <string.h>

enum {
    FACES = 6,         // of a cube
    TABLE_WIDTH = 8,   // texels of a row of `shadow_views`, in shadow_maps/views.glsl
    LARGEST = 1 << 14, // edge of an image
};

enum { MAPS_PLACE, MAPS_DRAW, MAPS_CHOOSE, MAPS_KERNELS = MAPS_CHOOSE + DRAWN_STEPS };

static const pass_kernel kernels[MAPS_KERNELS] = {
    [MAPS_DRAW] = {.vertex = "pass/surfaces/shadow_maps.vert",
                   .shader = "pass/surfaces/shadow_maps.frag"},
    DRAWN_KERNELS(MAPS_CHOOSE),
};

static const char *const names[] = {SHADOW_MAPS_NAMES(KERNEL_NAME_TEXT)};

typedef struct shadow_state {
    uint32_t declared; // lights of the scene, its sun among them
    uint32_t cascades, points;
    uint32_t fixed, views; // of sun and spots; all
    int spots[LIGHT_MAX];  // view of each light, -1: none
    uint32_t sizes[DRAWN_MAX_VIEWS], places[DRAWN_MAX_VIEWS][4], atlas[2];
    struct shadow_view now[DRAWN_MAX_VIEWS]; // the fixed ones of this frame
    bool wide[LIGHT_MAX];                    // spots too wide for a view
    bool holes;                              // a fragment may be one
    bool lights;                             // somebody looks for other lights than point lights
    drawn *drawn;
    gpu_buffer *placed; // the views, as the device has placed them
    bool known;         // what the maps hold follows from `content`
    hash128 content;
} shadow_state;

static shadow_state *state_of(const pass *p) {
    return p->state;
}

// ---- declaring --------------------------------------------------------------------------------

static void add_views(shadow_state *s, uint32_t count, uint32_t size) {
    for (uint32_t i = 0; i < count; i++) s->sizes[s->views++] = size;
}

// Rows of the images that say so.
static uint32_t count_lights(const pass *p) {
    const graph_image lights = *pass_image(p, N_lights),
                      point_lights = *pass_image(p, N_point_lights);
    const graph *g = p->host->graph;
    return (lights.id ? graph_get_desc(g, lights)->height : state_of(p)->declared) +
           (point_lights.id ? graph_get_desc(g, point_lights)->height : 0);
}

// Spots that there is no room for have no map.
static void list_views(pass *p) {
    shadow_state *s = state_of(p);
    const scene *around = p->host->scene;
    s->declared = around ? (uint32_t)around->light_count + 1 : 1;
    s->cascades = pass_option_number(p, N_cascades);
    s->points = pass_option_number(p, N_points);
    add_views(s, s->cascades, pass_option_number(p, N_size));
    uint32_t most = DRAWN_MAX_VIEWS - FACES * s->points, competing = count_lights(p) - 1;
    for (uint32_t i = 0; i < s->declared; i++) {
        bool spot = i && around->lights[i - 1].kind == SCENE_SPOT, fits = spot && s->views < most;
        s->spots[i] = fits ? (int)s->views : -1;
        add_views(s, fits, pass_option_number(p, N_spot_size));
        competing -= spot;
    }
    if (s->points > competing) s->points = competing;
    s->fixed = s->views;
    add_views(s, FACES * s->points, pass_option_number(p, N_point_size));
}

// The large ones first.
static bool place_views(pass *p) {
    shadow_state *s = state_of(p);
    uint32_t order[DRAWN_MAX_VIEWS], sizes[DRAWN_MAX_VIEWS], places[DRAWN_MAX_VIEWS][4];
    uint32_t count = 0;
    for (uint32_t size = LARGEST; size; size /= 2)
        for (uint32_t i = 0; i < s->views; i++)
            if (s->sizes[i] == size) order[count] = i, sizes[count++] = size;
    if (!shadow_maps_pack(sizes, count, LARGEST, places, s->atlas))
        return err_set("%s: an atlas of %ux%u texels; at most %d are possible: choose smaller "
                       "maps, or fewer",
                       p->label, s->atlas[0], s->atlas[1], LARGEST);
    for (uint32_t i = 0; i < count; i++) memcpy(s->places[order[i]], places[i], sizeof places[i]);
    return true;
}

// What is drawn is what the sources draw, where nothing else is given.
static bool take_meshes(pass *p) {
    bool given = p->mesh_count > 0 || p->instances_count > 0;
    for (size_t i = 0; i < p->source_count && !given; i++) {
        const pass *source = p->sources[i];
        for (size_t k = 0; k < source->mesh_count; k++)
            if (!pass_add_mesh(p, source->meshes[k])) return false;
        for (size_t k = 0; k < source->instances_count; k++)
            if (!pass_add_instances(p, source->instances[k])) return false;
    }
    return true;
}

static bool add_image(pass *p, int name, gpu_format format, uint32_t width, uint32_t height) {
    graph_image *image = pass_image(p, name);
    *image = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, names[name]),
                            .format = format,
                            .width = width,
                            .height = height,
                            .target = format == GPU_D32F,
                            .keep = true,
                        });
    return image->id != 0;
}

// Depths are compared and places are exact to a texel: no other format holds them.
static bool check_formats(const pass *p) {
    for (size_t i = 0; i < p->face->image_count; i++)
        if (p->formats[i] != p->face->images[i].format)
            return err_set("%s: 'format' is that of its maps and cannot be chosen", p->label);
    return true;
}

static bool has_holes(scene_mesh *const *meshes, size_t count) {
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < meshes[i]->data.part_count; k++)
            if (surface_has_holes(&meshes[i]->data, &meshes[i]->data.parts[k])) return true;
    return false;
}

// Where there are none, no fragment needs to be looked at, and a GPU draws several times faster.
static bool draws_holes(const pass *p) {
    bool found = has_holes(p->meshes, p->mesh_count);
    for (size_t i = 0; i < p->instances_count && !found; i++) {
        scene_mesh *const *kinds;
        size_t count = scene_instances_kinds(p->instances[i], &kinds);
        found = has_holes(kinds, count);
    }
    return found;
}

static bool maps_declare(pass *p) {
    shadow_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    p->point_lights = NULL; // of point lights the image is all that is read
    list_views(p);
    if (!check_formats(p) || !place_views(p) || !take_meshes(p)) return false;
    uint32_t rows = 1 + s->views + (count_lights(p) + TABLE_WIDTH - 1) / TABLE_WIDTH;
    s->holes = draws_holes(p);
    s->drawn = drawn_create(p, MAPS_CHOOSE, !s->holes);
    return add_image(p, N_shadow_atlas, GPU_D32F, s->atlas[0], s->atlas[1]) &&
           add_image(p, N_shadow_views, GPU_RGBA32F, TABLE_WIDTH, rows) && pass_add_to_graph(p);
}

// What readers that ask rays have no use for is not drawn. Who else is there asks for all.
static bool maps_complete(pass *p) {
    shadow_state *s = state_of(p);
    const uint32_t atlas = pass_image(p, N_shadow_atlas)->id;
    size_t readers = 0, looking = 0;
    for (size_t i = 0; i < p->host->declared_count; i++) {
        const pass *reader = p->host->declared[i];
        for (size_t k = 0; k < reader->face->image_count && reader != p; k++) {
            if (reader->images[k].id != atlas) continue;
            readers++;
            looking += !pass_has_word(reader, "shadows_by", "rays"); // a user's shader, too
        }
    }
    s->lights = readers == 0 || looking > 0;
    return true;
}

// ---- building ---------------------------------------------------------------------------------

static bool maps_defines(pass *p, size_t index, pass_defines *out) {
    const shadow_state *s = state_of(p);
    if (index == MAPS_DRAW) pass_define_flag(out, "HOLES", s->holes);
    if (index != MAPS_PLACE) return true;
    pass_define_number(p, out, "SHADOW_FIXED", s->fixed);
    pass_define_number(p, out, "SHADOW_VIEWS", s->views);
    pass_define_number(p, out, "SHADOW_POINTS", s->points);
    return true;
}

static void maps_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)p, (void)index;
    out->depth = GPU_D32F;
}

static bool maps_allocate(pass *p) {
    shadow_state *s = state_of(p);
    if (!s->placed)
        s->placed = gpu_buffer_create(
            p->host->device,
            &(gpu_buffer_desc){.label = "views of shadows",
                               .size = (s->views + 1) * sizeof(struct view_entry)});
    return s->placed && drawn_allocate(s->drawn);
}

static void maps_list_memory(const pass *p, budget_list *out) {
    const shadow_state *s = state_of(p);
    drawn_list_memory(s->drawn, s->views, out);
}

static void maps_destroy(pass *p) {
    shadow_state *s = state_of(p);
    if (!s) return;
    drawn_destroy(s->drawn);
    gpu_buffer_destroy(p->host->device, s->placed);
}

// ---- in a frame -------------------------------------------------------------------------------

// Texels at the edges of a view that a look from within it may ask for.
static float margin_of(const pass *p) {
    return pass_value(p, N_shadow_radius) + 2;
}

static bool is_dark(const struct light_entry *light) {
    const float *c = light->color.v;
    return c[0] <= 0 && c[1] <= 0 && c[2] <= 0;
}

static bool needs_sun(const pass *p) {
    return state_of(p)->lights && !is_dark(&p->host->lights->lights[0]);
}

// One that does not shine has views of nothing.
static void place_sun(pass *p, const struct light_entry *sun) {
    shadow_state *s = state_of(p);
    const struct frame_block *frame = p->host->frame;
    float ends[DRAWN_MAX_VIEWS], far = pass_value(p, N_distance), near;
    memset(s->now, 0, s->cascades * sizeof *s->now);
    if (!needs_sun(p)) return;
    far = fminf(far, frame->lens.v[3]);
    near = fminf(fmaxf(frame->lens.v[2], far * 2e-3f), 0.5f * far);
    shadow_maps_split(near, far, pass_value(p, N_split), s->cascades, ends);
    for (uint32_t i = 0; i < s->cascades; i++)
        shadow_maps_cascade(frame, sun->position.v, i ? ends[i - 1] : 0, ends[i],
                            SHADOW_REACH * far, s->sizes[i], margin_of(p), &s->now[i]);
}

static void place_spots(pass *p) {
    shadow_state *s = state_of(p);
    float far = pass_value(p, N_distance);
    for (uint32_t i = 1; i < s->declared; i++) {
        int view = s->spots[i];
        if (view < 0) continue;
        s->now[view] = (struct shadow_view){0};
        if (!s->lights) continue;
        s->wide[i] = !shadow_maps_spot(&p->host->lights->lights[i], far, s->sizes[view],
                                       margin_of(p), &s->now[view]);
    }
}

// As fixed_lights of the shader has them: a light that has views, is too wide for one, or competes.
static void set_lights(pass *p) {
    const shadow_state *s = state_of(p);
    float lights[LIGHT_MAX][4] = {{0, needs_sun(p) ? (float)s->cascades : 0}};
    for (uint32_t i = 1; i < LIGHT_MAX && s->lights; i++) {
        bool spot = i < s->declared && p->host->lights->lights[i].color.v[3] == LIGHT_SPOT;
        bool seen = spot && s->spots[i] >= 0 && !s->wide[i];
        lights[i][0] = seen ? (float)s->spots[i] : 0;
        lights[i][1] = seen ? 1 : spot ? 0 : -1;
    }
    pass_set(p, N_fixed_lights, lights, sizeof lights);
}

static bool maps_update(pass *p) {
    shadow_state *s = state_of(p);
    uint32_t count = p->host->lights->count.v[0];
    if (count != s->declared)
        return err_set("%s: made for %u lights (the sun is one), but the effect has %u; set "
                       "'lights' of the effect before it",
                       p->label, s->declared, count);
    place_sun(p, &p->host->lights->lights[0]);
    place_spots(p);
    float places[DRAWN_MAX_VIEWS][4];
    for (uint32_t i = 0; i < s->views; i++)
        for (int k = 0; k < 4; k++) places[i][k] = (float)s->places[i][k];
    float pixels = (float)p->host->frame->size.v[1] / (2 * p->host->frame->lens.v[1]);
    pass_set(p, N_places, places, sizeof places);
    pass_set(p, N_fixed_views, s->now, sizeof s->now);
    pass_set_float(p, N_margin, margin_of(p));
    pass_set_float(p, N_pixels, pixels);
    set_lights(p);
    return true;
}

static bool draw_maps(pass *p) {
    shadow_state *s = state_of(p);
    gpu_draw_desc target = {
        .depth = pass_get_image(p, N_shadow_atlas), .clear = true, .clear_depth = 1};
    kernel *k = pass_use(p, MAPS_PLACE);
    if (!k) return false;
    kernel_bind_buffer(k, N_Views, s->placed);
    if (!kernel_run(k, p->host->device, 1, 1, 1) || !gpu_draw_all(p->host->device, &target))
        return false;
    if (s->views == 0) return true;
    if (!drawn_cull(s->drawn, s->placed, s->views, p->host->frame->size.v[1], pass_value(p, N_lod),
                    0))
        return false;
    target.clear = false;
    return drawn_record(s->drawn, MAPS_DRAW, &target, 0, s->views, (const uint32_t(*)[4])s->places);
}

static bool maps_record(pass *p) {
    shadow_state *s = state_of(p);
    if (!pass_prepare(p)) return false;
    const graph *g = p->host->graph;
    hash128 content;
    bool tells = shadow_maps_content(p, pass_use(p, MAPS_PLACE), s->points > 0, &content);
    bool same = s->known && memcmp(&content, &s->content, sizeof content) == 0;
    if (tells && same && graph_has_content(g, *pass_image(p, N_shadow_atlas)) &&
        graph_has_content(g, *pass_image(p, N_shadow_views)))
        return true;
    s->known = false;
    if (!draw_maps(p)) return false;
    s->known = tells;
    s->content = content;
    return true;
}

const pass_type shadow_maps_type = {
    .name = "shadow_maps",
    .shader = "pass/surfaces/shadow_maps.comp",
    .meshes = PASS_DRAWS_MESHES,
    .unscaled = true,
    PASS_KERNELS,
    .solver = &drawn_kernel_table,
    .declare = maps_declare,
    .complete = maps_complete,
    .defines = maps_defines,
    .target = maps_target,
    .allocate = maps_allocate,
    .list_memory = maps_list_memory,
    .update = maps_update,
    .record = maps_record,
    .destroy = maps_destroy,
};

// ---- for passes that look ---------------------------------------------------------------------

// Whether there are lights, besides point lights, that may have no maps.
static bool leaves_lights_out(const pass *maps) {
    const shadow_state *s = state_of(maps);
    return s->cascades == 0 || s->declared > 1 || pass_image(maps, N_lights)->id;
}

// The pass behind the maps; NULL: there are none.
static const pass *maps_of(const pass *p) {
    graph_image atlas = p->images[pass_image_index(p, "shadow_atlas")];
    const pass *maps = atlas.id ? pass_writer(p->host, atlas) : NULL;
    return maps && maps->type == &shadow_maps_type ? maps : NULL;
}

// A point light that can have no map need not be asked for one.
static bool asks_for_point_lights(pass *p, const pass *maps) {
    bool can = maps && state_of(maps)->points > 0 && pass_image(maps, N_point_lights)->id;
    if (!can && pass_has_word(p, "point_light_shadows", "maps"))
        pass_set_option(p, "point_light_shadows", "none");
    return can && p->images[pass_image_index(p, "point_lights")].id &&
           !pass_has_word(p, "point_light_shadows", "none");
}

static const char *choose_way(const pass *p, const pass *maps) {
    if (!maps || !gpu_get_profile(p->host->device)->shadow_maps_win) return "rays";
    return leaves_lights_out(maps) ? "both" : "maps";
}

// Settles `auto`. Maps that nothing is looked up in are let go, so that they are not drawn.
static bool find_shadow_maps(pass *p) {
    static const char *const looked_at[] = {"shadow_atlas", "shadow_views"};
    if (pass_find_image(p, looked_at[0]) < 0 || !*pass_word(p, "shadows_by")) return true;
    const pass *maps = maps_of(p);
    bool asks = pass_has_word(p, "shadows_by", "maps") || pass_has_word(p, "shadows_by", "both");
    if (asks && !p->images[pass_image_index(p, looked_at[0])].id)
        return err_set("%s: 'shadows_by' asks for maps of shadows; give it some, as in 'from = "
                       "{scene, shadow_maps { from = scene }}'",
                       p->label);
    if (pass_has_word(p, "shadows_by", "auto"))
        pass_set_option(p, "shadows_by", choose_way(p, maps));
    if (asks_for_point_lights(p, maps) || !pass_has_word(p, "shadows_by", "rays")) return true;
    for (size_t i = 0; i < COUNT_OF(looked_at); i++)
        p->images[pass_image_index(p, looked_at[i])] = (graph_image){0};
    return true;
}

const pass_provider pass_shadow_maps_provider = {.find = find_shadow_maps};
