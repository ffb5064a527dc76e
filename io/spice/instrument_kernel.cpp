#include "io/spice/instrument_kernel.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/spice/kernel_names.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

class InstrumentReader {
  public:
    InstrumentReader(const KernelPool& pool, int code)
        : pool_(pool), prefix_("INS" + std::to_string(code) + "_") {}

    bool any() const {
        const auto at = pool_.all().lower_bound(prefix_);
        return at != pool_.all().end() && at->first.starts_with(prefix_);
    }
    std::string key(const char* item) const { return prefix_ + item; }
    std::optional<double> number(const char* item, double least, double most) const {
        const auto found = pool_.number(key(item));
        if (found && !(*found >= least && *found <= most))
            throw InputError(pool_.find(key(item))->where + ": " + key(item) + ": found " + plain(*found) +
                             "; accepted: " + plain(least) + " to " + plain(most));
        return found;
    }
    std::optional<Vec3d> direction(const char* item) const {
        const auto found = pool_.numbers(key(item));
        if (!found) return {};
        const auto v = pool_.require_numbers(key(item), 3, "a camera");
        const Vec3d out{v[0], v[1], v[2]};
        if (!(length(out) > 0))
            throw InputError(pool_.find(key(item))->where + ": " + key(item) + ": has no direction");
        return normalized(out);
    }
    std::optional<Vec2d> pair(const char* item, double most) const {
        const auto found = pool_.numbers(key(item));
        if (!found) return {};
        const auto v = pool_.require_numbers(key(item), 2, "a point of the detector");
        if (!(std::abs(v[0]) <= most && std::abs(v[1]) <= most))
            throw InputError(pool_.find(key(item))->where + ": " + key(item) + ": found " + plain(v[0]) +
                             ", " + plain(v[1]) + "; accepted: -" + plain(most) + " to " + plain(most));
        return Vec2d{v[0], v[1]};
    }
    std::string word(const char* item) const {
        const auto found = pool_.text(key(item));
        std::string out;
        for (const char c : found.value_or(""))
            out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return out;
    }
    std::span<const double> corners() const {
        for (const char* item : {"FOV_BOUNDARY_CORNERS", "FOV_BOUNDARY"})
            if (const auto found = pool_.numbers(key(item))) return *found;
        return {};
    }

  private:
    const KernelPool& pool_;
    std::string prefix_;
};

// The unit is the one in which the number is plausible for a pixel.
std::optional<double> pitch_of(const InstrumentReader& r) {
    if (const auto pitch = r.number("PIXEL_PITCH", 1e-3, 0.1)) return *pitch * 1e-3;
    const auto size = r.number("PIXEL_SIZE", 1e-6, 100);
    if (!size) return {};
    return *size >= 1 ? *size * 1e-6 : *size >= 1e-3 ? *size * 1e-3 : *size;
}

std::optional<double> half_field_of(const InstrumentReader& r, const std::optional<Vec3d>& boresight) {
    if (!boresight) return {};
    if (r.word("FOV_CLASS_SPEC") == "ANGLES") {
        const double unit_rad = r.word("FOV_ANGLE_UNITS") == "RADIANS" ? 1 : kDegree_rad;
        const auto one = r.number("FOV_REF_ANGLE", 0, 180), other = r.number("FOV_CROSS_ANGLE", 0, 180);
        if (!one) return {};
        // The corner of a rectangle of these half angles.
        const double a = std::tan(std::min(*one * unit_rad, 1.5)),
                     b = other ? std::tan(std::min(*other * unit_rad, 1.5)) : 0;
        return std::atan(r.word("FOV_SHAPE") == "RECTANGLE" ? std::hypot(a, b) : std::max(a, b));
    }
    const auto corners = r.corners();
    double out = 0;
    for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
        const Vec3d corner{corners[i], corners[i + 1], corners[i + 2]};
        if (length(corner) > 0) out = std::max(out, angle_between_rad(corner, *boresight));
    }
    if (!(out > 0)) return {};
    return out;
}

std::optional<Vec2d> center_of(const InstrumentReader& r, const InstrumentKernel& k) {
    constexpr double kMax_px = 16384, kFirst_px = 0.5;
    const auto x = r.number("DISTORTION_X", -kMax_px, kMax_px),
               y = r.number("DISTORTION_Y", -kMax_px, kMax_px);
    if (x && y) return Vec2d{*x + kFirst_px, *y + kFirst_px};
    const auto center = r.pair("CCD_CENTER", kMax_px);
    if (!center) return {};
    const bool from_one = k.samples && k.lines && center->x == 0.5 * (static_cast<double>(*k.samples) + 1) &&
                          center->y == 0.5 * (static_cast<double>(*k.lines) + 1);
    const double first_px = from_one ? -kFirst_px : kFirst_px;
    return Vec2d{center->x + first_px, center->y + first_px};
}

}  // namespace

InstrumentKernel instrument_kernel(const KernelPool& pool, std::string_view name, const std::string& key) {
    InstrumentKernel out;
    out.code = require_kernel_code(pool, name, key);
    const InstrumentReader r(pool, out.code);
    if (!r.any())
        throw InputError(key + ": found " + in_quotes(name) + ", and no kernel has INS" +
                         std::to_string(out.code) +
                         "_...; accepted: an instrument of an instrument kernel (IK)");
    out.frame = pool.text(r.key("FOV_FRAME")).value_or("");
    out.boresight = r.direction("BORESIGHT");
    if (const auto focal = r.number("FOCAL_LENGTH", 0.1, 1e6)) out.focal_length_m = *focal * 1e-3;
    out.pitch_m = pitch_of(r);
    if (const auto n = r.number("PIXEL_SAMPLES", 1, 65535)) out.samples = static_cast<std::int64_t>(*n);
    if (const auto n = r.number("PIXEL_LINES", 1, 65535)) out.lines = static_cast<std::int64_t>(*n);
    out.center_px = center_of(r, out);
    out.half_field_rad = half_field_of(r, out.boresight);
    return out;
}

}  // namespace hilcam
