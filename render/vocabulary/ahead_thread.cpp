#include "render/vocabulary/ahead_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <utility>

namespace hilcam {

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
