#include "emulator/scenario/real_time.h"

#include <sched.h>
#include <spdlog/fmt/fmt.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr const char* kAdvice =
    "in /etc/security/limits.d/hilcam.conf: '@video - rtprio 80' and '@video - memlock unlimited', then log "
    "in again; "
    "or run as root ('hilcam doctor' checks it)";

cpu_set_t set_of(const std::vector<double>& cores) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const double core : cores) CPU_SET(static_cast<std::size_t>(core), &set);
    return set;
}

std::string allowed_cores(const cpu_set_t& set) {
    std::string list;
    for (std::size_t core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &set)) list += fmt::format("{}{}", list.empty() ? "" : ", ", core);
    return list;
}

void require_cores(const RealTime& wishes) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    for (const double core : wishes.cores)
        if (std::floor(core) < core || !CPU_ISSET(static_cast<std::size_t>(core), &allowed))
            throw DeviceError(fmt::format("loop.cores: found {}; this process may run on {}", core,
                                          allowed_cores(allowed)));
}

// Tries the priority on this thread only, and restores it.
void require_priority(const RealTime& wishes) {
    if (wishes.priority == 0) return;
    const int policy = sched_getscheduler(0);
    sched_param before{};
    sched_getparam(0, &before);
    const sched_param wished{static_cast<int>(wishes.priority)};
    if (sched_setscheduler(0, SCHED_FIFO, &wished) != 0)
        throw DeviceError(fmt::format("loop.priority: found {}; this process may not have it: {}; {}",
                                      wishes.priority, std::strerror(errno), kAdvice));
    sched_setscheduler(0, policy, &before);
}

std::vector<pid_t> other_threads() {
    std::vector<pid_t> threads;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        const std::string name = entry.path().filename();
        pid_t thread = 0;
        std::from_chars(name.data(), name.data() + name.size(), thread);
        if (thread != 0 && thread != gettid()) threads.push_back(thread);
    }
    return threads;
}

int niceness_of(pid_t thread) { return getpriority(PRIO_PROCESS, static_cast<id_t>(thread)); }

// Ignores threads that have ended meanwhile.
void require_done(int result, const char* what) {
    if (result != 0 && errno != ESRCH)
        throw DeviceError(
            fmt::format("{}: a thread cannot be raised: {}; {}", what, std::strerror(errno), kAdvice));
}

void raise_thread(pid_t thread, const RealTime& wishes) {
    if (!wishes.cores.empty()) {
        const cpu_set_t set = set_of(wishes.cores);
        require_done(sched_setaffinity(thread, sizeof set, &set), "loop.cores");
    }
    if (wishes.priority > 0) {
        const sched_param wished{static_cast<int>(wishes.priority)};
        require_done(sched_setscheduler(thread, SCHED_FIFO, &wished), "loop.priority");
    }
}

}  // namespace

Fields fields(RealTime& w) {
    return {
        integer(
            "priority", w.priority, {0, 99},
            "real-time priority (SCHED_FIFO) of the threads that make and send frames; 0: normal scheduling"),
        numbers("cores", w.cores, 1, {0, CPU_SETSIZE - 1}, {0, CPU_SETSIZE},
                "processor cores on which those threads run; none: all"),
        flag("lock_memory", w.lock_memory, "true: the program's memory stays in RAM, without paging"),
    };
}

void require_rights(const RealTime& wishes) {
    require_cores(wishes);
    require_priority(wishes);
}

void lock_memory(const RealTime& wishes) {
    if (!wishes.lock_memory || mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return;
    const int error = errno;
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    throw DeviceError(fmt::format("loop.lock_memory: {} (memlock limit {} MB); {}", std::strerror(error),
                                  limit.rlim_cur / 1'000'000, kAdvice));
}

void raise_threads(const RealTime& wishes) {
    if (wishes.priority == 0 && wishes.cores.empty()) return;
    const int own = niceness_of(gettid());
    for (const pid_t thread : other_threads())
        if (niceness_of(thread) <= own) raise_thread(thread, wishes);
}

}  // namespace hilcam
