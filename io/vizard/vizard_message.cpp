#include "io/vizard/vizard_message.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/vizard/vizard_geometry.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"
#include "vizard.pb.h"

namespace hilcam {
namespace {

// 50 years: added to any epoch that parse_utc() accepts, the sum stays inside TimeTai.
constexpr double kLongest_ns = 1.6e18;
constexpr double kRotationTolerance = 1e-6;
// Basilisk's messages have some kilobytes.
constexpr std::size_t kMaxBytes = 8u << 20;
constexpr std::size_t kMaxThings = 10'000, kMaxCameras = 255, kMaxResolutions = 1000;

// A list of numbers in a message; `what` names it in a refusal.
struct Numbers {
    const google::protobuf::RepeatedField<double>& values;
    std::string what;

    [[noreturn]] void refuse(const std::string& accepted) const {
        throw refused(what, std::to_string(values.size()) + " numbers", accepted);
    }
    Vec3d vector(double most) const {
        if (values.size() != 3) refuse("3");
        const Vec3d v{values[0], values[1], values[2]};
        if (!is_finite(v) || !(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= most))
            throw InputError(what + ": found a number that is not finite, or above " + plain(most));
        return v;
    }
    // Three numbers are MRPs, nine a matrix. An ephemeris without attitudes sends nine zeros.
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
            q = to_quat(transposed(m));
        }
        if (!std::isfinite(norm(q))) throw InputError(what + ": found numbers that are no rotation");
        return q;
    }
};

template <class Message>
VizardThing thing_of(const std::string& kind, const std::string& name, const Message& m) {
    const std::string what = kind + " " + in_quotes(name) + ": ";
    VizardThing thing;
    thing.name = name;
    thing.position_n_m = Numbers{m.position(), what + "position"}.vector(kFarthestPlace_m);
    if (!m.velocity().empty())
        thing.velocity_n_m_s = Numbers{m.velocity(), what + "velocity"}.vector(kFastestMotion_m_s);
    thing.n_from_body = Numbers{m.rotation(), what + "rotation"}.attitude();
    return thing;
}

VizardCamera camera_of(const hilcam_vizard::CameraConfig& m) {
    const std::string what = "camera " + std::to_string(m.cameraid()) + ": ";
    VizardCamera camera;
    camera.id = m.cameraid();
    camera.parent = m.parentname();
    if (!m.camerapos_b().empty())
        camera.position_body_m = Numbers{m.camerapos_b(), what + "cameraPos_B"}.vector(kFarthestPlace_m);
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

// An unset field has protobuf's zero; where zero is not possible, the protocol's default replaces it.
TimeTai epoch_of(const hilcam_vizard::EpochDateTime& e) {
    // Truncated to nanoseconds, because rounding could turn 59.9999999999 into 60.
    const double seconds = e.seconds() >= 0 && e.seconds() < 61 ? std::floor(e.seconds() * 1e9) * 1e-9 : 99;
    char text[128];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%012.9f", e.year() == 0 ? 2019 : e.year(),
                  e.month() == 0 ? 1 : e.month(), e.day() == 0 ? 1 : e.day(), e.hours(), e.minutes(),
                  seconds);
    return parse_utc(text);
}

std::int64_t elapsed_of(double ns) {
    if (!(ns >= 0 && ns <= kLongest_ns))
        throw refused("simTimeElapsed", plain(ns) + " ns", "0 to " + plain(kLongest_ns));
    return std::llround(ns);
}

// --- checks before anything is built from a message

// Calls see(field, bytes) for each field of a message; a number has no bytes. Returns false when the bytes
// are no message. (Protobuf's groups, wire types 3 and 4, do not exist in proto3.)
template <class See>
bool walk(std::span<const std::uint8_t> message, const See& see) {
    google::protobuf::io::CodedInputStream in(message.data(), static_cast<int>(message.size()));
    while (const std::uint32_t tag = in.ReadTag()) {
        std::span<const std::uint8_t> bytes;
        std::uint64_t number = 0;
        std::uint32_t length = 0;
        bool good = false;
        switch (tag & 7) {
            case 0:
                good = in.ReadVarint64(&number);
                break;
            case 1:
                good = in.Skip(8);
                break;
            case 2:
                good = in.ReadVarint32(&length) && length <= message.size();
                if (good) {
                    const auto begin = static_cast<std::size_t>(in.CurrentPosition());
                    good = in.Skip(static_cast<int>(length));
                    if (good) bytes = message.subspan(begin, length);
                }
                break;
            case 5:
                good = in.Skip(4);
                break;
            default:
                break;
        }
        if (!good) return false;
        see(tag >> 3, bytes);
    }
    return in.ConsumedEntireMessage();
}

void check_number(const char* what, std::size_t found, std::size_t most) {
    if (found > most)
        throw InputError("found " + std::to_string(found) + " " + what + "; accepted: up to " +
                         std::to_string(most));
}

// Two bytes of a message can become a spacecraft of a hundred bytes in memory, one byte a camera's resolution
// of eight. So both are counted before they are built. Returns false when the bytes are no message. Throws
// InputError.
bool numbers_fit(std::span<const std::uint8_t> message) {
    using hilcam_vizard::CameraConfig, hilcam_vizard::VizMessage;
    std::size_t spacecraft = 0, bodies = 0, cameras = 0, resolutions = 0;
    const auto in_camera = [&](std::uint32_t field, std::span<const std::uint8_t> bytes) {
        if (field == CameraConfig::kResolutionFieldNumber)
            resolutions += std::max<std::size_t>(1, bytes.size());
    };
    const bool good = walk(message, [&](std::uint32_t field, std::span<const std::uint8_t> bytes) {
        spacecraft += field == VizMessage::kSpacecraftFieldNumber;
        bodies += field == VizMessage::kCelestialBodiesFieldNumber;
        cameras += field == VizMessage::kCamerasFieldNumber;
        // A malformed one is left to the parser.
        if (field == VizMessage::kCamerasFieldNumber) walk(bytes, in_camera);
    });
    if (!good) return false;
    check_number("spacecraft", spacecraft, kMaxThings);
    check_number("bodies", bodies, kMaxThings);
    check_number("cameras", cameras, kMaxCameras);
    check_number("bytes of resolutions", resolutions, kMaxResolutions);
    return true;
}

// --- contents

VizardUpdate update_of(const hilcam_vizard::VizMessage& m) {
    VizardUpdate update;
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
    // Stops the library from printing to standard error what the refusal says.
    static const bool quiet = (google::protobuf::SetLogHandler(nullptr), true);
    static_cast<void>(quiet);
    const std::string size = std::to_string(bytes.size()) + " bytes";
    if (bytes.size() > kMaxBytes)
        return {{}, "found " + size + "; accepted: up to " + std::to_string(kMaxBytes)};
    try {
        hilcam_vizard::VizMessage message;
        if (!numbers_fit(bytes) || !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
            return {{}, "is no VizMessage (" + size + ")"};
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

}  // namespace hilcam
