#include "io/system/child_watch.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>

#include "io/system/fd.h"

namespace hilcam {
namespace {

std::uint64_t page_bytes() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

// The address space that the program has, in bytes; nothing where the kernel does not say.
std::uint64_t mapped_bytes() {
    const Fd statm(open("/proc/self/statm", O_RDONLY | O_CLOEXEC));
    std::array<char, 128> text{};
    unsigned long pages = 0;  // the first number of statm (proc(5))
    if (read(statm.get(), text.data(), text.size() - 1) <= 0 || std::sscanf(text.data(), "%lu", &pages) != 1)
        return 0;
    return pages * page_bytes();
}

}  // namespace

void limit_own_memory(std::uint64_t bytes) {
    const rlimit core{0, 0};
    setrlimit(RLIMIT_CORE, &core);
    const std::uint64_t mapped = mapped_bytes();
    if (mapped == 0) return;
    rlimit space{};
    getrlimit(RLIMIT_AS, &space);
    // At most half of the machine's memory, because the result is copied once on its way out.
    const std::uint64_t half = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) / 2 * page_bytes();
    space.rlim_max = std::min<rlim_t>(space.rlim_max, mapped + half);
    space.rlim_cur = std::min<rlim_t>(space.rlim_max, mapped + bytes);
    setrlimit(RLIMIT_AS, &space);
}

double cpu_s_of(pid_t process) {
    clockid_t clock = 0;
    timespec time{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool wait_while_it_works(pid_t child, int fd, unsigned waiting_s) {
    constexpr int kLook_ms = 500;
    // A thread that only reads the clock now and then, as a sanitizer's does, does no work.
    constexpr double kMinWork_s = 1e-3;
    double worked_s = 0, idle_s = 0;
    for (;;) {
        pollfd poll_fd{fd, POLLIN, 0};
        const int ready = poll(&poll_fd, 1, kLook_ms);
        if (ready > 0) return true;
        if (ready < 0) continue;  // a signal
        const double now_s = cpu_s_of(child);
        idle_s = now_s > worked_s + kMinWork_s ? 0 : idle_s + 1e-3 * kLook_ms;
        worked_s = now_s;
        if (idle_s >= waiting_s) return false;
    }
}

int end_of_child(pid_t child) {
    // A child that is ending already keeps its own exit status.
    kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

std::string reason_of_end(int status, bool worked) {
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (!worked) return "its reader waits for something that does not come";
    if (signal == SIGXCPU) return "its reader found no end";
    if (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(ChildStatus::kMemory))
        return "it asks for more memory than a file of its size may, or than half of this machine's";
    return "it is broken in a way that ends its reader; export it anew";
}

}  // namespace hilcam
