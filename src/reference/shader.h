// The tree of rays below a sample of a pixel, followed depth first. Private to src/reference.
#pragma once

#include <optional>
#include <vector>

#include "reference/albedos.h"
#include "reference/bvh.h"
#include "reference/media.h"
#include "reference/optics.h"
#include "reference/surface.h"
#include "scene/picture.h"

namespace peelray {

/// What rays run through: shared by all threads, constant.
struct RenderContext {
    const Bvh& bvh;
    const Surfaces& surfaces;
    const Albedos& albedos;
    const Surroundings& surroundings;
    const std::vector<Light>& lights;
    const MediaRanks& media;
    const PictureSettings& settings;
    Box box;      ///< of the scene
    Media start;  ///< what the camera is in
    bool has_blended;
};

/// How wide the light is that a ray stands for (Akenine-Möller et al., JCGT 2021).
struct Cone {
    double width = 0;   ///< at the ray's start, world units; < 0: behind a focus
    double spread = 0;  ///< how much wider it gets per world unit
    double width_at(double t) const { return width + t * spread; }
    /// After a surface of this curvature: the mirrored direction turns twice as far as the normal, the refracted one as
    /// Snell's law has it near the normal.
    Cone reflected(double curvature) const { return {width, spread + 2 * curvature * width}; }
    Cone refracted(double curvature, double eta) const {
        return {width, (spread + curvature * width) / eta - curvature * width};
    }
};

/// Follows the rays of one sample of one pixel.
class Shader {
  public:
    static constexpr uint32_t none = ~0u;

    struct Path {
        glm::dvec3 origin, direction;  ///< direction: unit
        uint32_t skip = none;          ///< triangle that does not count: the one where the ray starts
        glm::dvec3 weight{1};          ///< share of the pixel's light that comes along the ray
        Media media;                   ///< what the ray is in at its start
        Cone cone;
        bool sees_sun = true;
        uint32_t seed = 0;  ///< of the random numbers: from the pixel and the branches taken
        uint32_t level = 0;
        uint32_t passed = 0;  ///< blended surfaces so far: those levels are no bounces
        Channel channel = Channel::all;
    };

    Shader(const RenderContext& context, uint32_t sample) : context_(context), sample_(sample) {}

    /// What the path's ray meets.
    Meeting hit(const Path& path) const;
    /// Light that comes back along the path from what it meets.
    glm::dvec3 radiance(const Path& path, const Meeting& meeting);
    /// The rays traced so far, camera rays excepted.
    const RayCounts& rays() const { return rays_; }
    /// What of the camera ray's light an unlit surface sends.
    const glm::dvec3& unlit() const { return unlit_; }

  private:
    struct Branch {
        glm::dvec3 weight{0};  ///< share of the hit's light; 0: no branch
        glm::dvec3 direction{0, 0, 1};
        Media media;
        Cone cone;
        bool passes = false;  ///< straight on, through a blended surface
        bool mirrors = true;  ///< it is a reflection
        bool sees_sun = false;
        bool traced = false;
        double blur = 0;  ///< roughness for the environment, if not traced
        Channel channel = Channel::all;
    };
    struct Scattered {
        Branch reflection, refraction;
        std::vector<Branch> split;  ///< dispersed light: the refraction's three channels, in its place
        glm::dvec3 radiance{0};     ///< what the surface sends by itself
    };
    /// Of the two parts of a material.
    struct Parts {
        glm::dvec3 dielectric{1}, metal{1};
        Parts operator*(const Parts& other) const { return {dielectric * other.dielectric, metal * other.metal}; }
        glm::dvec3 of(const Optics& m) const { return glm::mix(dielectric, metal, m.metallic); }
    };
    /// What a surface reflects and what it lets through, before its tint.
    struct Shares {
        glm::dvec3 reflected, refracted;
    };
    /// What is the same for all light that a surface sends along a path.
    struct Seen {
        double n_v = 1;        ///< cosine between the view and the shading normal
        double coat = 0;       ///< share that the clear coat mirrors
        double sheen = 1;      ///< what the sheen leaves for what is below
        double scattered = 1;  ///< what the dielectric part leaves for diffuse light
    };

    MediaWalk walk() const { return {context_.bvh, context_.surfaces, context_.media}; }
    Scattered scatter(const Surface& surface, const Path& path, const Meeting& meeting) const;
    static optics::Lobe lobe_of(const Surface& surface);
    glm::dvec3 half_vector(const optics::Lobe& lobe, const glm::dvec3& view, uint32_t seed,
                           optics::Purpose purpose) const;
    glm::dvec3 microfacet(const Surface& surface, const optics::Lobe& lobe, const Path& path) const;
    std::optional<glm::dvec3> refracted(const Surface& surface, const Path& path, const Meeting& meeting,
                                        const glm::dvec3& half) const;
    Shares shares(const Surface& surface, const optics::Lobe& lobe, const Path& path, const Meeting& meeting,
                  const glm::dvec3& half) const;
    bool disperses(const Surface& surface, const Path& path, const Meeting& meeting) const;
    void split(const Path& path, const Meeting& meeting, const Surface& surface, const glm::dvec3& half,
               Scattered& scattered) const;
    glm::dvec3 fade(Branch& branch, double roughness, double metallic) const;
    void add_coat(const Surface& surface, const Path& path, const Meeting& meeting, Scattered& scattered) const;
    void pass_beside(const Surface& surface, const Path& path, const Meeting& meeting, Scattered& scattered) const;
    bool is_last(const Branch& branch, const Path& path) const;
    bool is_wanted(const Branch& branch, const Path& path) const;
    bool is_traced(const Branch& branch, const Path& path) const;
    bool is_cut(const Branch& branch, const Path& path) const;
    glm::dvec3 follow(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle,
                      uint32_t which);

    bool compensates(const Optics& m) const;
    Parts compensation(const Surface& surface, double n_v) const;
    Parts mean_reflectance(const Surface& surface, double n_v) const;
    static Shares rough_glass(const glm::dvec3& fresnel, double kept_reflected, double kept_refracted);
    double below_sheen(const Surface& surface, double cosine) const;

    Seen seen(const Surface& surface, const Path& path) const;
    glm::dvec3 specular(const Surface& surface, const Path& path, const Parts& fresnel, double n_v,
                        const glm::dvec3& to_light) const;
    glm::dvec3 reflectance(const Surface& surface, const Path& path, const Seen& seen,
                           const glm::dvec3& to_light) const;
    glm::dvec3 direct_light(const Surface& surface, uint32_t triangle, const Path& path, const Meeting& meeting);
    glm::dvec3 sky_light(const Surface& surface, uint32_t triangle, const Path& path, const Seen& seen,
                         const Media& behind);
    glm::dvec3 visibility(const glm::dvec3& start, const glm::dvec3& direction, double distance, uint32_t triangle,
                          Media media) const;
    double index_of(uint32_t medium, Channel channel) const;
    /// Index behind a surface over that before it, and what its two parts reflect.
    double relative_index(const Meeting& meeting, const Surface& surface, Channel channel) const;
    Parts reflectance_at(const Meeting& meeting, const Surface& surface, double cosine, Channel channel) const;
    glm::dvec3 transmittance(uint32_t medium, double distance) const;

    const RenderContext& context_;
    uint32_t sample_;
    RayCounts rays_;
    glm::dvec3 unlit_{0};
};

}  // namespace peelray
