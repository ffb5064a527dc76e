#include "io/v4l2/sink_v4l2.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "io/contract/camera_control.h"
#include "io/contract/fault.h"
#include "io/system/monotonic.h"
#include "io/v4l2/v4l2_metadata_row.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::int64_t kMinInterval_ns = 1'000'000;  // whatever rate the camera claims
constexpr std::int64_t kRetry_ns = 500'000'000;

void sleep_until(std::int64_t ns) {
    const timespec t{ns / 1'000'000'000, ns % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
}

bool is_bayer(V4l2Format f) {
    return f == V4l2Format::kBayer8 || f == V4l2Format::kBayer10 || f == V4l2Format::kBayer12;
}

void check_metadata_row(const V4l2Config& c, std::size_t bytes_per_line) {
    if (c.metadata_row == V4l2Config::MetadataRow::kOff) return;
    if (bytes_per_line < kMetadataBytes)
        throw InputError("outputs.v4l2.metadata_row: needs lines of " + std::to_string(kMetadataBytes) +
                         " bytes; this picture's have " + std::to_string(bytes_per_line));
    if (c.metadata_row == V4l2Config::MetadataRow::kTop && is_bayer(c.format))
        throw InputError(
            "outputs.v4l2.metadata_row: found 'top', which shifts the phase of a mosaic; "
            "accepted with Bayer formats: off, bottom");
}

}  // namespace

Fields fields(V4l2Config& c) {
    return {
        text("device", c.device, "output device of v4l2loopback"),
        choice("format", c.format, {"GREY", "Y16", "BAYER8", "BAYER10", "BAYER12", "YUYV", "RGB24"},
               "pixel format. GREY: the upper 8 bits; Y16: the DN in the upper bits of 16; BAYER10, BAYER12: "
               "16-bit words, from v4l2loopback 0.14 on"),
        choice("io", c.io, {"mmap", "write"},
               "way to write to the device. mmap: time stamps are exposure times; write: time stamps are the "
               "module's, and frames are counted with every module version"),
        choice(
            "metadata_row", c.metadata_row, {"off", "top", "bottom"},
            "place of an extra row of the picture with frame id, times, pose and faults (docs/devices.md)"),
        integer("buffers", c.buffers, {2, 32},
                "number of buffers; before v4l2loopback 0.14 its max_buffers is used"),
    };
}

V4l2Sink::V4l2Sink(const V4l2Config& config, int width, int height, double frame_rate_hz,
                   const SinkContext& context)
    : config_(config),
      width_(width),
      height_(height),
      pattern_(context.camera.limits().color_pattern),
      context_(context),
      format_(config.format),
      mailbox_(width, height, 4) {
    use(config.format);
    check_metadata_row(config, pixels_.bytes_per_pixel * static_cast<std::size_t>(width));
    row_.resize(3 * static_cast<std::size_t>(width) + 8);
    // Half a period lets the loop's jitter pass, but no burst without pauses.
    const double fastest_hz = std::max(frame_rate_hz, context.camera.limits().max_frame_rate_hz);
    min_interval_ns_ = std::max(kMinInterval_ns, static_cast<std::int64_t>(std::llround(0.5e9 / fastest_hz)));
}

void V4l2Sink::use(V4l2Format format) {
    pixels_ = pixels_of(format, pattern_, width_);
    format_ = format;
}

void V4l2Sink::open_device() {
    V4l2Output::Request request;
    request.device = config_.device;
    request.fourcc = pixels_.fourcc;
    request.width = width_;
    request.height = height_ + (config_.metadata_row == V4l2Config::MetadataRow::kOff ? 0 : 1);
    request.bytes_per_line = pixels_.bytes_per_pixel * static_cast<std::size_t>(width_);
    request.frame_rate_hz = context_.camera.settings().frame_rate_hz;
    request.mapped = config_.io == V4l2Config::Io::kMmap;
    request.buffers = static_cast<unsigned>(config_.buffers);
    device_.open(request);
}

void V4l2Sink::start() {
    open_device();
    mailbox_.open();
    thread_ = std::thread([this] { run(); });
}

void V4l2Sink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    mailbox_.put(frame, record);
}

void V4l2Sink::note_fault(const std::string& text) noexcept {
    const std::lock_guard lock(mutex_);
    fault_ = text;
}

bool V4l2Sink::reopen() noexcept {
    retry_ns_ = monotonic_ns() + kRetry_ns;
    try {
        open_device();
        counters_.reopened.fetch_add(1);
        note_fault("");
        return true;
    } catch (const std::exception& error) {
        note_fault(error.what());
        return false;
    }
}

// Returns to the previous format when the device does not accept the other one.
void V4l2Sink::flip_format() noexcept {
    const V4l2Format before = format_;
    device_.close();
    try {
        use(format_ == config_.format ? flipped(config_.format) : config_.format);
        open_device();
        counters_.reopened.fetch_add(1);
    } catch (const std::exception&) {
        counters_.flips_refused.fetch_add(1);
        use(before);
        reopen();
    }
}

void V4l2Sink::strike_faults(std::uint64_t frame) noexcept {
    if (context_.faults.strikes(FaultKind::kV4l2Restart, frame)) {
        device_.close();
        reopen();
    }
    if (context_.faults.strikes(FaultKind::kV4l2FormatFlip, frame)) flip_format();
}

void V4l2Sink::pace() noexcept {
    const std::int64_t due_ns = last_ns_ + min_interval_ns_;
    if (monotonic_ns() < due_ns) sleep_until(due_ns);
    last_ns_ = monotonic_ns();
}

void V4l2Sink::draw(const FrameMailbox::Item& item, std::span<std::uint8_t> out) noexcept {
    const std::size_t line = pixels_.bytes_per_pixel * static_cast<std::size_t>(width_);
    const std::size_t picture = line * static_cast<std::size_t>(height_);
    const bool top = config_.metadata_row == V4l2Config::MetadataRow::kTop;
    write_wire(item.frame, {0, 0, width_, height_}, item.record.bits, pixels_.wire, pattern_, row_,
               out.subspan(top ? line : 0, picture));
    if (config_.metadata_row != V4l2Config::MetadataRow::kOff)
        write_metadata_row(item.record, out.subspan(top ? 0 : picture, line));
}

bool V4l2Sink::deliver(const FrameMailbox::Item& item) noexcept {
    const std::int64_t begun_ns = monotonic_ns();
    const std::span<std::uint8_t> out = device_.next();
    if (!out.empty()) draw(item, out);
    if (out.empty() || !device_.submit(item.record.exposure_mid_monotonic_ns)) {
        note_fault(config_.device + ": a frame was not taken: " + std::strerror(errno));
        device_.close();
        retry_ns_ = monotonic_ns() + kRetry_ns;
        return false;
    }
    counters_.buffers.store(device_.buffers_in_use());
    if (context_.listener) context_.listener->delivered(item.record, begun_ns, monotonic_ns());
    return true;
}

// Delivers the frame when it is due; false when the device is not there or does not take it.
bool V4l2Sink::takes(const FrameMailbox::Item& item) noexcept {
    if (!device_.is_open()) return false;
    pace();
    return deliver(item);
}

void V4l2Sink::run() {
    while (const FrameMailbox::Item* item = mailbox_.wait()) {
        strike_faults(item->record.id);
        if (!device_.is_open() && monotonic_ns() >= retry_ns_) reopen();
        if (context_.faults.strikes(FaultKind::kV4l2Stall, item->record.id)) {
            counters_.stalled.fetch_add(1);
        } else if (takes(*item)) {
            counters_.delivered.fetch_add(1);
        } else {
            counters_.failed.add(item->record.id);
        }
        mailbox_.done();
    }
}

void V4l2Sink::stop() noexcept {
    if (thread_.joinable()) {
        mailbox_.close();
        thread_.join();
    }
    device_.close();
}

bool V4l2Sink::has_fault() const noexcept {
    const std::lock_guard lock(mutex_);
    return !fault_.empty();
}

SinkReport V4l2Sink::report() const {
    SinkReport report;
    report.name = "v4l2 " + config_.device;
    report.frames = counters_.delivered.load();
    report.dropped = mailbox_.dropped() + counters_.failed.count() + counters_.stalled.load();
    report.dropped_by_faults = counters_.stalled.load();
    report.first_dropped = first_of({mailbox_.first_dropped(), counters_.failed.first()});
    report.figures = {{"stalled", static_cast<double>(counters_.stalled.load())},
                      {"reopened", static_cast<double>(counters_.reopened.load())},
                      {"format_flips_refused", static_cast<double>(counters_.flips_refused.load())},
                      {"buffers", static_cast<double>(counters_.buffers.load())}};
    const std::lock_guard lock(mutex_);
    report.fault = fault_;
    return report;
}

std::unique_ptr<FrameSink> make_sink(const V4l2Config& config, const SinkContext& context,
                                     const OutputShape& shape) {
    return std::make_unique<V4l2Sink>(config, shape.fixed_width, shape.fixed_height, shape.frame_rate_hz,
                                      context);
}

}  // namespace hilcam
