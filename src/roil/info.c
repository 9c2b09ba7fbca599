// Reference texts, printed from the tables that the library itself uses.
#include "roil/info.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "media/vdb.h"
#include <math.h>
#include <string.h>

static char *text_finish(strbuf *text) {
    if (!text->text) strbuf_append(text, "", 0);
    return text->text;
}

enum { HELP_COLUMN = 34, LINE_WIDTH = 100 };

// Appends text that starts at `column`, and a newline. Lines are broken between words and continue
// at `indent`.
static void add_flowing(strbuf *out, size_t indent, size_t column, const char *text) {
    bool first = true;
    while (*text) {
        size_t word = strcspn(text, " ");
        if (!first && column + 1 + word > LINE_WIDTH) {
            strbuf_add(out, "\n%*s", (int)indent, "");
            column = indent;
        } else if (!first) {
            strbuf_append(out, " ", 1);
            column++;
        }
        strbuf_append(out, text, word);
        column += word;
        first = false;
        text += word + (text[word] == ' ');
    }
    strbuf_append(out, "\n", 1);
}

void info_add_entry(strbuf *out, const char *name, const char *help) {
    strbuf_add(out, "  %-*s", HELP_COLUMN - 2, name);
    if (strlen(name) > HELP_COLUMN - 3) strbuf_add(out, "\n%*s", HELP_COLUMN, "");
    add_flowing(out, HELP_COLUMN, HELP_COLUMN, help);
}

static void describe(strbuf *out, const value_desc *desc) {
    strbuf name = {0}, help = {0};
    value_show(desc, NULL, NULL, &name);
    strbuf_add(&help, "%s%s", desc->help, desc->required ? "; required" : "");
    info_add_entry(out, strbuf_text(&name), strbuf_text(&help));
    strbuf_free(&name);
    strbuf_free(&help);
}

static void add_first_sentence(strbuf *out, const char *text) {
    const char *end = strstr(text, ". ");
    strbuf_append(out, text, end ? (size_t)(end - text) : strlen(text));
}

static void print_keys(strbuf *out, const char *title, const value_desc *keys) {
    if (keys) strbuf_add(out, "\n%s\n", title);
    for (; keys && keys->name; keys++) describe(out, keys);
}

// ---- devices ----------------------------------------------------------------------------------

const char *info_device_kind(gpu_kind kind) {
    static const char *const names[] = {"discrete GPU", "integrated GPU", "virtual GPU", "software",
                                        "other"};
    return names[kind];
}

char *roil_info_devices(void) {
    mem_enter();
    gpu_info infos[16];
    int count = gpu_list(infos, COUNT_OF(infos));
    if (count < 0) return roil_leave_text(NULL);
    strbuf out = {0};
    for (int i = 0; i < count && i < (int)COUNT_OF(infos); i++) {
        const gpu_info *d = &infos[i];
        strbuf_add(&out, "%d  %s (%s)\n", i, d->name, info_device_kind(d->kind));
        strbuf_add(&out, "   driver %s, Vulkan %u.%u, %.1f GiB, subgroups of %u\n", d->driver,
                   d->api_major, d->api_minor, (double)d->memory / (1 << 30), d->subgroup_size);
        if (d->uuid[0]) strbuf_add(&out, "   UUID %s\n", d->uuid);
        if (!d->usable) strbuf_add(&out, "   cannot be used: %s\n", d->missing);
    }
    if (!count) strbuf_add(&out, "no Vulkan device\n");
    return roil_leave_text(text_finish(&out));
}

// ---- passes -----------------------------------------------------------------------------------

value_desc info_field(const shader_field *f) {
    value_desc desc = {.name = f->name,
                       .components = f->components,
                       .required = f->required,
                       .unit = "",
                       .help = f->help};
    memcpy(desc.value, f->value, sizeof desc.value);
    return desc;
}

static void print_field(strbuf *out, const shader_field *f) {
    strbuf name = {0};
    value_desc desc = info_field(f);
    strbuf_add(&name, "%s ", f->glsl_type);
    value_show(&desc, f->name, f->value, &name);
    info_add_entry(out, strbuf_text(&name), f->help);
    strbuf_free(&name);
}

static void print_interface(strbuf *out, const shader_interface *face) {
    strbuf_append(out, "\n", 1);
    add_flowing(out, 0, 0, face->summary);
    bool titled = false;
    for (size_t i = 0; i < face->image_count; i++) {
        if (face->images[i].output) continue;
        if (!titled) strbuf_add(out, "\ninputs (images, by place or by name)\n");
        titled = true;
        strbuf name = {0};
        strbuf_add(&name, "%s%s", face->images[i].name,
                   face->images[i].optional ? " (optional)" : "");
        info_add_entry(out, strbuf_text(&name), face->images[i].help);
        strbuf_free(&name);
    }
    if (face->field_count) strbuf_add(out, "\nfields\n");
    for (size_t i = 0; i < face->field_count; i++) print_field(out, &face->fields[i]);
    if (face->option_count) strbuf_add(out, "\noptions (structure; * is the default)\n");
    for (size_t i = 0; i < face->option_count; i++) describe(out, &face->options[i]);
    strbuf_add(out, "\nuniforms (numbers; constants, parameters, curves or functions of time)\n");
    for (size_t i = 0; i < face->uniform_count; i++) describe(out, &face->uniforms[i]);
    print_keys(out, "keys of every pass", script_object_find("shader")->keys);
    strbuf_add(out, "\noutputs\n");
    for (size_t i = 0; i < face->image_count; i++) {
        if (!face->images[i].output) continue;
        strbuf name = {0};
        strbuf_add(&name, "%s %s", face->images[i].name, gpu_format_name(face->images[i].format));
        info_add_entry(out, strbuf_text(&name), face->images[i].help);
        strbuf_free(&name);
    }
    for (size_t i = 0; i < face->counter_count; i++) {
        if (i == 0) strbuf_add(out, "\ncounters (render --stats)\n");
        info_add_entry(out, face->counters[i].name, face->counters[i].help);
    }
}

static bool print_pass(strbuf *out, shader_library *library, const pass_type *type, bool whole) {
    arena memory = {0};
    const shader_interface *face = shader_interface_load(library, &memory, type->shader, NULL);
    if (face && whole) {
        strbuf_add(out, "%s\n", type->name);
        print_interface(out, face);
    } else if (face) { // the first sentence of the summary
        char *summary = arena_string(&memory, face->summary);
        char *end = strstr(summary, ". ");
        if (!end) end = strchr(summary, '\n');
        if (end) *end = '\0';
        info_add_entry(out, type->name, summary);
    }
    arena_free(&memory);
    return face != NULL;
}

char *roil_info_passes(roil *r, const char *name) {
    mem_enter();
    const pass_type *one = name ? pass_type_find(name) : NULL;
    if (name && !one) return roil_leave_text(NULL);
    shader_library *library =
        shader_library_create(&(shader_library_desc){.shader_root = r->shaders});
    if (!library) return roil_leave_text(NULL);
    strbuf out = {0};
    bool done = true;
    if (one) {
        done = print_pass(&out, library, one, true);
    } else {
        size_t count;
        const pass_type *const *types = pass_types(&count);
        for (size_t i = 0; done && i < count; i++)
            done = print_pass(&out, library, types[i], false);
        if (done)
            strbuf_add(&out,
                       "\n`roil info passes NAME` tells all about one. A GLSL file of your own "
                       "is a pass too:\n`roil info fields shader`.\n");
    }
    shader_library_destroy(library);
    if (done) return roil_leave_text(text_finish(&out));
    strbuf_free(&out);
    return roil_leave_text(NULL);
}

// ---- fields -----------------------------------------------------------------------------------

value_desc info_option(const field_option *o) {
    value_desc desc = {.name = o->name, .type = VALUE_WORD, .words = o->words, .help = o->help};
    while (desc.word_count < COUNT_OF(o->words) && o->words[desc.word_count]) desc.word_count++;
    return desc;
}

static void print_kind(strbuf *out, const field_kind *kind) {
    strbuf_add(out, "%s (%s)\n\n", kind->name, kind->group);
    add_flowing(out, 0, 0, kind->summary);
    if (kind->args[0].desc.name) strbuf_add(out, "\narguments\n");
    for (int i = 0; i < FIELD_MAX_ARGS && kind->args[i].desc.name; i++)
        describe(out, &kind->args[i].desc);
    for (int i = 0; i < FIELD_MAX_OPTIONS && kind->options[i].name; i++) {
        if (i == 0) strbuf_add(out, "\noptions (structure; * is the default)\n");
        value_desc desc = info_option(&kind->options[i]);
        describe(out, &desc);
    }
}

static void print_object(strbuf *out, const script_object *object) {
    strbuf_add(out, "%s (%s)\n\n", object->name, object->group);
    add_flowing(out, 0, 0, object->summary);
    strbuf_add(out, "\n  %s\n", object->form);
    print_keys(out, "arguments (by place)", object->args);
    const value_desc *key;
    bool choice = false;
    for (size_t i = 0; (key = script_object_key(object, i)); i++) choice |= key->words != NULL;
    for (size_t i = 0; (key = script_object_key(object, i)); i++) {
        if (i == 0) strbuf_add(out, "\nkeys%s\n", choice ? " (* is the default)" : "");
        describe(out, key);
    }
    print_keys(out, "members", object->members);
}

static const field_kind *find_kind(const char *name) {
    for (const field_kind *kind = field_kinds; kind->name; kind++)
        if (script_has_kind(kind) && strcmp(kind->name, name) == 0) return kind;
    return NULL;
}

static char *refuse_field(const char *name) {
    const char *names[256];
    size_t count = 0;
    const script_object *object;
    for (size_t i = 0; (object = script_object_at(i)) && count < COUNT_OF(names); i++)
        names[count++] = object->name;
    for (const field_kind *kind = field_kinds; kind->name && count < COUNT_OF(names); kind++)
        if (script_has_kind(kind)) names[count++] = kind->name;
    words_refuse(names, count, name, "`roil info fields` lists them", "unknown field '%.64s'",
                 name);
    return NULL;
}

static void print_line(strbuf *out, const char *name, const char *summary) {
    strbuf first = {0};
    add_first_sentence(&first, summary);
    info_add_entry(out, name, strbuf_text(&first));
    strbuf_free(&first);
}

static void print_group(strbuf *out, const char *group) {
    const script_object *object;
    strbuf_add(out, "%s%s\n", out->length ? "\n" : "", group);
    for (const field_kind *kind = field_kinds; kind->name; kind++)
        if (script_has_kind(kind) && strcmp(kind->group, group) == 0)
            print_line(out, kind->name, kind->summary);
    for (size_t i = 0; (object = script_object_at(i)); i++)
        if (strcmp(object->group, group) == 0) print_line(out, object->name, object->summary);
}

char *roil_info_fields(const char *name) {
    mem_enter();
    static const char *const groups[] = {"value", "source",   "noise", "shape",
                                         "blast", "operator", "scene", "effect"};
    strbuf out = {0};
    if (name) {
        const field_kind *kind = find_kind(name);
        const script_object *object = script_object_find(name);
        if (!kind && !object) return roil_leave_text(refuse_field(name));
        if (kind)
            print_kind(&out, kind);
        else
            print_object(&out, object);
        return roil_leave_text(text_finish(&out));
    }
    for (size_t i = 0; i < COUNT_OF(groups); i++) print_group(&out, groups[i]);
    strbuf_add(&out, "\n`roil info fields NAME` tells all about one. Arguments go by place or by "
                     "name.\nOperators are methods too: f:warp(by, 0.2); + - * / ^ work on fields; "
                     "f.x and f.rgb are components.\nAs in GLSL, the value is the last argument of "
                     "the functions smoothstep(low, high, value) and\nstep(edge, value); it is the "
                     "first of their methods, as of every other operator.\n");
    return roil_leave_text(text_finish(&out));
}

// ---- one effect -------------------------------------------------------------------------------

// "density = 30 [0, 200] 1/m", and in the help's column what there is to know besides.
static void print_control(roil_effect *e, size_t index, strbuf *out) {
    roil_control c;
    roil_get_control(e, index, &c);
    const effect_control *own = effect_get_control(e->effect, index);
    bool text = own->desc->type == VALUE_OTHER;
    strbuf name = {0}, help = {0};
    const char *shown = c.parameter || !c.group[0] ? c.name : c.label;
    value_show(own->desc, shown, c.value, &name);
    if (text) {
        strbuf_add(&name, " = ");
        effect_print_control(e->effect, own, &name);
    }
    strbuf_add(&help, "%s", c.help);
    if (c.structural && c.parameter)
        strbuf_add(&help, "%s(structure: read while the effect loads)", help.length ? " " : "");
    if (c.driven) strbuf_add(&help, "%s(the script moves it)", help.length ? " " : "");
    if (c.moved)
        strbuf_add(&help, "%s(moved; the script says %s)", help.length ? " " : "", own->initial);
    info_add_entry(out, strbuf_text(&name), strbuf_text(&help));
    strbuf_free(&name);
    strbuf_free(&help);
}

static const char *section_of(const effect_control *c, const roil_control *shown) {
    if (c->kind == EFFECT_CONTROL_PARAM) return "parameters";
    if (c->kind == EFFECT_CONTROL_PALETTE || c->kind == EFFECT_CONTROL_CURVE)
        return "palettes and curves";
    return shown->group;
}

static void add_memory(strbuf *out, const roil *r) {
    const double mib = 1 << 20;
    roil_memory m = roil_get_memory(r);
    strbuf_add(out, "loaded: %.1f MiB of memory of the %.0f MiB that may be taken",
               (double)m.sum / mib, (double)m.limit / mib);
    for (size_t i = 0; i < COUNT_OF(m.largest) && m.largest[i].bytes; i++)
        strbuf_add(out, "%s%s %.1f MiB", i ? ", " : "; ", m.largest[i].label,
                   (double)m.largest[i].bytes / mib);
    strbuf_add(out, "\n");
}

char *roil_info_params(roil_effect *e) {
    mem_enter();
    strbuf out = {0};
    effect *fx = e->effect;
    const effect_facts *facts = effect_get_facts(fx);
    strbuf_add(&out, "%s: %u frames from %u at %g a second\n", facts->name, facts->frames,
               facts->first, facts->fps);
    add_memory(&out, e->owner);
    const char *section = "";
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        const char *own = section_of(effect_get_control(fx, i), &c);
        bool listed = own != c.group || c.parameter; // by their own names
        if (strcmp(own, section) != 0) strbuf_add(&out, listed ? "\n%s\n" : "\n%s.*\n", own);
        section = own;
        print_control(e, i, &out);
    }
    return roil_leave_text(text_finish(&out));
}

char *roil_info_graph(roil_effect *e) {
    mem_enter();
    strbuf out = {0};
    graph_print_dot(effect_graph(e->effect), effect_get_facts(e->effect)->name, &out);
    return roil_leave_text(text_finish(&out));
}

// ---- OpenVDB ----------------------------------------------------------------------------------

static void print_grid(strbuf *out, const vdb_grid_info *g) {
    static const char *const classes[] = {
        "unknown", "fog volume", "level set (read as a solid; level_set = \"fog\": as fog)",
        "staggered"};
    strbuf_add(out, "%s: %s%s, %s, ", g->name, g->type, g->saved_half ? " (saved as half)" : "",
               classes[g->grid_class]);
    if (!g->linear) {
        strbuf_add(out, "frustum transform, which roil cannot read: resample it to boxes of voxels "
                        "first\n");
        return;
    }
    strbuf_add(out, "voxel %g x %g x %g m%s\n", (double)g->voxel_size[0], (double)g->voxel_size[1],
               (double)g->voxel_size[2],
               g->sheared        ? ", sheared: it is resampled"
               : g->axis_aligned ? ""
                                 : ", rotated: it is resampled");
}

// Prints the opacity of a ray along the shortest side of the box through a density of one, as a
// hint of scale.
static void print_opacity(strbuf *out, const vdb_grid_info *g) {
    const float opaque = 3; // optical depth: a twentieth shines through
    bool fog = g->grid_class != VDB_LEVEL_SET && g->components == 1;
    if (!fog || strcmp(g->name, "density") != 0 || box3_is_empty(g->box)) return;
    float side = fminf(fminf(g->box.max.x - g->box.min.x, g->box.max.y - g->box.min.y),
                       g->box.max.z - g->box.min.z);
    strbuf_add(
        out, "  %g m along its shortest side: where it is 1 throughout, density * %.2g is opaque\n",
        (double)side, (double)(opaque / side));
}

char *roil_info_vdb(const char *file) {
    mem_enter();
    arena memory = {0};
    vdb_info info;
    if (!vdb_read_info(file, &memory, &info)) {
        arena_free(&memory);
        return roil_leave_text(NULL);
    }
    strbuf out = {0};
    for (size_t i = 0; i < info.count; i++) {
        const vdb_grid_info *g = &info.grids[i];
        print_grid(&out, g);
        if (box3_is_empty(g->box))
            strbuf_add(&out, "  empty\n");
        else
            strbuf_add(
                &out, "  index (%d, %d, %d) to (%d, %d, %d), box (%g, %g, %g) to (%g, %g, %g) m\n",
                g->index_min[0], g->index_min[1], g->index_min[2], g->index_max[0], g->index_max[1],
                g->index_max[2], (double)g->box.min.x, (double)g->box.min.y, (double)g->box.min.z,
                (double)g->box.max.x, (double)g->box.max.y, (double)g->box.max.z);
        if (g->active_voxels)
            strbuf_add(&out, "  %llu active voxels\n", (unsigned long long)g->active_voxels);
        strbuf_add(&out, "  background %g%s\n", (double)g->background[0],
                   g->components ? "" : "; a type that roil cannot read");
        print_opacity(&out, g);
    }
    if (info.y_up)
        strbuf_add(&out, "Y up, as its creator makes them: vdb { } turns it to Z up, unless the "
                         "script says y_up = false\n");
    if (info.metadata[0]) strbuf_add(&out, "%s", info.metadata);
    arena_free(&memory);
    return roil_leave_text(text_finish(&out));
}
