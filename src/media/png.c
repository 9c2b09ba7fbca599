// PNG through libpng. A picture is compressed into memory and then written by file_write, so nobody
// reads half a file. A picture is read from memory, so a hostile file can only ask for what the
// limits below allow. libpng reports errors by longjmp: everything that must survive one is in
// `session`, which the caller of setjmp owns and never keeps in a register.
#include "media/png.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/str.h"
#include <assert.h>
#include <setjmp.h>
#include <string.h>

// libpng has types of the same names as ours.
#define png_image libpng_image
#define png_text libpng_text
#include <png.h>
#undef png_image
#undef png_text

enum {
    SIDE_MAX = 16384,
    CHUNK_BYTES_MAX = 8 << 20,
    CHUNKS_MAX = 128,
    KEY_MAX = 79,
    TEXT_BYTES_MAX = 1 << 20
};

typedef struct session {
    const char *name; // for messages
    png_structp png;
    png_infop info;
    const uint8_t *input; // reading
    size_t size, at;
    strbuf output; // writing
    char fault[160];
    bool refused; // the message is set, and names the file
} session;

static void png_on_error(png_structp png, const char *message) {
    session *s = png_get_error_ptr(png);
    str_copy(s->fault, sizeof s->fault, message);
    png_longjmp(png, 1);
}

static void warn(png_structp png, const char *message) {
    session *s = png_get_error_ptr(png);
    log_write(LOG_DEBUG, "%s: %s", s->name, message);
}

static void png_on_write(png_structp png, png_bytep bytes, size_t count) {
    session *s = png_get_io_ptr(png);
    strbuf_append(&s->output, (const char *)bytes, count);
}

static void png_on_flush(png_structp png) {
    (void)png;
}

static void png_on_read(png_structp png, png_bytep bytes, size_t count) {
    session *s = png_get_io_ptr(png);
    if (count > s->size - s->at) png_error(png, "the file ends too early");
    memcpy(bytes, s->input + s->at, count);
    s->at += count;
}

static bool is_ascii(const char *text) {
    for (; *text; text++)
        if ((unsigned char)*text > 126) return false;
    return true;
}

// Writes tEXt where that can hold the value, else UTF-8 text (iTXt).
static void add_texts(session *s, const png_text *texts, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char key[KEY_MAX + 1], language[1] = "";
        str_copy(key, sizeof key, texts[i].key);
        libpng_text text = {.key = key, .text = (char *)texts[i].value};
        text.lang = language;
        text.lang_key = language;
        if (is_ascii(texts[i].value)) {
            text.compression = PNG_TEXT_COMPRESSION_NONE;
            text.text_length = strlen(texts[i].value);
        } else {
            text.compression = PNG_ITXT_COMPRESSION_NONE;
            text.itxt_length = strlen(texts[i].value);
        }
        png_set_text(s->png, s->info, &text, 1);
    }
}

static bool session_encode(session *s, const png_image *image, const png_text *texts,
                           size_t text_count) {
    if (setjmp(png_jmpbuf(s->png))) return false;
    png_set_write_fn(s->png, s, png_on_write, png_on_flush);
    png_set_user_limits(s->png, SIDE_MAX, SIDE_MAX);
    // Render sequences are written often and looked at once: speed before the last tenth of size.
    png_set_compression_level(s->png, 4);
    png_set_filter(s->png, 0, PNG_FAST_FILTERS);
    int type = image->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    png_set_IHDR(s->png, s->info, image->width, image->height, image->bits, type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(s->png, s->info, PNG_sRGB_INTENT_PERCEPTUAL);
    add_texts(s, texts, text_count);
    png_write_info(s->png, s->info);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (image->bits == 16) png_set_swap(s->png);
#endif
    size_t pitch = (size_t)image->width * (size_t)image->channels * (size_t)(image->bits / 8);
    for (uint32_t y = 0; y < image->height; y++)
        png_write_row(s->png, (png_const_bytep)image->pixels + y * pitch);
    png_write_end(s->png, s->info);
    return true;
}

// Writes below `root`, or without one wherever `path` leads.
static bool write_picture(const char *root, const char *path, const png_image *image,
                          const png_text *texts, size_t text_count) {
    assert(image->channels == 3 || image->channels == 4);
    assert(image->bits == 8 || image->bits == 16);
    if (image->width == 0 || image->height == 0 || image->width > SIDE_MAX ||
        image->height > SIDE_MAX)
        return err_set("%s: cannot write a picture of %ux%u; 1x1 to %dx%d is accepted", path,
                       image->width, image->height, SIDE_MAX, SIDE_MAX);
    session s = {.name = path};
    s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &s, png_on_error, warn);
    s.info = s.png ? png_create_info_struct(s.png) : NULL;
    bool done =
        s.info ? session_encode(&s, image, texts, texts ? text_count : 0) : err_no_memory(sizeof s);
    png_destroy_write_struct(&s.png, &s.info);
    if (done)
        done = root ? file_write_inside(root, path, s.output.text, s.output.length)
                    : file_write(path, s.output.text, s.output.length);
    else
        err_set("%s: cannot be encoded: %s", path, s.fault);
    strbuf_free(&s.output);
    return done;
}

bool png_write(const char *path, const png_image *image, const png_text *texts, size_t text_count) {
    return write_picture(NULL, path, image, texts, text_count);
}

bool png_write_inside(const char *root, const char *path, const png_image *image) {
    return write_picture(root, path, image, NULL, 0);
}

// Asks libpng to turn every colour type into RGBA of 8 or 16 bits.
static void ask_for_rgba(session *s) {
    int type = png_get_color_type(s->png, s->info);
    int bits = png_get_bit_depth(s->png, s->info);
    png_set_expand(s->png);
    if (type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_GRAY_ALPHA)
        png_set_gray_to_rgb(s->png);
    png_set_add_alpha(s->png, bits == 16 ? 0xffff : 0xff, PNG_FILLER_AFTER);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (bits == 16) png_set_swap(s->png);
#endif
    png_set_interlace_handling(s->png);
    png_read_update_info(s->png, s->info);
}

static void read_header(session *s) { // all that stands before the pixels
    png_set_read_fn(s->png, s, png_on_read);
    png_set_user_limits(s->png, SIDE_MAX, SIDE_MAX);
    png_set_chunk_malloc_max(s->png, CHUNK_BYTES_MAX);
    png_set_chunk_cache_max(s->png, CHUNKS_MAX);
    png_read_info(s->png, s->info);
}

static bool session_decode(session *s, const picture_limits *limits, arena *memory,
                           png_image *out) {
    if (setjmp(png_jmpbuf(s->png))) return false;
    read_header(s);
    ask_for_rgba(s);
    s->refused = !picture_limits_allow(limits, s->name, png_get_image_width(s->png, s->info),
                                       png_get_image_height(s->png, s->info),
                                       4 * (size_t)png_get_bit_depth(s->png, s->info) / 8);
    if (s->refused) return false;
    out->width = png_get_image_width(s->png, s->info);
    out->height = png_get_image_height(s->png, s->info);
    out->bits = png_get_bit_depth(s->png, s->info);
    out->channels = 4;
    if (!memory) return true;
    size_t pitch = (size_t)out->width * 4 * (size_t)(out->bits / 8);
    if (png_get_rowbytes(s->png, s->info) != pitch) png_error(s->png, "unknown pixel layout");
    uint8_t *pixels = arena_alloc(memory, pitch * out->height);
    png_bytepp rows = arena_alloc(memory, out->height * sizeof *rows);
    for (uint32_t y = 0; y < out->height; y++) rows[y] = pixels + y * pitch;
    out->pixels = pixels;
    png_read_image(s->png, rows);
    png_read_end(s->png, NULL);
    return true;
}

static bool open_input(session *s, const void *data, size_t size, const char *name) {
    if (size < 8 || png_sig_cmp(data, 0, 8) != 0) return err_set("%s: is not a PNG file", name);
    *s = (session){.name = name, .input = data, .size = size};
    s->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, s, png_on_error, warn);
    s->info = s->png ? png_create_info_struct(s->png) : NULL;
    if (s->info) return true;
    png_destroy_read_struct(&s->png, NULL, NULL);
    return err_no_memory(sizeof *s);
}

bool png_decode(const void *data, size_t size, const char *name, const picture_limits *limits,
                arena *memory, png_image *out) {
    session s;
    *out = (png_image){0};
    if (!open_input(&s, data, size, name)) return false;
    bool done = session_decode(&s, limits, memory, out);
    png_destroy_read_struct(&s.png, &s.info, NULL);
    if (done) return true;
    *out = (png_image){0};
    return !s.refused && err_set("%s: cannot be read as PNG (at most %dx%d): %s", name, SIDE_MAX,
                                 SIDE_MAX, s.fault);
}

// ---- texts ------------------------------------------------------------------------------------

static bool decode_texts(session *s, arena *memory, png_text *out, size_t *count) {
    if (setjmp(png_jmpbuf(s->png))) return false;
    read_header(s);
    libpng_text *texts = NULL;
    int found = png_get_text(s->png, s->info, &texts, NULL);
    size_t left = TEXT_BYTES_MAX;
    for (int i = 0; i < found && *count < PNG_MAX_TEXTS; i++) {
        if (!texts[i].key || !texts[i].text) continue;
        size_t size = strlen(texts[i].key) + strlen(texts[i].text);
        if (size > left) continue;
        left -= size;
        out[(*count)++] =
            (png_text){arena_string(memory, texts[i].key), arena_string(memory, texts[i].text)};
    }
    return true;
}

bool png_decode_texts(const void *data, size_t size, const char *name, arena *memory,
                      png_text out[PNG_MAX_TEXTS], size_t *count) {
    session s;
    *count = 0;
    if (!open_input(&s, data, size, name)) return false;
    bool done = decode_texts(&s, memory, out, count);
    png_destroy_read_struct(&s.png, &s.info, NULL);
    return done || err_set("%s: cannot be read as PNG: %s", name, s.fault);
}
