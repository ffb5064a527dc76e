#include "io/truth/truth_document.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/contract/frame_flags.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

// Keeps keys in the order in which they are written here.
using OrderedJson = nlohmann::ordered_json;

// Rounds to a millionth of a pixel; further digits have no meaning.
double tidy_px(double px) { return std::round(px * 1e6) / 1e6; }
// Rounds to 1e-4, without the tail of digits that a float has as a double.
double tidy(float value) { return std::round(static_cast<double>(value) * 1e4) / 1e4; }

OrderedJson of(Vec3d v) { return OrderedJson::array({v.x, v.y, v.z}); }
OrderedJson of(Quat q) {
    // q and -q are one attitude.
    const double sign = q.w < 0 ? -1 : 1;
    return OrderedJson::array({sign * q.w, sign * q.x, sign * q.y, sign * q.z});
}
OrderedJson of(Vec2d px) { return OrderedJson::array({tidy_px(px.x), tidy_px(px.y)}); }
// Left, top, width, height.
OrderedJson of(const PixelBox& box) {
    if (box.empty()) return nullptr;
    return OrderedJson::array({box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0});
}

std::string_view name_of_body(std::uint32_t id) {
    if (id == kSunId) return "sun";
    for (std::size_t i = 0; i < kBodyCount; ++i)
        if (truth_id(static_cast<BodyId>(i)) == id) return kBodyNames[i];
    // Names of the scenario's own bodies, in order.
    constexpr std::array<std::string_view, kMaxOwnBodies> kOwn = {"body_1", "body_2", "body_3", "body_4",
                                                                  "body_5", "body_6", "body_7", "body_8"};
    for (std::size_t i = 0; i < kMaxOwnBodies; ++i)
        if (truth_id(static_cast<BodyId>(kBodyCount + i)) == id) return kOwn[i];
    return {};
}

OrderedJson image_of(const FrameTruth& t, const FrameRecord& record, const CameraModel& model) {
    const FrameIntrinsics lens = intrinsics_of(t.geometry, t.raster);
    const LensDistortion& d = t.geometry.distortion;
    const bool fisheye = d.projection == Projection::kFisheye;
    OrderedJson out = {{"width_px", t.raster.width_px},
                       {"height_px", t.raster.height_px},
                       {"binning", {record.binning_x, record.binning_y}},
                       {"reverse", {record.reverse_x, record.reverse_y}},
                       {"black_columns", model.black_columns},
                       {"black_rows", model.black_rows},
                       {"projection", fisheye ? "fisheye" : "rectilinear"},
                       {"focal_length_px", of(lens.focal_length_px)},
                       {"principal_point_px", of(lens.principal_point_px)},
                       {"distortion", fisheye ? OrderedJson::array({d.k1, d.k2, d.k3, d.k4})
                                              : OrderedJson::array({d.k1, d.k2, d.p1, d.p2, d.k3})}};
    if (d.polynomial.none()) return out;
    out["distortion_x"] = d.polynomial.terms_x();
    out["distortion_y"] = d.polynomial.terms_y();
    return out;
}

// Returns the part that objects and bodies share; the Sun has no axes.
OrderedJson thing_of(const SeenThing& thing, const std::string& name, const TruthRequest& request) {
    OrderedJson out = {{"id", thing.id}, {"name", name}, {"position_m", of(thing.world.position_world_m)}};
    const bool has_axes = thing.id != kSunId;
    if (has_axes) out["attitude_wxyz"] = of(thing.world.world_from_body);
    out["position_camera_m"] = of(thing.position_camera_m);
    if (has_axes) out["camera_from_body_wxyz"] = of(thing.camera_from_thing);
    out["distance_m"] = thing.distance_m;
    if (has_axes) out["phase_rad"] = thing.phase_rad;
    out["center_px"] = thing.has_center ? of(thing.center_px) : OrderedJson(nullptr);
    if (!request.visibility) return out;
    const bool visible = !thing.visible_box_px.empty();
    out["visible_px"] = thing.visible_px;
    out["visible_box_px"] = of(thing.visible_box_px);
    out["visible_center_px"] = visible ? of(thing.visible_center_px) : OrderedJson(nullptr);
    out["silhouette_px"] = thing.silhouette_px;
    out["silhouette_box_px"] = of(thing.silhouette_box_px);
    out["silhouette_cut"] = thing.silhouette_cut;
    out["visible_fraction"] = thing.visible_fraction;
    return out;
}

OrderedJson object_of(const SeenThing& thing, const std::string& name, const TruthRequest& request) {
    OrderedJson out = thing_of(thing, name, request);
    out["radius_m"] = thing.radius_m;
    out["sunlit_fraction"] = thing.sunlit;
    return out;
}

OrderedJson body_of(const SeenThing& thing, const TruthRequest& request) {
    OrderedJson out = thing_of(thing, std::string(name_of_body(thing.id)), request);
    out["equatorial_radius_m"] = thing.radius_m;
    out["polar_radius_m"] = thing.polar_radius_m;
    return out;
}

// figure: name of the thing's second figure.
OrderedJson ground_list(const std::vector<SeenGroundThing>& things, const char* figure) {
    OrderedJson out = OrderedJson::array();
    for (const SeenGroundThing& thing : things)
        out.push_back({{"longitude_deg", thing.longitude_deg},
                       {"latitude_deg", thing.latitude_deg},
                       {"diameter_m", thing.diameter_m},
                       {figure, thing.figure},
                       {"center_px", of(thing.place_px)},
                       {"diameter_px", thing.diameter_px},
                       {"distance_m", thing.distance_m},
                       {"visible", thing.visible ? OrderedJson(*thing.visible) : OrderedJson(nullptr)}});
    return out;
}

OrderedJson set_of(const FrameRecord& record) {
    return record.sequencer_set < 0 ? OrderedJson() : OrderedJson(record.sequencer_set);
}

}  // namespace

std::string TruthDocument::name_of_thing(const SeenThing& thing) const {
    if (thing.is_body) return std::string(name_of_body(thing.id));
    return thing.id - 1 < source_.things.size() ? source_.things[thing.id - 1] : std::string();
}

std::vector<std::string> TruthDocument::legend(const FrameTruth& t) const {
    std::vector<std::string> lines;
    for (const SeenThing& thing : t.things)
        lines.push_back(std::to_string(thing.id) + " " + name_of_thing(thing));
    return lines;
}

std::string TruthDocument::header() const {
    const RunLabel& run = source_.run;
    const OrderedJson out = {
        {"version", 1},
        {"run", {{"id", run.id}, {"scenario", run.scenario}, {"seed", run.seed}, {"program", run.program}}},
        {"camera", source_.camera},
        {"camera_name", source_.model.name}};
    return out.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::string TruthDocument::line(const FrameTruth& t, const FrameRecord& record, bool with_stars) const {
    OrderedJson out = {{"version", 1},
                       {"camera", source_.camera},
                       {"camera_name", source_.model.name},
                       {"frame", record.id},
                       {"time_utc", format_utc(record.exposure_mid)},
                       {"time_tai_ns", record.exposure_mid.ns},
                       {"shown_tai_ns", t.time.ns},
                       {"monotonic_ns", record.exposure_mid_monotonic_ns},
                       {"exposure_s", record.exposure_s},
                       {"gain_db", record.gain_db},
                       {"pose_sequence", record.pose_sequence},
                       {"trigger_sequence", record.trigger_sequence},
                       {"sequencer_set", set_of(record)},
                       {"quality_level", record.quality_level},
                       {"faults", names_of_bits(record.faults)},
                       {"image", image_of(t, record, source_.model)},
                       {"pose",
                        {{"position_m", of(t.camera.position_world_m)},
                         {"attitude_wxyz", of(t.camera.world_from_body)},
                         {"velocity_m_s", of(t.camera_velocity_m_s)},
                         {"rate_rad_s", of(t.camera_rate_rad_s)}}},
                       {"sun",
                        {{"direction", of(t.sun_world_dir)},
                         {"direction_camera", of(t.sun_camera_dir)},
                         {"distance_m", t.sun_distance_m}}}};
    if (t.height_above_ground_m) out["height_above_ground_m"] = *t.height_above_ground_m;
    OrderedJson objects = OrderedJson::array(), bodies = OrderedJson::array(), parts = OrderedJson::array(),
                stars = OrderedJson::array();
    for (const SeenThing& thing : t.things)
        if (thing.is_body)
            bodies.push_back(body_of(thing, t.request));
        else
            objects.push_back(object_of(thing, name_of_thing(thing), t.request));
    for (const SeenPart& part : t.parts)
        parts.push_back({{"object", part.thing},
                         {"name", part.object < source_.parts.size() ? source_.parts[part.object] : ""},
                         {"position_camera_m", of(part.position_camera_m)},
                         {"camera_from_part_wxyz", of(part.camera_from_part)}});
    out["objects"] = std::move(objects);
    out["parts"] = std::move(parts);
    out["bodies"] = std::move(bodies);
    if (source_.ground) {
        const SeenGroundThings ground = source_.ground->find(t);
        out["craters"] = ground_list(ground.craters, "worn");
        out["boulders"] = ground_list(ground.boulders, "height_m");
        out["ground_left_out"] = ground.left_out;
    }
    if (t.request.stars) {
        const double per_px = 1.0 / source_.oversampling;
        if (with_stars)
            for (const SeenStar& star : t.stars) {
                const Vec2d detector_px{per_px * star.image_px.x, per_px * star.image_px.y};
                stars.push_back(
                    {{"row", star.row},
                     {"hip", star.hip},
                     {"hd", star.hd},
                     {"position_px", of(star.position_px)},
                     {"magnitude_v", tidy(star.magnitude_v)},
                     {"electrons", electrons_.of(star.irradiance_w_m2_um, detector_px, record.exposure_s)}});
            }
        out["stars"] = std::move(stars);
        out["stars_left_out"] = t.stars_left_out + (with_stars ? 0 : t.stars.size());
    }
    // Names may have any bytes; invalid UTF-8 is replaced.
    return out.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace hilcam
