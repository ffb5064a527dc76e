#pragma once
// Orders to the loop to take its next frame apart into the parts of its light, one at a time.
//
// The client of an order allocates its buffer and waits; the loop fills the buffer and allocates nothing. While there is no order, a
// frame costs one relaxed load. The loop owns the buffer while the state is kInWork, and the client owns it at all other times. A client
// that gives up before the loop begins withdraws its order. If it gives up later, the loop still finishes the frame, and the next client
// gets that frame or frees its memory.

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
    // The maker makes what a frame is taken apart into, and what is shown of it, on the threads of those who ask.
    struct Maker {
        std::function<std::unique_ptr<PartsBuffer>(LightPart part)> make_buffer;
        // light: the part's image of that frame.
        std::function<DnImage(const RadianceImage& light, const FrameRecord& record)> numbers_of;
    };

    // refusal: why frames cannot be taken apart; empty: they can.
    explicit LightPartOrders(std::string refusal) : refusal_(std::move(refusal)) {}
    // Sets the maker, before the threads start; without it no order is taken.
    void serve(Maker maker) { maker_ = std::move(maker); }

    std::string refusal() const override { return refusal_; }
    std::shared_ptr<const Picture> wait_for(const Wish& wish, std::chrono::nanoseconds patience) override;

    // An order that the loop has in work.
    struct Order {
        std::unique_ptr<PartsBuffer> buffer;
        LightPart part{};
        bool with_truth = false;
        FrameRecord record;  // the frame, when it is done
    };
    // Gives the order that the frame which begins now is to carry out, to be followed by done(); null: nobody asks. Loop, one thread.
    Order* begin() noexcept {
        if (state_.load(std::memory_order_relaxed) != State::kWanted) return nullptr;
        State wanted = State::kWanted;
        return state_.compare_exchange_strong(wanted, State::kInWork, std::memory_order_acquire) ? &order_
                                                                                                 : nullptr;
    }
    // Its buffer holds this frame's light. Loop.
    void done(const FrameRecord& record) noexcept {
        order_.record = record;
        state_.store(State::kDone, std::memory_order_release);
        news_.release();
    }
    // No frame comes any more: who waits is answered. Loop.
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
    TimedSemaphore news_;  // the loop's: an order is done, or none will be any more
    Order order_;  // the loop owns it while the state is kInWork; else the client that has the turn does

    std::mutex mutex_;  // guards what follows
    std::condition_variable turns_;
    bool has_turn_ = false;  // somebody has
    std::shared_ptr<const Picture> newest_;
    LightPart newest_part_{};
};

}  // namespace hilcam
