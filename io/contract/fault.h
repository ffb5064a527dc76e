#pragma once
// Faults on demand: what a bench can ask its camera to do wrong, and the board that says what is wrong now.
//
// A fault has a rate (the share of packets, messages or frames it strikes), a value whose meaning is its
// kind's, and a span of frames or of time. Whether it strikes is a pure function of (seed, kind, frame,
// index): the same orders strike the same packets of the same frames on every run. Every strike is counted,
// and the first of each frame is logged with the frame's id.

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/contract/fault_kinds.h"

namespace hilcam {

struct FaultOrder {
    FaultKind kind = FaultKind::kPacketDrop;
    double rate = 1;               // 0..1; 0 ends the fault
    double value = 0;              // by kind
    std::uint64_t from_frame = 0;  // 0: at once; with `frames` the next one that begins
    std::uint64_t frames = 0;      // 0: no end by frames
    double duration_s = 0;         // from the order's arrival; 0: no end by time
};
// Why an order cannot be, or empty.
std::string_view refusal_of(const FaultOrder& order);

// One for each camera. One order per kind: a later one takes the earlier one's place.
class FaultBoard {
  public:
    explicit FaultBoard(std::uint64_t seed = 1) : seed_(seed) {}

    // This frame begins. Loop.
    void begin(std::uint64_t frame) noexcept { begun_.store(frame, std::memory_order_relaxed); }
    // That would begin next, if none were skipped. Any thread.
    std::uint64_t next_frame() const { return begun_.load(std::memory_order_relaxed) + 1; }
    // Any thread but the loop (a lock among those that order).
    void order(FaultOrder order);
    void clear_all();
    // The present order, if one is in force or waits for its frame.
    std::optional<FaultOrder> order_of(FaultKind kind) const;

    // Any thread: no lock, no allocation. Does the fault strike this item of this frame? Gives its value. A
    // strike is counted. `frame`: FrameRecord::id; 0 for what belongs to no frame. "once" kinds strike once
    // per order.
    std::optional<double> strikes(FaultKind kind, std::uint64_t frame, std::uint64_t index = 0);
    // The same without counting.
    std::optional<double> would_strike(FaultKind kind, std::uint64_t frame, std::uint64_t index = 0) const;
    // Is an order in force for this frame, whatever its rate.
    bool within_span(FaultKind kind, std::uint64_t frame) const;
    // Strikes that the caller has drawn by himself.
    void count(FaultKind kind, std::uint64_t frame, std::uint64_t strikes, double value);
    // Returns when the present order came [CLOCK_MONOTONIC ns].
    std::int64_t since_monotonic_ns(FaultKind kind) const;

    std::uint64_t strikes_of(FaultKind kind) const;
    std::uint64_t all_strikes() const;

    // The log: first strikes by frame, oldest first; what is not taken in time is overwritten and counted.
    struct Entry {
        FaultKind kind = FaultKind::kPacketDrop;
        std::uint64_t frame = 0;
        std::uint64_t index = 0;
        double value = 0;
        std::int64_t monotonic_ns = 0;
    };
    // One reading thread.
    bool take_entry(Entry& entry);

  private:
    // A sequence lock: readers try again while a writer is at it.
    struct Cell {
        std::atomic<std::uint32_t> version{0};
        std::atomic<double> rate{0}, value{0};
        std::atomic<std::uint64_t> from_frame{0}, frames{0}, order{0};
        std::atomic<std::int64_t> since_ns{0}, until_ns{0};
        std::atomic<double> duration_s{0};
        std::atomic<std::uint64_t> struck{0}, last_frame{~std::uint64_t{0}}, struck_order{0};
    };
    struct State;
    static std::size_t place_of(FaultKind kind);
    State read(const Cell& cell) const;
    void log(const Entry& entry);

    std::uint64_t seed_;
    std::array<Cell, kAllFaults.size()> cells_;
    std::atomic<std::uint64_t> orders_{0};
    static constexpr std::size_t kLogLength = 1024;
    struct LogSlot {
        std::atomic<std::uint64_t> turn{0};
        std::atomic<FaultKind> kind{FaultKind::kPacketDrop};
        std::atomic<std::uint64_t> frame{0}, index{0};
        std::atomic<double> value{0};
        std::atomic<std::int64_t> monotonic_ns{0};
    };
    std::array<LogSlot, kLogLength> log_;
    std::atomic<std::uint64_t> log_head_{0};
    std::uint64_t log_tail_ = 0;
    mutable std::atomic_flag writing_ = ATOMIC_FLAG_INIT;
    std::atomic<std::uint64_t> begun_{0};
};

}  // namespace hilcam
