// A picture of a scene: what it is to look like, and what comes out. Shared by every tracer; no GPU in sight.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/ray_costs.h"
#include "path/aov_records.h"
#include "path/backdrop_kinds.h"
#include "path/shading_numbers.h"
#include "scene/box.h"
#include "scene/scene.h"
#include "settings/choices.h"

namespace peelray {

struct Moment;

/// What the camera sees where nothing is before it, or nothing but blended surfaces; all other rays see the
/// environment.
struct Backdrop {
    enum class Kind : uint32_t {
        environment = BACKDROP_ENVIRONMENT,
        blurred = BACKDROP_BLURRED,  ///< Environment::has_blurred
        color = BACKDROP_COLOR,
        transparent = BACKDROP_NONE,  ///< black, and the picture's alpha says where
    };
    Kind kind = Kind::environment;
    glm::vec3 color{0};
    bool is_transparent() const { return kind == Kind::transparent; }
    bool operator==(const Backdrop&) const = default;
};

/// What a picture is to look like, whoever makes it. Defaults are those of the command line.
struct PictureSettings {
    uint32_t width = 1280, height = 1024;  ///< pixels
    Camera camera;
    /// What the view's near and far planes follow from, the same for all frames of an animation; none: the triangles'
    /// box.
    std::optional<Box> bounds;
    uint32_t bounces = 4;  ///< secondary rays in a row, 0 to 16
    uint32_t spp = 1;      ///< samples per pixel, at least 1
    uint32_t seed = 0;     ///< of the random numbers
    EnvironmentMode env_mode = EnvironmentMode::open;
    bool reflection = true, refraction = true, shadow = true;  ///< effects that are traced; others see the environment
    uint32_t gi = 0;                                           ///< diffuse bounces in a row that are traced, 0 to 16
    uint32_t caustics = 0;            ///< photons for each sample of the pixels, up to 2^24; 0: no caustics
    bool ambient = false;             ///< one ray per hit and sample decides how much of the sky a diffuse surface sees
    bool energy_compensation = true;  ///< light that rough surfaces scatter several times is not lost (Turquin, 2019)
    /// The largest channel that a sample's radiance may have, > 0: brighter ones are scaled down to it. None: no limit.
    std::optional<float> clamp;
    /// A picture may end with fewer samples than spp, but at least one: when this many seconds have passed since its
    /// first sample was begun, or when it is this noisy (noise_of), both > 0. `noise_target` needs `moments`.
    std::optional<double> time_limit;
    std::optional<float> noise_target;
    Backdrop backdrop;
    float exposure = 0;  ///< stops; applies to the encoded picture only
    Tonemap tonemap = Tonemap::neutral;
    bool aovs = false;       ///< also the auxiliary pictures
    bool ray_setup = false;  ///< and those of Aovs from `reflection` on
    bool motion = false;     ///< and Aovs::motion, which else is 0
    bool moments = false;    ///< also those of SAMPLE_AOVS, whether there are others or not
    /// What is wanted of Picture: a device does not hand over what is not.
    bool radiance = true, encoded = true;
    bool seen = false;  ///< also Picture::seen, where radiance is not wanted
    Denoise denoise = Denoise::none;
    int64_t number = 0;    ///< with Denoise::temporal: of the picture, in the order of the moments
    Camera camera_before;  ///< for `motion` and Denoise::temporal: where the camera was at the moment before
    /// For both: that moment, which must last until the picture is made; null: all stood where it stands. The reference
    /// needs what is generated placed in it (Simulation).
    const Moment* moment_before = nullptr;

    bool operator==(const PictureSettings&) const = default;
};

/// Auxiliary pictures at the pixel centres (path/aov_table.h); width·height entries each, row 0 at the top.
struct Aovs {
#define AOV_PICTURE(name, type, channels, nothing) std::vector<type> name;
    SURFACE_AOVS(AOV_PICTURE)
    RAY_SETUP_AOVS(AOV_PICTURE)
    /// Of all samples, not only of that at the centre; with PictureSettings::moments alone.
    SAMPLE_AOVS(AOV_PICTURE)
#undef AOV_PICTURE
    /// Where it was counted: what all rays of a pixel cost, of all samples.
    std::vector<RayCosts> costs;
};

struct RayCounts {
    uint64_t primary = 0, reflection = 0, refraction = 0, diffuse = 0, shadow = 0, ambient = 0;
    /// Not traced, and not among those above: would have been, if `bounces` did not end there.
    uint64_t cut_reflection = 0, cut_refraction = 0;
    /// Reflected and refracted ones that were in more than MEDIA_TOGETHER media at once.
    uint64_t crowded = 0;
    /// Photons that lamps sent, and those of them that came to rest on a surface that scatters light.
    uint64_t photons = 0, photons_kept = 0;
    uint64_t secondary() const { return reflection + refraction + diffuse + shadow + ambient; }
    RayCounts& operator+=(const RayCounts& b) {
        primary += b.primary;
        reflection += b.reflection;
        refraction += b.refraction;
        diffuse += b.diffuse;
        shadow += b.shadow;
        ambient += b.ambient;
        cut_reflection += b.cut_reflection;
        cut_refraction += b.cut_refraction;
        crowded += b.crowded;
        photons += b.photons;
        photons_kept += b.photons_kept;
        return *this;
    }
};

/// Why a picture has no more samples.
enum class PictureEnd : uint8_t {
    samples,  ///< it has all that were asked for
    time_limit,
    noise_target,
    interrupt,  ///< whoever watched it had enough
};
constexpr auto names_of(PictureEnd) {
    return std::to_array<Named<PictureEnd>>({{PictureEnd::samples, "samples"},
                                             {PictureEnd::time_limit, "time limit"},
                                             {PictureEnd::noise_target, "noise target"},
                                             {PictureEnd::interrupt, "interrupt"}});
}

struct SamplesMade {
    uint32_t count = 0;  ///< of each pixel
    PictureEnd end = PictureEnd::samples;
    std::optional<float> noise;  ///< see noise_of(); where moments were asked for, of more than one sample
};

struct Picture {
    uint32_t width = 0, height = 0;
    SamplesMade samples;
    /// Linear, mean over the samples, before exposure; alpha: share of samples with a surface. In a transparent picture
    /// alpha is 1 less the share of the backdrop's light that would come through, and colours are premultiplied by it.
    std::vector<glm::vec4> radiance;
    /// Exposed, tone-mapped, 8-bit sRGB, red in the lowest byte; opaque, or transparent and of the covered part's
    /// colour.
    std::vector<uint32_t> encoded;
    bool transparent = false;
    std::optional<double> seen;  ///< the mean of the radiance's alpha, for those who have no radiance
    Aovs aovs;
    RayCounts rays;
};

/// Of the mean of `samples` values, estimated from the sum of their squared deviations from that mean (Bessel's
/// correction); of a single one 0, for nothing is known.
inline float variance_of_mean(double squared_deviations, uint32_t samples) {
    return samples < 2 ? 0 : float(squared_deviations / (double(samples) * (samples - 1)));
}

/// Are lamps with a size and emissive triangles looked for at random?
inline bool samples_lamps(const PictureSettings& settings) {
    return settings.spp > 1 || settings.env_mode == EnvironmentMode::sampled;
}

/// Do samples of rough lobes, rather than their means, make the picture?
inline bool is_sampled(const PictureSettings& settings) {
    return samples_lamps(settings) && settings.env_mode != EnvironmentMode::filtered;
}

/// Do rays find out how much of the sky a surface sees?
inline bool occludes_sky(const PictureSettings& settings) {
    return settings.ambient || (settings.shadow && settings.env_mode == EnvironmentMode::filtered);
}

/// Do emissive triangles light the scene? Without samples their light would be noise.
inline bool samples_emitters(const PictureSettings& settings) {
    return samples_lamps(settings) || settings.gi > 0;
}

/// Is any light drawn at random, so that a picture of few samples is noisy?
inline bool draws_at_random(const PictureSettings& settings) {
    return samples_emitters(settings) || (settings.ambient && settings.env_mode != EnvironmentMode::filtered);
}

/// Is such light smoothed? What is looked up in cube maps is not drawn.
inline bool is_denoised(const PictureSettings& settings) {
    return settings.denoise != Denoise::none && draws_at_random(settings);
}
inline bool is_temporal(const PictureSettings& settings) {
    return settings.denoise == Denoise::temporal && draws_at_random(settings);
}

/// Levels of the tree of rays that reflections and refractions take: bounces, and the blended surfaces that a path goes
/// straight through.
uint32_t bounce_levels(const PictureSettings& settings, bool has_blended);

/// The last level of the tree: those, and diffuse bounces.
uint32_t last_level(const PictureSettings& settings, bool has_blended);

/// Does light pass through the material, somewhere at least?
inline bool transmits(const Material& material) {
    return material.transmission > 0 && (material.metallic < 1 || material.metallic_texture);
}

/// Does the material send light by itself, somewhere at least? What is unlit is a colour.
inline bool is_emissive(const Material& material) {
    return !material.unlit && material.emissive != glm::vec3(0);
}

/// Does light go on behind the material, refracted or straight, somewhere at least?
inline bool lets_through(const Material& material) {
    return transmits(material) || material.blended;
}

/// The material's roughness where it is smoothest, its coat included. Anisotropy only adds to it, and none where there
/// are no tangents.
float least_roughness(const Scene& scene, const Material& material);

/// The same where it is roughest: anisotropic lobes count as the round ones that are as wide on the mean.
float most_roughness(const Material& material);

/// Is a part at least of an opaque surface's reflection followed by rays (docs/frame.md section 4)? `metallic`: more
/// than half.
inline bool is_reflection_traced(float roughness, bool metallic, uint32_t spp) {
    return spp > 1 ? roughness < float(TRACED_ROUGHNESS) || metallic : roughness < float(FADE_LAST_ROUGHNESS);
}

/// Does any surface start reflected or refracted rays? Rough ones do not (docs/frame.md section 4).
bool is_reflective(const Scene& scene, uint32_t spp);

/// Where sample `index` lies in its pixel, [0, 1)²: the R2 sequence (Roberts 2018), whose first member is the centre;
/// any prefix of it is spread evenly.
glm::vec2 sample_position(uint32_t index);

/// A camera's rays: through the picture position (x, y), pixels from the top left, the ray
/// `forward + right·(2x/width - 1) + up·(1 - 2y/height)` from the eye; orthographic: along `forward` from the eye moved
/// likewise. In single precision, so that every tracer looks through the same camera.
struct View {
    glm::vec3 eye, right, up, forward;  ///< right and up have half the picture's size at distance 1; forward is unit
    bool orthographic = false;
    float near = 0;  ///< nearer surfaces may be cut away: a tiny share of the scene
    float far = 0;   ///< nothing of the scene lies beyond
};

/// `camera` after it went `turn` of a full circle around the vertical line through its look point, counter-clockwise as
/// seen from above, at the same height and distance. 0: the very same camera.
Camera turned(const Camera& camera, double turn);

/// `lower`, `upper`: the scene's box. Throws Error for a view without direction (eye = look, up along the view, a field
/// of view outside (0°, 180°)), naming the option.
View make_view(const Camera& camera, float aspect, const glm::vec3& lower, const glm::vec3& upper);

}  // namespace peelray
