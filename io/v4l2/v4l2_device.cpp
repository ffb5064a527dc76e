#include "io/v4l2/v4l2_device.h"

#include <fcntl.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "io/v4l2/v4l2_formats.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr const char* kLoadAdvice =
    "; load the module with: modprobe v4l2loopback video_nr=42 card_label=hilcam exclusive_caps=1 "
    "max_buffers=4";
constexpr std::uint32_t kMaxBuffers = 32;  // v4l2loopback's own limit

std::string size_text(std::uint32_t width, std::uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

// Returns the pixel formats that the device accepts at present; a single one when a reader holds the format.
std::vector<std::uint32_t> offered_formats(int fd) {
    std::vector<std::uint32_t> list;
    v4l2_fmtdesc format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    for (; v4l2_ioctl(fd, VIDIOC_ENUM_FMT, &format) == 0; ++format.index) list.push_back(format.pixelformat);
    return list;
}

}  // namespace

void V4l2Output::open(const Request& request) {
    close();
    request_ = request;
    frame_bytes_ = request.bytes_per_line * static_cast<std::size_t>(request.height);
    fd_ = Fd(::open(request.device.c_str(), O_RDWR | O_CLOEXEC));
    if (!fd_) {
        const int reason = errno;
        std::string advice = kLoadAdvice;
        if (reason == EACCES) advice = "; add the user to the group 'video'";
        if (reason == EBUSY) advice = "; too many programs have it open (max_openers of the module)";
        throw DeviceError(request.device + ": cannot be opened: " + std::strerror(reason) + advice);
    }
    try {
        check_output();
        check_offered();
        set_format();
        prepare_buffers();
    } catch (...) {
        close();
        throw;
    }
}

void V4l2Output::check_output() {
    v4l2_capability capability{};
    if (v4l2_ioctl(fd_.get(), VIDIOC_QUERYCAP, &capability) < 0)
        throw DeviceError(request_.device + ": is not a V4L2 device" + kLoadAdvice);
    const std::uint32_t can =
        capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
    const auto* driver = reinterpret_cast<const char*>(capability.driver);
    if (!(can & V4L2_CAP_VIDEO_OUTPUT) && std::string_view(driver) == "v4l2 loopback")
        throw DeviceError(request_.device +
                          ": takes no frames: another program feeds it; stop that one, or give hilcam a "
                          "device of its own (devices=2 of the module)");
    if (!(can & V4L2_CAP_VIDEO_OUTPUT))
        throw DeviceError(request_.device + ": takes no frames (driver " + driver + ")" + kLoadAdvice);
    module_ = std::string_view(driver) == "v4l2 loopback" ? loaded_loopback_module() : LoopbackModule{};
    shared_queue_ = module_.shared_queue();
}

// Checked before S_FMT, because old modules answer an unknown format with another one and keep that. New ones
// accept more than they list, and refuse correctly.
void V4l2Output::check_offered() const {
    if (!shared_queue_) return;
    const std::vector<std::uint32_t> offered = offered_formats(fd_.get());
    std::string list;
    for (const std::uint32_t fourcc : offered) {
        if (fourcc == request_.fourcc) return;
        list.append(list.empty() ? "" : " ").append(fourcc_text(fourcc));
    }
    if (offered.size() > 1)
        throw DeviceError(request_.device + ": v4l2loopback " + module_.name() + " has no " +
                          fourcc_text(request_.fourcc) + "; it has " + list);
}

std::string V4l2Output::hint_of_fallback(std::uint32_t fourcc) const {
    if (offered_formats(fd_.get()).size() == 1)
        return "the device holds " + fourcc_text(fourcc) +
               " for a reader that has it open, or by its control keep_format: close that reader (fuser -v " +
               request_.device + " shows it), or choose that format";
    return "the module's max_width and max_height may be too small";
}

void V4l2Output::set_format() {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    v4l2_pix_format& pixels = format.fmt.pix;
    pixels.width = static_cast<std::uint32_t>(request_.width);
    pixels.height = static_cast<std::uint32_t>(request_.height);
    pixels.field = V4L2_FIELD_NONE;
    pixels.colorspace = V4L2_COLORSPACE_SRGB;
    pixels.pixelformat = request_.fourcc;
    const std::string asked = fourcc_text(request_.fourcc) + " " + size_text(pixels.width, pixels.height);
    if (v4l2_ioctl(fd_.get(), VIDIOC_S_FMT, &format) < 0) {
        const int reason = errno;
        if (reason == EINVAL && !shared_queue_)
            throw DeviceError(request_.device + ": has no " + asked + " (v4l2loopback " + module_.name() +
                              ", driver's answer: " + std::strerror(reason) + ")");
        throw DeviceError(request_.device + ": refuses " + asked + ": " + std::strerror(reason) +
                          "; another program feeds it or has it open with another size; if none does, "
                          "reload the module (modprobe -r v4l2loopback)");
    }
    const bool same = pixels.pixelformat == request_.fourcc &&
                      pixels.width == static_cast<std::uint32_t>(request_.width) &&
                      pixels.height == static_cast<std::uint32_t>(request_.height);
    if (!same)
        throw DeviceError(request_.device + ": asked for " + asked + ", got " +
                          fourcc_text(pixels.pixelformat) + " " + size_text(pixels.width, pixels.height) +
                          "; " + hint_of_fallback(pixels.pixelformat));
    if (pixels.bytesperline != request_.bytes_per_line || pixels.sizeimage < frame_bytes_)
        throw DeviceError(
            request_.device + ": takes " + asked + " with " + std::to_string(pixels.bytesperline) +
            " bytes a line in " + std::to_string(pixels.sizeimage) + " bytes, but a frame has " +
            std::to_string(request_.bytes_per_line) + " a line and " + std::to_string(frame_bytes_) +
            ": this module's " + fourcc_text(request_.fourcc) + " is of no use");
    v4l2_streamparm rate{};
    rate.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    rate.parm.output.timeperframe = {1000,
                                     static_cast<std::uint32_t>(std::lround(request_.frame_rate_hz * 1000))};
    // Readers see it as the frame rate. Not every module accepts it, and nothing depends on it.
    static_cast<void>(v4l2_ioctl(fd_.get(), VIDIOC_S_PARM, &rate));
}

void V4l2Output::prepare_buffers() {
    const auto refuse = [this](const char* what) {
        const int reason = errno;
        throw DeviceError(request_.device + ": " + what + ": " + std::strerror(reason));
    };
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    queued_ = 0;
    next_index_ = 0;
    if (shared_queue_) {
        // STREAMON is needed for write(), too; without it the device would not be an output again after we
        // are gone.
        if (v4l2_ioctl(fd_.get(), VIDIOC_STREAMON, &type) < 0) refuse("does not start");
        // REQBUFS would unmap the buffers of readers that are streaming.
        if (!buffers_.map_existing(fd_.get(), kMaxBuffers)) refuse("gives no buffers");
        in_use_ = buffers_.size();
    } else if (request_.mapped) {
        if (!buffers_.request(fd_.get(), request_.buffers)) refuse("gives no buffers; try 'io: write'");
        if (v4l2_ioctl(fd_.get(), VIDIOC_STREAMON, &type) < 0) refuse("does not start");
        in_use_ = buffers_.size();
    }
    if (!request_.mapped) staging_.resize(frame_bytes_);
    for (std::size_t i = 0; request_.mapped && i < buffers_.size(); ++i)
        if (buffers_.memory(i).size() < frame_bytes_)
            throw DeviceError(request_.device + ": its buffers are smaller than a frame");
}

// Counts the buffers in use, because a reader may have removed some.
void V4l2Output::recount() {
    std::size_t distinct = 0;
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
        v4l2_buffer buffer = output_buffer(i);
        if (v4l2_ioctl(fd_.get(), VIDIOC_QUERYBUF, &buffer) < 0) break;
        if (i > 0 && buffers_.at_offset(buffer.m.offset) == 0) break;
        ++distinct;
    }
    in_use_ = std::max<std::size_t>(1, distinct);
}

std::span<std::uint8_t> V4l2Output::next() noexcept {
    if (!request_.mapped) return staging_;
    v4l2_buffer buffer = output_buffer(next_index_);
    if (shared_queue_) {
        recount();
        next_index_ = static_cast<std::uint32_t>((next_index_ + 1) % in_use_);
        buffer = output_buffer(next_index_);
        if (v4l2_ioctl(fd_.get(), VIDIOC_QUERYBUF, &buffer) < 0) return {};
        const std::size_t place = buffers_.at_offset(buffer.m.offset);
        return place < buffers_.size() ? buffers_.memory(place) : std::span<std::uint8_t>{};
    }
    if (queued_ < buffers_.size()) {
        next_index_ = static_cast<std::uint32_t>(queued_);
        return buffers_.memory(next_index_);
    }
    if (v4l2_ioctl(fd_.get(), VIDIOC_DQBUF, &buffer) < 0 || buffer.index >= buffers_.size()) return {};
    next_index_ = buffer.index;
    return buffers_.memory(next_index_);
}

bool V4l2Output::submit(std::int64_t timestamp_ns) noexcept {
    if (!request_.mapped)
        return ::write(fd_.get(), staging_.data(), staging_.size()) == static_cast<ssize_t>(staging_.size());
    v4l2_buffer buffer = output_buffer(next_index_);
    buffer.bytesused = static_cast<std::uint32_t>(frame_bytes_);
    buffer.timestamp.tv_sec = timestamp_ns / 1'000'000'000;
    buffer.timestamp.tv_usec = timestamp_ns % 1'000'000'000 / 1000;
    if (v4l2_ioctl(fd_.get(), VIDIOC_QBUF, &buffer) < 0) return false;
    if (!shared_queue_ && queued_ < buffers_.size()) ++queued_;
    return true;
}

void V4l2Output::close() noexcept {
    if (!fd_) return;
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    static_cast<void>(v4l2_ioctl(fd_.get(), VIDIOC_STREAMOFF, &type));
    buffers_.release();
    fd_.reset();
}

}  // namespace hilcam
