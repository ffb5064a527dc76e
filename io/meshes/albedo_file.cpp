#include "io/meshes/albedo_file.h"

#include <algorithm>
#include <array>

#include "io/files/text_lines.h"
#include "io/system/input_file.h"
#include "render/scene/color_bands.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxAlbedoBytes = std::uintmax_t{4} << 30;
constexpr std::size_t kMaxAlbedos = 300'000'000;
constexpr double kMaxAlbedo = 1e6;
constexpr int kGreyCodes = 256;

Texture grey_ramp() {
    Texture ramp;
    ramp.name = "albedo";
    ramp.width = kGreyCodes, ramp.height = 1;
    for (int code = 0; code < kGreyCodes; ++code) {
        const auto grey = static_cast<std::uint8_t>(code);
        ramp.texels.push_back({grey, grey, grey});
    }
    return ramp;
}

// Finds the texture coordinate on the ramp for a linear value between 0 and 1.
class RampPlaces {
  public:
    RampPlaces() {
        for (int code = 0; code < kGreyCodes; ++code)
            values_[static_cast<std::size_t>(code)] = linear_from_srgb(static_cast<std::uint8_t>(code));
    }
    Vec2f of(float value) const {
        const auto above = std::upper_bound(values_.begin() + 1, values_.end() - 1, value);
        const float low = *(above - 1), high = *above;
        const auto code = static_cast<float>(above - 1 - values_.begin());
        return {(code + (value - low) / (high - low) + 0.5f) / kGreyCodes, 0.5f};
    }

  private:
    std::array<float, kGreyCodes> values_{};
};

// Returns the mean by area, of the facets or of their corners.
double mean_albedo(const Mesh& mesh, const std::vector<float>& albedos, bool of_facets) {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const auto at = [&](std::size_t k) { return static_cast<double>(albedos[k]); };
        const double albedo = of_facets ? at(i) : (at(t[0]) + at(t[1]) + at(t[2])) / 3;
        const double a = length(area_vector(mesh, t));
        sum += a * albedo, area += a;
    }
    return area > 0 ? sum / area : 0;
}

// Gives each triangle its own vertices.
void take_apart(Mesh& mesh) {
    std::vector<Vec3f> vertices_m, normals;
    vertices_m.reserve(3 * mesh.triangles.size());
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            if (!mesh.normals.empty()) normals.push_back(mesh.normals[corner]);
            vertices_m.push_back(mesh.vertices_m[corner]);
            corner = static_cast<std::uint32_t>(vertices_m.size() - 1);
        }
    mesh.vertices_m = std::move(vertices_m), mesh.normals = std::move(normals);
}

}  // namespace

std::vector<float> parse_albedos(std::string_view text, const std::string& name) {
    TextLines lines(text, name);
    std::vector<float> out;
    for (std::string_view line; lines.next(line);) {
        const std::string_view word = trimmed(line);
        if (word.empty() || word.starts_with('#')) continue;
        const auto value = number_of(word);
        if (!value || *value < 0 || *value > kMaxAlbedo) lines.refuse(word, "an albedo, 0 to 1000000");
        if (out.size() == kMaxAlbedos) lines.fail("has more than 300000000 albedos");
        out.push_back(static_cast<float>(*value));
    }
    if (out.empty()) throw InputError(name + ": has no albedo; accepted: a number a line");
    return out;
}

std::vector<float> read_albedos(const std::filesystem::path& file) {
    return parse_albedos(read_input_file(file, {kMaxAlbedoBytes, "a table of albedos"}), file.string());
}

double paint_albedos(Mesh& mesh, const std::vector<float>& albedos, std::optional<double> reference,
                     const std::string& name) {
    const bool of_facets = albedos.size() == mesh.triangles.size();
    if (!of_facets && albedos.size() != mesh.vertices_m.size())
        throw InputError(name + ": found " + std::to_string(albedos.size()) + " albedos; accepted: " +
                         std::to_string(mesh.triangles.size()) + ", one for each facet, or " +
                         std::to_string(mesh.vertices_m.size()) + ", one for each vertex");
    if (!mesh.textures.empty())
        throw InputError(name + ": the mesh has textures; accepted: albedos for one without");
    const auto greatest = static_cast<double>(*std::max_element(albedos.begin(), albedos.end()));
    const double base = reference.value_or(mean_albedo(mesh, albedos, of_facets));
    if (!(greatest > 0) || !(base > 0))
        throw InputError(name + ": all albedos are 0; accepted: some that are above");
    const RampPlaces places;
    const auto place_of = [&](std::size_t i) {
        return places.of(static_cast<float>(static_cast<double>(albedos[i]) / greatest));
    };
    if (of_facets) take_apart(mesh);
    mesh.uvs.resize(mesh.vertices_m.size());
    for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) mesh.uvs[i] = place_of(of_facets ? i / 3 : i);
    mesh.textures.push_back(grey_ramp());
    for (MeshSurface& surface : mesh.surfaces) surface.base_color_texture = 0;
    return greatest / base;
}

}  // namespace hilcam
