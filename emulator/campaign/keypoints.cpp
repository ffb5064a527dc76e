#include "emulator/campaign/keypoints.h"

#include <algorithm>
#include <cmath>

#include "io/files/value_table_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxKeypoints = 10'000;

KeypointSet load_set(const KeypointsConfig& config) {
    const ValueTable table = read_value_table(config.file);
    if (table.rows.size() > kMaxKeypoints)
        throw InputError(table.name + ": found " + std::to_string(table.rows.size()) +
                         " points; accepted: " + std::to_string(kMaxKeypoints) + " at most");
    const std::size_t name = table.column("name"), x = table.column("x_m"), y = table.column("y_m"),
                      z = table.column("z_m");
    KeypointSet set{static_cast<std::uint32_t>(config.object), config.tolerance_m, {}, {}};
    const auto part = std::find(table.columns.begin(), table.columns.end(), "part");
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::string& word = table.rows[row][name];
        if (word.empty() || std::find(set.names.begin(), set.names.end(), word) != set.names.end())
            throw InputError(table.name + ":" + std::to_string(table.lines[row]) + ": name: found " +
                             in_quotes(word) + "; accepted: a name of its own for each point");
        set.names.push_back(word);
        set.nodes.push_back(part == table.columns.end()
                                ? std::string()
                                : table.rows[row][static_cast<std::size_t>(part - table.columns.begin())]);
        set.places_m.push_back({table.number(row, x), table.number(row, y), table.number(row, z)});
    }
    return set;
}

}  // namespace

std::vector<KeypointSet> load_keypoints(const std::vector<KeypointsConfig>& configs) {
    std::vector<KeypointSet> out;
    out.reserve(configs.size());
    for (const KeypointsConfig& config : configs) out.push_back(load_set(config));
    return out;
}

// The renderer's objects are the scenario's, followed by all their parts on joints (scene_loader.cpp).
void find_parts(const ScenarioConfig& scenario, std::vector<KeypointSet>& sets) {
    for (KeypointSet& set : sets) {
        set.parts.assign(set.nodes.size(), 0);
        for (std::size_t i = 0; i < set.nodes.size(); ++i) {
            if (set.nodes[i].empty()) continue;
            auto number = static_cast<std::uint32_t>(scenario.objects.size());
            std::string known;
            for (std::size_t object = 0; object < scenario.objects.size(); ++object)
                for (const JointConfig& joint : scenario.objects[object].joints) {
                    if (object + 1 == set.object) {
                        known += (known.empty() ? "" : ", ") + joint.node;
                        if (joint.node == set.nodes[i]) set.parts[i] = number;
                    }
                    ++number;
                }
            if (set.parts[i] == 0)
                throw InputError("keypoints: point " + in_quotes(set.names[i]) + ": part: found " +
                                 in_quotes(set.nodes[i]) + "; accepted: a node with a joint of object " +
                                 std::to_string(set.object) + ": " + (known.empty() ? "it has none" : known));
        }
    }
}

bool project_to_frame(const FrameTruth& truth, Vec3d place_camera_m, Vec2d& frame_px) {
    if (!(place_camera_m.z > 0)) return false;
    const Vec2d image_px = truth.geometry.project_px(place_camera_m);
    if (!std::isfinite(image_px.x) || !std::isfinite(image_px.y) ||
        !truth.geometry.shows(place_camera_m, image_px))
        return false;
    frame_px = truth.raster.frame_px(image_px);
    return true;
}

std::vector<SeenKeypoint> seen_keypoints(const KeypointSet& set, const FrameTruth& truth) {
    std::vector<SeenKeypoint> out(set.places_m.size());
    const auto thing = std::find_if(truth.things.begin(), truth.things.end(),
                                    [&](const SeenThing& t) { return !t.is_body && t.id == set.object; });
    if (thing == truth.things.end()) return out;
    const Mat3d camera_from_thing = to_matrix(thing->camera_from_thing);
    for (std::size_t i = 0; i < out.size(); ++i) {
        Vec3d at_m = camera_from_thing * set.places_m[i] + thing->position_camera_m;
        if (i < set.parts.size() && set.parts[i] > 0)
            for (const SeenPart& part : truth.parts)
                if (part.object == set.parts[i])
                    at_m = to_matrix(part.camera_from_part) * set.places_m[i] + part.position_camera_m;
        if (!project_to_frame(truth, at_m, out[i].place_px)) continue;
        const int x = static_cast<int>(std::floor(std::clamp(out[i].place_px.x, -1.0, 1e8)));
        const int y = static_cast<int>(std::floor(std::clamp(out[i].place_px.y, -1.0, 1e8)));
        if (x < 0 || y < 0 || x >= truth.raster.width_px || y >= truth.raster.height_px) continue;
        const auto nearest_m = static_cast<double>(truth.layers.depth_m.row(y)[static_cast<std::size_t>(x)]);
        out[i].visibility = nearest_m < at_m.z - set.tolerance_m ? 1 : 2;
    }
    return out;
}

}  // namespace hilcam
