#include "scene/grouping.h"

#include <algorithm>
#include <cmath>

#include "scene/assembly.h"

namespace peelray {
namespace {

/// Cost of a ray's start in a cube, and of a look at one sample in the lists that it meets near a surface, relative to each
/// other.
constexpr double kStart = 4, kSample = 2;
/// Share of the cost that a split must save.
constexpr double kGain = 0.05;
constexpr int kDeepest = 8;  // 256 groups at most

/// What some parts have together.
class Extent {
  public:
    void add(const Part& part) {
        lower_ = glm::min(lower_, part.lower);
        upper_ = glm::max(upper_, part.upper);
        triangles_ += part.triangles;
        const double share = half_area(part.lower, part.upper);
        const double edge = std::sqrt(std::max(part.area, 1e-60) / double(std::max<uint64_t>(part.triangles, 1)));
        shares_ += share;
        by_edge_ += share / edge;
        by_edge2_ += share / (edge * edge);
    }

    /// Of a random ray, times a constant. Its chance to meet a box is as the box's surface. Near a part's surface it meets
    /// voxels with the triangles that touch them: (1 + h / e)² of edge length e at a voxel's edge h.
    double cost() const {
        const glm::vec3 size = upper_ - lower_;
        const double h = std::max({size.x, size.y, size.z}) / double(serving_resolution(triangles_));
        return kStart * half_area(lower_, upper_) + kSample * (shares_ + 2 * h * by_edge_ + h * h * by_edge2_);
    }

  private:
    static double half_area(const glm::vec3& lower, const glm::vec3& upper) {
        const glm::dvec3 s = glm::dvec3(upper) - glm::dvec3(lower);
        return s.x * s.y + s.y * s.z + s.z * s.x;
    }

    glm::vec3 lower_{INFINITY}, upper_{-INFINITY};
    uint64_t triangles_ = 0;
    double shares_ = 0, by_edge_ = 0, by_edge2_ = 0;
};

class Grouping {
  public:
    explicit Grouping(const std::vector<Part>& parts) : parts_(parts) {}

    void split(std::vector<uint32_t> group, int depth) {
        std::vector<uint32_t> other;
        if (depth < kDeepest && find_split(group, other)) {
            split(std::move(group), depth + 1);
            split(std::move(other), depth + 1);
            return;
        }
        std::sort(group.begin(), group.end());
        groups_.push_back(std::move(group));
    }

    std::vector<std::vector<uint32_t>> take() {
        std::sort(groups_.begin(), groups_.end());
        return std::move(groups_);
    }

  private:
    /// By size, or by place along an axis.
    double key(int order, uint32_t index) const {
        const glm::dvec3 lower = parts_[index].lower, upper = parts_[index].upper;
        if (order < 3) return lower[order] + upper[order];
        return -std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    }

    /// The best of all splits of the group in two; false: none pays.
    bool find_split(std::vector<uint32_t>& group, std::vector<uint32_t>& other) const {
        if (group.size() < 2) return false;
        Extent all;
        for (uint32_t part : group) all.add(parts_[part]);
        double best = all.cost() * (1 - kGain);
        std::vector<uint32_t> first, second;
        for (int order = 0; order < 4; order++) {
            std::stable_sort(group.begin(), group.end(),
                             [&](uint32_t a, uint32_t b) { return key(order, a) < key(order, b); });
            std::vector<double> behind(group.size());
            Extent extent;
            for (size_t i = group.size(); i-- > 0;) {
                extent.add(parts_[group[i]]);
                behind[i] = extent.cost();
            }
            extent = {};
            for (size_t i = 1; i < group.size(); i++) {
                extent.add(parts_[group[i - 1]]);
                const double cost = extent.cost() + behind[i];
                if (!(cost < best)) continue;
                best = cost;
                first.assign(group.begin(), group.begin() + ptrdiff_t(i));
                second.assign(group.begin() + ptrdiff_t(i), group.end());
            }
        }
        if (first.empty()) return false;
        group = std::move(first);
        other = std::move(second);
        return true;
    }

    const std::vector<Part>& parts_;
    std::vector<std::vector<uint32_t>> groups_;
};

}  // namespace

std::vector<std::vector<uint32_t>> group_parts(const std::vector<Part>& parts) {
    Grouping grouping(parts);
    std::vector<uint32_t> all(parts.size());
    for (uint32_t i = 0; i < all.size(); i++) all[i] = i;
    if (!all.empty()) grouping.split(std::move(all), 0);
    return grouping.take();
}

}  // namespace peelray
