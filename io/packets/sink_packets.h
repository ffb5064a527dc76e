#pragma once
// Sends frames as CCSDS space packets (docs/packets.md).
//
// The loop copies a frame into a mailbox. The output's own thread compresses it, cuts it into packets and
// sends them. When that thread is late, frames are dropped and counted, or the loop waits (when_slow.h). A
// frame's line of truth says when it is missing in packets' files, if the camera has no other files.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "io/contract/frame_fates.h"
#include "io/contract/frame_mailbox.h"
#include "io/contract/output_shape.h"
#include "io/packets/image_segmenter.h"
#include "io/packets/packet_transport.h"
#include "io/packets/packets_config.h"
#include "io/packets/payload_encoder.h"
#include "io/packets/send_pacer.h"
#include "io/packets/spacewire.h"

namespace hilcam {

// The camera's other parts that packets concern. All may be null and outlive the sink.
struct PacketSurroundings {
    DeliveryListener* listener = nullptr;
    FrameFates* fates = nullptr;
};

// Figures of the camera that packets have beside those of the frame's record.
struct PacketCamera {
    std::string color_pattern;  // empty: monochrome
    int offset_x = 0, offset_y = 0;
};

class PacketsSink : public FrameSink {
  public:
    // width, height: the largest frame's. waits: the loop waits for room. Throws InputError when a library is
    // missing, or the folder holds another run's packets.
    PacketsSink(const PacketsConfig& config, int width, int height, PacketCamera camera, bool waits = true,
                PacketSurroundings surroundings = {});
    ~PacketsSink() override { stop(); }

    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override { return mailbox_.has_room(); }
    bool must_be_waited_for() const noexcept override { return waits_; }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;
    std::vector<SinkNote> take_notes() override { return transport_->take_notes(); }

  private:
    using Outcome = PacketTransport::Outcome;
    struct Counters {
        std::atomic<std::uint64_t> delivered{0}, unwanted{0}, encoded{0}, packets{0}, bytes{0}, pixel_bits{0},
            payload_bits{0};
        std::atomic<std::int64_t> encoding_ns{0};
        LossCount gone;  // frames whose receiver vanished or was given up
    };

    void run();
    Outcome deliver(const FrameMailbox::Item& item);
    void encode(const FrameMailbox::Item& item);
    bool send_all();
    ImageFrame header_of(const FrameMailbox::Item& item) const;
    void count(const FrameRecord& record, Outcome outcome);
    void fail(const std::exception& error, std::uint64_t frame);
    void settle(std::uint64_t frame, bool written);
    std::string report_of_loss() const;

    PacketsConfig config_;
    PacketCamera camera_;
    bool waits_;
    PacketSurroundings surroundings_;  // a listener of sockets, fates of files
    std::unique_ptr<PayloadEncoder> encoder_;
    std::unique_ptr<PacketTransport> transport_;
    ImageSegmenter segmenter_;
    std::optional<SpaceWireWrapper> spacewire_;
    SendPacer pacer_;
    FrameMailbox mailbox_;
    std::thread thread_;
    std::uint64_t offered_ = 0;

    std::vector<std::uint8_t> payload_;
    std::vector<StripPayload> strips_;
    Counters counters_;
    mutable std::mutex mutex_;
    std::uint64_t failed_ = 0, first_failed_ = 0;
    std::string first_failure_;
};

std::unique_ptr<FrameSink> make_sink(const PacketsConfig& config, const SinkContext& context,
                                     const OutputShape& shape);

}  // namespace hilcam
