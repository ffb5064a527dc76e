#include "emulator/loop/image_faults.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/contract/frame_flags.h"
#include "io/contract/frame_sink.h"

namespace hilcam {
namespace {

static_assert((std::uint64_t{1} << kAllFaults.size()) <= kFrameFlags[0].bit);

constexpr std::array kWholeFrame = {
    FaultKind::kLeaderLost,     FaultKind::kTrailerLost,     FaultKind::kFrameDrop,
    FaultKind::kFrameRepeat,    FaultKind::kWrongSizeY,      FaultKind::kTimestampStep,
    FaultKind::kTimestampDrift, FaultKind::kTimestampFreeze, FaultKind::kImageStuck,
    FaultKind::kImageBlack,     FaultKind::kImageSaturated,  FaultKind::kImageTear,
};

bool same_size(const DnImage& a, const DnImage& b) {
    return a.width() == b.width() && a.height() == b.height();
}

// Draws which pixels are struck. The gaps between them are geometrically distributed, so the work grows with
// their number only.
std::uint64_t flip_bits(double rate, const FrameRecord& record, std::uint64_t seed, DnImage& frame) {
    const double log_miss = std::log1p(-std::min(rate, 1.0 - 1e-12));
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
    return struck;
}

}  // namespace

ImageFaults image_faults(FaultBoard& board, std::uint64_t frame) {
    ImageFaults out;
    out.stuck = board.strikes(FaultKind::kImageStuck, frame).has_value();
    out.tear_share = board.strikes(FaultKind::kImageTear, frame);
    out.black = board.strikes(FaultKind::kImageBlack, frame).has_value();
    out.saturated = board.strikes(FaultKind::kImageSaturated, frame).has_value();
    const auto flips = board.order_of(FaultKind::kImageBitFlips);
    if (flips && board.within_span(FaultKind::kImageBitFlips, frame)) out.flip_rate = flips->rate;
    return out;
}

std::uint64_t strike_image(const ImageFaults& faults, const FrameRecord& record, std::uint64_t seed,
                           const DnImage& before, DnImage& frame) {
    if (faults.stuck && same_size(before, frame))
        std::copy(before.all().begin(), before.all().end(), frame.all().begin());
    if (faults.tear_share && same_size(before, frame)) {
        const int first = static_cast<int>(*faults.tear_share * frame.height());
        for (int y = first; y < frame.height(); ++y)
            std::copy(before.row(y).begin(), before.row(y).end(), frame.row(y).begin());
    }
    const auto fill = [&](std::uint32_t dn) {
        std::fill(frame.all().begin(), frame.all().end(), static_cast<std::uint16_t>(dn));
    };
    if (faults.black) fill(0);
    if (faults.saturated) fill((1u << record.bits) - 1);
    return faults.flip_rate ? flip_bits(*faults.flip_rate, record, seed, frame) : 0;
}

std::uint64_t frame_faults(const FaultBoard& faults, std::uint64_t frame) {
    std::uint64_t bits = 0;
    for (const FaultKind kind : kWholeFrame)
        if (faults.would_strike(kind, frame)) bits |= bit_of(kind);
    if (faults.within_span(FaultKind::kImageBitFlips, frame)) bits |= bit_of(FaultKind::kImageBitFlips);
    return bits;
}

}  // namespace hilcam
