#pragma once
// `hilcam bench --sensor`: what the sensor stage costs, and each of its effects.

#include <nlohmann/json_fwd.hpp>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// The scenario's camera on a made-up picture (a bright disk over a third of it, and stars), frame after
// frame: with the effects that most cameras have, then with each other one on top. Times are medians;
// `floor_ms` is one FFTW pair of the padded picture's size on the same threads plus one copy of the frame.
nlohmann::json bench_sensor(const ScenarioConfig& scenario, int runs);

}  // namespace hilcam
