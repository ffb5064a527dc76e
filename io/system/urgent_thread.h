#pragma once
// Priority for threads that work little and must not wait for the threads that render.

#include <sys/resource.h>

namespace hilcam {

// Lets the calling thread run before ordinary threads, where the process may ask for that (CAP_SYS_NICE or a
// limit on niceness; see `hilcam doctor`). Returns false, and changes nothing, where it may not. It is no
// real-time scheduling: a stream's receiver on the same machine must not starve.
inline bool make_thread_urgent() noexcept {
    // Linux: 0 is the calling thread, not the process. -10 has 9 times the weight of an ordinary thread
    // (kernel/sched).
    return setpriority(PRIO_PROCESS, 0, -10) == 0;
}

}  // namespace hilcam
