// Raw files: frames of one channel, one after another, little-endian. The numbers that describe
// them come from strangers: every product is checked before it is formed.
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "field/sequence_parts.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

enum { MAX_SIDE = 4096 };

static uint32_t type_size(const char *type) {
    if (strcmp(type, "u8") == 0) return 1;
    if (strcmp(type, "u16") == 0 || strcmp(type, "f16") == 0) return 2;
    return strcmp(type, "f32") == 0 ? 4 : 0;
}

static bool read_axes(sequence_data *s) {
    const char *text = s->desc.raw.axes, *at = text;
    unsigned seen = 0;
    for (int i = 0; i < 3; i++) {
        s->layout.backwards[i] = *at == '-';
        if (*at == '-') at++;
        int axis = *at - 'x';
        if (axis < 0 || axis > 2) break;
        s->layout.axes[i] = axis;
        seen |= 1u << axis;
        at++;
    }
    if (seen == 7 && *at == '\0') return true;
    return err_set("%s: raw axes '%.16s'; x, y and z are accepted, each once, the fastest first, "
                   "with a '-' before one that runs backwards, as in \"x-yz\"",
                   s->files[0], text);
}

static bool has_box(const sequence_data *s) {
    const box3 *b = &s->desc.raw.box;
    return b->min.x != b->max.x || b->min.y != b->max.y || b->min.z != b->max.z;
}

static bool check_box(const sequence_data *s) {
    const box3 *b = &s->desc.raw.box;
    const float low[3] = {b->min.x, b->min.y, b->min.z}, high[3] = {b->max.x, b->max.y, b->max.z};
    for (int i = 0; i < 3 && has_box(s); i++)
        if (!(low[i] >= -1e6f && high[i] <= 1e6f && low[i] < high[i]))
            return err_set("%s: raw box from %g to %g m along %c; the greater end comes last, and "
                           "+-1e6 are accepted",
                           s->files[0], (double)low[i], (double)high[i], 'x' + i);
    for (int i = 0; i < 3; i++)
        if (s->desc.raw.padding > MAX_SIDE || s->file_size[i] > MAX_SIDE)
            return err_set("%s: %u voxels and %u of padding on both sides; at most %d in all are "
                           "accepted",
                           s->files[0], s->desc.raw.size[i], s->desc.raw.padding, MAX_SIDE);
    return true;
}

static bool check_numbers(sequence_data *s) {
    const char *path = s->files[0];
    const uint32_t *size = s->desc.raw.size;
    if (!s->desc.raw.type || type_size(s->desc.raw.type) == 0)
        return err_set("%s: raw type '%.16s'; u8, u16, f16 and f32 are accepted", path,
                       s->desc.raw.type ? s->desc.raw.type : "");
    for (int i = 0; i < 3; i++)
        if (size[i] < 1 || size[i] > MAX_SIDE)
            return err_set("%s: raw size %u x %u x %u; 1 to %d voxels a side are accepted", path,
                           size[0], size[1], size[2], MAX_SIDE);
    if (!isfinite(s->desc.raw.value_scale))
        return err_set("%s: the raw value scale is not finite", path);
    float voxel = s->desc.raw.voxel_size;
    if (!isfinite(voxel) || voxel < 0 || voxel > 1e6f)
        return err_set("%s: raw voxel size %g m; more than 0 and at most 1e6 is accepted", path,
                       (double)voxel);
    for (int i = 0; i < 3; i++) s->file_size[i] = size[i] + 2 * s->desc.raw.padding;
    return read_axes(s) && check_box(s);
}

static bool check_length(sequence_data *s, uint64_t length) {
    const char *path = s->files[0];
    sequence_raw_layout *l = &s->layout;
    const uint32_t *size = s->desc.raw.size, *padded = s->file_size;
    uint64_t voxels = (uint64_t)size[0] * size[1] * size[2]; // at most 2^36
    l->texel = type_size(s->desc.raw.type);
    l->frame_bytes = voxels * l->texel;
    l->offset = s->desc.raw.offset;
    l->stride = s->desc.raw.stride ? s->desc.raw.stride : l->frame_bytes;
    if ((uint64_t)padded[0] * padded[1] * padded[2] * sizeof(uint16_t) > s->desc.max_frame_bytes)
        return err_set("%s: a frame of %u x %u x %u voxels is larger than the limit of %llu bytes",
                       path, padded[0], padded[1], padded[2],
                       (unsigned long long)s->desc.max_frame_bytes);
    if (l->stride < l->frame_bytes)
        return err_set("%s: frames of %llu bytes cannot lie %llu bytes apart", path,
                       (unsigned long long)l->frame_bytes, (unsigned long long)l->stride);
    if (l->offset > length || length - l->offset < l->frame_bytes)
        return err_set("%s: it holds %llu bytes; its first frame needs %llu from byte %llu on",
                       path, (unsigned long long)length, (unsigned long long)l->frame_bytes,
                       (unsigned long long)l->offset);
    uint64_t whole = (length - l->offset - l->frame_bytes) / l->stride + 1;
    if (s->desc.raw.frames > whole)
        return err_set("%s: %u frames are wanted, but it holds only %llu", path, s->desc.raw.frames,
                       (unsigned long long)whole);
    uint64_t frames = s->desc.raw.frames ? s->desc.raw.frames : whole;
    if (frames > SEQUENCE_MAX_FRAMES)
        return err_set("%s: %llu frames; at most %d are accepted", path, (unsigned long long)frames,
                       SEQUENCE_MAX_FRAMES);
    l->frames = (uint32_t)frames;
    return true;
}

bool sequence_raw_open(sequence_data *s) {
    size_t length;
    int file = file_open_inside(s->desc.root, s->files[0], SIZE_MAX, &length);
    if (file < 0) return false;
    close(file);
    s->layout.changed = file_changed_ns(s->files[0]);
    if (!check_numbers(s) || !check_length(s, length)) return false;
    s->frame_count = s->layout.frames;
    s->span = s->frame_count;
    const uint32_t *size = s->desc.raw.size;
    float voxel = s->desc.raw.voxel_size, pad = (float)s->desc.raw.padding;
    if (voxel == 0) voxel = 1.0f / (float)size[0];
    box3 b = s->desc.raw.box;
    if (!has_box(s))
        b = (box3){{0, 0, 0},
                   {voxel * (float)size[0], voxel * (float)size[1], voxel * (float)size[2]}};
    float3 side = {pad * (b.max.x - b.min.x) / (float)size[0],
                   pad * (b.max.y - b.min.y) / (float)size[1],
                   pad * (b.max.z - b.min.z) / (float)size[2]};
    s->file_box = (box3){{b.min.x - side.x, b.min.y - side.y, b.min.z - side.z},
                         {b.max.x + side.x, b.max.y + side.y, b.max.z + side.z}};
    return true;
}

static float convert(const sequence_data *s, const uint8_t *at) {
    uint16_t word = (uint16_t)(at[0] | (s->layout.texel > 1 ? at[1] << 8 : 0));
    switch (s->desc.raw.type[0]) {
    case 'u':
        return s->layout.texel == 1 ? (float)word / 255.0f : (float)word / 65535.0f;
    default:
        break;
    }
    if (s->layout.texel == 2) return half_to_float(word);
    uint32_t bits = (uint32_t)word | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static bool read_at(const sequence_data *s, uint64_t offset, uint8_t *out, size_t size) {
    size_t length;
    const char *path = s->files[0];
    int file = file_open_inside(s->desc.root, path, SIZE_MAX, &length);
    if (file < 0) return false;
    size_t done = 0;
    while (done < size) {
        ssize_t got = pread(file, out + done, size - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            bool ended = got == 0;
            err_set("%s: %s", path,
                    ended ? "it became shorter while it was read" : strerror(errno));
            close(file);
            return false;
        }
        done += (size_t)got;
    }
    close(file);
    return true;
}

typedef struct way { // through the box, along each axis of the file
    size_t start;
    ptrdiff_t step[3];
    uint32_t count[3];
} way;

static way find_way(const sequence_data *s) {
    const size_t steps[3] = {1, s->file_size[0], (size_t)s->file_size[0] * s->file_size[1]};
    way w = {.start = s->desc.raw.padding * (steps[0] + steps[1] + steps[2])};
    for (int i = 0; i < 3; i++) {
        int axis = s->layout.axes[i];
        w.count[i] = s->desc.raw.size[axis];
        w.step[i] = (ptrdiff_t)steps[axis];
        if (!s->layout.backwards[i]) continue;
        w.start += (w.count[i] - 1) * steps[axis];
        w.step[i] = -w.step[i];
    }
    return w;
}

static uint64_t place_values(const sequence_data *s, const uint8_t *bytes, float *out) {
    const way w = find_way(s);
    uint64_t bad = 0;
    for (uint32_t slow = 0; slow < w.count[2]; slow++)
        for (uint32_t middle = 0; middle < w.count[1]; middle++) {
            float *to = out + w.start + slow * w.step[2] + middle * w.step[1];
            for (uint32_t i = 0; i < w.count[0]; i++, bytes += s->layout.texel) {
                float v = convert(s, bytes) * s->desc.raw.value_scale;
                if (isfinite(v))
                    to[i * w.step[0]] = v;
                else
                    bad++;
            }
        }
    return bad;
}

bool sequence_raw_read(const sequence_data *s, uint32_t frame, float *out, uint64_t *bad) {
    size_t size = (size_t)s->layout.frame_bytes;
    uint8_t *bytes = mem_alloc(size);
    // No overflow: the frame lies inside the file.
    bool ok = read_at(s, s->layout.offset + frame * s->layout.stride, bytes, size);
    if (ok) *bad += place_values(s, bytes, out);
    mem_free(bytes);
    return ok;
}
