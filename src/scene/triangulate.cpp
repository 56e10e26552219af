#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace peelray {

namespace {

/// Looks for an ear compare a corner with every inward corner; ten thousand corners of a comb take this many.
constexpr uint64_t most_comparisons = 100'000'000;

/// The polygon as it is seen along its normal, counter-clockwise.
std::vector<glm::dvec2> flatten_polygon(std::span<const glm::vec3> corners) {
    // Newell's normal: the areas of the three projections.
    glm::dvec3 normal(0);
    const glm::dvec3 origin = corners[0];
    for (size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[(i + 1) % corners.size()]) - origin);
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::vec3& corner : corners)
        flat.emplace_back(double(corner[u]) - origin[u], double(corner[v]) - origin[v]);
    return flat;
}

/// Twice the area, negative where the corners go clockwise.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is left of a polygon while ears are cut off.
class Rest {
  public:
    explicit Rest(std::vector<glm::dvec2> points) : points_(std::move(points)) {
        const auto count = static_cast<uint32_t>(points_.size());
        for (uint32_t i = 0; i < count; ++i) {
            next_.push_back((i + 1) % count);
            previous_.push_back((i + count - 1) % count);
        }
        for (uint32_t i = 0; i < count; ++i)
            if (area_at(i) < 0) inward_.push_back(i);
    }

    uint32_t next(uint32_t i) const { return next_[i]; }
    uint32_t previous(uint32_t i) const { return previous_[i]; }
    double area_at(uint32_t i) const { return area(points_[previous_[i]], points_[i], points_[next_[i]]); }
    uint64_t comparisons() const { return comparisons_; }

    /// Does the triangle of a corner and its neighbours lie inside? Only an inward corner can dent it; one that touches
    /// a corner of the triangle does not (a hole's two ways in run along each other).
    bool is_ear(uint32_t i) {
        const glm::dvec2 a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
        if (!(area(a, b, c) > 0)) return false;
        comparisons_ += inward_.size() + 1;
        return std::none_of(inward_.begin(), inward_.end(), [&](uint32_t k) {
            const glm::dvec2 p = points_[k];
            return p != a && p != b && p != c && area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
        });
    }

    void cut(uint32_t i) {
        const uint32_t before = previous_[i], after = next_[i];
        next_[before] = after;
        previous_[after] = before;
        std::erase_if(inward_, [&](uint32_t k) { return k == i || ((k == before || k == after) && area_at(k) >= 0); });
    }

  private:
    std::vector<glm::dvec2> points_;
    std::vector<uint32_t> next_, previous_, inward_;
    uint64_t comparisons_ = 0;
};

void add_fan(uint32_t first, uint32_t count, std::vector<glm::uvec3>& out) {
    for (uint32_t i = 1; i + 1 < count; ++i) out.emplace_back(first, (first + i) % count, (first + i + 1) % count);
}

}  // namespace

bool triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& out) {
    const auto count = static_cast<uint32_t>(corners.size());
    if (count == 3) out.emplace_back(0, 1, 2);
    if (count <= 3) return true;
    std::vector<glm::dvec2> flat = flatten_polygon(corners);
    if (count == 4) {
        uint32_t first = 0;
        for (uint32_t i = 0; i < 4; ++i)
            if (area(flat[(i + 3) % 4], flat[i], flat[(i + 1) % 4]) < 0) first = i;
        add_fan(first, count, out);
        return true;
    }
    bool is_fan = true;
    for (uint32_t i = 1; i + 1 < count && is_fan; ++i) is_fan = area(flat[0], flat[i], flat[i + 1]) >= 0;
    if (is_fan) {
        add_fan(0, count, out);
        return true;
    }
    Rest rest(std::move(flat));
    uint32_t at = 1, left = count, looked = 0;
    while (left > 2) {
        // Once no corner is an ear, what is left has no inside (or is too much work): any corner will do.
        if (looked < left && rest.comparisons() < most_comparisons && !rest.is_ear(at)) {
            at = rest.next(at);
            ++looked;
            continue;
        }
        out.emplace_back(rest.previous(at), at, rest.next(at));
        rest.cut(at);
        at = rest.next(at);
        --left;
        looked = 0;
    }
    return rest.comparisons() < most_comparisons;
}

}  // namespace peelray
