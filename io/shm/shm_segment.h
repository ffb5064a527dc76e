#pragma once
// A POSIX shared memory that this program writes. A lock on it holds the name while the program lives.
//
// The kernel releases the lock (flock) however the program ends. A memory made by hilcam without a lock is
// therefore left from a killed program: it is replaced, and its readers see that it has ended. A memory that
// another program has locked, or that hilcam has not made, is refused. A memory that begins with zeros counts
// as one whose writer was killed while it started. All memory is allocated at the start, so that no later
// write of a frame can fail.

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

    // Creates the memory, all bytes 0. Throws InputError when the name is taken, DeviceError when there is no
    // room. Owner thread.
    void create(const std::string& name, std::size_t bytes);
    // Removes the name if it is still this memory's; programs that have mapped the memory keep it.
    // Idempotent. Owner thread.
    void remove() noexcept;

    std::byte* data() const { return data_; }
    ShmHeader& header() const { return *reinterpret_cast<ShmHeader*>(data_); }

  private:
    std::string path_;  // "/hilcam", as for shm_open()
    Fd fd_;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace hilcam
