#include "assembly/grouping.h"

#include <algorithm>
#include <cmath>

#include "assembly/assembly.h"
#include "peelray/cube.h"

namespace peelray {
namespace {

/// Costs relative to each other: of a ray's start in a cube whose box it meets, of a look at one sample in the lists
/// that it meets near a surface, and of finding out which of two boxes it meets.
constexpr double kStart = 4, kSample = 2, kBoxes = 1;
/// The same for testing the few triangles of a bare body (CubeBody::bare).
constexpr double kBare = 1;
/// Share of the cost that a split must save.
constexpr double kGain = 0.1;
/// Share of all rays that both groups of a split must have: for a few rays no cube is worth its start.
constexpr double kLeastWeight = 0.02;
constexpr int kDeepest = 8;  // 256 groups at most
/// Parts that become bare bodies of their own before all else: every ray looks at their boxes.
constexpr size_t kMostBare = 6;

double half_area(const glm::vec3& lower, const glm::vec3& upper) {
    const glm::dvec3 s = glm::dvec3(upper) - glm::dvec3(lower);
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

/// What some parts have together.
class Extent {
  public:
    /// `weight`: the share of all rays that look for hits on this part.
    void add(const Part& part, double weight) {
        lower_ = glm::min(lower_, part.lower);
        upper_ = glm::max(upper_, part.upper);
        triangles_ += part.triangles;
        const double edge = mean_edge(part.triangles, part.area);
        inverse_edges_ += double(part.triangles) / edge;
        weight_ += weight;
        by_edge_ += weight / edge;
        by_edge2_ += weight / (edge * edge);
    }

    /// Of all rays that look for hits on its parts, in one cube. Near a part's surface a ray meets voxels with the
    /// triangles that touch them: (1 + h / e)² of edge length e at a voxel's edge h.
    double cost() const {
        if (is_bare()) return kBare * weight_;
        const glm::vec3 size = upper_ - lower_;
        const double longest = std::max({size.x, size.y, size.z});
        const double h = longest / double(serving_resolution(triangles_, longest, inverse_edges_));
        return kStart * weight_ + kSample * (weight_ + 2 * h * by_edge_ + h * h * by_edge2_);
    }
    /// Of one more ray that meets its box.
    double start() const { return is_bare() ? kBare : kStart; }
    double weight() const { return weight_; }
    double area() const { return half_area(lower_, upper_); }

  private:
    bool is_bare() const { return triangles_ <= PEELRAY_BARE_TRIANGLES; }

    glm::vec3 lower_{INFINITY}, upper_{-INFINITY};
    uint64_t triangles_ = 0;
    double inverse_edges_ = 0, weight_ = 0, by_edge_ = 0, by_edge2_ = 0;
};

/// Of all rays that look for hits on two sets of parts, beside what each set's rays cost in its own cubes: they find
/// out which boxes they meet, and start in the other's cube as well if they meet its box.
double cost_of_both(const Extent& all, const Extent& a, const Extent& b) {
    const double area = std::max(all.area(), 1e-60);
    return kBoxes * all.weight() + (a.weight() * b.start() * b.area() + b.weight() * a.start() * a.area()) / area;
}

class Grouping {
  public:
    /// Half of the rays go to parts by their size, half by their triangles: what is modelled finely gets looked at.
    explicit Grouping(const std::vector<Part>& parts) : parts_(parts) {
        double area = 1e-60, triangles = 1e-60;
        for (const Part& part : parts) {
            area += half_area(part.lower, part.upper);
            triangles += double(part.triangles);
        }
        for (const Part& part : parts)
            weights_.push_back(0.5 * half_area(part.lower, part.upper) / area +
                               0.5 * double(part.triangles) / triangles);
    }

    struct Result {
        double cost = 0;
        std::vector<std::vector<uint32_t>> groups;
    };

    /// The largest of the parts that can be bare, if enough rays look for hits on them.
    std::vector<uint32_t> bare() const {
        std::vector<uint32_t> found;
        for (uint32_t i = 0; i < parts_.size(); i++)
            if (parts_[i].triangles <= PEELRAY_BARE_TRIANGLES && weights_[i] >= kLeastWeight) found.push_back(i);
        std::stable_sort(found.begin(), found.end(), [&](uint32_t a, uint32_t b) { return weights_[a] > weights_[b]; });
        if (found.size() > kMostBare) found.resize(kMostBare);
        return found;
    }

    /// Splits as far as possible, then takes back the splits that do not pay: whether they do may show only after
    /// several (a square town has to be split along both of its sides).
    Result split(std::vector<uint32_t> group, int depth) const {
        const Extent all = extent_of(group);
        Result whole{all.cost(), {group}};
        std::vector<uint32_t> other;
        if (depth == kDeepest || !find_split(group, other)) return whole;
        const double both = cost_of_both(all, extent_of(group), extent_of(other));
        Result first = split(std::move(group), depth + 1), second = split(std::move(other), depth + 1);
        first.cost += second.cost + both;
        if (!(first.cost < (1 - kGain) * whole.cost)) return whole;
        for (auto& each : second.groups) first.groups.push_back(std::move(each));
        return first;
    }

  private:
    /// By size, or by place along an axis.
    double key(int order, uint32_t index) const {
        const glm::dvec3 lower = parts_[index].lower, upper = parts_[index].upper;
        if (order < 3) return lower[order] + upper[order];
        return -std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    }

    Extent extent_of(const std::vector<uint32_t>& group) const {
        Extent extent;
        for (uint32_t part : group) extent.add(parts_[part], weights_[part]);
        return extent;
    }

    /// The best split of the group in two; false: there is none.
    bool find_split(std::vector<uint32_t>& group, std::vector<uint32_t>& other) const {
        if (group.size() < 2) return false;
        double best = INFINITY;
        std::vector<uint32_t> first, second;
        for (int order = 0; order < 4; order++) {
            std::stable_sort(group.begin(), group.end(),
                             [&](uint32_t a, uint32_t b) { return key(order, a) < key(order, b); });
            std::vector<Extent> behind(group.size());
            Extent extent;
            for (size_t i = group.size(); i-- > 0;) {
                extent.add(parts_[group[i]], weights_[group[i]]);
                behind[i] = extent;
            }
            extent = {};
            for (size_t i = 1; i < group.size(); i++) {
                extent.add(parts_[group[i - 1]], weights_[group[i - 1]]);
                if (std::min(extent.weight(), behind[i].weight()) < kLeastWeight) continue;
                const double cost = extent.cost() + behind[i].cost() + cost_of_both(behind[0], extent, behind[i]);
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
    std::vector<double> weights_;
};

}  // namespace

std::vector<std::vector<uint32_t>> group_parts(const std::vector<Part>& parts) {
    if (parts.empty()) return {};
    const Grouping grouping(parts);
    const std::vector<uint32_t> bare = grouping.bare();
    std::vector<uint32_t> others;
    for (uint32_t i = 0; i < parts.size(); i++)
        if (std::find(bare.begin(), bare.end(), i) == bare.end()) others.push_back(i);
    std::vector<std::vector<uint32_t>> groups;
    if (!others.empty()) groups = grouping.split(std::move(others), 0).groups;
    for (const uint32_t i : bare) groups.push_back({i});
    for (auto& group : groups) std::sort(group.begin(), group.end());
    std::sort(groups.begin(), groups.end());
    return groups;
}

}  // namespace peelray
