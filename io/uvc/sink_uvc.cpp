#include "io/uvc/sink_uvc.h"

#include <fcntl.h>
#include <linux/usb/ch9.h>
#include <linux/usb/g_uvc.h>
#include <linux/usb/video.h>
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "io/system/monotonic.h"
#include "io/system/wire_format.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr int kBindRetry_ms = 200;
constexpr unsigned kBuffers = 4;

UvcStreamShape shape_of(const UvcConfig& config, int width, int height, const CameraControl& camera) {
    if (width % 2 != 0)
        throw InputError("outputs.uvc: YUYV shares colour between two pixels; the camera's width is " +
                         std::to_string(width) + ", accepted: an even one");
    UvcStreamShape shape;
    shape.width = width;
    shape.height = height;
    shape.intervals_100ns = uvc_intervals(camera.settings().frame_rate_hz, camera.limits().max_frame_rate_hz);
    shape.preset_100ns = uvc_interval(camera.settings().frame_rate_hz);
    shape.max_payload_bytes = static_cast<std::uint32_t>(config.packet_bytes);
    return shape;
}

}  // namespace

UvcSink::UvcSink(const UvcConfig& config, int width, int height, const SinkContext& context)
    : width_(width),
      height_(height),
      pattern_(context.camera.limits().color_pattern),
      context_(context),
      controls_(context.camera),
      stream_(shape_of(config, width, height, context.camera)),
      gadget_(config, stream_.shape()),
      mailbox_(width, height, 4),
      row_(3 * static_cast<std::size_t>(width) + 8) {}

void UvcSink::start() {
    gadget_.make();
    wakeup_ = open_wakeup();
    answering_ = std::thread([this] { answer_host(); });
    mailbox_.open();
    feeding_ = std::thread([this] { feed(); });
}

void UvcSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    mailbox_.put(frame, record);
}

void UvcSink::note_fault(const std::string& text) noexcept {
    const std::lock_guard lock(mutex_);
    fault_ = text;
}

// Binds the gadget and opens its video device. Returns false while the controller, or a command function on
// the same cable, is not ready.
bool UvcSink::open_video() {
    if (!gadget_.bind() && errno != EBUSY) {
        note_fault("uvc " + gadget_.udc() + ": the gadget cannot be bound: " + std::strerror(errno));
        return false;
    }
    const std::filesystem::path device = gadget_.video_device();
    if (device.empty()) return false;
    video_ = Fd(::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!video_) {
        note_fault(device.string() + ": cannot be opened: " + std::strerror(errno));
        return false;
    }
    for (const int type : {UVC_EVENT_CONNECT, UVC_EVENT_DISCONNECT, UVC_EVENT_SETUP, UVC_EVENT_DATA,
                           UVC_EVENT_STREAMON, UVC_EVENT_STREAMOFF}) {
        v4l2_event_subscription subscription{};
        subscription.type = static_cast<__u32>(type);
        static_cast<void>(v4l2_ioctl(video_.get(), VIDIOC_SUBSCRIBE_EVENT, &subscription));
    }
    streaming_interface_ = gadget_.streaming_interface();
    note_fault("");
    return true;
}

// --- the host's requests

void UvcSink::answer_host() {
    pollfd waits[2] = {{wakeup_.get(), POLLIN, 0}, {-1, POLLPRI, 0}};
    while (!stopping_.load()) {
        if (!video_) {
            if (!open_video()) {
                poll(waits, 1, kBindRetry_ms);
                continue;
            }
            waits[1].fd = video_.get();
        }
        if (poll(waits, 2, -1) < 0 && errno != EINTR) break;
        if (waits[1].revents & POLLPRI)
            take_event();
        else if (waits[1].revents & (POLLERR | POLLHUP) && !streaming_)
            poll(waits, 1, kBindRetry_ms);  // f_uvc signals POLLERR while there are no buffers
    }
    end_stream();
    video_.reset();
}

void UvcSink::take_event() {
    v4l2_event event{};
    if (v4l2_ioctl(video_.get(), VIDIOC_DQEVENT, &event) < 0) return;
    switch (event.type) {
        case UVC_EVENT_SETUP:
            return answer_setup(event);
        case UVC_EVENT_DATA:
            return take_data(event);
        case UVC_EVENT_STREAMON:
            return begin_stream();
        case UVC_EVENT_STREAMOFF:
        case UVC_EVENT_DISCONNECT:
            return end_stream();
        default:
            return;
    }
}

void UvcSink::answer_setup(const v4l2_event& event) {
    uvc_event uvc{};
    std::memcpy(&uvc, &event.u.data, std::min(sizeof uvc, sizeof event.u.data));
    const usb_ctrlrequest& request = uvc.req;
    requests_.fetch_add(1);
    const auto selector = static_cast<std::uint8_t>(request.wValue >> 8);
    const auto unit = static_cast<std::uint8_t>(request.wIndex >> 8);
    data_is_for_stream_ = (request.wIndex & 0xFF) == streaming_interface_;
    std::optional<UvcAnswer> answer;
    if ((request.bRequestType & USB_TYPE_MASK) == USB_TYPE_CLASS)
        answer = data_is_for_stream_ ? stream_.setup(selector, request.bRequest, request.wLength)
                                     : controls_.setup(unit, selector, request.bRequest);
    uvc_request_data response{};
    response.length = -EL2HLT;  // the kernel's code for a stall
    if (answer) {
        // The answer to SET_CUR is the number of bytes that we accept.
        const bool takes = request.bRequest == UVC_SET_CUR;
        const std::size_t size = takes ? std::size_t{request.wLength} : answer->size;
        response.length =
            static_cast<__s32>(std::min({size, sizeof response.data, std::size_t{request.wLength}}));
        std::memcpy(response.data, answer->bytes.data(), answer->size);
    }
    refusals_.store(controls_.refusals());
    static_cast<void>(v4l2_ioctl(video_.get(), UVCIOC_SEND_RESPONSE, &response));
}

void UvcSink::take_data(const v4l2_event& event) {
    uvc_event uvc{};
    std::memcpy(&uvc, &event.u.data, std::min(sizeof uvc, sizeof event.u.data));
    const auto length = static_cast<std::size_t>(std::clamp<int>(uvc.data.length, 0, sizeof uvc.data.data));
    const std::span<const std::uint8_t> bytes(uvc.data.data, length);
    if (!data_is_for_stream_) {
        controls_.data(bytes);
    } else if (const auto interval = stream_.data(bytes)) {
        SettingsChange change;
        change.frame_rate_hz = 1e7 / *interval;
        // A camera that sets its own rate keeps it; the host then gets frames at that rate.
        context_.camera.change(change);
    }
    changes_.store(controls_.changes());
    refusals_.store(controls_.refusals());
}

// --- pictures

void UvcSink::begin_stream() {
    const std::lock_guard lock(buffers_mutex_);
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<std::uint32_t>(width_);
    format.fmt.pix.height = static_cast<std::uint32_t>(height_);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.sizeimage = stream_.shape().frame_bytes();
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    queued_ = 0;
    if (v4l2_ioctl(video_.get(), VIDIOC_S_FMT, &format) < 0 || !buffers_.request(video_.get(), kBuffers) ||
        v4l2_ioctl(video_.get(), VIDIOC_STREAMON, &type) < 0) {
        note_fault("uvc " + gadget_.udc() + ": the stream does not begin: " + std::strerror(errno));
        return;
    }
    streaming_ = true;
    streams_.fetch_add(1);
}

void UvcSink::end_stream() noexcept {
    const std::lock_guard lock(buffers_mutex_);
    if (!video_) return;
    streaming_ = false;
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    static_cast<void>(v4l2_ioctl(video_.get(), VIDIOC_STREAMOFF, &type));
    buffers_.release();
    v4l2_requestbuffers none{};
    none.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    none.memory = V4L2_MEMORY_MMAP;
    static_cast<void>(v4l2_ioctl(video_.get(), VIDIOC_REQBUFS, &none));
}

void UvcSink::feed() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        {
            const std::lock_guard lock(buffers_mutex_);
            if (!streaming_)
                unwanted_.fetch_add(1);
            else if (deliver(*item))
                delivered_.fetch_add(1);
            else
                late_.add(item->record.id);
        }
        mailbox_.done();
    }
}

bool UvcSink::deliver(const FrameMailbox::Item& item) {
    const std::int64_t begun_ns = monotonic_ns();
    v4l2_buffer buffer = output_buffer(static_cast<std::uint32_t>(queued_));
    // No buffer is free: the host is slower than the camera.
    if (queued_ >= buffers_.size() && v4l2_ioctl(video_.get(), VIDIOC_DQBUF, &buffer) < 0) return false;
    const std::size_t bytes = stream_.shape().frame_bytes();
    if (buffer.index >= buffers_.size() || buffers_.memory(buffer.index).size() < bytes) return false;
    write_wire(item.frame, {0, 0, width_, height_}, item.record.bits, WireFormat::kYuyv, pattern_, row_,
               buffers_.memory(buffer.index).first(bytes));
    buffer.bytesused = static_cast<std::uint32_t>(bytes);
    if (v4l2_ioctl(video_.get(), VIDIOC_QBUF, &buffer) < 0) return false;
    if (queued_ < buffers_.size()) ++queued_;
    if (context_.listener) context_.listener->delivered(item.record, begun_ns, monotonic_ns());
    return true;
}

void UvcSink::stop() noexcept {
    stopping_.store(true);
    if (answering_.joinable()) {
        wake(wakeup_);
        answering_.join();
    }
    if (feeding_.joinable()) {
        mailbox_.close();
        feeding_.join();
    }
    gadget_.remove();
}

bool UvcSink::has_fault() const noexcept {
    const std::lock_guard lock(mutex_);
    return !fault_.empty();
}

SinkReport UvcSink::report() const {
    SinkReport report;
    report.name = "uvc " + gadget_.udc();
    report.frames = delivered_.load();
    report.dropped = mailbox_.dropped() + late_.count();
    report.first_dropped = first_of({mailbox_.first_dropped(), late_.first()});
    report.unwanted = unwanted_.load();
    report.figures = {{"requests", static_cast<double>(requests_.load())},
                      {"settings_changed", static_cast<double>(changes_.load())},
                      {"requests_refused", static_cast<double>(refusals_.load())},
                      {"streams", static_cast<double>(streams_.load())},
                      {"host_too_slow", static_cast<double>(late_.count())}};
    const std::lock_guard lock(mutex_);
    report.fault = fault_;
    return report;
}

std::unique_ptr<FrameSink> make_sink(const UvcConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    return std::make_unique<UvcSink>(config, shape.fixed_width, shape.fixed_height, context);
}

}  // namespace hilcam
