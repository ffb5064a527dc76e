#include "io/system/helper_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <utility>

#include "io/system/child_watch.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Returns memory that can neither shrink nor grow, so that no access runs past its end.
Fd sealed_memory(std::size_t bytes) {
    Fd fd(memfd_create("hilcam-helper", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!fd || ftruncate(fd.get(), static_cast<off_t>(bytes)) != 0 ||
        fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
        return {};
    return fd;
}

// Returns a copy above the descriptors that the helper expects, so that neither overwrites the other.
Fd moved_up(const Fd& fd) { return Fd(fcntl(fd.get(), F_DUPFD_CLOEXEC, kHelperMemory + 1)); }

// Starts the program with its two descriptors, no terminal, and no signal blocked or ignored. Returns -1 on
// failure.
pid_t started(const std::filesystem::path& program, int socket, int memory) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int terminal : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, terminal, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions, socket, kHelperSocket);
    posix_spawn_file_actions_adddup2(&actions, memory, kHelperMemory);
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    sigset_t all, none;
    sigfillset(&all), sigemptyset(&none);
    posix_spawnattr_setsigdefault(&how, &all);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    std::string name = program.filename().string();
    std::array<char*, 2> arguments{name.data(), nullptr};
    pid_t process = -1;
    if (posix_spawn(&process, program.c_str(), &actions, &how, arguments.data(), environ) != 0) process = -1;
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&actions);
    return process;
}

}  // namespace

HelperProcess::HelperProcess(const std::filesystem::path& program, std::size_t memory_bytes)
    : owner_(getpid()), memory_bytes_(memory_bytes) {
    const Fd memory = sealed_memory(memory_bytes);
    void* const mapped =
        memory ? mmap(nullptr, memory_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0)
               : MAP_FAILED;
    std::array<int, 2> ends{-1, -1};
    if (mapped == MAP_FAILED || socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        if (mapped != MAP_FAILED) munmap(mapped, memory_bytes);
        throw DeviceError(program.string() + ": no memory or no socket can be made for it");
    }
    memory_ = static_cast<std::uint8_t*>(mapped);
    socket_ = Fd(ends[0]);
    const Fd other(ends[1]);
    process_ = started(program, moved_up(other).get(), moved_up(memory).get());
    if (process_ > 0) return;
    munmap(mapped, memory_bytes);
    throw DeviceError(program.string() + " cannot be started");
}

HelperProcess::~HelperProcess() {
    if (is_own() && process_ > 0) end_of_child(process_);
    munmap(memory_, memory_bytes_);
}

bool HelperProcess::is_own() const { return owner_ == getpid(); }

std::string HelperProcess::ask(std::span<const std::uint8_t> request, std::span<std::uint8_t> answer,
                               Limits limits) {
    HILCAM_CHECK(is_own() && process_ > 0);
    // The kernel enforces this limit even when nobody waits any more.
    rlimit cpu{};
    if (prlimit(process_, RLIMIT_CPU, nullptr, &cpu) == 0) {
        cpu.rlim_cur =
            std::min<rlim_t>(cpu.rlim_max, static_cast<rlim_t>(std::ceil(cpu_s_of(process_) + limits.cpu_s)));
        prlimit(process_, RLIMIT_CPU, &cpu, nullptr);
    }
    if (send(socket_.get(), request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size()))
        return end(true);
    if (!wait_while_it_works(process_, socket_.get(), limits.waiting_s)) return end(false);
    ssize_t got = 0;
    // MSG_TRUNC: the size of the whole message.
    while ((got = recv(socket_.get(), answer.data(), answer.size(), MSG_TRUNC)) < 0 && errno == EINTR) {
    }
    return got == static_cast<ssize_t>(answer.size()) ? std::string() : end(true);
}

std::string HelperProcess::end(bool worked) {
    return reason_of_end(end_of_child(std::exchange(process_, -1)), worked);
}

}  // namespace hilcam
