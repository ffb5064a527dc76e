#pragma once
// A USB camera: a UVC gadget on this machine's USB device controller that sends YUYV pictures.
//
// A host sees the camera's picture size, its rates and its settings (uvc_controls.h). One thread answers the
// host's requests, another feeds pictures; a slow host loses some. The gadget is created at start and removed
// at stop.
//
// Isochronous pictures need real hardware, because virtual controllers carry requests only (docs/devices.md).

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "io/contract/frame_mailbox.h"
#include "io/contract/loss_count.h"
#include "io/contract/output_shape.h"
#include "io/system/fd.h"
#include "io/uvc/uvc_gadget.h"
#include "io/v4l2/v4l2_buffers.h"

struct v4l2_event;

namespace hilcam {

std::unique_ptr<FrameSink> make_sink(const UvcConfig& config, const SinkContext& context,
                                     const OutputShape& shape);

class UvcSink : public FrameSink {
  public:
    // Throws InputError for an odd width.
    UvcSink(const UvcConfig& config, int width, int height, const SinkContext& context);
    ~UvcSink() override { stop(); }

    // Throws DeviceError (uvc_gadget.h).
    void start() override;
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override { return mailbox_.has_room(); }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;

  private:
    bool open_video();
    void answer_host();
    void take_event();
    void answer_setup(const v4l2_event& event);
    void take_data(const v4l2_event& event);
    void begin_stream();
    void end_stream() noexcept;
    void feed();
    bool deliver(const FrameMailbox::Item& item);
    void note_fault(const std::string& text) noexcept;

    int width_, height_;
    std::string pattern_;
    SinkContext context_;
    UvcControls controls_;
    UvcStream stream_;
    UvcGadget gadget_;
    FrameMailbox mailbox_;
    std::vector<std::uint16_t> row_;
    Fd video_, wakeup_;
    int streaming_interface_ = 1;
    bool data_is_for_stream_ = false;
    std::atomic<bool> stopping_{false};
    std::thread answering_, feeding_;

    std::mutex buffers_mutex_;  // serialises the stream's start and end with pictures
    V4l2Buffers buffers_;
    std::size_t queued_ = 0;
    bool streaming_ = false;

    LossCount late_;  // the host was too slow
    std::atomic<std::uint64_t> delivered_{0}, unwanted_{0}, requests_{0}, streams_{0};
    std::atomic<std::uint64_t> changes_{0}, refusals_{0};
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace hilcam
