// SPK types 2, 3 and 20: Chebyshev polynomials over spans of equal length; type 14: over spans of any length.

#include "io/spice/chebyshev_records.h"
#include "io/spice/spk_types.h"
#include "io/spice/text_kernel.h"

namespace hilcam {
namespace {

// Types 2 and 3: x, y, z [km] and, in type 3, their rates [km/s]; type 2's velocity is the derivative.
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

// Type 20: a record is, for each of x, y, z, the coefficients of the velocity and the position at the span's middle.
// After the records: units of length [km] and time [s], the first one's begin as a Julian date in two parts, the length
// of each in days, the words of each, how many.
class ChebyshevVelocities final : public SpkSegment {
  public:
    ChebyshevVelocities(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where) {
        record_ = words_.count_from_end(2, "words of a record", 6, 1e6);
        count_ = words_.count_from_end(1, "records", 1, kMostRecords);
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

// Type 14, a "generic segment": the degree, packets of the middle and half the length of a span [s] and coefficients of
// x, y, z [km] and their rates [km/s], then the times at which the packets begin, and where all of these lie: 17 numbers,
// of which a place counts from the segment's first word. A packet holds until the next one begins.
class ChebyshevPackets final : public SpkSegment {
  public:
    ChebyshevPackets(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where) {
        words_.count_from_end(1, "items at its end", kItems, kItems);
        const auto item = [&](std::size_t number, const char* what, double least, double most) {
            return words_.count_from_end(kItems - number + 1, what, least, most);
        };
        const std::size_t constants = item(1, "place of constants", 0, kMostRecords);
        item(2, "constants", 1, 1);
        item(5, "kind of index", 3, 3);
        times_ = item(6, "place of times", 0, kMostRecords), count_ = item(7, "times", 1, kMostRecords);
        packets_ = item(11, "place of packets", 0, kMostRecords);
        item(12, "packets", static_cast<double>(count_), static_cast<double>(count_));
        const std::size_t size = item(15, "words of a packet", 8, 1e6);
        before_ = item(16, "words before a packet", 0, 1e6), step_ = size + before_;
        words_.require_size(std::max({constants + 1, times_ + count_, packets_ + count_ * step_}));
        const double degree = words_[constants];
        terms_ = (size - 2) / 6;
        if (size != 2 + 6 * terms_ || degree != static_cast<double>(terms_ - 1))
            words_.fail("degree: found " + plain(degree) + " and packets of " + std::to_string(size) +
                        " words; accepted: 2 and six times the degree and 1");
        words_.require_rising(times_, count_, "time");
        for (std::size_t i = 0; i < count_; ++i)
            if (!(words_[packet(i) + 1] > 0))
                words_.fail("packet " + std::to_string(i + 1) + ": its radius is " +
                            plain(words_[packet(i) + 1]) + "; accepted: above 0");
    }

    StateVector at(double et_s) const override {
        const std::size_t after = times_up_to(words_.piece(times_, count_), et_s);
        const std::size_t from = packet(after > 0 ? after - 1 : 0);
        const double s = std::clamp((et_s - words_[from]) / words_[from + 1], -1.0, 1.0);
        std::array<double, 6> v{};
        for (std::size_t k = 0; k < 6; ++k)
            v[k] = kKilometre_m * chebyshev_at(words_.piece(from + 2 + k * terms_, terms_), s).value;
        return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }

  private:
    static constexpr std::size_t kItems = 17;
    SegmentWords words_;
    std::size_t times_ = 0, packets_ = 0, count_ = 0, before_ = 0, step_ = 0, terms_ = 0;

    std::size_t packet(std::size_t i) const { return packets_ + i * step_ + before_; }
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_chebyshev(const SpkSummary& about, std::vector<double> words) {
    if (about.type == 14) return std::make_unique<ChebyshevPackets>(about, std::move(words));
    if (about.type == 20) return std::make_unique<ChebyshevVelocities>(about, std::move(words));
    return std::make_unique<ChebyshevStates>(about, std::move(words));
}

}  // namespace hilcam
