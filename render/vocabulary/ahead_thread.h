#pragma once
// A thread that works ahead: while frames are made, it computes what the next ones will need. It runs one
// piece of work at a time, on one core, and frames go first.
//
// On a machine whose cores are all busy with frames, this thread gets little time, and a frame that simply
// waited for it would wait for seconds (priority inversion: Lampson & Redell, CACM 23(2), 1980). So a frame
// that needs unfinished work completes it on the loop's threads, or tells the thread to give up. wait() then
// lasts for one piece of work at most.

#include <tbb/task_group.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace hilcam {

class AheadThread {
  public:
    AheadThread() = default;
    // Gives up the work that is left: nobody needs it once the thread's owner is gone.
    ~AheadThread() { give_up(), stop(); }
    AheadThread(const AheadThread&) = delete;
    AheadThread& operator=(const AheadThread&) = delete;

    // kNice: frames go first. kEqual: for short work which a frame may have to wait for.
    enum class Rank : std::uint8_t { kNice, kEqual };
    // Starts the thread. Each ask() runs `work` once. Owner thread.
    void start(std::function<void()> work, Rank rank = Rank::kNice);
    // Ends the thread after the work that was asked for. The thread then counts as busy, and nothing is
    // computed ahead. For programs that make single pictures or are about to fork. Owner thread.
    void stop();

    bool is_busy() const { return state_.load(std::memory_order_acquire) != State::kIdle; }
    // True when work was asked for and is not done.
    bool is_at_work() const { return state_.load(std::memory_order_acquire) == State::kAsked; }
    // Asks for the work. The thread must not be busy. Loop.
    void ask() {
        pieces_.reset();
        state_.store(State::kAsked, std::memory_order_release), state_.notify_one();
    }
    // Makes the thread skip all pieces of the work (iterations of oneTBB's loops) that have not begun. The
    // work finds out by was_given_up(). Loop.
    void give_up() {
        if (is_at_work()) pieces_.cancel_group_execution();
    }
    // True when pieces of the work that calls this were skipped. Always false on other threads.
    static bool was_given_up() { return tbb::is_current_task_group_canceling(); }
    // Returns the processor time of all such threads of the program, also of those that have ended [ns]. It
    // belongs to simulated time, not to frames: a frame that comes later needs more of it. Takes a lock, so
    // frames that are timed do not call it. Any thread.
    static std::int64_t processor_ns();
    // Returns when the work is done or given up. Loop.
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
