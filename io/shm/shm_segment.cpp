#include "io/shm/shm_segment.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <cstring>

#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr mode_t kReadByAll = 0644;
constexpr int kTries = 8;  // other programs may start and end meanwhile
constexpr std::int64_t kReadersLook_ns = 1'000'000;

std::string megabytes(double bytes) {
    return std::to_string(static_cast<std::int64_t>(bytes / 1e6 + 0.5)) + " MB";
}

// A reader that tests whether the writer lives holds a lock for a moment (tools/client/hilcam_shm.h).
bool is_held_by_a_writer(const Fd& memory) {
    for (int i = 0; i < kTries; ++i) {
        if (flock(memory.get(), LOCK_EX | LOCK_NB) == 0) return false;
        sleep_until_monotonic_ns(monotonic_ns() + kReadersLook_ns);
    }
    return true;
}

// Returns false also when there is no such name.
bool names(const std::string& path, const Fd& memory) {
    const Fd found(shm_open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC, 0));
    struct stat theirs {};
    struct stat ours {};
    return found && fstat(found.get(), &theirs) == 0 && fstat(memory.get(), &ours) == 0 &&
           theirs.st_dev == ours.st_dev && theirs.st_ino == ours.st_ino;
}

// Removes a memory that a killed program has left, and notifies its readers. Throws InputError when it is
// another's.
void take_over(const std::string& path) {
    const std::string key = "outputs.shm.name: found " + in_quotes(path.substr(1)) + ", ";
    const Fd old(shm_open(path.c_str(), O_RDWR | O_CLOEXEC, 0));
    if (!old) {
        if (errno == ENOENT) return;  // it was removed meanwhile
        throw InputError(key + "a shared memory of another user; accepted: a name that is free");
    }
    struct stat facts {};
    fstat(old.get(), &facts);
    void* const mapped =
        static_cast<std::size_t>(facts.st_size) < sizeof(ShmHeader)
            ? MAP_FAILED
            : mmap(nullptr, sizeof(ShmHeader), PROT_READ | PROT_WRITE, MAP_SHARED, old.get(), 0);
    auto* const header = mapped == MAP_FAILED ? nullptr : static_cast<ShmHeader*>(mapped);
    const bool is_ours = facts.st_size == 0 || (header && (header->magic == kShmMagic || header->magic == 0));
    const bool is_held = is_held_by_a_writer(old);
    const std::uint32_t pid = header ? header->writer_pid : 0;
    if (is_ours && !is_held) {
        if (header) header->ended.store(1);
        shm_unlink(path.c_str());
    }
    if (header) munmap(mapped, sizeof(ShmHeader));
    if (!is_ours)
        throw InputError(key + "a shared memory that hilcam has not made; accepted: a name that is free");
    if (is_held)
        throw InputError(key + "which process " + std::to_string(pid) +
                         " writes; accepted: a name of its own for each camera");
}

}  // namespace

void ShmSegment::create(const std::string& name, std::size_t bytes) {
    remove();
    path_.assign(1, '/').append(name);
    for (int i = 0; i < kTries && !fd_; ++i) {
        fd_ = Fd(shm_open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kReadByAll));
        if (fd_) {
            // A program that found it before it was locked may have treated it as abandoned.
            struct stat facts {};
            if (flock(fd_.get(), LOCK_EX | LOCK_NB) == 0 && fstat(fd_.get(), &facts) == 0 &&
                facts.st_nlink > 0)
                break;
            fd_.reset();
            continue;
        }
        if (errno != EEXIST) {
            const std::string why = std::strerror(errno);
            path_.clear();
            throw DeviceError("outputs.shm: /dev/shm/" + name + " cannot be made: " + why);
        }
        try {
            take_over(path_);
        } catch (...) {
            path_.clear();  // another program's name stays
            throw;
        }
    }
    if (!fd_) {
        path_.clear();
        throw DeviceError("outputs.shm: /dev/shm/" + name + " is taken by others again and again");
    }
    fchmod(fd_.get(), kReadByAll);  // the shell's mask took away from it
    const int full = ftruncate(fd_.get(), static_cast<off_t>(bytes)) != 0
                         ? errno
                         : posix_fallocate(fd_.get(), 0, static_cast<off_t>(bytes));
    if (full != 0) {
        struct statvfs room {};
        fstatvfs(fd_.get(), &room);
        remove();
        throw DeviceError("outputs.shm: /dev/shm has no room for " + megabytes(static_cast<double>(bytes)) +
                          " (" + std::strerror(full) + "), " +
                          megabytes(static_cast<double>(room.f_bavail) * static_cast<double>(room.f_frsize)) +
                          " are free: fewer outputs.shm.slots, or a larger /dev/shm");
    }
    void* const mapped =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd_.get(), 0);
    if (mapped == MAP_FAILED) {
        const std::string why = std::strerror(errno);
        remove();
        throw DeviceError("outputs.shm: " + megabytes(static_cast<double>(bytes)) +
                          " cannot be mapped: " + why);
    }
    data_ = static_cast<std::byte*>(mapped);
    bytes_ = bytes;
}

void ShmSegment::remove() noexcept {
    if (data_) munmap(data_, bytes_);
    data_ = nullptr, bytes_ = 0;
    // The name may have been removed, and taken by another program.
    if (!path_.empty() && names(path_, fd_)) shm_unlink(path_.c_str());
    path_.clear();
    fd_.reset();
}

}  // namespace hilcam
