// The panel's model of shipped effects, loaded without a device.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/panel_model.h"
#include "base/memory.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct stage {
    roil *r;
    roil_effect *e;
    roil_control *controls;
    size_t count;
    panel_model model;
} stage;

static int open_stage(void **state) {
    stage *s = mem_alloc(sizeof *s);
    *state = s;
    s->r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR"), .no_device = true});
    if (!s->r) fail_msg("%s", roil_error());
    return 0;
}

static int close_stage(void **state) {
    stage *s = *state;
    panel_model_free(&s->model);
    mem_free(s->controls);
    roil_unload(s->e);
    roil_destroy(s->r);
    mem_free(s);
    return 0;
}

static void gather(stage *s, const char *search) {
    s->count = roil_control_count(s->e);
    mem_free(s->controls);
    s->controls = mem_alloc(s->count * sizeof *s->controls);
    for (size_t i = 0; i < s->count; i++) roil_get_control(s->e, i, &s->controls[i]);
    panel_model_fill(&s->model, s->controls, s->count, search);
}

static stage *load(void **state, const char *name) {
    stage *s = *state;
    char file[4096];
    snprintf(file, sizeof file, "%s/effects/%s.lua", getenv("ROIL_SOURCE_DIR"), name);
    s->e = roil_load(s->r, file, NULL, 0);
    if (!s->e) fail_msg("%s", roil_error());
    gather(s, "");
    return s;
}

static const panel_section *section(const stage *s, panel_part part, const char *title) {
    for (size_t i = 0; i < s->model.section_count; i++) {
        const panel_section *found = &s->model.sections[i];
        if (found->part == part && strcmp(found->title, title) == 0) return found;
    }
    fail_msg("no section '%s'", title);
    return NULL;
}

static const roil_control *row(const stage *s, const panel_section *at, size_t index) {
    assert_true(index < at->count);
    return &s->controls[s->model.rows[at->first + index]];
}

static void the_explosion_has_its_sections(void **state) {
    const stage *s = load(state, "explosion");
    const panel_section *own = &s->model.sections[0];
    assert_string_equal(own->title, "Parameters");
    assert_int_equal(own->count, 7);
    assert_string_equal(row(s, own, 0)->name, "density");
    assert_string_equal(row(s, own, 6)->name, "steps");
    assert_int_equal(row(s, section(s, PANEL_SHAPE, "fire"), 0)->type, ROIL_PALETTE);
    section(s, PANEL_CAMERA, "Camera");
    section(s, PANEL_SUN, "Sun");
    section(s, PANEL_SKY, "Sky");
    section(s, PANEL_PASS, "final");
}

static void options_of_the_march_stand_first(void **state) {
    const stage *s = load(state, "explosion");
    const panel_section *march = section(s, PANEL_PASS, "march");
    assert_string_equal(row(s, march, 0)->name, "march.mode");
    bool uniforms = false;
    for (size_t i = 0; i < march->count; i++) {
        if (uniforms) assert_false(row(s, march, i)->structural);
        uniforms |= !row(s, march, i)->structural;
    }
}

static void expect_one_row_each(const stage *s) {
    unsigned char *seen = mem_alloc(s->count);
    assert_int_equal(s->model.row_count, s->count);
    for (size_t i = 0; i < s->count; i++) seen[s->model.rows[i]]++;
    for (size_t i = 0; i < s->count; i++) assert_int_equal(seen[i], 1);
    mem_free(seen);
}

static void every_control_has_one_row(void **state) {
    stage *s = load(state, "explosion");
    expect_one_row_each(s);
    roil_unload(s->e);
    expect_one_row_each(load(state, "paper"));
}

static void a_search_finds_by_help(void **state) {
    stage *s = load(state, "explosion");
    gather(s, "reach towards a light"); // "how far towards a light shadows reach"
    const panel_section *march = section(s, PANEL_PASS, "march");
    assert_string_equal(row(s, march, 0)->name, "march.shadow_distance");
    gather(s, "no such thing");
    assert_int_equal(s->model.row_count, 0);
}

// What the panel writes, the effect takes, and it is the same value.
static void values_as_text_are_taken(void **state) {
    stage *s = load(state, "explosion");
    size_t tried = 0;
    for (size_t i = 0; i < s->count; i++) {
        const roil_control *c = &s->controls[i];
        roil_control after;
        if (c->structural || c->driven || c->type == ROIL_PALETTE || c->type == ROIL_CURVE)
            continue;
        strbuf text = {0};
        panel_value_text(c, c->value, &text);
        if (!roil_set(s->e, c->name, strbuf_text(&text))) fail_msg("%s", roil_error());
        roil_get_control(s->e, i, &after);
        assert_memory_equal(after.value, c->value, (size_t)c->components * sizeof(float));
        strbuf_free(&text);
        tried++;
    }
    assert_true(tried > 30);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_explosion_has_its_sections, open_stage, close_stage),
        cmocka_unit_test_setup_teardown(options_of_the_march_stand_first, open_stage, close_stage),
        cmocka_unit_test_setup_teardown(every_control_has_one_row, open_stage, close_stage),
        cmocka_unit_test_setup_teardown(a_search_finds_by_help, open_stage, close_stage),
        cmocka_unit_test_setup_teardown(values_as_text_are_taken, open_stage, close_stage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
