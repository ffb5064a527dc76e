// SPK types 1 and 21: modified difference arrays, which are the steps of JPL's integrator.

#include <numeric>

#include "io/spice/segment_words.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kPoints = 16;

// Gauss-Legendre points and weights on [0, 1], exact for polynomials up to degree 31 (Press et al., Numerical
// Recipes, 3rd ed., 2007, section 4.6: Newton's steps to the roots of the polynomial).
struct Quadrature {
    std::array<double, kPoints> point{}, weight{};
    Quadrature() {
        constexpr double n = kPoints;
        for (std::size_t i = 0; i < kPoints; ++i) {
            double x = std::cos(kPi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 0;
            for (int step = 0; step < 20; ++step) {
                double before = 0, p = 1;
                for (std::size_t k = 0; k < kPoints; ++k) {
                    const double order = static_cast<double>(k);
                    const double next = ((2 * order + 1) * x * p - order * before) / (order + 1);
                    before = p, p = next;
                }
                slope = n * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            point[i] = 0.5 * (1 + x), weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

// A record of m terms has the time of the step's end, m spans G back to earlier steps, then x, x', y, y', z,
// z' there [km, km/s], 3 m differences of the acceleration, the highest order plus one, and the number of
// differences per axis. It is valid up to its epoch. The epochs are in a list after the records, with every
// hundredth; in type 21 the words per record follow; the last word is the number of records.
//
// The differences are those of Krogh's modified form: at the time tau after the step, the acceleration is the
// sum of D_j times the product of (tau + G_(i-1)) / G_i over i < j, G_0 = 0. It is integrated by a quadrature
// that is exact for these polynomials.
class Differences final : public SpkSegment {
  public:
    Differences(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where) {
        // Type 1 has 15 terms; NAIF's limit for type 21 is 25.
        record_ = 71;
        std::size_t tail = 1;
        if (about.type == 21) record_ = words_.count_from_end(2, "words of a record", 15, 111), tail = 2;
        count_ = words_.count_from_end(1, "records", 1, kMaxRecords);
        if ((record_ - 11) % 4 != 0)
            words_.fail("words of a record: found " + std::to_string(record_) +
                        "; accepted: 11 and a multiple of 4, up to 111");
        terms_ = (record_ - 11) / 4;
        words_.require_size(count_ * (record_ + 1) + count_ / kDirectoryStep + tail);
        words_.require_rising(count_ * record_, count_, "epoch");
        for (std::size_t i = 0; i < count_; ++i) check(i);
    }

    StateVector at(double et_s) const override {
        const auto epochs = words_.piece(count_ * record_, count_);
        // The first record with an epoch not before the time.
        const auto found = std::lower_bound(epochs.begin(), epochs.end(), et_s) - epochs.begin();
        const std::size_t i = std::min(static_cast<std::size_t>(found), count_ - 1);
        const auto r = words_.piece(i * record_, record_);
        const double delta_s = et_s - r[0];
        static const Quadrature rule;
        const std::span<const double> g = r.subspan(1, terms_), state = r.subspan(1 + terms_, 6);
        std::array<double, 3> position{}, velocity{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position[axis] = state[2 * axis] + delta_s * state[2 * axis + 1];
            velocity[axis] = state[2 * axis + 1];
        }
        for (std::size_t q = 0; q < kPoints; ++q) {
            const double tau_s = delta_s * rule.point[q];
            const std::array<double, 3> a = acceleration(r, g, tau_s);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                velocity[axis] += delta_s * rule.weight[q] * a[axis];
                position[axis] += delta_s * rule.weight[q] * (delta_s - tau_s) * a[axis];
            }
        }
        return {kKilometre_m * Vec3d{position[0], position[1], position[2]},
                kKilometre_m * Vec3d{velocity[0], velocity[1], velocity[2]}};
    }

  private:
    SegmentWords words_;
    std::size_t record_ = 0, count_ = 0, terms_ = 0;

    std::size_t order(std::span<const double> r, std::size_t axis) const {
        return static_cast<std::size_t>(r[7 + 4 * terms_ + 1 + axis]);
    }
    std::array<double, 3> acceleration(std::span<const double> r, std::span<const double> g,
                                       double tau_s) const {
        std::array<double, 3> out{};
        double factor = 1;
        const std::size_t most = std::max({order(r, 0), order(r, 1), order(r, 2)});
        for (std::size_t j = 0; j < most; ++j) {
            if (j > 0) factor *= (tau_s + (j > 1 ? g[j - 2] : 0)) / g[j - 1];
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (j < order(r, axis)) out[axis] += factor * r[7 + terms_ + axis * terms_ + j];
        }
        return out;
    }
    void check(std::size_t i) const {
        const auto r = words_.piece(i * record_, record_);
        const std::string record = "record " + std::to_string(i + 1) + ": ";
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double n = r[7 + 4 * terms_ + 1 + axis];
            if (!(n >= 0 && n <= static_cast<double>(terms_)) || n != std::floor(n))
                words_.fail(record + "number of differences: found " + plain(n) + "; accepted: 0 to " +
                            std::to_string(terms_));
        }
        const std::size_t most = std::max({order(r, 0), order(r, 1), order(r, 2)});
        for (std::size_t j = 1; j < most; ++j)
            if (r[j] == 0)
                words_.fail(record + "span " + std::to_string(j) + " back is 0; accepted: another number");
    }
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_differences(const SpkSummary& about, std::vector<double> words) {
    return std::make_unique<Differences>(about, std::move(words));
}

}  // namespace hilcam
