#include "emulator/send/send_fly.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "emulator/motion/flight.h"
#include "emulator/send/send_clock.h"
#include "io/commands/command_sender.h"
#include "io/system/monotonic.h"

namespace hilcam {
namespace {

// Interval between clock measurements. Until the next one, a change in how time runs is not noticed, nor the
// drift between two machines' clocks.
constexpr std::int64_t kAskAgain_ns = 500'000'000;

Vec3d vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

CircleFlight flight_of(const FlyOptions& o) {
    CircleFlight flight;
    flight.center_m = vec(o.around_m), flight.start_m = vec(o.from_m), flight.axis = vec(o.axis);
    flight.up = vec(o.up);
    flight.period_s = o.period_s;
    return flight;
}

}  // namespace

void add_fly_options(CLI::App& app, FlyOptions& o) {
    app.add_option("--object", o.object, "number of the thing that flies; 0: the camera")
        ->check(CLI::Range(0, 65535));
    app.add_option("--around-m", o.around_m, "x y z of the centre");
    app.add_option("--from-m", o.from_m, "x y z of the start");
    app.add_option("--axis", o.axis, "x y z of the circle's axis");
    app.add_option("--up", o.up, "x y z, up in the picture");
    app.add_option("--period-s", o.period_s, "time of one round");
    app.add_option("--rate-hz", o.rate_hz, "poses a second")->check(CLI::Range(0.1, 10000.0));
    app.add_option("--duration-s", o.duration_s, "duration of the flight")->check(CLI::Range(0.0, 1e7));
}

// Sends poses with time tags in the emulator's simulated time, which may run faster or slower than this
// machine's, or change its speed; the flight follows it.
int send_flight(const SendTarget& target, const FlyOptions& o) {
    CommandSender sender(target.endpoint, target.dialect);
    const CircleFlight flight = flight_of(o);
    ClockFilter clock;
    measure_clock(sender, {}, target.timeout_ms, clock);
    const std::int64_t start_ns = monotonic_ns();
    std::int64_t asked_ns = start_ns;
    // Without a clock reading, poses are valid on arrival.
    const TimeTai start = clock.simulated_at(start_ns).value_or(TimeTai{});
    std::vector<double> round_trips_ms;
    std::uint64_t accepted = 0, refused = 0;
    const auto count = static_cast<std::uint64_t>(o.duration_s * o.rate_hz);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::int64_t due_ns =
            start_ns + static_cast<std::int64_t>(static_cast<double>(i) / o.rate_hz * 1e9);
        sleep_until_monotonic_ns(due_ns);
        if (monotonic_ns() - asked_ns >= kAskAgain_ns) {
            exchange_clock(sender, {}, target.timeout_ms, clock);
            asked_ns = monotonic_ns();
        }
        const std::int64_t now_ns = monotonic_ns();
        PoseCommand pose;
        pose.object = static_cast<std::uint16_t>(o.object);
        const TimeTai time = clock.simulated_at(now_ns).value_or(TimeTai{});
        pose.motion = flight.at(static_cast<double>(time - start) * 1e-9, time);
        const Acknowledgement answer = sender.send(pose, target.timeout_ms);
        round_trips_ms.push_back(static_cast<double>(monotonic_ns() - now_ns) * 1e-6);
        ++(answer.status == CommandStatus::kAccepted ? accepted : refused);
    }
    std::sort(round_trips_ms.begin(), round_trips_ms.end());
    const auto quantile = [&](double q) {
        return round_trips_ms.empty() ? 0.0
                                      : round_trips_ms[static_cast<std::size_t>(
                                            q * static_cast<double>(round_trips_ms.size() - 1))];
    };
    fmt::print("{} poses sent, {} accepted, {} refused; round trip p50 {:.3f} ms, p99 {:.3f} ms\n", count,
               accepted, refused, quantile(0.5), quantile(0.99));
    return refused == 0 ? 0 : 1;
}

}  // namespace hilcam
