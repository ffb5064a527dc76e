#pragma once
// Reports of `hilcam bench` and `hilcam bench --sensor`: JSON (its keys are part of the interface) and a
// table for people.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/bench/bench.h"
#include "emulator/bench/sensor_bench.h"

namespace hilcam {

nlohmann::json bench_json(const Bench& result);
std::string bench_text(const Bench& result);

nlohmann::json bench_json(const SensorBench& result);
std::string bench_text(const SensorBench& result);

}  // namespace hilcam
