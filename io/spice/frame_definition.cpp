#include "io/spice/frame_definition.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "io/spice/dynamic_frame.h"
#include "io/spice/kernel_names.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Mat3d turned_axes(int axis, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    if (axis == 1) return {{1, 0, 0}, {0, c, s}, {0, -s, c}};
    if (axis == 2) return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

namespace {

// First code of the frames IAU_<body>, in a range that NAIF does not use. The Sun, planets and their moons
// have NAIF's own codes, from 10010 on.
constexpr int kIauBase = 1'200'000'000;
// Returns the body of the frames 10010 to 10080: the Sun, the planets, the Moon, then moons in the order of
// their codes.
std::optional<int> iau_body(int frame) {
    constexpr std::array kFirst = {10, 199, 299, 399, 499, 599, 699, 799, 899, 999, 301};
    constexpr std::array<std::pair<int, int>, 6> kMoons = {
        {{401, 2}, {501, 16}, {601, 18}, {701, 15}, {801, 8}, {901, 1}}};
    int at = frame - 10010;
    if (at < 0) return {};
    if (at < static_cast<int>(kFirst.size())) return kFirst[static_cast<std::size_t>(at)];
    at -= static_cast<int>(kFirst.size());
    for (const auto& [code, count] : kMoons) {
        if (at < count) return code + at;
        at -= count;
    }
    return {};
}
constexpr int kItrf93 = 13000, kItrf93Class = 3000;

std::string upper(std::string_view text) {
    std::string out;
    for (const char c : text) out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return out;
}

// Axes of older ephemerides relative to those of DE-400, 402 and 403, which are J2000's: appendix of "Frames
// Required Reading".
struct OldFrame {
    const char* name;
    int code;
    Mat3d frame_from_j2000;
};
constexpr std::array kOldFrames = {
    OldFrame{"DE-140",
             19,
             {{0.9999256765384668, 0.0111817701197967, 0.0048589521583895},
              {-0.0111817701797229, 0.9999374816848701, -0.0000271545195858},
              {-0.0048589520204830, -0.0000271791849815, 0.9999881948535965}}},
    OldFrame{"DE-142",
             20,
             {{0.9999256765402605, 0.0111817697320531, 0.0048589526815484},
              {-0.0111817697907755, 0.9999374816892126, -0.0000271547693170},
              {-0.0048589525464121, -0.0000271789392288, 0.9999881948510477}}},
    OldFrame{"DE-143",
             21,
             {{0.9999256765435852, 0.0111817743077255, 0.0048589414674762},
              {-0.0111817743300355, 0.9999374816382505, -0.0000271622115251},
              {-0.0048589414161348, -0.0000271713942366, 0.9999881949053349}}}};

std::optional<FrameDefinition> inertial(std::string_view name, int code) {
    const auto made = [](int number, const char* text, const Mat3d& frame_from_j2000) {
        return FrameDefinition{
            number, text,      FrameClass::kInertial, number, transposed(frame_from_j2000), kJ2000Frame,
            {},     "built in"};
    };
    const auto is = [&](const char* text, int number) { return name == text || code == number; };
    if (is("J2000", kJ2000Frame) || name == "ICRF") return made(kJ2000Frame, "J2000", {});
    // Both are within 0.03 arcsec of J2000; NAIF treats them as J2000.
    if (is("DE-200", 14)) return made(14, "DE-200", {});
    if (is("DE-202", 15)) return made(15, "DE-202", {});
    // The obliquity of the ecliptic at J2000, Lieske 1979.
    if (is("ECLIPJ2000", 17)) return made(17, "ECLIPJ2000", turned_axes(1, 84381.448 * kArcsecond_rad));
    // The frames before J2000, from the appendix of "Frames Required Reading".
    const Mat3d b1950 = turned_axes(3, 1152.84248596724 * kArcsecond_rad) *
                        turned_axes(2, -1002.26108439117 * kArcsecond_rad) *
                        turned_axes(3, 1153.04066200330 * kArcsecond_rad);
    const Mat3d fk4 = turned_axes(3, 0.525 * kArcsecond_rad) * b1950;
    if (is("B1950", 2)) return made(2, "B1950", b1950);
    if (is("FK4", 3)) return made(3, "FK4", fk4);
    if (is("DE-118", 4)) return made(4, "DE-118", turned_axes(3, 0.53155 * kArcsecond_rad) * b1950);
    // Mars's mean equator of J2000 and its node on the Earth's (pole: Davies et al., Celest. Mech. 46, 1989,
    // 187).
    if (is("MARSIAU", 16))
        return made(
            16, "MARSIAU",
            turned_axes(1, (90 - 52.886) * kDegree_rad) * turned_axes(3, (90 + 317.681) * kDegree_rad));
    for (const OldFrame& old : kOldFrames)
        if (is(old.name, old.code)) return made(old.code, old.name, old.frame_from_j2000);
    if (is("GALACTIC", 13))
        return made(13, "GALACTIC",
                    turned_axes(3, 327 * kDegree_rad) * turned_axes(1, 62.6 * kDegree_rad) *
                        turned_axes(3, 282.25 * kDegree_rad) * fk4);
    return {};
}

std::optional<FrameDefinition> body_frame(const KernelPool& pool, std::string_view name, int code) {
    FrameDefinition out;
    out.kind = FrameClass::kPck, out.where = "built in";
    if (name == "ITRF93" || code == kItrf93) {
        out.code = kItrf93, out.name = "ITRF93", out.class_code = kItrf93Class;
        return out;
    }
    std::optional<int> body;
    if (name.starts_with("IAU_")) body = kernel_code(pool, name.substr(4));
    if (code != 0 && code < kIauBase) body = iau_body(code);
    if (code >= kIauBase) body = code - kIauBase;
    if (!body || *body < 0 || *body > 900'000'000) return {};
    out.class_code = *body, out.code = kIauBase + *body;
    out.name = name.empty() ? "IAU_" + std::to_string(*body) : std::string(name);
    return out;
}

class FrameReader {
  public:
    FrameReader(const KernelPool& pool, int code) : pool_(pool), code_(code), id_(std::to_string(code)) {}

    std::optional<FrameDefinition> read() {
        const auto kind = pool_.integer("FRAME_" + id_ + "_CLASS");
        if (!kind) return {};
        FrameDefinition out;
        out.code = code_;
        out.name = pool_.text("FRAME_" + id_ + "_NAME").value_or(id_);
        out.where = pool_.find("FRAME_" + id_ + "_CLASS")->where;
        out.class_code = pool_.integer("FRAME_" + id_ + "_CLASS_ID").value_or(code_);
        if (*kind < 2 || *kind > 5)
            throw InputError(out.where + ": frame " + in_quotes(out.name) + ": found class " +
                             std::to_string(*kind) +
                             "; accepted: 2 (PCK), 3 (CK), 4 (fixed offset), 5 (dynamic)");
        out.kind = static_cast<FrameClass>(*kind);
        if (out.kind == FrameClass::kFixedOffset) read_offset(out);
        if (out.kind == FrameClass::kDynamic) read_dynamic(out);
        return out;
    }

  private:
    const KernelPool& pool_;
    int code_;
    std::string id_;

    // Returns a key of the offset, with the frame's code or its name.
    std::string key(const FrameDefinition& frame, const char* item) const {
        for (const std::string& owner : {id_, frame.name})
            if (const std::string name = "TKFRAME_" + owner + "_" + item; pool_.find(name)) return name;
        throw InputError(frame.where + ": frame " + in_quotes(frame.name) + ": no kernel has TKFRAME_" + id_ +
                         "_" + item + ", which its offset needs");
    }
    void read_dynamic(FrameDefinition& out) const {
        const std::string where = out.where + ": frame " + in_quotes(out.name);
        for (const std::string& owner : {id_, out.name})
            if (const auto base = pool_.text("FRAME_" + owner + "_RELATIVE")) {
                out.relative = frame_code(pool_, *base, where);
                out.dynamic = read_dynamic_frame(pool_, id_, out.name, where);
                return;
            }
        throw InputError(where + ": no kernel has FRAME_" + id_ + "_RELATIVE, which it needs");
    }
    void read_offset(FrameDefinition& out) const {
        const std::string relative = key(out, "RELATIVE"), spec_key = key(out, "SPEC");
        const std::string spec = upper(pool_.text(spec_key).value());
        out.relative =
            frame_code(pool_, pool_.text(relative).value(), pool_.find(relative)->where + ": " + relative);
        if (spec == "ANGLES") {
            out.relative_from_frame = from_angles(out);
        } else if (spec == "MATRIX") {
            const auto m = pool_.require_numbers(key(out, "MATRIX"), 9, "frame " + out.name);
            out.relative_from_frame = {{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}};
        } else if (spec == "QUATERNION") {
            const auto q = pool_.require_numbers(key(out, "Q"), 4, "frame " + out.name);
            out.relative_from_frame = to_matrix(normalized(Quat{q[0], q[1], q[2], q[3]}));
        } else {
            throw InputError(pool_.find(spec_key)->where + ": " + spec_key + ": found " + in_quotes(spec) +
                             "; accepted: ANGLES, MATRIX, QUATERNION");
        }
        check(out);
    }
    Mat3d from_angles(const FrameDefinition& frame) const {
        const auto angles = pool_.require_numbers(key(frame, "ANGLES"), 3, "frame " + frame.name);
        const std::string axes_key = key(frame, "AXES"), units_key = key(frame, "UNITS");
        const auto axes = pool_.require_numbers(axes_key, 3, "frame " + frame.name);
        const std::string units = upper(pool_.text(units_key).value());
        const double unit_rad = units == "DEGREES"      ? kDegree_rad
                                : units == "RADIANS"    ? 1
                                : units == "ARCSECONDS" ? kArcsecond_rad
                                : units == "ARCMINUTES" ? 60 * kArcsecond_rad
                                                        : 0;
        if (unit_rad == 0)
            throw InputError(pool_.find(units_key)->where + ": " + units_key + ": found " + in_quotes(units) +
                             "; accepted: DEGREES, RADIANS, ARCSECONDS, ARCMINUTES");
        Mat3d out;
        for (std::size_t i = 0; i < 3; ++i) {
            if (axes[i] != 1 && axes[i] != 2 && axes[i] != 3)
                throw InputError(pool_.find(axes_key)->where + ": " + axes_key + ": accepted: 1, 2, 3");
            out = out * turned_axes(static_cast<int>(axes[i]), angles[i] * unit_rad);
        }
        return out;
    }
    // Kernels give rotation matrices with few digits: they are orthonormalized if the error is small.
    static void check(FrameDefinition& f) {
        const Mat3d& m = f.relative_from_frame;
        const double error = std::max({std::abs(dot(m.x, m.x) - 1), std::abs(dot(m.y, m.y) - 1),
                                       std::abs(dot(m.x, m.y)), std::abs(dot(cross(m.x, m.y), m.z) - 1)});
        if (!(error < 1e-3))
            throw InputError(f.where + ": frame " + in_quotes(f.name) + ": its matrix is no rotation");
        const Vec3d x = normalized(m.x), z = normalized(cross(x, m.y));
        f.relative_from_frame = {x, cross(z, x), z};
    }
};

}  // namespace

int frame_code(const KernelPool& pool, const std::string& name, const std::string& where) {
    const std::string wanted = upper(name);
    if (const auto code = parsed_as<int>(name)) return *code;
    if (const auto found = inertial(wanted, 0)) return found->code;
    if (const auto code = pool.integer("FRAME_" + wanted)) return *code;
    if (const auto found = body_frame(pool, wanted, 0)) return found->code;
    throw InputError(where + ": found the frame " + in_quotes(name) +
                     "; accepted: J2000, ECLIPJ2000, a frame of a frames kernel (FK), IAU_<body>");
}

FrameDefinition frame_coded(const KernelPool& pool, int code, const std::string& key) {
    if (auto found = inertial("", code)) return *found;
    if (auto found = FrameReader(pool, code).read()) return *found;
    if (auto found = body_frame(pool, "", code)) return *found;
    throw InputError(key + ": found the frame " + std::to_string(code) +
                     "; accepted: J2000, ECLIPJ2000, a frame of a frames kernel (FK), IAU_<body>");
}

FrameDefinition frame_named(const KernelPool& pool, std::string_view name, const std::string& key) {
    if (const auto code = parsed_as<int>(name)) return frame_coded(pool, *code, key);
    const std::string wanted = upper(name);
    if (auto found = inertial(wanted, 0)) return *found;
    if (const auto code = pool.integer("FRAME_" + wanted)) {
        if (auto found = FrameReader(pool, *code).read()) return *found;
        throw InputError(pool.find("FRAME_" + wanted)->where + ": frame " + in_quotes(wanted) +
                         ": no kernel has FRAME_" + std::to_string(*code) + "_CLASS");
    }
    if (auto found = body_frame(pool, wanted, 0)) return *found;
    throw InputError(key + ": found the frame " + in_quotes(name) +
                     "; accepted: J2000, ECLIPJ2000, a frame of a frames kernel (FK), IAU_<body>");
}

}  // namespace hilcam
