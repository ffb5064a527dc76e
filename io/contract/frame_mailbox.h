#pragma once
// Hands frames from the loop to a sink's own thread, through a ring of preallocated copies. The loop never
// waits: when the ring is full, the new frame is dropped and counted.

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <vector>

#include "io/contract/frame_sink.h"
#include "io/contract/loss_count.h"

namespace hilcam {

class FrameMailbox {
  public:
    struct Item {
        DnImage frame;
        FrameRecord record;
    };

    // width, height: of the largest frame.
    FrameMailbox(int width, int height, std::size_t slots) : items_(slots) {
        for (Item& item : items_) item.frame = DnImage(width, height);
    }
    // Opens the mailbox: a thread takes frames from here until close(). Owner thread.
    void open() { open_.store(true, std::memory_order_relaxed); }
    // Copies a frame into the ring; false when it was dropped. Loop, one thread.
    bool put(const DnImage& frame, const FrameRecord& record) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == items_.size()) {
            dropped_.add(record.id);
            return false;
        }
        Item& item = items_[head % items_.size()];
        item.frame.reshape(frame.width(), frame.height());
        std::copy(frame.all().begin(), frame.all().end(), item.frame.all().begin());
        item.record = record;
        head_.store(head + 1, std::memory_order_release);
        ready_.release();
        return true;
    }
    // Waits for a frame and returns it; nullptr after close(). The item stays valid until done(). Sink's
    // thread.
    const Item* wait() {
        ready_.acquire();
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        return tail == head_.load(std::memory_order_acquire) ? nullptr : &items_[tail % items_.size()];
    }
    void done() { tail_.fetch_add(1, std::memory_order_release); }
    // Closes the mailbox. wait() still returns the frames in the ring before it returns nullptr.
    void close() {
        open_.store(false, std::memory_order_relaxed);
        ready_.release();
    }
    // True when the next put() finds a free place, and while the mailbox is closed. Loop.
    bool has_room() const {
        if (!open_.load(std::memory_order_relaxed)) return true;
        return head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire) < items_.size();
    }
    std::uint64_t dropped() const { return dropped_.count(); }
    // Returns the id of the first frame that was dropped; 0: none was.
    std::uint64_t first_dropped() const { return dropped_.first(); }

  private:
    std::vector<Item> items_;
    std::atomic<std::size_t> head_{0}, tail_{0};
    LossCount dropped_;
    std::atomic<bool> open_{false};
    std::counting_semaphore<> ready_{0};
};

}  // namespace hilcam
