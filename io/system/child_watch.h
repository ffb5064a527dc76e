#pragma once
// Parents and their children that work on bytes which nobody vouches for (confined.h, helper_process.h) have this in common: a child's
// limits, how its parent waits for it, and what its end means.

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace hilcam {

// The status with which such a child ends. Others are those of libraries and sanitizers.
enum class ChildStatus : int { kDone = 0, kRefused = 100, kMemory = 101, kDevice = 102, kBroken = 103 };

// Limits this process: so much address space beyond what it has, half of the machine's memory at most, no core dump. The work may ask
// for more later (allow_more()).
void limit_own_memory(std::uint64_t bytes);

// Returns the processor time that a process has taken so far.
double cpu_s_of(pid_t process);
// Waits until `fd` can be read or its other end is closed, which the child's death does. False: for so long the child took next to no
// processor time, so it only waits, which a limit of processor time does not see. It is not ended here.
bool wait_while_it_works(pid_t child, int fd, unsigned waiting_s);
// Ends a child that has no more to say, and returns how it ended (waitpid()).
int end_of_child(pid_t child);
// Says what a child's end means for the file that it read. worked: it was not ended because it waited.
std::string reason_of_end(int status, bool worked);

}  // namespace hilcam
