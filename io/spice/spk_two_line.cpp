// SPK type 10: Earth satellites by two-line element sets and SGP4, blended from one set to the next.

#include "io/orbits/sgp4.h"
#include "io/spice/earth_of_date.h"
#include "io/spice/ephemeris_time.h"
#include "io/spice/frame_definition.h"
#include "io/spice/generic_segment.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The theory's constants in the order of a segment: J2, J3, J4, the square root of the gravity [er^1.5/min],
// the limits of the atmosphere [km], the Earth's radius [km], and length units in it.
struct Constant {
    const char* name;
    double value;
};
std::array<Constant, 8> constants_of_theory() {
    return {{{"J2", wgs72::kJ2},
             {"J3", wgs72::kJ3},
             {"J4", wgs72::kJ4},
             {"KE", wgs72::root_mu()},
             {"QO", 120},
             {"SO", 78},
             {"ER", wgs72::kEarthRadius_km},
             {"AE", 1}}};
}

// A packet's words: rates of the mean motion, which SGP4 does not use, then these, then angles and rates of
// the nutation, which NAIF's reader computes anew.
enum PacketWord : std::size_t {
    kBstar = 2,
    kInclination,
    kNode,
    kEccentricity,
    kPerigee,
    kMeanAnomaly,
    kMeanMotion,
    kEpoch,
    kMinWords
};

double days_1950(double et_s) {
    // UTC: julian_ut1() without a difference between the two.
    constexpr double kDay0 = 2433281.5;  // 1949-12-31
    const JulianDate utc = julian_ut1(EphemerisTime{}.tai(et_s), 0);
    return utc.day - kDay0 + utc.fraction;
}

class TwoLine final : public SpkSegment {
  public:
    TwoLine(const SpkSummary& about, std::vector<double> words) : SpkSegment(about) {
        const SegmentWords all(std::move(words), about.where);
        const GenericSegment parts(all, 8, kMinWords);
        if (about.frame != kJ2000Frame)
            all.fail("frame: found " + std::to_string(about.frame) + "; accepted: 1 (J2000)");
        check_constants(all, parts);
        for (std::size_t i = 0; i < parts.count; ++i) {
            const auto packet = all.piece(parts.packet(i), kMinWords);
            epochs_et_s_.push_back(packet[kEpoch]);
            // UTC is known here for 1950 to 2200.
            if (!(packet[kEpoch] > -1.57e9 && packet[kEpoch] < 6.3e9))
                all.fail("packet " + std::to_string(i + 1) + ": its epoch is " + plain(packet[kEpoch]) +
                         " s; accepted: the years 1950 to 2200");
            if (packet[kEpoch] != all[parts.times + i])
                all.fail("packet " + std::to_string(i + 1) + ": its epoch is " + plain(packet[kEpoch]) +
                         "; its time is " + plain(all[parts.times + i]));
            add(all, packet, i + 1);
        }
        for (std::size_t i = 0; i < sets_.size(); ++i) check_orbit(all, i);
    }

    StateVector at(double et_s) const override {
        const std::size_t after = times_up_to(epochs_et_s_, et_s);
        StateVector teme;
        if (after == 0 || after == sets_.size()) {
            teme = state(after == 0 ? 0 : after - 1, et_s);
        } else {
            // The weight of the earlier set falls from 1 to 0 as a cosine; the velocity includes the rate of
            // the weight.
            const double from = epochs_et_s_[after - 1], span_s = epochs_et_s_[after] - from;
            const double angle = kPi * (et_s - from) / span_s;
            const double weight = 0.5 + 0.5 * std::cos(angle), rate = -0.5 * std::sin(angle) * kPi / span_s;
            const StateVector a = state(after - 1, et_s), b = state(after, et_s);
            teme.position_m = weight * a.position_m + (1 - weight) * b.position_m;
            teme.velocity_m_s = weight * a.velocity_m_s + (1 - weight) * b.velocity_m_s +
                                rate * (a.position_m - b.position_m);
        }
        const FrameTurn turn = earth_of_date(EarthAxes::kTeme, et_s);
        const Vec3d position_m = turn.reference_from_frame * teme.position_m;
        return {position_m,
                turn.reference_from_frame * teme.velocity_m_s + cross(turn.rate_rad_s, position_m)};
    }

  private:
    std::vector<double> epochs_et_s_;
    std::vector<Sgp4> sets_;

    static void check_constants(const SegmentWords& words, const GenericSegment& parts) {
        // Kernels round the constants. Values other than those of WGS 72 would be another theory.
        constexpr double kSame = 1e-5;
        const auto theory = constants_of_theory();
        for (std::size_t i = 0; i < theory.size(); ++i) {
            const double found = words[parts.constants + i];
            if (!(std::abs(found - theory[i].value) <= kSame * std::abs(theory[i].value)))
                words.fail(std::string(theory[i].name) + ": found " + plain(found) +
                           "; accepted: " + plain(theory[i].value) + " (WGS 72)");
        }
    }
    void add(const SegmentWords& words, std::span<const double> packet, std::size_t number) {
        try {
            sets_.push_back(
                Sgp4({days_1950(packet[kEpoch]), packet[kInclination], packet[kNode], packet[kEccentricity],
                      packet[kPerigee], packet[kMeanAnomaly], packet[kMeanMotion], packet[kBstar]}));
        } catch (const InputError& error) {
            words.fail("packet " + std::to_string(number) + ": " + error.what());
        }
    }
    // The theory is not valid for so long, and its resonances are integrated in steps of half a day.
    static constexpr double kMaxAway_s = 20 * 365.25 * 86400;

    // A set must work wherever it is used: up to its neighbours, or to the ends of the span.
    void check_orbit(const SegmentWords& words, std::size_t i) const {
        const double first = i > 0 ? epochs_et_s_[i - 1] : about().start_et_s,
                     last = i + 1 < sets_.size() ? epochs_et_s_[i + 1] : about().stop_et_s;
        for (const double et_s : {first, epochs_et_s_[i], last}) {
            if (!(std::abs(et_s - epochs_et_s_[i]) <= kMaxAway_s))
                words.fail("packet " + std::to_string(i + 1) + ": stands for " + plain(et_s) +
                           " s, years from its epoch; accepted: 20 years at most");
            StateVector state;
            if (sets_[i].at((et_s - epochs_et_s_[i]) / 60, state) != Sgp4Status::kOk)
                words.fail("packet " + std::to_string(i + 1) +
                           ": its elements are no orbit above the ground at " + plain(et_s) + " s");
        }
    }
    // Where the theory fails between the tested times, the satellite stays where it was at the set's epoch.
    StateVector state(std::size_t i, double et_s) const {
        StateVector out;
        if (sets_[i].at((et_s - epochs_et_s_[i]) / 60, out) != Sgp4Status::kOk) sets_[i].at(0, out);
        return out;
    }
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_two_line(const SpkSummary& about, std::vector<double> words) {
    return std::make_unique<TwoLine>(about, std::move(words));
}

}  // namespace hilcam
