#pragma once
// Child processes that work on numbered pieces in parallel. A piece that crashes or hangs costs only that
// piece.
//
// Children are forked from a process that has loaded the data they share, and use its pages without a copy
// until one of them writes. At that time no other thread of the process may hold a lock (oneTBB limited to
// one thread has none). Children die with their parent.

#include <sys/types.h>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/system/fd.h"

namespace hilcam {

class WorkerPool {
  public:
    // Does one piece in the child. Returns an empty text, or why the piece failed.
    using Work = std::function<std::string(std::uint64_t number)>;
    // Called in each child before its first piece. slot: number of the child, from 0.
    using Begin = std::function<Work(std::size_t slot)>;
    // The end of a piece: the child reported back; it crashed or took too long, and would do so again; or
    // someone ended it with SIGKILL, SIGTERM, SIGINT or SIGHUP, perhaps for lack of memory.
    enum class End { kCameBack, kCrashed, kWasEnded };
    // Called in the parent at the end of each piece.
    using Done = std::function<void(std::uint64_t number, const std::string& problem, End end)>;

    WorkerPool(std::size_t workers, double time_limit_s, Begin begin);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    // Does all pieces, in about this order. Calls `stops` often; once it returns true, ends the children and
    // drops unfinished pieces. Throws DeviceError when no child can be made, and InputError with the message
    // that `begin` threw in a child. Owner thread.
    void run(
        const std::vector<std::uint64_t>& numbers, const Done& done,
        const std::function<bool()>& stops = [] { return false; });

  private:
    struct Worker {
        pid_t process = -1;
        Fd line;
        std::uint64_t number = 0;  // 0: idle
        double begun_s = 0;
        bool is_ready = false;  // true: has begun, and its time limit runs
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
    void end_all(const Done& done);
    void hear_the_last(Worker& worker, const Done& done);
};

}  // namespace hilcam
