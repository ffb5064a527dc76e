#pragma once
// Requests of the frame loop's threads to the machine: priority over other programs, cores of their own,
// memory that is never paged out. All of it only on request, because a program should not take a core from
// others unasked.
//
// The priority applies to all threads of the process except the calling one, which reports, and threads that
// have made themselves nicer than it, such as the preview's, which must never delay a frame. Threads that a
// raised thread starts are raised as well.

#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct RealTime {
    std::int64_t priority = 0;  // for SCHED_FIFO, 1 to 99; 0: the system's normal scheduling
    std::vector<double> cores;  // numbers of the cores; empty: any core
    bool lock_memory = false;
};
Fields fields(RealTime& wishes);

// Throws DeviceError with the reason when this process lacks the rights for its requests. Any thread.
void require_rights(const RealTime& wishes);
// Locks all present and future memory of the process. Throws DeviceError.
void lock_memory(const RealTime& wishes);
// Raises the threads that exist. Throws DeviceError.
void raise_threads(const RealTime& wishes);

}  // namespace hilcam
