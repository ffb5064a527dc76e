// SPK type 5: two-body motion from the states before and after, blended from one to the other.

#include "io/orbits/two_body.h"
#include "io/spice/segment_words.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// States of six words [km, km/s], their times, every hundredth of these, the centre's gravity [km^3/s^2],
// number of states.
class TwoBody final : public SpkSegment {
  public:
    TwoBody(const SpkSummary& about, std::vector<double> words)
        : SpkSegment(about), words_(std::move(words), about.where) {
        count_ = words_.count_from_end(1, "states", 1, kMaxRecords);
        gravity_km3_s2_ = words_.from_end(2);
        if (!(gravity_km3_s2_ > 0))
            words_.fail("gravity: found " + plain(gravity_km3_s2_) + "; accepted: above 0");
        words_.require_size(7 * count_ + count_ / kDirectoryStep + 2);
        words_.require_rising(6 * count_, count_, "time");
        for (std::size_t i = 0; i < count_; ++i)
            if (!(length(state(i).position_m) > 0))
                words_.fail("state " + std::to_string(i + 1) + ": lies at the centre");
    }

    StateVector at(double et_s) const override {
        const auto times = words_.piece(6 * count_, count_);
        const std::size_t after = times_up_to(times, et_s);
        StateVector out;
        if (after == 0 || after == count_) {
            const std::size_t i = after == 0 ? 0 : count_ - 1;
            out = two_body_state(state(i), gravity_km3_s2_, et_s - times[i]);
        } else {
            // The weight of the earlier state falls from 1 to 0 as a cosine; the velocity includes the rate
            // of the weight.
            const double span_s = times[after] - times[after - 1];
            const double angle = kPi * (et_s - times[after - 1]) / span_s;
            const double weight = 0.5 + 0.5 * std::cos(angle), rate = -0.5 * std::sin(angle) * kPi / span_s;
            const StateVector a = two_body_state(state(after - 1), gravity_km3_s2_, et_s - times[after - 1]);
            const StateVector b = two_body_state(state(after), gravity_km3_s2_, et_s - times[after]);
            out.position_m = weight * a.position_m + (1 - weight) * b.position_m;
            out.velocity_m_s = weight * a.velocity_m_s + (1 - weight) * b.velocity_m_s +
                               rate * (a.position_m - b.position_m);
        }
        return {kKilometre_m * out.position_m, kKilometre_m * out.velocity_m_s};
    }

  private:
    SegmentWords words_;
    std::size_t count_ = 0;
    double gravity_km3_s2_ = 0;

    // In kilometres.
    StateVector state(std::size_t i) const {
        const auto w = words_.piece(6 * i, 6);
        return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
    }
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_two_body(const SpkSummary& about, std::vector<double> words) {
    return std::make_unique<TwoBody>(about, std::move(words));
}

}  // namespace hilcam
