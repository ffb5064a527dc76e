#pragma once
// The common part of confined.h and helper_process.h, which work on untrusted bytes in a child process: the
// child's limits, how the parent waits, and what the child's end means.

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace hilcam {

// The exit status of such a child. Other values come from libraries and sanitizers.
enum class ChildStatus : int { kDone = 0, kRefused = 100, kMemory = 101, kDevice = 102, kBroken = 103 };

// Limits the memory of this process to `bytes` of address space beyond what it has, and to half of the
// machine's memory at most; switches core dumps off. The work may ask for more later (allow_more()).
void limit_own_memory(std::uint64_t bytes);

// Returns the processor time that a process has used [s].
double cpu_s_of(pid_t process);
// Waits until `fd` can be read or its other end is closed, as when the child dies. Returns false when the
// child used next to no processor time for waiting_s: it hangs, which a limit of processor time does not
// catch. Does not end the child.
bool wait_while_it_works(pid_t child, int fd, unsigned waiting_s);
// Ends a child with nothing more to say, and returns its status as waitpid() gives it.
int end_of_child(pid_t child);
// Returns what a child's end means for the file that it read. worked: false when it was ended because it
// hung.
std::string reason_of_end(int status, bool worked);

}  // namespace hilcam
