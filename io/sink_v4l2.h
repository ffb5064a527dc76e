#pragma once
// Frames into a V4L2 output device, the writing side of v4l2loopback.
//
// GREY carries the upper 8 bits of a DN, Y16 the DN shifted to the most significant of 16 bits. Frames go out
// as they come, one per frame period, by a thread of its own: never unpaced, which old modules answer with a
// kernel panic. `io: mmap` passes the exposure's CLOCK_MONOTONIC time to the reader; `io: write` lets the
// module count frames instead (0.12.7 cannot do both).

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <thread>

#include "io/fd.h"
#include "io/frame_mailbox.h"
#include "render/config_field.h"

namespace hilcam {

struct V4l2Config {
    enum class Format { kGrey, kY16 } format = Format::kY16;
    enum class Io { kMmap, kWrite } io = Io::kMmap;
    std::string device = "/dev/video42";
};
Fields fields(V4l2Config& config);

class V4l2Sink : public FrameSink {
  public:
    V4l2Sink(const V4l2Config& config, int width, int height, double frame_rate_hz,
             const SinkContext& context);
    ~V4l2Sink() override { stop(); }

    // Throws DeviceError: no such device, no right, not an output, busy, format not taken.
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;

  private:
    struct Buffer {
        void* memory = nullptr;
        std::size_t size = 0;
    };
    void set_format();
    void map_buffers();
    void run();
    bool write_frame(const FrameMailbox::Item& item);
    bool queue_frame(const FrameMailbox::Item& item);
    void convert(const FrameMailbox::Item& item, std::uint8_t* out) const;
    std::size_t frame_bytes() const;

    V4l2Config config_;
    int width_, height_;
    double frame_rate_hz_;
    DeliveryListener* listener_;
    FrameMailbox mailbox_;
    Fd device_;
    std::vector<Buffer> buffers_;
    std::vector<std::uint8_t> staging_;
    std::size_t queued_ = 0;
    std::thread thread_;
    std::atomic<std::uint64_t> delivered_{0}, failed_{0};
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace hilcam
