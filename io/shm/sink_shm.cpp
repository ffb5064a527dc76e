#include "io/shm/sink_shm.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include "io/contract/camera_control.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kPage_bytes = 4096, kLongestName = 200;

bool names_a_memory(std::string_view name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.';
    };
    return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
           std::all_of(name.begin(), name.end(), fits);
}

template <std::size_t kSize>
void copy_text(const std::string& text, std::array<char, kSize>& out) {
    out.fill(0);
    std::copy_n(text.begin(), std::min(text.size(), kSize - 1), out.begin());
}

void wake_readers(ShmHeader& header) noexcept {
    syscall(SYS_futex, &header.news, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void describe(const FrameRecord& r, ShmSlot& slot) noexcept {
    slot.id = r.id;
    slot.exposure_mid_tai_ns = r.exposure_mid.ns;
    slot.exposure_mid_monotonic_ns = r.exposure_mid_monotonic_ns;
    slot.exposure_s = r.exposure_s, slot.gain_db = r.gain_db, slot.black_level_dn = r.black_level_dn;
    slot.bits = static_cast<std::uint32_t>(r.bits);
    slot.binning_x = static_cast<std::uint32_t>(r.binning_x);
    slot.binning_y = static_cast<std::uint32_t>(r.binning_y);
    slot.pose_sequence = r.pose_sequence, slot.trigger_sequence = r.trigger_sequence;
    slot.pose_tai_ns = r.pose_time.ns;
    slot.faults = r.faults, slot.quality_level = r.quality_level;
    slot.flags = (r.reverse_x ? kShmReverseX : 0) | (r.reverse_y ? kShmReverseY : 0) |
                 (r.camera ? kShmHasPose : 0) | (r.has_truth ? kShmHasTruth : 0);
    slot.command_arrival_monotonic_ns = r.command_arrival_monotonic_ns;
    const Pose pose = r.camera.value_or(Pose{});
    slot.camera_position_m = {pose.position_world_m.x, pose.position_world_m.y, pose.position_world_m.z};
    const Quat& q = pose.world_from_body;
    slot.camera_attitude_wxyz = {q.w, q.x, q.y, q.z};
}

}  // namespace

Fields fields(ShmConfig& c) {
    return {
        text("name", c.name, "name of the shared memory, a file in /dev/shm; each camera needs its own"),
        integer(
            "slots", c.slots, {2, 1024},
            "number of frames in the memory; a reader has the time of all but one of them to read a frame"),
    };
}

void validate(const ShmConfig& c) {
    if (!names_a_memory(c.name))
        throw refused_key("name", in_quotes(c.name),
                          "1 to 200 of a-z, A-Z, 0-9, '_', '-' and '.', no '.' at the begin");
}

ShmSink::ShmSink(const ShmConfig& config, int width, int height, std::string camera, std::string colors,
                 DeliveryListener* listener)
    : config_(config),
      width_(width),
      height_(height),
      camera_(std::move(camera)),
      colors_(std::move(colors)),
      listener_(listener) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    slot_bytes_ =
        (kShmSlotHeaderBytes + sizeof(std::uint16_t) * pixels + kPage_bytes - 1) / kPage_bytes * kPage_bytes;
}

void ShmSink::start() {
    const std::size_t bytes = kShmHeaderBytes + static_cast<std::size_t>(config_.slots) * slot_bytes_;
    segment_.create(config_.name, bytes);
    ShmHeader& header = *new (segment_.data()) ShmHeader{};
    header.version = kShmVersion;
    header.header_bytes = kShmHeaderBytes;
    header.slots = static_cast<std::uint32_t>(config_.slots);
    header.slot_header_bytes = kShmSlotHeaderBytes;
    header.slot_bytes = slot_bytes_;
    header.segment_bytes = bytes;
    header.max_width_px = static_cast<std::uint32_t>(width_);
    header.max_height_px = static_cast<std::uint32_t>(height_);
    header.pixel_bytes = sizeof(std::uint16_t);
    header.writer_pid = static_cast<std::uint32_t>(getpid());
    copy_text(camera_, header.camera);
    copy_text(colors_, header.colors);
    for (std::size_t i = 0; i < header.slots; ++i)
        new (segment_.data() + kShmHeaderBytes + i * slot_bytes_) ShmSlot{};
    count_ = 0;
    header.magic.store(kShmMagic, std::memory_order_release);
}

void ShmSink::publish(const DnImage& frame, const FrameRecord& record) noexcept {
    const std::size_t bytes = sizeof(std::uint16_t) * frame.pixels();
    if (!segment_.data() || kShmSlotHeaderBytes + bytes > slot_bytes_) {
        dropped_.add(record.id);
        return;
    }
    const std::int64_t begun_ns = monotonic_ns();
    ShmHeader& header = segment_.header();
    const std::uint64_t number = ++count_;
    std::byte* const place = segment_.data() + kShmHeaderBytes +
                             (number - 1) % static_cast<std::uint64_t>(config_.slots) * slot_bytes_;
    auto& slot = *reinterpret_cast<ShmSlot*>(place);
    slot.sequence.store(2 * number - 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);  // nothing below becomes visible before it
    std::memcpy(place + kShmSlotHeaderBytes, frame.data(), bytes);
    describe(record, slot);
    slot.width_px = static_cast<std::uint32_t>(frame.width());
    slot.height_px = static_cast<std::uint32_t>(frame.height());
    slot.row_bytes = static_cast<std::uint32_t>(sizeof(std::uint16_t)) * slot.width_px;
    slot.published_monotonic_ns = monotonic_ns();
    slot.sequence.store(2 * number, std::memory_order_release);
    header.published.store(number, std::memory_order_release);
    header.news.store(static_cast<std::uint32_t>(number), std::memory_order_release);
    wake_readers(header);
    published_.store(number, std::memory_order_relaxed);
    if (listener_) listener_->delivered(record, begun_ns, monotonic_ns());
}

void ShmSink::stop() noexcept {
    if (!segment_.data()) return;
    ShmHeader& header = segment_.header();
    header.ended.store(1, std::memory_order_release);
    header.news.fetch_add(1, std::memory_order_release);  // wakes a reader that is about to wait
    wake_readers(header);
    segment_.remove();
}

SinkReport ShmSink::report() const {
    return {.name = "shm " + config_.name,
            .frames = published_.load(),
            .dropped = dropped_.count(),
            .first_dropped = dropped_.first()};
}

std::unique_ptr<FrameSink> make_sink(const ShmConfig& config, const SinkContext& context,
                                     const OutputShape& shape) {
    return std::make_unique<ShmSink>(config, shape.width, shape.height, shape.camera_name,
                                     context.camera.limits().color_pattern, context.listener);
}

}  // namespace hilcam
