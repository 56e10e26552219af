// Is an answer right? It is when the ray, or one beside it, has it in double precision.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/bvh.h"

namespace peelray {
namespace {

constexpr double allowed_offset = 2e-6;      // of the diagonal
constexpr double allowed_difference = 1e-5;  // of the diagonal, across the surface

glm::dvec3 unit_normal(const std::array<glm::vec3, 3>& c) {
    return glm::normalize(glm::cross(glm::dvec3(c[1]) - glm::dvec3(c[0]), glm::dvec3(c[2]) - glm::dvec3(c[0])));
}

/// An offset of a ray: across it (two components) and along it, in world units.
using Offset = glm::dvec3;

/// What lies around a ray, seen along it: which offsets can change its answer at all, and which to try.
class Neighbourhood {
  public:
    Neighbourhood(const Bvh& bvh, const OracleRay& ray)
        : triangles_(bvh.triangles), alpha_(bvh.alpha), ray_(ray), radius_(allowed_offset * triangles_.diagonal) {
        const double length = glm::length(ray.direction / max_component(ray)) * max_component(ray);
        along_ = ray.direction / length;
        const glm::dvec3 helper = std::abs(along_.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        x_ = glm::normalize(glm::cross(along_, helper));
        y_ = glm::cross(along_, x_);
        // A reach of the full radius at both ends of the ray as well.
        const double stretch = radius_ / length;
        for (const uint32_t i : bvh.along({ray.origin, ray.tmin - stretch, ray.direction, ray.tmax + stretch})) look(i);
    }

    bool surface_near() const { return !near_.empty(); }
    /// Of a triangle, of one of its holes, or of the ray itself.
    bool edge_near() const { return !edges_.empty() || end_near_ || hole_near_; }

    /// Could some triangle near the ray be hit at `t`? An offset moves the distance to its plane by no more than
    /// itself.
    bool surface_near(double t) const {
        const glm::dvec3 point = ray_.origin + t * ray_.direction;
        return std::any_of(near_.begin(), near_.end(), [&](uint32_t i) {
            const auto& c = triangles_.corners[i];
            return std::abs(glm::dot(unit_normal(c), point - glm::dvec3(c[0]))) <=
                   allowed_difference * triangles_.diagonal + 2 * radius_;
        });
    }

    /// Is there an offset ray for which `right` holds? First a coarse disc, then both sides of every edge near by
    /// (nothing else finds a sliver), then a fine disc.
    template <typename Right>
    bool any(const Right& right) const {
        const auto holds = [&](const Offset& offset) { return right(moved(offset)); };
        const std::vector<Offset> coarse = coarse_offsets(), fine = fine_offsets();
        return std::any_of(coarse.begin(), coarse.end(), holds) || std::any_of(edges_.begin(), edges_.end(), holds) ||
               std::any_of(fine.begin(), fine.end(), holds);
    }

    /// Is there one among the offset rays that are aimed at the surface where the ray is at `t`? Rays that meet a
    /// triangle almost edge-on hit it through a window far narrower than the allowed offset: only aiming finds it.
    template <typename Right>
    bool any_aimed(double t, const Right& right) const {
        const glm::dvec3 point = ray_.origin + t * ray_.direction;
        for (const uint32_t i : near_) {
            const auto& c = triangles_.corners[i];
            const std::array<glm::dvec3, 3> p = {glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])};
            const glm::dvec3 nearest = nearest_point(point, p), middle = (p[0] + p[1] + p[2]) / 3.0;
            for (const double inwards : {0.0, 1e-6, 1e-4, 1e-2}) {
                const glm::dvec3 move = nearest + inwards * (middle - nearest) - point;
                const Offset offset(glm::dot(move, x_), glm::dot(move, y_), 0);
                if (glm::length(offset) <= radius_ && right(moved(offset))) return true;
            }
        }
        return false;
    }

  private:
    /// The point of a triangle nearest to `q`: inside it, or on one of its edges.
    static glm::dvec3 nearest_point(const glm::dvec3& q, const std::array<glm::dvec3, 3>& p) {
        const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        bool inside = true;
        glm::dvec3 best = p[0];
        double distance = std::numeric_limits<double>::infinity();
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec3 a = p[i], edge = p[(i + 1) % 3] - a;
            inside = inside && glm::dot(glm::cross(edge, q - a), normal) >= 0;
            const double squared = glm::dot(edge, edge);
            const glm::dvec3 on_edge =
                a + edge * (squared > 0 ? std::clamp(glm::dot(q - a, edge) / squared, 0.0, 1.0) : 0.0);
            if (const double d = glm::length(q - on_edge); d < distance) {
                distance = d;
                best = on_edge;
            }
        }
        return inside ? q - normal * glm::dot(q - p[0], normal) : best;
    }

    /// The direction may be as short as 10⁻³⁰⁰, whose square is 0.
    static double max_component(const OracleRay& ray) {
        const glm::dvec3 size = glm::abs(ray.direction);
        return std::max({size.x, size.y, size.z});
    }

    OracleRay moved(const Offset& o) const {
        return {ray_.origin + o.x * x_ + o.y * y_ + o.z * along_, ray_.tmin, ray_.direction, ray_.tmax};
    }

    glm::dvec2 across(const glm::vec3& vertex) const {
        const glm::dvec3 p = glm::dvec3(vertex) - ray_.origin;
        return {glm::dot(p, x_), glm::dot(p, y_)};
    }

    void look(uint32_t index) {
        const auto& c = triangles_.corners[index];
        const std::array<glm::dvec2, 3> p = {across(c[0]), across(c[1]), across(c[2])};
        bool near = false;
        double signs[3];
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec2 a = p[i], edge = p[(i + 1) % 3] - a;
            signs[i] = edge.x * -a.y + edge.y * a.x;
            const double squared = glm::dot(edge, edge);
            const glm::dvec2 q = a + edge * (squared > 0 ? std::clamp(-glm::dot(a, edge) / squared, 0.0, 1.0) : 0.0);
            if (glm::length(q) > radius_) continue;
            near = true;
            const glm::dvec2 middle = (p[0] + p[1] + p[2]) / 3.0 - q;
            const glm::dvec2 normal = squared > 0 ? glm::dvec2(-edge.y, edge.x) / std::sqrt(squared) : glm::dvec2(1, 0);
            add_edge(q, middle, normal);
        }
        near |= (signs[0] >= 0 && signs[1] >= 0 && signs[2] >= 0) || (signs[0] <= 0 && signs[1] <= 0 && signs[2] <= 0);
        if (!near) return;
        near_.push_back(index);
        hole_near_ |= alpha_.is_masked(triangles_.ids[index]);
        const glm::dvec3 normal = unit_normal(c);
        for (const double t : {ray_.tmin, ray_.tmax}) {
            const glm::dvec3 end = ray_.origin + t * ray_.direction;
            end_near_ |= std::abs(glm::dot(normal, end - glm::dvec3(c[0]))) <= 2 * radius_;
        }
    }

    /// Beside an edge's nearest point `q`: hair's breadths and wider steps to both sides, and towards the triangle's
    /// middle.
    void add_edge(const glm::dvec2& q, const glm::dvec2& middle, const glm::dvec2& normal) {
        constexpr size_t most = 1024;
        const double step[] = {1e-4, 1e-2, 0.2};
        for (const double s : step)
            for (const glm::dvec2 point : {q + s * radius_ * normal, q - s * radius_ * normal})
                if (glm::length(point) <= radius_ && edges_.size() < most) edges_.emplace_back(point, 0);
        for (const double s : {1e-3, 0.1, 1.0})
            if (const glm::dvec2 point = q + s * middle; glm::length(point) <= radius_ && edges_.size() < most)
                edges_.emplace_back(point, 0);
        if (edges_.size() < most) edges_.emplace_back(q, 0);
    }

    std::vector<Offset> coarse_offsets() const {
        std::vector<Offset> offsets;
        for (const double share : {0.01, 0.1, 0.3, 0.6, 0.999}) {
            const double r = share * radius_;
            for (int i = 0; i < 16; ++i) {
                const double angle = i * std::numbers::pi / 8;
                offsets.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
            }
            offsets.emplace_back(0, 0, r);
            offsets.emplace_back(0, 0, -r);
        }
        return offsets;
    }

    /// Points spread evenly by the golden angle, in three slices along the ray that stay inside the ball.
    std::vector<Offset> fine_offsets() const {
        std::vector<Offset> offsets;
        constexpr int count = 256;
        const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
        for (const double slice : {0.0, -0.5, 0.5}) {
            const double widest = 0.999 * std::sqrt(1 - slice * slice) * radius_;
            for (int i = 0; i < count; ++i) {
                const double r = widest * std::sqrt((i + 0.5) / count);
                offsets.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), slice * radius_);
            }
        }
        return offsets;
    }

    const TriangleSet& triangles_;
    const AlphaTest& alpha_;
    const OracleRay& ray_;
    double radius_;
    glm::dvec3 along_, x_, y_;
    std::vector<uint32_t> near_;
    std::vector<Offset> edges_;
    bool end_near_ = false, hole_near_ = false;
};

/// Do the oracle's answer and a claimed t mean the same?
bool agrees(const Bvh& bvh, const OracleRay& ray, const Bvh::Found& found, double t) {
    const bool miss = std::isinf(t);
    if (miss || !found.hit.hit()) return miss && !found.hit.hit();
    const double across = std::abs(glm::dot(unit_normal(bvh.triangles.corners[found.index]), ray.direction));
    return std::abs(t - found.hit.t) * across <= allowed_difference * bvh.triangles.diagonal;
}

}  // namespace

Verdict Oracle::check(const OracleRay& ray, double t, uint32_t triangle) const {
    const bool miss = t == std::numeric_limits<double>::infinity();
    // A claim that contradicts itself: NaN, a miss with a triangle, a hit without one.
    if (!(miss || std::isfinite(t)) || miss != (triangle == ~0u)) return Verdict::wrong;
    const std::vector<uint32_t>& ids = impl_->triangles.ids;
    if (!miss && !std::binary_search(ids.begin(), ids.end(), triangle)) return Verdict::wrong;
    if (agrees(*impl_, ray, impl_->nearest(ray, ~0u), t)) return Verdict::same;
    if (!PreparedRay::make(ray, impl_->triangles)) return Verdict::wrong;  // misses by definition, wherever it starts
    const Neighbourhood around(*impl_, ray);
    if (miss ? !around.edge_near() : !around.surface_near(t)) return Verdict::wrong;
    const auto right = [&](const OracleRay& moved) { return agrees(*impl_, moved, impl_->nearest(moved, ~0u), t); };
    const bool found = (!miss && around.any_aimed(t, right)) || around.any(right);
    return found ? Verdict::within_offset : Verdict::wrong;
}

Verdict Oracle::check_any(const OracleRay& ray, bool occluded) const {
    if (impl_->occluded(ray) == occluded) return Verdict::same;
    if (!PreparedRay::make(ray, impl_->triangles)) return Verdict::wrong;
    const Neighbourhood around(*impl_, ray);
    if (occluded ? !around.surface_near() : !around.edge_near()) return Verdict::wrong;
    const bool found = around.any([&](const OracleRay& moved) { return impl_->occluded(moved) == occluded; });
    return found ? Verdict::within_offset : Verdict::wrong;
}

}  // namespace peelray
