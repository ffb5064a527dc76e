#include <nlohmann/json.hpp>

#include "emulator/check/mesh_survey.h"

namespace hilcam {

std::string to_json(const MeshSurvey& s) {
    using Json = nlohmann::ordered_json;
    Json surfaces = Json::array(), nodes = Json::array();
    for (const SurveyedSurface& surface : s.surfaces)
        surfaces.push_back({{"name", surface.name},
                            {"triangles", surface.triangles},
                            {"area_m2", surface.area_m2},
                            {"textured", surface.textured}});
    for (const MeshNode& node : s.nodes)
        nodes.push_back({{"name", node.name}, {"depth", node.depth}, {"triangles", node.triangles}});
    const Json out = {{"file", s.file},
                      {"size_m", {s.max_m.x - s.min_m.x, s.max_m.y - s.min_m.y, s.max_m.z - s.min_m.z}},
                      {"least_m", {s.min_m.x, s.min_m.y, s.min_m.z}},
                      {"most_m", {s.max_m.x, s.max_m.y, s.max_m.z}},
                      {"triangles", s.triangles},
                      {"vertices", s.vertices},
                      {"places", s.places},
                      {"shells", s.shells},
                      {"has_normals", s.has_normals},
                      {"surfaces", surfaces},
                      {"nodes", nodes},
                      {"probably_mm", s.probably_mm},
                      {"open_edges", s.open_edges},
                      {"inconsistent_edges", s.inconsistent_edges},
                      {"crowded_edges", s.crowded_edges},
                      {"inverted_shells", s.inverted_shells},
                      {"opposed_normals", s.opposed_normals},
                      {"leaning_normals", s.leaning_normals},
                      {"collapsed_triangles", s.collapsed_triangles},
                      {"sliver_triangles", s.sliver_triangles},
                      {"repeated_triangles", s.repeated_triangles},
                      {"unreadable_textures", s.unreadable_textures},
                      {"problems", problems_of(s)}};
    // Replaces invalid UTF-8, because names may be any bytes.
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hilcam
