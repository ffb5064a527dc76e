#include "emulator/bench/pilot.h"

#include <cmath>

#include "emulator/scenario/initial_world.h"
#include "render/vocabulary/check.h"

namespace hilcam {

CircleFlight circle_around_target(const ScenarioConfig& scenario) {
    const std::vector<Motion> motions = initial_motions(scenario, parse_utc(scenario.time_utc));
    HILCAM_CHECK(motions.size() >= 2);
    CircleFlight flight;
    flight.center_m = motions[1].pose.position_world_m;
    flight.start_m = motions[0].pose.position_world_m;
    flight.axis = flight.up = scenario.camera_pose.up;
    flight.period_s = 120;
    return flight;
}

std::optional<CircleFlight> flight_of_pilot(const ScenarioConfig& scenario) {
    if (scenario.objects.empty() || scenario.camera_motion) return {};
    return circle_around_target(scenario);
}

Pilot::Pilot(Emulator& emulator, const CircleFlight& flight, std::function<double(std::int64_t)> flown_s)
    : emulator_(emulator), flight_(flight), flown_s_(std::move(flown_s)) {
    flight_.at(0, TimeTai{});
    thread_ = std::thread([this] { fly(); });
}

Pilot::~Pilot() {
    stop_.store(true);
    thread_.join();
}

void Pilot::fly() {
    constexpr double kMean_ns = 10e6;
    // Multiples of the golden ratio's fraction fill the unit interval evenly (Weyl; Knuth, TAOCP 3, 6.4).
    constexpr double kGolden = 0.6180339887498949;
    for (std::uint32_t i = 1; !stop_.load(std::memory_order_relaxed); ++i) {
        const std::int64_t now_ns = monotonic_ns();
        emulator_.world().set(0, flight_.at(flown_s_(now_ns), emulator_.clock().at(now_ns)), {i, now_ns});
        const double share = std::fmod(i * kGolden, 1.0);
        sleep_until_monotonic_ns(now_ns + static_cast<std::int64_t>(kMean_ns * (0.5 + share)));
    }
}

}  // namespace hilcam
