#include "io/gige/stream/gige_ring.h"

#include "render/vocabulary/check.h"

namespace hilcam {

GigeRing::GigeRing(std::size_t slots, std::size_t bytes_each) : slots_(slots) {
    HILCAM_CHECK(slots >= kMinSlots);
    for (GigeSlot& slot : slots_) {
        slot.bytes.resize(bytes_each);
        slot.turn_ = ++turns_;
    }
}

GigeSlot* GigeRing::claim() noexcept {
    if (waiting() >= kMaxWaiting) return nullptr;
    for (std::uint64_t after = 0;;) {
        GigeSlot* oldest = nullptr;
        for (GigeSlot& slot : slots_)
            if (slot.turn_ > after && (!oldest || slot.turn_ < oldest->turn_)) oldest = &slot;
        if (!oldest) return nullptr;
        Use kept = Use::kKept;
        if (oldest->use_.compare_exchange_strong(kept, Use::kWriting, std::memory_order_acquire))
            return oldest;
        after = oldest->turn_;  // the sender is reading it: take the next older one
    }
}

void GigeRing::publish(GigeSlot& slot) noexcept {
    slot.turn_ = ++turns_;
    slot.use_.store(Use::kWaiting, std::memory_order_release);
    const std::uint64_t at = written_.load(std::memory_order_relaxed);
    waiting_[at % waiting_.size()] = &slot;
    written_.store(at + 1, std::memory_order_release);
}

GigeSlot* GigeRing::next() noexcept {
    if (taken_ == written_.load(std::memory_order_acquire)) return nullptr;
    GigeSlot* const slot = waiting_[taken_++ % waiting_.size()];
    slot->use_.store(Use::kReading, std::memory_order_relaxed);
    return slot;
}

void GigeRing::done(GigeSlot& slot) noexcept {
    keep(slot);
    sent_.fetch_add(1, std::memory_order_release);
}

GigeSlot* GigeRing::find(std::uint64_t acquisition, std::uint64_t block, std::uint64_t& oldest) noexcept {
    oldest = 0;
    std::uint64_t oldest_turn = ~std::uint64_t{0};
    for (GigeSlot& slot : slots_) {
        Use kept = Use::kKept;
        if (!slot.use_.compare_exchange_strong(kept, Use::kReading, std::memory_order_acquire)) continue;
        if (slot.acquisition == acquisition && slot.frame.block == block) return &slot;
        if (slot.acquisition == acquisition && slot.turn_ < oldest_turn)
            oldest = slot.frame.block, oldest_turn = slot.turn_;
        keep(slot);
    }
    return nullptr;
}

void GigeRing::keep(GigeSlot& slot) noexcept { slot.use_.store(Use::kKept, std::memory_order_release); }

}  // namespace hilcam
