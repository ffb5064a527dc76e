#include "emulator/campaign/worker_pool.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <utility>

#include "emulator/progress/progress.h"
#include "io/system/monotonic.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kLongestProblem = 4000;

double now_s() { return 1e-9 * static_cast<double>(monotonic_ns()); }

// True for a signal that someone sends, not one that a fault in the piece raises.
bool is_from_outside(int status) {
    if (!WIFSIGNALED(status)) return false;
    const int signal = WTERMSIG(status);
    return signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
}

std::string end_of_child(int status, bool is_late, double limit_s) {
    if (is_late)
        return "took longer than " + std::to_string(static_cast<long>(limit_s)) + " s (time_limit_s)";
    if (!WIFSIGNALED(status)) return "its process ended with status " + std::to_string(WEXITSTATUS(status));
    const int signal = WTERMSIG(status);
    if (is_from_outside(status))
        return "its process was ended: signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    return "its process crashed: signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

void pause_ms(long ms) {
    const timespec pause{0, ms * 1'000'000};
    nanosleep(&pause, nullptr);
}

}  // namespace

WorkerPool::WorkerPool(std::size_t workers, double time_limit_s, Begin begin)
    : time_limit_s_(time_limit_s), begin_(std::move(begin)), workers_(workers) {}

WorkerPool::~WorkerPool() {
    for (Worker& worker : workers_)
        if (worker.process > 0) kill(worker.process, SIGKILL), end(worker);
}

void WorkerPool::start(std::size_t slot) {
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw DeviceError(std::string("no line to a process can be made: ") + std::strerror(errno));
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) be_child(slot, ends[1], parent);
    ::close(ends[1]);
    workers_[slot].line = Fd(ends[0]);
    if (child < 0) throw DeviceError(std::string("no process can be made: ") + std::strerror(errno));
    workers_[slot].process = child;
    workers_[slot].number = 0;
    workers_[slot].is_ready = false;
}

void WorkerPool::be_child(std::size_t slot, int line, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // the parent died before the death signal was set up
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM})
        std::signal(signal, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    Progress::keep_silent();
    Work work;
    std::string reason;  // why nothing can be done
    try {
        work = begin_(slot);
    } catch (const std::exception& problem) {
        reason = plain_words(problem);
    }
    const std::string greeting = reason.empty() ? " " : "!" + reason.substr(0, kLongestProblem);
    if (write(line, greeting.data(), greeting.size()) < 0) _exit(1);
    // Reads all pending packets: a socket that is closed with unread packets loses its own last message.
    for (std::uint64_t ignored = 0; !reason.empty();)
        if (read(line, &ignored, sizeof ignored) <= 0) _exit(1);
    for (std::uint64_t number = 0; read(line, &number, sizeof number) == sizeof number && number != 0;) {
        std::string problem = work(number);
        problem.resize(std::min(problem.size(), kLongestProblem));
        problem.insert(problem.begin(), ' ');  // a packet of nothing would be the end
        if (write(line, problem.data(), problem.size()) < 0) break;
    }
    _exit(0);
}

void WorkerPool::give(Worker& worker, std::uint64_t number) {
    worker.number = number;
    worker.begun_s = now_s();
    worker.is_late = false;
    // If the child is dead, its socket reports it.
    [[maybe_unused]] const ssize_t sent = send(worker.line.get(), &number, sizeof number, MSG_NOSIGNAL);
}

void WorkerPool::end(Worker& worker) {
    worker.line.reset();
    while (worker.process > 0 && waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
    }
    worker.process = -1;
}

void WorkerPool::hear(std::size_t slot, const Done& done) {
    Worker& worker = workers_[slot];
    std::array<char, kLongestProblem + 1> text{};
    const ssize_t size = recv(worker.line.get(), text.data(), text.size(), 0);
    if (size < 0 && errno == EINTR) return;
    if (size > 0 && !worker.is_ready) {
        if (text[0] == '!')
            throw InputError(std::string(text.data() + 1, static_cast<std::size_t>(size) - 1));
        worker.is_ready = true;
        worker.begun_s = now_s();
        return;
    }
    const std::uint64_t number = std::exchange(worker.number, 0);
    if (size > 0) {
        if (number != 0)
            done(number, std::string(text.data() + 1, static_cast<std::size_t>(size) - 1), End::kCameBack);
        return;
    }
    int status = 0;
    while (waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
    }
    worker.process = -1;
    worker.line.reset();
    if (number == 0) return;
    const bool was_ended = is_from_outside(status) && !worker.is_late;
    done(number, end_of_child(status, worker.is_late, time_limit_s_),
         was_ended ? End::kWasEnded : End::kCrashed);
}

void WorkerPool::end_late_ones() {
    for (Worker& worker : workers_)
        if (worker.number != 0 && worker.is_ready && !worker.is_late &&
            now_s() - worker.begun_s > time_limit_s_) {
            worker.is_late = true;
            kill(worker.process, SIGKILL);
        }
}

// Gives children a moment to end what they have started.
void WorkerPool::end_all(const Done& done) {
    constexpr int kPatience_ms = 3000, kLook_ms = 10;
    for (const Worker& worker : workers_)
        if (worker.process > 0) kill(worker.process, SIGTERM);
    for (int waited_ms = 0; waited_ms < kPatience_ms; waited_ms += kLook_ms) {
        bool all_ended = true;
        for (Worker& worker : workers_) {
            if (worker.process > 0 && waitpid(worker.process, nullptr, WNOHANG) == worker.process)
                worker.process = -1;
            all_ended = all_ended && worker.process <= 0;
        }
        if (all_ended) break;
        pause_ms(kLook_ms);
    }
    for (Worker& worker : workers_) {
        hear_the_last(worker, done);
        if (worker.process > 0) kill(worker.process, SIGKILL);
        end(worker);
    }
}

// Accepts a piece that was finished before its child ended.
void WorkerPool::hear_the_last(Worker& worker, const Done& done) {
    std::array<char, kLongestProblem + 1> text{};
    while (worker.number != 0 && worker.line) {
        const ssize_t size = recv(worker.line.get(), text.data(), text.size(), MSG_DONTWAIT);
        if (size <= 0) return;
        if (!std::exchange(worker.is_ready, true)) continue;
        done(std::exchange(worker.number, 0),
             std::string(text.data() + 1, static_cast<std::size_t>(size) - 1), End::kCameBack);
    }
}

void WorkerPool::run(const std::vector<std::uint64_t>& numbers, const Done& done,
                     const std::function<bool()>& stops) {
    std::size_t next = 0;
    while (true) {
        if (stops()) return end_all(done);
        std::vector<pollfd> lines;
        std::vector<std::size_t> slots;
        for (std::size_t slot = 0; slot < workers_.size(); ++slot) {
            Worker& worker = workers_[slot];
            if (worker.number == 0 && next < numbers.size()) {
                if (worker.process < 0) start(slot);
                give(worker, numbers[next++]);
            }
            if (worker.number == 0) continue;
            lines.push_back({worker.line.get(), POLLIN, 0});
            slots.push_back(slot);
        }
        if (lines.empty()) break;
        constexpr int kLook_ms = 100;
        if (poll(lines.data(), lines.size(), kLook_ms) > 0)
            for (std::size_t i = 0; i < lines.size(); ++i)
                if (lines[i].revents != 0) hear(slots[i], done);
        end_late_ones();
    }
    for (Worker& worker : workers_)
        if (worker.process > 0) give(worker, 0), end(worker);
}

}  // namespace hilcam
