// Optical flow by OpenCV: Kroeger, Timofte, Dai and Van Gool, "Fast optical flow using dense
// inverse search", ECCV 2016.
#include "media/optical_flow.h"
#include <cstring>
#include <opencv2/video/tracking.hpp>

extern "C" optical_flow_function roil_optical_flow;

bool roil_optical_flow(const uint8_t *from, const uint8_t *to, int width, int height, float *out) {
    try {
        const cv::Mat a(height, width, CV_8UC1, const_cast<uint8_t *>(from));
        const cv::Mat b(height, width, CV_8UC1, const_cast<uint8_t *>(to));
        cv::Mat flow;
        cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)->calc(a, b, flow);
        if (flow.type() != CV_32FC2 || !flow.isContinuous()) return false;
        std::memcpy(out, flow.data,
                    sizeof(float) * 2 * static_cast<size_t>(width) * static_cast<size_t>(height));
        return true;
    } catch (...) {
        return false;
    }
}
