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
    hilcam::CameraSettings s{0.001, 0, 30, true};
    hilcam::CameraSettings settings() const override { return s; }
    hilcam::CameraLimits limits() const override { return {640, 480, 12, 1e-5, 1, 0, 24, 0.1, 200}; }
    bool set_exposure_s(double v) override { return v >= 1e-5 && v <= 1 && (s.exposure_s = v, true); }
    bool set_gain_db(double v) override { return v >= 0 && v <= 24 && (s.gain_db = v, true); }
    bool set_frame_rate_hz(double v) override { return v >= 0.1 && v <= 200 && (s.frame_rate_hz = v, true); }
    void set_running(bool running) override { s.running = running; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    AnyCamera camera;
    GigeDevice device(
        {"camera", "S1", "", 0x7F000001, 0xFF000000, 0, 0x020000000001, 1500}, camera,
        {nullptr, [](const gvcp::ResendRequest&) {}, [](const GigeStreamState&, std::size_t) {}});
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
