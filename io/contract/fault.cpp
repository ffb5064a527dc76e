#include "io/contract/fault.h"

#include <cmath>

#include "io/system/monotonic.h"
#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

struct Kind {
    FaultKind kind;
    std::string_view name, meaning;
    bool once = false;
    double least = 0, most = 0;  // range of the value; equal: it has none
};

constexpr std::array<Kind, kAllFaults.size()> kKinds = {{
    {FaultKind::kPacketDrop, "packet_drop", "stream packets are not sent"},
    {FaultKind::kPacketDuplicate, "packet_duplicate", "stream packets are sent twice"},
    {FaultKind::kPacketReorder, "packet_reorder", "a stream packet changes places with the next"},
    {FaultKind::kPacketDelay, "packet_delay", "stream packets come late; value: ms", false, 0, 10000},
    {FaultKind::kPacketCorrupt, "packet_corrupt", "a byte of the payload is inverted"},
    {FaultKind::kPacketWrongId, "packet_wrong_id", "value is added to the packet id", false, -1e6, 1e6},
    {FaultKind::kPacketTruncate, "packet_truncate", "value: bytes cut off the end", false, 1, 16384},
    {FaultKind::kLeaderLost, "leader_lost", "leaders are not sent"},
    {FaultKind::kTrailerLost, "trailer_lost", "trailers are not sent"},
    {FaultKind::kResendRefused, "resend_refused", "resend requests get 'packet unavailable'"},
    {FaultKind::kResendDelayed, "resend_delayed", "resent packets come late; value: ms", false, 0, 10000},
    {FaultKind::kResendWrongId, "resend_wrong_id", "value is added to a resent packet's id", false, -1e6,
     1e6},
    {FaultKind::kBandwidthCap, "bandwidth_cap", "the stream's rate; value: MB/s", false, 0.001, 1e5},
    {FaultKind::kFrameDrop, "frame_drop", "frames are not sent, their block ids are skipped"},
    {FaultKind::kFrameRepeat, "frame_repeat", "the frame before is sent again in a frame's place"},
    {FaultKind::kWrongSizeY, "wrong_size_y", "value is added to the trailer's height", false, -65535, 65535},
    {FaultKind::kTimestampStep, "timestamp_step", "value: ms added to time stamps", false, -1e9, 1e9},
    {FaultKind::kTimestampDrift, "timestamp_drift", "value: ppm that time stamps run fast", false, -1e6, 1e6},
    {FaultKind::kTimestampFreeze, "timestamp_freeze", "time stamps stand still"},
    {FaultKind::kBlockIdWrap, "block_id_wrap", "once: the next block id is 65530", true},
    {FaultKind::kControlSilence, "control_silence", "control messages get no answer"},
    {FaultKind::kControlSlow, "control_slow", "answers come late, with PENDING_ACK; value: ms", false, 0,
     60000},
    {FaultKind::kControlBusy, "control_busy", "control messages are answered BUSY"},
    {FaultKind::kControlDenied, "control_denied", "control messages are answered ACCESS_DENIED"},
    {FaultKind::kHeartbeatIgnored, "heartbeat_ignored", "the controller is lost although it speaks"},
    {FaultKind::kDeviceReset, "device_reset", "once: control, stream and settings as after power-up", true},
    {FaultKind::kLinkDown, "link_down", "neither control nor stream"},
    {FaultKind::kIpChange, "ip_change", "once: value is added to the address's last byte", true, 1, 254},
    {FaultKind::kTestPacketLimit, "test_packet_limit", "value: bytes; longer test packets are lost", false,
     64, 65535},
    {FaultKind::kV4l2Stall, "v4l2_stall", "the V4L2 device gets no frames"},
    {FaultKind::kV4l2Restart, "v4l2_restart", "once: the V4L2 device is closed and opened again", true},
    {FaultKind::kV4l2FormatFlip, "v4l2_format_flip", "once: opened again with the other bit depth", true},
    {FaultKind::kUsbDetach, "usb_detach", "the USB device leaves the bus"},
    {FaultKind::kUsbShortTransfer, "usb_short_transfer", "answers come in two transfers"},
    {FaultKind::kUsbStall, "usb_stall", "answers are withheld"},
    {FaultKind::kUsbBadCrc, "usb_bad_crc", "answers have a wrong CRC"},
    {FaultKind::kImageStuck, "image_stuck", "the picture of the frame before"},
    {FaultKind::kImageBlack, "image_black", "all pixels 0"},
    {FaultKind::kImageSaturated, "image_saturated", "all pixels full scale"},
    {FaultKind::kImageBitFlips, "image_bit_flips", "one bit of struck pixels; rate is per pixel"},
    {FaultKind::kImageTear, "image_tear", "rows below `value` of the height are of the frame before", false,
     0, 1},
}};

const Kind* find(FaultKind kind) {
    for (const Kind& k : kKinds)
        if (k.kind == kind) return &k;
    return nullptr;
}

}  // namespace

std::string_view name_of(FaultKind kind) {
    const Kind* k = find(kind);
    return k ? k->name : std::string_view{};
}
std::string_view meaning_of(FaultKind kind) {
    const Kind* k = find(kind);
    return k ? k->meaning : std::string_view{};
}
std::optional<FaultKind> fault_named(std::string_view name) {
    for (const Kind& k : kKinds)
        if (k.name == name) return k.kind;
    return {};
}
std::uint64_t bit_of(FaultKind kind) {
    const Kind* k = find(kind);
    return k ? std::uint64_t{1} << (k - kKinds.data()) : 0;
}

std::string_view refusal_of(const FaultOrder& o) {
    const Kind* k = find(o.kind);
    if (!k) return "no such kind of fault";
    if (!(o.rate >= 0 && o.rate <= 1)) return "rate is not 0 to 1";
    if (!std::isfinite(o.value)) return "value is not finite";
    if (o.rate > 0 && k->least < k->most && !(o.value >= k->least && o.value <= k->most))
        return "value is outside its kind's range";
    if (!(o.duration_s >= 0 && o.duration_s <= 1e7)) return "duration is not 0 to 1e7 s";
    return {};
}

// --- the board

struct FaultBoard::State {
    FaultOrder order;
    std::uint64_t number = 0;  // number of the order; 0: none yet
    std::int64_t since_ns = 0, until_ns = 0;

    bool covers(std::uint64_t frame) const {
        if (number == 0 || order.rate <= 0) return false;
        // An item that belongs to no frame is struck whatever the span of frames.
        if (frame != 0 && frame < order.from_frame) return false;
        if (frame != 0 && order.frames != 0 && frame >= order.from_frame + order.frames) return false;
        return until_ns == 0 || monotonic_ns() < until_ns;
    }
};

std::size_t FaultBoard::place_of(FaultKind kind) {
    const Kind* k = find(kind);
    return k ? static_cast<std::size_t>(k - kKinds.data()) : kAllFaults.size();
}

void FaultBoard::order(FaultOrder o) {
    const std::size_t place = place_of(o.kind);
    if (place == kAllFaults.size() || !refusal_of(o).empty()) return;
    if (o.frames != 0 && o.from_frame == 0) o.from_frame = next_frame();
    while (writing_.test_and_set(std::memory_order_acquire)) {
    }
    Cell& c = cells_[place];
    const std::uint32_t version = c.version.load(std::memory_order_relaxed);
    // Whoever reads (acquires) one of the values stored from here on also sees this odd version. No fences:
    // ThreadSanitizer does not know them.
    c.version.store(version + 1, std::memory_order_relaxed);
    const std::int64_t now_ns = monotonic_ns();
    c.rate.store(o.rate, std::memory_order_release);
    c.value.store(o.value, std::memory_order_release);
    c.from_frame.store(o.from_frame, std::memory_order_release);
    c.frames.store(o.frames, std::memory_order_release);
    c.duration_s.store(o.duration_s, std::memory_order_release);
    c.since_ns.store(now_ns, std::memory_order_release);
    c.until_ns.store(o.duration_s > 0 ? now_ns + static_cast<std::int64_t>(o.duration_s * 1e9) : 0,
                     std::memory_order_release);
    c.order.store(orders_.fetch_add(1) + 1, std::memory_order_release);
    c.version.store(version + 2, std::memory_order_release);
    writing_.clear(std::memory_order_release);
}

void FaultBoard::clear_all() {
    for (const FaultKind kind : kAllFaults) order({kind, 0, 0, 0, 0, 0});
}

FaultBoard::State FaultBoard::read(const Cell& c) const {
    State s;
    std::uint32_t before = 0;
    do {
        before = c.version.load(std::memory_order_acquire);
        s.order.rate = c.rate.load(std::memory_order_acquire);
        s.order.value = c.value.load(std::memory_order_acquire);
        s.order.from_frame = c.from_frame.load(std::memory_order_acquire);
        s.order.frames = c.frames.load(std::memory_order_acquire);
        s.order.duration_s = c.duration_s.load(std::memory_order_acquire);
        s.since_ns = c.since_ns.load(std::memory_order_acquire);
        s.until_ns = c.until_ns.load(std::memory_order_acquire);
        s.number = c.order.load(std::memory_order_acquire);
    } while (before % 2 != 0 || before != c.version.load(std::memory_order_relaxed));
    return s;
}

std::optional<FaultOrder> FaultBoard::order_of(FaultKind kind) const {
    const std::size_t place = place_of(kind);
    if (place == kAllFaults.size()) return {};
    State s = read(cells_[place]);
    s.order.kind = kind;
    if (s.number == 0 || s.order.rate <= 0 || (s.until_ns != 0 && monotonic_ns() >= s.until_ns)) return {};
    return s.order;
}

std::int64_t FaultBoard::since_monotonic_ns(FaultKind kind) const {
    const std::size_t place = place_of(kind);
    return place == kAllFaults.size() ? 0 : cells_[place].since_ns.load();
}

std::optional<double> FaultBoard::would_strike(FaultKind kind, std::uint64_t frame,
                                               std::uint64_t index) const {
    const std::size_t place = place_of(kind);
    if (place == kAllFaults.size()) return {};
    const Cell& c = cells_[place];
    if (c.order.load(std::memory_order_relaxed) == 0) return {};  // the common case
    const State s = read(c);
    if (!s.covers(frame)) return {};
    if (kKinds[place].once && c.struck_order.load() == s.number) return {};
    if (s.order.rate < 1) {
        const std::array words =
            random_words({seed_ ^ index >> 32 << 32, frame}, RandomPurpose::kFault,
                         static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(kind));
        // 64 bits of chance: rates down to 1e-15 are what they say.
        const std::uint64_t word = std::uint64_t{words[0]} << 32 | words[1];
        if (static_cast<double>(word) * 0x1p-64 >= s.order.rate) return {};
    }
    return s.order.value;
}

bool FaultBoard::within_span(FaultKind kind, std::uint64_t frame) const {
    const std::size_t place = place_of(kind);
    if (place == kAllFaults.size()) return false;
    const Cell& c = cells_[place];
    return c.order.load(std::memory_order_relaxed) != 0 && read(c).covers(frame);
}

void FaultBoard::count(FaultKind kind, std::uint64_t frame, std::uint64_t strikes, double value) {
    const std::size_t place = place_of(kind);
    if (place == kAllFaults.size()) return;
    Cell& c = cells_[place];
    c.struck.fetch_add(strikes, std::memory_order_relaxed);
    if (c.last_frame.exchange(frame, std::memory_order_relaxed) != frame || frame == 0)
        log({kind, frame, 0, value, monotonic_ns()});
}

std::optional<double> FaultBoard::strikes(FaultKind kind, std::uint64_t frame, std::uint64_t index) {
    const std::optional<double> value = would_strike(kind, frame, index);
    if (!value) return {};
    Cell& c = cells_[place_of(kind)];
    if (kKinds[place_of(kind)].once) {
        // When several threads ask, one gets it.
        const std::uint64_t number = c.order.load();
        if (c.struck_order.exchange(number) == number) return {};
    }
    c.struck.fetch_add(1, std::memory_order_relaxed);
    if (c.last_frame.exchange(frame, std::memory_order_relaxed) != frame || frame == 0)
        log({kind, frame, index, *value, monotonic_ns()});
    return value;
}

std::uint64_t FaultBoard::strikes_of(FaultKind kind) const {
    const std::size_t place = place_of(kind);
    return place == kAllFaults.size() ? 0 : cells_[place].struck.load();
}
std::uint64_t FaultBoard::all_strikes() const {
    std::uint64_t sum = 0;
    for (const Cell& c : cells_) sum += c.struck.load();
    return sum;
}

// A ring whose slots carry the turn they were written in: a reader that was overtaken sees it.
void FaultBoard::log(const Entry& entry) {
    const std::uint64_t turn = log_head_.fetch_add(1, std::memory_order_relaxed);
    LogSlot& slot = log_[turn % kLogLength];
    slot.turn.store(0, std::memory_order_relaxed);
    slot.kind.store(entry.kind, std::memory_order_release);
    slot.frame.store(entry.frame, std::memory_order_release);
    slot.index.store(entry.index, std::memory_order_release);
    slot.value.store(entry.value, std::memory_order_release);
    slot.monotonic_ns.store(entry.monotonic_ns, std::memory_order_release);
    slot.turn.store(turn + 1, std::memory_order_release);
}

bool FaultBoard::take_entry(Entry& entry) {
    const std::uint64_t head = log_head_.load(std::memory_order_acquire);
    if (head > log_tail_ + kLogLength) log_tail_ = head - kLogLength;
    while (log_tail_ < head) {
        const LogSlot& slot = log_[log_tail_ % kLogLength];
        if (slot.turn.load(std::memory_order_acquire) != log_tail_ + 1) {
            // Being written: later. Overtaken: lost.
            if (log_head_.load() <= log_tail_ + kLogLength) return false;
            ++log_tail_;
            continue;
        }
        entry = {slot.kind.load(std::memory_order_acquire), slot.frame.load(std::memory_order_acquire),
                 slot.index.load(std::memory_order_acquire), slot.value.load(std::memory_order_acquire),
                 slot.monotonic_ns.load(std::memory_order_acquire)};
        const bool whole = slot.turn.load(std::memory_order_relaxed) == log_tail_ + 1;
        ++log_tail_;
        if (whole) return true;
    }
    return false;
}

}  // namespace hilcam
