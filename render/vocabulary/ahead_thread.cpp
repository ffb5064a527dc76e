#include "render/vocabulary/ahead_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <time.h>
#include <unistd.h>

#include <mutex>
#include <utility>
#include <vector>

namespace hilcam {
namespace {

// The clocks of threads that run, and the processor time of those that have ended.
struct ProcessorTimes {
    std::mutex mutex;
    std::vector<clockid_t> running;
    std::int64_t ended_ns = 0;
};
ProcessorTimes& processor_times() {
    static ProcessorTimes times;
    return times;
}

std::int64_t time_of(clockid_t clock) {
    timespec t{};
    return clock_gettime(clock, &t) == 0 ? std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec : 0;
}

// Enters the calling thread's clock as long as this lives.
class CountedThread {
  public:
    CountedThread() {
        pthread_getcpuclockid(pthread_self(), &clock_);
        const std::lock_guard lock(processor_times().mutex);
        processor_times().running.push_back(clock_);
    }
    ~CountedThread() {
        const std::lock_guard lock(processor_times().mutex);
        processor_times().ended_ns += time_of(clock_);
        std::erase(processor_times().running, clock_);
    }
    CountedThread(const CountedThread&) = delete;
    CountedThread& operator=(const CountedThread&) = delete;

  private:
    clockid_t clock_{};
};

}  // namespace

std::int64_t AheadThread::processor_ns() {
    const std::lock_guard lock(processor_times().mutex);
    std::int64_t sum_ns = processor_times().ended_ns;
    for (const clockid_t clock : processor_times().running) sum_ns += time_of(clock);
    return sum_ns;
}

void AheadThread::start(std::function<void()> work, Rank rank) {
    work_ = std::move(work);
    thread_ = std::thread([this, rank] { run(rank); });
}

void AheadThread::stop() {
    if (!thread_.joinable()) return;
    wait();
    state_.store(State::kStop), state_.notify_one();
    thread_.join();
}

void AheadThread::run(Rank rank) {
    pthread_setname_np(pthread_self(), "ahead");
    const CountedThread counted;
    // Frames come first; this work may use one core of those that they leave.
    constexpr int kNicer = 10;  // added to the program's own niceness
    // On Linux the process id is that of its first thread. The thread that started this one may be nicer
    // (light_maker.h).
    if (rank == Rank::kNice)
        setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, static_cast<id_t>(getpid())) + kNicer);
    tbb::task_arena alone(1, 1);
    while (true) {
        state_.wait(State::kIdle);
        if (state_.load(std::memory_order_acquire) == State::kStop) return;
        alone.execute([this] { tbb::task_group(pieces_).run_and_wait(work_); });
        state_.store(State::kIdle, std::memory_order_release), state_.notify_one();
    }
}

}  // namespace hilcam
