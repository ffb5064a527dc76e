#include "io/sink_v4l2.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "render/check.h"

namespace hilcam {
namespace {

int retry_ioctl(int fd, unsigned long request, void* argument) {
    int result;
    do result = ioctl(fd, request, argument);
    while (result < 0 && errno == EINTR);
    return result;
}

std::string fourcc_text(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(code >> (8 * i) & 0x7F);
    return text;
}

constexpr const char* kAdvice =
    "; load the module with: modprobe v4l2loopback video_nr=42 card_label=hilcam exclusive_caps=1 "
    "max_buffers=4";

std::int64_t monotonic_ns() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

Fields fields(V4l2Config& c) {
    return {
        text("device", c.device, "an output device of v4l2loopback"),
        choice("format", c.format, {"GREY", "Y16"}, "8 bits, or 16 bits with the DN in the upper ones"),
        choice("io", c.io, {"mmap", "write"}, "mmap: exposure time stamps; write: the module counts frames"),
    };
}

V4l2Sink::V4l2Sink(const V4l2Config& config, int width, int height, double frame_rate_hz,
                   const SinkContext& context)
    : config_(config),
      width_(width),
      height_(height),
      frame_rate_hz_(frame_rate_hz),
      listener_(context.listener),
      mailbox_(width, height, 4) {}

std::size_t V4l2Sink::frame_bytes() const {
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    return config_.format == V4l2Config::Format::kGrey ? pixels : 2 * pixels;
}

void V4l2Sink::start() {
    device_ = Fd(open(config_.device.c_str(), O_RDWR | O_CLOEXEC));
    if (!device_) {
        const int reason = errno;
        const std::string advice = reason == EACCES ? "; add the user to the group 'video'" : kAdvice;
        throw DeviceError(config_.device + ": cannot be opened: " + std::strerror(reason) + advice);
    }
    v4l2_capability capability{};
    if (retry_ioctl(device_.get(), VIDIOC_QUERYCAP, &capability) < 0)
        throw DeviceError(config_.device + ": is not a V4L2 device" + kAdvice);
    const std::uint32_t can =
        capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
    if (!(can & V4L2_CAP_VIDEO_OUTPUT))
        throw DeviceError(config_.device +
                          ": takes no frames (it is a camera, or another program feeds it already)" +
                          kAdvice);
    set_format();
    if (config_.io == V4l2Config::Io::kMmap) map_buffers();
    staging_.resize(frame_bytes());
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    if (retry_ioctl(device_.get(), VIDIOC_STREAMON, &type) < 0)
        throw DeviceError(config_.device + ": does not start streaming: " + std::strerror(errno));
    thread_ = std::thread([this] { run(); });
}

void V4l2Sink::set_format() {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<std::uint32_t>(width_);
    format.fmt.pix.height = static_cast<std::uint32_t>(height_);
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.colorspace = V4L2_COLORSPACE_RAW;
    const std::uint32_t asked =
        config_.format == V4l2Config::Format::kGrey ? V4L2_PIX_FMT_GREY : V4L2_PIX_FMT_Y16;
    format.fmt.pix.pixelformat = asked;
    if (retry_ioctl(device_.get(), VIDIOC_S_FMT, &format) < 0)
        throw DeviceError(config_.device + ": refuses " + fourcc_text(asked) + ": " + std::strerror(errno) +
                          "; is another program feeding it, or a reader holding another format?");
    // The module answers an unknown format with another one instead of an error.
    const v4l2_pix_format& got = format.fmt.pix;
    if (got.pixelformat != asked || got.width != static_cast<std::uint32_t>(width_) ||
        got.height != static_cast<std::uint32_t>(height_) || got.sizeimage < frame_bytes())
        throw DeviceError(config_.device + ": asked for " + fourcc_text(asked) + " " +
                          std::to_string(width_) + "x" + std::to_string(height_) +
                          ", the module fell back to " + fourcc_text(got.pixelformat) + " " +
                          std::to_string(got.width) + "x" + std::to_string(got.height));
    v4l2_streamparm rate{};
    rate.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    rate.parm.output.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(frame_rate_hz_ * 1000))};
    retry_ioctl(device_.get(), VIDIOC_S_PARM,
                &rate);  // readers see it as the frame rate; not all modules take it
}

void V4l2Sink::map_buffers() {
    v4l2_requestbuffers request{};
    request.count = 4;
    request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    request.memory = V4L2_MEMORY_MMAP;
    if (retry_ioctl(device_.get(), VIDIOC_REQBUFS, &request) < 0 || request.count < 2)
        throw DeviceError(config_.device + ": gives no buffers; try 'io: write'");
    for (std::uint32_t i = 0; i < request.count; ++i) {
        v4l2_buffer buffer{};
        buffer.index = i;
        buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
        buffer.memory = V4L2_MEMORY_MMAP;
        if (retry_ioctl(device_.get(), VIDIOC_QUERYBUF, &buffer) < 0)
            throw DeviceError(config_.device + ": does not describe its buffers: " + std::strerror(errno));
        void* memory = mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_.get(),
                            static_cast<off_t>(buffer.m.offset));
        if (memory == MAP_FAILED)
            throw DeviceError(config_.device + ": buffers cannot be mapped: " + std::strerror(errno));
        buffers_.push_back({memory, buffer.length});
    }
}

void V4l2Sink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    mailbox_.put(frame, record);
}

void V4l2Sink::convert(const FrameMailbox::Item& item, std::uint8_t* out) const {
    const int bits = item.record.bits;
    const std::span<const std::uint16_t> in = item.frame.all();
    if (config_.format == V4l2Config::Format::kGrey) {
        for (std::size_t i = 0; i < in.size(); ++i) out[i] = static_cast<std::uint8_t>(in[i] >> (bits - 8));
        return;
    }
    for (std::size_t i = 0; i < in.size(); ++i) {
        const auto value = static_cast<std::uint16_t>(in[i] << (16 - bits));
        out[2 * i] = static_cast<std::uint8_t>(value & 0xFF);
        out[2 * i + 1] = static_cast<std::uint8_t>(value >> 8);
    }
}

bool V4l2Sink::write_frame(const FrameMailbox::Item& item) {
    convert(item, staging_.data());
    return ::write(device_.get(), staging_.data(), staging_.size()) == static_cast<ssize_t>(staging_.size());
}

bool V4l2Sink::queue_frame(const FrameMailbox::Item& item) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (queued_ < buffers_.size())
        buffer.index = static_cast<std::uint32_t>(queued_++);
    else if (retry_ioctl(device_.get(), VIDIOC_DQBUF, &buffer) < 0)
        return false;
    if (buffer.index >= buffers_.size() || buffers_[buffer.index].size < frame_bytes()) return false;
    convert(item, static_cast<std::uint8_t*>(buffers_[buffer.index].memory));
    buffer.bytesused = static_cast<std::uint32_t>(frame_bytes());
    buffer.field = V4L2_FIELD_NONE;
    const std::int64_t stamp_ns = item.record.exposure_mid_monotonic_ns;
    buffer.timestamp.tv_sec = stamp_ns / 1'000'000'000;
    buffer.timestamp.tv_usec = stamp_ns % 1'000'000'000 / 1000;
    return retry_ioctl(device_.get(), VIDIOC_QBUF, &buffer) == 0;
}

void V4l2Sink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        const std::int64_t first_ns = monotonic_ns();
        const bool sent = config_.io == V4l2Config::Io::kMmap ? queue_frame(*item) : write_frame(*item);
        if (sent) {
            delivered_.fetch_add(1);
            if (listener_) listener_->delivered(item->record, first_ns, monotonic_ns());
        } else if (failed_.fetch_add(1) == 0) {
            const std::lock_guard lock(mutex_);
            fault_ = config_.device + ": a frame was not taken: " + std::strerror(errno);
        }
        mailbox_.done();
    }
}

void V4l2Sink::stop() noexcept {
    if (thread_.joinable()) {
        mailbox_.close();
        thread_.join();
        int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
        retry_ioctl(device_.get(), VIDIOC_STREAMOFF, &type);
    }
    for (const Buffer& buffer : buffers_) munmap(buffer.memory, buffer.size);
    buffers_.clear();
    device_.reset();
}

SinkReport V4l2Sink::report() const {
    const std::lock_guard lock(mutex_);
    return {"v4l2 " + config_.device, delivered_.load(), mailbox_.dropped() + failed_.load(), fault_};
}

}  // namespace hilcam
