#pragma once
// Cheap looks at a mesh file before a library reads it: at what makes the library compute for minutes, or
// allocate what no file of that size can need. Throws InputError with one line that begins with `name`.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// More than any exporter makes, and few enough for readers that search them one by one.
inline constexpr std::size_t kMaxMaterials = 10'000;
// assimp triangulates a polygon in a time that grows with the square of its corners: here about a second.
inline constexpr std::size_t kMaxCorners = 10'000;
// A node is more than a kilobyte in memory.
inline constexpr std::uint64_t kMaxMeshNodes = 200'000;
// 120 bytes each in memory, before the tree of the ray tracer.
inline constexpr std::uint64_t kMaxTriangles = 100'000'000;
// The depth to which nodes may lie: their tree is gone down by recursion.
inline constexpr std::uint32_t kDeepestNode = 1000;
// All textures of a file together have at most so many: 3 GB of colours.
inline constexpr std::uint64_t kMaxTexels = std::uint64_t{1} << 30;
// Vertices, normals, places on textures, corners, and the same once more as a reader has them.
inline constexpr std::uint64_t kBytesPerTriangle = 250;

// The contents of a binary glTF: its parts lie in the file, or it is refused. `binary` is empty without that
// chunk.
struct GlbChunks {
    std::string_view json, binary;
    bool has_binary = false;
};
GlbChunks require_glb_chunks(std::string_view glb, const std::string& name);

// The nodes of the scene of a glTF file, each as often as it is a child of another.
void require_few_nodes(const nlohmann::json& gltf, const std::string& name);

// Materials of an OBJ file and of those that it names, together.
class ObjMaterials {
  public:
    // `text`: of an OBJ or MTL file.
    void add(std::string_view text, const std::string& name);

  private:
    std::set<std::string, std::less<>> names_;
};

// Says of textures that cannot be read which they are.
[[noreturn]] void refuse_textures(const std::vector<std::string>& unreadable, const std::string& name);
[[noreturn]] void refuse_materials(std::size_t found, const std::string& name);

}  // namespace hilcam
