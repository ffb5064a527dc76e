#include "io/ptp/ptp_servo.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace hilcam {
namespace {

constexpr double kForget_s = 10;  // time constant of the servo at last
constexpr double kLeastOutlier_ns = 10'000;
constexpr int kOutliersFrom = 8;       // Syncs before outliers can be recognised
constexpr int kCountAfterChange = 20;  // gains of the rate after a change of master
constexpr double kLeastSpan_s = 0.1;   // between the two Syncs that give the frequency

struct Gains {
    double alpha, beta;
};

Gains gains_of(int n, double interval_s) {
    const double k = n;
    const double last = std::clamp(interval_s / kForget_s, 1e-3, 0.5);
    const double alpha = 2 * (2 * k - 1) / (k * (k + 1));
    if (alpha > last) return {alpha, 6 / (k * (k + 1))};
    return {last, 2 * (2 - last) - 4 * std::sqrt(1 - last)};
}

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

void PtpServo::take(std::int64_t now_ns, const Sync& sync, const PathDelay& delay) {
    tick(now_ns);
    const std::int64_t delay_ns = delay.median_ns(master_rate());
    const std::int64_t gap_ns = clock_.device_ns(sync.monotonic_ns) - sync.master_ns;
    offset_ns_ = gap_ns - delay_ns;
    if (count_ == 0) {
        first_gap_ns_ = gap_ns;
        last_ = sync;
        count_ = 1;
    } else if (count_ == 1) {
        take_second(now_ns, sync, delay);
    } else {
        follow(now_ns, sync);
    }
}

void PtpServo::take_second(std::int64_t now_ns, const Sync& sync, const PathDelay& delay) {
    const double span_s = seconds(sync.monotonic_ns - last_.monotonic_ns);
    if (span_s < kLeastSpan_s) return;
    const std::int64_t guess_ns = delay.median_ns(master_rate()), gap_ns = offset_ns_ + guess_ns;
    const double rate = seconds(gap_ns - first_gap_ns_) / span_s;
    if (std::abs(rate) > DeviceClock::kMaxAdjustment || span_s > seconds(kLongestGap_ns)) {
        // The master has stepped between the two.
        first_gap_ns_ = gap_ns;
        last_ = sync;
        return;
    }
    integral_ = std::clamp(integral_ - rate, -DeviceClock::kMaxAdjustment, DeviceClock::kMaxAdjustment);
    steer(now_ns, 0);
    // The delay is known better now that the rate is. Until now the clock has gone on with the old rate.
    offset_ns_ = gap_ns - delay.median_ns(master_rate());
    const double late_ns = static_cast<double>(now_ns - sync.monotonic_ns);
    const std::int64_t offset_now_ns = offset_ns_ + std::llround(late_ns * rate);
    if (std::abs(offset_now_ns) > kFirstStep_ns) step(now_ns, -offset_now_ns);
    last_ = sync;
    count_ = 2;
}

void PtpServo::follow(std::int64_t now_ns, const Sync& sync) {
    const std::int64_t since_ns = sync.monotonic_ns - last_.monotonic_ns;
    if (since_ns <= 0) return;
    last_ = sync;
    if (since_ns > kLongestGap_ns) change_master();
    recent_[recent_count_++ % kRecent] = offset_ns_;
    const std::int64_t median_ns = median_of_recent();
    good_ = std::abs(median_ns) < kStep_ns ? std::min(good_ + 1, kGoodWhenLocked) : 0;
    const double interval_s = std::clamp(sync.interval_s, 1.0 / 128, 16.0);
    if (has_shifted(median_ns)) {
        recent_count_ = 0;
        settled_ = 1;
        if (std::abs(median_ns) > kStep_ns)
            step(now_ns, -median_ns);
        else
            slew(now_ns, median_ns, interval_s);
        return;
    }
    // A while without Syncs would make small changes of the rate of large offsets.
    const double since_s = std::max(seconds(std::min(since_ns, kLongestGap_ns)), 0.5 * interval_s);
    count_ = std::min(count_ + 1, 1'000'000);
    settled_ = std::min(settled_ + 1, 1'000'000);
    Gains g = gains_of(count_, interval_s);
    if (settled_ < kSettled) g = {std::max(g.alpha, 1.0 / settled_), 0};
    const double offset_ns = clipped(static_cast<double>(offset_ns_));
    integral_ = std::clamp(integral_ - g.beta * 1e-9 * offset_ns / since_s, -DeviceClock::kMaxAdjustment,
                           DeviceClock::kMaxAdjustment);
    slew(now_ns, std::llround(g.alpha * offset_ns), interval_s);
}

// True when the master's time has jumped: the latest offsets have a median that single outliers cannot have.
bool PtpServo::has_shifted(std::int64_t median_ns) const {
    if (recent_count_ < kRecentNeeded) return false;
    const double usual_ns =
        count_ > kOutliersFrom ? std::max(8 * mean_ns_, 2 * kLeastOutlier_ns) : static_cast<double>(kStep_ns);
    return static_cast<double>(std::abs(median_ns)) > std::min(usual_ns, static_cast<double>(kStep_ns));
}

// Takes an offset out of the clock until the next Sync.
void PtpServo::slew(std::int64_t now_ns, std::int64_t offset_ns, double interval_s) {
    slewing_ = true;
    slew_end_ns_ = now_ns + std::llround(interval_s * 1e9);
    steer(now_ns, std::clamp(-seconds(offset_ns) / interval_s, -kMaxSlew, kMaxSlew));
}

// Returns the offset, and no more of it than outliers may have.
double PtpServo::clipped(double offset_ns) {
    const double most_ns = std::max(4 * mean_ns_, kLeastOutlier_ns);
    const bool clips = count_ > kOutliersFrom;
    const double used_ns = clips ? std::clamp(offset_ns, -most_ns, most_ns) : offset_ns;
    // Below kOutliersFrom this is the plain mean.
    mean_ns_ += (std::abs(used_ns) - mean_ns_) / std::min(count_, 16);
    return used_ns;
}

std::int64_t PtpServo::median_of_recent() const {
    std::array<std::int64_t, kRecent> sorted = recent_;
    const std::size_t kept = std::min(recent_count_, kRecent);
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(kept);
    std::sort(sorted.begin(), end);
    return kept == 0 ? 0 : sorted[kept / 2];
}

void PtpServo::step(std::int64_t now_ns, std::int64_t by_ns) {
    slewing_ = false;
    steer(now_ns, 0);
    clock_.step(now_ns, by_ns);
    ++steps_;
    last_step_ns_ = by_ns;
    offset_ns_ += by_ns;
    good_ = 0;
}

void PtpServo::steer(std::int64_t now_ns, double slew) {
    slew_ = slew;
    clock_.steer(now_ns, integral_ + slew);
}

void PtpServo::tick(std::int64_t now_ns) {
    if (slewing_ && now_ns >= slew_end_ns_) {
        slewing_ = false;
        steer(now_ns, 0);
    }
    if (count_ > 0 && now_ns - last_.monotonic_ns > kLongestGap_ns) good_ = 0;
}

void PtpServo::change_master() {
    if (count_ <= 1) count_ = 0;
    count_ = std::min(count_, kCountAfterChange);
    settled_ = count_ == 0 ? kSettled : 0;
    recent_count_ = 0;
    good_ = 0;
}

void PtpServo::reset(std::int64_t now_ns) {
    count_ = 0;
    settled_ = kSettled;
    integral_ = mean_ns_ = 0;
    recent_count_ = 0;
    good_ = 0;
    offset_ns_ = 0;
    slewing_ = false;
    steer(now_ns, 0);
}

}  // namespace hilcam
