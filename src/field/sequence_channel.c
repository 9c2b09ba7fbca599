// Channels of a sequence: which grid of a file a name means, and where its values go in the
// textures.
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "field/sequence_parts.h"
#include <string.h>

// ---- names ------------------------------------------------------------------------------------

enum { MAX_ALIASES = 6 };

static const char *const aliases[][MAX_ALIASES] = {
    // the first is the canonical name
    {"density", "smoke", "Density"},
    {"temperature", "temp", "heat"},
    {"flame", "flames", "burn", "fire"},
    {"velocity", "vel", "v"},
    {"color", "Cd"},
    {"surface", "sdf"},
};

static const char *const *find_aliases(const char *name) { // NULL: it has none
    for (size_t i = 0; i < COUNT_OF(aliases); i++)
        for (size_t k = 0; k < MAX_ALIASES && aliases[i][k]; k++)
            if (strcmp(aliases[i][k], name) == 0) return aliases[i];
    return NULL;
}

static const vdb_grid_info *find_exact(const vdb_info *info, const char *name, int part) {
    for (size_t i = 0; i < info->count; i++) {
        const vdb_grid_info *grid = &info->grids[i];
        size_t length = strlen(name);
        if (grid->components == 0 || !grid->linear || strncmp(grid->name, name, length) != 0)
            continue;
        const char *rest = grid->name + length;
        if (rest[0] == '\0' && part == 0) return grid;
        if (rest[0] == '.' && rest[1] == 'x' + part && rest[2] == '\0') return grid;
    }
    return NULL;
}

const vdb_grid_info *sequence_find_grid(const vdb_info *info, const char *channel, int part) {
    const vdb_grid_info *grid = find_exact(info, channel, part);
    const char *const *row = find_aliases(channel);
    for (size_t k = 0; !grid && row && k < MAX_ALIASES && row[k]; k++)
        grid = find_exact(info, row[k], part);
    return grid;
}

static bool is_velocity(const char *channel) {
    const char *const *row = find_aliases(channel);
    return row && strcmp(row[0], "velocity") == 0;
}

// ---- asking for them --------------------------------------------------------------------------

static int components_of(const sequence_data *s, const char *name) { // 0: there is no such channel
    if (s->raw) return strcmp(name, s->desc.raw.channel) == 0 ? 1 : 0;
    int components = 0;
    for (size_t i = 0; i < s->file_count; i++) {
        const vdb_grid_info *grid = sequence_find_grid(&s->infos[i], name, 0);
        if (!grid) continue;
        bool split = grid->components == 1 && sequence_find_grid(&s->infos[i], name, 1) &&
                     sequence_find_grid(&s->infos[i], name, 2);
        int here = split ? 3 : grid->components;
        if (here > components) components = here;
    }
    return components;
}

static void add_name(strbuf *out, const char *name) {
    char quoted[256];
    str_copy(quoted, sizeof quoted, name);
    strbuf_add(out, "%s%s", out->length > 0 ? ", " : "", quoted);
}

void sequence_list_grids(const vdb_info *info, strbuf *out) {
    for (size_t i = 0; i < info->count && out->length < 2000; i++) {
        const vdb_grid_info *grid = &info->grids[i];
        add_name(out, grid->name);
        if (grid->components == 0)
            strbuf_add(out, " (has values of type %.64s)", grid->type);
        else if (!grid->linear)
            strbuf_add(out, " (has a frustum transform; resample it to boxes of voxels first)");
    }
}

static int no_channel(const sequence_data *s, const char *name) {
    strbuf names = {0};
    if (s->raw) add_name(&names, s->desc.raw.channel);
    for (size_t i = 0; !s->raw && i < s->file_count && names.length == 0; i++)
        sequence_list_grids(&s->infos[i], &names);
    err_set("%s: no grid named '%.64s' can be read; there are: %s", s->desc.pattern, name,
            strbuf_text(&names));
    strbuf_free(&names);
    return -1;
}

int sequence_channel(sequence *s, const char *name, int *components) {
    sequence_data *d = s->data;
    for (size_t i = 0; i < d->channel_count; i++) {
        if (strcmp(d->channels[i].name, name) != 0) continue;
        *components = d->channels[i].components;
        return d->channels[i].first;
    }
    int count = components_of(d, name);
    if (count == 0) return no_channel(d, name);
    // A vector lies in one texture.
    int first = d->width, end;
    if (first % 4 + count > 4) first += 4 - first % 4;
    end = first + count;
    uint64_t bytes = (uint64_t)d->file_size[0] * d->file_size[1] * d->file_size[2] *
                     (uint64_t)((end + 3) / 4 * 4) * sizeof(uint16_t);
    if (end > 4 * FIELD_GRID_IMAGES || s->sealed ||
        (d->channel_count > 0 && !d->sparse && bytes > d->desc.max_frame_bytes)) {
        err_set("%s: '%.64s' cannot be added: %s", d->desc.pattern, name,
                s->sealed                     ? "the sequence is playing already"
                : end > 4 * FIELD_GRID_IMAGES ? "a sequence has at most 16 channels"
                                              : "a frame would exceed its limit of memory");
        return -1;
    }
    d->channels[d->channel_count++] = (sequence_channel_info){
        arena_string(&d->memory, name), first, count, is_velocity(name) ? d->desc.scale : 1};
    d->width = s->grid.channel_count = end;
    *components = count;
    return first;
}

const char *sequence_field_name(const field_grid *grid, size_t index) {
    const sequence_data *d = ((const sequence *)grid)->data;
    if (index >= d->channel_count) return NULL;
    const char *const *row = find_aliases(d->channels[index].name);
    return row ? row[0] : d->channels[index].name;
}

int sequence_find_field(field_grid *grid, const char *name, int *components) {
    sequence *s = (sequence *)grid;
    for (size_t i = 0; i < s->data->channel_count; i++)
        if (strcmp(sequence_field_name(grid, i), name) == 0) name = s->data->channels[i].name;
    return sequence_channel(s, name, components);
}
