// OpenEXR through OpenEXRCore, the C library. Both directions go through memory: a file is complete
// before it appears under its name, and cannot change while it is read. Chunks (16 lines for ZIP,
// or one tile) pass through the library's pipeline, which gets the address of each channel's plane.
#include "media/exr.h"
#include "base/error.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/str.h"
#include <assert.h>
#include <openexr.h>
#include <string.h>

enum { SIDE_MAX = 16384, CHANNELS_MAX = 64 };

typedef struct stream {
    uint8_t *bytes;
    size_t size, capacity;
    char fault[200]; // the library's first message
} stream;

static void note_error(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)code;
    void *user = NULL;
    if (exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    stream *s = user;
    if (!s->fault[0]) str_copy(s->fault, sizeof s->fault, message);
}

static int64_t stream_size(exr_const_context_t context, void *user) {
    (void)context;
    return (int64_t)((stream *)user)->size;
}

static int64_t stream_read(exr_const_context_t context, void *user, void *out, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    const stream *s = user;
    if (offset >= s->size) return 0;
    if (size > s->size - offset) size = s->size - offset;
    memcpy(out, s->bytes + offset, size);
    return (int64_t)size;
}

static int64_t stream_write(exr_const_context_t context, void *user, const void *data,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    stream *s = user;
    size_t end = offset + size;
    s->bytes = mem_reserve(s->bytes, 1, end, &s->capacity);
    if (offset > s->size) memset(s->bytes + s->size, 0, offset - s->size);
    memcpy(s->bytes + offset, data, size);
    if (end > s->size) s->size = end;
    return (int64_t)size;
}

static exr_context_initializer_t settings(stream *s) {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = note_error;
    init.user_data = s;
    init.max_image_width = SIDE_MAX;
    init.max_image_height = SIDE_MAX;
    init.max_tile_width = SIDE_MAX;
    init.max_tile_height = SIDE_MAX;
    init.zip_level = 4;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

static bool fault(const char *path, const char *doing, const stream *s) {
    return err_set("%s: %s: %s", path, doing, s->fault[0] ? s->fault : "OpenEXR failed");
}

// A channel's plane in the format of the file.
typedef struct plane {
    const char *name;
    const uint8_t *values;
    exr_pixel_type_t type;
    int16_t size; // bytes of one value
} plane;

static void make_planes(const exr_image *image, arena *memory, plane *planes) {
    size_t count = (size_t)image->width * image->height;
    for (size_t c = 0; c < image->channel_count; c++) {
        const exr_channel *channel = &image->channels[c];
        planes[c] = (plane){channel->name, (const uint8_t *)channel->values, EXR_PIXEL_FLOAT, 4};
        if (!channel->half) continue;
        uint16_t *halves = arena_alloc(memory, count * sizeof *halves);
        for (size_t i = 0; i < count; i++) halves[i] = half_from_float(channel->values[i]);
        planes[c] = (plane){channel->name, (const uint8_t *)halves, EXR_PIXEL_HALF, 2};
    }
}

static exr_result_t write_chunk(exr_context_t context, const exr_image *image, const plane *planes,
                                int y, exr_encode_pipeline_t *pipe, bool first) {
    exr_chunk_info_t chunk;
    exr_result_t r = exr_write_scanline_chunk_info(context, 0, y, &chunk);
    if (r == EXR_ERR_SUCCESS)
        r = first ? exr_encoding_initialize(context, 0, &chunk, pipe)
                  : exr_encoding_update(context, 0, &chunk, pipe);
    for (int i = 0; r == EXR_ERR_SUCCESS && i < pipe->channel_count; i++) {
        exr_coding_channel_info_t *target = &pipe->channels[i];
        for (size_t c = 0; c < image->channel_count; c++) {
            const plane *p = &planes[c];
            if (strcmp(p->name, target->channel_name) != 0) continue;
            size_t pitch = (size_t)image->width * (size_t)p->size;
            target->user_data_type = (uint16_t)p->type;
            target->user_bytes_per_element = p->size;
            target->user_pixel_stride = p->size;
            target->user_line_stride = (int32_t)pitch;
            target->encode_from_ptr = p->values + (size_t)y * pitch;
        }
    }
    if (r == EXR_ERR_SUCCESS && first) r = exr_encoding_choose_default_routines(context, 0, pipe);
    if (r == EXR_ERR_SUCCESS) r = exr_encoding_run(context, 0, pipe);
    return r;
}

static exr_result_t write_all(exr_context_t context, const exr_image *image, const plane *planes,
                              const char *recipe) {
    int part;
    exr_result_t r = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (r == EXR_ERR_SUCCESS)
        r = exr_initialize_required_attr_simple(context, part, (int32_t)image->width,
                                                (int32_t)image->height, EXR_COMPRESSION_ZIP);
    for (size_t c = 0; r == EXR_ERR_SUCCESS && c < image->channel_count; c++)
        r = exr_add_channel(context, part, planes[c].name, planes[c].type,
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (r == EXR_ERR_SUCCESS && recipe)
        r = exr_attr_set_string(context, part, "roil:recipe", recipe);
    if (r == EXR_ERR_SUCCESS) r = exr_write_header(context);
    int32_t lines = 1;
    if (r == EXR_ERR_SUCCESS) r = exr_get_scanlines_per_chunk(context, part, &lines);
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    for (int y = 0; r == EXR_ERR_SUCCESS && y < (int)image->height; y += lines)
        r = write_chunk(context, image, planes, y, &pipe, y == 0);
    exr_encoding_destroy(context, &pipe);
    return r;
}

bool exr_write_with(const char *path, const exr_image *image, const char *recipe) {
    assert(image->channel_count > 0);
    if (image->width == 0 || image->height == 0 || image->width > SIDE_MAX ||
        image->height > SIDE_MAX)
        return err_set("%s: cannot write a picture of %ux%u; 1x1 to %dx%d is accepted", path,
                       image->width, image->height, SIDE_MAX, SIDE_MAX);
    arena memory = {0};
    plane *planes = arena_alloc(&memory, image->channel_count * sizeof *planes);
    make_planes(image, &memory, planes);
    stream s = {0};
    exr_context_initializer_t init = settings(&s);
    init.write_fn = stream_write;
    exr_context_t context;
    bool done = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init) == EXR_ERR_SUCCESS;
    if (done) {
        done = write_all(context, image, planes, recipe) == EXR_ERR_SUCCESS;
        done = exr_finish(&context) == EXR_ERR_SUCCESS && done;
    }
    done = done ? file_write(path, s.bytes, s.size) : fault(path, "cannot be encoded", &s);
    mem_free(s.bytes);
    arena_free(&memory);
    return done;
}

bool exr_write(const char *path, const exr_image *image) {
    return exr_write_with(path, image, NULL);
}

typedef struct reader {
    exr_context_t context;
    const stream *in;
    const char *path;
    const exr_wish *wish;
    exr_attr_box2i_t window;
    size_t width, height;
    float *const *planes;
    exr_decode_pipeline_t pipe;
    bool started;
} reader;

static bool read_chunk(reader *r, const exr_chunk_info_t *chunk, size_t x, size_t y) {
    exr_result_t code = r->started ? exr_decoding_update(r->context, 0, chunk, &r->pipe)
                                   : exr_decoding_initialize(r->context, 0, chunk, &r->pipe);
    bool first = !r->started;
    r->started = true;
    for (int i = 0; code == EXR_ERR_SUCCESS && i < r->pipe.channel_count; i++) {
        exr_coding_channel_info_t *target = &r->pipe.channels[i];
        target->user_data_type = EXR_PIXEL_FLOAT;
        target->user_bytes_per_element = sizeof(float);
        target->user_pixel_stride = sizeof(float);
        target->user_line_stride = (int32_t)(r->width * sizeof(float));
        target->decode_to_ptr = (uint8_t *)(r->planes[i] + y * r->width + x);
    }
    if (x + (size_t)chunk->width > r->width || y + (size_t)chunk->height > r->height)
        return err_set("%s: damaged EXR file: a chunk leaves the picture", r->path);
    if (code == EXR_ERR_SUCCESS && first)
        code = exr_decoding_choose_default_routines(r->context, 0, &r->pipe);
    if (code == EXR_ERR_SUCCESS) code = exr_decoding_run(r->context, 0, &r->pipe);
    return code == EXR_ERR_SUCCESS || fault(r->path, "cannot be read as EXR", r->in);
}

static bool read_lines(reader *r) {
    int32_t step;
    if (exr_get_scanlines_per_chunk(r->context, 0, &step) != EXR_ERR_SUCCESS || step < 1)
        return fault(r->path, "cannot be read as EXR", r->in);
    for (size_t y = 0; y < r->height; y += (size_t)step) {
        exr_chunk_info_t chunk;
        if (exr_read_scanline_chunk_info(r->context, 0, r->window.min.y + (int)y, &chunk) !=
            EXR_ERR_SUCCESS)
            return fault(r->path, "cannot be read as EXR", r->in);
        if (!read_chunk(r, &chunk, 0, y)) return false;
    }
    return true;
}

static bool read_tiles(reader *r) {
    int32_t step_x, step_y; // of the first level, the whole picture
    if (exr_get_tile_sizes(r->context, 0, 0, 0, &step_x, &step_y) != EXR_ERR_SUCCESS ||
        step_x < 1 || step_y < 1)
        return fault(r->path, "cannot be read as EXR", r->in);
    for (size_t y = 0; y < r->height; y += (size_t)step_y)
        for (size_t x = 0; x < r->width; x += (size_t)step_x) {
            exr_chunk_info_t chunk;
            if (exr_read_tile_chunk_info(r->context, 0, (int)(x / (size_t)step_x),
                                         (int)(y / (size_t)step_y), 0, 0,
                                         &chunk) != EXR_ERR_SUCCESS)
                return fault(r->path, "cannot be read as EXR", r->in);
            if (!read_chunk(r, &chunk, x, y)) return false;
        }
    return true;
}

static bool is_wanted(const exr_wish *wish, const char *name) {
    return !wish->letters || (name[0] && !name[1] && strchr(wish->letters, name[0]));
}

// Makes room for the wanted channels, and one plane for all others. OpenEXR 3.1 says that it skips
// a channel without an address, but crashes when all channels are halves.
static bool make_room(reader *r, const exr_attr_chlist_t *list, arena *memory, exr_image *out) {
    size_t count = (size_t)list->num_channels, wanted = 0;
    for (size_t c = 0; c < count; c++) wanted += is_wanted(r->wish, list->entries[c].name.str);
    size_t pixel = (wanted + (wanted < count)) * sizeof(float);
    int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1;
    int64_t height = (int64_t)r->window.max.y - r->window.min.y + 1;
    if (!picture_limits_allow(&r->wish->limits, r->path, width, height, pixel)) return false;
    if (!memory) {
        *out = (exr_image){(uint32_t)width, (uint32_t)height, NULL, 0};
        return true;
    }
    r->width = (size_t)width;
    r->height = (size_t)height;
    exr_channel *channels = arena_alloc(memory, count * sizeof *channels);
    float **planes = arena_alloc(memory, count * sizeof *planes), *spare = NULL;
    *out = (exr_image){(uint32_t)width, (uint32_t)height, channels, 0};
    for (size_t c = 0; c < count; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        if (!is_wanted(r->wish, entry->name.str)) {
            if (!spare) spare = arena_alloc(memory, r->width * r->height * sizeof(float));
            planes[c] = spare;
            continue;
        }
        planes[c] = arena_alloc(memory, r->width * r->height * sizeof(float));
        channels[out->channel_count++] = (exr_channel){
            arena_string(memory, entry->name.str), planes[c], entry->pixel_type == EXR_PIXEL_HALF};
    }
    r->planes = planes;
    return true;
}

// Reads the size and the channels, and allocates the planes.
static bool read_shape(reader *r, arena *memory, exr_image *out) {
    int parts = 0;
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_count(r->context, &parts) != EXR_ERR_SUCCESS ||
        exr_get_data_window(r->context, 0, &r->window) != EXR_ERR_SUCCESS ||
        exr_get_channels(r->context, 0, &list) != EXR_ERR_SUCCESS)
        return fault(r->path, "cannot be read as EXR", r->in);
    if (parts != 1)
        return err_set("%s: EXR file of %d parts; one part is accepted", r->path, parts);
    int count = list->num_channels;
    if (count < 1 || count > CHANNELS_MAX)
        return err_set("%s: EXR picture of %d channels; 1 to %d are accepted", r->path, count,
                       CHANNELS_MAX);
    for (int c = 0; c < count; c++)
        if (list->entries[c].x_sampling != 1 || list->entries[c].y_sampling != 1)
            return err_set("%s: EXR channel '%s' is subsampled; full channels are accepted",
                           r->path, list->entries[c].name.str);
    return make_room(r, list, memory, out);
}

static bool read_picture(reader *r, arena *memory, exr_image *out) {
    exr_storage_t storage;
    if (!read_shape(r, memory, out)) return false;
    if (!memory) return true;
    if (exr_get_storage(r->context, 0, &storage) != EXR_ERR_SUCCESS)
        return fault(r->path, "cannot be read as EXR", r->in);
    bool done = false;
    if (storage == EXR_STORAGE_SCANLINE)
        done = read_lines(r);
    else if (storage == EXR_STORAGE_TILED)
        done = read_tiles(r);
    else
        err_set("%s: deep EXR file; scanline and tiled files are accepted", r->path);
    exr_decoding_destroy(r->context, &r->pipe);
    return done;
}

bool exr_decode(const void *data, size_t size, const char *name, const exr_wish *wish,
                arena *memory, exr_image *out) {
    stream s = {.bytes = (uint8_t *)(uintptr_t)data, .size = size}; // only read
    exr_context_initializer_t init = settings(&s);
    init.read_fn = stream_read;
    init.size_fn = stream_size;
    reader r = {.in = &s, .path = name, .wish = wish};
    bool done = exr_start_read(&r.context, name, &init) == EXR_ERR_SUCCESS;
    if (done) {
        done = read_picture(&r, memory, out);
        exr_finish(&r.context);
    } else {
        fault(name, "cannot be read as EXR", &s);
    }
    if (!done) *out = (exr_image){0};
    return done;
}

const float *exr_find(const exr_image *image, const char *channel) {
    for (size_t c = 0; c < image->channel_count; c++)
        if (strcmp(image->channels[c].name, channel) == 0) return image->channels[c].values;
    return NULL;
}
