#include "ldc/cubes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "ldc/ldc_grid.h"
#include "settings/limits.h"

namespace peelray {
namespace {

/// As orderedBits of shaders/bounds.glsl.
uint32_t ordered_bits(float x) {
    const auto bits = std::bit_cast<uint32_t>(x);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

glm::uvec3 ordered_bits(const glm::vec3& p) {
    return {ordered_bits(p.x), ordered_bits(p.y), ordered_bits(p.z)};
}

}  // namespace

uint32_t round_resolution(uint32_t resolution) {
    check_limits(kResolutionLimits, setting::ldc, resolution);
    return (resolution + 15) / 16 * 16;
}

TriangleBuffers::TriangleBuffers(Device& device, std::span<const glm::vec3> vertices,
                                 std::span<const glm::uvec3> indices)
    : count(uint32_t(indices.size())) {
    // Two bits of a sample's id hold its axis.
    if (indices.size() >= 1u << 30)
        fail("the scene has {} triangles, but cubes hold fewer than 2^30: split the scene", indices.size());
    const MemoryPart part(device, "triangles");
    positions = Buffer(device, "vertex positions", vertices.size_bytes());
    triangles = Buffer(device, "triangle indices", indices.size_bytes());
    Commands commands(device);
    commands.upload(positions, vertices);
    commands.upload(triangles, indices);
}

uint64_t most_exact_triangles(const Device& device) {
    return device.limits().maxStorageBufferRange / sizeof(LdcCorners);
}

void check_captures(BuilderKind builder, Sampling sampling) {
    if (sampling == Sampling::conservative) check_captures(builder, HitTest::exact);
}

CubeGrid make_grid(const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution) {
    return ldcMakeGrid(lower, upper, round_resolution(resolution));
}

Cubes::Cubes(Device& device, std::vector<CubeBody> bodies, Sampling sampling, const CubeLayout& layout)
    : device_(device), bodies_(std::move(bodies)), sampling_(sampling), layout_(layout) {
    assert(!bodies_.empty());
    check_limits(kBlockLimits, setting::block, layout.block);
    const MemoryPart part(device, "cubes");
    Commands commands(device);
    std::vector<LdcBody> table;
    std::vector<glm::uvec3> lower, upper;
    for (const CubeBody& body : bodies_) {
        assert(!body.bare || (body.triangles >= 1 && body.triangles <= PEELRAY_BARE_TRIANGLES && !layout.by_pixel() &&
                              layout.builder == BuilderKind::compute));
        const uint32_t resolution = round_resolution(body.resolution) | (body.bare ? LDC_BARE : 0);
        table.push_back({{}, body.first_triangle, body.triangles, resolution, 0, {}, body.tolerance});
        lower.push_back(ordered_bits(body.lower));
        upper.push_back(ordered_bits(body.upper));
    }
    body_table = Buffer(device, "the table of bodies", table.size() * sizeof(LdcBody));
    body_lower = Buffer(device, "lower bounds of bodies", lower.size() * sizeof(glm::uvec3));
    body_upper = Buffer(device, "upper bounds of bodies", upper.size() * sizeof(glm::uvec3));
    commands.upload(body_table, std::span<const LdcBody>(table));
    commands.upload(body_lower, std::span<const glm::uvec3>(lower));
    commands.upload(body_upper, std::span<const glm::uvec3>(upper));
}

void Cubes::reserve(Commands& commands, const TableSize& size, const TableSize& kept) {
    // Entries are 31-bit numbers of nodes and samples.
    if (size.cells >= 1ull << 32)
        fail("the cubes would hold {} pixels or cells, more than their tables can number: use a smaller {}", size.cells,
             setting::ldc);
    if (size.nodes >= 1u << 25 || size.samples >= 1u << 31)
        fail("the cubes would hold {} nodes and {} samples, more than their tables can number: use a smaller {}",
             size.nodes, size.samples, setting::ldc);
    const MemoryPart part(device_, "cubes");
    if (has_patches()) {
        const uint64_t triangles = uint64_t(bodies_.back().first_triangle) + bodies_.back().triangles;
        if (triangles > most_exact_triangles(device_))
            fail(
                "{} triangles are more than the device '{}' holds for exact hits by voxel ({}): use {} planar, or {} "
                "two-level",
                triangles, device_.info().name, most_exact_triangles(device_), setting::hit, setting::traversal);
        if (!corners) corners = Buffer(device_, "the cubes' corners of triangles", triangles * sizeof(LdcCorners));
        grow(device_, commands, patches, "the cubes' patches", size.samples * 16, kept.samples * 16);
    } else {
        grow(device_, commands, samples, "the cubes' samples", size.samples * 8, kept.samples * 8);
        grow(device_, commands, sample_ids, "the cubes' sample ids", size.samples * 4, kept.samples * 4);
    }
    const uint64_t attributes = layout_.streams ? 8 : 0;
    grow(device_, commands, sample_attributes, "the cubes' attributes", size.samples * attributes,
         kept.samples * attributes);
    if (layout_.by_pixel()) {
        grow(device_, commands, pixel_offsets, "the cubes' pixels", size.cells * 4, kept.cells * 4);
        grow(device_, commands, pixel_ranges, "the cubes' ranges of depth", size.cells * 4, kept.cells * 4);
        return;
    }
    grow(device_, commands, top_table, "the cubes' top table", size.cells * 8, kept.cells * 8);
    grow(device_, commands, node_table, "the cubes' nodes", size.occupied * 256, kept.occupied * 256);
    grow(device_, commands, voxel_table, "the cubes' voxels", size.nodes * 256, kept.nodes * 256);
}

void Cubes::trim(const TableSize& size) {
    const MemoryPart part(device_, "cubes");
    Commands commands(device_);  // of its own: the builder's hold the times of the build
    const auto to = [&](Buffer& buffer, uint64_t bytes) { shrink(device_, commands, buffer, bytes); };
    to(samples, size.samples * 8);
    to(sample_ids, size.samples * 4);
    to(patches, size.samples * 16);
    to(sample_attributes, size.samples * 8);
    to(pixel_offsets, size.cells * 4);
    to(pixel_ranges, size.cells * 4);
    to(top_table, size.cells * 8);
    to(node_table, size.occupied * 256);
    to(voxel_table, size.nodes * 256);
}

bool Cubes::tests_triangles() const {
    return sampling_ == Sampling::conservative ||
           std::any_of(bodies_.begin(), bodies_.end(), [](const CubeBody& body) { return body.bare; });
}

uint32_t Cubes::pyramid_levels() const {
    uint32_t largest = 16;
    for (const CubeBody& body : bodies_) largest = std::max(largest, round_resolution(body.resolution));
    return uint32_t(std::bit_width(largest - 1));
}

std::vector<LdcBody> Cubes::download_bodies(Commands& commands) const {
    return commands.download<LdcBody>(body_table, bodies_.size());
}

}  // namespace peelray
