#include "emulator/send/send_clock.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <string>

#include "io/system/monotonic.h"

namespace hilcam {
namespace {

std::string way_of(const ClockReading& r) {
    const double left_s = static_cast<double>(r.stands_at - r.departure) * kSecondsPerNs;
    if (left_s <= 0) return fmt::format("stands (scale {} when it goes on)", r.scale);
    if (r.stands_at.ns == std::numeric_limits<std::int64_t>::max()) return fmt::format("scale {}", r.scale);
    return fmt::format("scale {}, stands in {:.9f} s", r.scale, left_s);
}

}  // namespace

Acknowledgement exchange_clock(CommandSender& sender, ClockCommand order, int timeout_ms,
                               ClockFilter& filter) {
    order.sender_ns = monotonic_ns();
    const Acknowledgement answer = sender.send(order, timeout_ms);
    if (answer.clock) filter.take({order.sender_ns, monotonic_ns(), *answer.clock});
    return answer;
}

Acknowledgement measure_clock(CommandSender& sender, const ClockCommand& order, int timeout_ms,
                              ClockFilter& filter) {
    const Acknowledgement first = exchange_clock(sender, order, timeout_ms, filter);
    for (std::size_t i = 1; i < ClockFilter::kSamples; ++i) exchange_clock(sender, {}, timeout_ms, filter);
    return first;
}

int send_clock(const SendTarget& target, const ClockCommand& order) {
    CommandSender sender(target.endpoint, target.dialect);
    ClockFilter filter;
    const Acknowledgement first = measure_clock(sender, order, target.timeout_ms, filter);
    const bool accepted = first.status == CommandStatus::kAccepted;
    const std::int64_t now_ns = monotonic_ns();
    const auto estimate = filter.estimate(now_ns);
    if (!accepted || !first.clock || !estimate) {
        fmt::print("{} simulated time {}\n", text_of(first), format_utc(first.simulated_time));
        return accepted ? 0 : 1;
    }
    fmt::print("accepted simulated time {}, {}\n",
               format_utc(filter.simulated_at(now_ns).value_or(TimeTai{})), way_of(*first.clock));
    fmt::print("its machine's clock is {:.3f} us {} this one's, within {:.3f} us; round trip {:.3f} us\n",
               std::abs(static_cast<double>(estimate->offset_ns)) * 1e-3,
               estimate->offset_ns < 0 ? "behind" : "ahead of", estimate->error_ns * 1e-3,
               static_cast<double>(estimate->delay_ns) * 1e-3);
    return 0;
}

}  // namespace hilcam
