#include "io/gige/stream/gige_frame_writer.h"

#include <algorithm>

namespace hilcam {
namespace {

bool fits(const DnImage& frame, const FrameRecord& record, const GigeStreamState& s) {
    return record.binning_x == s.binning_x && record.binning_y == s.binning_y && s.width > 0 &&
           s.height > 0 && std::uint64_t{s.offset_x} + s.width <= static_cast<std::uint64_t>(frame.width()) &&
           std::uint64_t{s.offset_y} + s.height <= static_cast<std::uint64_t>(frame.height());
}

}  // namespace

GigeFrameWriter::GigeFrameWriter(GigeRing& ring, FaultBoard& faults, const DeviceClock& clock,
                                 std::string pattern, int width)
    : ring_(ring),
      faults_(faults),
      device_clock_(clock),
      pattern_(std::move(pattern)),
      scratch_(3 * static_cast<std::size_t>(width) + 8) {}

std::uint64_t GigeFrameWriter::admit(const DnImage& frame, const FrameRecord& record,
                                     const GigeStreamNow& now) noexcept {
    const GigeStreamState& s = now.state;
    const auto unwanted = [this] {
        unwanted_.fetch_add(1, std::memory_order_relaxed);
        return std::uint64_t{0};
    };
    if (!s.open || !s.acquiring || record.id < now.first_frame) return unwanted();
    if (now.acquisition != acquisition_) {
        acquisition_ = now.acquisition;
        frames_ = 0;
        ids_.restart();
        before_ = nullptr;
    }
    if (s.frames != 0 && frames_ >= s.frames) return unwanted();
    if (!fits(frame, record, s)) {
        of_other_size_.add(record.id);
        return 0;
    }
    return ids_.take(s.long_ids(), faults_.strikes(FaultKind::kBlockIdWrap, record.id).has_value());
}

GigeFrameWriter::Outcome GigeFrameWriter::write(const DnImage& frame, const FrameRecord& record,
                                                const GigeStreamNow& now, std::uint64_t block) noexcept {
    const GigeStreamState& s = now.state;
    if (block == 0) return {};
    if (faults_.strikes(FaultKind::kFrameDrop, record.id)) {
        dropped_by_faults_.fetch_add(1, std::memory_order_relaxed);
        return {.written = false, .finished = s.frames != 0 && ++frames_ == s.frames};
    }
    GigeSlot* const slot = ring_.claim();
    if (!slot) {
        dropped_.add(record.id);
        return {};
    }
    slot->acquisition = now.acquisition;
    slot->last = s.frames != 0 && ++frames_ == s.frames;
    slot->record = record;
    GigeFrame& f = slot->frame;
    f.stream = s;
    f.pattern = pattern_;
    f.block = block;
    f.payload = std::span(slot->bytes).first(s.payload_bytes());
    f.size_y_error = 0;
    if (const auto error = faults_.strikes(FaultKind::kWrongSizeY, record.id)) {
        f.size_y_error = static_cast<std::int32_t>(*error);
        slot->record.faults |= bit_of(FaultKind::kWrongSizeY);
    }
    const bool repeat = before_ && before_->frame.payload.size() == f.payload.size() &&
                        faults_.strikes(FaultKind::kFrameRepeat, record.id);
    if (repeat) {
        // The sender may be reading that slot, but no thread writes it.
        f.timestamp_ns = before_->frame.timestamp_ns;
        std::copy(before_->frame.payload.begin(), before_->frame.payload.end(), slot->bytes.begin());
    } else {
        f.timestamp_ns = stamps_.stamp(faults_, record.id, record.exposure_mid_monotonic_ns,
                                       device_clock_.line(), slot->record.faults);
        write_gige_payload(frame, slot->record, s, pattern_, f.timestamp_ns, scratch_,
                           std::span(slot->bytes).first(f.payload.size()));
    }
    before_ = slot;
    ring_.publish(*slot);
    return {.written = true, .finished = false};
}

}  // namespace hilcam
