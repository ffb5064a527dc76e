#pragma once
// The preview's worker threads. When too many jobs wait, add() blocks the thread that accepts connections,
// and the kernel's backlog then refuses further ones.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "io/preview/preview_slot.h"

namespace hilcam {

class BoundedPool {
  public:
    BoundedPool(std::size_t workers, std::size_t max_waiting) : max_waiting_(max_waiting) {
        for (std::size_t i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
    }
    ~BoundedPool() { stop(); }

    // Adds a job; blocks until there is room.
    void add(std::function<void()> job) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return jobs_.size() < max_waiting_; });
        jobs_.push_back(std::move(job));
        jobs_there_.notify_one();
    }
    // Finishes the jobs in the queue and ends the threads. Idempotent.
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        jobs_there_.notify_all();
        for (std::thread& thread : threads_)
            if (thread.joinable()) thread.join();
    }

  private:
    void work() {
        become_preview_thread();
        std::unique_lock lock(mutex_);
        while (true) {
            jobs_there_.wait(lock, [&] { return over_ || !jobs_.empty(); });
            if (jobs_.empty()) return;
            const std::function<void()> job = std::move(jobs_.front());
            jobs_.pop_front();
            room_.notify_one();
            lock.unlock();
            job();
            lock.lock();
        }
    }

    std::size_t max_waiting_;
    std::mutex mutex_;
    std::condition_variable jobs_there_, room_;
    std::deque<std::function<void()>> jobs_;
    bool over_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace hilcam
