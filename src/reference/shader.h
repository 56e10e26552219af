// The tree of rays below a sample of a pixel, followed depth first. Private to src/reference.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "denoise/denoise_params.h"
#include "reference/albedos.h"
#include "reference/emitter_list.h"
#include "reference/intersections.h"
#include "reference/media.h"
#include "reference/moment_before.h"
#include "reference/optics.h"
#include "reference/photon_tree.h"
#include "reference/random_numbers.h"
#include "reference/surface.h"
#include "reference/surroundings.h"
#include "scene/lamps.h"
#include "scene/picture.h"

namespace peelray::inline PRECISION {

struct SentPhoton;

/// What rays run through: shared by all threads, constant.
struct RenderContext {
    const Intersections& triangles;
    const Surfaces& surfaces;
    const Albedos& albedos;
    const Surroundings& surroundings;
    std::span<const Light> lights;
    const Lamps& lamps;
    std::span<const Light> all_lights;  ///< with those that stand for a part of an image that is sampled
    const EmitterList& emitters;
    real rough_limit;  ///< radiance that rays after a rough surface see of the environment at most
    const MediaRanks& media;
    const PictureSettings& settings;
    Box box;      ///< of the scene
    Media start;  ///< what the camera is in
    bool has_blended;
    uint32_t bounce_levels, last_level;   ///< of the tree of rays (scene/picture.h)
    const MomentBefore* before;           ///< null: guides need no motion
    const PhotonTree* photons = nullptr;  ///< of the sample; null: there are none
    bool glass_is_opaque = false;         ///< to light of lamps, which photons bring
    bool is_photon = false;               ///< what runs is a photon: a sample, whatever the picture's pixels are

    bool sampled() const { return is_photon || is_sampled(settings); }
    /// Is one lamp with a place drawn for all of them?
    bool draws_lamps() const { return samples_lamps(settings) && lamps.count > LAMPS_EACH; }
    bool samples_emitters() const { return peelray::samples_emitters(settings) && !emitters.empty(); }
    bool samples_environment() const { return settings.env_mode == EnvironmentMode::sampled; }
    bool filters_environment() const { return settings.env_mode == EnvironmentMode::filtered; }
};

/// How wide the light is that a ray stands for (Akenine-Möller et al., JCGT 2021).
struct Cone {
    real width = 0;   ///< at the ray's start, world units; < 0: behind a focus
    real spread = 0;  ///< how much wider it gets per world unit
    real width_at(real t) const { return width + t * spread; }
    /// After a lobe of this alpha.
    Cone blurred(real alpha) const;
    /// After a surface of this curvature: the mirrored direction turns twice as far as the normal, the refracted one as
    /// Snell's law has it near the normal.
    Cone reflected(real curvature) const { return {width, spread + 2 * curvature * width}; }
    Cone refracted(real curvature, real eta) const {
        return {width, (spread + curvature * width) / eta - curvature * width};
    }
};

/// Follows the rays of one sample of one pixel.
class Shader {
  public:
    static constexpr uint32_t none = ~0u;

    struct Path {
        Vec3 origin, direction;  ///< direction: unit
        uint32_t skip = none;    ///< triangle that does not count: the one where the ray starts
        Vec3 weight{1};          ///< share of the pixel's light that comes along the ray
        Media media;             ///< what the ray is in at its start
        Cone cone;
        bool sees_sun = true;
        /// Of the ray's direction among those that its hit could have drawn, where that hit has drawn directions to
        /// lights too: both share the light. 0: all of it comes along the ray; < 0: none.
        real density = 0;
        uint32_t seed = 0;  ///< of the random numbers: from the pixel and the branches taken
        uint32_t level = 0;
        uint32_t scattered = 0;  ///< diffuse bounces so far
        uint32_t passed = 0;     ///< blended surfaces so far: those levels are no bounces
        Channel channel = Channel::all;
        /// Straight from the camera?
        bool is_straight() const { return passed == level; }
        bool guided = false;        ///< the denoiser's guides are looked for along it
        real length = 0;            ///< of the path so far
        std::optional<Vec2> ahead;  ///< where the ray looks in the environment's map, if that is known
    };

    Shader(const RenderContext& context, const PixelSample& sample) : context_(context), sample_(sample) {}
    /// Goes on with another sample, which adds to the same rays.
    void begin(const PixelSample& sample) {
        sample_ = sample;
        unlit_ = Vec3(0);
        through_ = 0;
        catches_ = false;
        if (is_denoised(context_.settings)) {
            guide_ = {};
            guide_motion_ = no_motion;
            image_ = {};
        }
    }

    /// What the path's ray meets; `first`: the nearest triangle, if it is known.
    Meeting hit(const Path& path, const Hit* first = nullptr) const;
    /// Light that comes back along the path from what it meets.
    Vec3 radiance(const Path& path, const Meeting& meeting);
    /// The rays traced so far, camera rays excepted.
    const RayCounts& rays() const { return rays_; }
    /// What of the camera ray's light an unlit surface sends.
    const Vec3& unlit() const { return unlit_; }
    /// Share of the backdrop's light that comes to the camera.
    real through() const { return through_; }
    /// Does the camera see a surface that is not to be seen itself?
    bool catches() const { return catches_; }
    /// Follows a photon to where it comes to rest, if it does; `usual`: the mean flux of such photons.
    std::optional<RestingPhoton> fly(const SentPhoton& sent, uint32_t seed, real usual) const;
    /// Of a guided camera ray; `surfaces` is 0 where there are none.
    const DenoiseGuide& guide() const { return guide_; }
    /// Where what it comes from was, with RenderContext::before.
    const DenoiseMotion& guide_motion() const { return guide_motion_; }

  private:
    struct Branch {
        Vec3 weight{0};  ///< share of the hit's light; 0: no branch
        Vec3 direction{0, 0, 1};
        Media media;
        Cone cone;
        bool passes = false;  ///< straight on, through a blended surface
        bool mirrors = true;  ///< it is a reflection
        bool sees_sun = false;
        real density = 0;  ///< Path::density
        bool traced = false;
        real blur = 0;  ///< roughness for the environment, if not traced
        Channel channel = Channel::all;
    };
    struct Scattered {
        Branch reflection, refraction;
        std::vector<Branch> split;  ///< dispersed light: the refraction's three channels, in its place
        Vec3 radiance{0};           ///< what the surface sends by itself
    };
    /// Of the two parts of a material.
    struct Parts {
        Vec3 dielectric{1}, metal{1};
        Parts operator*(const Parts& other) const { return {dielectric * other.dielectric, metal * other.metal}; }
        Vec3 of(const Optics& m) const { return glm::mix(dielectric, metal, m.metallic); }
    };
    /// What a surface reflects and what it lets through, before its tint.
    struct Shares {
        Vec3 reflected, refracted;
    };
    /// What is the same for all light that a surface sends along a path.
    struct Seen {
        real n_v = 1;        ///< cosine between the view and the shading normal
        real coat = 0;       ///< share that the clear coat mirrors
        real sheen = 1;      ///< what the sheen leaves for what is below
        real scattered = 1;  ///< what the dielectric part leaves for diffuse light
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
        Vec3 irradiance{0};  ///< on a surface that faces the light; 0: none
        Vec3 direction;      ///< to the light, unit
    };

    /// `crossed`: see MediaWalk.
    MediaWalk walk(const HitsAlong* crossed = nullptr) const {
        return {context_.triangles, context_.surfaces, context_.media, crossed};
    }
    Scattered scatter(const Surface& surface, const Path& path, const Meeting& meeting) const;
    real traced_part(real roughness, real metallic) const;
    static optics::Lobe lobe_of(const Surface& surface);
    static optics::Lobe coat_lobe(const Surface& surface);
    static real coat_reflectance(const Optics& m, real v_h);
    Vec2 random(const Path& path, uint32_t purpose) const {
        return random_pair(path.seed, path.level, purpose, sample_);
    }
    Vec3 half_vector(const optics::Lobe& lobe, const Path& path, uint32_t purpose) const;
    real reflection_density(const Surface& surface, const optics::Lobe& lobe, const Path& path,
                            const Vec3& reflected) const;
    Vec3 microfacet(const Surface& surface, const optics::Lobe& lobe, const Path& path) const;
    std::optional<Vec3> refracted(const Surface& surface, const Path& path, const Meeting& meeting,
                                  const Vec3& half) const;
    Shares shares(const Surface& surface, const optics::Lobe& lobe, const Path& path, const Meeting& meeting,
                  const Vec3& half) const;
    bool disperses(const Surface& surface, const Path& path, const Meeting& meeting) const;
    void split(const Path& path, const Meeting& meeting, const Surface& surface, const Vec3& half,
               Scattered& scattered) const;
    Vec3 fade(Branch& branch, real roughness, real metallic) const;
    void add_coat(const Surface& surface, const Path& path, const Meeting& meeting, Scattered& scattered) const;
    void pass_beside(const Surface& surface, const Path& path, const Meeting& meeting, Scattered& scattered) const;
    bool is_last(const Path& path, bool passes) const;
    bool is_wanted(const Branch& branch, const Path& path) const;
    bool is_traced(const Branch& branch, const Path& path) const;
    bool is_cut(const Branch& branch, const Path& path) const;
    Vec3 follow(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle, uint32_t which,
                bool guided = false);
    std::optional<uint32_t> guiding_branch(const Surface& surface, const Path& path, const Scattered& out) const;
    void look_back(const Path& path, const Hit& hit, std::optional<uint32_t> guiding, const Scattered& out);
    void guide(const Surface& surface, const Path& path, const Vec3& all, const Vec3& second, const Vec3& lit);

    real roulette(real brings, const Path& path, uint32_t purpose) const;
    static Path next_path(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle,
                          uint32_t which);
    Vec3 caught(const Surface& surface, const Path& path, const Meeting& meeting, const Branch& reflection);
    Vec3 backdrop(const Vec3& direction) const;
    Vec3 missed(const Path& path, const Vec3& weight);
    Vec3 untraced(const Branch& branch, const Path& path) const;

    bool compensates(const Optics& m) const;
    Parts compensation(const Surface& surface, real n_v) const;
    Parts mean_reflectance(const Surface& surface, real n_v) const;
    static Shares rough_glass(const Vec3& fresnel, real kept_reflected, real kept_refracted);
    real below_sheen(const Surface& surface, real cosine) const;

    Seen seen(const Surface& surface, const Path& path) const;
    Vec3 specular(const Surface& surface, const Path& path, const optics::Lobe& lobe, real density,
                  const Parts& fresnel, real n_v, const Vec3& to_light) const;
    Vec3 reflectance(const Surface& surface, const Path& path, const Seen& seen, const Vec3& to_light) const;
    Vec3 scattered_light(const Surface& surface, const Path& path, const Meeting& meeting);
    Vec3 direct_light(const Lit& at, bool sky);
    real radius_of(const Light& light) const { return samples_lamps(context_.settings) ? real(light.radius) : 0; }
    Incidence incidence(const Light& light, uint32_t index, const Lit& at) const;
    /// What the surface would send of a lamp's light, if nothing were in its way.
    struct LampLight {
        uint32_t index;  ///< of the lamp
        Vec3 direction, light;
    };
    LampLight lamp_light(uint32_t index, const Lit& at) const;
    Vec3 lamp_visibility(const LampLight& found, const Lit& at);
    Vec3 drawn_lamp(const Lit& at);
    bool hides_itself(const Lit& at, const Vec3& direction) const;
    real reach(const Light& light, const Vec3& start, const Vec3& direction) const;
    /// Of a surface that light comes to from a direction.
    struct Start {
        Vec3 point;
        bool from_behind;
    };
    static Start start_to(const Lit& at, const Vec3& direction);
    /// `opaque_glass`: glass lets nothing of it through.
    Vec3 arriving(const Lit& at, const Start& start, const Vec3& direction, real distance, bool opaque_glass = false);
    /// What Lambert's law scatters of light from the side that is seen and from behind, per unit of irradiance.
    struct BothSides {
        Vec3 front, back;
    };
    static BothSides scattered(const Lit& at);
    Vec3 sky_light(const Lit& at);
    Cone lobe_cone(const Cone& cone, real roughness, real part) const;
    Vec3 filtered_lobe(const Vec3& direction, const Cone& cone) const;
    Vec3 filtered_sky(const Lit& at, const BothSides& sky);
    Vec3 left_by_shadows(const Lit& at);
    /// `place`: in the environment's map.
    real environment_share(const Vec2& place, real density) const;
    real environment_blur(const Cone& cone, real density) const;
    static Vec3 scattered_from(const Lit& at, const Vec3& direction);
    Vec3 mirrored_from(const Lit& at, const Vec3& direction, real drawn_density, bool followed) const;
    static bool mirrors_drawn(const Optics& m);
    static bool scatters(const Optics& m);
    static Vec3 draw_scattered(const Lit& at, Vec2 random);
    static real scattered_density(const Lit& at, const Vec3& direction);
    Vec3 environment_light(const Lit& at);
    Branch diffuse_branch(const Lit& at) const;
    static bool photons_follow(real roughness, real metallic);
    bool photons_bring_lobe(const Optics& m, const Path& path) const;
    bool photons_bring_coat(const Optics& m, const Path& path) const;
    Vec3 caustic_light(const Lit& at) const;
    real emitter_density(uint32_t triangle, real probability, const Vec3& direction, real distance) const;
    real emission_share(const Path& path, const Hit& hit) const;
    Vec3 emission_towards(uint32_t triangle, real u, real v, const Vec3& direction) const;
    Vec3 emitter_light(const Lit& at);
    Vec3 visibility(const Vec3& start, const Vec3& direction, real distance, uint32_t triangle, Media media,
                    bool opaque_glass = false) const;
    real index_of(uint32_t medium, Channel channel) const;
    /// Index behind a surface over that before it, and what its two parts reflect.
    real relative_index(const Meeting& meeting, const Surface& surface, Channel channel) const;
    Parts reflectance_at(const Meeting& meeting, const Surface& surface, real cosine, Channel channel) const;
    Vec3 transmittance(uint32_t medium, real distance) const;

    const RenderContext& context_;
    PixelSample sample_;
    RayCounts rays_;
    Vec3 unlit_{0};
    real through_ = 0;
    bool catches_ = false;
    DenoiseGuide guide_{};
    static constexpr DenoiseMotion no_motion{glm::vec2(0), 0, DENOISE_NO_OBJECT};
    DenoiseMotion guide_motion_ = no_motion;
    PastImage image_;                              ///< of the guided path so far
    Vec3 camera_origin_{0}, camera_direction_{0};  ///< of the camera ray
};

}  // namespace peelray::inline PRECISION
