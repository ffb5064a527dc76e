// A conversation with the camera's control port: [u8 sender and seconds][u16 length][datagram] repeated.
// Whatever is said, answers fit their buffer and the region of interest stays on the sensor.

#include <algorithm>
#include <vector>

#include "io/bytes.h"
#include "io/gige_device.h"
#include "render/check.h"

namespace {

class AnyCamera : public hilcam::CameraControl {
  public:
    hilcam::CameraSettings s{.exposure_s = 0.001, .frame_rate_hz = 30};
    hilcam::CameraSettings settings() const override { return s; }
    hilcam::CameraLimits limits() const override {
        return {.width = 640,
                .height = 480,
                .bits = 12,
                .color_pattern = {},
                .least_exposure_s = 1e-5,
                .most_exposure_s = 1,
                .least_gain_db = 0,
                .most_gain_db = 24,
                .least_frame_rate_hz = 0.1,
                .most_frame_rate_hz = 200};
    }
    bool change(const hilcam::SettingsChange& c) override {
        const hilcam::CameraLimits l = limits();
        if (c.exposure_s && !(*c.exposure_s >= l.least_exposure_s && *c.exposure_s <= l.most_exposure_s))
            return false;
        if (c.gain_db && !(*c.gain_db >= l.least_gain_db && *c.gain_db <= l.most_gain_db)) return false;
        if (c.frame_rate_hz &&
            !(*c.frame_rate_hz >= l.least_frame_rate_hz && *c.frame_rate_hz <= l.most_frame_rate_hz))
            return false;
        s.exposure_s = c.exposure_s.value_or(s.exposure_s);
        s.gain_db = c.gain_db.value_or(s.gain_db);
        s.frame_rate_hz = c.frame_rate_hz.value_or(s.frame_rate_hz);
        return true;
    }
    hilcam::TriggerResult trigger(const hilcam::TriggerOrder&) override {
        return hilcam::TriggerResult::kTaken;
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    AnyCamera camera;
    FaultBoard faults;
    GigeDevice device({"camera", "S1", "", 0x7F000001, 0xFF000000, 0, 0x020000000001, 1500}, camera, faults,
                      {});
    std::vector<std::uint8_t> out(gvcp::kMostDatagramBytes);
    std::span<const std::uint8_t> rest(data, size);
    std::int64_t now_ns = 0;
    while (rest.size() >= 3) {
        const Endpoint from{0x7F000001, static_cast<std::uint16_t>(40000 + (rest[0] & 1))};
        now_ns += std::int64_t{rest[0] >> 4} * 1'000'000'000;
        const std::size_t length = std::min<std::size_t>(ByteReader(rest.subspan(1)).u16(), rest.size() - 3);
        HILCAM_CHECK(device.handle(rest.subspan(3, length), from, now_ns, out) <= out.size());
        const GigeStreamState& s = device.stream_state();
        HILCAM_CHECK(s.width >= 1 && s.height >= 1 && s.width + s.offset_x <= 640 &&
                     s.height + s.offset_y <= 480);
        HILCAM_CHECK(s.packet_bytes >= 576 && s.packet_bytes <= 16384);
        rest = rest.subspan(3 + length);
    }
    return 0;
}
