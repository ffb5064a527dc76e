#include "io/spice/body_orientation.h"

#include <array>
#include <cmath>

#include "io/spice/chebyshev_records.h"
#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kCentury_s = 36525 * kJulianDay_s;

// Angles and rates: of the node from the reference's x axis, of the tilt, and along the equator from the
// node.
struct Euler {
    double node_rad, tilt_rad, spin_rad, node_rate, tilt_rate, spin_rate;
};

// Returns NAIF's [spin]3 [tilt]1 [node]3; the rate is the sum of the rates about the three axes.
FrameTurn turn_of(const Euler& e) {
    const double cn = std::cos(e.node_rad), sn = std::sin(e.node_rad), ct = std::cos(e.tilt_rad),
                 st = std::sin(e.tilt_rad), cs = std::cos(e.spin_rad), ss = std::sin(e.spin_rad);
    const Vec3d node{cn, sn, 0}, across{-sn * ct, cn * ct, st}, pole{sn * st, -cn * st, ct};
    const Mat3d frame_from_reference{cs * node + ss * across, -ss * node + cs * across, pole};
    return {transposed(frame_from_reference),
            e.node_rate * Vec3d{0, 0, 1} + e.tilt_rate * node + e.spin_rate * pole};
}

struct ValueRate {
    double value = 0, rate = 0;
};
ValueRate polynomial(std::span<const double> c, double t) {
    ValueRate out;
    for (std::size_t i = c.size(); i-- > 0;) {
        out.rate = out.rate * t + out.value;
        out.value = out.value * t + c[i];
    }
    return out;
}

class TextOrientation final : public BodyOrientation {
  public:
    TextOrientation(const KernelPool& pool, int body) {
        const std::string id = "BODY" + std::to_string(body);
        const auto read = [&](const std::string& key, std::vector<double>& to) {
            const auto found = pool.numbers(id + key);
            if (found) to.assign(found->begin(), found->end());
            return found.has_value();
        };
        read("_POLE_RA", ra_deg_);
        if (!read("_POLE_DEC", dec_deg_) || !read("_PM", meridian_deg_))
            throw InputError(pool.find(id + "_POLE_RA")->where + ": " + id +
                             "_POLE_RA stands without _POLE_DEC or _PM; accepted: all three");
        read("_NUT_PREC_RA", ra_terms_), read("_NUT_PREC_DEC", dec_terms_),
            read("_NUT_PREC_PM", meridian_terms_);
        frame = pool.integer(id + "_CONSTANTS_REF_FRAME").value_or(1);
        epoch_et_s_ =
            (pool.number(id + "_CONSTANTS_JED_EPOCH").value_or(kJ2000_jd) - kJ2000_jd) * kJulianDay_s;
        read_angles(pool, body);
    }

    FrameTurn at(double et_s) const override {
        const double t = (et_s - epoch_et_s_) / kCentury_s, d = (et_s - epoch_et_s_) / kJulianDay_s;
        ValueRate ra = polynomial(ra_deg_, t), dec = polynomial(dec_deg_, t),
                  w = polynomial(meridian_deg_, d);
        ra.rate /= kCentury_s, dec.rate /= kCentury_s, w.rate /= kJulianDay_s;
        const std::size_t most = std::max({ra_terms_.size(), dec_terms_.size(), meridian_terms_.size()});
        for (std::size_t i = 0; i < most; ++i) {
            const ValueRate angle =
                polynomial(std::span(angles_deg_).subspan(i * coefficients_, coefficients_), t);
            const double a = std::fmod(angle.value, 360.0) * kDegree_rad;
            const double rate = angle.rate * kDegree_rad / kCentury_s, s = std::sin(a), c = std::cos(a);
            if (i < ra_terms_.size()) ra.value += ra_terms_[i] * s, ra.rate += ra_terms_[i] * c * rate;
            if (i < dec_terms_.size()) dec.value += dec_terms_[i] * c, dec.rate -= dec_terms_[i] * s * rate;
            if (i < meridian_terms_.size())
                w.value += meridian_terms_[i] * s, w.rate += meridian_terms_[i] * c * rate;
        }
        return turn_of({(90 + ra.value) * kDegree_rad, (90 - dec.value) * kDegree_rad,
                        std::fmod(w.value, 360.0) * kDegree_rad, ra.rate * kDegree_rad,
                        -dec.rate * kDegree_rad, w.rate * kDegree_rad});
    }

  private:
    std::vector<double> ra_deg_, dec_deg_, meridian_deg_, ra_terms_, dec_terms_, meridian_terms_, angles_deg_;
    std::size_t coefficients_ = 2;
    double epoch_et_s_ = 0;

    // The angles of the periodic terms are the planet's barycentre's, or the body's own.
    void read_angles(const KernelPool& pool, int body) {
        const std::size_t most = std::max({ra_terms_.size(), dec_terms_.size(), meridian_terms_.size()});
        if (most == 0) return;
        int home = body;
        if (body >= 100 && body <= 999) home = body / 100;
        if (body >= 10000 && body <= 99999) home = body / 10000;
        const std::string id = "BODY" + std::to_string(home), key = id + "_NUT_PREC_ANGLES";
        const int degree = pool.integer(id + "_MAX_PHASE_DEGREE").value_or(1);
        const auto found = pool.numbers(key);
        if (!found)
            throw InputError("no kernel has " + key + ", which the orientation of body " +
                             std::to_string(body) + " needs; accepted: a PCK with it");
        const std::string where = pool.find(key)->where + ": " + key;
        if (degree < 1 || degree > 3)
            throw InputError(where + ": found the degree " + std::to_string(degree) + "; accepted: 1 to 3");
        coefficients_ = static_cast<std::size_t>(degree) + 1;
        if (found->size() < most * coefficients_)
            throw InputError(where + ": found " + std::to_string(found->size()) + " numbers; body " +
                             std::to_string(body) + " has terms for " + std::to_string(most * coefficients_));
        angles_deg_.assign(found->begin(), found->end());
    }
};

class BinaryOrientation final : public BodyOrientation {
  public:
    BinaryOrientation(std::vector<double> words, const std::string& where, bool own_rates)
        : records_(std::move(words), where, own_rates ? 6 : 3), own_rates_(own_rates) {}

    FrameTurn at(double et_s) const override {
        const auto v = records_.at(et_s);
        const auto rate = [&](std::size_t k) { return own_rates_ ? v[k + 3].value : v[k].slope; };
        return turn_of({v[0].value, v[1].value, v[2].value, rate(0), rate(1), rate(2)});
    }

  private:
    ChebyshevRecords records_;
    bool own_rates_;
};

}  // namespace

FrameTurn composed(const FrameTurn& outer, const FrameTurn& inner) {
    return {outer.reference_from_frame * inner.reference_from_frame,
            outer.rate_rad_s + outer.reference_from_frame * inner.rate_rad_s};
}

std::unique_ptr<BodyOrientation> text_orientation(const KernelPool& pool, int body) {
    if (!pool.find("BODY" + std::to_string(body) + "_POLE_RA")) return nullptr;
    return std::make_unique<TextOrientation>(pool, body);
}

std::unique_ptr<BodyOrientation> load_binary_orientation(const DafFile& file, const DafArray& array) {
    const std::string where = file.name() + ": segment " + std::to_string(&array - file.arrays().data() + 1) +
                              " (" + in_quotes(array.name) + ")";
    const int type = array.integers[2];
    if (type != 2 && type != 3)
        throw InputError(where + ": found type " + std::to_string(type) + " of a binary PCK; accepted: 2, 3");
    auto out = std::make_unique<BinaryOrientation>(file.words(array), where, type == 3);
    out->frame = array.integers[1];
    out->start_et_s = array.doubles[0], out->stop_et_s = array.doubles[1];
    return out;
}

}  // namespace hilcam
