#include "render/vocabulary/ahead_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <time.h>
#include <unistd.h>

#include <mutex>
#include <utility>

namespace hilcam {
namespace {

std::int64_t time_of(clockid_t clock) {
    timespec t{};
    return clock_gettime(clock, &t) == 0 ? std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec : 0;
}

// Counts the calling thread's processor time as long as this lives, and keeps it afterwards. Threads may start
// while frames are made, so their list allocates nothing.
class CountedThread {
  public:
    CountedThread() {
        pthread_getcpuclockid(pthread_self(), &clock_);
        const std::lock_guard lock(mutex);
        next_ = first, first = this;
    }
    ~CountedThread() {
        const std::lock_guard lock(mutex);
        ended_ns += time_of(clock_);
        CountedThread** link = &first;
        while (*link != this) link = &(*link)->next_;
        *link = next_;
    }
    CountedThread(const CountedThread&) = delete;
    CountedThread& operator=(const CountedThread&) = delete;

    static std::int64_t all_ns() {
        const std::lock_guard lock(mutex);
        std::int64_t sum_ns = ended_ns;
        for (const CountedThread* thread = first; thread; thread = thread->next_)
            sum_ns += time_of(thread->clock_);
        return sum_ns;
    }

  private:
    static inline std::mutex mutex;
    static inline CountedThread* first = nullptr;
    static inline std::int64_t ended_ns = 0;
    clockid_t clock_{};
    CountedThread* next_ = nullptr;
};

}  // namespace

std::int64_t AheadThread::processor_ns() { return CountedThread::all_ns(); }

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
