// The scene as it was read, which never changes (a moment of its animations is a Moment): meshes, materials, textures,
// a node hierarchy, lights and cameras. No GPU in sight. Conventions (docs/conventions.md): right-handed, +y up,
// metres; colours linear Rec. 709; angles in radians.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/cube_light.h"
#include "scene/generated.h"

namespace peelray {

/// An image of RGBA texels, row 0 first (the glTF order: v = 0 is the first row), and how it is sampled. Whether red,
/// green and blue are sRGB-encoded is for the use to say; alpha is linear.
struct Texture {
    enum class Wrap : uint8_t { repeat, mirror, clamp };
    enum class Mipmaps : uint8_t { none, nearest, linear };
    std::string name;
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> texels;       ///< width·height of 8 bits a channel, red in the lowest byte
    std::vector<uint64_t> deep_texels;  ///< instead of them: 16 bits a channel, red in the lowest
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;      ///< where it is magnified: the nearest texel instead of the four around
    bool min_nearest = false;  ///< the same where it is made smaller
    /// Which of its levels serve where it is made smaller (scene/mipmaps.h): the first alone, the nearest, two.
    Mipmaps mipmaps = Mipmaps::linear;
};

/// A texture as a material uses it. Only its default and its number alone are implicit.
struct MaterialTexture {
    int texture = -1;        ///< index into Scene::textures, -1: none
    uint32_t uv_set = 0;     ///< of the primitive's texture coordinates
    uint32_t channel = 0;    ///< what a single number is read from: 0 to 3, red to alpha
    glm::mat2 uv_matrix{1};  ///< coordinates times this
    glm::vec2 uv_offset{0};  ///< plus this

    MaterialTexture(int number = -1) : texture(number) {}
    bool operator==(const MaterialTexture&) const = default;
    explicit operator bool() const { return texture >= 0; }
    glm::vec2 place(const glm::vec2& uv) const { return uv_matrix * uv + uv_offset; }
};

/// glTF 2.0 metallic-roughness with the extensions that docs/scenes.md lists; textures modulate factors.
struct Material {
    std::string name;
    glm::vec3 base_color{1};             ///< linear, [0, 1]
    float alpha = 1;                     ///< base colour alpha, [0, 1]; of no effect but with these two:
    bool blended = false;                ///< alpha is the share of the surface that is there
    float alpha_cutoff = 0;              ///< less alpha than this is a hole (AlphaTest); 0: opaque, whatever the alpha
    MaterialTexture base_color_texture;  ///< sRGB; its alpha times `alpha`
    MaterialTexture emissive_texture;    ///< sRGB
    MaterialTexture metallic_texture, roughness_texture, transmission_texture, thickness_texture;  ///< one channel each
    MaterialTexture specular_texture;                                                              ///< one channel
    MaterialTexture specular_color_texture;                                                        ///< sRGB
    MaterialTexture normal_texture;     ///< tangent space, red along the tangent, green along the bitangent
    MaterialTexture occlusion_texture;  ///< one channel; 0: no light of the sky arrives
    MaterialTexture clearcoat_texture, coat_roughness_texture;  ///< one channel each
    MaterialTexture coat_normal_texture;  ///< as normal_texture, for the coat; none: the coat is smooth
    MaterialTexture sheen_color_texture;  ///< sRGB
    MaterialTexture sheen_roughness_texture, iridescence_texture;  ///< one channel each
    MaterialTexture film_thickness_texture;                        ///< one channel: 0 the least, 1 the most thickness
    /// Red and green: the direction along which the lobe is stretched, in tangent space; blue times `anisotropy`. None:
    /// its uv_set still says which coordinates tangents follow.
    MaterialTexture anisotropy_texture;
    MaterialTexture diffuse_transmission_texture;        ///< one channel
    MaterialTexture diffuse_transmission_color_texture;  ///< sRGB
    float normal_scale = 1;                              ///< of the normal texture's red and green
    float occlusion_strength = 1;                        ///< [0, 1]
    float metallic = 0;                                  ///< [0, 1]
    float roughness = 1;                                 ///< perceptual, [0, 1]; GGX alpha is its square
    glm::vec3 emissive{0};        ///< radiance, W/(sr·m²) up to the exposure; already times the emissive strength
    float transmission = 0;       ///< share of the light that is not reflected and passes through, [0, 1]
    float ior = 1.5f;             ///< index of refraction, ≥ 1; 0: infinite, all light is reflected
    float clearcoat = 0;          ///< share of the surface that has a coat, [0, 1] (KHR_materials_clearcoat)
    float coat_roughness = 0;     ///< perceptual, [0, 1]
    float coat_normal_scale = 1;  ///< as normal_scale
    float specular = 1;           ///< share of the reflection of what is no metal, [0, 1] (KHR_materials_specular)
    glm::vec3 specular_color{1};  ///< its colour at normal incidence, ≥ 0
    glm::vec3 sheen_color{0};     ///< of the cloth's fibres, [0, 1]; black: none (KHR_materials_sheen)
    float sheen_roughness = 0;    ///< perceptual, [0, 1]
    float iridescence = 0;        ///< share of the surface that a thin film covers, [0, 1] (KHR_materials_iridescence)
    float film_ior = 1.3f;        ///< its index of refraction, ≥ 1
    float film_least = 100,
          film_most = 400;          ///< its thickness, nm, where the texture says 0 and 1; no texture: the most
    float anisotropy = 0;           ///< how much the lobe is stretched, [0, 1] (KHR_materials_anisotropy)
    float anisotropy_rotation = 0;  ///< of its direction, radians from the tangent towards the bitangent
    float dispersion = 0;           ///< 20 over the Abbe number, ≥ 0 (KHR_materials_dispersion)
    /// Share of the diffuse light that comes out behind, [0, 1], and its colour (KHR_materials_diffuse_transmission).
    float diffuse_transmission = 0;
    glm::vec3 diffuse_transmission_color{1};
    float thickness = 0;             ///< 0: thin-walled (no bending, no absorption); > 0: the mesh bounds a volume
    glm::vec3 attenuation_color{1};  ///< what white becomes after attenuation_distance inside the volume
    float attenuation_distance = std::numeric_limits<float>::infinity();
    bool unlit = false;        ///< KHR_materials_unlit: base colour as it is
    bool catcher = false;      ///< nothing is seen of it but shadows and, in front of what is behind it, mirror images
    bool double_sided = true;  ///< both sides are shown, where the file says nothing else; see is_single_sided()
};

/// All textures of a material, in the order of the shaders' TEXTURE_* (common/material.h).
inline constexpr std::array<MaterialTexture Material::*, 20> material_textures = {
    &Material::base_color_texture,
    &Material::emissive_texture,
    &Material::metallic_texture,
    &Material::roughness_texture,
    &Material::transmission_texture,
    &Material::thickness_texture,
    &Material::normal_texture,
    &Material::occlusion_texture,
    &Material::specular_texture,
    &Material::specular_color_texture,
    &Material::clearcoat_texture,
    &Material::coat_roughness_texture,
    &Material::coat_normal_texture,
    &Material::sheen_color_texture,
    &Material::sheen_roughness_texture,
    &Material::iridescence_texture,
    &Material::film_thickness_texture,
    &Material::anisotropy_texture,
    &Material::diffuse_transmission_texture,
    &Material::diffuse_transmission_color_texture};

/// Does a use read its texture's red, green and blue as an sRGB-encoded colour?
constexpr bool is_color(MaterialTexture Material::*use) {
    return use == &Material::base_color_texture || use == &Material::emissive_texture ||
           use == &Material::specular_color_texture || use == &Material::sheen_color_texture ||
           use == &Material::diffuse_transmission_color_texture;
}

/// Joints of a skin that pull at a vertex, and how much; the weights sum to 1, or all are 0 (the vertex follows its
/// node).
struct JointWeights {
    static constexpr int most = 8;
    std::array<uint16_t, most> joints{};  ///< indices into Skin::joints
    std::array<float, most> weights{};
};

/// A shape that a primitive can take on, as differences to its own.
struct MorphTarget {
    std::vector<glm::vec3> positions, normals, tangents;  ///< one per vertex, or empty: no difference
};

/// Triangles of one material. Lists are per vertex; all but `positions` and `normals` may be empty.
struct Primitive {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;                ///< unit length, same count as positions
    std::vector<glm::vec2> uvs;                    ///< the first set of texture coordinates
    std::vector<std::vector<glm::vec2>> more_uvs;  ///< sets 1, 2, …, each empty or per vertex
    /// Unit tangents (x, y, z) for the normal texture and the direction of anisotropy, and the side of the bitangent: w
    /// · cross(normal, tangent) points to the image's first row. w = 0: none is known, the normal stays as it is. See
    /// make_tangents().
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;     ///< linear vertex colour that multiplies the base colour
    std::vector<JointWeights> joints;  ///< one per vertex; empty: no skin moves it
    std::vector<MorphTarget> targets;
    /// Makes the targets of a primitive that leaves them for later, since a still picture has no use for them and they
    /// take as much room as the rest of it; see complete_targets(). Empty: `targets` holds all.
    std::function<std::vector<MorphTarget>(const Primitive&)> make_targets;
    std::vector<glm::uvec3> triangles;
    uint32_t material = 0;
    bool flat = false;  ///< the normals are the triangles' own, also after it is deformed; no vertex is shared
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  ///< of the morph targets at rest; missing ones are 0
};

/// A skeleton: vertices follow the joints, each from where it was when the mesh was bound to it.
struct Skin {
    std::string name;
    std::vector<int> joints;              ///< indices into Scene::nodes
    std::vector<glm::mat4> inverse_bind;  ///< mesh to joint, one per joint
};

/// A node's transform in its parent, in parts: scaled, then rotated, then moved.
struct Placement {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    /// Put together in single precision, unless the scene is `precise`.
    glm::dmat4 matrix(bool precise = false) const;
};

struct Camera {
    std::string name;
    glm::dvec3 eye{0, 0, 1}, look{0};  ///< double: its direction is their difference, wherever it stands
    glm::vec3 up{0, 1, 0};
    float vertical_fov = 0.8f;      ///< radians, (0, π); unused if orthographic
    float orthographic_height = 0;  ///< > 0: an orthographic camera that sees this height
    uint32_t number = 0;            ///< as the file counts its cameras; several nodes may show the same one
    std::string node;               ///< name of the node that shows it; empty: it has none, or none shows it

    bool operator==(const Camera&) const = default;
};

struct Light {
    enum class Kind : uint8_t { directional, point, spot };
    std::string name;
    Kind kind = Kind::directional;
    glm::vec3 color{1};             ///< linear, times intensity: lux (directional), candela (point, spot)
    glm::vec3 position{0};          ///< world space
    glm::vec3 direction{0, -1, 0};  ///< unit, the direction in which the light travels
    float range = std::numeric_limits<float>::infinity();  ///< metres, point and spot only
    float inner_cone = 0, outer_cone = 0.785398f;          ///< spot: half angles, radians
    float radius = 0;  ///< of its ball, world units; directional: of its disc, radians. Several samples see it soften
};

struct Node {
    std::string name;
    int parent = -1;      ///< index into Scene::nodes; a parent always precedes its children
    glm::dmat4 local{1};  ///< node to parent
    int mesh = -1, camera = -1, light = -1, skin = -1;
    Placement rest;              ///< what animations start from; unused where `fixed`
    bool fixed = true;           ///< no animation can move it: the file gives a matrix, or the scene is no glTF file
    std::vector<float> weights;  ///< of its mesh's morph targets; empty: the mesh's own
    int source = -1;             ///< glTF: index into the file's own nodes (animations and skins speak of those);
                                 ///< -1: one of a node's instances
    bool is_instance =
        false;  ///< one of those that its parent is shown as, moved from there by `local`; so is its skin
};

/// Keys over time for one property of one node (glTF 2.0, section 3.11 and appendix C).
struct AnimationChannel {
    enum class Path : uint8_t { translation, rotation, scale, weights };
    enum class Interpolation : uint8_t { step, linear, cubic };
    int node = -1;  ///< index into Scene::nodes
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    uint32_t width = 3;         ///< numbers per value: 3, 4 (quaternions x y z w), or as many as the mesh has targets
    std::vector<float> times;   ///< seconds, ascending; at least one
    std::vector<float> values;  ///< `width` per key; cubic: three times as many (in-tangent, value, out-tangent)

    /// The value at `time`: the first or last key's outside of the keys. Rotations come out unit.
    std::vector<float> at(float time) const;
};

struct Animation {
    std::string name;
    float duration = 0;  ///< seconds: the last key of all channels
    std::vector<AnimationChannel> channels;
};

struct Scene {
    std::string name;                          ///< "builtin:teapots" or the file's name
    std::vector<std::filesystem::path> files;  ///< all that were read, its own first, each once; built-in: none
    /// Where positions count from: those of cameras, lights, boxes and triangles in the world are relative to it. 0
    /// unless the scene stands far from the world's origin (docs/conventions.md). Matrices of nodes leave it out.
    glm::dvec3 origin{0};
    bool precise = false;  ///< something in it stands so far away that matrices are multiplied in double precision
    std::vector<Texture> textures;
    std::vector<Material> materials;  ///< never empty once triangles exist
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;      ///< parents first; only what the file's default scene shows
    std::vector<Camera> cameras;  ///< in world space, by number; of equal ones in the order of the nodes that show them
    std::vector<Camera> unplaced_cameras;  ///< by number; no node shows them, so that they have a lens but no place
    std::vector<Light> lights;             ///< in world space
    std::optional<CubeLight> cube_light;   ///< what surrounds it, where nobody asks for something else
    bool outdoors = false;                 ///< where nothing else lights it, a clear sky does; otherwise a studio
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    Generated generated;                              ///< what is computed for every moment, if anything is
    std::vector<std::string> variants;                ///< names; one chose the materials if it was asked for
    std::vector<std::string> extensions_used;         ///< as the file says, sorted
    std::vector<std::string> extensions_unsupported;  ///< used, not required, and without effect here
    std::vector<std::string>
        notes;  ///< what was dropped or ignored, one line each, with counts ("3 zero-area triangles dropped")
};

/// All triangles of the scene in world space, in file order: nodes in order of the hierarchy (depth first), primitives
/// in order, triangles in order. A triangle's index here is the one that HITS.npy reports. Degenerate triangles keep
/// their index; nothing is reordered. Under a mirroring transform the second and third corner swap, so that the front
/// stays in front.
struct Geometry {
    /// What moves as one: the triangles of one node of the scene, contiguous.
    struct Object {
        uint32_t first, count;  ///< triangles
    };

    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;                ///< one per position, unit
    std::vector<glm::vec2> uvs;                    ///< one per position (0 where the file has none)
    std::vector<std::vector<glm::vec2>> more_uvs;  ///< the same of sets 1, 2, …
    std::vector<glm::vec4> tangents;  ///< as Primitive::tangents, one per position, or empty if no primitive has any
    std::vector<glm::vec4> colors;    ///< one per position, or empty if no primitive has colours
    std::vector<glm::uvec3> triangles;
    std::vector<uint32_t> materials;  ///< one per triangle

    const std::vector<glm::vec2>& uv_set(uint32_t set) const { return set == 0 ? uvs : more_uvs[set - 1]; }
    std::vector<Object> objects;   ///< ascending, without gaps; together all triangles
    glm::vec3 lower{0}, upper{0};  ///< bounds of all referenced positions; lower > upper: no triangle
    uint32_t zero_area = 0;        ///< triangles without area (kept; they can never be hit)
};

/// World-space triangles of the whole scene at rest (see Geometry). Throws Error when there is no triangle, naming the
/// scene.
Geometry flatten(const Scene& scene);

}  // namespace peelray
