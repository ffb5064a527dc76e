#pragma once
// Threads that compute give way to threads that move data.
//
// A frame's arithmetic keeps every core busy for whole frame periods; a packet or a command needs a core for
// microseconds, but now: a client on this machine has buffers for a few milliseconds of stream. So the
// calling thread, and oneTBB's threads that work for it, run at a lower priority (nice 10) than the threads
// that serve sockets and than other programs' threads. That needs no rights. On a machine with idle cores it
// changes nothing.

#include <tbb/task_scheduler_observer.h>

namespace hilcam {

class ComputePriority : private tbb::task_scheduler_observer {
  public:
    // From here on, for the thread's life. Owner: the computing thread, before its first parallel work.
    ComputePriority();
    ~ComputePriority() override;

  private:
    void on_scheduler_entry(bool is_worker) override;
};

}  // namespace hilcam
