#pragma once
// Publishes frames with their reports in a shared memory, which other programs of this machine read without a
// copy.
//
// The loop's own copy into the memory is the only one, and there is no thread. Readers cannot delay the
// writer, which does not know them. A reader that is slower than the ring detects that from the slot's
// sequence (shm_ring.h). A futex wakes waiting readers. Lockstep does not wait for readers.

#include <atomic>
#include <memory>
#include <string>

#include "io/contract/frame_sink.h"
#include "io/contract/loss_count.h"
#include "io/contract/output_shape.h"
#include "io/shm/shm_segment.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct ShmConfig {
    static constexpr const char* kKey = "shm";
    static constexpr const char* kMeaning =
        "frames in shared memory, which programs on this machine read without a copy (docs/shared_memory.md)";
    static constexpr bool kLive = true;

    std::string name = "hilcam";
    std::int64_t slots = 8;
};
Fields fields(ShmConfig& config);
void validate(const ShmConfig& config);
std::unique_ptr<FrameSink> make_sink(const ShmConfig& config, const SinkContext& context,
                                     const OutputShape& shape);

class ShmSink : public FrameSink {
  public:
    // width, height: of the largest frame.
    ShmSink(const ShmConfig& config, int width, int height, std::string camera, std::string colors,
            DeliveryListener* listener);
    ~ShmSink() override { stop(); }

    // Throws InputError and DeviceError (shm_segment.h).
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void stop() noexcept override;
    SinkReport report() const override;

  private:
    ShmConfig config_;
    int width_, height_;
    std::string camera_, colors_;
    DeliveryListener* listener_;
    std::size_t slot_bytes_;
    ShmSegment segment_;
    std::uint64_t count_ = 0;
    LossCount dropped_;
    std::atomic<std::uint64_t> published_{0};
};

}  // namespace hilcam
