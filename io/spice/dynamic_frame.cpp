#include "io/spice/dynamic_frame.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/spice/frame_definition.h"
#include "io/spice/kernel_names.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

class DynamicReader {
  public:
    DynamicReader(const KernelPool& pool, const std::string& code, const std::string& name,
                  const std::string& frame_where)
        : pool_(pool), code_(code), name_(name), where_(frame_where) {}

    std::shared_ptr<const DynamicFrame> read() {
        choose("DEF_STYLE", {"PARAMETERIZED"});
        constexpr std::array kFamilies = {"TWO-VECTOR", "EULER", "MEAN_EQUATOR_AND_EQUINOX_OF_DATE",
                                          "TRUE_EQUATOR_AND_EQUINOX_OF_DATE",
                                          "MEAN_ECLIPTIC_AND_EQUINOX_OF_DATE"};
        const std::size_t family = choose("FAMILY", {kFamilies.begin(), kFamilies.end()});
        if (const auto key = find("FREEZE_EPOCH")) out_.frozen_et_s = number(*key);
        if (find("ROTATION_STATE")) {
            out_.inertial = choose("ROTATION_STATE", {"ROTATING", "INERTIAL"}) == 1;
            if (out_.frozen_et_s) fail("ROTATION_STATE", "does not go with FREEZE_EPOCH");
        }
        if (family == 0)
            read_vectors();
        else if (family == 1)
            read_angles();
        else
            read_earth(family - 2);
        return std::make_shared<const DynamicFrame>(std::move(out_));
    }

  private:
    const KernelPool& pool_;
    std::string code_, name_, where_;
    DynamicFrame out_;

    // Returns the variable's full name, with the frame's code or its name.
    std::optional<std::string> find(const std::string& item) const {
        for (const std::string& owner : {code_, name_})
            if (const std::string key = "FRAME_" + owner + "_" + item; pool_.find(key)) return key;
        return {};
    }
    std::string require(const std::string& item) const {
        const auto key = find(item);
        if (!key)
            throw InputError(where_ + ": no kernel has FRAME_" + code_ + "_" + item + ", which it needs");
        return *key;
    }
    [[noreturn]] void fail(const std::string& item, const std::string& what) const {
        const std::string key = require(item);
        throw InputError(pool_.find(key)->where + ": " + key + ": " + what);
    }
    // Returns a word in upper case without blanks.
    std::string word(const std::string& item) const {
        const std::string given = pool_.text(require(item)).value();
        std::string out;
        for (const char c : given)
            if (c != ' ') out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return out;
    }
    std::size_t choose(const std::string& item, const std::vector<std::string>& words) const {
        const std::string found = word(item);
        const auto at = std::find(words.begin(), words.end(), found);
        std::string accepted;
        for (const std::string& w : words) accepted += (accepted.empty() ? "" : ", ") + w;
        if (at == words.end()) fail(item, "found " + in_quotes(found) + "; accepted: " + accepted);
        return static_cast<std::size_t>(at - words.begin());
    }
    double number(const std::string& key) const { return pool_.require_numbers(key, 1, where_).front(); }
    double unit_rad(const std::string& item) const {
        constexpr std::array kUnits = {1.0, kDegree_rad, 60 * kArcsecond_rad, kArcsecond_rad};
        return kUnits[choose(item, {"RADIANS", "DEGREES", "ARCMINUTES", "ARCSECONDS"})];
    }
    int body(const std::string& item) const {
        const std::string key = require(item), where = pool_.find(key)->where + ": " + key;
        if (const KernelVariable* v = pool_.find(key); !v->numbers.empty()) return pool_.integer(key).value();
        return require_kernel_code(pool_, pool_.text(key).value(), where);
    }
    int frame(const std::string& item) const {
        const std::string key = require(item);
        return frame_code(pool_, pool_.text(key).value(), pool_.find(key)->where + ": " + key);
    }

    void read_earth(std::size_t which) {
        constexpr std::array kAxes = {EarthAxes::kMeanEquator, EarthAxes::kTrueEquator,
                                      EarthAxes::kMeanEcliptic};
        out_.family = DynamicFrame::Family::kEarth;
        out_.earth = kAxes[which];
        choose("PREC_MODEL", {"EARTH_IAU_1976"});
        if (out_.earth == EarthAxes::kTrueEquator) choose("NUT_MODEL", {"EARTH_IAU_1980"});
        if (out_.earth == EarthAxes::kMeanEcliptic) choose("OBLIQ_MODEL", {"EARTH_IAU_1980"});
        if (!out_.frozen_et_s) require("ROTATION_STATE");
    }

    void read_angles() {
        out_.family = DynamicFrame::Family::kEuler;
        out_.epoch_et_s = number(require("EPOCH"));
        const auto axes = pool_.require_numbers(require("AXES"), 3, where_);
        for (std::size_t i = 0; i < 3; ++i) {
            if (axes[i] != 1 && axes[i] != 2 && axes[i] != 3)
                fail("AXES", "found " + plain(axes[i]) + "; accepted: 1, 2, 3");
            out_.axes[i] = static_cast<int>(axes[i]);
        }
        if (out_.axes[1] == out_.axes[0] || out_.axes[1] == out_.axes[2])
            fail("AXES", "two neighbours are the same; accepted: others");
        const double unit = unit_rad("UNITS");
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string item = "ANGLE_" + std::to_string(i + 1) + "_COEFFS";
            const auto coefficients = pool_.numbers(require(item));
            constexpr std::size_t kMax = 20;  // the limit of NAIF's reader
            if (!coefficients || coefficients->size() > kMax)
                fail(item, "accepted: 1 to " + std::to_string(kMax) + " numbers");
            for (const double c : *coefficients) out_.angles_rad[i].push_back(unit * c);
        }
    }

    void read_vectors() {
        out_.family = DynamicFrame::Family::kTwoVector;
        out_.vectors = {read_vector("PRI_"), read_vector("SEC_")};
        if (out_.vectors[0].axis == out_.vectors[1].axis)
            fail("SEC_AXIS", "is that of the primary vector; accepted: another one");
        if (const auto key = find("ANGLE_SEP_TOL")) out_.min_angle_rad = number(*key);
        if (!(out_.min_angle_rad > 0))
            fail("ANGLE_SEP_TOL", "found " + plain(out_.min_angle_rad) + "; accepted: above 0");
    }
    FrameVector read_vector(const std::string& which) const {
        FrameVector out;
        const std::size_t axis = choose(which + "AXIS", {"X", "Y", "Z", "+X", "+Y", "+Z", "-X", "-Y", "-Z"});
        out.axis = axis % 3, out.sign = axis < 6 ? 1 : -1;
        switch (choose(which + "VECTOR_DEF",
                       {"OBSERVER_TARGET_POSITION", "OBSERVER_TARGET_VELOCITY", "CONSTANT"})) {
            case 0:
                out.kind = FrameVector::Kind::kPosition;
                break;
            case 1:
                out.kind = FrameVector::Kind::kVelocity;
                out.frame = frame(which + "FRAME");
                break;
            default:
                out.frame = frame(which + "FRAME");
                out.constant = read_constant(which);
        }
        if (out.kind != FrameVector::Kind::kConstant)
            out.observer = body(which + "OBSERVER"), out.target = body(which + "TARGET");
        if (find(which + "ABCORR")) choose(which + "ABCORR", {"NONE"});
        return out;
    }
    Vec3d read_constant(const std::string& which) const {
        const std::size_t spec = choose(which + "SPEC", {"RECTANGULAR", "LATITUDINAL", "RA/DEC"});
        if (spec == 0) {
            const auto v = pool_.require_numbers(require(which + "VECTOR"), 3, where_);
            const Vec3d out{v[0], v[1], v[2]};
            if (!(length(out) > 0)) fail(which + "VECTOR", "found no direction");
            return normalized(out);
        }
        const double unit = unit_rad(which + "UNITS");
        const double around = unit * number(require(which + (spec == 1 ? "LONGITUDE" : "RA"))),
                     up = unit * number(require(which + (spec == 1 ? "LATITUDE" : "DEC")));
        return {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
    }
};

Mat3d euler_matrix(const DynamicFrame& f, double et_s) {
    Mat3d out;
    for (std::size_t i = 0; i < 3; ++i) {
        double angle_rad = 0;
        for (std::size_t k = f.angles_rad[i].size(); k-- > 0;)
            angle_rad = angle_rad * (et_s - f.epoch_et_s) + f.angles_rad[i][k];
        out = out * turned_axes(f.axes[i], angle_rad);
    }
    return out;
}

}  // namespace

std::shared_ptr<const DynamicFrame> read_dynamic_frame(const KernelPool& pool, const std::string& code,
                                                       const std::string& name,
                                                       const std::string& frame_where) {
    return DynamicReader(pool, code, name, frame_where).read();
}

FrameTurn euler_turn(const DynamicFrame& f, double et_s) {
    constexpr double kStep_s = 1;
    const Mat3d now = euler_matrix(f, et_s);
    return {now, rate_of(now, euler_matrix(f, et_s - kStep_s), euler_matrix(f, et_s + kStep_s), 2 * kStep_s)};
}

std::optional<Mat3d> two_vector_axes(const DynamicFrame& f, Vec3d primary, Vec3d secondary) {
    const auto [first, second] = f.vectors;
    const Vec3d p = first.sign * primary, s = second.sign * secondary;
    const double apart_rad = angle_between_rad(p, s);
    if (!(apart_rad > f.min_angle_rad && kPi - apart_rad > f.min_angle_rad)) return {};
    std::array<Vec3d, 3> axes;
    axes[first.axis] = normalized(p);
    // The third axis makes the frame right-handed: first x second where they follow each other cyclically,
    // else the reverse.
    const std::size_t third = 3 - first.axis - second.axis;
    const double sign = (first.axis + 1) % 3 == second.axis ? 1 : -1;
    axes[third] = sign * normalized(cross(p, s));
    axes[second.axis] = sign * cross(axes[third], axes[first.axis]);
    return transposed(Mat3d{axes[0], axes[1], axes[2]});
}

}  // namespace hilcam
