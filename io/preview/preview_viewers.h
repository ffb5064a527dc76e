#pragma once
// The viewers of the preview, by a number that each page chooses; forgotten after a while. Any thread.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <thread>

namespace hilcam {

class PreviewViewers {
  public:
    static constexpr std::chrono::milliseconds kInterval{66};  // 15 pictures/s
    static constexpr std::size_t kMax = 16;

    // Waits so that a viewer gets at most 15 answers a second. False when there are too many viewers or
    // requests.
    bool admit(std::uint64_t viewer) {
        Clock::time_point turn;
        {
            const std::lock_guard lock(mutex_);
            const auto now = Clock::now();
            std::erase_if(turns_, [&](const auto& v) { return now - v.second > kForgotten; });
            const auto known = turns_.find(viewer);
            if (known == turns_.end() && turns_.size() == kMax) return false;
            turn = known == turns_.end() ? now : std::max(now, known->second + kInterval);
            // Refuses a queue of simultaneous requests from one viewer.
            if (turn - now > 2 * kInterval) return false;
            turns_[viewer] = turn;
        }
        std::this_thread::sleep_until(turn);
        return true;
    }
    std::size_t count() const {
        const std::lock_guard lock(mutex_);
        const auto now = Clock::now();
        return static_cast<std::size_t>(std::count_if(
            turns_.begin(), turns_.end(), [&](const auto& v) { return now - v.second <= kForgotten; }));
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kForgotten{5};
    mutable std::mutex mutex_;
    std::map<std::uint64_t, Clock::time_point> turns_;
};

}  // namespace hilcam
