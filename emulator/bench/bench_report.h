#pragma once
// Reports of `hilcam bench` and `hilcam bench --sensor`: JSON (its keys are part of the interface) and a
// table for people.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/bench/bench.h"
#include "emulator/bench/sensor_bench.h"

namespace hilcam {

nlohmann::json bench_json(const Bench& result);
std::string bench_text(const Bench& result);

// A scenario and its variants, in one table.
nlohmann::json bench_json(const std::vector<BenchVariant>& variants);
std::string bench_text(const std::vector<BenchVariant>& variants);

nlohmann::json bench_json(const SensorBench& result);
std::string bench_text(const SensorBench& result);

}  // namespace hilcam
