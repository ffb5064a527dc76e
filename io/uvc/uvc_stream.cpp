#include "io/uvc/uvc_stream.h"

#include <linux/usb/video.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

void put(UvcAnswer& answer, std::size_t at, std::uint32_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
        answer.bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

std::uint32_t uvc_interval(double rate_hz) { return static_cast<std::uint32_t>(std::lround(1e7 / rate_hz)); }

std::vector<std::uint32_t> uvc_intervals(double frame_rate_hz, double max_frame_rate_hz) {
    std::vector<std::uint32_t> list = {uvc_interval(frame_rate_hz)};
    for (const double rate_hz : {60.0, 30.0, 25.0, 20.0, 15.0, 10.0, 5.0, 1.0})
        if (rate_hz <= max_frame_rate_hz) list.push_back(uvc_interval(rate_hz));
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

UvcStream::UvcStream(UvcStreamShape shape) : shape_(std::move(shape)) {
    HILCAM_CHECK(!shape_.intervals_100ns.empty() && shape_.preset_100ns > 0);
    probe_100ns_ = commit_100ns_ = shape_.preset_100ns;
}

UvcAnswer UvcStream::control(std::uint32_t interval_100ns) const {
    UvcAnswer answer;
    answer.size = kBytes;
    put(answer, 0, 1, 2);  // bmHint: the interval is fixed
    put(answer, 2, 1, 1);  // format
    put(answer, 3, 1, 1);  // frame
    put(answer, 4, interval_100ns, 4);
    put(answer, 18, shape_.frame_bytes(), 4);
    put(answer, 22, shape_.max_payload_bytes, 4);
    put(answer, 26, 48'000'000, 4);  // clock of the kernel's header descriptor
    put(answer, 30, 3, 1);           // frame id and end of frame are in the payload headers
    put(answer, 31, 1, 1);
    put(answer, 32, 1, 1);
    put(answer, 33, 1, 1);
    return answer;
}

std::optional<UvcAnswer> UvcStream::setup(std::uint8_t selector, std::uint8_t request, std::uint16_t length) {
    pending_ = 0;
    if (selector != UVC_VS_PROBE_CONTROL && selector != UVC_VS_COMMIT_CONTROL) return std::nullopt;
    UvcAnswer answer;
    switch (request) {
        case UVC_SET_CUR:
            pending_ = selector;
            return answer;
        case UVC_GET_CUR:
            answer = control(selector == UVC_VS_PROBE_CONTROL ? probe_100ns_ : commit_100ns_);
            break;
        case UVC_GET_MIN:
            answer = control(shape_.intervals_100ns.front());
            break;
        case UVC_GET_DEF:
            answer = control(shape_.preset_100ns);
            break;
        case UVC_GET_MAX:
            answer = control(shape_.intervals_100ns.back());
            break;
        case UVC_GET_RES:
            answer.size = kBytes;
            break;
        case UVC_GET_LEN:
            answer.size = 2;
            answer.bytes[0] = kBytes;
            break;
        case UVC_GET_INFO:
            answer.size = 1;
            answer.bytes[0] = 3;
            break;
        default:
            return std::nullopt;
    }
    answer.size = std::min<std::size_t>(answer.size, length);
    return answer;
}

std::optional<std::uint32_t> UvcStream::data(std::span<const std::uint8_t> bytes) {
    const std::uint8_t selector = pending_;
    pending_ = 0;
    if (selector == 0 || bytes.size() < 8) return std::nullopt;
    std::uint32_t wanted = 0;
    for (std::size_t i = 0; i < 4; ++i) wanted |= std::uint32_t{bytes[4 + i]} << (8 * i);
    // Chooses the slowest of the camera's rates that is at least as fast as requested.
    const auto& list = shape_.intervals_100ns;
    const auto after = std::upper_bound(list.begin(), list.end(), wanted);
    const std::uint32_t chosen = after == list.begin() ? list.front() : *(after - 1);
    probe_100ns_ = chosen;
    if (selector != UVC_VS_COMMIT_CONTROL) return std::nullopt;
    commit_100ns_ = chosen;
    return chosen;
}

}  // namespace hilcam
