#pragma once
// A ring of frames between the loop, which writes them, and the sender, which sends them and keeps them for
// resends. All memory is allocated beforehand. Neither waits for the other: each skips a slot that the other
// uses.

#include <atomic>
#include <cstdint>
#include <vector>

#include "io/gige/stream/gige_packets.h"

namespace hilcam {

// The orders of the control side, and the acquisition that they belong to. That number never recurs, unlike
// the device's own count, which a reset sets back. 0: none yet.
struct GigeStreamNow {
    GigeStreamState state;
    std::uint64_t acquisition = 0;
    std::uint64_t first_frame = 0;  // the camera's frames before it had begun before the acquisition did
};

class GigeSlot {
  public:
    GigeFrame frame;  // its payload is in `bytes`
    FrameRecord record;
    std::uint64_t acquisition = 0;
    bool last = false;         // the last frame of a counted acquisition
    std::uint64_t resent = 0;  // number of its packets that clients asked for again, since it was sent
    std::vector<std::uint8_t> bytes;

  private:
    friend class GigeRing;
    enum class Use : std::uint8_t { kKept, kWriting, kWaiting, kReading };
    std::atomic<Use> use_{Use::kKept};
    std::uint64_t turn_ = 0;  // counts the writes to all slots
};

class GigeRing {
  public:
    // Frames that wait to be sent or are being sent; a further one is dropped.
    static constexpr std::size_t kMaxWaiting = 3;
    // Number of frames that are always kept for resends.
    static constexpr std::size_t kMinKept = 8;
    static constexpr std::size_t kMinSlots = kMinKept + kMaxWaiting + 1;

    GigeRing(std::size_t slots, std::size_t bytes_each);

    // Returns the slot with the oldest frame, to be overwritten; null: the sender is too far behind. Loop.
    GigeSlot* claim() noexcept;
    // Returns how many frames wait to be sent or are being sent. Loop.
    std::size_t waiting() const noexcept {
        return static_cast<std::size_t>(written_.load(std::memory_order_relaxed) -
                                        sent_.load(std::memory_order_acquire));
    }
    void publish(GigeSlot& slot) noexcept;

    // Returns the next frame to send, or null; done() must follow when it has been sent. Sender.
    GigeSlot* next() noexcept;
    void done(GigeSlot& slot) noexcept;
    // Returns how many frames follow those that next() returned. Sender.
    std::size_t queued() const noexcept {
        return static_cast<std::size_t>(written_.load(std::memory_order_acquire) - taken_);
    }
    // Returns a frame that was sent, to be given back with keep(). Null when it is not here; oldest_block is
    // then the oldest one of that acquisition that is, 0: none. Sender.
    GigeSlot* find(std::uint64_t acquisition, std::uint64_t block, std::uint64_t& oldest_block) noexcept;
    void keep(GigeSlot& slot) noexcept;

  private:
    using Use = GigeSlot::Use;
    std::vector<GigeSlot> slots_;
    std::uint64_t turns_ = 0;  // the loop's
    std::array<GigeSlot*, 2 * kMaxWaiting> waiting_{};
    std::atomic<std::uint64_t> written_{0}, sent_{0};
    std::uint64_t taken_ = 0;  // the sender's
};

}  // namespace hilcam
