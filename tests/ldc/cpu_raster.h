// Which triangle belongs to which voxel, in double precision on the CPU: by clipping, not by the shaders' edge
// functions.
#pragma once

#include <cstdint>
#include <span>

#include "../gpu/exact_clip.h"
#include "ldc/cubes.h"

namespace peelray::test {

/// A triangle in a voxel, as one number that sorts: voxel index, triangle · 4 + axis.
inline uint64_t pair_of(const CubeGrid& grid, const glm::uvec3& voxel, uint32_t id) {
    return uint64_t((voxel.z * grid.dims.y + voxel.y) * grid.dims.x + voxel.x) << 32 | id;
}

/// Graphics hardware rounds corners to 1/256 pixel, twice at most.
constexpr double kSnap = 1.0 / 128;

/// The plane of a triangle and where it lies, seen along one axis: corners (u, v, w) in voxels.
struct SeenTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec2 slope;
    double plane(const glm::dvec2& p) const { return corners[0].z + glm::dot(slope, p - glm::dvec2(corners[0])); }
};

/// What a correct cube must hold and may hold.
struct Expected {
    std::vector<uint64_t> must, may;  ///< sorted, without repetition
    uint32_t degenerate = 0;
};

class CpuRaster {
  public:
    CpuRaster(const CubeGrid& grid, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
        : grid_(grid), positions_(positions), triangles_(triangles) {}

    /// Normal, not normalised. Needles: from edges rounded as any float program rounds them, for the direction of a
    /// normal is ill-conditioned there, and which LDI takes the triangle with which slopes is a matter of convention,
    /// not of truth.
    glm::dvec3 normal(uint32_t triangle) const {
        const glm::uvec3& t = triangles_[triangle];
        const glm::vec3 e = (positions_[t.y] - positions_[t.x]) * grid_.inv_voxel,
                        f = (positions_[t.z] - positions_[t.x]) * grid_.inv_voxel;
        return glm::cross(glm::dvec3(e), glm::dvec3(f));
    }
    SeenTriangle seen(uint32_t triangle, uint32_t axis) const {
        SeenTriangle s;
        for (int k = 0; k < 3; k++)
            s.corners[size_t(k)] = permuted(
                (glm::dvec3(positions_[triangles_[triangle][k]]) - glm::dvec3(grid_.origin)) / double(grid_.voxel),
                axis);
        const glm::dvec3 n = permuted(normal(triangle), axis);
        s.slope = {-n.x / n.z, -n.y / n.z};
        return s;
    }

    /// Conservative. Must: the clipped triangle touches the (closed) voxel. May: the pixel's square is within 2·10⁻³
    /// voxels of the triangle's inside by every edge and by its bounding rectangle, the voxel within 3·10⁻³ of the
    /// depth range that the triangle's plane has over the pixel's square, cut to the triangle's own depth range, and
    /// seen along u and v the voxel within 4·10⁻³ of its inside by every edge.
    /// Centre. Must: the pixel's centre is inside by more than 10⁻³. May: it is outside by at most 2·10⁻³ by every edge
    /// line (at the tip of a needle that is farther as the crow flies), in a pixel that the bounding rectangle touches.
    /// Depth: the plane over the footprint of half-width 0.7, with 3·10⁻³ more. Triangles whose component is 0.8 of the
    /// largest: also there.
    Expected expect(Sampling sampling) const {
        Expected result;
        for (uint32_t i = 0; i < triangles_.size(); i++) {
            const glm::dvec3 m = glm::abs(normal(i));
            const double largest = std::max({m.x, m.y, m.z});
            if (largest == 0) {
                result.degenerate++;
                continue;
            }
            // Ties of equal components are exact in both; shares within 10⁻⁶ of a limit may fall on either side.
            uint32_t first = 0;
            while (m[int(first)] < largest) first++;
            for (uint32_t axis = 0; axis < 3; axis++) {
                const double share = m[int(axis)] / largest, limit = sampling == Sampling::band ? 0.8 : 1;
                const bool may = axis == first || share > limit - 1e-6;
                const bool close = sampling == Sampling::conservative
                                       ? second(m) > largest * (1 - 1e-6) && !exact_tie(m)
                                       : share < limit + 1e-6 && axis != first;
                if (!may || (sampling == Sampling::conservative && exact_tie(m) && axis != first)) continue;
                raster(i, axis, sampling, !close, result);
            }
        }
        for (auto* list : {&result.must, &result.may}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
        return result;
    }

    static glm::dvec3 permuted(const glm::dvec3& p, uint32_t axis) {
        return {p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
    }

  private:
    static double second(const glm::dvec3& m) {
        return std::max(std::min(m.x, m.y), std::min(std::max(m.x, m.y), m.z));
    }
    static bool exact_tie(const glm::dvec3& m) { return second(m) == std::max({m.x, m.y, m.z}); }

    void raster(uint32_t triangle, uint32_t axis, Sampling sampling, bool sure, Expected& out) const {
        const SeenTriangle t = seen(triangle, axis);
        const Polygon whole(t.corners.begin(), t.corners.end());
        const glm::dvec3 dims = permuted(glm::dvec3(grid_.dims), axis);
        glm::dvec3 low = whole[0], high = whole[0];
        for (const auto& p : whole) low = glm::min(low, p), high = glm::max(high, p);
        const int x0 = int(std::max(0.0, std::floor(low.x - 2e-3))),
                  x1 = int(std::min(dims.x - 1, std::floor(high.x + 2e-3)));
        const int y0 = int(std::max(0.0, std::floor(low.y - 2e-3))),
                  y1 = int(std::min(dims.y - 1, std::floor(high.y + 2e-3)));
        const bool centre_only = sampling == Sampling::band;
        const double half = centre_only ? 0.7 : 0.5;
        for (int y = y0; y <= y1; y++) {
            const Polygon row = centre_only ? whole : clip_box(whole, {-1e9, y, 0}, {1e9, y + 1, 0}, 2);
            for (int x = x0; x <= x1; x++) {
                const glm::dvec2 centre(x + 0.5, y + 0.5);
                const double distance = edge_distance(t.corners, centre, centre_only ? 0 : 0.5);
                if (distance < -2e-3) continue;
                const double w = t.plane(centre), extent = half * (std::abs(t.slope.x) + std::abs(t.slope.y));
                double from = w - extent, to = w + extent;
                if (!centre_only) from = std::max(from, low.z), to = std::min(to, high.z);
                for (double at = std::floor(from - 3e-3); at <= std::floor(to + 3e-3); at++)
                    if (centre_only || side_distance(t.corners, {x + 0.5, y + 0.5, at + 0.5}, 0.5) > -4e-3)
                        add(out.may, axis, triangle, x, y, at, at, dims.z);
                if (!sure) continue;
                if (centre_only) {
                    if (distance > 1e-3) add(out.must, axis, triangle, x, y, std::floor(from), std::floor(to), dims.z);
                    continue;
                }
                const Polygon inside = clip_box(row, {x, y, 0}, {x + 1, y + 1, 0}, 1);
                if (inside.empty()) continue;
                from = to = inside[0].z;
                for (const auto& p : inside) from = std::min(from, p.z), to = std::max(to, p.z);
                add(out.must, axis, triangle, x, y, std::ceil(from) - 1, std::floor(to), dims.z);
            }
        }
    }
    void add(std::vector<uint64_t>& list, uint32_t axis, uint32_t triangle, int x, int y, double from, double to,
             double depth) const {
        for (int w = int(std::clamp(from, 0.0, depth - 1)); w <= int(std::clamp(to, 0.0, depth - 1)); w++) {
            glm::uvec3 voxel;
            voxel[(axis + 1) % 3] = uint32_t(x);
            voxel[(axis + 2) % 3] = uint32_t(y);
            voxel[axis] = uint32_t(w);
            list.push_back(pair_of(grid_, voxel, triangle << 2 | axis));
        }
    }

    const CubeGrid& grid_;
    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
};

}  // namespace peelray::test
