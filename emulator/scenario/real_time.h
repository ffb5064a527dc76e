#pragma once
// The wishes of the frame loop's threads to the machine: priority over everything else, cores of their own,
// memory that is never paged out. All of it on request only: a program that takes a core whatever else wants
// it must be asked to.
//
// Raised are all threads of the process but the calling one, which reports, and those that have made
// themselves nicer than it: the preview's, which must never delay a frame. What a raised thread starts is
// raised too.

#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct RealTime {
    std::int64_t priority = 0;  // priority of SCHED_FIFO, 1 to 99; 0: the system's usual scheduling
    std::vector<double> cores;  // numbers; none: wherever the system likes
    bool lock_memory = false;
};
Fields fields(RealTime& wishes);

// Throws DeviceError with the reason when this process may not have what is wished for. Any thread.
void require_rights(const RealTime& wishes);
// Locks all memory that the process has and will have. Throws DeviceError.
void lock_memory(const RealTime& wishes);
// Raises the threads that there are. Throws DeviceError.
void raise_threads(const RealTime& wishes);

}  // namespace hilcam
