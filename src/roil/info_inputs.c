// Whose an effect is, and what it reads, for people and for programs.
#include "base/memory.h"
#include "base/str.h"
#include "roil/info.h"
#include "roil/sheet.h"
#include <string.h>

enum { ALONE = 3 }; // files of one kind in one folder that are listed one by one

static bool are_alike(const char *a, const char *b) {
    size_t folder = (size_t)(path_name(a) - a);
    return folder == (size_t)(path_name(b) - b) && strncmp(a, b, folder) == 0 &&
           strcmp(path_extension(a), path_extension(b)) == 0;
}

static void add_size(strbuf *out, uint64_t bytes) {
    if (bytes < 10000)
        strbuf_add(out, "%u bytes\n", (unsigned)bytes);
    else
        strbuf_add(out, bytes < 10000000 ? "%.2f MB\n" : "%.0f MB\n", (double)bytes * 1e-6);
}

// Adds a line for a file, or one for all files like it that follow. Returns how many it stands for.
static size_t add_files(strbuf *out, const roil_input *files, size_t left) {
    uint64_t bytes = 0;
    size_t count = 1;
    while (count < left && are_alike(files[0].name, files[count].name)) count++;
    if (count <= ALONE) count = 1;
    for (size_t i = 0; i < count; i++) bytes += files[i].size;
    const char *name = files[0].name;
    if (count > 1)
        strbuf_add(out, "  %.*s*.%s: %zu files, ", (int)(path_name(name) - name), name,
                   path_extension(name), count);
    else
        strbuf_add(out, "  %s: ", name);
    add_size(out, bytes);
    return count;
}

static char *inputs_as_text(roil *r, const char *file) {
    roil_inputs *in = roil_collect(r, file);
    if (!in) return NULL;
    strbuf out = {0};
    uint64_t bytes = 0;
    for (size_t i = 0; i < in->count; i++) bytes += in->files[i].size;
    strbuf_add(&out, "%s: %u frames from %u at %g a second\n", in->info.name, in->info.frames,
               in->info.first_frame, in->info.fps);
    strbuf_add(&out, "author: %s\nlicence: %s\n", in->info.author ? in->info.author : "not said",
               in->info.licence ? in->info.licence : "not said");
    strbuf_add(&out, "reads %zu file%s, ", in->count, in->count == 1 ? "" : "s");
    add_size(&out, bytes);
    for (size_t i = 0; i < in->count;) i += add_files(&out, &in->files[i], in->count - i);
    roil_free_inputs(in);
    return out.text;
}

char *roil_info_inputs(roil *r, const char *file) {
    mem_enter();
    return roil_leave_text(inputs_as_text(r, file));
}

static char *inputs_as_json(roil *r, const char *file) {
    roil_inputs *in = roil_collect(r, file);
    if (!in) return NULL;
    json_t *files = json_array(), *about = info_effect_json(&in->info);
    json_object_set_new(about, "file", sheet_text(in->effect));
    for (size_t i = 0; i < in->count; i++)
        json_array_append_new(files, json_pack("{s:o, s:I}", "name", sheet_text(in->files[i].name),
                                               "bytes", (json_int_t)in->files[i].size));
    roil_free_inputs(in);
    return info_finish_json(
        json_pack("{s:s, s:o, s:o}", "roil", roil_version(), "effect", about, "files", files));
}

char *roil_info_inputs_json(roil *r, const char *file) {
    mem_enter();
    return roil_leave_text(inputs_as_json(r, file));
}
