#include "builtin/skin_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace peelray {

namespace {

float distance_to(const Bone& bone, const glm::vec3& p) {
    const glm::vec3 along = bone.b - bone.a;
    const float length2 = glm::dot(along, along);
    const float share = length2 > 0 ? std::clamp(glm::dot(p - bone.a, along) / length2, 0.f, 1.f) : 0.f;
    return glm::distance(p, bone.a + share * along) - bone.radius;
}

size_t nearest(std::span<const Bone> bones, const glm::vec3& p) {
    size_t best = 0;
    for (size_t i = 1; i < bones.size(); ++i)
        if (distance_to(bones[i], p) < distance_to(bones[best], p)) best = i;
    return bones[best].joint;
}

/// The four largest of a row of weights, rescaled.
JointWeights strongest(std::span<const float> row) {
    std::array<uint16_t, 4> order{};
    std::vector<uint16_t> joints(row.size());
    std::iota(joints.begin(), joints.end(), uint16_t(0));
    std::partial_sort_copy(joints.begin(), joints.end(), order.begin(), order.end(),
                           [&](uint16_t a, uint16_t b) { return row[a] > row[b]; });
    JointWeights out;
    float sum = 0;
    for (const uint16_t joint : order) sum += row[joint];
    for (size_t i = 0; i < order.size(); ++i) {
        if (row[order[i]] < 1e-4f * sum) continue;
        out.joints[i] = order[i];
        out.weights[i] = row[order[i]];
    }
    sum = std::accumulate(out.weights.begin(), out.weights.end(), 0.f);
    for (float& weight : out.weights) weight /= sum;
    return out;
}

}  // namespace

std::vector<JointWeights> soft_weights(const ClosedMesh& mesh, std::span<const Bone> bones, size_t joints,
                                       const std::function<float(const glm::vec3&)>& reach) {
    const size_t count = mesh.positions.size();
    std::vector<float> now(count * joints), next;
    std::vector<int> steps(count);
    for (uint32_t i = 0; i < count; ++i) {
        now[i * joints + nearest(bones, mesh.positions[i])] = 1;
        float edge = 0;
        mesh.for_each_around(i, [&](uint32_t h) { edge += mesh.length(h); });
        edge /= float(mesh.valence(i));
        // A step over a hexagon of neighbours spreads by half its edge squared.
        steps[i] = int(std::round(2 * std::pow(reach(mesh.positions[i]) / edge, 2.f)));
    }
    const int most = *std::max_element(steps.begin(), steps.end());
    for (int step = 0; step < most; ++step) {
        next = now;
        for (uint32_t i = 0; i < count; ++i) {
            if (step >= steps[i]) continue;
            float* row = &next[i * joints];
            std::fill(row, row + joints, 0.f);
            const float share = 1 / float(mesh.valence(i));
            mesh.for_each_around(i, [&](uint32_t h) {
                const float* from = &now[mesh.to(h) * joints];
                for (size_t k = 0; k < joints; ++k) row[k] += share * from[k];
            });
        }
        now.swap(next);
    }
    std::vector<JointWeights> out;
    for (size_t i = 0; i < count; ++i) out.push_back(strongest({&now[i * joints], joints}));
    return out;
}

}  // namespace peelray
