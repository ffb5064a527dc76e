#pragma once
// Cheap checks of a mesh file before a library reads it, for what makes the library compute for minutes or
// allocate more than a file of that size can need. They throw InputError, one line that begins with `name`.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// More than any exporter makes, and few enough for readers that search them linearly.
inline constexpr std::size_t kMaxMaterials = 10'000;
// assimp triangulates a polygon in time quadratic in its corners: at this number, about a second.
inline constexpr std::size_t kMaxCorners = 10'000;
// A node takes more than a kilobyte of memory.
inline constexpr std::uint64_t kMaxMeshNodes = 200'000;
// 120 bytes each in memory, without the ray tracer's tree.
inline constexpr std::uint64_t kMaxTriangles = 100'000'000;
// Largest depth of a node, because the tree is traversed recursively.
inline constexpr std::uint32_t kDeepestNode = 1000;
// Largest number of texels in all textures of a file: 3 GB of colours.
inline constexpr std::uint64_t kMaxTexels = std::uint64_t{1} << 30;
// Vertices, normals, texture coordinates and corners, twice: the reader has a copy.
inline constexpr std::uint64_t kBytesPerTriangle = 250;

// The chunks of a binary glTF. `binary` is empty without that chunk. The file is refused when a chunk extends
// beyond it.
struct GlbChunks {
    std::string_view json, binary;
    bool has_binary = false;
};
GlbChunks require_glb_chunks(std::string_view glb, const std::string& name);

// Refuses a glTF file with too many nodes in a scene, or with nodes too deep. A node counts as often as it is
// a child.
void require_few_nodes(const nlohmann::json& gltf, const std::string& name);

// Counts the materials of an OBJ file and its libraries together, and refuses more than kMaxMaterials.
class ObjMaterials {
  public:
    // text: of an OBJ or MTL file.
    void add(std::string_view text, const std::string& name);

  private:
    std::set<std::string, std::less<>> names_;
};

// Throws InputError that lists textures that cannot be read.
[[noreturn]] void refuse_textures(const std::vector<std::string>& unreadable, const std::string& name);
[[noreturn]] void refuse_materials(std::size_t found, const std::string& name);

}  // namespace hilcam
