// The table of settings: what a picture shows and how it is made. A setting is a member here and, beside it, its entry;
// options, help, checks and the manifest of a sequence follow from the entry. docs/usage.md shows how they are used.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "settings/setting_list.h"

namespace peelray {

/// Where the camera stands, and when.
struct ViewArguments {
    std::optional<glm::dvec3> eye, look;  ///< in the world
    std::optional<glm::vec3> up;
    std::optional<float> fov;  ///< degrees
    std::string camera;
    std::optional<double> time;  ///< seconds
    std::string animation;
    bool frame_moment = false;
    bool goes_round = false;  ///< not an option: the camera is going to, and is to see everything on the way
};

inline void add_view(SettingList& list, ViewArguments& a) {
    const std::string group = "View", form = "X,Y,Z", expected = "three numbers X,Y,Z";
    add_setting(list, a.eye,
                {.name = "eye", .group = group, .help = "where the camera stands", .form = form, .expected = expected});
    add_setting(list, a.look,
                {.name = "look",
                 .group = group,
                 .help = "the point it looks at; default: the scene's centre",
                 .form = form,
                 .expected = expected});
    add_setting(list, a.up,
                {.name = "up",
                 .group = group,
                 .help = "its upward direction; default: 0,1,0",
                 .form = form,
                 .expected = expected});
    add_setting(list, a.fov,
                {.name = "fov",
                 .group = group,
                 .help = "vertical field of view; default: the camera's own, 40 where there is none",
                 .form = "DEGREES",
                 .limits = {.least = 0,
                            .most = 180,
                            .open = true,
                            .fault = "a field of view of {} degrees is impossible",
                            .choose = "one between 0 and 180"}});
    add_setting(
        list, a.camera,
        {.name = "camera",
         .group = group,
         .help = "a camera of the scene, by its name, its node's or its number in the file, see 'peelray info SCENE'; "
                 "default: the first, or the whole scene in view",
         .form = "NAME|N"});
    add_setting(
        list, a.time,
        {.name = "time",
         .group = group,
         .help = "moment of the animation; default: everything at rest",
         .form = "SECONDS",
         .limits = {
             .least = 0, .most = 1e6, .fault = "a moment of {} seconds is out of range", .choose = "0 to 1000000"}});
    add_setting(
        list, a.animation,
        {.name = "animation",
         .group = group,
         .help = "which one, see 'peelray info SCENE', or all at once; default: the first, with --time or --frames",
         .form = "NAME|N|all"});
    add_setting(list, a.frame_moment,
                {.name = "frame-moment",
                 .group = group,
                 .help = "without a camera: show as large as can be what there is at this moment, not all that the "
                         "animation reaches; for one moment, not for --frames"});
}

/// What lights the scene, and how bright the picture is.
struct LightArguments {
    std::string env;
    bool sky = false;
    double env_rotation = 0;                ///< degrees, counter-clockwise as seen from above
    float env_intensity = 1;                ///< of all that the environment sends
    std::optional<EnvVisible> env_visible;  ///< none: as there is a background or not
    std::optional<Background> background;
    float light_radius = 0;                   ///< world units
    std::optional<EnvironmentMode> env_mode;  ///< none: sampled where it is an image
    float exposure = 0;                       ///< stops
    Tonemap tonemap = Tonemap::neutral;

    /// Is the background's colour the light, too? Beside a chosen environment, or where that is not to be seen, it only
    /// is what is seen.
    bool is_lit_by_background() const {
        return background && background->color && env.empty() && !sky && env_visible != EnvVisible::no;
    }
    bool is_transparent() const { return background && background->is_transparent(); }
    /// What is seen of the environment.
    EnvVisible visible() const {
        const bool hides = background && !is_lit_by_background();
        return env_visible.value_or(hides ? EnvVisible::no : EnvVisible::yes);
    }
};

/// The environment, whichever it is, and what is seen of it.
inline void add_environment(SettingList& list, LightArguments& a, const std::string& group) {
    add_setting(
        list, a.background,
        {.name = "background",
         .group = group,
         .help = "one colour from everywhere, linear, from 0 up; with --env, --sky or --env-visible no it "
                 "lights nothing and is what is seen instead of the environment; transparent: the picture gets "
                 "an alpha channel, straight in a .png, premultiplied in an .exr",
         .form = "R,G,B|transparent",
         .expected = "three numbers R,G,B, or transparent",
         .limits = {
             .least = 0, .fault = "a background cannot be darker than black", .choose = "three numbers from 0 up"}});
    add_setting(list, a.env_rotation,
                {.name = "env-rotation",
                 .group = group,
                 .help = "turn of the environment around the vertical, counter-clockwise as seen from above",
                 .form = "DEGREES",
                 .limits = {.open = true,
                            .fault = "a rotation by {} degrees is impossible",
                            .choose = "a finite number, such as 90"}});
    add_setting(
        list, a.env_intensity,
        {.name = "env-intensity",
         .group = group,
         .help = "how bright the environment is, times what it is by itself; the scene's own lights stay",
         .limits = {
             .least = 0, .most = 1e6f, .fault = "an intensity of {} is out of range", .choose = "0 to 1000000"}});
    add_setting(list, a.env_visible,
                {.name = "env-visible",
                 .group = group,
                 .help = "what the camera sees of the environment where nothing is before it: all, nothing but the "
                         "--background (black where there is none), or a blurred picture of it; mirrors, glass and "
                         "rough surfaces see all of it",
                 .preset = "yes, or no with --background beside --env or --sky"});
}

inline void add_light(SettingList& list, LightArguments& a) {
    const std::string group = "Light";
    add_setting(
        list, a.env,
        {.name = "env", .group = group, .help = "environment map, equirectangular .hdr or .exr", .form = "FILE"});
    add_setting(list, a.sky,
                {.name = "sky",
                 .group = group,
                 .help = "procedural sky with a sun; default: a studio for a file without lights, this sky for a "
                         "built-in scene without, a dim grey for a scene with lights",
                 .excludes = {"env"}});
    add_environment(list, a, group);
    add_setting(list, a.env_mode,
                {.name = "env-mode",
                 .group = group,
                 .help = "how the environment lights what is no mirror: by sampling where it is bright, behind what is "
                         "in the way; or (open) as if nothing were, without noise; or (filtered), without noise "
                         "either, roughly behind what is in the way of a few fixed directions: a preview; auto: images "
                         "and the studio are sampled, others open",
                 .none = "auto"});
    add_setting(list, a.light_radius,
                {.name = "light-radius",
                 .group = group,
                 .help = "of the balls that the scene's point and spot lights are, in world units: several samples per "
                         "pixel see their shadows soften",
                 .form = "R",
                 .limits = {.least = 0, .fault = "a light cannot have the radius {}", .choose = "0 or more"}});
    add_setting(
        list, a.exposure,
        {.name = "exposure",
         .group = group,
         .help = "of a .png, in stops: each doubles the brightness",
         .form = "STOPS",
         .limits = {
             .least = -64, .most = 64, .fault = "an exposure of {} stops is out of range", .choose = "-64 to 64"}});
    add_setting(list, a.tonemap, {.name = "tonemap", .group = group, .help = "tone curve of a .png"});
}

/// How rays are traced in the layered depth cube.
struct TracingArguments {
    std::optional<Tracer> tracer;    ///< none: ldc, but for what resolves it by the machine (automatic_tracer)
    std::optional<HitTest> hit;      ///< none: chosen by the number of triangles
    std::optional<uint32_t> ldc;     ///< none: chosen for each part
    std::optional<uint32_t> refine;  ///< none: by what is built once, what for every frame, and the device
    std::optional<uint32_t> merge;   ///< triangles; none: chosen
    double tolerance = 0.001;
    std::optional<BuilderKind> builder;  ///< none: compute
    Routing routing = Routing::geometry;
    uint32_t depth = 32;  ///< bits
    Batch batch = Batch::none;
    Traversal traversal = Traversal::voxel;
    glm::uvec2 block{8};
};

inline void add_hit(SettingList& list, TracingArguments& a) {
    add_setting(
        list, a.hit,
        {.name = "hit",
         .group = "Tracing",
         .help = "exact: the triangles themselves; planar: the samples' planes, at a cost that does not depend on the "
                 "number of triangles; tolerance: the samples' depths, within --tolerance, as in the paper; auto: "
                 "exact up to a few million triangles (with --builder peel: planar)",
         .none = "auto",
         .of_cubes = true});
}

inline void add_block(SettingList& list, glm::uvec2& block, SettingInfo info) {
    info.name = "block";
    info.form = "N|NxM";
    info.expected = "a number of pixels such as 8 or 8x4";
    info.preset = "8";
    info.limits = kBlockLimits;
    info.of_cubes = true;
    add_setting(list, block, std::move(info), parse_block,
                [](const glm::uvec2& value) { return std::optional(print_text(value)); });
}

/// A number of the cubes', or that it is chosen.
inline void add_automatic(SettingList& list, std::optional<uint32_t>& number, SettingInfo info) {
    info.form = "auto|N";
    info.none = "auto";
    info.of_cubes = true;
    add_setting(list, number, std::move(info));
}

inline void add_refine(SettingList& list, std::optional<uint32_t>& refine, SettingInfo info) {
    info.name = "refine";
    info.expected = "auto or a number of samples from 1 up";
    info.limits = kRefineLimits;
    add_automatic(list, refine, std::move(info));
}

inline void add_merge(SettingList& list, std::optional<uint32_t>& merge, SettingInfo info) {
    info.name = "merge";
    info.expected = "auto or a number of triangles from 0 up";
    info.limits = kMergeLimits;
    add_automatic(list, merge, std::move(info));
}

inline constexpr Limits kToleranceLimits{
    .least = 0, .open = true, .fault = "a tolerance of {} is impossible", .choose = "a distance above 0"};

inline void add_tracing(SettingList& list, TracingArguments& a) {
    const std::string group = "Tracing";
    add_automatic(list, a.ldc,
                  {.name = "ldc",
                   .group = group,
                   .help = "voxels along the longest side of the largest part that has a cube of its own, 16 to 2048; "
                           "smaller parts get fewer; auto: by the number of triangles of each",
                   .expected = "auto or a number from 16 to 2048",
                   .limits = kResolutionLimits});
    add_refine(list, a.refine,
               {.group = group, .help = "with --hit exact, voxels of more than N samples become 4x4x4 finer ones"});
    add_merge(list, a.merge,
              {.group = group, .help = "many objects of at most N triangles share a cube (--hit exact)"});
    add_setting(list, a.tolerance,
                {.name = "tolerance",
                 .group = group,
                 .help = "distance of a hit of --hit tolerance, world units",
                 .limits = kToleranceLimits,
                 .of_cubes = true});
    add_setting(list, a.builder,
                {.name = "builder",
                 .group = group,
                 .help = "what rasterises the layered depth cubes: compute shaders, or the graphics pipeline in one "
                         "pass (abuffer) or one pass per layer (peel, as in the paper); auto: compute",
                 .none = "auto",
                 .of_cubes = true});
    add_setting(list, a.routing,
                {.name = "routing",
                 .group = group,
                 .help = "how the graphics pipeline sends triangles to the three images: a geometry shader, or three "
                         "draws",
                 .of_cubes = true});
    add_setting(list, a.depth,
                {.name = "depth",
                 .group = group,
                 .help = "bits of the samples' depths with --traversal two-level and mipmap: 32, or 16 as in the paper",
                 .form = "16|32",
                 .limits = {.least = 16,
                            .most = 32,
                            .step = 16,
                            .fault = "a depth of {} bits is not supported",
                            .choose = "16 or 32"},
                 .of_cubes = true});
    add_setting(list, a.batch,
                {.name = "batch",
                 .group = group,
                 .help = "for measuring: two-level and mipmap test four layers of a pixel at a time, or trace four "
                         "rays at a time",
                 .of_cubes = true});
    add_setting(list, a.traversal,
                {.name = "traversal",
                 .group = group,
                 .help = "how rays walk through a cube: all of it at once by voxels, or one image after the other over "
                         "blocks of pixels (two-level, as in the paper) or a full pyramid (mipmap)",
                 .of_cubes = true});
    add_block(list, a.block, {.group = group, .help = "pixels per block with --traversal two-level, 2 to 32 a side"});
}

/// What is read of a file in one of several ways.
struct SceneArguments {
    std::string variant;              ///< of its materials
    std::optional<float> point_size;  ///< world units; none: points and lines are left out
    bool double_sided = false;        ///< whatever its materials say
};

inline void add_scene(SettingList& list, SceneArguments& a) {
    add_setting(list, a.variant,
                {.name = "variant",
                 .group = "Scene",
                 .help = "the materials that a glTF file has under that name, see 'peelray info SCENE'",
                 .form = "NAME"});
    add_setting(
        list, a.point_size,
        {.name = "point-size",
         .group = "Scene",
         .help = "diameter, in world units, of the balls and tubes that show a glTF file's points and lines; "
                 "default: they are left out",
         .limits = {
             .least = 0, .open = true, .fault = "points of size {} cannot be seen", .choose = "a diameter above 0"}});
    add_setting(list, a.double_sided,
                {.name = "double-sided",
                 .group = "Scene",
                 .help = "show all faces from both sides, also those of which a glTF file shows the front only"});
}

/// What is traced, and of what.
struct EffectArguments {
    ChoiceSet<Effect> effects = {Effect::reflection, Effect::refraction, Effect::shadow};
    uint32_t bounces = 4, gi = 0, caustics = 0, spp = 1, seed = 0;
    std::optional<float> clamp;  ///< radiance; none: samples are as bright as they are
    std::optional<MaterialOverride> material;
    bool floor = false;
    bool shadow_catcher = false;
    bool no_energy_compensation = false;
    Denoise denoise = Denoise::none;
};

/// A list out of the effects, or "none".
std::optional<ChoiceSet<Effect>> parse_effects(const std::string& text);

/// How often light is followed.
inline void add_ways(SettingList& list, EffectArguments& a, const std::string& group) {
    add_setting(list, a.bounces,
                {.name = "bounces",
                 .group = group,
                 .help = "reflections and refractions in a row, 0 to 16",
                 .limits = kBounceLimits});
    add_setting(list, a.gi,
                {.name = "gi",
                 .group = group,
                 .help = "indirect light: diffuse bounces in a row, 0 to 16",
                 .limits = kBounceLimits});
    add_setting(list, a.caustics,
                {.name = "caustics",
                 .group = group,
                 .help = "photons that the lamps send by way of mirrors and glass to rough surfaces, for each sample "
                         "per pixel; 100000 is a good number; 0: no caustics, and glass only tints shadows",
                 .limits = kPhotonLimits});
}

inline void add_effects(SettingList& list, EffectArguments& a) {
    const std::string group = "Effects";
    add_setting(list, a.effects,
                {.name = "effects",
                 .group = group,
                 .help = "what is traced, a list out of reflection,refraction,shadow,ambient, or none",
                 .form = "LIST",
                 .expected = "a list out of reflection,refraction,shadow,ambient, or none"},
                parse_effects, [](const ChoiceSet<Effect>& effects) {
                    const std::string names = print_text(effects);
                    return names.empty() ? std::nullopt : std::optional(names);
                });
    add_ways(list, a, group);
    add_setting(list, a.spp,
                {.name = "spp",
                 .group = group,
                 .help = "samples per pixel: smooth edges and rough reflections",
                 .limits = kSampleLimits});
    add_setting(list, a.seed,
                {.name = "seed",
                 .group = group,
                 .help = "of the random numbers: other values give other noise, with the same mean"});
    add_setting(list, a.clamp,
                {.name = "clamp",
                 .group = group,
                 .help = "scale down samples of which a channel is brighter than this radiance: fewer stray white "
                         "dots, but a darker picture; default: none is",
                 .limits = kClampLimits});
    add_setting(list, a.material, {.name = "material", .group = group, .help = "make every surface of this material"});
    add_setting(list, a.floor,
                {.name = "floor", .group = group, .help = "put the scene on a slightly reflective floor"});
    add_setting(
        list, a.shadow_catcher,
        {.name = "shadow-catcher",
         .group = group,
         .help = "put the scene on a floor that shows nothing but shadows and mirror images, over the "
                 "background or, with --background transparent, in the alpha channel; not for --tracer cubemap"});
    add_setting(list, a.no_energy_compensation,
                {.name = "no-energy-compensation",
                 .group = group,
                 .help = "rough surfaces lose the light that they scatter more than once, as in many renderers"});
    add_setting(list, a.denoise,
                {.name = "denoise",
                 .group = group,
                 .help = "smooth the noise of light that is drawn at random, but not textures, edges or clear mirror "
                         "images; temporal: with the light of the five frames before; default: none, and spatial "
                         "where no value follows: each picture by itself",
                 .form = "[spatial|temporal|none]",
                 .expected = "one of spatial|temporal|none",
                 .implied = "spatial"});
}

/// Which device works.
struct DeviceArguments {
    std::string device;
    bool validate = false;
    std::optional<uint32_t> memory_limit;  ///< MiB; none: whatever the device has
};

inline void add_device(SettingList& list, DeviceArguments& a) {
    const std::string group = "Device";
    add_setting(list, a.device,
                {.name = "device",
                 .group = group,
                 .help = "by number or part of its name, see 'peelray devices'; default: the fastest kind there is",
                 .form = "N|NAME",
                 .changes_picture = false});
    add_setting(list, a.validate,
                {.name = "validate",
                 .group = group,
                 .help = "run under the Vulkan validation layers; any message is an error",
                 .changes_picture = false});
    add_setting(list, a.memory_limit,
                {.name = "memory-limit",
                 .group = group,
                 .help = "device memory held at most: what does not fit is made in bands, and cubes become coarser, "
                         "which no exact hit depends on; default: all that the device has",
                 .form = "MIB",
                 .expected = "a number of MiB such as 512",
                 .limits = kMemoryLimits,
                 .changes_picture = false});
}

/// What a picture shows and how it is made.
struct PictureArguments : ViewArguments, LightArguments, EffectArguments, SceneArguments {
    std::string scene;  ///< a file or builtin:NAME
    glm::uvec2 size{1280, 1024};
    TracingArguments tracing;
    Visibility visibility = Visibility::automatic;
    uint32_t repeat = 1;
    bool rebuild = false;
    DeviceArguments device;
};

inline constexpr Limits kRepeatLimits{
    .least = 1, .most = 10000, .fault = "{} repetitions are out of range", .choose = "1 to 10000"};
inline constexpr Limits kSizeLimits{.least = 1, .fault = "a picture of {} pixels is empty", .choose = "at least 1x1"};

/// All but the scene. `one`: with the tracer and the hit test; without where several of them are compared.
SettingList picture_settings(PictureArguments& a, bool one = true);

/// Several pictures in a row.
struct SequenceArguments {
    std::optional<FrameRange> frames;
    std::optional<double> fps;
    std::optional<uint32_t> turntable;  ///< frames of a full circle
    std::optional<Shard> shard;
    bool resume = false;
};

inline constexpr uint32_t kMostFrames = 10'000'000;

SettingList sequence_settings(SequenceArguments& a);

/// The auxiliary pictures of --aov: a list, or "all": those of what is seen.
std::optional<std::vector<Aov>> parse_aovs(const std::string& text);

/// Throw Error for values that are well-formed but make no sense, alone or together.
void check(const TracingArguments& arguments);
void check(const PictureArguments& arguments);

}  // namespace peelray
