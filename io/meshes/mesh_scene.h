#pragma once
// The scene that assimp reads from a mesh file. assimp may use only the importer for the file's ending, the
// files that named_files.h permits, and a bounded number of triangles.

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
    // Both must outlive this. Throws InputError, and std::bad_alloc when limited memory runs out.
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
