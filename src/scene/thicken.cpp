#include "scene/thicken.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace peelray {
namespace {

// An icosahedron with smooth normals: at a few pixels it looks round, at twenty triangles.
constexpr float golden = 1.618034f;
constexpr std::array<std::array<float, 3>, 12> ball_corners = {{{-1, golden, 0},
                                                                {1, golden, 0},
                                                                {-1, -golden, 0},
                                                                {1, -golden, 0},
                                                                {0, -1, golden},
                                                                {0, 1, golden},
                                                                {0, -1, -golden},
                                                                {0, 1, -golden},
                                                                {golden, 0, -1},
                                                                {golden, 0, 1},
                                                                {-golden, 0, -1},
                                                                {-golden, 0, 1}}};
constexpr std::array<std::array<uint32_t, 3>, 20> ball_triangles = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
constexpr uint32_t tube_sides = 6;

class Thickener {
  public:
    Thickener(const Primitive& from, float radius) : from_(from), radius_(radius) {}

    void add_ball(uint32_t point) {
        const auto first = static_cast<uint32_t>(sources_.size());
        for (const auto& [x, y, z] : ball_corners) add_vertex(point, glm::normalize(glm::vec3(x, y, z)));
        for (const auto& [a, b, c] : ball_triangles) triangles_.emplace_back(first + a, first + b, first + c);
    }

    void add_tube(uint32_t a, uint32_t b) {
        const glm::dvec3 way = glm::dvec3(from_.positions[b]) - glm::dvec3(from_.positions[a]);
        const double length = glm::length(way);
        if (!(length > 0) || !std::isfinite(length)) return;
        const glm::dvec3 along = way / length;
        // The axis that is farthest from the line makes the frame around it.
        const glm::dvec3 size = glm::abs(along);
        const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                                : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                     : glm::dvec3(0, 0, 1);
        const glm::dvec3 u = glm::normalize(glm::cross(along, axis)), v = glm::cross(along, u);
        const auto first = static_cast<uint32_t>(sources_.size());
        for (const uint32_t end : {a, b})
            for (uint32_t k = 0; k < tube_sides; ++k) {
                const double angle = 6.283185307179586 * k / tube_sides;
                add_vertex(end, glm::vec3(std::cos(angle) * u + std::sin(angle) * v));
            }
        for (uint32_t k = 0; k < tube_sides; ++k) {
            const uint32_t next = (k + 1) % tube_sides;
            triangles_.emplace_back(first + k, first + next, first + tube_sides + next);
            triangles_.emplace_back(first + k, first + tube_sides + next, first + tube_sides + k);
        }
    }

    /// The primitive's vertices exchanged for those that were added.
    void put_into(Primitive& out) {
        const auto gather = [&](auto& values) {
            auto picked = values;
            picked.clear();
            if (!values.empty())
                for (const uint32_t source : sources_) picked.push_back(values[source]);
            values = std::move(picked);
        };
        gather(out.positions);
        for (size_t i = 0; i < out.positions.size(); ++i) out.positions[i] += radius_ * normals_[i];
        out.normals = std::move(normals_);
        out.tangents.clear();
        gather(out.uvs);
        for (std::vector<glm::vec2>& set : out.more_uvs) gather(set);
        gather(out.colors);
        gather(out.joints);
        for (MorphTarget& target : out.targets) {
            gather(target.positions);
            target.tangents.clear();
            target.normals.clear();  // what stands around a point does not turn with it
        }
        out.triangles = std::move(triangles_);
        out.flat = false;
    }

  private:
    void add_vertex(uint32_t source, const glm::vec3& outwards) {
        sources_.push_back(source);
        normals_.push_back(outwards);
    }

    const Primitive& from_;
    const float radius_;
    std::vector<uint32_t> sources_;  ///< the primitive's vertex that each belongs to
    std::vector<glm::vec3> normals_;
    std::vector<glm::uvec3> triangles_;
};

}  // namespace

uint64_t thickened_triangles(size_t corners, LineMode mode) {
    return corners * ball_triangles.size() + (mode == LineMode::points ? 0 : corners * tube_sides * 2);
}

void thicken(Primitive& primitive, std::span<const uint32_t> corners, LineMode mode, float radius) {
    Thickener made(primitive, radius);
    if (mode == LineMode::lines) corners = corners.first(corners.size() / 2 * 2);
    std::vector<bool> has_ball(primitive.positions.size());
    for (const uint32_t corner : corners) {
        if (!has_ball[corner]) made.add_ball(corner);
        has_ball[corner] = true;
    }
    const size_t step = mode == LineMode::lines ? 2 : 1;
    if (mode != LineMode::points)
        for (size_t i = 0; i + 1 < corners.size(); i += step) made.add_tube(corners[i], corners[i + 1]);
    if (mode == LineMode::loop && corners.size() > 2) made.add_tube(corners.back(), corners.front());
    made.put_into(primitive);
}

}  // namespace peelray
