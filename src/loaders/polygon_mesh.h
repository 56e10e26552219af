// What a mesh file (OBJ, PLY, STL, OFF) says, before it becomes primitives: polygons with any number of corners, and
// attributes per vertex, corner or face.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loaders/file_reader.h"
#include "scene/scene.h"

namespace peelray {

/// Stands for an attribute that a vertex, corner or face does not have.
constexpr uint32_t no_value = UINT32_MAX;

/// One attribute of a polygon mesh.
template <typename T>
struct MeshAttribute {
    enum class Per : uint8_t { vertex, corner, face };
    Per per = Per::vertex;
    std::vector<T> values;  ///< empty: the file has no such attribute
    /// One per vertex, corner or face: its value, or `no_value`. Empty: value i belongs to vertex, corner or face i.
    std::vector<uint32_t> indices;
};

struct PolygonMesh {
    /// Polygons that follow each other, of one object and one material.
    struct Part {
        uint32_t first = 0;     ///< polygon; the part ends where the next one begins
        uint32_t object = 0;    ///< index into `objects`
        uint32_t material = 0;  ///< index into Scene::materials
    };

    glm::dvec3 origin{0};              ///< what positions are relative to, see far_middle()
    std::vector<glm::vec3> positions;  ///< see relative()
    std::vector<uint32_t> corners;     ///< polygon after polygon: indices into positions
    std::vector<uint32_t> ends;        ///< per polygon: where its corners end; empty: all polygons are triangles
    MeshAttribute<glm::vec3> normals;  ///< of any length; without direction: as if it had none
    MeshAttribute<glm::vec2> uvs;      ///< v counts from the image's last row, as these formats do
    MeshAttribute<glm::vec4> colors;   ///< linear; see encoded_color()
    std::vector<std::string> objects;  ///< names; empty: one object without a name
    std::vector<Part> parts;           ///< ascending; empty: one part of object 0 and material 0

    uint32_t polygon_count() const;
    /// A position as the file has it, as one of `positions`.
    glm::vec3 relative(const glm::dvec3& position) const { return glm::vec3(position - origin); }
};

/// An integer colour of a file, scaled to [0, 1], as a linear one. Integer colours (8 or 16 bits a channel) are sRGB,
/// alpha is linear; colours that a file gives as floating-point numbers are linear already.
glm::vec4 encoded_color(const glm::vec4& encoded);

/// An 8-bit colour.
glm::vec4 encoded_color(uint8_t red, uint8_t green, uint8_t blue, uint8_t alpha = 255);

/// The middle of what polygons show, if it is so far away that floats would lose details: to be read once more,
/// relative to it. Nothing: it is not.
std::optional<glm::dvec3> far_middle(const PolygonMesh& mesh);

/// Reads a file of polygons: `read` what it says, with positions relative to an origin, and adds it to the scene, which
/// has its name and nothing else yet. Where the polygons turn out to be far away, reads it once more, so that positions
/// become floats only when they are near.
Scene load_polygons(const std::filesystem::path& path,
                    const std::function<PolygonMesh(FileReader& file, Scene& scene, const glm::dvec3& origin)>& read);

/// Adds a node and a mesh for each object and, in it, a primitive for each part, and notes of what could not be kept.
/// Triangles come in the order of the polygons, a polygon's in place. Vertices are split where attributes of corners or
/// faces differ, and joined where nothing does. Corners without a normal get a smooth one; edges sharper than 75° stay
/// hard. Throws Error, prefixed with the scene's name, for corners that name no vertex or one that is not finite.
void add_polygon_mesh(PolygonMesh mesh, Scene& scene);

}  // namespace peelray
