// The choices that settings offer, and their names: one table for each, read by whoever parses or prints them.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "path/aov_table.h"

namespace peelray {

template <typename Value>
struct Named {
    Value value;
    const char* name;
};

enum class YesNo : uint8_t { yes, no };
constexpr auto names_of(YesNo) {
    return std::to_array<Named<YesNo>>({{YesNo::yes, "yes"}, {YesNo::no, "no"}});
}

/// Of an EXR.
enum class Compression : uint8_t {
    zip,  ///< blocks of 16 rows
    none,
};
constexpr auto names_of(Compression) {
    return std::to_array<Named<Compression>>({{Compression::zip, "zip"}, {Compression::none, "none"}});
}

/// Who answers for what a surface mirrors, lets through and has in its way to the light.
enum class Tracer : uint8_t {
    ldc,        ///< rays in the layered depth cube
    cpu,        ///< all rays on the CPU, in single precision
    reference,  ///< all rays on the CPU, in double precision
    cubemap,    ///< the baseline: cube maps of each object's surroundings and shadow maps
    khr,        ///< the rival: rays by the device's own ray tracing
    none,       ///< nobody: the environment is all that surfaces see, and no light is blocked
};
constexpr auto names_of(Tracer) {
    return std::to_array<Named<Tracer>>({{Tracer::ldc, "ldc"},
                                         {Tracer::cpu, "cpu"},
                                         {Tracer::reference, "reference"},
                                         {Tracer::cubemap, "cubemap"},
                                         {Tracer::khr, "khr"},
                                         {Tracer::none, "none"}});
}
/// Does it need no Vulkan device?
constexpr bool is_on_cpu(Tracer tracer) {
    return tracer == Tracer::cpu || tracer == Tracer::reference;
}

/// What a ray takes for a hit.
enum class HitTest : uint8_t {
    exact,      ///< the triangles themselves
    planar,     ///< the samples' planes, each inside its footprint
    tolerance,  ///< the samples' depths, within a distance (the paper, section 3)
};
constexpr auto names_of(HitTest) {
    return std::to_array<Named<HitTest>>(
        {{HitTest::exact, "exact"}, {HitTest::planar, "planar"}, {HitTest::tolerance, "tolerance"}});
}

/// How rays walk through a cube, which decides the order of its samples.
enum class Traversal : uint8_t {
    voxel,      ///< by voxel: all three LDIs at once, front to back
    two_level,  ///< by pixel: one LDI after the other, in blocks of pixels (the paper, section 1.4)
    mipmap,     ///< by pixel: the same over a full min/max pyramid
};
constexpr auto names_of(Traversal) {
    return std::to_array<Named<Traversal>>(
        {{Traversal::voxel, "voxel"}, {Traversal::mipmap, "mipmap"}, {Traversal::two_level, "two-level"}});
}

/// Who rasterises: all make the same cube.
enum class BuilderKind : uint8_t {
    compute,  ///< compute shaders
    abuffer,  ///< the graphics pipeline, one pass: fragments append themselves
    peel,     ///< the graphics pipeline, a pass per layer: depth peeling (the paper, section 1.2)
};
constexpr auto names_of(BuilderKind) {
    return std::to_array<Named<BuilderKind>>(
        {{BuilderKind::compute, "compute"}, {BuilderKind::abuffer, "abuffer"}, {BuilderKind::peel, "peel"}});
}

/// How a triangle gets into the LDI that its normal picks, in the graphics pipeline.
enum class Routing : uint8_t {
    geometry,  ///< a geometry shader sends it there: one submission of the geometry for all three (the paper)
    draws,     ///< each LDI is drawn on its own; vertices of triangles that are not its own are thrown away
};
constexpr auto names_of(Routing) {
    return std::to_array<Named<Routing>>({{Routing::geometry, "geometry"}, {Routing::draws, "draws"}});
}

/// What two_level and mipmap do at a time (the paper, section 4).
enum class Batch : uint8_t {
    none,    ///< one sample, one ray
    layers,  ///< four samples of a pixel
    rays,    ///< four rays per thread: `peelray trace` and the bounces of a picture, not its shadow rays
};
constexpr auto names_of(Batch) {
    return std::to_array<Named<Batch>>({{Batch::none, "none"}, {Batch::layers, "layers"}, {Batch::rays, "rays"}});
}

/// Who finds what each pixel sees.
enum class Visibility : uint8_t {
    automatic,  ///< compute where the device can, but for software devices
    compute,    ///< compute shaders, with the camera's rays
    raster,     ///< the graphics pipeline
};
constexpr auto names_of(Visibility) {
    return std::to_array<Named<Visibility>>(
        {{Visibility::automatic, "auto"}, {Visibility::compute, "compute"}, {Visibility::raster, "raster"}});
}

/// The tone curve of the encoded picture.
enum class Tonemap : uint8_t { none, aces, neutral };
constexpr auto names_of(Tonemap) {
    return std::to_array<Named<Tonemap>>(
        {{Tonemap::none, "none"}, {Tonemap::aces, "aces"}, {Tonemap::neutral, "neutral"}});
}

/// How surfaces that are no mirrors find the environment's light.
enum class EnvironmentMode : uint8_t {
    sampled,   ///< rays in directions drawn by its brightness and by the surface's lobes: unbiased
    open,      ///< smooth approximations without noise, as if nothing stood in the way
    filtered,  ///< such approximations, and rays of fixed directions find what stands in the way: no noise either
};
constexpr auto names_of(EnvironmentMode) {
    return std::to_array<Named<EnvironmentMode>>({{EnvironmentMode::sampled, "sampled"},
                                                  {EnvironmentMode::open, "open"},
                                                  {EnvironmentMode::filtered, "filtered"}});
}

/// What the camera sees of the environment where nothing is before it.
enum class EnvVisible : uint8_t { yes, no, blurred };
constexpr auto names_of(EnvVisible) {
    return std::to_array<Named<EnvVisible>>(
        {{EnvVisible::yes, "yes"}, {EnvVisible::no, "no"}, {EnvVisible::blurred, "blurred"}});
}

/// What is done about the noise of light that is drawn at random.
enum class Denoise : uint8_t {
    none,
    spatial,   ///< it is smoothed where the picture shows the same
    temporal,  ///< of this picture and those of a fixed number of moments before, and then smoothed likewise
};
constexpr auto names_of(Denoise) {
    return std::to_array<Named<Denoise>>(
        {{Denoise::spatial, "spatial"}, {Denoise::temporal, "temporal"}, {Denoise::none, "none"}});
}

/// What every surface of a scene can be made of instead.
enum class MaterialOverride : uint8_t { mirror, glass, clay };
constexpr auto names_of(MaterialOverride) {
    return std::to_array<Named<MaterialOverride>>(
        {{MaterialOverride::mirror, "mirror"}, {MaterialOverride::glass, "glass"}, {MaterialOverride::clay, "clay"}});
}

/// What is traced.
enum class Effect : uint8_t { reflection, refraction, shadow, ambient };
constexpr auto names_of(Effect) {
    return std::to_array<Named<Effect>>({{Effect::reflection, "reflection"},
                                         {Effect::refraction, "refraction"},
                                         {Effect::shadow, "shadow"},
                                         {Effect::ambient, "ambient"}});
}

/// Kinds of rays, each a set of its own.
enum class RayKind : uint8_t {
    primary,     ///< from the camera, one per pixel
    mirror,      ///< reflected where a primary ray hits, as if everything were a perfect mirror
    refraction,  ///< up to four refractions or total reflections in a row, as if everything were glass of index 1.5
    shadow,      ///< from where primary rays hit to the light, where the surface faces it
    ambient,     ///< four per hit, cosine-distributed around the normal: is the sky seen?
    diffuse,     ///< one per hit, cosine-distributed: what is seen?
};
constexpr auto names_of(RayKind) {
    return std::to_array<Named<RayKind>>({{RayKind::primary, "primary"},
                                          {RayKind::mirror, "mirror"},
                                          {RayKind::refraction, "refraction"},
                                          {RayKind::shadow, "shadow"},
                                          {RayKind::ambient, "ambient"},
                                          {RayKind::diffuse, "diffuse"}});
}

/// Auxiliary pictures (path/aov_table.h).
enum class Aov : uint8_t {
#define AOV_VALUE(name, type, channels, nothing) name,
    SURFACE_AOVS(AOV_VALUE) RAY_SETUP_AOVS(AOV_VALUE) SAMPLE_AOVS(AOV_VALUE) COST_AOVS(AOV_VALUE)
#undef AOV_VALUE
};
constexpr auto names_of(Aov) {
#define AOV_NAME(name, type, channels, nothing) Named<Aov>{Aov::name, #name},
    return std::to_array({SURFACE_AOVS(AOV_NAME) RAY_SETUP_AOVS(AOV_NAME) SAMPLE_AOVS(AOV_NAME) COST_AOVS(AOV_NAME)});
#undef AOV_NAME
}

/// An enumeration with a table of names.
template <typename Value>
concept Choice = requires(Value value) {
    names_of(value);
};

template <Choice Value>
constexpr const char* name_of(Value value) {
    for (const Named<Value>& each : names_of(value))
        if (each.value == value) return each.name;
    return "";
}

/// None: nothing is called so.
template <Choice Value>
constexpr std::optional<Value> value_named(std::string_view name) {
    for (const Named<Value>& each : names_of(Value{}))
        if (name == each.name) return each.value;
    return std::nullopt;
}

/// All, in the order in which help lists them.
template <Choice Value>
std::vector<Value> values_of() {
    std::vector<Value> values;
    for (const Named<Value>& each : names_of(Value{})) values.push_back(each.value);
    return values;
}

/// Some of a choice, in no order.
template <Choice Value>
class ChoiceSet {
  public:
    constexpr ChoiceSet() = default;
    constexpr ChoiceSet(std::initializer_list<Value> values) {
        for (const Value value : values) add(value);
    }
    constexpr void add(Value value) { bits_ |= 1u << unsigned(value); }
    constexpr bool has(Value value) const { return bits_ >> unsigned(value) & 1; }
    constexpr bool operator==(const ChoiceSet&) const = default;

  private:
    uint32_t bits_ = 0;
};

}  // namespace peelray
