#include "emulator/campaign/bop_models.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "emulator/campaign/case_plan.h"
#include "emulator/campaign/label_writer.h"
#include "emulator/progress/progress.h"
#include "emulator/scenario/scene_loader.h"
#include "io/system/durable_file.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/point_diameter.h"

namespace hilcam {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kMm_m = 1e3;

// The corners of a mesh's triangles, without unused vertices.
struct Model {
    std::vector<Vec3d> vertices_mm;
    std::vector<Vec3d> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Sums the normals of the triangles about each vertex, weighted by their angles there, as the format asks
// (Thuerrner & Wuethrich 1998, Computing vertex normals from polygonal facets).
std::vector<Vec3d> vertex_normals(const Model& model) {
    std::vector<Vec3d> sums(model.vertices_mm.size());
    for (const auto& triangle : model.triangles) {
        std::array<Vec3d, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = model.vertices_mm[triangle[k]];
        const Vec3d area = cross(p[1] - p[0], p[2] - p[0]);
        if (!(length(area) > 0)) continue;
        for (std::size_t k = 0; k < 3; ++k)
            sums[triangle[k]] =
                sums[triangle[k]] +
                angle_between_rad(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]) * normalized(area);
    }
    for (Vec3d& sum : sums) sum = length(sum) > 0 ? normalized(sum) : Vec3d{0, 0, 1};
    return sums;
}

Model model_of(const Mesh& mesh) {
    constexpr std::uint32_t kUnused = ~0u;
    std::vector<std::uint32_t> number_of(mesh.vertices_m.size(), kUnused);
    Model model;
    for (auto triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            std::uint32_t& number = number_of[corner];
            if (number == kUnused) {
                number = static_cast<std::uint32_t>(model.vertices_mm.size());
                model.vertices_mm.push_back(kMm_m * to_double(mesh.vertices_m[corner]));
                if (!mesh.normals.empty()) model.normals.push_back(to_double(mesh.normals[corner]));
            }
            corner = number;
        }
        model.triangles.push_back(triangle);
    }
    if (model.normals.empty()) model.normals = vertex_normals(model);
    return model;
}

std::string ply_of(const Model& model) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {}\nproperty list "
        "uchar int vertex_indices\nend_header\n",
        model.vertices_mm.size(), model.triangles.size());
    for (std::size_t i = 0; i < model.vertices_mm.size(); ++i) {
        const Vec3d &p = model.vertices_mm[i], &n = model.normals[i];
        fmt::format_to(out, "{:.9g} {:.9g} {:.9g} {:.6g} {:.6g} {:.6g}\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
    for (const auto& triangle : model.triangles)
        fmt::format_to(out, "3 {} {} {}\n", triangle[0], triangle[1], triangle[2]);
    return text;
}

OrderedJson info_of(const Model& model) {
    Vec3d least = model.vertices_mm.front(), most = least;
    for (const Vec3d& p : model.vertices_mm) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    return {{"diameter", point_diameter(model.vertices_mm)},
            {"min_x", least.x},
            {"min_y", least.y},
            {"min_z", least.z},
            {"size_x", most.x - least.x},
            {"size_y", most.y - least.y},
            {"size_z", most.z - least.z}};
}

// True when the keys that the cases vary change the shape of that object (0, 1, ...).
bool has_other_shapes(const std::vector<std::string>& keys, std::size_t object) {
    const std::string prefix = "objects." + std::to_string(object);
    return std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
        if (key == "objects" || key == prefix) return true;
        if (!key.starts_with(prefix + ".")) return false;
        const std::string below = key.substr(prefix.size() + 1);
        return below == "mesh" || below == "mesh_surface" || below == "scale" ||
               below.starts_with("generate");
    });
}

}  // namespace

void write_bop_models(const std::filesystem::path& folder, const CampaignConfig& campaign,
                      const std::vector<ObjectConfig>& objects) {
    const std::vector<std::string> keys = CaseDraw(campaign).columns();
    OrderedJson infos = OrderedJson::object();
    std::map<std::string, std::size_t> first_of_make;
    Progress progress("models", static_cast<double>(objects.size()));
    for (std::size_t i = 0; i < objects.size(); ++i) {
        progress.done(static_cast<double>(i));
        if (has_other_shapes(keys, i)) continue;
        const auto file_of = [&](std::size_t object) {
            return folder / ("obj_" + case_name(object + 1) + ".ply");
        };
        const std::string make =
            fmt::format("{} {} {}", mesh_name_of(objects[i]), objects[i].mesh_surface, objects[i].scale);
        const auto [first, is_new] = first_of_make.try_emplace(make, i);
        if (is_new) {
            const Model model = model_of(load_whole_mesh(objects[i]));
            write_durably(file_of(i), ply_of(model));
            infos[std::to_string(i + 1)] = info_of(model);
        } else {
            link_or_copy(file_of(first->second), file_of(i));
            infos[std::to_string(i + 1)] = infos[std::to_string(first->second + 1)];
        }
    }
    write_durably(folder / "models_info.json", infos.dump(2) + "\n");
}

}  // namespace hilcam
