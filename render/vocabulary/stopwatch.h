#pragma once
// Measures how long work takes. Loop.

#include <chrono>
#include <ctime>

namespace hilcam {

// Measures by the machine's monotonic clock.
class Stopwatch {
  public:
    // Time since the stopwatch was made.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }
    double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - begun_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begun_ = Clock::now();
};

// Measures the processor time of the thread that made it, which other load on the machine hardly changes.
class ThreadStopwatch {
  public:
    double ms() const { return now_ms() - begun_ms_; }

  private:
    static double now_ms() {
        std::timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
    }
    double begun_ms_ = now_ms();
};

}  // namespace hilcam
