// SPK types 2, 3 and 20: Chebyshev polynomials over spans of equal length; type 14: over spans of any length.

#include "io/spice/chebyshev_records.h"
#include "io/spice/generic_segment.h"
#include "io/spice/spk_types.h"
#include "io/spice/text_kernel.h"

namespace hilcam {
namespace {

// Types 2 and 3: x, y, z [km] and, in type 3, their rates [km/s]; the velocity of type 2 is the derivative.
class ChebyshevStates final : public SpkSegment {
  public:
    ChebyshevStates(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about),
          records_(std::move(words), about.where, about.type == 2 ? 3 : 6),
          own_rates_(about.type == 3) {}

    StateVector at(double et_s) const override {
        const auto v = records_.at(et_s);
        const Vec3d position_km{v[0].value, v[1].value, v[2].value};
        const Vec3d velocity_km_s = own_rates_ ? Vec3d{v[3].value, v[4].value, v[5].value}
                                               : Vec3d{v[0].slope, v[1].slope, v[2].slope};
        return {kKilometre_m * position_km, kKilometre_m * velocity_km_s};
    }

  private:
    ChebyshevRecords records_;
    bool own_rates_;
};

// Type 20: a record has, for each of x, y, z, the coefficients of the velocity and the position at the middle
// of the span. After the records come the units of length [km] and time [s], the beginning of the first as a
// Julian date in two parts, the length of each in days, the words of each, and their number.
class ChebyshevVelocities final : public SpkSegment {
  public:
    ChebyshevVelocities(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where) {
        record_ = words_.count_from_end(2, "words of a record", 6, 1e6);
        count_ = words_.count_from_end(1, "records", 1, kMaxRecords);
        length_s_ = words_.from_end(3) * kJulianDay_s;
        begin_et_s_ = ((words_.from_end(5) - kJ2000_jd) + words_.from_end(4)) * kJulianDay_s;
        unit_m_ = words_.from_end(7) * kKilometre_m, unit_m_s_ = unit_m_ / words_.from_end(6);
        if (record_ % 3 != 0)
            words_.fail("words of a record: found " + std::to_string(record_) +
                        "; accepted: a multiple of 3");
        if (!(length_s_ > 0) || !std::isfinite(begin_et_s_ + length_s_) || !std::isfinite(unit_m_s_))
            words_.fail("its length of a record, begin or units are no positive numbers");
        words_.require_size(count_ * record_ + 7);
    }

    StateVector at(double et_s) const override {
        const double index = std::floor((et_s - begin_et_s_) / length_s_);
        const auto i = static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(count_ - 1)));
        const std::size_t terms = record_ / 3 - 1;
        const double radius_s = length_s_ / 2;
        const double middle_s = begin_et_s_ + (static_cast<double>(i) + 0.5) * length_s_;
        const double s = std::clamp((et_s - middle_s) / radius_s, -1.0, 1.0);
        std::array<double, 3> position{}, velocity{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t from = i * record_ + k * (terms + 1);
            const auto c = words_.piece(from, terms);
            velocity[k] = unit_m_s_ * chebyshev_at(c, s).value;
            position[k] = unit_m_ * words_[from + terms] + radius_s * unit_m_s_ * chebyshev_integral(c, s);
        }
        return {{position[0], position[1], position[2]}, {velocity[0], velocity[1], velocity[2]}};
    }

  private:
    SegmentWords words_;
    std::size_t record_ = 0, count_ = 0;
    double begin_et_s_ = 0, length_s_ = 0, unit_m_ = 0, unit_m_s_ = 0;
};

// Type 14, a generic segment (generic_segment.h): the degree, then packets with the middle and half the
// length of a span [s] and the coefficients of x, y, z [km] and their rates [km/s]. A packet holds until the
// next one begins.
class ChebyshevPackets final : public SpkSegment {
  public:
    ChebyshevPackets(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where), parts_(words_, 1, 8) {
        constexpr std::size_t kLastBegun = 3;
        words_.count_from_end(GenericSegment::kIndexKindFromEnd, "kind of index", kLastBegun, kLastBegun);
        const double degree = words_[parts_.constants];
        const std::size_t size = parts_.packet_words;
        terms_ = (size - 2) / 6;
        if (size != 2 + 6 * terms_ || degree != static_cast<double>(terms_ - 1))
            words_.fail("degree: found " + plain(degree) + " and packets of " + std::to_string(size) +
                        " words; accepted: 2 and six times the degree and 1");
        for (std::size_t i = 0; i < parts_.count; ++i)
            if (!(words_[parts_.packet(i) + 1] > 0))
                words_.fail("packet " + std::to_string(i + 1) + ": its radius is " +
                            plain(words_[parts_.packet(i) + 1]) + "; accepted: above 0");
    }

    StateVector at(double et_s) const override {
        const std::size_t after = times_up_to(words_.piece(parts_.times, parts_.count), et_s);
        const std::size_t from = parts_.packet(after > 0 ? after - 1 : 0);
        const double s = std::clamp((et_s - words_[from]) / words_[from + 1], -1.0, 1.0);
        std::array<double, 6> v{};
        for (std::size_t k = 0; k < 6; ++k)
            v[k] = kKilometre_m * chebyshev_at(words_.piece(from + 2 + k * terms_, terms_), s).value;
        return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }

  private:
    SegmentWords words_;
    GenericSegment parts_;
    std::size_t terms_ = 0;
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_chebyshev(const SpkSummary& about, std::vector<double> words) {
    if (about.type == 14) return std::make_unique<ChebyshevPackets>(about, std::move(words));
    if (about.type == 20) return std::make_unique<ChebyshevVelocities>(about, std::move(words));
    return std::make_unique<ChebyshevStates>(about, std::move(words));
}

}  // namespace hilcam
