#pragma once
// Chooses quality levels so that frames meet their deadline: a lower quality when they miss it, a better one
// when there is room. Pure decisions: frame times and budgets go in, a level comes out, without clock, thread
// or allocation.
//
// Level 0 is the best. A frame is a miss when it takes longer than the budget.
//
//   start  If costs_ms holds times measured before the run, the best level that leaves room is chosen. The
//          same happens whenever the budget changes, as when a client changes the frame rate.
//   down   More than kMaxMisses misses among the last kWindow frames at a level lead to the next level, past
//          levels that are too slow as well by their measured times or costs. A single hiccup of the machine
//          changes nothing; three slow frames in a row do.
//   up     One level up when the hold-off has passed, the level's mean leaves room (below kRoom of the
//          budget) and none of the last kWindow frames was a miss. A level that is expected to be too slow,
//          by its cost and the present ratio of times to costs, is tried only after kDoubtfulStay frames.
//
// Where the budget is between two levels, these rules alone would oscillate: the lower level has room, the
// upper one misses. So the hold-off begins at kMinStay frames and doubles each time a climb has to be taken
// back, up to kMaxStay. With a constant load the upper level is tried log2(kMaxStay / kMinStay) times at
// growing intervals, then once in kMaxStay frames (like TCP's back-off: Jacobson, SIGCOMM 88). If the load
// has fallen below kFell of its value at the last climb from this level, the upper level is tried after a
// sixteenth of the hold-off. A climb that lasts kMaxStay frames resets the hold-off.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hilcam {

struct GovernorSettings {
    // Stands for a budget that use_budget() sets frame by frame.
    static constexpr double kToldBudget_ms = -1;

    double budget_ms = 0;    // 0: no governor
    std::size_t levels = 1;  // number of levels
    // Measured frame time of each level. 0 or missing: not measured; infinity: too long to measure.
    std::vector<double> costs_ms{};

    bool is_told() const { return budget_ms < 0; }
    bool on() const { return (budget_ms > 0 || is_told()) && levels > 1; }
};

class Governor {
  public:
    static constexpr int kWarmUp = 8;  // first frames, which are ignored
    static constexpr int kWindow = 32;
    static constexpr int kMaxMisses = 2;
    static constexpr std::int64_t kMinStay = 64, kMaxStay = 65536, kDoubtfulStay = 1024;
    static constexpr double kRoom = 0.85, kFell = 0.75;
    // A budget that differs from that of the last choice by less than this share counts as unchanged.
    static constexpr double kSameBudget = 0.1;

    // Owner thread; all other functions: loop.
    explicit Governor(const GovernorSettings& settings);

    // Sets the time limit of the next frames [ms]; 0: no limit, and frames have the best level. Only for
    // settings with kToldBudget_ms.
    void use_budget(double budget_ms);
    // Returns the budget [ms]; 0: no limit.
    double budget_ms() const { return budget_ms_; }
    // Takes the time of a frame at a level [ms] and returns the level of the next frame. Frames of a level
    // that has been left since are ignored.
    std::size_t take(std::size_t level, double frame_ms);
    std::size_t level() const { return level_; }
    // Returns the mean over the frames since the level was last entered; 0: not used yet.
    double mean_ms(std::size_t level) const { return measured_[level].mean_ms; }

  private:
    struct Measured {
        double cost_ms = 0;  // measured before the run; 0: not measured
        double mean_ms = 0;
        double at_climb_ms = 0;  // mean_ms when the level was last left for a better one; 0: never
    };
    bool on_;
    std::vector<Measured> measured_;
    double budget_ms_ = 0;
    double chosen_for_ms_ = 0;  // budget at the last choice
    double load_ = 1;           // ratio of frame times to costs at present
    std::size_t level_ = 0;
    int warm_up_ = kWarmUp;
    std::int64_t frames_ = 0;   // frames at this level
    std::uint32_t misses_ = 0;  // one bit for each of the last kWindow frames
    std::int64_t hold_off_ = kMinStay;
    bool climbed_ = false;  // true: reached by a climb, not long ago

    void choose();
    void measure(double frame_ms);
    double expected_ms(std::size_t level) const { return load_ * measured_[level].cost_ms; }
    bool has_room() const;
    std::int64_t wait() const;
    void enter(std::size_t level, bool by_climbing);
    void fall();
};

}  // namespace hilcam
