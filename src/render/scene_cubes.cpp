#include "render/scene_cubes.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace peelray {
namespace {

/// `auto` of planar hits, which are as good as their voxels are fine.
constexpr float kPlanarResolution = 1024;
/// Share of the resolution that every body gets, however small it is beside the largest; of more bodies than a few only
/// as much that its voxels are at most so many times as fine.
constexpr float kLeast = 0.25f, kFinest = 4;
constexpr size_t kFewBodies = 16;
/// Where cubes find no room, those with this share of their voxels along a side are tried, down to the last. A
/// surface's samples become fewer with the square of it until there is about one for each triangle and LDI: that takes
/// an eighth.
constexpr float kCoarser = 0.75f, kCoarsest = 0.1f;

/// Of cubes that are built for every frame, and of those that are built once. Where no list is four times as long as
/// the others may be, rays gain less than the build takes (docs/lab_notes.md).
/// A list takes 20 ns: more than so many would take longer than anything that rays gain (100,000 bodies in flight: 10
/// ms for 1 ms).
constexpr Refinement kRebuilt{24, 90, 32'768}, kKept{16, 48};

/// Software devices have no lanes that would wait for the longest list of a group.
Refinement refinement_of(const Device& device, const CubeChoice& choice, bool kept) {
    if (choice.refine) return {*choice.refine};
    if (device.immediate) return {};
    return kept ? kKept : kRebuilt;
}

/// Of copies that lie apart. By their number alone, so that it stays what it is while they move. On builtin:particles
/// (H200) a frame takes 6.6 ms at N = 272, 5.8 at 640, 5.6 at 900; with 100,000 bodies 20 ms from 560 to 750, 25 at
/// 1168.
float merged_resolution(uint32_t triangles) {
    return std::min(10 * std::cbrt(float(triangles)), 704.0f);
}

float longest_side(const Assembly::Body& body) {
    const glm::vec3 size = body.upper - body.lower;
    return std::max({size.x, size.y, size.z, 0.0f});
}

/// Not of corners that builds drop (shaders/common/bounds.glsl).
bool is_bounded(const Assembly::Body& body) {
    const glm::vec3 far = glm::max(glm::abs(body.lower), glm::abs(body.upper));
    return std::max({far.x, far.y, far.z}) < 1e30f;
}

uint32_t in_sixteens(float voxels) {
    return uint32_t(std::clamp(std::ceil(voxels / 16) * 16, 16.0f, 2048.0f));
}

/// To three digits, so that what a message suggests is allowed.
double rounded_down(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
    return std::floor(value / digit) * digit;
}

std::vector<CubeBody> cube_bodies(const Assembly& assembly, const CubeChoice& choice, uint32_t fixed,
                                  const std::vector<float>& scales) {
    const std::vector<uint32_t> resolutions = choose_resolutions(assembly, choice, fixed);
    std::vector<CubeBody> bodies;
    for (size_t i = 0; i < assembly.bodies.size(); i++) {
        const Assembly::Body& body = assembly.bodies[i];
        bodies.push_back({body.first_triangle, body.triangles, resolutions[i], body.lower, body.upper, 0});
        // What a ray would have to do to enter a cube costs more than a few triangles.
        bodies.back().bare = body.triangles >= 1 && body.triangles <= PEELRAY_BARE_TRIANGLES && is_bounded(body) &&
                             choice.hit != HitTest::tolerance && !choice.layout.by_pixel() &&
                             choice.layout.builder == BuilderKind::compute;
        if (choice.hit != HitTest::tolerance) continue;
        bodies.back().tolerance = choice.tolerance / scales[i];
        const float voxel = make_grid(body.lower, body.upper, resolutions[i]).voxel;
        if (!choice.layout.by_pixel() && bodies.back().tolerance > LDC_FARTHEST_BY_VOXEL * voxel)
            fail(
                "a tolerance of {} is more than {} voxels of a cube, which {} voxel cannot hold: choose at most {:.3g} "
                "({}), a smaller {}, or {} two-level",
                choice.tolerance, LDC_FARTHEST_BY_VOXEL, setting::traversal,
                rounded_down(LDC_FARTHEST_BY_VOXEL * voxel * scales[i]), setting::tolerance, setting::ldc,
                setting::traversal);
    }
    return bodies;
}

BuildCounts sum_of(const BuildCounts& a, const BuildCounts& b) {
    BuildCounts sum = a;
    sum.fragments += b.fragments;
    sum.blocks += b.blocks;
    sum.listed += b.listed;
    sum.cells += b.cells;
    sum.occupied += b.occupied;
    sum.nodes += b.nodes;
    sum.voxels += b.voxels;
    sum.long_lists += b.long_lists;
    sum.longest = std::max(a.longest, b.longest);
    sum.complexity = std::max(a.complexity, b.complexity);
    sum.passes += b.passes;
    sum.refined += b.refined;
    sum.fine += b.fine;
    sum.degenerate += b.degenerate;
    sum.invalid += b.invalid;
    return sum;
}

}  // namespace

std::optional<CubeChoice> smaller_than(const CubeChoice& choice) {
    CubeChoice smaller = choice;
    smaller.fineness *= kCoarser;
    if (choice.ldc == 0 && smaller.fineness >= kCoarsest) return smaller;
    if (!choice.may_be_planar) return std::nullopt;
    smaller.fineness = 1;
    smaller.hit = HitTest::planar;
    smaller.may_be_planar = false;
    return smaller;
}

std::vector<uint32_t> choose_resolutions(const Assembly& assembly, const CubeChoice& choice, uint32_t fixed) {
    float largest = 1e-30f;
    for (const Assembly::Body& body : assembly.bodies) largest = std::max(largest, longest_side(body));
    const bool by_triangles = choice.ldc == 0 && choice.hit == HitTest::exact;
    const float n = choice.ldc == 0 ? kPlanarResolution * choice.fineness : float(round_resolution(choice.ldc));
    std::vector<uint32_t> resolutions;
    for (size_t i = 0; i < assembly.bodies.size(); i++) {
        const Assembly::Body& body = assembly.bodies[i];
        const float share = choice.ldc_each ? 1 : longest_side(body) / largest;
        // Of very many small bodies each would get more than it can use.
        const float least = assembly.bodies.size() > kFewBodies ? std::min(kLeast, kFinest * share) : kLeast;
        uint32_t resolution = in_sixteens(n * std::max(share, least));
        // Exact hits need no finer voxels than a sixteenth of a triangle's edge, whatever is asked for.
        if (choice.hit == HitTest::exact)
            resolution = std::min(resolution, in_sixteens(16 * std::sqrt(float(body.triangles))));
        if (by_triangles && body.merged)
            resolution = in_sixteens(choice.fineness * merged_resolution(body.triangles));
        else if (by_triangles)
            resolution = in_sixteens(choice.fineness * float(serving_resolution(body.triangles, longest_side(body),
                                                                                body.inverse_edges, i >= fixed)));
        resolutions.push_back(resolution);
    }
    return resolutions;
}

uint32_t largest_resolution(const Assembly& assembly, const CubeChoice& choice, uint32_t fixed) {
    if (choice.ldc != 0) return round_resolution(choice.ldc);
    const std::vector<uint32_t> resolutions = choose_resolutions(assembly, choice, fixed);
    return *std::max_element(resolutions.begin(), resolutions.end());
}

SceneCubes::SceneCubes(Device& device, const Assembly& assembly, const CubeChoice& choice, uint32_t fixed,
                       const std::vector<float>& scales)
    : device_(device),
      choice_(choice),
      fixed_(fixed),
      cubes_(device, cube_bodies(assembly, choice, fixed, scales), sampling_for(choice.hit), choice.layout) {}

bool SceneCubes::build_fixed(Commands& commands, const TriangleBuffers& triangles) {
    if (fixed_built_) return false;
    if (fixed_ > 0) {
        // Its scratch memory goes when the work is done.
        CubeBuilder builder(device_, commands, cubes_, 0, fixed_, {}, refinement_of(device_, choice_, true));
        builder.build(commands, triangles);
        fixed_counts_ = builder.counts();
        fixed_size_ = builder.size();
        fixed_redone_ = builder.redone();
    }
    // The builder guessed; what does not deform never needs more.
    if (fixed_ > 0) cubes_.trim(fixed_size_);
    const auto all = uint32_t(cubes_.bodies().size());
    if (fixed_ < all)
        builder_ = std::make_unique<CubeBuilder>(device_, commands, cubes_, fixed_, all - fixed_, fixed_size_,
                                                 refinement_of(device_, choice_, false));
    fixed_built_ = true;
    return fixed_ > 0;
}

void SceneCubes::record(Commands& commands, const TriangleBuffers& triangles) {
    if (builder_) builder_->record(commands, triangles);
}

bool SceneCubes::finish(Commands& commands) {
    return !builder_ || builder_->finish(commands);
}

SceneCubes::Stats SceneCubes::stats() const {
    Stats stats;
    stats.bodies = uint32_t(cubes_.bodies().size());
    stats.fixed = fixed_;
    stats.choice = choice_;
    for (const CubeBody& body : cubes_.bodies()) stats.bare += body.bare;
    if (choice_.ldc != 0)
        stats.resolution = round_resolution(choice_.ldc);
    else
        for (const CubeBody& body : cubes_.bodies())
            if (!body.bare) stats.resolution = std::max(stats.resolution, body.resolution);
    stats.counts = builder_ ? sum_of(fixed_counts_, builder_->counts()) : fixed_counts_;
    stats.bytes = (fixed_size_ + (builder_ ? builder_->size() : TableSize{})).bytes(cubes_.sample_bytes()) +
                  cubes_.bodies().size() * (sizeof(LdcBody) + 24) + cubes_.corners.bytes();
    stats.scratch_bytes = builder_ ? builder_->scratch_bytes() : 0;
    stats.redone = fixed_redone_ + (builder_ ? builder_->redone() : 0);
    return stats;
}

}  // namespace peelray
