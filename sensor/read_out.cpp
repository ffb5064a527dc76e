#include "sensor/read_out.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/clones.h"
#include "sensor/noise.h"

namespace hilcam {
namespace {

struct Amplifier {
    float full_well_e, a2, a3;
    float noise_e;   // factor for the deviate
    float offset_e;  // common to the row
};

HILCAM_CLONES void amplify(float* charge, const float* deviate, std::size_t count,
                           const Amplifier& amplifier) {
    // Copied so that the compiler knows that the stores below do not change it.
    const Amplifier a = amplifier;
    const float per_well = 1.0f / a.full_well_e;
    for (std::size_t i = 0; i < count; ++i) {
        const float q = std::min(charge[i], a.full_well_e);
        const float x = q * per_well;
        charge[i] = q * (1.0f + x * (a.a2 + x * a.a3)) + (a.noise_e * deviate[i] + a.offset_e);
    }
}

HILCAM_CLONES void add_row(float* sum, const float* other, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) sum[i] += other[i];
}

HILCAM_CLONES void scale_row(float* value, std::size_t count, float gain, float offset) {
    for (std::size_t i = 0; i < count; ++i) value[i] = value[i] * gain + offset;
}

}  // namespace

ReadOut::ReadOut(const CameraModel& c)
    : full_well_e_(static_cast<float>(c.full_well_e)),
      a2_(static_cast<float>(c.nonlinearity.empty() ? 0 : c.nonlinearity[0])),
      a3_(static_cast<float>(c.nonlinearity.size() < 2 ? 0 : c.nonlinearity[1])),
      pixel_noise_e_(static_cast<float>(std::hypot(c.read_noise_e, c.reset_noise_e))),
      row_noise_e_(static_cast<float>(c.row_noise_e)),
      telegraph_frames_(static_cast<std::uint64_t>(c.defects.telegraph_frames)),
      filter_(c.filters),
      converter_(c.converter, static_cast<int>(c.bits), static_cast<std::uint64_t>(c.fixed_pattern.seed),
                 c.number_bits()),
      max_sum_dn_((1u << c.number_bits()) - 1) {
    if (c.flicker_noise_e > 0) {
        const auto [width, height] = array_size(c);
        flicker_octaves_ = static_cast<int>(std::ceil(std::log2(static_cast<double>(width) * height))) + 1;
        flicker_octave_e_ = static_cast<float>(c.flicker_noise_e / std::sqrt(flicker_octaves_ + 1));
    }
}

void ReadOut::read(const ReadOutRow& row, std::span<const TelegraphPixel> telegraph, RandomKey key,
                   std::span<std::uint16_t> dn) const {
    const std::span<float> value = row.charge_e;
    // With binning on the chip, a pixel's full well is that of all its parts.
    Amplifier amplifier{full_well_e_ * static_cast<float>(row.charges), a2_, a3_, pixel_noise_e_, 0};
    if (row_noise_e_ > 0) {
        const auto words = random_words(key, RandomPurpose::kRowNoise, row.sensor_row);
        amplifier.offset_e = row_noise_e_ * normal_quantile(uniform01(words[0]));
    }
    amplify(value.data(), row.deviates.data(), value.size(), amplifier);
    if (!row.offset_e.empty()) add_row(value.data(), row.offset_e.data(), value.size());
    if (flicker_octaves_ > 0) add_flicker(row.y, key, value);
    if (!telegraph.empty()) add_telegraph(telegraph, row.charges_across, key, value);
    if (!filter_.none()) filter_.apply(value);
    scale_row(value.data(), value.size(), static_cast<float>(row.gain_dn_e),
              static_cast<float>(row.black_level_dn));
    converter_.convert(value, dn);
}

void ReadOut::add_flicker(int y, RandomKey key, std::span<float> charge_e) const {
    constexpr std::uint64_t kTogether = 128;
    std::array<float, kTogether> deviates;
    const std::uint64_t first = static_cast<std::uint64_t>(y) * charge_e.size();
    const std::uint64_t end = first + charge_e.size();
    for (int octave = 0; octave < flicker_octaves_; ++octave) {
        // Stretches of 2^octave pixels that overlap this row.
        const std::uint64_t last = (end - 1) >> octave;
        for (std::uint64_t stretch = first >> octave; stretch <= last; stretch += kTogether) {
            const std::span<float> values =
                std::span(deviates).first(std::min(kTogether, last + 1 - stretch));
            // The first octave also stands for all faster ones: with twice the variance, every octave of the
            // sum has the same power.
            const float amplitude_e = octave == 0 ? std::sqrt(2.0f) * flicker_octave_e_ : flicker_octave_e_;
            draw_normals(key, RandomPurpose::kFlicker, static_cast<std::uint32_t>(octave), stretch, values);
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::uint64_t from = std::max(first, (stretch + i) << octave);
                const std::uint64_t to = std::min(end, (stretch + i + 1) << octave);
                for (std::uint64_t x = from; x < to; ++x)
                    charge_e[static_cast<std::size_t>(x - first)] += amplitude_e * values[i];
            }
        }
    }
}

// Binned charge is read by the first pixel's amplifier.
void ReadOut::add_telegraph(std::span<const TelegraphPixel> pixels, int charges_across, RandomKey key,
                            std::span<float> charge_e) const {
    for (const TelegraphPixel& p : pixels) {
        const auto x = static_cast<std::size_t>(p.x / charges_across);
        if (p.x % charges_across != 0 || x >= charge_e.size()) continue;
        // Pixels change their state at different frames.
        const std::uint64_t shifted = key.frame + p.pixel % telegraph_frames_;
        const auto words =
            random_words({key.seed, shifted / telegraph_frames_}, RandomPurpose::kTelegraph, p.pixel);
        charge_e[x] += (words[0] & 1u ? 0.5f : -0.5f) * p.height_e;
    }
}

}  // namespace hilcam
