#pragma once
// Hands the newest value from one thread to any number of others without a lock (latest.h has one reader).
// The writer never waits; a reader repeats its copy only if kSlots values were written during it. One writer
// at a time: several need a mutex. T is copied whole, in words.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace hilcam {

template <class T>
class SharedLatest {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint64_t) == 0);

  public:
    explicit SharedLatest(const T& initial) { write(initial); }

    void write(const T& value) {
        const std::uint64_t turn = newest_.load(std::memory_order_relaxed) + 1;
        Slot& slot = slots_[turn % kSlots];
        const Words words = std::bit_cast<Words>(value);
        for (std::size_t i = 0; i < words.size(); ++i) slot[i].store(words[i], std::memory_order_release);
        newest_.store(turn, std::memory_order_release);
    }
    // Any thread, the loop too.
    T read() const {
        while (true) {
            const std::uint64_t turn = newest_.load(std::memory_order_acquire);
            const Slot& slot = slots_[turn % kSlots];
            Words words;
            for (std::size_t i = 0; i < words.size(); ++i) words[i] = slot[i].load(std::memory_order_acquire);
            // If a word above is from the slot's next value, the number read here is at least that of the
            // value before it.
            if (newest_.load(std::memory_order_relaxed) - turn < kSlots - 1) return std::bit_cast<T>(words);
        }
    }

  private:
    static constexpr std::uint64_t kSlots = 64;
    using Words = std::array<std::uint64_t, sizeof(T) / sizeof(std::uint64_t)>;
    using Slot = std::array<std::atomic<std::uint64_t>, sizeof(T) / sizeof(std::uint64_t)>;
    std::array<Slot, kSlots> slots_{};
    alignas(64) std::atomic<std::uint64_t> newest_{0};
};

}  // namespace hilcam
