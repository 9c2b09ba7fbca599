// March: the box that rays are cut to is computed on the host, from the bounds of the density;
// where in it nothing is, bricks tell.
#include "base/memory.h"
#include "pass/march/bricks.h"
#include "pass/march/march_around.h"
#include <math.h>

enum { GROUP_SIDE = 16, MOST_TEAM = 16 };

// Of a device, beyond which more threads make a ray no faster.
static const float ENOUGH_THREADS = 1.2e6f;

static const char *const names[] = {MARCH_NAMES(KERNEL_NAME_TEXT)};
static const pass_kernel kernels[MARCH_KERNELS] = {
    [MARCH_HOLD] = {.define = "STAGE_HOLD"},
    [MARCH_FREE] = {.define = "STAGE_FREE", .without_fields = true},
    [MARCH_AROUND] = {.define = "STAGE_AROUND", .without_fields = true},
};

typedef struct march_state {
    bool skips;    // by bricks
    bool paper;    // the mode
    bool noise;    // is what the view shows
    bool adaptive; // has code for a tolerance
    bool teams;    // has code for several threads a ray
    bool software; // the device is: it has no branches
    bool maps;     // keeps more of what a ray sees, of which it has one thread and even steps
    int32_t team;  // threads a ray, in this frame
    box3 box;      // that rays are cut to, in this frame
    bricks bricks;
} march_state;

static bool record_bricks(pass *p) {
    march_state *s = p->state;
    return pass_prepare(p) && bricks_record(p, &s->bricks);
}

static bool march_declare(pass *p) {
    march_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->software = gpu_get_profile(p->host->device)->march_by_sides;
    s->maps = pass_is(p, "maps");
    s->skips = pass_option_is(p, N_skipping, "on");
    s->paper = pass_option_is(p, N_mode, "paper");
    s->noise = pass_option_is(p, N_view, "noise");
    if (!pass_check_density(p) || !pass_declare_images(p)) return false;
    if (!s->skips) return pass_add_to_graph(p);
    return bricks_declare(p, &s->bricks, record_bricks) &&
           pass_add_to_graph_after(p, &s->bricks.image, 1);
}

// ---- building ---------------------------------------------------------------------------------

// Steps of one length take less code and fewer registers alone: those of variable length are left
// out as long as nobody gives a tolerance. Likewise rays have one thread where they are as many as
// the pixels of the output, and where threads are few. What someone moves by hand where the effect
// says nothing of it is compiled in then.
static void choose_code(const pass *p) {
    march_state *s = p->state;
    if (s->maps) return;
    s->adaptive = s->adaptive || pass_gives(p, N_tolerance);
    s->teams =
        s->teams || (!s->noise && ((!s->software && p->scale < 1) || pass_gives(p, N_threads)));
}

static bool march_defines(pass *p, size_t index, pass_defines *out) {
    const march_state *s = p->state;
    if (index == MARCH_HOLD || index == MARCH_FREE) {
        if (index == MARCH_HOLD) pass_define(out, "WITH_RANGES", "1");
        return s->skips;
    }
    if (index == MARCH_AROUND) return s->software;
    choose_code(p);
    pass_define_flag(out, "ADAPTIVE", s->adaptive);
    pass_define_flag(out, "TEAMS", s->teams);
    pass_define_flag(out, "MARCH_SOFTWARE", s->software && !s->teams);
    return true;
}

// ---- in a frame -------------------------------------------------------------------------------

// The paper marches the whole simulation box in every frame (section 3.5), wherever that was moved;
// otherwise the box is as tight as what burns just now.
static bool march_box(const pass *p, box3 *box) {
    if (!((const march_state *)p->state)->paper) return pass_density_box(p, box);
    return pass_density_box_of_grids(p, box);
}

// A power of two; one where there are rays enough.
static int32_t team_size(pass *p, float rays) {
    const march_state *s = p->state;
    if (!s->teams || pass_value(p, N_tolerance) > 0) return 1;
    float asked = pass_value(p, N_threads);
    float most = asked > 0 ? asked : ENOUGH_THREADS / fmaxf(rays, 1);
    most = fminf(most, (float)gpu_get_info(p->host->device)->subgroup_size);
    int32_t team = 1;
    while (team < MOST_TEAM && (float)(2 * team) <= most) team *= 2;
    return team;
}

static bool march_update(pass *p) {
    march_state *s = p->state;
    uint32_t size[3];
    if (!march_box(p, &s->box)) return false;
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    const float rays = (float)size[0] * (float)size[1];
    s->team = team_size(p, rays);
    pass_set_box(p, s->box);
    pass_set_float(p, N_brick_rows, (float)size[1]);
    pass_set_int(p, N_team, s->team);
    if (s->skips) bricks_update(p, &s->bricks, s->box, rays * pass_value(p, N_steps));
    return true;
}

// A tolerance or threads that someone moves by hand, where the effect says nothing of them.
static bool follow_code(pass *p) {
    march_state *s = p->state, before = *s;
    if (s->maps) return true;
    s->adaptive = s->adaptive || pass_value(p, N_tolerance) > 0;
    s->teams = s->teams || (pass_value(p, N_threads) > 1 && !s->noise);
    const bool same = s->adaptive == before.adaptive && s->teams == before.teams;
    return same || pass_make_late(p, MARCH_RAYS, true);
}

// A group is a square of pixels, or half of one, of 256 threads.
static void count_threads(const march_state *s, march_part part, uint32_t threads[2]) {
    int bits = 8;
    for (int32_t i = 1; i < s->team; i *= 2) bits--;
    const uint32_t tile[2] = {1u << (bits + 1) / 2, 1u << bits / 2};
    for (int i = 0; i < 2; i++) {
        uint32_t pixels = (uint32_t)(part.high[i] - part.low[i]);
        threads[i] = (pixels + tile[i] - 1) / tile[i] * GROUP_SIDE;
    }
}

static bool record_part(pass *p, march_part part) {
    march_state *s = p->state;
    uint32_t threads[2];
    kernel *k = pass_use(p, MARCH_RAYS);
    count_threads(s, part, threads);
    if (!k || !threads[0] || !threads[1]) return k;
    if (s->skips) bricks_bind(p, &s->bricks, k);
    march_set_corner(k, part);
    return kernel_run(k, p->host->device, threads[0], threads[1], 1);
}

static bool march_record(pass *p) {
    march_state *s = p->state;
    uint32_t size[3];
    if (!s->skips && !pass_prepare(p)) return false;
    if (!follow_code(p)) return false;
    graph_get_size(p->host->graph, *pass_image(p, N_color), size);
    march_part inside = {{0, 0}, {(int32_t)size[0], (int32_t)size[1]}};
    if (s->software && !s->teams && !march_around_record(p, s->box, &inside)) return false;
    return record_part(p, inside);
}

#define MARCH_TYPE(NAME)                                                                           \
    {                                                                                              \
        .name = NAME, .shader = "pass/march/" NAME ".comp", PASS_KERNELS,                          \
        .declare = march_declare, .defines = march_defines, .update = march_update,                \
        .record = march_record,                                                                    \
    }

const pass_type march_type = MARCH_TYPE("march");
const pass_type maps_type = MARCH_TYPE("maps");
