// MP4: the film has the frames, the size and the colours that it was given.
#include "media_test.h"

#include "media/video.h"
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

enum { FRAMES = 10 };

static uint8_t *picture(uint32_t width, uint32_t height, const uint8_t rgb[3]) {
    uint8_t *rgba = mem_alloc((size_t)width * height * 4);
    for (size_t i = 0; i < (size_t)width * height; i++) memcpy(rgba + 4 * i, rgb, 3);
    return rgba;
}

static bool write_film(const char *path, uint32_t width, uint32_t height) {
    static const uint8_t ORANGE[3] = {240, 120, 20};
    video *v = video_create(path, width, height, 24.0, false);
    if (!v) return false;
    uint8_t *rgba = picture(width, height, ORANGE);
    bool good = true;
    for (int i = 0; i < FRAMES && good; i++) good = video_add(v, rgba);
    mem_free(rgba);
    if (good) return video_finish(v);
    video_abandon(v);
    return false;
}

typedef struct probe {
    int frames, width, height;
    double fps;
    uint8_t yuv[3]; // of the first frame's first pixel
    enum AVColorSpace space;
} probe;

static probe examine(const char *path) {
    probe p = {0};
    AVFormatContext *format = NULL;
    assert_int_equal(avformat_open_input(&format, path, NULL, NULL), 0);
    assert_true(avformat_find_stream_info(format, NULL) >= 0);
    assert_int_equal(format->nb_streams, 1);
    AVStream *stream = format->streams[0];
    const AVCodec *codec = avcodec_find_decoder(stream->codecpar->codec_id);
    AVCodecContext *decoder = avcodec_alloc_context3(codec);
    avcodec_parameters_to_context(decoder, stream->codecpar);
    assert_int_equal(avcodec_open2(decoder, codec, NULL), 0);
    AVPacket *packet = av_packet_alloc();
    AVFrame *frame = av_frame_alloc();
    bool more = true;
    while (more) {
        more = av_read_frame(format, packet) >= 0;
        avcodec_send_packet(decoder, more ? packet : NULL);
        while (avcodec_receive_frame(decoder, frame) >= 0) {
            if (p.frames++ == 0)
                for (int i = 0; i < 3; i++) p.yuv[i] = frame->data[i][0];
        }
        av_packet_unref(packet);
    }
    p.width = decoder->width;
    p.height = decoder->height;
    p.space = decoder->colorspace;
    p.fps = av_q2d(stream->avg_frame_rate);
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&decoder);
    avformat_close_input(&format);
    return p;
}

static void a_film_has_its_frames_size_and_colour(void **state) {
    (void)state;
    assert_true(write_film(test_path("a.mp4"), 64, 48));
    probe p = examine(test_path("a.mp4"));
    assert_int_equal(p.frames, FRAMES);
    assert_int_equal(p.width, 64);
    assert_int_equal(p.height, 48);
    assert_float_equal(p.fps, 24.0, 1e-6);
    assert_int_equal(p.space, AVCOL_SPC_BT709);
    // 16 + 219 * (0.2126 R + 0.7152 G + 0.0722 B), and the BT.709 differences, within coding error.
    assert_in_range(p.yuv[0], 135 - 2, 135 + 2);
    assert_in_range(p.yuv[1], 72 - 3, 72 + 3);
    assert_in_range(p.yuv[2], 185 - 3, 185 + 3);
    assert_int_equal(test_count_files(), 1);
    unlink(test_path("a.mp4"));
}

static void odd_sizes_are_padded(void **state) {
    (void)state;
    assert_true(write_film(test_path("odd.mp4"), 33, 17));
    probe p = examine(test_path("odd.mp4"));
    assert_int_equal(p.frames, FRAMES);
    assert_int_equal(p.width, 34);
    assert_int_equal(p.height, 18);
    unlink(test_path("odd.mp4"));
}

static void the_index_stands_in_front(void **state) {
    (void)state;
    assert_true(write_film(test_path("fast.mp4"), 32, 32));
    void *data;
    size_t size;
    assert_true(file_read(test_path("fast.mp4"), 1 << 24, &data, &size));
    const char *moov = memmem(data, size, "moov", 4), *mdat = memmem(data, size, "mdat", 4);
    assert_non_null(moov);
    assert_non_null(mdat);
    assert_true(moov < mdat);
    mem_free(data);
    unlink(test_path("fast.mp4"));
}

static void an_abandoned_or_empty_film_leaves_nothing(void **state) {
    (void)state;
    video_abandon(NULL);
    video *v = video_create(test_path("a.mp4"), 32, 32, 30.0, false);
    assert_non_null(v);
    video_abandon(v);
    v = video_create(test_path("a.mp4"), 32, 32, 30.0, false);
    assert_false(video_finish(v));
    assert_message("at least one frame");
    assert_int_equal(test_count_files(), 0);
}

static void an_unwritable_path_is_an_error(void **state) {
    (void)state;
    assert_null(video_create(test_path("no/such/folder.mp4"), 32, 32, 24.0, false));
    assert_message("folder.mp4");
    assert_null(video_create(test_folder, 32, 32, 24.0, false));
    assert_message("is a folder");
    assert_null(video_create(test_path("a.mp4"), 0, 32, 24.0, false));
    assert_null(video_create(test_path("a.mp4"), 32, 32, 0.0, false));
    assert_message("frames a second");
    assert_int_equal(test_count_files(), 0);
}

static bool write_noise(void) {
    video *v = video_create(test_path("full.mp4"), 256, 256, 24.0, false);
    if (!v) return false;
    uint8_t *rgba = mem_alloc(256 * 256 * 4);
    uint32_t random = 5;
    bool good = true;
    for (int f = 0; f < 60 && good; f++) {
        for (size_t i = 0; i < 256 * 256 * 4; i++) rgba[i] = (uint8_t)test_random(&random);
        good = video_add(v, rgba);
    }
    mem_free(rgba);
    if (good) return video_finish(v);
    char message[256];
    snprintf(message, sizeof message, "%s", err_get());
    video_abandon(v);
    return err_set("%s", message);
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    assert_true(test_fails_on_full_disk(write_noise, 100000));
    assert_int_equal(test_count_files(), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_film_has_its_frames_size_and_colour),
        cmocka_unit_test(odd_sizes_are_padded),
        cmocka_unit_test(the_index_stands_in_front),
        cmocka_unit_test(an_abandoned_or_empty_film_leaves_nothing),
        cmocka_unit_test(an_unwritable_path_is_an_error),
        cmocka_unit_test(a_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, test_setup, test_teardown);
}
