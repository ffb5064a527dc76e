#include "io/contract/fault.h"

#include <cmath>

#include "io/system/monotonic.h"
#include "render/vocabulary/random.h"

namespace hilcam {

std::string_view refusal_of(const FaultOrder& o) {
    const FaultTraits* traits = traits_of(o.kind);
    if (!traits) return "no such kind of fault";
    if (!(o.rate >= 0 && o.rate <= 1)) return "rate is not 0 to 1";
    if (!std::isfinite(o.value)) return "value is not finite";
    if (o.rate > 0 && traits->has_value() && !(o.value >= traits->least && o.value <= traits->most))
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
    const FaultTraits* traits = traits_of(kind);
    return traits ? static_cast<std::size_t>(traits - kFaultTable.data()) : kFaultTable.size();
}

void FaultBoard::order(FaultOrder o) {
    const std::size_t place = place_of(o.kind);
    if (place == kFaultTable.size() || !refusal_of(o).empty()) return;
    if (o.frames != 0 && o.from_frame == 0) o.from_frame = next_frame();
    while (writing_.test_and_set(std::memory_order_acquire)) {
    }
    Cell& c = cells_[place];
    const std::uint32_t version = c.version.load(std::memory_order_relaxed);
    // A reader that acquires one of the values stored below also sees this odd version. There are no fences,
    // because ThreadSanitizer does not know them.
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
    if (place == kFaultTable.size()) return {};
    State s = read(cells_[place]);
    s.order.kind = kind;
    if (s.number == 0 || s.order.rate <= 0 || (s.until_ns != 0 && monotonic_ns() >= s.until_ns)) return {};
    return s.order;
}

std::int64_t FaultBoard::since_monotonic_ns(FaultKind kind) const {
    const std::size_t place = place_of(kind);
    return place == kFaultTable.size() ? 0 : cells_[place].since_ns.load();
}

std::optional<double> FaultBoard::would_strike(FaultKind kind, std::uint64_t frame,
                                               std::uint64_t index) const {
    const std::size_t place = place_of(kind);
    if (place == kFaultTable.size()) return {};
    const Cell& c = cells_[place];
    if (c.order.load(std::memory_order_relaxed) == 0) return {};  // the common case
    const State s = read(c);
    if (!s.covers(frame)) return {};
    if (kFaultTable[place].once && c.struck_order.load() == s.number) return {};
    if (s.order.rate < 1) {
        const std::array words =
            random_words({seed_ ^ index >> 32 << 32, frame}, RandomPurpose::kFault,
                         static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(kind));
        // 64 random bits, so that even rates of 1e-15 hold.
        const std::uint64_t word = std::uint64_t{words[0]} << 32 | words[1];
        if (static_cast<double>(word) * 0x1p-64 >= s.order.rate) return {};
    }
    return s.order.value;
}

bool FaultBoard::within_span(FaultKind kind, std::uint64_t frame) const {
    const std::size_t place = place_of(kind);
    if (place == kFaultTable.size()) return false;
    const Cell& c = cells_[place];
    return c.order.load(std::memory_order_relaxed) != 0 && read(c).covers(frame);
}

void FaultBoard::count(FaultKind kind, std::uint64_t frame, std::uint64_t strikes, double value) {
    const std::size_t place = place_of(kind);
    if (place == kFaultTable.size()) return;
    Cell& c = cells_[place];
    c.struck.fetch_add(strikes, std::memory_order_relaxed);
    if (c.last_frame.exchange(frame, std::memory_order_relaxed) != frame || frame == 0)
        log({kind, frame, 0, value, monotonic_ns()});
}

std::optional<double> FaultBoard::strikes(FaultKind kind, std::uint64_t frame, std::uint64_t index) {
    const std::optional<double> value = would_strike(kind, frame, index);
    if (!value) return {};
    Cell& c = cells_[place_of(kind)];
    if (kFaultTable[place_of(kind)].once) {
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
    return place == kFaultTable.size() ? 0 : cells_[place].struck.load();
}
std::uint64_t FaultBoard::all_strikes() const {
    std::uint64_t sum = 0;
    for (const Cell& c : cells_) sum += c.struck.load();
    return sum;
}

// The slots of the ring carry the turn in which they were written, so a reader that was overtaken notices it.
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
            // When it is being written, try later; when it was overtaken, it is lost.
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
