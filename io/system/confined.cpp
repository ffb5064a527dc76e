#include "io/system/confined.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <new>

#include "io/system/child_watch.h"
#include "io/system/confinement.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using Status = ChildStatus;

void limit_child(const ConfinedLimits& limits) {
    rlimit cpu{};
    getrlimit(RLIMIT_CPU, &cpu);
    cpu.rlim_cur = std::min(cpu.rlim_max, static_cast<rlim_t>(std::ceil(limits.cpu_s)));
    setrlimit(RLIMIT_CPU, &cpu);
    limit_own_memory(limits.memory_bytes);
}

[[noreturn]] void end_child(ConfinedOutput& out, int fd, Status status, const std::string& message = {}) {
    try {
        if (!message.empty()) {
            if (ftruncate(fd, 0) != 0 || lseek(fd, 0, SEEK_SET) != 0) status = Status::kBroken;
            out.text(message);
        }
    } catch (const std::exception&) {
        status = Status::kBroken;
    }
    _exit(static_cast<int>(status));
}

// Leaves the child with what it needs: /dev/null for the terminal, the file for its results, and the end of
// the pipe that shows its death.
void keep_only(int results, int alive) {
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int terminal : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, terminal);
    close_all_but(std::array{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO, results, alive});
}

[[noreturn]] void be_child(pid_t parent, int fd, int alive, const ConfinedLimits& limits,
                           std::span<const std::filesystem::path> readable,
                           const std::function<void(ConfinedOutput&)>& work) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent died before the request for its signal.
    if (getppid() != parent) _exit(static_cast<int>(Status::kBroken));
    // Resets the parent's handlers (a sanitizer's, a test's), which would handle the child's abort as their
    // own.
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGXCPU})
        std::signal(signal, SIG_DFL);
    keep_only(fd, alive);
    limit_child(limits);
    restrict_files(readable);
    restrict_calls();
    ConfinedOutput out(fd);
    try {
        work(out);
    } catch (const InputError& error) {
        end_child(out, fd, Status::kRefused, error.what());
    } catch (const DeviceError& error) {
        end_child(out, fd, Status::kDevice, error.what());
    } catch (const std::bad_alloc&) {
        end_child(out, fd, Status::kMemory);
    } catch (...) {
        end_child(out, fd, Status::kBroken);
    }
    end_child(out, fd, Status::kDone);
}

}  // namespace

void ConfinedOutput::write(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(from);
    while (size > 0) {
        const ssize_t written = ::write(fd_, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) throw std::bad_alloc();  // the file is in memory
        bytes += written, size -= static_cast<std::size_t>(written);
    }
}

ConfinedResult::ConfinedResult(const Fd& file, std::string name) : name_(std::move(name)) {
    struct stat found {};
    if (fstat(file.get(), &found) != 0) refuse();
    size_ = static_cast<std::uint64_t>(found.st_size);
    if (size_ == 0) return;
    void* const mapped = mmap(nullptr, size_, PROT_READ, MAP_SHARED, file.get(), 0);
    if (mapped == MAP_FAILED) throw DeviceError("no memory for what was found in " + name_);
    bytes_ = {static_cast<const std::uint8_t*>(mapped),
              [size = size_](const std::uint8_t* p) { munmap(const_cast<std::uint8_t*>(p), size); }};
}

const std::uint8_t* ConfinedResult::take(std::uint64_t count, std::uint64_t size_each) {
    if (count > (size_ - at_) / size_each) refuse();
    return bytes_.get() + std::exchange(at_, at_ + count * size_each);
}

void ConfinedResult::refuse() const {
    throw InputError(name_ +
                     ": does not parse: it is broken in a way that confuses its reader; export it anew");
}

ConfinedResult run_confined(const std::string& name, const ConfinedLimits& limits,
                            std::span<const std::filesystem::path> readable,
                            const std::function<void(ConfinedOutput&)>& work) {
    const Fd results(memfd_create("hilcam", MFD_CLOEXEC));
    std::array<int, 2> ends{-1, -1};
    const pid_t parent = getpid();
    const pid_t child = results && pipe2(ends.data(), O_CLOEXEC) == 0 ? fork() : -1;
    const Fd alive(ends[0]);
    if (child == 0) be_child(parent, results.get(), ends[1], limits, readable, work);
    Fd(ends[1]).reset();  // only the child holds it
    if (child < 0) throw DeviceError("no process can be made to read " + name);
    const bool worked = wait_while_it_works(child, alive.get(), limits.waiting_s);
    const int status = end_of_child(child);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const auto is = [&](Status s) { return worked && code == static_cast<int>(s); };
    if (!is(Status::kDone) && !is(Status::kRefused) && !is(Status::kDevice))
        throw InputError(name + ": does not parse: " + reason_of_end(status, worked));
    ConfinedResult result(results, name);
    if (is(Status::kRefused)) throw InputError(result.text());
    if (is(Status::kDevice)) throw DeviceError(result.text());
    return result;
}

void allow_more(std::uint64_t memory_bytes, double cpu_s) {
    const auto raise = [](__rlimit_resource_t which, std::uint64_t more) {
        rlimit limit{};
        getrlimit(which, &limit);
        if (limit.rlim_cur == RLIM_INFINITY) return;
        limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, limit.rlim_cur + more);
        setrlimit(which, &limit);
    };
    raise(RLIMIT_AS, memory_bytes);
    raise(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(cpu_s)));
}

}  // namespace hilcam
