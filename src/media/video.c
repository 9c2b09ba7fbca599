// Films through libavformat and libavcodec, whose kinds are rows of a table. The file is a draft
// that gets its name at the end (base/file.h), so that a process that is killed leaves nothing.
// libavformat, which opens the file again to move the index to its front, reaches it by its
// descriptor. Where colours have half the size, pictures are padded to even sizes; they are
// converted with the BT.709 matrix, and tagged so. Frame n is shown at time n / fps.
#include "media/video.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/str.h"
#include "media/av.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { SIDE_MAX = 16384, TIME_BASE_MAX = 1001000, MPEG4_QUANTISER = 3, KEY_SECONDS = 2 };

typedef struct film_kind {
    const char *extension, *muxer;
    const char *encoders[2];          // the first that there is
    enum AVPixelFormat opaque, clear; // clear: with alpha; NONE: it keeps none
    bool halves;                      // colours have half the size
    const char *options[4][2];        // of the encoder; those that it does not know are passed over
    const char *name;
} film_kind;

static const film_kind kinds[] = {
    {"mp4",
     "mp4",
     {"libx264", "mpeg4"},
     AV_PIX_FMT_YUV420P,
     AV_PIX_FMT_NONE,
     true,
     {{"crf", "18"}, {"preset", "medium"}},
     "H.264 or MPEG-4"},
    {"webm",
     "webm",
     {"libvpx-vp9"},
     AV_PIX_FMT_YUV420P,
     AV_PIX_FMT_YUVA420P,
     true,
     {{"crf", "20"}, {"row-mt", "1"}, {"cpu-used", "4"}},
     "VP9"},
    {"mov",
     "mov",
     {"prores_ks"},
     AV_PIX_FMT_YUV444P10LE,
     AV_PIX_FMT_YUVA444P10LE,
     false,
     {{"profile", "4444"}, {"vendor", "apl0"}, {"alpha_bits", "16"}},
     "ProRes"},
    {"gif", "gif", {"gif"}, AV_PIX_FMT_PAL8, AV_PIX_FMT_PAL8, false, {{NULL}}, "GIF"},
    {"apng",
     "apng",
     {"apng"},
     AV_PIX_FMT_RGB24,
     AV_PIX_FMT_RGBA,
     false,
     {{"pred", "mixed"}},
     "APNG"},
};

struct video {
    const film_kind *kind;
    bool alpha;
    enum AVPixelFormat pixels;
    char path[PATH_CAP];
    file_draft draft;
    bool drafting; // `draft` has begun
    char *comment; // NULL: none
    uint32_t width, height, even_width, even_height;
    int64_t frames;
    uint8_t *padded; // NULL when both sizes are even
    AVFormatContext *format;
    AVCodecContext *encoder;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
    struct SwsContext *scaler;
};

static bool fault(const video *v, const char *doing, int code) {
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av.av_strerror(code, text, sizeof text);
    return err_set("%s: %s: %s", v->path, doing, text);
}

static bool is_yuv(const video *v) {
    return v->pixels != AV_PIX_FMT_PAL8 && v->pixels != AV_PIX_FMT_RGB24 &&
           v->pixels != AV_PIX_FMT_RGBA;
}

static bool open_encoder(video *v, double fps) {
    const film_kind *kind = v->kind;
    const AVCodec *codec = av.avcodec_find_encoder_by_name(kind->encoders[0]);
    const bool best = codec != NULL;
    if (!codec && kind->encoders[1]) codec = av.avcodec_find_encoder_by_name(kind->encoders[1]);
    if (!codec) return err_set("%s: this libavcodec encodes no %s", v->path, kind->name);
    AVCodecContext *e = v->encoder = av.avcodec_alloc_context3(codec);
    if (!e) return err_no_memory(sizeof *e);
    AVRational rate = av.av_d2q(fps, TIME_BASE_MAX);
    if (!best && (rate.num > 65535 || rate.den > 65535)) rate = av.av_d2q(fps, 65535);
    e->width = (int)v->even_width;
    e->height = (int)v->even_height;
    e->pix_fmt = v->pixels;
    e->framerate = rate;
    e->time_base = av_inv_q(rate);
    e->gop_size = (int)ceil(fps * KEY_SECONDS);
    if (is_yuv(v)) {
        e->color_range = AVCOL_RANGE_MPEG;
        e->colorspace = AVCOL_SPC_BT709;
        e->color_primaries = AVCOL_PRI_BT709;
        e->color_trc = AVCOL_TRC_BT709;
    }
    e->sample_aspect_ratio = (AVRational){1, 1};
    if (v->format->oformat->flags & AVFMT_GLOBALHEADER) e->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    for (size_t i = 0; best && i < COUNT_OF(kind->options) && kind->options[i][0]; i++)
        av.av_opt_set(e->priv_data, kind->options[i][0], kind->options[i][1], 0);
    if (!best) {
        e->flags |= AV_CODEC_FLAG_QSCALE;
        e->global_quality = MPEG4_QUANTISER * FF_QP2LAMBDA;
    }
    int code = av.avcodec_open2(e, codec, NULL);
    return code >= 0 || fault(v, "the video encoder does not start", code);
}

static bool open_file(video *v) {
    v->stream = av.avformat_new_stream(v->format, NULL);
    if (!v->stream) return err_no_memory(sizeof *v->stream);
    v->format->flags |= AVFMT_FLAG_BITEXACT; // no number of chance in it
    v->stream->time_base = v->encoder->time_base;
    v->stream->avg_frame_rate = v->encoder->framerate;
    int code = av.avcodec_parameters_from_context(v->stream->codecpar, v->encoder);
    if (code >= 0) code = av.avio_open(&v->format->pb, v->format->url, AVIO_FLAG_WRITE);
    if (code < 0) return fault(v, "cannot be written", code);
    AVDictionary *options = NULL;
    av.av_dict_set(&options, "movflags", "+faststart", 0);
    av.av_dict_set(&options, "plays", "0", 0); // of an APNG: for ever, as a GIF does
    code = av.avformat_write_header(v->format, &options);
    av.av_dict_free(&options);
    return code >= 0 || fault(v, "cannot be written", code);
}

static bool open_converter(video *v) {
    v->frame = av.av_frame_alloc();
    v->packet = av.av_packet_alloc();
    int width = (int)v->even_width, height = (int)v->even_height;
    const bool palette = v->pixels == AV_PIX_FMT_PAL8;
    if (!palette)
        v->scaler = av.sws_getContext(width, height, AV_PIX_FMT_RGBA, width, height, v->pixels,
                                      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, NULL,
                                      NULL, NULL);
    if (!v->frame || !v->packet || (!v->scaler && !palette))
        return err_set("%s: no conversion to video at %dx%d", v->path, width, height);
    v->frame->format = v->pixels;
    v->frame->width = width;
    v->frame->height = height;
    if (is_yuv(v)) {
        const int *bt709 = av.sws_getCoefficients(SWS_CS_ITU709);
        av.sws_setColorspaceDetails(v->scaler, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
        v->frame->color_range = AVCOL_RANGE_MPEG;
        v->frame->colorspace = AVCOL_SPC_BT709;
    }
    int code = av.av_frame_get_buffer(v->frame, 0);
    if (code < 0) return fault(v, "no memory for a frame", code);
    if (v->even_width != v->width || v->even_height != v->height)
        v->padded = mem_alloc((size_t)v->even_width * v->even_height * 4);
    return true;
}

bool video_is_film(const char *path) {
    for (size_t i = 0; i < COUNT_OF(kinds); i++)
        if (strcmp(path_extension(path), kinds[i].extension) == 0) return true;
    return false;
}

static const film_kind *kind_of(const char *path, bool alpha) {
    const film_kind *kind = &kinds[0];
    for (size_t i = 0; i < COUNT_OF(kinds); i++)
        if (strcmp(path_extension(path), kinds[i].extension) == 0) kind = &kinds[i];
    if (!alpha || kind->clear != AV_PIX_FMT_NONE) return kind;
    err_set("%s: an .%s keeps no alpha; .webm, .mov, .gif and .apng do", path, kind->extension);
    return NULL;
}

video *video_create(const char *path, uint32_t width, uint32_t height, double fps, bool alpha) {
    const film_kind *kind = kind_of(path, alpha);
    if (!kind) return NULL;
    if (width == 0 || height == 0 || width > SIDE_MAX || height > SIDE_MAX) {
        err_set("%s: cannot write a video of %ux%u; 1x1 to %dx%d is accepted", path, width, height,
                SIDE_MAX, SIDE_MAX);
        return NULL;
    }
    if (!(fps >= 0.01 && fps <= 1000.0)) {
        err_set("%s: cannot write a video of %g frames a second; 0.01 to 1000 is accepted", path,
                fps);
        return NULL;
    }
    if (!av_load()) {
        err_prefix("%s: ", path);
        return NULL;
    }
    av.av_log_set_level(AV_LOG_QUIET); // our messages, not the encoder's
    video *v = mem_alloc(sizeof *v);
    *v = (video){.kind = kind, .alpha = alpha, .width = width, .height = height};
    v->pixels = alpha ? kind->clear : kind->opaque;
    v->even_width = width + (kind->halves ? width & 1 : 0);
    v->even_height = height + (kind->halves ? height & 1 : 0);
    char opened[64];
    bool done = str_copy(v->path, sizeof v->path, path) || path_too_long(path);
    done = v->drafting = done && file_draft_begin(&v->draft, path);
    snprintf(opened, sizeof opened, "/proc/self/fd/%d", v->draft.fd);
    if (done && av.avformat_alloc_output_context2(&v->format, NULL, kind->muxer, opened) < 0)
        done = err_set("%s: this libavformat writes no .%s", path, kind->extension);
    if (done && open_encoder(v, fps) && open_file(v) && open_converter(v)) return v;
    video_abandon(v);
    return NULL;
}

// Sends a frame and writes the packets that are ready. `frame` NULL ends the video.
static bool video_encode(video *v, const AVFrame *frame) {
    int code = av.avcodec_send_frame(v->encoder, frame);
    if (code < 0) return fault(v, "cannot be encoded", code);
    for (;;) {
        code = av.avcodec_receive_packet(v->encoder, v->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return true;
        if (code < 0) return fault(v, "cannot be encoded", code);
        if (v->packet->duration == 0) v->packet->duration = 1;
        av.av_packet_rescale_ts(v->packet, v->encoder->time_base, v->stream->time_base);
        v->packet->stream_index = v->stream->index;
        code = av.av_interleaved_write_frame(v->format, v->packet);
        if (code >= 0) code = v->format->pb->error;
        if (code < 0) return fault(v, "cannot be written", code);
    }
}

// Repeats the last column and row.
static const uint8_t *pad(video *v, const uint8_t *rgba) {
    if (!v->padded) return rgba;
    size_t from = (size_t)v->width * 4, to = (size_t)v->even_width * 4;
    for (uint32_t y = 0; y < v->even_height; y++) {
        const uint8_t *source = rgba + from * (y < v->height ? y : v->height - 1);
        uint8_t *row = v->padded + to * y;
        memcpy(row, source, from);
        if (to > from) memcpy(row + from, source + from - 4, 4);
    }
    return v->padded;
}

// ---- GIF --------------------------------------------------------------------------------------

enum { REDS = 6, GREENS = 7, BLUES = 6, CLEAR = REDS * GREENS * BLUES };

// The encoder takes the first colour without alpha for the clear one.
static void fill_palette(uint32_t palette[256], bool alpha) {
    for (uint32_t i = CLEAR; i < 256; i++) palette[i] = alpha && i == CLEAR ? 0 : 0xff000000u;
    for (uint32_t i = 0; i < CLEAR; i++) {
        const uint32_t r = i / (GREENS * BLUES) * 255 / (REDS - 1),
                       g = i / BLUES % GREENS * 255 / (GREENS - 1);
        palette[i] = 0xff000000u | r << 16 | g << 8 | i % BLUES * 255 / (BLUES - 1);
    }
}

// Of an 8 x 8 matrix, 0 to 63 (Bayer, "An optimum method for two-level rendition of continuous-tone
// pictures", 1973): the bits of x ^ y and y, the least first.
static uint32_t threshold(uint32_t x, uint32_t y) {
    uint32_t out = 0;
    for (int i = 0; i < 3; i++) out = out << 2 | ((x ^ y) >> i & 1) << 1 | (y >> i & 1);
    return out;
}

// One palette for all films, so that colours do not flicker from frame to frame.
static void dither(const video *v, const uint8_t *rgba) {
    static const uint32_t steps[3] = {REDS - 1, GREENS - 1, BLUES - 1};
    fill_palette((uint32_t *)(void *)v->frame->data[1], v->alpha);
    for (uint32_t y = 0; y < v->height; y++) {
        uint8_t *row = v->frame->data[0] + (ptrdiff_t)y * v->frame->linesize[0];
        for (uint32_t x = 0; x < v->width; x++, rgba += 4) {
            const uint32_t noise = threshold(x, y) * 255 / 64 + 2;
            uint32_t index = 0;
            for (int c = 0; c < 3; c++)
                index = index * (steps[c] + 1) + (rgba[c] * steps[c] + noise) / 255;
            row[x] = v->alpha && rgba[3] < noise ? CLEAR : (uint8_t)index;
        }
    }
}

bool video_add(video *v, const uint8_t *rgba) {
    int code = av.av_frame_make_writable(v->frame);
    if (code < 0) return fault(v, "no memory for a frame", code);
    const uint8_t *planes[1] = {pad(v, rgba)};
    const int pitches[1] = {(int)v->even_width * 4};
    if (v->pixels == AV_PIX_FMT_PAL8)
        dither(v, rgba);
    else
        av.sws_scale(v->scaler, planes, pitches, 0, (int)v->even_height, v->frame->data,
                     v->frame->linesize);
    v->frame->pts = v->frames++;
    return video_encode(v, v->frame);
}

static void put_be(uint8_t *out, uint32_t value) {
    for (int i = 0; i < 4; i++) out[i] = (uint8_t)(value >> (24 - 8 * i));
}

// A chunk of text, before the last one, which is 12 bytes.
static void add_apng_text(video *v) {
    static const char key[] = "roil:recipe";
    const size_t length = sizeof key + strlen(v->comment);
    uint8_t end[12], *chunk = mem_alloc(length + 12);
    const off_t size = lseek(v->draft.fd, 0, SEEK_END);
    if (size > 12 && pread(v->draft.fd, end, sizeof end, size - 12) == (ssize_t)sizeof end) {
        put_be(chunk, (uint32_t)length);
        memcpy(chunk + 4, "tEXt", 4);
        memcpy(chunk + 8, key, sizeof key);
        memcpy(chunk + 8 + sizeof key, v->comment, strlen(v->comment));
        put_be(chunk + 8 + length, (uint32_t)crc32(0, chunk + 4, (uInt)length + 4));
        file_draft_patch(&v->draft, (uint64_t)size - 12, chunk, length + 12);
        file_draft_add(&v->draft, end, sizeof end);
    }
    mem_free(chunk);
}

// An element of EBML that readers pass over, at the end of the segment, whose size it adds to. A
// size of 8 bytes begins with 1.
static void add_webm_void(video *v) {
    static const uint8_t segment[] = {0x18, 0x53, 0x80, 0x67, 0x01};
    const size_t length = strlen(v->comment);
    uint8_t begin[256], head[9] = {0xec, 0x01}, size[7];
    const ssize_t count = pread(v->draft.fd, begin, sizeof begin, 0);
    const uint8_t *at = count > 0 ? memmem(begin, (size_t)count, segment, sizeof segment) : NULL;
    if (!at || at + sizeof segment + sizeof size > begin + count) return;
    at += sizeof segment;
    uint64_t sum = sizeof head + length;
    for (int i = 6; i >= 0; i--, sum >>= 8) {
        sum += at[i];
        size[i] = (uint8_t)sum;
    }
    put_be(head + 5, (uint32_t)length);
    file_draft_add(&v->draft, head, sizeof head);
    file_draft_add(&v->draft, v->comment, length);
    file_draft_patch(&v->draft, (uint64_t)(at - begin), size, sizeof size);
}

// An extension before the last byte, with text as it is, as Adobe puts XMP there (XMP part 3):
// readers take each letter for the length of a block and land in the bytes that follow, which lead
// to the end.
static void add_gif_text(video *v) {
    static const uint8_t head[] = "\x21\xff\x0broil:recipe";
    uint8_t rest[259] = {1}; // 255 to 0, 0, and the end of the file
    const off_t size = lseek(v->draft.fd, 0, SEEK_END);
    if (size < 1) return;
    for (int i = 0; i < 256; i++) rest[1 + i] = (uint8_t)(255 - i);
    rest[258] = ';';
    file_draft_patch(&v->draft, (uint64_t)size - 1, head, sizeof head - 1);
    file_draft_add(&v->draft, v->comment, strlen(v->comment));
    file_draft_add(&v->draft, rest, sizeof rest);
}

// Files of these kinds are said to be whole before one knows what to say.
static void add_comment(video *v) {
    const char *muxer = v->format->oformat->name;
    if (!v->comment || lseek(v->draft.fd, 0, SEEK_END) < 0) return;
    if (strcmp(muxer, "apng") == 0) add_apng_text(v);
    if (strcmp(muxer, "webm") == 0) add_webm_void(v);
    if (strcmp(muxer, "gif") == 0) add_gif_text(v);
}

static bool close_file(video *v) {
    int code = av.av_write_trailer(v->format);
    if (code >= 0) code = v->format->pb->error;
    int closed = av.avio_closep(&v->format->pb);
    if (code >= 0) code = closed;
    if (code < 0) return fault(v, "cannot be written", code);
    v->drafting = false;
    add_comment(v);
    return file_draft_end(&v->draft);
}

void video_set_comment(video *v, const char *text) {
    av.av_dict_set(&v->format->metadata, "comment", text, 0); // of .mp4 and .mov
    v->comment = mem_copy(text, strlen(text) + 1);
}

bool video_finish(video *v) {
    bool done = v->frames > 0 || err_set("%s: a video needs at least one frame", v->path);
    done = done && video_encode(v, NULL) && close_file(v);
    video_abandon(v);
    return done;
}

void video_abandon(video *v) {
    if (!v) return;
    if (v->format && v->format->pb) av.avio_closep(&v->format->pb);
    av.avformat_free_context(v->format);
    av.avcodec_free_context(&v->encoder);
    av.av_frame_free(&v->frame);
    av.av_packet_free(&v->packet);
    av.sws_freeContext(v->scaler);
    mem_free(v->padded);
    mem_free(v->comment);
    if (v->drafting) file_draft_drop(&v->draft);
    mem_free(v);
}
