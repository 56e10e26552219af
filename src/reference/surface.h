// The scene as shading sees it, in double precision: materials, the surface at a hit. Private to src/reference.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/real.h"
#include "scene/mipmaps.h"
#include "scene/picture.h"
#include "scene/scene.h"

namespace peelray::inline PRECISION {

/// What of light that disperses a ray carries. Rays that carry all of it see each channel reflected by its own index
/// and bent by the middle one, green's.
enum class Channel { red, green, blue, all };

/// A material: its constants, or what its textures make of them at a point.
struct Optics {
    Vec3 base_color{1}, emissive{0}, absorption{0};  ///< absorption: per world unit inside the volume
    real metallic = 0, roughness = 1, transmission = 0;
    real ior = 1;            ///< ≥ 1
    bool specified = false;  ///< the dielectric part's reflectance is stated: Schlick's, from f0 to f90; else it
                             ///< follows from ior
    real normal = 0;         ///< reflectance at normal incidence by the index alone
    Vec3 f0{0};
    real f90 = 1;
    real occlusion = 1;  ///< share of the sky's diffuse light that arrives
    real alpha = 1;      ///< share of the surface that is there
    real clearcoat = 0, coat_roughness = 0;
    Vec3 sheen{0};
    real sheen_roughness = 0;
    real film = 0, film_ior = 1, film_thickness = 0;  ///< share that a thin film covers; nm
    real anisotropy = 0;                              ///< of the lobe; > 0 only where it has a direction
    real spread = 0;                                  ///< of the index: how far red's and blue's are from the middle
    real behind = 0;                                  ///< share of the diffuse light that comes out behind
    Vec3 behind_color{1};
    bool thin = true, unlit = false, catcher = false;

    Optics() = default;
    explicit Optics(const Material& material);
    bool transmits() const { return transmission > 0 && metallic < 1; }
    /// Does a clear coat mirror along the same ray as what is below? The second is the one that goes through.
    bool shares_branch() const { return clearcoat > 0 && (transmits() || alpha < 1); }
    /// What the light that is not reflected is multiplied by on its way through.
    Vec3 tint() const { return (1 - metallic) * transmission * base_color; }
    /// Is a ray that meets the surface from its `front` or back inside of the volume?
    bool leaves(bool front) const { return transmits() && !thin && !front; }
    /// Widths of the lobe of microfacets, where it is stretched: along its direction and across.
    Vec2 alphas() const;
    /// Of the round lobe that is as large: what decides by a roughness goes by this one.
    real lobe_roughness() const;
    /// Index of refraction, ≥ 1; all: the middle one.
    real index(Channel channel) const;
    /// Of one face of the dielectric part; `cosine` ≥ 0 on the incoming side, `leaving`: from inside.
    Vec3 face_reflectance(real cosine, bool leaving, Channel channel = Channel::all) const;
    /// Of what a ray meets: a thin wall has two faces.
    Vec3 wall_reflectance(real cosine, bool leaving, Channel channel = Channel::all) const;
    /// Of the metal part.
    Vec3 metal_reflectance(real cosine, bool leaving, Channel channel = Channel::all) const;
    /// Of a thin film that covers all of the dielectric or of the metal part.
    Vec3 film_on_dielectric(real cosine, bool leaving, Channel channel = Channel::all) const;
    Vec3 film_on_metal(real cosine, bool leaving, Channel channel = Channel::all) const;

  private:
    Vec3 film_reflectance(const Vec3& base, real cosine, bool leaving, Channel channel) const;
    Vec3 plain_reflectance(real cosine, bool leaving, Channel channel) const;
    Channel channel_of(int component, Channel carried) const;
};

/// What a lobe of microfacets reflects of white light (Albedos).
struct AlbedoMeans {
    Vec3 dielectric{0};                                ///< share of the dielectric part
    real normal = 0, grazing = 0;                      ///< a metal's, by what it reflects at normal incidence: `metal`
    real masking() const { return normal + grazing; }  ///< of a perfect mirror's microfacets
    /// To the microfacet whose grazing light, as Schlick's formula has it, is the mean.
    real cosine() const { return 1 - std::pow(grazing / masking(), 0.2); }
    Vec3 metal(const Vec3& base_color) const { return base_color * normal + grazing; }
};

/// Of a triangle that a ray meets.
struct Face {
    Vec3 geometric;  ///< unit normal of the triangle, on the ray's side
    real extent;     ///< the largest coordinate of the triangle
    bool front;      ///< the ray comes from the side that the normals point to
    uint32_t material;
};

/// What shading needs to know of a hit (see Surface in shaders/path/frame.glsl).
struct Surface : Face {
    Vec3 position;
    Vec3 normal;          ///< interpolated and bent by the normal texture, unit, on the ray's side
    Vec3 coat_normal;     ///< of a clear coat
    Vec3 along{0};        ///< of a surface with anisotropy: where the lobe is stretched, unit, in the normal's plane
    Vec3 shadow_start;    ///< position moved to the smooth surface (Hanika, Ray Tracing Gems II, ch. 4)
    real error;           ///< bound on the position's rounding error, world units
    Optics optics;        ///< the material here
    real mean_roughness;  ///< of the round lobe that masks the ray that came as much as the material's own
    real curvature;       ///< how much the normal turns per world unit; > 0: the ray meets a bulge
    /// The last answer of Albedos::at(), which is asked for each light and branch of a hit, and for which cosine.
    mutable AlbedoMeans means;
    mutable real means_cosine = -1;

    /// Where a ray that goes to `direction`'s side of the surface starts: off its plane by the rounding error, so that
    /// a triangle that coincides with the surface's own is not hit either.
    Vec3 start(const Vec3& point, const Vec3& direction) const;
    /// Where a ray to a light starts: on the viewer's side of the smooth surface, even if the triangle turns away from
    /// the light.
    Vec3 lit_start() const { return shadow_start + geometric * error; }
};

/// Attributes and materials of a scene, which must outlive it.
class Surfaces {
  public:
    Surfaces(const Scene& scene, const Geometry& geometry);

    /// The surface at the weights (u, v) of a triangle's second and third corner, seen along `direction` by a ray that
    /// stands for light of this `width` (0: a point, which textures do not blur).
    Surface at(uint32_t triangle, real u, real v, const Vec3& direction, real width = 0) const;
    /// What of it needs neither the material nor its textures.
    Face face_at(uint32_t triangle, real u, real v, const Vec3& direction) const;
    /// The emission there, where it is the same in all directions: below no coat, of what is not blended.
    std::optional<Vec3> plain_emission(uint32_t triangle, real u, real v) const;
    /// Does a ray along `direction` from the smooth surface at a point of the triangle pass through the triangle?
    bool blocks_itself(const Surface& surface, uint32_t triangle, const Vec3& direction) const;
    /// Of a triangle.
    std::array<Vec3, 3> corners(uint32_t triangle) const {
        const glm::uvec3 at = geometry_.triangles[triangle];
        return {geometry_.positions[at.x], geometry_.positions[at.y], geometry_.positions[at.z]};
    }
    /// A material's constants, without its textures.
    const Optics& optics(uint32_t material) const { return optics_[material]; }
    bool lets_through(uint32_t material) const { return peelray::lets_through(scene_.materials[material]); }
    uint32_t material_of_triangle(uint32_t triangle) const { return geometry_.materials[triangle]; }
    const Optics& optics_of_triangle(uint32_t triangle) const { return optics_[geometry_.materials[triangle]]; }

  private:
    /// A place in a triangle.
    struct Place {
        glm::uvec3 corners;
        Vec3 weights;
        real seen;  ///< area of what the ray stands for, over that of the triangle
        /// What the last use of a texture for data found, for many are there for several of their channels.
        mutable const MaterialTexture* last_use = nullptr;
        mutable Vec4 last_data{0};
        /// Texture coordinates of the last use, and the area of the triangle in them, for many uses share them.
        mutable const MaterialTexture* last_mapped = nullptr;
        mutable Vec2 mapped{0};
        mutable real mapped_area = 0;
        template <typename T>
        auto interpolate(const std::vector<T>& values) const {
            return glm::vec<T::length(), real>(values[corners.x]) * weights.x +
                   glm::vec<T::length(), real>(values[corners.y]) * weights.y +
                   glm::vec<T::length(), real>(values[corners.z]) * weights.z;
        }
    };
    real face_at(uint32_t triangle, const Vec3 (&corners)[3], const Vec3& normal, const Vec3& direction,
                 Face& face) const;
    /// Finds the texture coordinates of a use.
    void map(const MaterialTexture& use, const Place& place) const;
    /// What a use's texture shows there, filtered; sample(level, coordinates, nearest).
    template <typename Sample>
    auto filtered(const MaterialTexture& use, const Place& place, bool is_data, Sample sample) const;
    /// All channels as they are stored, of the levels of data or of colours.
    Vec4 data(const MaterialTexture& use, const Place& place, bool is_data = true) const;
    /// The single number that a use reads, 1 where there is no texture.
    real number(const MaterialTexture& use, const Place& place) const;
    Vec3 color(const MaterialTexture& use, const Place& place) const;
    Optics evaluate(uint32_t material, const Place& place) const;
    /// What few materials have textures for.
    void evaluate_rare(Optics& optics, const Material& material, const Place& place) const;
    /// The interpolated tangent and bitangent, neither made unit; nothing where there are none.
    std::optional<Mat2x3> tangents(const Place& place, const Vec3& normal) const;
    void stretch(Surface& surface, const Place& place, const Vec3& normal) const;
    /// The interpolated normal as a normal texture bends it, unit; nothing where none does.
    std::optional<Vec3> bent(const MaterialTexture& use, real scale, const Place& place, const Vec3& normal) const;
    const Scene& scene_;
    const Geometry& geometry_;
    std::vector<Optics> optics_;
    std::vector<uint8_t> is_plain_;  ///< of a material: evaluate_rare() finds nothing
    Mipmaps mipmaps_;
};

}  // namespace peelray::inline PRECISION
