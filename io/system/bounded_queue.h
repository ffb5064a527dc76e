#pragma once
// A queue of fixed length from any number of threads to one, without locks, allocation or waiting. After D.
// Vyukov, "Bounded MPMC queue" (1024cores.net, 2010): each cell holds the turn in which it may be written or
// read.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hilcam {

template <class T, std::size_t kLength>
class BoundedQueue {
    static_assert((kLength & (kLength - 1)) == 0, "turns wrap with the length");

  public:
    BoundedQueue() {
        for (std::size_t i = 0; i < kLength; ++i) cells_[i].turn.store(i, std::memory_order_relaxed);
    }
    // Returns false when the queue is full. Any thread.
    bool push(const T& value) noexcept {
        std::size_t at = head_.load(std::memory_order_relaxed);
        while (true) {
            Cell& cell = cells_[at % kLength];
            const std::size_t turn = cell.turn.load(std::memory_order_acquire);
            if (turn == at) {
                if (!head_.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) continue;
                cell.value = value;
                cell.turn.store(at + 1, std::memory_order_release);
                return true;
            }
            if (turn < at) return false;
            at = head_.load(std::memory_order_relaxed);
        }
    }
    // Returns false when the queue is empty. One thread.
    bool pop(T& value) noexcept {
        Cell& cell = cells_[tail_ % kLength];
        if (cell.turn.load(std::memory_order_acquire) != tail_ + 1) return false;
        value = cell.value;
        cell.turn.store(tail_ + kLength, std::memory_order_release);
        ++tail_;
        return true;
    }

  private:
    struct Cell {
        std::atomic<std::size_t> turn;
        T value{};
    };
    std::array<Cell, kLength> cells_;
    alignas(64) std::atomic<std::size_t> head_{0};
    alignas(64) std::size_t tail_ = 0;
};

}  // namespace hilcam
