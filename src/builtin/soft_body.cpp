#include "builtin/soft_body.h"

#include <limits>

namespace peelray {

namespace {

float square(float x) {
    return x * x;
}

/// Quilez' round cone, from `a` along `axis`.
float round_cone(const glm::vec3& from_a, const glm::vec3& axis, float ra, float rb) {
    const float length2 = glm::dot(axis, axis), slope = ra - rb;
    if (length2 <= slope * slope) return std::min(glm::length(from_a) - ra, glm::length(from_a - axis) - rb);
    const float side2 = length2 - slope * slope, y = glm::dot(from_a, axis), z = y - length2;
    const glm::vec3 across = from_a * length2 - axis * y;
    const float x2 = glm::dot(across, across), y2 = y * y * length2, z2 = z * z * length2;
    const float k = std::copysign(slope * slope * x2, slope);
    if (std::copysign(side2 * z2, z) > k) return std::sqrt(x2 + z2) / length2 - rb;
    if (std::copysign(side2 * y2, y) < k) return std::sqrt(x2 + y2) / length2 - ra;
    return (std::sqrt(x2 * side2 / length2) + y * slope) / length2 - ra;
}

}  // namespace

float Piece::at(const glm::vec3& p) const {
    const glm::vec3 from_a = (p - a) * thin;
    const float most = std::max({thin.x, thin.y, thin.z});
    if (is_ring) {
        const float along = glm::dot(from_a, b),
                    across = std::sqrt(std::max(glm::dot(from_a, from_a) - along * along, 0.f));
        return (std::sqrt(square(across - ra) + along * along) - rb) / most;
    }
    return round_cone(from_a, (b - a) * thin, ra, rb) / most;
}

float SoftGroup::at(const glm::vec3& p) const {
    float distance = std::numeric_limits<float>::infinity();
    for (const Piece& piece : pieces) distance = soft_min(distance, piece.at(p), piece.blend);
    for (const Cut& cut : cuts) distance = soft_max(distance, glm::dot(cut.outwards, p) - cut.offset, cut.blend);
    return distance;
}

void SoftGroup::measure() {
    lower = glm::vec3(std::numeric_limits<float>::infinity());
    upper = -lower;
    float blend = 0;
    for (const Piece& piece : pieces) {
        blend = std::max(blend, piece.blend);
        const float radius = piece.is_ring ? piece.ra + piece.rb : std::max(piece.ra, piece.rb);
        const glm::vec3 end = piece.is_ring ? piece.a : piece.b;
        lower = glm::min(lower, glm::min(piece.a, end) - radius);
        upper = glm::max(upper, glm::max(piece.a, end) + radius);
        thinnest = std::max({thinnest, piece.thin.x, piece.thin.y, piece.thin.z});
    }
    // A soft union bulges by at most a quarter of its blend per piece that takes part; two or three do.
    lower -= blend;
    upper += blend;
}

float SoftGroup::at_least(const glm::vec3& p) const {
    return glm::length(p - glm::clamp(p, lower, upper)) / thinnest;
}

float SoftBody::at(const glm::vec3& p) const {
    float distance = std::numeric_limits<float>::infinity();
    for (const SoftGroup& group : groups)
        if (group.at_least(p) < distance + group.seam) distance = soft_min(distance, group.at(p), group.seam);
    return distance;
}

float SoftBody::at(uint32_t part, const glm::vec3& p) const {
    float distance = std::numeric_limits<float>::infinity();
    for (const SoftGroup& group : groups)
        if (group.part == part && group.at_least(p) < distance + group.seam)
            distance = soft_min(distance, group.at(p), group.seam);
    return distance;
}

uint32_t SoftBody::part_at(const glm::vec3& p) const {
    uint32_t nearest = 0;
    float least = std::numeric_limits<float>::infinity();
    for (const SoftGroup& group : groups) {
        if (group.at_least(p) >= least) continue;
        const float distance = group.at(p);
        if (distance < least) least = distance, nearest = group.part;
    }
    return nearest;
}

float SoftBody::margin(uint32_t part, const glm::vec3& p) const {
    float own = std::numeric_limits<float>::infinity(), others = own;
    for (const SoftGroup& group : groups) {
        float& least = group.part == part ? own : others;
        if (group.at_least(p) < least) least = std::min(least, group.at(p));
    }
    return own - others;
}

}  // namespace peelray
