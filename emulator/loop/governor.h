#pragma once
// Chooses a quality level so that frames meet their deadline: down when they do not, up again when there is
// room. Decisions alone: frame times and budgets go in, a level comes out; no clock, no thread, no allocation.
//
// Level 0 is the best. A frame is a miss when it takes longer than the budget.
//
//   first by what frames of each level took before the run (costs_ms), where that was measured: the best level
//         that leaves room. So it is again when the budget becomes another one: a client changes the frame
//         rate.
//   down  when more than kMaxMisses of the last kWindow frames at a level were misses: a single hiccup of
//         the machine changes nothing, three frames in a row that are too slow do. To the next level, past
//         those that were measured, or are by their costs, too slow as well.
//   up    by one level, when the level has been kept for the hold-off, its mean leaves room (below kRoom of
//         the budget) and none of the last kWindow frames was a miss. A level that should be too slow, by its
//         cost and by how much more than theirs frames take now, is tried only after kDoubtfulStay frames.
//
// That alone would swing where the budget lies between two levels: the lower has room, the upper misses. So
// the hold-off, at first kMinStay frames, doubles each time a climb has to be taken back, up to kMaxStay;
// a plant that does not change is tried at rising intervals, log2(kMaxStay / kMinStay) times, then once in
// kMaxStay frames (as TCP backs off: Jacobson, SIGCOMM 88). Only a load that has fallen below kFell of what
// it was at the last climb from here is tried sooner, after a sixteenth of the hold-off. A climb that lasts
// kMaxStay frames is good: the hold-off is as at first.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hilcam {

struct GovernorSettings {
    // The budget's owner tells it, frame by frame: use_budget().
    static constexpr double kToldBudget_ms = -1;

    double budget_ms = 0;    // 0: no governor
    std::size_t levels = 1;  // number of levels
    // Time that a frame of each level takes, as far as it was measured; 0 or none: it was not; infinity: too long to be.
    std::vector<double> costs_ms{};

    bool is_told() const { return budget_ms < 0; }
    bool on() const { return (budget_ms > 0 || is_told()) && levels > 1; }
};

class Governor {
  public:
    static constexpr int kWarmUp = 8;  // first frames, which do not count
    static constexpr int kWindow = 32;
    static constexpr int kMaxMisses = 2;
    static constexpr std::int64_t kMinStay = 64, kMaxStay = 65536, kDoubtfulStay = 1024;
    static constexpr double kRoom = 0.85, kFell = 0.75;
    // A budget that differs from the one of the last choice by less than this share is the same one.
    static constexpr double kSameBudget = 0.1;

    // Owner thread; the others: loop.
    explicit Governor(const GovernorSettings& settings);

    // Sets how long frames may take from now on [ms]; 0: there is no limit, and frames have the best level. Only for
    // settings with kToldBudget_ms.
    void use_budget(double budget_ms);
    // Returns the budget [ms]; 0: frames may take as long as they like.
    double budget_ms() const { return budget_ms_; }
    // A frame of some level took so long [ms]; frames of a level that has been left since do not count. Gives
    // the level of the next frame.
    std::size_t take(std::size_t level, double frame_ms);
    std::size_t level() const { return level_; }
    // Returns the mean over the frames since a level was last entered; 0: not used yet.
    double mean_ms(std::size_t level) const { return measured_[level].mean_ms; }

  private:
    struct Measured {
        double cost_ms = 0;  // before the run; 0: not measured
        double mean_ms = 0;
        double at_climb_ms = 0;  // its mean when it was last left upwards; 0: never
    };
    bool on_;
    std::vector<Measured> measured_;
    double budget_ms_ = 0;
    double chosen_for_ms_ = 0;  // budget of the last choice
    double load_ = 1;           // factor by which frames take more than their cost now
    std::size_t level_ = 0;
    int warm_up_ = kWarmUp;
    std::int64_t frames_ = 0;   // at this level
    std::uint32_t misses_ = 0;  // a bit for each of the last kWindow of them
    std::int64_t hold_off_ = kMinStay;
    bool climbed_ = false;  // to this level, not long ago

    void choose();
    void measure(double frame_ms);
    double expected_ms(std::size_t level) const { return load_ * measured_[level].cost_ms; }
    bool has_room() const;
    std::int64_t wait() const;
    void enter(std::size_t level, bool by_climbing);
    void fall();
};

}  // namespace hilcam
