#pragma once
// Poses as a dynamics simulator would send them, from a thread inside: for measurements without a sender.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

#include "emulator/motion/flight.h"
#include "emulator/run/emulator.h"

namespace hilcam {

// Once around the first object, from the camera's pose on, in two minutes. The scenario has an object.
CircleFlight circle_around_target(const ScenarioConfig& scenario);
// Returns that; none where the camera moves as the scenario says: by a motion of its own, or without an object.
std::optional<CircleFlight> flight_of_pilot(const ScenarioConfig& scenario);

// Sends the first camera's poses while it lives, 100 a second on average, each true when it is sent. They
// come 5 to 15 ms apart, so that they keep no rhythm with the frames: with one, latency would drift with
// their beat.
class Pilot {
  public:
    // flown_s: the place on the flight at an instant of CLOCK_MONOTONIC; called by the pilot's thread. Throws
    // InputError when there is no such flight.
    Pilot(Emulator& emulator, const CircleFlight& flight,
          std::function<double(std::int64_t monotonic_ns)> flown_s);
    ~Pilot();

  private:
    void fly();

    Emulator& emulator_;
    CircleFlight flight_;
    std::function<double(std::int64_t)> flown_s_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace hilcam
