#pragma once
// Measures how long work takes, by the machine's clock that never goes back. Loop.

#include <chrono>

namespace hilcam {

class Stopwatch {
  public:
    // Since it was made.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }
    double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - begun_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begun_ = Clock::now();
};

}  // namespace hilcam
