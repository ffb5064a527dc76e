#pragma once
// A clock's oscillator with a constant rate error and a random walk of its rate:
//     rate in second n = rate + wander (g_1 + ... + g_n),    g_i normal, of variance 1
// A quartz without an oven is some 10 ppm off and wanders by some 0.001 to 0.01 ppm in a second. The walk is
// a function of seed and second alone. It does not model temperature or age. Owner thread.

#include <cstdint>

namespace hilcam {

struct OscillatorConfig {
    double rate = 0;    // a ratio: 50e-6 gains 50 us in a second
    double wander = 0;  // standard deviation of the change from one second to the next, a ratio
    std::uint64_t seed = 1;
};

class Oscillator {
  public:
    static constexpr double kMaxRate = 1e-3;  // limit of the sum

    explicit Oscillator(const OscillatorConfig& config) : config_(config) {}
    // Returns the rate in a second of the clock's life; seconds must not fall from call to call.
    double rate_in(std::int64_t second);

  private:
    OscillatorConfig config_;
    std::int64_t second_ = 0;
    double walk_ = 0;
};

}  // namespace hilcam
