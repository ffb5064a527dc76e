#pragma once
// A thread that makes, beside the frames, what the next ones will need. It does one thing at a time, on one core, and
// lets frames go first.

#include <atomic>
#include <functional>
#include <thread>

namespace hilcam {

class AheadThread {
  public:
    AheadThread() = default;
    ~AheadThread() { stop(); }
    AheadThread(const AheadThread&) = delete;
    AheadThread& operator=(const AheadThread&) = delete;

    // Starts it; each ask() has `work` done once. Owner thread.
    void start(std::function<void()> work);
    // Ends it, when it has done what it was asked for: from then on it counts as busy, and nothing is made ahead. For
    // who makes single pictures, or is about to fork. Owner thread.
    void stop();

    bool is_busy() const { return state_.load(std::memory_order_acquire) != State::kIdle; }
    // It was asked, and is not done.
    bool is_at_work() const { return state_.load(std::memory_order_acquire) == State::kAsked; }
    // Has the work done; is not busy. Loop.
    void ask() { state_.store(State::kAsked, std::memory_order_release), state_.notify_one(); }
    // Returns when what it was asked for is done. Loop.
    void wait() const {
        for (State state; (state = state_.load(std::memory_order_acquire)) == State::kAsked;)
            state_.wait(state);
    }

  private:
    enum class State : int { kIdle, kAsked, kStop };
    std::function<void()> work_;
    std::atomic<State> state_{State::kIdle};
    std::thread thread_;

    void run();
};

}  // namespace hilcam
