#pragma once
// Limits of memory and time for a test that runs in a process of its own (EXPECT_EXIT). Children have them
// too.

#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>

namespace hilcam {

// memory_bytes: of address space beyond what there is now. A write or a read that waits ends with SIGALRM.
inline void limit_this_process(std::uint64_t memory_bytes, unsigned seconds) {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + memory_bytes;
    const rlimit space{most, most};
    setrlimit(RLIMIT_AS, &space);
    alarm(seconds);
}

}  // namespace hilcam
