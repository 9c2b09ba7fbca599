// libavformat, libavcodec, libavutil and libswscale, loaded when the first video is begun. They
// depend on a hundred libraries, which would cost every start of the program 30 ms.
#pragma once
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
#include <stdbool.h>

#define AV_FUNCTIONS(X)                                                                            \
    X(format, av_interleaved_write_frame)                                                          \
    X(format, av_write_trailer)                                                                    \
    X(format, avformat_alloc_output_context2)                                                      \
    X(format, avformat_free_context)                                                               \
    X(format, avformat_new_stream)                                                                 \
    X(format, avformat_write_header)                                                               \
    X(format, avio_closep)                                                                         \
    X(format, avio_open)                                                                           \
    X(codec, av_packet_alloc)                                                                      \
    X(codec, av_packet_free)                                                                       \
    X(codec, av_packet_rescale_ts)                                                                 \
    X(codec, avcodec_alloc_context3)                                                               \
    X(codec, avcodec_find_encoder)                                                                 \
    X(codec, avcodec_find_encoder_by_name)                                                         \
    X(codec, avcodec_free_context)                                                                 \
    X(codec, avcodec_open2)                                                                        \
    X(codec, avcodec_parameters_from_context)                                                      \
    X(codec, avcodec_receive_packet)                                                               \
    X(codec, avcodec_send_frame)                                                                   \
    X(util, av_d2q)                                                                                \
    X(util, av_dict_free)                                                                          \
    X(util, av_dict_set)                                                                           \
    X(util, av_frame_alloc)                                                                        \
    X(util, av_frame_free)                                                                         \
    X(util, av_frame_get_buffer)                                                                   \
    X(util, av_frame_make_writable)                                                                \
    X(util, av_log_set_level)                                                                      \
    X(util, av_opt_set)                                                                            \
    X(util, av_strerror)                                                                           \
    X(scale, sws_freeContext)                                                                      \
    X(scale, sws_getCoefficients)                                                                  \
    X(scale, sws_getContext)                                                                       \
    X(scale, sws_scale)                                                                            \
    X(scale, sws_setColorspaceDetails)

#define AV_MEMBER(library, name) __typeof__(name) *name;
typedef struct av_functions {
    AV_FUNCTIONS(AV_MEMBER)
} av_functions;

extern av_functions av; // valid after av_load

// Loads the libraries. False with a message when they are not installed. Any thread.
bool av_load(void);
