// A child that reads what may be hostile tries to get out: each call here is one that whoever had taken it over would make.

#include "io/system/confinement.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <thread>

#include "io/system/confined.h"
#include "io/system/input_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

class Escape : public FilesTest {
  protected:
    // What a call fails with in a child that may read in folder_; 0: it is done.
    int error_in_child(const std::function<long()>& call) {
        const std::array readable{folder_};
        ConfinedResult result = run_confined("f", {256u << 20, 10, 5}, readable, [&](ConfinedOutput& out) {
            errno = 0;
            out.value(call() < 0 ? errno : 0);
        });
        return result.value<int>();
    }
    int error_of_opening(const std::filesystem::path& file, int flags) {
        return error_in_child([&] { return open(file.c_str(), flags, 0600); });
    }
};

#define NEEDS_SECCOMP() \
    if (!confinement_here().seccomp) GTEST_SKIP() << "this kernel has no seccomp"
#define NEEDS_LANDLOCK() \
    if (confinement_here().landlock == 0) GTEST_SKIP() << "this kernel has no Landlock"

TEST_F(Escape, NoFileIsWrittenMadeOrRemoved) {
    NEEDS_SECCOMP();
    const std::filesystem::path there = write("there", "old");
    for (const int flags :
         {O_WRONLY, O_RDWR, O_WRONLY | O_CREAT, O_RDONLY | O_CREAT, O_RDONLY | O_TRUNC, O_WRONLY | O_APPEND})
        EXPECT_EQ(error_of_opening(there, flags), EPERM) << flags;
    EXPECT_EQ(error_of_opening(folder_, O_TMPFILE | O_RDWR), EPERM);
    EXPECT_EQ(error_of_opening("/dev/null", O_WRONLY), EPERM);
    const std::filesystem::path other = folder_ / "other";
    EXPECT_EQ(error_in_child([&] { return creat(other.c_str(), 0600); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return truncate(there.c_str(), 0); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return unlink(there.c_str()); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return rename(there.c_str(), other.c_str()); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return mkdir(other.c_str(), 0700); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return link(there.c_str(), other.c_str()); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return symlink(there.c_str(), other.c_str()); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return chmod(there.c_str(), 0777); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return mkfifo(other.c_str(), 0600); }), EPERM);
    EXPECT_EQ(read_input_file(there, {100, ""}), "old");
}

TEST_F(Escape, OnlyWhatItIsGivenIsRead) {
    NEEDS_LANDLOCK();
    std::filesystem::create_directories(folder_ / "below");
    EXPECT_EQ(error_of_opening(write("a", "x"), O_RDONLY), 0);
    EXPECT_EQ(error_of_opening(write("below/a", "x"), O_RDONLY), 0);
    EXPECT_EQ(error_of_opening("/etc/passwd", O_RDONLY), EACCES);
    EXPECT_EQ(error_of_opening("/etc", O_RDONLY | O_DIRECTORY), EACCES);
    EXPECT_EQ(error_of_opening("/proc/self/environ", O_RDONLY), EACCES);
    std::filesystem::create_symlink("/etc/passwd", folder_ / "link");
    EXPECT_EQ(error_of_opening(folder_ / "link", O_RDONLY), EACCES);
    EXPECT_EQ(error_of_opening(folder_ / "../../etc/passwd", O_RDONLY), EACCES);
}

TEST_F(Escape, NoSocketIsMade) {
    NEEDS_SECCOMP();
    for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK})
        EXPECT_EQ(error_in_child([&] { return socket(family, SOCK_DGRAM, 0); }), EPERM) << family;
    EXPECT_EQ(error_in_child([] {
                  std::array<int, 2> ends{};
                  return socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data());
              }),
              EPERM);
    sockaddr_in where{};
    where.sin_family = AF_INET;
    EXPECT_EQ(
        error_in_child([&] { return connect(0, reinterpret_cast<const sockaddr*>(&where), sizeof where); }),
        EPERM);
    EXPECT_EQ(
        error_in_child([&] { return bind(0, reinterpret_cast<const sockaddr*>(&where), sizeof where); }),
        EPERM);
    // To an address, which a connected socket needs none for.
    EXPECT_EQ(error_in_child([&] {
                  return sendto(0, "x", 1, 0, reinterpret_cast<const sockaddr*>(&where), sizeof where);
              }),
              EPERM);
}

// No kernel is needed for that.
TEST_F(Escape, TheParentsDescriptorsAreGone) {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    const int high = fcntl(ends[0], F_DUPFD, 500);
    const Fd file(open("/etc/passwd", O_RDONLY | O_CLOEXEC));
    for (const int fd : {ends[0], ends[1], high, file.get()}) {
        EXPECT_EQ(error_in_child([&] { return ::write(fd, "x", 1); }), EBADF) << fd;
        EXPECT_EQ(error_in_child([&] { return fcntl(fd, F_GETFD); }), EBADF) << fd;
    }
    for (const int fd : {ends[0], ends[1], high}) close(fd);
}

TEST_F(Escape, NoProgramIsStartedAndNoProcessTouched) {
    NEEDS_SECCOMP();
    EXPECT_EQ(error_in_child([] {
                  char name[] = "/bin/true";
                  std::array<char*, 2> arguments{name, nullptr};
                  return execve(name, arguments.data(), environ);
              }),
              EPERM);
    EXPECT_EQ(error_in_child([] { return syscall(SYS_fork); }), EPERM);
    EXPECT_EQ(error_in_child([] { return syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, 0); }),
              EPERM);
    EXPECT_EQ(error_in_child([] { return syscall(SYS_clone3, nullptr, 0); }), ENOSYS);
    const pid_t own = getpid();
    EXPECT_EQ(error_in_child([&] { return kill(own, 0); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return syscall(SYS_tgkill, own, own, 0); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return ptrace(PTRACE_ATTACH, own, nullptr, nullptr); }), EPERM);
    EXPECT_EQ(error_in_child([&] { return process_vm_readv(own, nullptr, 0, nullptr, 0, 0); }), EPERM);
    rlimit limit{};
    EXPECT_EQ(error_in_child([&] { return prlimit(own, RLIMIT_CPU, nullptr, &limit); }), EPERM);
}

TEST_F(Escape, NothingElseThatLeadsOut) {
    NEEDS_SECCOMP();
    EXPECT_EQ(error_in_child([] {
                  return mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
                                 MAP_FAILED
                             ? -1
                             : 0;
              }),
              EPERM);
    EXPECT_EQ(error_in_child([] {
                  void* const page =
                      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                  return mprotect(page, 4096, PROT_READ | PROT_EXEC);
              }),
              EPERM);
    for (const long call :
         {SYS_memfd_create, SYS_io_uring_setup, SYS_bpf, SYS_userfaultfd, SYS_mount, SYS_unshare, SYS_setns,
          SYS_chroot, SYS_perf_event_open, SYS_keyctl, SYS_personality, SYS_pidfd_open, SYS_shmget, SYS_ioctl,
          SYS_setxattr, SYS_utimensat})
        EXPECT_EQ(error_in_child([&] { return syscall(call, 0, 0, 0, 0, 0); }), EPERM) << call;
}

// Threads, memory and time are what it works with.
TEST_F(Escape, WorkGoesOn) {
    const std::array readable{folder_};
    write("a", "some words");
    ConfinedResult result = run_confined("f", {256u << 20, 10, 5}, readable, [&](ConfinedOutput& out) {
        int sum = 0;
        std::thread([&] { sum = 7; }).join();
        allow_more(1 << 20, 1);
        out.value(sum);
        out.text(read_input_file(folder_ / "a", {100, ""}));
        out.list(std::span<const char>(std::vector<char>(32 << 20, 'x')));
    });
    EXPECT_EQ(result.value<int>(), 7);
    EXPECT_EQ(result.text(), "some words");
    EXPECT_EQ(result.list<char>().size(), 32u << 20);
}

TEST_F(Escape, AllButTheKeptDescriptorsAreClosed) {
    const pid_t child = fork();
    if (child == 0) {
        const int low = open("/dev/null", O_RDONLY), high = fcntl(low, F_DUPFD, 300);
        close_all_but(std::array{high, 1});
        const bool good = fcntl(high, F_GETFD) >= 0 && fcntl(1, F_GETFD) >= 0 && fcntl(0, F_GETFD) < 0 &&
                          fcntl(2, F_GETFD) < 0 && fcntl(low, F_GETFD) < 0;
        _exit(good ? 0 : 1);
    }
    int status = 1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace hilcam
