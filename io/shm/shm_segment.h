#pragma once
// A POSIX shared memory that this program writes, and whose name it holds by a lock while it lives.
//
// The lock (flock) is the kernel's and goes with the program, however that ends: a memory of hilcam's that
// nobody holds was left by a killed one and is replaced. Its readers are told that it has ended. What another
// program holds, or hilcam has not made, is refused. All of the memory is taken at once, so that no write of a
// frame can fail later. A memory that begins with zeros counts as one whose writer was killed while it started.

#include <string>

#include "io/shm/shm_ring.h"
#include "io/system/fd.h"

namespace hilcam {

class ShmSegment {
  public:
    ShmSegment() = default;
    ~ShmSegment() { remove(); }
    ShmSegment(const ShmSegment&) = delete;
    ShmSegment& operator=(const ShmSegment&) = delete;

    // Owner thread. All bytes are 0. Throws InputError when the name is another's, DeviceError when there is no
    // room.
    void create(const std::string& name, std::size_t bytes);
    // Takes the name away where it is still this memory's; who has the memory mapped keeps it. Idempotent. Owner
    // thread.
    void remove() noexcept;

    std::byte* data() const { return data_; }
    ShmHeader& header() const { return *reinterpret_cast<ShmHeader*>(data_); }

  private:
    std::string path_;  // "/hilcam", as shm_open has it
    Fd fd_;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace hilcam
