#include "io/commands/clock_filter.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Clocks from the wire may have any epoch; an overflow wraps.
std::int64_t difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
std::int64_t sum(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t mean(std::int64_t a, std::int64_t b) { return a / 2 + b / 2 + (a % 2 + b % 2) / 2; }

}  // namespace

bool ClockFilter::take(const ClockExchange& x) {
    const ClockReading& r = x.reading;
    const std::int64_t there_ns = difference(r.arrival_monotonic_ns, x.sent_ns);
    const std::int64_t back_ns = difference(r.departure_monotonic_ns, x.received_ns);
    const std::int64_t delay_ns = difference(there_ns, back_ns);
    if (x.received_ns < x.sent_ns || r.departure_monotonic_ns < r.arrival_monotonic_ns || delay_ns < 0)
        return false;
    samples_[count_++ % kSamples] = {mean(there_ns, back_ns), delay_ns, x.received_ns};
    newest_ = r;
    return true;
}

std::optional<ClockFilter::Estimate> ClockFilter::estimate(std::int64_t sender_ns) const {
    std::optional<Estimate> best;
    for (std::size_t i = 0; i < std::min(count_, kSamples); ++i) {
        const Sample& s = samples_[i];
        const double age_ns = std::abs(static_cast<double>(difference(sender_ns, s.received_ns)));
        const double error_ns = 0.5 * static_cast<double>(s.delay_ns) + kDrift * age_ns;
        if (!best || error_ns < best->error_ns) best = {s.offset_ns, s.delay_ns, error_ns};
    }
    return best;
}

std::optional<TimeTai> ClockFilter::simulated_at(std::int64_t sender_ns) const {
    const std::optional<Estimate> best = estimate(sender_ns);
    if (!best) return std::nullopt;
    return hilcam::simulated_at(newest_, sum(sender_ns, best->offset_ns));
}

TimeTai simulated_at(const ClockReading& r, std::int64_t monotonic_ns) {
    const std::int64_t since_ns = difference(monotonic_ns, r.departure_monotonic_ns);
    const double scaled_ns = std::clamp(r.scale * static_cast<double>(since_ns), -4e18, 4e18);
    const std::int64_t ahead_ns = r.scale == 1 || !(scaled_ns >= -4e18) ? since_ns : std::llround(scaled_ns);
    return std::min(TimeTai{sum(r.departure.ns, ahead_ns)}, r.stands_at);
}

}  // namespace hilcam
