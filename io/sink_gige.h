#pragma once
// Frames out of a GigE Vision camera on one IPv4 address: sockets and threads around gige_device.h.
//
// The loop packs each frame into a ring slot; a sender thread sends it in small batches with sleeps between,
// so that a receiver with the kernel's default buffer keeps up; a control thread answers within its poll and
// serves resend requests from the ring. Mono8 carries the upper 8 bits of a DN, Mono12 the DN scaled to 12
// bits, Mono16 the DN in the most significant of 16 bits; samples are little-endian. Leaders carry the
// exposure's middle on CLOCK_MONOTONIC, 1 tick = 1 ns.

#include <cstdint>
#include <memory>

#include "io/camera_control.h"
#include "io/frame_sink.h"
#include "render/config_field.h"

namespace hilcam {

struct GigeConfig {
    std::string interface = "127.0.0.1";  // IPv4 address or name of an interface
    std::string model = "hilcam";
    std::string serial = "HC000001";
    std::string user_name = "";
    std::int64_t packet_bytes = 7680;  // before a client negotiates another
    double rate_bytes_s = 400e6;       // upper limit of the stream
};
Fields fields(GigeConfig& config);

class GigeSink : public FrameSink {
  public:
    GigeSink(const GigeConfig& config, const SinkContext& context);
    ~GigeSink() override;

    // Throws InputError when there is no such interface, DeviceError when port 3956 there is taken.
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
