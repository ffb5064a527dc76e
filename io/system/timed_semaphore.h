#pragma once
// A counting semaphore with waits that end on time: a futex with a deadline on the monotonic clock.
// std::counting_semaphore::try_acquire_until of libstdc++ 12 yields and sleeps before it asks the kernel,
// each time for half as long as it has waited, and ends 6 to 24 ms late on a loaded machine. glibc's
// sem_clockwait() would do, but ThreadSanitizer does not know it. Linux only.

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

#include "io/system/monotonic.h"

namespace hilcam {

class TimedSemaphore {
  public:
    // Loop, any thread.
    void release() {
        count_.fetch_add(1, std::memory_order_release);
        call(FUTEX_WAKE, 1, nullptr);
    }
    // Returns true when it has taken one. Loop, any thread.
    bool try_acquire() {
        std::uint32_t count = count_.load(std::memory_order_relaxed);
        while (count > 0)
            if (count_.compare_exchange_weak(count, count - 1, std::memory_order_acquire,
                                             std::memory_order_relaxed))
                return true;
        return false;
    }
    // Returns true when it has taken one, at once if possible; false at the deadline.
    bool try_acquire_until(std::int64_t monotonic_ns_then) {
        while (!try_acquire()) {
            if (monotonic_ns() >= monotonic_ns_then) return false;
            const timespec then = timespec_of(monotonic_ns_then);
            // Returns here when a release comes before the sleep, on a signal and at the deadline.
            call(FUTEX_WAIT_BITSET, 0, &then);
        }
        return true;
    }
    bool try_acquire_for(std::int64_t ns) { return try_acquire_until(monotonic_ns() + ns); }
    // Takes all; for an owner that looks at everything that they announce in one go.
    void take_all() { count_.exchange(0, std::memory_order_acquire); }

  private:
    static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));
    std::atomic<std::uint32_t> count_{0};

    void call(int operation, std::uint32_t value, const timespec* then) {
        syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&count_), operation | FUTEX_PRIVATE_FLAG, value,
                then, nullptr, FUTEX_BITSET_MATCH_ANY);
    }
};

}  // namespace hilcam
