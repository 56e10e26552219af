#include "render/scene_cubes.h"

#include <algorithm>
#include <cmath>

namespace peelray {
namespace {

/// A small body's voxels are at most this much finer than those of the largest: beyond it they cost memory and bring
/// nothing.
constexpr float kFinest = 4;

float longest_side(const Assembly::Body& body) {
    const glm::vec3 size = body.upper - body.lower;
    return std::max({size.x, size.y, size.z, 0.0f});
}

uint32_t in_sixteens(float voxels) {
    return uint32_t(std::clamp(std::ceil(voxels / 16) * 16, 16.0f, 2048.0f));
}

std::vector<CubeBody> cube_bodies(const Assembly& assembly, const CubeChoice& choice) {
    const std::vector<uint32_t> resolutions = choose_resolutions(assembly, choice);
    std::vector<CubeBody> bodies;
    for (size_t i = 0; i < assembly.bodies.size(); i++) {
        const Assembly::Body& body = assembly.bodies[i];
        bodies.push_back({body.first_triangle, body.triangles, resolutions[i], body.lower, body.upper});
    }
    return bodies;
}

LdcCounters sum_of(const LdcCounters& a, const LdcCounters& b) {
    LdcCounters sum = a;
    sum.fragments += b.fragments;
    sum.big += b.big;
    sum.tiles += b.tiles;
    sum.tops += b.tops;
    sum.occupied += b.occupied;
    sum.nodes += b.nodes;
    sum.voxels += b.voxels;
    sum.long_lists += b.long_lists;
    sum.longest = std::max(a.longest, b.longest);
    sum.degenerate += b.degenerate;
    sum.invalid += b.invalid;
    return sum;
}

}  // namespace

std::vector<uint32_t> choose_resolutions(const Assembly& assembly, const CubeChoice& choice) {
    float largest = 0;
    for (const Assembly::Body& body : assembly.bodies) largest = std::max(largest, longest_side(body));
    std::vector<uint32_t> resolutions;
    for (const Assembly::Body& body : assembly.bodies) {
        const float share = longest_side(body) / std::max(largest, 1e-30f);
        uint32_t resolution = choice.ldc;
        if (resolution == 0)
            resolution = choice.hit == HitTest::exact ? serving_resolution(body.triangles)
                                                      : std::max(512u, in_sixteens(share * 1024));
        // What is asked for by number is for those who want just that, unless there are very many.
        if (choice.hit == HitTest::planar ? choice.ldc == 0 : assembly.bodies.size() > 16)
            resolution = std::min(resolution, in_sixteens(kFinest * float(resolution) * share));
        resolutions.push_back(resolution);
    }
    return resolutions;
}

SceneCubes::SceneCubes(Device& device, const Assembly& assembly, const CubeChoice& choice)
    : device_(device),
      choice_(choice),
      fixed_(choice.rebuild ? 0 : assembly.fixed),
      cubes_(device, cube_bodies(assembly, choice), sampling_for(choice.hit)) {}

bool SceneCubes::build_fixed(Commands& commands, const TriangleBuffers& triangles) {
    if (fixed_built_) return false;
    if (fixed_ > 0) {
        // Its scratch memory goes when the work is done.
        ComputeBuilder builder(device_, commands, cubes_, 0, fixed_);
        builder.build(commands, triangles);
        fixed_counts_ = builder.counts();
        fixed_size_ = builder.size();
        fixed_redone_ = builder.redone();
    }
    const auto all = uint32_t(cubes_.bodies().size());
    if (fixed_ < all)
        builder_ = std::make_unique<ComputeBuilder>(device_, commands, cubes_, fixed_, all - fixed_, fixed_size_);
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
    for (const CubeBody& body : cubes_.bodies()) stats.resolution = std::max(stats.resolution, body.resolution);
    stats.counts = builder_ ? sum_of(fixed_counts_, builder_->counts()) : fixed_counts_;
    stats.bytes = (fixed_size_ + (builder_ ? builder_->size() : TableSize{})).bytes() +
                  cubes_.bodies().size() * (sizeof(LdcBody) + 24);
    stats.scratch_bytes = builder_ ? builder_->scratch_bytes() : 0;
    stats.redone = fixed_redone_ + (builder_ ? builder_->redone() : 0);
    return stats;
}

}  // namespace peelray
