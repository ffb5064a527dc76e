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
    // Does one piece; returns an empty text, or why nothing came of it. It runs in the child.
    using Work = std::function<std::string(std::uint64_t number)>;
    // Is called in each child before its first piece; slot: which child, from 0.
    using Begin = std::function<Work(std::size_t slot)>;
    // The end of a piece in its child: the child came back; it crashed or took too long, as it would again; or somebody
    // ended it, who may have had no memory left (SIGKILL, SIGTERM, SIGINT, SIGHUP).
    enum class End { kCameBack, kCrashed, kWasEnded };
    // Told of each piece, in the parent.
    using Done = std::function<void(std::uint64_t number, const std::string& problem, End end)>;

    WorkerPool(std::size_t workers, double time_limit_s, Begin begin);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    // Does all pieces, in about this order. It asks `stops` often; once that returns true, it ends the children and
    // drops the pieces that they have not finished. Throws DeviceError when no child can be made, and InputError with
    // the words that `begin` threw in a child. Owner thread.
    void run(
        const std::vector<std::uint64_t>& numbers, const Done& done,
        const std::function<bool()>& stops = [] { return false; });

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
    void end_all(const Done& done);
    void hear_the_last(Worker& worker, const Done& done);
};

}  // namespace hilcam
