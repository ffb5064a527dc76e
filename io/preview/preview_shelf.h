#pragma once
// Keeps what the preview's page asks for later: frames that a viewer has frozen, and lines of truth. Both are
// bounded; the oldest is dropped first. Any thread but the loop.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "io/preview/preview_slot.h"

namespace hilcam {

class PreviewShelf {
  public:
    using Frame = std::shared_ptr<const PreviewSlot::Frame>;
    // A frozen frame stays until this many others have been frozen.
    static constexpr std::size_t kMaxFrames = 4;
    // Few lines suffice, because a frame's truth is requested right after the frame.
    static constexpr std::size_t kMaxLines = 8;

    void keep(const PreviewSlot::Frame& frame) {
        auto copy = std::make_shared<const PreviewSlot::Frame>(frame);
        const std::lock_guard lock(mutex_);
        std::erase_if(frames_, [&](const Frame& f) { return f->record.id == frame.record.id; });
        if (frames_.size() == kMaxFrames) frames_.pop_front();
        frames_.push_back(std::move(copy));
    }
    // Returns the frame; null when it is not here or was dropped.
    Frame find(std::uint64_t id) const {
        const std::lock_guard lock(mutex_);
        for (const Frame& frame : frames_)
            if (frame->record.id == id) return frame;
        return nullptr;
    }

    void put_line(std::uint64_t frame, std::string line) {
        {
            const std::lock_guard lock(mutex_);
            if (lines_.size() == kMaxLines) lines_.pop_front();
            lines_.emplace_back(frame, std::move(line));
        }
        news_.notify_all();
    }
    // Waits for a frame's line; empty when it does not come in time.
    std::string line_of(std::uint64_t frame, std::chrono::nanoseconds patience) {
        std::unique_lock lock(mutex_);
        std::string found;
        news_.wait_for(lock, patience, [&] {
            const auto line =
                std::find_if(lines_.begin(), lines_.end(), [&](const auto& l) { return l.first == frame; });
            if (line != lines_.end()) found = line->second;
            return line != lines_.end();
        });
        return found;
    }

  private:
    mutable std::mutex mutex_;
    std::condition_variable news_;
    std::deque<Frame> frames_;
    std::deque<std::pair<std::uint64_t, std::string>> lines_;
};

}  // namespace hilcam
