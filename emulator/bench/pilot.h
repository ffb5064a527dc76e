#pragma once
// Sends poses from a thread of the program, as a dynamics simulator would, so that a measurement needs no
// sender.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

#include "emulator/motion/flight.h"
#include "emulator/run/emulator.h"

namespace hilcam {

// Returns a flight once around the first object in two minutes, beginning at the camera's pose. The scenario
// must have an object.
CircleFlight circle_around_target(const ScenarioConfig& scenario);
// Returns the same flight, or none where the scenario has no object or gives the camera a motion of its own.
std::optional<CircleFlight> flight_of_pilot(const ScenarioConfig& scenario);

// Sends poses of the first camera for as long as it exists. Each pose is true at the instant when it is sent.
// The mean rate is 100 Hz; gaps vary from 5 to 15 ms, because latency would drift if poses kept a fixed
// rhythm with the frames.
class Pilot {
  public:
    // flown_s: returns the time flown [s] at an instant of CLOCK_MONOTONIC; the pilot's thread calls it.
    // Throws InputError when the flight is impossible.
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
