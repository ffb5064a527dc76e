#include "emulator/loop/light_part_orders.h"

#include <utility>

namespace hilcam {

// Gives a client the turn while others wait; the lock is open meanwhile.
class LightPartOrders::Turn {
  public:
    Turn(LightPartOrders& orders, std::unique_lock<std::mutex>& lock) : orders_(orders), lock_(lock) {
        orders_.has_turn_ = true;
        lock_.unlock();
    }
    ~Turn() {
        lock_.lock();
        orders_.has_turn_ = false;
        orders_.turns_.notify_all();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    LightPartOrders& orders_;
    std::unique_lock<std::mutex>& lock_;
};

std::shared_ptr<const LightPartSource::Picture> LightPartOrders::wait_for(const Wish& wish,
                                                                          std::chrono::nanoseconds patience) {
    if (!refusal_.empty() || !maker_.make_buffer) return nullptr;
    const auto deadline = Clock::now() + patience;
    std::unique_lock lock(mutex_);
    turns_.wait_until(lock, deadline, [&] { return !has_turn_ || has(wish); });
    if (!has(wish) && !has_turn_) {
        const Turn turn(*this, lock);
        carry_out(wish, deadline);
    }
    return has(wish) ? newest_ : nullptr;
}

// Called under the lock.
bool LightPartOrders::has(const Wish& wish) const {
    return newest_ && newest_part_ == wish.part && newest_->record.id != wish.after;
}

// First takes a frame left by a client that has given up. It may be the wanted one, if frames take longer
// than clients wait.
void LightPartOrders::carry_out(const Wish& wish, Clock::time_point deadline) {
    if (state_.load(std::memory_order_acquire) != State::kIdle) {
        if (!wait_until_done(deadline)) return;
        take_result();
        const std::lock_guard lock(mutex_);
        if (has(wish)) return;
    }
    if (closed_.load(std::memory_order_acquire)) return;
    order_ = {maker_.make_buffer(wish.part), wish.part, wish.with_truth, {}};
    news_.take_all();  // news of earlier orders
    state_.store(State::kWanted, std::memory_order_release);
    if (wait_until_done(deadline)) return take_result();
    State wanted = State::kWanted;
    if (state_.compare_exchange_strong(wanted, State::kIdle, std::memory_order_acquire)) order_ = {};
}

// False when time is up, or the loop has ended before it began the order.
bool LightPartOrders::wait_until_done(Clock::time_point deadline) {
    // The semaphore uses CLOCK_MONOTONIC, like steady_clock.
    const std::int64_t until_ns = std::chrono::nanoseconds(deadline.time_since_epoch()).count();
    // The loop finishes an order before it ends. After its end, an order is done or never will be.
    while (state_.load(std::memory_order_acquire) != State::kDone) {
        const bool over = closed_.load(std::memory_order_acquire) || !news_.try_acquire_until(until_ns);
        if (over) return state_.load(std::memory_order_acquire) == State::kDone;
    }
    return true;
}

void LightPartOrders::take_result() {
    const Order result = std::exchange(order_, {});
    state_.store(State::kIdle, std::memory_order_relaxed);
    auto picture = std::make_shared<const Picture>(
        Picture{maker_.numbers_of(result.buffer->parts.of(result.part), result.record), result.record});
    const std::lock_guard lock(mutex_);
    newest_ = std::move(picture), newest_part_ = result.part;
}

}  // namespace hilcam
