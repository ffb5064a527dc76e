#pragma once
// Faults on demand: what a bench can order its camera to do wrong, and the board that holds the orders in
// force.
//
// A fault has a rate (the share of packets, messages or frames that it strikes), a value with a meaning of
// its kind, and a span of frames or of time. Whether it strikes is a pure function of (seed, kind, frame,
// index): the same orders strike the same packets of the same frames in every run. Every strike is counted,
// and the first in each frame is logged with the frame's id.

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
    double value = 0;              // meaning by kind
    std::uint64_t from_frame = 0;  // 0: at once; with `frames`, the next frame that begins
    std::uint64_t frames = 0;      // 0: no end by frames
    double duration_s = 0;         // counted from the order's arrival; 0: no end by time
};
// Returns why the board cannot take the order; empty: it can.
std::string_view refusal_of(const FaultOrder& order);

// The fault orders of one camera, one for each kind: a later order replaces the earlier one.
class FaultBoard {
  public:
    explicit FaultBoard(std::uint64_t seed = 1) : seed_(seed) {}

    // Says that this frame begins. Loop.
    void begin(std::uint64_t frame) noexcept { begun_.store(frame, std::memory_order_relaxed); }
    // Returns the id of the next frame, if none is skipped. Any thread.
    std::uint64_t next_frame() const { return begun_.load(std::memory_order_relaxed) + 1; }
    // Any thread but the loop: callers share a lock.
    void order(FaultOrder order);
    void clear_all();
    // Returns the kind's order that is in force or waits for its frame; nothing when there is none.
    std::optional<FaultOrder> order_of(FaultKind kind) const;

    // Decides whether the fault strikes this item of this frame; returns its value if so, and counts the
    // strike. A "once" kind strikes once per order. frame: FrameRecord::id; 0 for what belongs to no frame.
    // Any thread: no lock, no allocation.
    std::optional<double> strikes(FaultKind kind, std::uint64_t frame, std::uint64_t index = 0);
    // Returns the same and does not count.
    std::optional<double> would_strike(FaultKind kind, std::uint64_t frame, std::uint64_t index = 0) const;
    // True when an order is in force for this frame, whatever its rate.
    bool within_span(FaultKind kind, std::uint64_t frame) const;
    // Counts strikes that the caller has drawn itself.
    void count(FaultKind kind, std::uint64_t frame, std::uint64_t strikes, double value);
    // Returns when the present order arrived [CLOCK_MONOTONIC ns].
    std::int64_t since_monotonic_ns(FaultKind kind) const;

    std::uint64_t strikes_of(FaultKind kind) const;
    std::uint64_t all_strikes() const;

    // An entry of the log: the first strike of a kind in a frame. The log is a ring; entries that are not
    // taken in time are overwritten and counted.
    struct Entry {
        FaultKind kind = FaultKind::kPacketDrop;
        std::uint64_t frame = 0;
        std::uint64_t index = 0;
        double value = 0;
        std::int64_t monotonic_ns = 0;
    };
    // Takes the oldest entry; false when there is none. One reading thread.
    bool take_entry(Entry& entry);

  private:
    // A sequence lock: a reader tries again when a writer was active.
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
