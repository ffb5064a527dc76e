#include "io/commands/usb_answers.h"

#include <algorithm>

namespace hilcam {
namespace {

// Smallest packet size of a bulk endpoint at full speed; the others are multiples.
constexpr std::size_t kMinPacketSize = 64;

}  // namespace

bool UsbAnswers::put(std::span<const std::uint8_t> packet, bool telemetry) {
    if (bytes() + packet.size() > (telemetry ? max_bytes_ / 2 : max_bytes_)) return false;
    if (begin_ > bytes_.size() / 2) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
        begin_ = 0;
    }
    bytes_.insert(bytes_.end(), packet.begin(), packet.end());
    if (faults_.strikes(FaultKind::kUsbBadCrc, 0, packets_++) && !packet.empty()) bytes_.back() ^= 0xFF;
    return true;
}

std::size_t UsbAnswers::next(std::span<std::uint8_t> transfer) {
    std::size_t size = std::min(bytes(), transfer.size());
    if (size == 0) return 0;
    if (faults_.would_strike(FaultKind::kUsbStall, 0, transfers_)) {
        if (!stalled_) faults_.strikes(FaultKind::kUsbStall, 0, transfers_);  // counted once
        stalled_ = true;
        return 0;
    }
    stalled_ = false;
    if (second_half_) {
        second_half_ = false;
    } else if (size > 1 && faults_.strikes(FaultKind::kUsbShortTransfer, 0, transfers_)) {
        size /= 2;
        second_half_ = true;
    }
    if (size % kMinPacketSize == 0) --size;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), size, transfer.begin());
    begin_ += size;
    ++transfers_;
    if (begin_ == bytes_.size()) bytes_.clear(), begin_ = 0;
    return size;
}

void UsbAnswers::clear() {
    bytes_.clear();
    begin_ = 0;
    second_half_ = stalled_ = false;
}

}  // namespace hilcam
