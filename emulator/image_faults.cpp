#include "emulator/image_faults.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/frame_sink.h"

namespace hilcam {
namespace {

// The bits beyond are those of kTimeStandsBit and its neighbours.
static_assert(kAllFaults.size() <= 60);

constexpr std::array kWholeFrame = {
    FaultKind::kLeaderLost,     FaultKind::kTrailerLost,     FaultKind::kFrameDrop,
    FaultKind::kFrameRepeat,    FaultKind::kWrongSizeY,      FaultKind::kTimestampStep,
    FaultKind::kTimestampDrift, FaultKind::kTimestampFreeze, FaultKind::kImageStuck,
    FaultKind::kImageBlack,     FaultKind::kImageSaturated,  FaultKind::kImageTear,
};

bool same_size(const DnImage& a, const DnImage& b) {
    return a.width() == b.width() && a.height() == b.height();
}

// Which pixels: gaps between struck ones are geometric, so the work goes with their number.
void flip_bits(FaultBoard& faults, const FrameRecord& record, std::uint64_t seed, DnImage& frame) {
    const auto order = faults.order_of(FaultKind::kImageBitFlips);
    if (!order || !faults.within_span(FaultKind::kImageBitFlips, record.id)) return;
    const double log_miss = std::log1p(-std::min(order->rate, 1.0 - 1e-12));
    const std::span<std::uint16_t> pixels = frame.all();
    double at = 0;
    std::uint64_t struck = 0;
    for (std::uint32_t draw = 0;; ++draw, ++struck) {
        const auto words = random_words({seed, record.id}, RandomPurpose::kFault, draw,
                                        static_cast<std::uint32_t>(FaultKind::kImageBitFlips));
        at += std::floor(std::log(static_cast<double>(uniform01(words[0]))) / log_miss);
        if (!(at < static_cast<double>(pixels.size()))) break;
        auto& pixel = pixels[static_cast<std::size_t>(at)];
        pixel =
            static_cast<std::uint16_t>(pixel ^ (1u << words[1] % static_cast<std::uint32_t>(record.bits)));
        at += 1;
    }
    if (struck > 0) faults.count(FaultKind::kImageBitFlips, record.id, struck, order->value);
}

}  // namespace

void strike_image(FaultBoard& faults, const FrameRecord& record, std::uint64_t seed, const DnImage& before,
                  DnImage& frame) {
    const std::uint64_t id = record.id;
    if (faults.strikes(FaultKind::kImageStuck, id) && same_size(before, frame))
        std::copy(before.all().begin(), before.all().end(), frame.all().begin());
    if (const auto share = faults.strikes(FaultKind::kImageTear, id); share && same_size(before, frame)) {
        const int first = static_cast<int>(*share * frame.height());
        for (int y = first; y < frame.height(); ++y)
            std::copy(before.row(y).begin(), before.row(y).end(), frame.row(y).begin());
    }
    const auto fill = [&](std::uint32_t dn) {
        std::fill(frame.all().begin(), frame.all().end(), static_cast<std::uint16_t>(dn));
    };
    if (faults.strikes(FaultKind::kImageBlack, id)) fill(0);
    if (faults.strikes(FaultKind::kImageSaturated, id)) fill((1u << record.bits) - 1);
    flip_bits(faults, record, seed, frame);
}

std::uint64_t frame_faults(const FaultBoard& faults, std::uint64_t frame) {
    std::uint64_t bits = 0;
    for (const FaultKind kind : kWholeFrame)
        if (faults.would_strike(kind, frame)) bits |= bit_of(kind);
    if (faults.within_span(FaultKind::kImageBitFlips, frame)) bits |= bit_of(FaultKind::kImageBitFlips);
    return bits;
}

}  // namespace hilcam
