#pragma once
// A thread that makes, beside the frames, what the next ones will need. It does one thing at a time, on one core, and
// lets frames go first.
//
// Where frames leave no core free it hardly gets on, and a frame that waited for it would wait for seconds (priority
// inversion: Lampson & Redell, CACM 23(2), 1980). So a frame that needs what is not done makes the rest itself, on all of
// the loop's threads: it takes pieces as the thread does, or has the thread give up. wait() then lasts no longer than the
// one piece that the thread is at.

#include <tbb/task_group.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace hilcam {

class AheadThread {
  public:
    AheadThread() = default;
    // The rest of the work is given up: who lets go of the thread wants nothing of it any more.
    ~AheadThread() { give_up(), stop(); }
    AheadThread(const AheadThread&) = delete;
    AheadThread& operator=(const AheadThread&) = delete;

    // kNice: frames go first. kEqual: for what is little work, and of which a frame may have to wait for the whole.
    enum class Rank : std::uint8_t { kNice, kEqual };
    // Starts it; each ask() has `work` done once. Owner thread.
    void start(std::function<void()> work, Rank rank = Rank::kNice);
    // Ends it, when it has done what it was asked for: from then on it counts as busy, and nothing is made ahead. For
    // who makes single pictures, or is about to fork. Owner thread.
    void stop();

    bool is_busy() const { return state_.load(std::memory_order_acquire) != State::kIdle; }
    // It was asked, and is not done.
    bool is_at_work() const { return state_.load(std::memory_order_acquire) == State::kAsked; }
    // Has the work done; is not busy. Loop.
    void ask() {
        pieces_.reset();
        state_.store(State::kAsked, std::memory_order_release), state_.notify_one();
    }
    // Has it leave out those pieces of the work, made by oneTBB's loops, that are not begun; the work can tell by
    // was_given_up(). Loop.
    void give_up() {
        if (is_at_work()) pieces_.cancel_group_execution();
    }
    // Some pieces of the work that calls this were left out. False on other threads.
    static bool was_given_up() { return tbb::is_current_task_group_canceling(); }
    // Returns when what it was asked for is done or given up. Loop.
    void wait() const {
        for (State state; (state = state_.load(std::memory_order_acquire)) == State::kAsked;)
            state_.wait(state);
    }

  private:
    enum class State : int { kIdle, kAsked, kStop };
    std::function<void()> work_;
    std::atomic<State> state_{State::kIdle};
    tbb::task_group_context pieces_{tbb::task_group_context::isolated};
    std::thread thread_;

    void run(Rank rank);
};

}  // namespace hilcam
