#pragma once
// Steers a device's clock to a master's by Sync messages: a PI servo whose gains begin high and fall.
//
// The offset of a Sync is o = device(t2) - t1 - delay, positive when the device is ahead. The first two Syncs
// give the frequency, and the clock steps by what is left of the offset (if above kFirstStep_ns). From then
// on the n-th Sync, T after the one before, changes
//     the correction of the rate by -beta_n o / T,
//     and the clock's reading by -alpha_n o, spread over the next T (the slew)
// where alpha_n = 2 (2n - 1) / (n (n + 1)), beta_n = 6 / (n (n + 1)) are the gains of a least-squares line
// through all Syncs (P. R. Kalata, IEEE Trans. AES-20, 1984, for the limit below). They fall until alpha is
// T / 10 s, beta = 2 (2 - alpha) - 4 sqrt(1 - alpha); the servo then forgets with a time constant of 10 s.
// With T = 1 s and 50 us of jitter on each stamp, a third of the jitter is left in the clock.
//
// An offset that is unlike those before (four times their mean magnitude) counts as that much only. When the
// median of the latest three to five is unlike them, too (eight times), the master's time has jumped: the
// clock steps by the median if that is above kStep_ns, else it slews, and the rate stays. The same holds for
// the first offsets from another master, alpha being 1, 1/2, 1/3, ... Without Syncs the rate stays what it
// was (holdover). Owner thread.

#include <array>
#include <cstdint>
#include <limits>

#include "io/ptp/device_clock.h"
#include "io/ptp/path_delay.h"

namespace hilcam {

class PtpServo {
  public:
    static constexpr std::int64_t kFirstStep_ns = 20'000, kStep_ns = 1'000'000;
    static constexpr double kMaxSlew = 500e-6;

    explicit PtpServo(DeviceClock& clock) : clock_(clock) {}

    struct Sync {
        std::int64_t master_ns = 0;     // t1 with its corrections added
        std::int64_t monotonic_ns = 0;  // t2
        double interval_s = 1;          // until the next Sync
    };
    // Takes a Sync. now: at or shortly after its arrival.
    void take(std::int64_t now_monotonic_ns, const Sync& sync, const PathDelay& delay);
    // Another master took over: the rate stays, and the gains rise a little.
    void change_master();
    // Begins anew, with no correction of the rate.
    void reset(std::int64_t now_monotonic_ns);
    // Ends a slew whose time is over; to be called at wake_ns() or soon after.
    void tick(std::int64_t now_monotonic_ns);
    std::int64_t wake_ns() const {
        return slewing_ ? slew_end_ns_ : std::numeric_limits<std::int64_t>::max();
    }

    // True when some Syncs in a row have found the clock near the master's, the last one not long ago.
    bool locked() const { return good_ >= kGoodWhenLocked; }
    std::int64_t offset_ns() const { return offset_ns_; }
    std::uint32_t steps() const { return steps_; }
    std::int64_t last_step_ns() const { return last_step_ns_; }
    double rate_correction() const { return integral_; }
    // Returns the gain of the master's clock over CLOCK_MONOTONIC, as far as it is known.
    double master_rate() const { return clock_.line().rate - slew_; }

  private:
    static constexpr int kGoodWhenLocked = 3;
    static constexpr int kSettled = 4;  // Syncs after a jump until the rate changes again
    static constexpr std::int64_t kLongestGap_ns = 10'000'000'000;
    static constexpr std::size_t kRecent = 5, kRecentNeeded = 3;

    void take_second(std::int64_t now_ns, const Sync& sync, const PathDelay& delay);
    void follow(std::int64_t now_ns, const Sync& sync);
    bool has_shifted(std::int64_t median_ns) const;
    void slew(std::int64_t now_ns, std::int64_t offset_ns, double interval_s);
    void step(std::int64_t now_ns, std::int64_t by_ns);
    void steer(std::int64_t now_ns, double slew);
    double clipped(double offset_ns);
    std::int64_t median_of_recent() const;

    DeviceClock& clock_;
    int count_ = 0;           // Syncs so far, as the gains count them
    int settled_ = kSettled;  // Syncs since the last jump
    Sync last_{};
    std::int64_t first_gap_ns_ = 0;  // offset and delay of the first Sync
    std::int64_t offset_ns_ = 0;
    double integral_ = 0, slew_ = 0;  // corrections of the rate: kept, and until slew_end_ns_
    bool slewing_ = false;
    std::int64_t slew_end_ns_ = 0;
    double mean_ns_ = 0;  // mean magnitude of the offsets
    std::array<std::int64_t, kRecent> recent_{};
    std::size_t recent_count_ = 0;
    int good_ = 0;
    std::uint32_t steps_ = 0;
    std::int64_t last_step_ns_ = 0;
};

}  // namespace hilcam
