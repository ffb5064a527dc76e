#include "io/system/confinement.h"

#include <fcntl.h>
#include <linux/sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <vector>

#include "io/system/fd.h"

namespace hilcam {
namespace {

// From linux/landlock.h, of which older versions lack some parts. The numbers of calls and bits are the
// kernel's stable interface.
constexpr long kCreateRuleset = 444, kAddRule = 445, kRestrictSelf = 446;
constexpr unsigned kAskVersion = 1;
constexpr int kPathBeneath = 1;
constexpr std::uint64_t kReadFile = 1u << 2, kReadFolder = 1u << 3;
struct LandlockRules {
    std::uint64_t files;  // bits of what is forbidden unless a rule allows it
    std::uint64_t network;
    std::uint64_t scope;
};
struct __attribute__((packed)) LandlockPath {
    std::uint64_t allowed;
    std::int32_t parent;
};

int landlock_version() {
    const long version = syscall(kCreateRuleset, nullptr, 0, kAskVersion);
    return version > 0 ? static_cast<int>(version) : 0;
}

// Returns everything that a version can forbid; the kernel refuses bits of later versions.
LandlockRules all_of(int version) {
    int bits = 13;                // 1: execute, write, read, list, remove, make
    if (version >= 2) bits = 14;  // move to another folder
    if (version >= 3) bits = 15;  // truncate
    if (version >= 5) bits = 16;  // ioctl on devices
    LandlockRules out{(std::uint64_t{1} << bits) - 1, 0, 0};
    if (version >= 4) out.network = 3;  // bind, connect (TCP)
    if (version >= 6) out.scope = 3;    // abstract Unix sockets, signals
    return out;
}

std::size_t size_of_rules(int version) { return version >= 6 ? 24 : version >= 4 ? 16 : 8; }

void allow_to_read(int rules, const std::filesystem::path& path) {
    const Fd at(open(path.c_str(), O_PATH | O_CLOEXEC));
    struct stat found {};
    if (!at || fstat(at.get(), &found) != 0) return;
    const LandlockPath rule{S_ISDIR(found.st_mode) ? kReadFile | kReadFolder : kReadFile, at.get()};
    syscall(kAddRule, rules, kPathBeneath, &rule, 0);
}

class Filter {
  public:
    // Calls that are not allowed fail as if the process had no right to them.
    Filter() : context_(seccomp_init(SCMP_ACT_ERRNO(EPERM))) {}
    ~Filter() {
        if (context_) seccomp_release(context_);
    }
    Filter(const Filter&) = delete;
    Filter& operator=(const Filter&) = delete;

    void allow(std::initializer_list<int> calls) {
        for (const int call : calls) add(SCMP_ACT_ALLOW, call, {});
    }
    void allow_if(int call, std::initializer_list<scmp_arg_cmp> conditions) {
        add(SCMP_ACT_ALLOW, call, conditions);
    }
    // Fails as on a kernel without the call, so that libraries use an older one.
    void deny_as_unknown(int call) { add(SCMP_ACT_ERRNO(ENOSYS), call, {}); }
    bool load() {
        if (!context_ || !good_) return false;
        seccomp_attr_set(context_, SCMP_FLTATR_CTL_TSYNC, 1);
        return seccomp_load(context_) == 0;
    }

  private:
    scmp_filter_ctx context_;
    bool good_ = true;

    void add(std::uint32_t action, int call, std::initializer_list<scmp_arg_cmp> conditions) {
        if (!context_) return;
        good_ = seccomp_rule_add_array(context_, action, call, static_cast<unsigned>(conditions.size()),
                                       conditions.begin()) == 0 &&
                good_;
    }
};

scmp_arg_cmp without(unsigned argument, scmp_datum_t bits) { return {argument, SCMP_CMP_MASKED_EQ, bits, 0}; }
scmp_arg_cmp with(unsigned argument, scmp_datum_t bits) { return {argument, SCMP_CMP_MASKED_EQ, bits, bits}; }
scmp_arg_cmp equal(unsigned argument, scmp_datum_t value) { return {argument, SCMP_CMP_EQ, value, 0}; }

void allow_computing(Filter& filter) {
    filter.allow({SCMP_SYS(brk),
                  SCMP_SYS(munmap),
                  SCMP_SYS(mremap),
                  SCMP_SYS(madvise),
                  SCMP_SYS(futex),
                  SCMP_SYS(sched_yield),
                  SCMP_SYS(sched_getaffinity),
                  SCMP_SYS(membarrier),
                  SCMP_SYS(rseq),
                  SCMP_SYS(set_robust_list),
                  SCMP_SYS(exit),
                  SCMP_SYS(exit_group),
                  SCMP_SYS(restart_syscall),
                  SCMP_SYS(rt_sigaction),
                  SCMP_SYS(rt_sigprocmask),
                  SCMP_SYS(rt_sigreturn),
                  SCMP_SYS(sigaltstack),
                  SCMP_SYS(pause),
                  SCMP_SYS(nanosleep),
                  SCMP_SYS(clock_nanosleep),
                  SCMP_SYS(clock_gettime),
                  SCMP_SYS(clock_getres),
                  SCMP_SYS(gettimeofday),
                  SCMP_SYS(time),
                  SCMP_SYS(times),
                  SCMP_SYS(getpid),
                  SCMP_SYS(gettid),
                  SCMP_SYS(getppid),
                  SCMP_SYS(getuid),
                  SCMP_SYS(geteuid),
                  SCMP_SYS(getgid),
                  SCMP_SYS(getegid),
                  SCMP_SYS(getrandom),
                  SCMP_SYS(sysinfo),
                  SCMP_SYS(uname),
                  SCMP_SYS(getrusage),
                  SCMP_SYS(getrlimit),
                  SCMP_SYS(setrlimit)});
    filter.allow_if(SCMP_SYS(mmap), {without(2, PROT_EXEC)});
    filter.allow_if(SCMP_SYS(mprotect), {without(2, PROT_EXEC)});
    filter.allow_if(SCMP_SYS(prlimit64), {equal(0, 0)});
    // Allows threads and no processes. The newer clone3() hides its flags from the filter.
    filter.allow_if(SCMP_SYS(clone), {with(0, CLONE_THREAD)});
    filter.deny_as_unknown(SCMP_SYS(clone3));
    // abort() signals its own thread.
    filter.allow_if(SCMP_SYS(tgkill), {equal(0, static_cast<scmp_datum_t>(getpid()))});
}

void allow_reading(Filter& filter) {
    filter.allow({SCMP_SYS(read),     SCMP_SYS(readv),      SCMP_SYS(pread64),   SCMP_SYS(preadv),
                  SCMP_SYS(lseek),    SCMP_SYS(close),      SCMP_SYS(stat),      SCMP_SYS(lstat),
                  SCMP_SYS(fstat),    SCMP_SYS(newfstatat), SCMP_SYS(statx),     SCMP_SYS(statfs),
                  SCMP_SYS(fstatfs),  SCMP_SYS(access),     SCMP_SYS(faccessat), SCMP_SYS(faccessat2),
                  SCMP_SYS(readlink), SCMP_SYS(readlinkat), SCMP_SYS(getcwd),    SCMP_SYS(getdents64),
                  SCMP_SYS(fcntl),    SCMP_SYS(fadvise64),  SCMP_SYS(dup),       SCMP_SYS(poll),
                  SCMP_SYS(ppoll)});
    constexpr scmp_datum_t kToWrite = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
    filter.allow_if(SCMP_SYS(open), {without(1, kToWrite)});
    filter.allow_if(SCMP_SYS(openat), {without(2, kToWrite)});
    filter.deny_as_unknown(SCMP_SYS(openat2));
}

// Answers go to open descriptors, the results' memory and the helper's socket; nothing else can be opened for
// writing.
void allow_answering(Filter& filter) {
    filter.allow({SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(pwrite64), SCMP_SYS(ftruncate)});
    filter.allow_if(SCMP_SYS(recvfrom), {equal(4, 0)});
    filter.allow_if(SCMP_SYS(sendto), {equal(4, 0)});
}

}  // namespace

void close_all_but(std::span<const int> kept) {
    std::vector<int> ends(kept.begin(), kept.end());
    std::sort(ends.begin(), ends.end());
    ends.push_back(INT_MAX);
    int from = 0;
    for (const int next : ends) {
        const int to = next - 1;
        if (from <= to && close_range(static_cast<unsigned>(from), static_cast<unsigned>(to), 0) != 0) {
            // Before Linux 5.9: one by one.
            rlimit files{};
            getrlimit(RLIMIT_NOFILE, &files);
            const auto last = static_cast<int>(std::min<rlim_t>(files.rlim_cur, 1 << 16));
            for (int fd = from; fd <= std::min(to, last); ++fd) close(fd);
        }
        from = next == INT_MAX ? INT_MAX : next + 1;
    }
}

bool restrict_files(std::span<const std::filesystem::path> readable) {
    const int version = landlock_version();
    if (version == 0 || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
    const LandlockRules all = all_of(version);
    const Fd rules(static_cast<int>(syscall(kCreateRuleset, &all, size_of_rules(version), 0)));
    if (!rules) return false;
    for (const std::filesystem::path& path : readable) allow_to_read(rules.get(), path);
    return syscall(kRestrictSelf, rules.get(), 0) == 0;
}

bool restrict_calls() {
    Filter filter;
    allow_computing(filter);
    allow_reading(filter);
    allow_answering(filter);
    return filter.load();
}

Confinement confinement_here() {
    Confinement out;
    const pid_t child = fork();
    if (child == 0) _exit(restrict_calls() ? 0 : 1);
    int status = 1;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    out.seccomp = child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    out.landlock = landlock_version();
    return out;
}

}  // namespace hilcam
