// The geometry of a primitive that KHR_draco_mesh_compression holds, as the primitive's accessors would give it.
#pragma once

#include <string>
#include <vector>

#include "loaders/draco_mesh.h"
#include "loaders/gltf_file.h"

namespace peelray {

class DracoGeometry {
  public:
    /// Decodes `source`. Throws Error, prefixed with `where`, for a stream that is damaged, claims far more than the
    /// accessors, or lacks an attribute.
    DracoGeometry(GltfFile& file, const DracoSource& source, const tinygltf::Primitive& primitive,
                  const std::string& where);
    DracoGeometry(const DracoGeometry&) = delete;
    DracoGeometry& operator=(const DracoGeometry&) = delete;

    bool has(const std::string& attribute) const { return attributes_.contains(attribute); }
    /// The accessor's type, with the stream's numbers of vertices and components.
    const GltfFile::Accessor& accessor(const std::string& attribute) const { return attributes_.at(attribute).info; }
    /// All components of all vertices; integers that the accessor calls normalised as [0, 1] or [-1, 1].
    std::vector<float> floats(const std::string& attribute) const;
    /// Three per triangle, in the stream's order.
    const std::vector<uint32_t>& corners() const { return mesh_.corners; }
    /// Whether the stream has as many vertices and triangles as the accessors say.
    bool matches_accessors() const { return matches_; }

  private:
    struct Attribute {
        GltfFile::Accessor info;
        const DracoMesh::Attribute* values;
    };

    DracoMesh mesh_;
    std::map<std::string, Attribute> attributes_;
    bool matches_ = true;
};

}  // namespace peelray
