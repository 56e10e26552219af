// The tree of rays below a sample of a pixel, followed depth first. Private to src/reference.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "denoise/denoise_params.h"
#include "reference/albedos.h"
#include "reference/bvh.h"
#include "reference/emitter_list.h"
#include "reference/media.h"
#include "reference/optics.h"
#include "reference/random_numbers.h"
#include "reference/surface.h"
#include "reference/surroundings.h"
#include "scene/lamps.h"
#include "scene/picture.h"

namespace peelray {

/// What rays run through: shared by all threads, constant.
struct RenderContext {
    const Bvh& bvh;
    const Surfaces& surfaces;
    const Albedos& albedos;
    const Surroundings& surroundings;
    std::span<const Light> lights;
    const Lamps& lamps;
    std::span<const Light> all_lights;  ///< with those that stand for a part of an image that is sampled
    const EmitterList& emitters;
    double rough_limit;  ///< radiance that rays after a rough surface see of the environment at most
    const MediaRanks& media;
    const PictureSettings& settings;
    Box box;      ///< of the scene
    Media start;  ///< what the camera is in
    bool has_blended;

    bool sampled() const { return is_sampled(settings); }
    /// Is one lamp with a place drawn for all of them?
    bool draws_lamps() const { return sampled() && lamps.count > LAMPS_EACH; }
    bool samples_emitters() const { return peelray::samples_emitters(settings) && !emitters.empty(); }
    bool samples_environment() const { return settings.env_mode == EnvironmentMode::sampled; }
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
        /// Of the ray's direction among those that its hit could have drawn, where that hit has drawn directions to
        /// lights too: both share the light. 0: all of it comes along the ray; < 0: none.
        double density = 0;
        uint32_t seed = 0;  ///< of the random numbers: from the pixel and the branches taken
        uint32_t level = 0;
        uint32_t scattered = 0;  ///< diffuse bounces so far
        uint32_t passed = 0;     ///< blended surfaces so far: those levels are no bounces
        Channel channel = Channel::all;
        /// Straight from the camera?
        bool is_straight() const { return passed == level; }
        bool guided = false;  ///< the denoiser's guides are looked for along it
        double length = 0;    ///< of the path so far
    };

    Shader(const RenderContext& context, const PixelSample& sample) : context_(context), sample_(sample) {}

    /// What the path's ray meets.
    Meeting hit(const Path& path) const;
    /// Light that comes back along the path from what it meets.
    glm::dvec3 radiance(const Path& path, const Meeting& meeting);
    /// The rays traced so far, camera rays excepted.
    const RayCounts& rays() const { return rays_; }
    /// What of the camera ray's light an unlit surface sends.
    const glm::dvec3& unlit() const { return unlit_; }
    /// Share of the backdrop's light that comes to the camera.
    double through() const { return through_; }
    /// Does the camera see a surface that is not to be seen itself?
    bool catches() const { return catches_; }
    /// Of a guided camera ray; `surfaces` is 0 where there are none.
    const DenoiseGuide& guide() const { return guide_; }

  private:
    struct Branch {
        glm::dvec3 weight{0};  ///< share of the hit's light; 0: no branch
        glm::dvec3 direction{0, 0, 1};
        Media media;
        Cone cone;
        bool passes = false;  ///< straight on, through a blended surface
        bool mirrors = true;  ///< it is a reflection
        bool sees_sun = false;
        double density = 0;  ///< Path::density
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

    /// A hit that light falls on.
    struct Lit {
        const Surface& surface;
        uint32_t triangle;
        const Path& path;
        const Seen& seen;
        const Media& behind;  ///< the media on the other side
    };
    /// A light as a point of a surface meets it.
    struct Incidence {
        glm::dvec3 irradiance{0};  ///< on a surface that faces the light; 0: none
        glm::dvec3 direction;      ///< to the light, unit
    };

    MediaWalk walk() const { return {context_.bvh, context_.surfaces, context_.media}; }
    Scattered scatter(const Surface& surface, const Path& path, const Meeting& meeting) const;
    double traced_part(double roughness, double metallic) const;
    static optics::Lobe lobe_of(const Surface& surface);
    static optics::Lobe coat_lobe(const Surface& surface);
    static double coat_reflectance(const Optics& m, double v_h);
    glm::dvec2 random(const Path& path, uint32_t purpose) const {
        return random_pair(path.seed, path.level, purpose, sample_);
    }
    glm::dvec3 half_vector(const optics::Lobe& lobe, const Path& path, uint32_t purpose) const;
    double reflection_density(const Surface& surface, const optics::Lobe& lobe, const Path& path,
                              const glm::dvec3& reflected) const;
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
    bool is_last(const Path& path, bool passes) const;
    bool is_wanted(const Branch& branch, const Path& path) const;
    bool is_traced(const Branch& branch, const Path& path) const;
    bool is_cut(const Branch& branch, const Path& path) const;
    glm::dvec3 follow(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle, uint32_t which,
                      bool guided = false);
    std::optional<uint32_t> guiding_branch(const Surface& surface, const Path& path, const Scattered& out) const;
    void guide(const Surface& surface, const Path& path, const glm::dvec3& all, const glm::dvec3& second,
               const glm::dvec3& lit);

    static Path next_path(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle,
                          uint32_t which);
    glm::dvec3 caught(const Surface& surface, const Path& path, const Meeting& meeting, const Branch& reflection);
    glm::dvec3 backdrop(const glm::dvec3& direction) const;
    glm::dvec3 missed(const Path& path, const glm::dvec3& weight);
    glm::dvec3 untraced(const Branch& branch, const Path& path) const;

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
    glm::dvec3 scattered_light(const Surface& surface, const Path& path, const Meeting& meeting);
    glm::dvec3 direct_light(const Lit& at, bool sky);
    double radius_of(const Light& light) const { return context_.sampled() ? double(light.radius) : 0; }
    Incidence incidence(const Light& light, uint32_t index, const Lit& at) const;
    /// What the surface would send of a lamp's light, if nothing were in its way.
    struct LampLight {
        uint32_t index;  ///< of the lamp
        glm::dvec3 direction, light;
    };
    LampLight lamp_light(uint32_t index, const Lit& at) const;
    glm::dvec3 lamp_visibility(const LampLight& found, const Lit& at);
    glm::dvec3 drawn_lamp(const Lit& at);
    bool hides_itself(const Lit& at, const glm::dvec3& direction) const;
    double reach(const Light& light, const glm::dvec3& start, const glm::dvec3& direction) const;
    /// Of a surface that light comes to from a direction.
    struct Start {
        glm::dvec3 point;
        bool from_behind;
    };
    static Start start_to(const Lit& at, const glm::dvec3& direction);
    glm::dvec3 arriving(const Lit& at, const Start& start, const glm::dvec3& direction, double distance);
    /// What Lambert's law scatters of light from the side that is seen and from behind, per unit of irradiance.
    struct BothSides {
        glm::dvec3 front, back;
    };
    static BothSides scattered(const Lit& at);
    glm::dvec3 sky_light(const Lit& at);
    glm::dvec3 left_by_shadows(const Lit& at);
    double environment_share(const glm::dvec3& direction, double density) const;
    double environment_blur(const Cone& cone, double density) const;
    static glm::dvec3 scattered_from(const Lit& at, const glm::dvec3& direction);
    glm::dvec3 mirrored_from(const Lit& at, const Surroundings::Drawn& drawn, bool followed) const;
    static bool scatters(const Optics& m);
    static glm::dvec3 draw_scattered(const Lit& at, glm::dvec2 random);
    static double scattered_density(const Lit& at, const glm::dvec3& direction);
    glm::dvec3 environment_light(const Lit& at);
    Branch diffuse_branch(const Lit& at) const;
    double emitter_density(uint32_t triangle, double probability, const glm::dvec3& direction, double distance) const;
    double emission_share(const Path& path, const OracleHit& hit) const;
    glm::dvec3 emitter_light(const Lit& at);
    glm::dvec3 visibility(const glm::dvec3& start, const glm::dvec3& direction, double distance, uint32_t triangle,
                          Media media) const;
    double index_of(uint32_t medium, Channel channel) const;
    /// Index behind a surface over that before it, and what its two parts reflect.
    double relative_index(const Meeting& meeting, const Surface& surface, Channel channel) const;
    Parts reflectance_at(const Meeting& meeting, const Surface& surface, double cosine, Channel channel) const;
    glm::dvec3 transmittance(uint32_t medium, double distance) const;

    const RenderContext& context_;
    PixelSample sample_;
    RayCounts rays_;
    glm::dvec3 unlit_{0};
    double through_ = 0;
    bool catches_ = false;
    DenoiseGuide guide_{};
};

}  // namespace peelray
