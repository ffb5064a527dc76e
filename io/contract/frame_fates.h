#pragma once
// A record of what became of frames' files. The output that writes them reports here, and a frame's line of
// truth says whether its file was lost. The record holds the newest 1024 frames that were to be written.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

namespace hilcam {

class FrameFates {
  public:
    enum class Fate : std::uint8_t { kNoFile, kPending, kWritten, kLost };

    // Returns this record for the one output that it is about, which is the first that asks; null for the
    // others. Owner thread.
    FrameFates* claim() { return std::exchange(claimed_, true) ? nullptr : this; }
    // Sets the function that settle() calls. Owner thread, before frames come.
    void listen(std::function<void()> on_settled) { on_settled_ = std::move(on_settled); }
    // Says that a file of this frame will be written. Loop, one thread, frames in order.
    void expect(std::uint64_t frame) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        Entry& entry = entries_[head % entries_.size()];
        entry.fate.store(Fate::kPending, std::memory_order_relaxed);
        entry.frame.store(frame, std::memory_order_relaxed);
        head_.store(head + 1, std::memory_order_release);
    }
    // Says that the file of an expected frame is written, or is lost. Loop, and the writing thread.
    void settle(std::uint64_t frame, bool written) {
        if (const std::size_t at = find(frame); at < entries_.size())
            entries_[at].fate.store(written ? Fate::kWritten : Fate::kLost, std::memory_order_release);
        if (on_settled_) on_settled_();
    }
    // Returns the fate of a frame's file. Any thread.
    Fate of(std::uint64_t frame) const {
        const std::size_t at = find(frame);
        return at < entries_.size() ? entries_[at].fate.load(std::memory_order_acquire) : Fate::kNoFile;
    }

  private:
    struct Entry {
        std::atomic<std::uint64_t> frame{0};
        std::atomic<Fate> fate{Fate::kNoFile};
    };

    // Returns the index of the newest entry of that frame; the number of entries when there is none.
    std::size_t find(std::uint64_t frame) const {
        const std::size_t head = head_.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < entries_.size() && i < head; ++i) {
            const std::size_t at = (head - 1 - i) % entries_.size();
            if (entries_[at].frame.load(std::memory_order_relaxed) == frame) return at;
        }
        return entries_.size();
    }

    std::array<Entry, 1024> entries_;
    std::atomic<std::size_t> head_{0};
    std::function<void()> on_settled_;
    bool claimed_ = false;
};

}  // namespace hilcam
