#include "io/images/picture_notes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/contract/frame_flags.h"
#include "render/vocabulary/quoted.h"
#include "sensor/auto_exposure.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json_value(const PictureNote& note) {
    return std::visit([](const auto& value) { return OrderedJson(value); }, note.value);
}
// Names may have any bytes; invalid UTF-8 is replaced.
std::string dumped(const OrderedJson& json) {
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::vector<double> distortion_of(const LensDistortion& d) {
    if (d.projection == Projection::kFisheye) return {d.k1, d.k2, d.k3, d.k4};
    return {d.k1, d.k2, d.p1, d.p2, d.k3};
}

void add_lens(const CameraModel& model, const PictureLayout& layout, PictureNotes& notes) {
    const FrameIntrinsics lens = lens_of(model, layout);
    const LensDistortion distortion = geometry_of(model, 0).distortion;
    const bool fisheye = distortion.projection == Projection::kFisheye;
    notes.push_back({"binning", "BINNING",
                     std::vector<std::int64_t>{layout.frame.binning_x, layout.frame.binning_y},
                     "columns and rows to one"});
    notes.push_back({"reverse", "REVERSE",
                     std::vector<std::int64_t>{layout.frame.reverse_x, layout.frame.reverse_y},
                     "1: mirrored left-right, up-down"});
    notes.push_back({"focal_length_px", "FOCALPX",
                     std::vector{lens.focal_length_px.x, lens.focal_length_px.y},
                     "px along x and y; negative: mirrored"});
    notes.push_back({"principal_point_px", "PRINCPX",
                     std::vector{lens.principal_point_px.x, lens.principal_point_px.y},
                     "px; centre of pixel (0, 0) at (0.5, 0.5)"});
    notes.push_back(
        {"projection", "PROJECT", std::string(fisheye ? "fisheye" : "rectilinear"), "of the lens"});
    if (!distortion.none())
        notes.push_back(
            {"distortion", "DISTORT", distortion_of(distortion),
             fisheye ? "k1, k2, k3, k4 as OpenCV orders them" : "k1, k2, p1, p2, k3 as in OpenCV"});
    const LensPolynomial& polynomial = distortion.polynomial;
    if (polynomial.none()) return;
    notes.push_back({"distortion_x", "DISTX",
                     std::vector(polynomial.terms_x().begin(), polynomial.terms_x().end()),
                     "added to x: terms 1, x, y, x2, xy, y2, x3.."});
    notes.push_back({"distortion_y", "DISTY",
                     std::vector(polynomial.terms_y().begin(), polynomial.terms_y().end()),
                     "added to y, likewise"});
}

// Camera axes: +x right, +y down, +z along the boresight; world: ICRF axes about the scenario's origin.
void add_pose(const Pose& camera, PictureNotes& notes) {
    const Vec3d& p = camera.position_world_m;
    const Quat& q = camera.world_from_body;
    const double sign = q.w < 0 ? -1 : 1;  // q and -q are one attitude
    notes.push_back(
        {"position_m", "CAMPOS", std::vector{p.x, p.y, p.z}, "m, the camera in the world (ICRF axes)"});
    notes.push_back({"attitude_wxyz", "CAMQUAT", std::vector{sign * q.w, sign * q.x, sign * q.y, sign * q.z},
                     "turns camera axes (x right, y down) into world"});
}

// Returns the DN of a pixel without light. When pixels are summed, so are their black levels.
double black_dn(const CameraModel& model, const FrameRecord& record) {
    const DnScale scale = dn_scale_of(model, {record.exposure_s,
                                              record.gain_db,
                                              record.black_level_dn,
                                              record.binning_x,
                                              record.binning_y,
                                              {},
                                              {},
                                              {}});
    return scale.square_root ? std::round(255 * std::sqrt(scale.black_dn / scale.max_dn)) : scale.black_dn;
}

}  // namespace

PictureLayout layout_of(const FrameRecord& record) {
    return {{record.binning_x, record.binning_y, record.reverse_x, record.reverse_y}, 1};
}

FrameIntrinsics lens_of(const CameraModel& model, const PictureLayout& layout) {
    const FrameIntrinsics lens = intrinsics_of(geometry_of(model, 0), raster_of(model, 1, layout.frame));
    const double m = layout.oversampling;
    return {{m * lens.focal_length_px.x, m * lens.focal_length_px.y},
            {m * lens.principal_point_px.x, m * lens.principal_point_px.y}};
}

PictureNotes notes_of(const PictureRun& run, const FrameRecord& record, const PictureLayout& layout,
                      const std::string& unit) {
    PictureNotes notes = {
        {"software", "CREATOR", run.software, "made this picture"},
        {"scenario", "SCENARIO", run.scenario, ""},
        {"camera", "CAMERA", run.camera, "on the bench, from 1"},
        {"camera_name", "INSTRUME", run.model.name, "camera model"},
        {"seed", "SEED", run.seed, "of the run's random numbers"},
        {"frame", "FRAME", static_cast<std::int64_t>(record.id), "of the run, from 1"},
        {"unit", "", unit, "of the numbers"},
        {"time_utc", "", format_utc(record.exposure_mid), "mid-exposure, simulated"},
        {"time_tai_ns", "TAI_NS", record.exposure_mid.ns, "ns, mid-exposure: TAI since 1970"},
        {"exposure_s", "EXPTIME", record.exposure_s, "s"},
        {"gain_db", "GAIN_DB", record.gain_db, "dB over the camera file's gain"},
        {"black_level_dn", "BLACK_DN", unit == "DN" ? black_dn(run.model, record) : record.black_level_dn,
         "DN"},
    };
    if (unit == "DN") notes.push_back({"bits", "BITS", std::int64_t{record.bits}, "of a DN, right-aligned"});
    add_lens(run.model, layout, notes);
    if (record.camera) add_pose(*record.camera, notes);
    std::string faults;
    for (const std::string_view name : names_of_bits(record.faults))
        faults.append(faults.empty() ? "" : " ").append(name);
    if (!faults.empty()) notes.push_back({"faults", "FAULTS", faults, "that strike the frame"});
    return notes;
}

const PictureNote* find_note(const PictureNotes& notes, std::string_view key) {
    const auto found =
        std::find_if(notes.begin(), notes.end(), [key](const PictureNote& note) { return note.key == key; });
    return found == notes.end() ? nullptr : &*found;
}

std::string text_of(const PictureNote& note) {
    const auto* const text = std::get_if<std::string>(&note.value);
    return text ? harmless(*text) : dumped(json_value(note));
}

// Software is a keyword of the PNG specification.
std::vector<std::pair<std::string, std::string>> png_texts(const PictureNotes& notes) {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const PictureNote& note : notes)
        texts.emplace_back(note.key == "software" ? "Software" : note.key, text_of(note));
    return texts;
}

std::string json_of(const PictureNotes& notes) {
    OrderedJson out = OrderedJson::object();
    for (const PictureNote& note : notes) out[note.key] = json_value(note);
    return dumped(out);
}

}  // namespace hilcam
