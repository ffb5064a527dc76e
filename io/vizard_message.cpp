#include "io/vizard_message.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/plain_number.h"
#include "io/vizard_geometry.h"
#include "render/check.h"
#include "render/units.h"
#include "vizard.pb.h"

namespace hilcam {
namespace {

// 10 000 au and the speed of light, as in command_payload.cpp: beyond these a number is a mistake, and
// squares stay finite.
constexpr double kFarthest_m = 1.5e15, kFastest_m_s = 3e8;
// 50 years: with any epoch that parse_utc() takes, the sum stays inside TimeTai.
constexpr double kLongest_ns = 1.6e18;
constexpr double kRotationTolerance = 1e-6;
// Basilisk's messages have some kilobytes. Two bytes can become a spacecraft of a hundred in memory.
constexpr std::size_t kMostBytes = 8u << 20;
constexpr int kMostThings = 10'000, kMostCameras = 255;

// A list of numbers of a message; `what` names it in a refusal.
struct Numbers {
    const google::protobuf::RepeatedField<double>& values;
    std::string what;

    [[noreturn]] void refuse(const std::string& accepted) const {
        throw InputError(what + ": found " + std::to_string(values.size()) +
                         " numbers; accepted: " + accepted);
    }
    Vec3d vector(double most) const {
        if (values.size() != 3) refuse("3");
        const Vec3d v{values[0], values[1], values[2]};
        if (!is_finite(v) || !(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= most))
            throw InputError(what + ": found a number that is not finite, or above " + plain(most));
        return v;
    }
    // Three numbers are MRPs, nine a matrix; nine zeros are what an ephemeris without attitudes gives.
    std::optional<Quat> attitude() const {
        if (values.empty()) return {};
        Quat q;
        if (values.size() == 3) {
            q = from_mrp(vector(1e100));
        } else {
            if (values.size() != 9) refuse("3 (MRPs) or 9 (a matrix)");
            if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0; })) return {};
            const Mat3d m{{values[0], values[1], values[2]},
                          {values[3], values[4], values[5]},
                          {values[6], values[7], values[8]}};
            if (!(rotation_error(m) <= kRotationTolerance))
                throw InputError(what + ": found a matrix that is no rotation");
            q = from_dcm(m);
        }
        if (!std::isfinite(norm(q))) throw InputError(what + ": found numbers that are no rotation");
        return q;
    }
};

template <class Message>
VizardThing thing_of(const std::string& kind, const std::string& name, const Message& m) {
    const std::string what = kind + " '" + shown(name) + "': ";
    VizardThing thing;
    thing.name = name;
    thing.position_n_m = Numbers{m.position(), what + "position"}.vector(kFarthest_m);
    if (!m.velocity().empty())
        thing.velocity_n_m_s = Numbers{m.velocity(), what + "velocity"}.vector(kFastest_m_s);
    thing.n_from_body = Numbers{m.rotation(), what + "rotation"}.attitude();
    return thing;
}

VizardCamera camera_of(const hilcam_vizard::CameraConfig& m) {
    const std::string what = "camera " + std::to_string(m.cameraid()) + ": ";
    VizardCamera camera;
    camera.id = m.cameraid();
    camera.parent = m.parentname();
    if (!m.camerapos_b().empty())
        camera.position_body_m = Numbers{m.camerapos_b(), what + "cameraPos_B"}.vector(kFarthest_m);
    camera.body_from_camera = body_from_camera(Numbers{m.cameradir_b(), what + "cameraDir_B"}.vector(1e100));
    if (!std::isfinite(norm(camera.body_from_camera)))
        throw InputError(what + "cameraDir_B: found numbers that are no rotation");
    if (!(m.fieldofview() >= 0 && m.fieldofview() < 180))
        throw InputError(what + "fieldOfView: found " + plain(m.fieldofview()) + " deg; accepted: 0 to 180");
    camera.field_of_view_rad = m.fieldofview() * kDegree_rad;
    if (m.resolution_size() == 2) camera.width_px = m.resolution(0), camera.height_px = m.resolution(1);
    camera.wants_depth = m.rendermode() == 1;
    return camera;
}

// Fields that are not set have protobuf's zero; the protocol's defaults stand for those that cannot be one.
TimeTai epoch_of(const hilcam_vizard::EpochDateTime& e) {
    // Cut, not rounded, to nanoseconds: 59.9999999999 must not become 60.
    const double seconds = e.seconds() >= 0 && e.seconds() < 61 ? std::floor(e.seconds() * 1e9) * 1e-9 : 99;
    char text[128];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%012.9f", e.year() == 0 ? 2019 : e.year(),
                  e.month() == 0 ? 1 : e.month(), e.day() == 0 ? 1 : e.day(), e.hours(), e.minutes(),
                  seconds);
    return parse_utc(text);
}

std::int64_t elapsed_of(double ns) {
    if (!(ns >= 0 && ns <= kLongest_ns))
        throw InputError("simTimeElapsed: found " + plain(ns) + " ns; accepted: 0 to " + plain(kLongest_ns));
    return std::llround(ns);
}

void check_number(const char* what, int found, int most) {
    if (found > most)
        throw InputError("found " + std::to_string(found) + " " + what + "; accepted: up to " +
                         std::to_string(most));
}

VizardUpdate update_of(const hilcam_vizard::VizMessage& m) {
    VizardUpdate update;
    check_number("spacecraft", m.spacecraft_size(), kMostThings);
    check_number("bodies", m.celestialbodies_size(), kMostThings);
    check_number("cameras", m.cameras_size(), kMostCameras);
    if (!m.has_currenttime()) throw InputError("currentTime is missing");
    update.frame_number = m.currenttime().framenumber();
    update.elapsed_ns = elapsed_of(m.currenttime().simtimeelapsed());
    if (m.has_epoch()) update.epoch = epoch_of(m.epoch());
    for (const auto& s : m.spacecraft())
        update.spacecraft.push_back(thing_of("spacecraft", s.spacecraftname(), s));
    for (const auto& b : m.celestialbodies()) update.bodies.push_back(thing_of("body", b.bodyname(), b));
    for (const auto& c : m.cameras()) update.cameras.push_back(camera_of(c));
    update.is_last = m.livesettings().terminatevizard();
    return update;
}

}  // namespace

DecodedVizardUpdate decode_vizard_update(std::span<const std::uint8_t> bytes) {
    // The library would print to standard error what is told in the refusal.
    static const bool quiet = (google::protobuf::SetLogHandler(nullptr), true);
    static_cast<void>(quiet);
    const std::string size = std::to_string(bytes.size()) + " bytes";
    if (bytes.size() > kMostBytes)
        return {{}, "found " + size + "; accepted: up to " + std::to_string(kMostBytes)};
    hilcam_vizard::VizMessage message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        return {{}, "is no VizMessage (" + size + ")"};
    try {
        return {update_of(message), {}};
    } catch (const InputError& error) {
        return {{}, error.what()};
    }
}

std::string encode_vizard_input(std::int64_t frame_number) {
    hilcam_vizard::VizInput input;
    input.set_framenumber(frame_number);
    return input.SerializeAsString();
}

std::string shown(const std::string& text) {
    constexpr std::size_t kMost = 60;
    std::string out = text.substr(0, kMost);
    for (char& c : out)
        if (c < ' ' || c > '~') c = '.';
    return out;
}

}  // namespace hilcam
