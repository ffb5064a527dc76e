#pragma once
// Child processes that do numbered pieces of work beside each other, so that a piece that crashes or hangs
// costs that piece alone.
//
// Children are forked from a process that has loaded what they share: its pages are theirs without a copy, for
// as long as nobody writes to them. It must have no other thread then that holds a lock (oneTBB held to one
// thread has none). They die with their parent.

#include <sys/types.h>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/system/fd.h"

namespace hilcam {

class WorkerPool {
  public:
    // Does one piece; returns an empty text, or why it failed. It runs in the child.
    using Work = std::function<std::string(std::uint64_t number)>;
    // Is called in each child before its first piece; slot: which child, from 0.
    using Begin = std::function<Work(std::size_t slot)>;
    // Told of each piece, in the parent. lost: the child did not come back from it.
    using Done = std::function<void(std::uint64_t number, const std::string& problem, bool lost)>;

    WorkerPool(std::size_t workers, double time_limit_s, Begin begin);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    // Has all pieces done, in about this order. DeviceError when no child can be made, InputError with what
    // begin threw in a child. Owner thread.
    void run(const std::vector<std::uint64_t>& numbers, const Done& done);

  private:
    struct Worker {
        pid_t process = -1;
        Fd line;
        std::uint64_t number = 0;  // 0: idle
        double begun_s = 0;
        bool is_ready = false;  // it has begun; its time runs from then on
        bool is_late = false;
    };
    double time_limit_s_;
    Begin begin_;
    std::vector<Worker> workers_;

    void start(std::size_t slot);
    void give(Worker& worker, std::uint64_t number);
    void end(Worker& worker);
    [[noreturn]] void be_child(std::size_t slot, int line, pid_t parent);
    void hear(std::size_t slot, const Done& done);
    void end_late_ones();
};

}  // namespace hilcam
