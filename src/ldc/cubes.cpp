#include "ldc/cubes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "ldc/ldc_grid.h"
#include "settings/limits.h"

namespace peelray {

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
    : table(device, std::move(bodies), "cubes"), device_(device), sampling_(sampling), layout_(layout) {
    check_limits(kBlockLimits, setting::block, layout.block);
    for ([[maybe_unused]] const CubeBody& body : table.bodies())
        assert(!body.bare || (body.triangles >= 1 && body.triangles <= PEELRAY_BARE_TRIANGLES && !layout.by_pixel() &&
                              layout.builder == BuilderKind::compute));
}

void Cubes::reserve(Commands& commands, const TableSize& size, const TableSize& kept) {
    // Entries are 30-bit numbers of nodes and samples.
    const MemoryPart part(device_, "cubes");
    if (size.cells >= 1ull << 32)
        throw NoRoom(fmt::format("{} pixels or cells are more than the cubes' tables can number", size.cells),
                     device_.room_advice());
    if (size.nodes >= 1u << 25 || size.samples >= 1u << 30)
        throw NoRoom(
            fmt::format("{} nodes and {} samples are more than the cubes' tables can number", size.nodes, size.samples),
            device_.room_advice());
    if (has_patches()) {
        const uint64_t triangles = uint64_t(bodies().back().first_triangle) + bodies().back().triangles;
        if (triangles > most_exact_triangles(device_))
            throw NoRoom(fmt::format("{} triangles are more than the device '{}' holds for exact hits by voxel ({})",
                                     triangles, device_.info().name, most_exact_triangles(device_)),
                         fmt::format("use {} auto", setting::hit));
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
    const auto to = [&](Buffer& buffer, uint64_t bytes) {
        try {
            shrink(device_, commands, buffer, bytes);
        } catch (const NoRoom&) {
            // A moment long both must live: then the larger one stays.
        }
    };
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
           std::any_of(bodies().begin(), bodies().end(), [](const CubeBody& body) { return body.bare; });
}

uint32_t Cubes::pyramid_levels() const {
    uint32_t largest = 16;
    for (const CubeBody& body : bodies()) largest = std::max(largest, round_resolution(body.resolution));
    return uint32_t(std::bit_width(largest - 1));
}

}  // namespace peelray
