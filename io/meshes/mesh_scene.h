#pragma once
// The scene that assimp makes of a mesh file. assimp is kept to the importer of the file's ending, to files that named_files.h allows,
// and to so many triangles as there may be.

#include <memory>

#include "io/meshes/mesh_source.h"
#include "io/meshes/named_files.h"

namespace Assimp {
class Importer;
}
struct aiScene;

namespace hilcam {

class MeshScene {
  public:
    // InputError; std::bad_alloc when memory is limited and runs out. Both must live longer.
    MeshScene(const MeshSource& source, NamedFiles& files);
    ~MeshScene();
    MeshScene(const MeshScene&) = delete;
    MeshScene& operator=(const MeshScene&) = delete;

    const aiScene& scene() const { return *scene_; }

  private:
    std::unique_ptr<Assimp::Importer> importer_;
    const aiScene* scene_ = nullptr;
};

}  // namespace hilcam
