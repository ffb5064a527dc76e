#pragma once
// Tells what has become of frames' files: from the output that writes them to the truth, whose line of a frame says when
// its file was lost. It knows the newest 1024 frames that were to be written.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hilcam {

class FrameFates {
  public:
    enum class Fate : std::uint8_t { kNoFile, kPending, kWritten, kLost };

    // on_settled: is called by settle(). Owner thread, before frames come.
    void listen(std::function<void()> on_settled) { on_settled_ = std::move(on_settled); }
    // A frame's file is to be written. Loop, one thread, frames in their order.
    void expect(std::uint64_t frame) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        Entry& entry = entries_[head % entries_.size()];
        entry.fate.store(Fate::kPending, std::memory_order_relaxed);
        entry.frame.store(frame, std::memory_order_relaxed);
        head_.store(head + 1, std::memory_order_release);
    }
    // The file of an expected frame is written, or is lost. Loop, and the writing thread.
    void settle(std::uint64_t frame, bool written) {
        if (const std::size_t at = find(frame); at < entries_.size())
            entries_[at].fate.store(written ? Fate::kWritten : Fate::kLost, std::memory_order_release);
        if (on_settled_) on_settled_();
    }
    // Any thread.
    Fate of(std::uint64_t frame) const {
        const std::size_t at = find(frame);
        return at < entries_.size() ? entries_[at].fate.load(std::memory_order_acquire) : Fate::kNoFile;
    }

  private:
    struct Entry {
        std::atomic<std::uint64_t> frame{0};
        std::atomic<Fate> fate{Fate::kNoFile};
    };

    // The newest first; the number of entries when there is none.
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
};

}  // namespace hilcam
