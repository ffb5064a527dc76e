#pragma once
// Sends frames as a GigE Vision camera on one IPv4 address: the threads around gige_device.h (control) and
// gige_sender.h (stream).
//
// The loop writes each frame into a slot of a ring (gige_frame_writer.h), and the sender's thread sends it.
// The control thread shares nothing with rendering, so it answers as soon as the machine lets it run.
// Leaders carry mid-exposure on the device's clock (io/ptp/device_clock.h), with 1 tick = 1 ns. With source
// ptp a third thread listens to PTP masters. A process may have several cameras, each on its own address.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/contract/frame_sink.h"
#include "io/contract/output_shape.h"
#include "io/ptp/device_clock_config.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct GigeConfig {
    static constexpr const char* kKey = "gige";
    static constexpr const char* kMeaning = "frames by GigE Vision, as a camera";
    static constexpr bool kLive = true;

    std::string interface = "127.0.0.1";  // IPv4 address or name of an interface
    std::string model = "hilcam";
    std::string serial = "HC000001";
    std::string user_name{};
    std::int64_t packet_bytes = 7680;  // until a client negotiates another; at most the interface's MTU
    double rate_bytes_s = 400e6;       // upper limit of the stream
    bool multipart = false;            // announce it
    double spread_fraction = 0.5;      // share of a frame period over which a frame's packets may be spread
    std::vector<std::string> lines{};  // names of the trigger input besides Line0
    DeviceClockConfig clock{};
    // Another camera's face (docs/camera_face.md): its description, the table that hilcam-camera-face made
    // of it, and what was recorded from it; all empty: hilcam's own.
    std::filesystem::path genicam_file{}, face_file{}, registers_file{};
};
Fields fields(GigeConfig& config);
void validate(const GigeConfig& config);
std::vector<ListeningPort> listening(const GigeConfig& config);
// Makes the output; the model "hilcam" is replaced by the camera's name. Throws InputError.
std::unique_ptr<FrameSink> make_sink(const GigeConfig& config, const SinkContext& context,
                                     const OutputShape& shape);

class GigeSink : public FrameSink {
  public:
    // Throws InputError when there is no such interface.
    GigeSink(const GigeConfig& config, const SinkContext& context);
    ~GigeSink() override;

    // Throws DeviceError when port 3956 there is taken.
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override;
    void on_event(const CameraEvent& event) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;
    std::vector<SinkNote> take_notes() override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
