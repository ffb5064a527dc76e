#pragma once
// `hilcam bench --sensor`: what the sensor stage costs, as a whole and effect by effect.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct SensorStageTimes {
    double all_ms = 0, collapse_ms = 0, convolve_ms = 0, points_ms = 0, digitise_ms = 0, fft_pair_ms = 0;
};

// Times are medians over the runs.
struct SensorBench {
    std::string camera;
    int width_px = 0, height_px = 0, runs = 0;
    SensorStageTimes base;  // time with the effects that most cameras have
    double floor_ms = 0;    // one FFT pair of the padded image and one copy of the frame, on the same threads
    struct Effect {
        std::string name;
        double extra_ms = 0;  // on top of the base
    };
    std::vector<Effect> effects;

    double ratio_to_floor() const { return base.all_ms / floor_ms; }
};

// Times the scenario's camera on a synthetic image (a bright disk over a third of it, and stars), frame after
// frame: first with the effects that most cameras have, then with each other effect added alone.
SensorBench bench_sensor(const ScenarioConfig& scenario, int runs);

}  // namespace hilcam
