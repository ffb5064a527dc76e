#include "io/ptp/foreign_masters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace hilcam {
namespace {

constexpr std::uint16_t kMostSteps = 254;

// The interval that a message says: 1/16 s to 16 s.
std::int64_t interval_ns_of(std::int8_t log_interval) {
    return std::llround(std::exp2(std::clamp<int>(log_interval, -4, 4)) * 1e9);
}

}  // namespace

bool is_better(const ForeignMaster& a, const ForeignMaster& b) {
    const auto rank = [](const ForeignMaster& m) {
        const ptp::Announce& n = m.announce;
        return std::tuple(n.priority1, n.clock_class, n.accuracy, n.variance, n.priority2, n.grandmaster);
    };
    if (a.announce.grandmaster != b.announce.grandmaster) return rank(a) < rank(b);
    return std::tuple(a.announce.steps_removed, a.sender) < std::tuple(b.announce.steps_removed, b.sender);
}

void ForeignMasters::take(const ptp::Message& m, std::int64_t now_ns) {
    if (m.announce.steps_removed > kMostSteps || m.has(ptp::flag::kAlternateMaster) ||
        m.announce.grandmaster == own_clock_ || m.source.clock == own_clock_)
        return;
    const auto is_sender = [&](const std::optional<ForeignMaster>& f) { return f && f->sender == m.source; };
    auto place = std::find_if(masters_.begin(), masters_.end(), is_sender);
    const std::int64_t interval_ns = interval_ns_of(m.log_interval);
    bool qualified = false;
    if (place != masters_.end()) {
        qualified = (*place)->qualified || now_ns - (*place)->received_ns <= 4 * interval_ns;
    } else {
        // An empty place comes first, then the one that does not count and was silent longest.
        const auto rank = [](const std::optional<ForeignMaster>& f) {
            return f ? std::tuple(1, f->qualified, f->received_ns) : std::tuple(0, false, std::int64_t{0});
        };
        place = std::min_element(masters_.begin(), masters_.end(),
                                 [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
        if (*place && (*place)->qualified) return;
    }
    *place = ForeignMaster{m.source, m.flags, m.announce, now_ns, interval_ns, qualified};
}

void ForeignMasters::expire(std::int64_t now_ns) {
    for (auto& m : masters_) {
        if (!m) continue;
        // One that does not count yet has four intervals for its second Announce.
        if (now_ns >= end_of(*m) + (m->qualified ? 0 : m->interval_ns)) m.reset();
    }
}

const ForeignMaster* ForeignMasters::best() const {
    const ForeignMaster* best = nullptr;
    for (const auto& m : masters_)
        if (m && m->qualified && (!best || is_better(*m, *best))) best = &*m;
    return best;
}

std::int64_t ForeignMasters::wake_ns() const {
    std::int64_t wake_ns = std::numeric_limits<std::int64_t>::max();
    for (const auto& m : masters_)
        if (m) wake_ns = std::min(wake_ns, end_of(*m) + (m->qualified ? 0 : m->interval_ns));
    return wake_ns;
}

}  // namespace hilcam
