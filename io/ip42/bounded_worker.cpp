#include "io/ip42/bounded_worker.h"

#include <chrono>

namespace hilcam {

BoundedWorker::~BoundedWorker() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

// std::chrono::steady_clock is CLOCK_MONOTONIC.
bool BoundedWorker::wait_idle(std::unique_lock<std::mutex>& lock, std::int64_t until_monotonic_ns) {
    const std::chrono::steady_clock::time_point until{std::chrono::nanoseconds(until_monotonic_ns)};
    return changed_.wait_until(lock, until, [this] { return !work_; });
}

BoundedWorker::Outcome BoundedWorker::run_until(std::function<void()> work, std::int64_t until_monotonic_ns) {
    std::unique_lock lock(mutex_);
    if (!wait_idle(lock, until_monotonic_ns)) return Outcome::kBusy;
    work_ = std::move(work);
    changed_.notify_all();
    return wait_idle(lock, until_monotonic_ns) ? Outcome::kDone : Outcome::kLate;
}

void BoundedWorker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ending_ || work_; });
        if (!work_) return;
        lock.unlock();
        work_();
        lock.lock();
        work_ = nullptr;
        changed_.notify_all();
    }
}

}  // namespace hilcam
