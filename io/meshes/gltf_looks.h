#pragma once
// Turns the materials of a glTF file into surfaces of a mesh: metallic-roughness or the older
// specular-glossiness, with textures. Collects the cuts that masks and metallic-roughness textures need, and
// the names of what is left out.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/gltf_document.h"
#include "io/meshes/left_out.h"
#include "io/meshes/surface_cutter.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// The placement of a texture on a surface: the set of texture coordinates, and their transform
// (KHR_texture_transform).
struct GltfTexturePlace {
    std::uint64_t uv_set = 0;
    Vec2f offset{0, 0}, scale{1, 1};
    float rotation_rad = 0;

    Vec2f of(Vec2f uv) const;
    bool operator==(const GltfTexturePlace& other) const;
};

class GltfLooks {
  public:
    // named: the materials of the primitives, in the order of the surfaces made from them. Pictures are read
    // only for materials that triangles have.
    struct Named {
        std::uint64_t material = 0;
        bool has_triangles = false;
    };
    GltfLooks(GltfDocument& document, const std::vector<Named>& named);

    // Returns the surface of a material; without a material, the default surface.
    std::size_t surface_of(std::optional<std::uint64_t> material) const;

    std::vector<MeshSurface> surfaces;  // one per material, the default, then those that cuts add
    std::vector<Texture> textures;
    std::vector<std::optional<GltfTexturePlace>> places;  // by surface; none: it has no textures
    std::vector<SurfaceCut> cuts;
    LeftOut left_out;
    std::vector<std::string> unreadable;  // textures that cannot be read, each the rest of a sentence

  private:
    using Json = GltfDocument::Json;
    // A texture as a material refers to it.
    struct Use {
        std::uint64_t texture = 0;
        GltfTexturePlace place;
    };
    // A picture with its wrapping beyond the edges.
    struct Picture {
        std::uint64_t image = 0;
        std::array<TextureWrap, 2> wrap{};
        bool smooth = true;
        auto operator<=>(const Picture&) const = default;
    };
    // A material and its numbers while it is read.
    struct Material {
        const Json& json;
        std::string name, where;
        std::size_t surface;
        std::optional<Use> colors;
        float alpha = 1;
    };

    GltfDocument& document_;
    std::map<std::uint64_t, std::size_t> surface_of_material_;
    std::map<Picture, int> known_;
    std::uint64_t texels_ = 0;

    void read(const Json& json, std::size_t surface, bool has_triangles);
    void read_metal_rough(Material& material);
    void read_specular(Material& material, const Json& specular);
    void set_colors(Material& material, const Json* texture);
    void cut_by_textures(const Material& material);
    void add_kinds(const Material& material, SurfaceCut cut);
    bool read_alpha(const Material& material, SurfaceCut& cut);
    bool read_metal_texture(const Material& material, SurfaceCut& cut);
    void read_sheet(const Material& material);
    void name_the_rest(const Material& material);
    std::optional<Use> use_of(const Json* texture, const std::string& where) const;
    std::optional<Picture> picture_of(std::uint64_t texture) const;
    std::string bytes_of(std::uint64_t image, const Material& material);
    int texture_of(const Picture& picture, const Material& material);
    // Calls read(). Returns false when it throws InputError about a picture, which is then added to
    // `unreadable`.
    template <class Read>
    bool is_read(const Read& read);
    void count_texels(const Texture& texture);
    static std::string what_is(std::uint64_t image, const Material& material);
};

}  // namespace hilcam
