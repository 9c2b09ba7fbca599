// Prints what comes before a shader's own text: the version, extensions, macros of options,
// enumerations and formats, the default group size, and the functions that count.
#include "shader/unit.h"
#include <ctype.h>
#include <string.h>

void unit_add_upper(strbuf *out, const char *name) {
    for (; *name; name++) {
        char upper = (char)toupper((unsigned char)*name);
        strbuf_append(out, &upper, 1);
    }
}

static void define_words(strbuf *out, const char *name, const char *const *words, size_t count) {
    for (size_t i = 0; i < count; i++) {
        strbuf_add(out, "#define ");
        unit_add_upper(out, name);
        strbuf_add(out, "_");
        unit_add_upper(out, words[i]);
        strbuf_add(out, " %zu\n", i);
    }
}

static bool define_options(const shader_interface *interface, const shader_compile_desc *desc,
                           strbuf *out) {
    const size_t *values = desc->options;
    if (values && desc->option_count != interface->option_count)
        return err_set("%s: has %zu options, values of %zu were given", interface->path,
                       interface->option_count, desc->option_count);
    for (size_t i = 0; i < interface->option_count; i++) {
        const value_desc *option = &interface->options[i];
        size_t value = values ? values[i] : (size_t)option->value[0];
        if (value >= option->word_count)
            return err_set("%s: option %s has %zu words, number %zu was asked for", interface->path,
                           option->name, option->word_count, value);
        define_words(out, option->name, option->words, option->word_count);
        strbuf_add(out, "#define ");
        unit_add_upper(out, option->name);
        strbuf_add(out, " %zu\n", value);
    }
    for (size_t i = 0; i < interface->uniform_count; i++) {
        const value_desc *uniform = &interface->uniforms[i];
        define_words(out, uniform->name, uniform->words, uniform->word_count);
    }
    return true;
}

static bool define_given(const shader_compile_desc *desc, strbuf *out) {
    for (size_t i = 0; i < desc->define_count; i++) {
        const shader_define *define = &desc->defines[i];
        const char *value = define->value ? define->value : "";
        if (!str_is_identifier(define->name) || strpbrk(value, "\r\n\\"))
            return err_set("%s: \"%s\" cannot be defined as \"%s\": a name and one line are "
                           "accepted",
                           desc->name, define->name, value);
        strbuf_add(out, "#define %s %s\n", define->name, value);
    }
    return true;
}

static void define_formats(const shader_interface *interface, strbuf *out) {
    for (size_t i = 0; i < interface->image_count; i++) {
        const shader_image *image = &interface->images[i];
        if (!image->output) continue;
        for (int line = 0; line < 2; line++) {
            strbuf_add(out, line ? "#define FORMAT_" : "#ifndef FORMAT_");
            unit_add_upper(out, image->name);
            strbuf_add(out, line ? " %s\n#endif\n" : "\n", gpu_format_name(image->format));
        }
    }
}

// A counter is two words, low and high. One lane adds for its whole subgroup. The lane that makes
// the low word wrap around increments the high one.
static void declare_counters(const shader_interface *interface, bool on, strbuf *out) {
    strbuf_add(out, "#define ROIL_COUNTERS %d\n", on);
    if (on && interface->counter_count)
        strbuf_add(out, "#extension GL_KHR_shader_subgroup_arithmetic : require\n"
                        "layout(std430) buffer Counters { uint counters_[]; };\n"
                        "void counters_add_(uint index, uint n) {\n"
                        "    n = subgroupAdd(n);\n"
                        "    if (!subgroupElect()) return;\n"
                        "    uint before = atomicAdd(counters_[2 * index], n);\n"
                        "    if (before + n < before) atomicAdd(counters_[2 * index + 1], 1u);\n"
                        "}\n");
    for (size_t i = 0; i < interface->counter_count; i++) {
        const char *name = interface->counters[i].name;
        if (on)
            strbuf_add(out, "#define count_%s(n) counters_add_(%zuu, uint(n))\n", name, i);
        else
            strbuf_add(out, "#define count_%s(n)\n", name);
    }
}

bool unit_prelude(const shader_unit *unit, const shader_interface *interface,
                  const shader_compile_desc *desc, strbuf *out) {
    strbuf_add(out, "#version 460\n"
                    "#extension GL_EXT_control_flow_attributes : require\n"
                    "#define ROIL 1\n");
    if (!define_options(interface, desc, out) || !define_given(desc, out)) return false;
    define_formats(interface, out);
    declare_counters(interface, desc->counters, out);
    if (desc->stage == SHADER_COMPUTE && !unit->has_local_size)
        strbuf_add(out, "layout(local_size_x = 16, local_size_y = 16) in;\n");
    return true;
}
