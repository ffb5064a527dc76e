#pragma once
// Threads that work little and must not wait for those that render.

#include <sys/resource.h>

namespace hilcam {

// The calling thread gets a core before ordinary threads do, where the process may ask for that (CAP_SYS_NICE
// or a limit on niceness; `hilcam doctor` tells); else nothing changes. Not real-time scheduling: a stream's
// receiver on the same machine must not starve.
inline bool make_thread_urgent() noexcept {
    // Linux: 0 is the calling thread, not the process. -10 weighs 9 times an ordinary thread (kernel/sched).
    return setpriority(PRIO_PROCESS, 0, -10) == 0;
}

}  // namespace hilcam
