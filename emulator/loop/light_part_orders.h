#pragma once
// Orders that make the loop split its next frame's light into parts, one order at a time.
//
// A client that orders allocates a buffer and waits; the loop fills the buffer and allocates nothing. Without
// an order a frame costs one relaxed load. The loop owns the buffer while the state is kInWork; the client
// owns it otherwise. A client that gives up before the loop begins withdraws its order. If it gives up later,
// the loop still finishes the frame, and the next client gets that frame or frees its memory.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "io/contract/light_part_source.h"
#include "io/system/timed_semaphore.h"
#include "render/frame/parts_buffer.h"

namespace hilcam {

class LightPartOrders : public LightPartSource {
  public:
    // Makes buffers and the shown pictures, on the threads of the clients.
    struct Maker {
        std::function<std::unique_ptr<PartsBuffer>(LightPart part)> make_buffer;
        // light: image of the part in that frame.
        std::function<DnImage(const RadianceImage& light, const FrameRecord& record)> numbers_of;
    };

    // refusal: why frames cannot be split; empty: they can.
    explicit LightPartOrders(std::string refusal) : refusal_(std::move(refusal)) {}
    // Sets the maker before the threads start. Without a maker all orders are refused.
    void serve(Maker maker) { maker_ = std::move(maker); }

    std::string refusal() const override { return refusal_; }
    std::shared_ptr<const Picture> wait_for(const Wish& wish, std::chrono::nanoseconds patience) override;

    // An order that the loop works on.
    struct Order {
        std::unique_ptr<PartsBuffer> buffer;
        LightPart part{};
        bool with_truth = false;
        FrameRecord record;  // record of the frame, when it is done
    };
    // Returns the order for the frame that begins now, which done() must complete; null: no order. Loop, one
    // thread.
    Order* begin() noexcept {
        if (state_.load(std::memory_order_relaxed) != State::kWanted) return nullptr;
        State wanted = State::kWanted;
        return state_.compare_exchange_strong(wanted, State::kInWork, std::memory_order_acquire) ? &order_
                                                                                                 : nullptr;
    }
    // The buffer now holds this frame's light. Loop.
    void done(const FrameRecord& record) noexcept {
        order_.record = record;
        state_.store(State::kDone, std::memory_order_release);
        news_.release();
    }
    // No more frames will come: wakes waiting clients with an answer. Loop.
    void close() noexcept {
        closed_.store(true, std::memory_order_release);
        news_.release();
    }

  private:
    using Clock = std::chrono::steady_clock;
    enum class State : std::uint8_t { kIdle, kWanted, kInWork, kDone };

    class Turn;
    bool has(const Wish& wish) const;
    void carry_out(const Wish& wish, Clock::time_point deadline);
    bool wait_until_done(Clock::time_point deadline);
    void take_result();

    std::string refusal_;
    Maker maker_;
    std::atomic<State> state_{State::kIdle};
    std::atomic<bool> closed_{false};
    TimedSemaphore news_;  // raised by the loop when an order is done, or no more will be
    Order order_;          // owned by the loop in state kInWork, otherwise by the client that has the turn

    std::mutex mutex_;  // guards the members below
    std::condition_variable turns_;
    bool has_turn_ = false;  // true: a client has it
    std::shared_ptr<const Picture> newest_;
    LightPart newest_part_{};
};

}  // namespace hilcam
