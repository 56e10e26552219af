// The sphere in cells, for histograms of directions and what a density lets expect in them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace peelray::test {

constexpr double pi = 3.14159265358979323846;

/// Rings around an axis, each cut into sectors. Rings are equal steps of u = t / (t + width²), t = tan²(angle / 2):
/// with width 1 steps of the cosine; with less, half of the rings are within tan(angle / 2) = width, to resolve narrow
/// lobes.
class SphereCells {
  public:
    using Density = std::function<double(const glm::dvec3&)>;

    /// `axis`: unit. `half`: there are rings in front of the axis only, and the last ends at right angles to it.
    SphereCells(const glm::dvec3& axis, double width, bool half = false, int rings = 16, int sectors = 20);

    size_t count() const { return size_t(rings_ * sectors_); }
    /// The cell of a direction of any length.
    size_t cell(const glm::dvec3& direction) const;
    /// Integral over each cell's solid angle, to about 1e-6 for densities that are bounded and in pieces smooth.
    std::vector<double> integrate(const Density& density) const;

  private:
    double gauss(const Density& density, const glm::dvec2& low, const glm::dvec2& high) const;
    double refined(const Density& density, const glm::dvec2& low, const glm::dvec2& high, double coarse,
                   int depth) const;

    glm::dvec3 x_, y_, axis_;
    double width2_, most_;  ///< of u
    int rings_, sectors_;
};

}  // namespace peelray::test
