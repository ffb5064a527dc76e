#pragma once
// Carries out one piece of work at a time on a thread of its own, so that its giver can wait for a bounded
// time. Owner thread, unless a function says otherwise.

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace hilcam {

class BoundedWorker {
  public:
    BoundedWorker() : thread_([this] { run(); }) {}
    // Waits for the work that has begun.
    ~BoundedWorker();
    BoundedWorker(const BoundedWorker&) = delete;
    BoundedWorker& operator=(const BoundedWorker&) = delete;

    enum class Outcome {
        kDone,
        kLate,  // still at it at that time; it will be done
        kBusy,  // earlier work was not done by then, so this one was not begun
    };
    // Gives work and waits for its end, until a time of CLOCK_MONOTONIC at most. The work must not throw.
    Outcome run_until(std::function<void()> work, std::int64_t until_monotonic_ns);

  private:
    void run();
    bool wait_idle(std::unique_lock<std::mutex>& lock, std::int64_t until_monotonic_ns);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::function<void()> work_;  // empty: none
    bool ending_ = false;
    std::thread thread_;  // last, as it uses the others
};

}  // namespace hilcam
