// Builds cubes in every way, and compares them with those of `compute` and with the CPU.
#pragma once

#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "decoded_pixels.h"
#include "ldc/graphics_raster.h"
#include "meshes.h"
#include "single_cube.h"

namespace peelray::test {

/// By how much ldcCovers reaches beyond an edge's line, at most.
constexpr double kSlack = 1.5e-3;

struct Builder {
    BuilderKind kind;
    Routing routing;
};
constexpr Builder kGraphics[] = {{BuilderKind::abuffer, Routing::geometry},
                                 {BuilderKind::abuffer, Routing::draws},
                                 {BuilderKind::peel, Routing::geometry},
                                 {BuilderKind::peel, Routing::draws}};
constexpr Sampling kSamplings[] = {Sampling::conservative, Sampling::band, Sampling::centre};

inline std::string name_of(const Builder& builder, Sampling sampling, Traversal traversal) {
    const char* builders[] = {"compute", "abuffer", "peel"};
    const char* routings[] = {"geometry", "draws"};
    const char* samplings[] = {"conservative", "band", "centre"};
    return fmt::format("{} {} {} {}", builders[int(builder.kind)], routings[int(builder.routing)],
                       samplings[int(sampling)], traversal == Traversal::voxel ? "by voxel" : "by pixel");
}

/// A sample in either order, as far as it must be the same.
struct Found {
    uint32_t id;         ///< triangle · 4 + axis, of the whole triangle buffer
    glm::uvec3 cell;     ///< u, v and, by voxel, w
    glm::uvec4 data{0};  ///< by voxel: as it is stored
    float w = 0;         ///< by pixel

    auto key() const { return std::tuple(id, cell.y, cell.x, cell.z); }
};

class BuildersTest : public DeviceTest {
  protected:
    struct Built {
        LdcBody body;
        LdcCounters counts;
        std::vector<Found> samples;  ///< sorted by key
    };

    static CubeLayout layout_of(const Builder& builder, Traversal traversal, bool half = false) {
        CubeLayout layout;
        layout.traversal = traversal;
        layout.builder = builder.kind;
        layout.routing = builder.routing;
        layout.half_depth = half;
        return layout;
    }
    SingleCube cube_of(const Mesh3& mesh, uint32_t resolution, Sampling sampling, const CubeLayout& layout) {
        return {device(),   commands(), mesh.positions, mesh.triangles, mesh.lower,
                mesh.upper, resolution, sampling,       layout};
    }
    /// The samples of one body.
    std::vector<Found> samples_of(const Cubes& cubes, const LdcBody& body, const TableSize& size,
                                  const LdcCounters* whole) {
        std::vector<Found> found;
        if (cubes.layout().by_pixel()) {
            const PixelTables tables = download_pixels(commands(), cubes, size);
            const DecodedPixels decoded(body, tables);
            if (whole) decoded.expect_whole(*whole);
            for (const auto& s : decoded.samples) found.push_back({s.id, {s.pixel, 0}, {}, s.w});
        } else {
            const Tables tables = test::download(commands(), cubes, size);
            const DecodedCube decoded(body, tables);
            if (HasFatalFailure()) return {};
            if (whole) decoded.expect_whole(*whole);
            for (const auto& s : decoded.samples) {
                const uint32_t axis = s.id & 3;
                found.push_back({s.id, {s.voxel[(axis + 1) % 3], s.voxel[(axis + 2) % 3], s.voxel[axis]}, s.data, 0});
            }
        }
        std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.key() < b.key(); });
        return found;
    }
    Built look_at(const SingleCube& cube) {
        const LdcBody body = cube.cubes.table.download(commands())[0];
        return {body, cube.counts(), samples_of(cube.cubes, body, cube.builder.size(), &cube.counts())};
    }
    Built build(const Mesh3& mesh, uint32_t resolution, Sampling sampling, const CubeLayout& layout) {
        return look_at(cube_of(mesh, resolution, sampling, layout));
    }

    static double segment_distance(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
        const glm::dvec2 e = b - a;
        const double length2 = glm::dot(e, e), t = length2 > 0 ? std::clamp(glm::dot(p - a, e) / length2, 0.0, 1.0) : 0;
        return glm::length(p - a - t * e);
    }
    /// How far the pixel's centre is from the nearest edge.
    static bool near_edge(const CpuRaster& cpu, const Found& f, uint32_t first_triangle) {
        const auto seen = cpu.seen((f.id >> 2) - first_triangle, f.id & 3);
        const glm::dvec2 centre = glm::dvec2(f.cell) + 0.5;
        if (std::abs(edge_distance(seen.corners, centre, 0)) <= kSlack) return true;
        for (size_t k = 0; k < 3; k++)
            if (segment_distance(centre, seen.corners[k], seen.corners[(k + 1) % 3]) <= kSnap) return true;
        return false;
    }

    /// `other` is the same cube as `compute`, but for samples at edges.
    static void expect_same(const Mesh3& mesh, const LdcBody& body, const std::vector<Found>& compute,
                            const std::vector<Found>& other, Sampling sampling) {
        const CpuRaster cpu(body.grid, mesh.positions, mesh.triangles);
        size_t lonely = 0;
        const auto alone = [&](const Found& f, const char* who) {
            lonely++;
            ASSERT_TRUE(sampling != Sampling::conservative && near_edge(cpu, f, body.first_triangle))
                << "only " << who << ": triangle " << (f.id >> 2) << " axis " << (f.id & 3) << " pixel " << f.cell.x
                << " " << f.cell.y;
        };
        auto a = compute.begin(), b = other.begin();
        while (a != compute.end() || b != other.end()) {
            if (b == other.end() || (a != compute.end() && a->key() < b->key())) {
                alone(*a++, "compute");
            } else if (a == compute.end() || b->key() < a->key()) {
                alone(*b++, "the other");
            } else {
                ASSERT_EQ(a->data, b->data);
                ASSERT_NEAR(a->w, b->w, 1e-3);
                a++, b++;
            }
            if (HasFatalFailure()) return;
        }
        EXPECT_LE(lonely, (compute.size() + other.size()) / 20 + 8) << "of " << compute.size();
    }
    /// Every builder, way, sampling and order.
    void expect_all_same(const Mesh3& mesh, uint32_t resolution, std::span<const Builder> builders = kGraphics) {
        for (const Sampling sampling : kSamplings)
            for (const Traversal traversal : {Traversal::voxel, Traversal::two_level}) {
                const Built compute = build(mesh, resolution, sampling, layout_of({}, traversal));
                for (const Builder& builder : builders) {
                    if (builder.kind == BuilderKind::peel && sampling == Sampling::conservative) continue;
                    SCOPED_TRACE(name_of(builder, sampling, traversal));
                    const Built other = build(mesh, resolution, sampling, layout_of(builder, traversal));
                    EXPECT_EQ(compute.counts.degenerate, other.counts.degenerate);
                    EXPECT_EQ(compute.counts.invalid, other.counts.invalid);
                    expect_same(mesh, compute.body, compute.samples, other.samples, sampling);
                    if (builder.kind == BuilderKind::peel) {
                        EXPECT_EQ(other.counts.passes, other.counts.complexity);
                        if (traversal != Traversal::voxel) {
                            EXPECT_EQ(other.counts.complexity, other.counts.longest);
                        }
                    }
                    if (HasFailure()) return;
                }
            }
    }

    /// The by-pixel cube against the CPU. Must: the pixel's centre is inside by more than 1/128, or, conservatively,
    /// its square touches the triangle. May: it is outside by no more than that.
    void expect_right(const Mesh3& mesh, const Built& built, Sampling sampling, bool half) {
        const CubeGrid& grid = built.body.grid;
        const CpuRaster cpu(grid, mesh.positions, mesh.triangles);
        const bool conservative = sampling == Sampling::conservative;
        uint32_t degenerate = 0;
        std::vector<std::tuple<uint32_t, uint32_t, uint32_t>> keys;
        for (const Found& f : built.samples) {
            keys.emplace_back(f.id, f.cell.y, f.cell.x);
            const auto seen = cpu.seen(f.id >> 2, f.id & 3);
            const glm::dvec2 centre = glm::dvec2(f.cell) + 0.5;
            const double distance = edge_distance(seen.corners, centre, conservative ? 0.5 : 0);
            ASSERT_TRUE(distance > (conservative ? -2e-3 : -kSnap) || near_edge(cpu, f, 0));
            const double w = seen.plane(centre);
            ASSERT_NEAR(f.w, w, 3e-4 + (half ? w / 2048 : 0));
        }
        for (uint32_t i = 0; i < mesh.triangles.size(); i++) {
            const glm::dvec3 m = glm::abs(cpu.normal(i));
            const double largest = std::max({m.x, m.y, m.z});
            if (largest == 0) {
                degenerate++;
                continue;
            }
            for (uint32_t axis = 0; axis < 3; axis++) {
                // Sure to be captured there: no tie, and not at the limit of the overlap band.
                const double share = m[int(axis)] / largest, rest = std::max(m[(axis + 1) % 3], m[(axis + 2) % 3]);
                const bool sure = sampling == Sampling::band ? share > 0.8 + 1e-6 : m[int(axis)] > rest * (1 + 1e-6);
                if (sure) expect_held(cpu.seen(i, axis), i << 2 | axis, conservative, keys);
            }
        }
        EXPECT_EQ(degenerate, built.counts.degenerate);
    }

  private:
    static void expect_held(const SeenTriangle& seen, uint32_t id, bool conservative,
                            const std::vector<std::tuple<uint32_t, uint32_t, uint32_t>>& keys) {
        glm::dvec2 low(seen.corners[0]), high = low;
        for (const glm::dvec3& p : seen.corners)
            low = glm::min(low, glm::dvec2(p)), high = glm::max(high, glm::dvec2(p));
        for (int y = int(std::floor(low.y)); y <= int(std::floor(high.y)); y++)
            for (int x = int(std::floor(low.x)); x <= int(std::floor(high.x)); x++) {
                const double distance = edge_distance(seen.corners, {x + 0.5, y + 0.5}, conservative ? 0.5 : 0);
                if (distance < (conservative ? 0 : kSnap)) continue;
                ASSERT_TRUE(std::binary_search(keys.begin(), keys.end(), std::tuple(id, uint32_t(y), uint32_t(x))))
                    << "triangle " << (id >> 2) << " axis " << (id & 3) << " pixel " << x << " " << y << " is lost";
            }
    }
};

}  // namespace peelray::test
