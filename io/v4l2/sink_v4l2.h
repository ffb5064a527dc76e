#pragma once
// Writes frames to a V4L2 output device, the writing side of v4l2loopback 0.12.7 and later.
//
// A thread writes frames as they come, at least 1 ms and half the shortest frame period apart: a writer
// without pauses makes the kernel panic with old modules. With `io: mmap`, readers get the CLOCK_MONOTONIC
// time of mid-exposure; with `io: write`, the module assigns its own times, but every version counts frames.
// Pixels are those of wire_format.h. A device that fails is reported, closed and tried again every half
// second; frames are dropped meanwhile. Readers and the emulator may start and stop in any order.
//
// Faults: v4l2_stall, v4l2_restart, v4l2_format_flip (fault.h).

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "io/contract/frame_mailbox.h"
#include "io/contract/loss_count.h"
#include "io/contract/output_shape.h"
#include "io/v4l2/v4l2_device.h"
#include "io/v4l2/v4l2_formats.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct V4l2Config {
    static constexpr const char* kKey = "v4l2";
    static constexpr const char* kMeaning = "frames to a v4l2loopback device";
    static constexpr bool kLive = true;
    static constexpr bool kFixedSize = true;

    enum class Io { kMmap, kWrite };
    enum class MetadataRow { kOff, kTop, kBottom };
    V4l2Format format = V4l2Format::kY16;
    Io io = Io::kMmap;
    MetadataRow metadata_row = MetadataRow::kOff;
    std::int64_t buffers = 4;
    std::string device = "/dev/video42";
};
Fields fields(V4l2Config& config);
std::unique_ptr<FrameSink> make_sink(const V4l2Config& config, const SinkContext& context,
                                     const OutputShape& shape);

class V4l2Sink : public FrameSink {
  public:
    // Throws InputError for a format that does not suit the camera, and for a metadata row that does not fit.
    V4l2Sink(const V4l2Config& config, int width, int height, double frame_rate_hz,
             const SinkContext& context);
    ~V4l2Sink() override { stop(); }

    // Throws DeviceError (v4l2_device.h).
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override { return mailbox_.has_room(); }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;

  private:
    struct Counters {
        LossCount failed;
        std::atomic<std::uint64_t> delivered{0}, stalled{0}, reopened{0}, flips_refused{0};
        std::atomic<std::size_t> buffers{0};
    };

    void use(V4l2Format format);
    void open_device();
    bool reopen() noexcept;
    void flip_format() noexcept;
    void run();
    void strike_faults(std::uint64_t frame) noexcept;
    void pace() noexcept;
    bool takes(const FrameMailbox::Item& item) noexcept;
    bool deliver(const FrameMailbox::Item& item) noexcept;
    void draw(const FrameMailbox::Item& item, std::span<std::uint8_t> out) noexcept;
    void note_fault(const std::string& text) noexcept;

    V4l2Config config_;
    int width_, height_;
    std::string pattern_;
    SinkContext context_;
    V4l2Format format_;
    V4l2Pixels pixels_;
    FrameMailbox mailbox_;
    V4l2Output device_;
    std::vector<std::uint16_t> row_;
    std::int64_t min_interval_ns_, last_ns_ = 0, retry_ns_ = 0;
    std::thread thread_;
    Counters counters_;
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace hilcam
