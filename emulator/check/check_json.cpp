#include <cmath>
#include <nlohmann/json.hpp>

#include "emulator/check/check_report.h"

namespace hilcam {
namespace {

using Json = nlohmann::ordered_json;

Json of(Vec3d v) { return {v.x, v.y, v.z}; }

const char* word_of(SeenObject::Place place) {
    constexpr const char* kWords[] = {"visible", "hidden", "outside", "behind"};
    return kWords[static_cast<std::size_t>(place)];
}

Json surfaces_of(const LoadedObject& o) {
    Json list = Json::array();
    for (const LoadedSurface& s : o.surfaces)
        list.push_back({{"name", s.name},
                        {"triangles", s.triangles},
                        {"area_m2", s.area_m2},
                        {"reflectance", s.reflectance},
                        {"rule", s.rule.empty() ? Json() : Json(s.rule)}});
    return list;
}

Json expected_of(const ExpectedSignal& e) {
    return {{"signal_e", e.signal_e}, {"dn", e.dn}, {"full_scale_ratio", e.full_scale}, {"snr", e.snr}};
}

Json object_of(const SeenObject& o) {
    return {{"name", o.loaded.name},
            {"size_m", of(o.loaded.max_m - o.loaded.min_m)},
            {"triangles", o.loaded.triangles},
            {"reflectance", o.loaded.mean_reflectance()},
            {"surfaces", surfaces_of(o.loaded)},
            {"idle_rules", o.loaded.idle_rules},
            {"left_out", o.loaded.left_out},
            {"place", word_of(o.place)},
            {"distance_m", o.distance_m},
            {"off_boresight_deg", degrees(o.off_boresight_rad)},
            {"silhouette_px", o.silhouette_px},
            {"picture_share", o.picture_share},
            {"visible_fraction", o.visible_fraction},
            {"camera_inside", o.holds_camera},
            {"phase_deg", degrees(o.phase_rad)},
            {"sunlit_fraction", o.sunlit},
            {"expected", expected_of(o.expected)}};
}

Json ground_of(const std::optional<GroundSight>& g) {
    if (!g) return {};
    return {{"body", g->body},
            {"distance_m", g->distance_m},
            {"pixel_m", g->pixel_m},
            {"field_m", {g->wide_m, g->high_m}},
            {"off_vertical_deg", degrees(g->off_vertical_rad)},
            {"sun_elevation_deg", degrees(g->sun_elevation_rad)},
            {"expected", g->expected ? expected_of(*g->expected) : Json()}};
}

Json sheet_of(const CameraSheet& s) {
    Json scenes = Json::array(), stars = Json::array();
    for (const CameraSheet::Scene& scene : s.scenes)
        scenes.push_back({{"name", scene.name}, {"signal_e", scene.signal_e}, {"snr", scene.snr}});
    for (const CameraSheet::Star& star : s.stars)
        stars.push_back({{"magnitude_v", star.magnitude},
                         {"total_e", star.total_e},
                         {"peak_e", star.peak_e},
                         {"snr", star.snr}});
    return {{"name", s.camera.name},
            {"width_px", s.camera.width_px},
            {"height_px", s.camera.height_px},
            {"pitch_um", s.camera.pitch_m * 1e6},
            {"frame_px", s.frame_px},
            {"frame_bytes", s.frame_bytes},
            {"field_deg", {degrees(s.field_x_rad), degrees(s.field_y_rad), degrees(s.field_diagonal_rad)}},
            {"ifov_urad", s.ifov_rad * 1e6},
            {"focal_length_mm", s.camera.focal_length_m * 1e3},
            {"f_number", s.camera.f_number},
            {"t_number", s.t_number},
            {"band_um", {s.from_um, s.to_um}},
            {"mean_um", s.mean_um},
            {"airy_radius_px", s.airy_radius_px},
            {"mtf_nyquist", {s.mtf_system_x, s.mtf_system_y}},
            {"exposure_ms", s.exposure_s * 1e3},
            {"gain_db", s.camera.gain_db},
            {"gain_dn_e", s.gain_dn_e},
            {"offset_dn", s.camera.offset_dn},
            {"most_dn", s.max_dn},
            {"full_scale_e", s.full_scale_e},
            {"well_e", s.well_e},
            {"converter_e", s.converter_e},
            {"response_e_s", s.response_e_s},
            {"saturation_w_m2_sr_um", s.saturation_w_m2_sr_um},
            {"dark_current_e_s", s.dark_e_s},
            {"dark_noise_e", s.dark_total_e},
            {"dynamic_range_db", 20 * std::log10(s.dynamic_range)},
            {"scenes", scenes},
            {"stars", stars},
            {"faintest_magnitude_v", s.faintest_magnitude}};
}

// Replaces invalid UTF-8, because names may be any bytes.
std::string dumped(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string to_json(const CameraSheet& sheet, const std::vector<std::string>& warnings) {
    Json out = sheet_of(sheet);
    out["warnings"] = warnings;
    return dumped(out);
}

std::string to_json(const CheckReport& report) {
    Json cameras = Json::array();
    for (const CameraReport& c : report.reports) {
        Json objects = Json::array();
        for (const SeenObject& o : c.sight.objects) objects.push_back(object_of(o));
        cameras.push_back({{"number", c.number},
                           {"objects", objects},
                           {"sun",
                            {{"distance_au", c.sight.sun_distance_au},
                             {"off_boresight_deg", degrees(c.sight.sun_off_boresight_rad)},
                             {"direction_camera", of(c.sight.sun_camera_dir)}}},
                           {"boresight",
                            {{"right_ascension_deg", degrees(c.sight.pointing.right_ascension_rad)},
                             {"declination_deg", degrees(c.sight.pointing.declination_rad)},
                             {"roll_deg", degrees(c.sight.pointing.roll_rad)}}},
                           {"height_above_ground_m",
                            c.sight.height_above_ground_m ? Json(*c.sight.height_above_ground_m) : Json()},
                           {"ground", ground_of(c.sight.ground)},
                           {"from_site_m", c.sight.from_site_m ? Json(of(*c.sight.from_site_m)) : Json()},
                           {"from_first_camera_m", of(c.sight.from_first_m)},
                           {"turned_from_first_deg", degrees(c.sight.turned_rad)},
                           {"sheet", sheet_of(c.sheet)},
                           {"frame_ms", c.frame_time ? Json{{"render", c.frame_time->render_ms},
                                                            {"sensor", c.frame_time->sensor_ms},
                                                            {"threads", c.frame_time->threads},
                                                            {"late", c.is_late()}}
                                                     : Json()},
                           {"share_in_bins", c.share_in_bins},
                           {"plan", c.plan}});
    }
    return dumped({{"warnings", report.warnings},
                   {"scenario", report.scenario},
                   {"time_utc", format_utc(report.time)},
                   {"cameras", cameras},
                   {"maps", report.maps},
                   {"run", report.run},
                   {"memory_mb", report.memory_mb > 0 ? Json(report.memory_mb) : Json()}});
}

}  // namespace hilcam
