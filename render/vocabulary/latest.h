#pragma once
// Hands the newest value from one thread to another without a lock: a triple buffer. The writer always has a
// free slot and the reader always has a complete value. A slow reader skips values; a slow writer never
// blocks the reader. One writer thread (several need a mutex of their own), one reader thread. T is copied
// whole.

#include <array>
#include <atomic>
#include <cstdint>

namespace hilcam {

template <class T>
class Latest {
  public:
    explicit Latest(const T& initial = T{}) { slots_.fill(Slot{initial}); }

    // Writer. Wait-free.
    void write(const T& value) {
        slots_[write_].value = value;
        write_ = exchange_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_acq_rel) &
                 kIndex;
    }
    // Reader. Wait-free. The reference stays valid until the next read().
    const T& read() {
        if (exchange_.load(std::memory_order_relaxed) & kFresh)
            read_ = exchange_.exchange(read_, std::memory_order_acq_rel) & kIndex;
        return slots_[read_].value;
    }

  private:
    static constexpr std::uint8_t kFresh = 0x80;
    static constexpr std::uint8_t kIndex = 0x03;
    struct alignas(64) Slot {
        T value;
    };
    std::array<Slot, 3> slots_;
    alignas(64) std::atomic<std::uint8_t> exchange_{2};
    alignas(64) std::uint8_t write_ = 0;
    alignas(64) std::uint8_t read_ = 1;
};

}  // namespace hilcam
