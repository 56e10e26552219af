#include "ldc/body_table.h"

#include <bit>
#include <cassert>

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

BodyTable::BodyTable(Device& device, std::vector<CubeBody> bodies, const char* part) : bodies_(std::move(bodies)) {
    assert(!bodies_.empty());
    const MemoryPart memory(device, part);
    Commands commands(device);
    std::vector<LdcBody> table;
    std::vector<glm::uvec3> lowest, highest;
    for (const CubeBody& body : bodies_) {
        const uint32_t resolution = round_resolution(body.resolution) | (body.bare ? LDC_BARE : 0);
        table.push_back({{}, body.first_triangle, body.triangles, resolution, 0, {}, body.tolerance});
        lowest.push_back(ordered_bits(body.lower));
        highest.push_back(ordered_bits(body.upper));
    }
    entries = Buffer(device, "the table of bodies", table.size() * sizeof(LdcBody));
    lower = Buffer(device, "lower bounds of bodies", lowest.size() * sizeof(glm::uvec3));
    upper = Buffer(device, "upper bounds of bodies", highest.size() * sizeof(glm::uvec3));
    commands.upload(entries, std::span<const LdcBody>(table));
    commands.upload(lower, std::span<const glm::uvec3>(lowest));
    commands.upload(upper, std::span<const glm::uvec3>(highest));
}

void BodyTable::record_emptying(Commands& commands, uint32_t first, uint32_t end) const {
    const uint64_t count = end - first;
    if (count == 0) return;
    commands.fill(lower, ~0u, first * 12ull, count * 12);
    commands.fill(upper, 0, first * 12ull, count * 12);
}

std::vector<LdcBody> BodyTable::download(Commands& commands) const {
    return commands.download<LdcBody>(entries, bodies_.size());
}

}  // namespace peelray
