// Voxels whose lists are long become finer ones: what is in those, and that no hit depends on it.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <set>

#include "../gpu/device_fixture.h"
#include "../gpu/exact_clip.h"
#include "decoded_cube.h"
#include "effort.h"
#include "loaders/load.h"
#include "ray_sets.h"
#include "traced_body.h"

namespace peelray {
namespace {

using glm::dvec3;
using glm::uvec3;
using glm::vec3;
using test::RayKind;
using test::TracedBody;

/// Triangles and their box.
Geometry geometry_from(const std::vector<std::array<vec3, 3>>& triangles) {
    Geometry g;
    g.lower = vec3(1e30f);
    g.upper = vec3(-1e30f);
    for (const auto& triangle : triangles) {
        const auto first = uint32_t(g.positions.size());
        for (const vec3& p : triangle) {
            g.positions.push_back(p);
            g.lower = glm::min(g.lower, p);
            g.upper = glm::max(g.upper, p);
        }
        g.triangles.emplace_back(first, first + 1, first + 2);
    }
    return g;
}

/// A finely tessellated bowl in the corner of a large, otherwise empty box: a voxel or two hold all of it.
Geometry crowd_in_a_corner(uint32_t around) {
    std::vector<std::array<vec3, 3>> triangles = {{vec3(0, 0, 0), vec3(40, 0, 0), vec3(0, 0, 40)},
                                                  {vec3(40, 40, 40), vec3(40, 38, 40), vec3(38, 40, 40)}};
    const auto point = [&](uint32_t i, uint32_t k) {
        const float a = float(i) / float(around) * 6.2831853f, b = float(k) / float(around / 2) * 1.5f;
        return vec3(3.1f, 2.7f, 3.3f) + 0.9f * vec3(std::cos(a) * std::sin(b), -std::cos(b), std::sin(a) * std::sin(b));
    };
    for (uint32_t k = 0; k < around / 2; k++)
        for (uint32_t i = 0; i < around; i++) {
            triangles.push_back({point(i, k), point(i, k + 1), point(i + 1, k + 1)});
            if (k > 0) triangles.push_back({point(i, k), point(i + 1, k + 1), point(i + 1, k)});
        }
    return geometry_from(triangles);
}

/// A cone's triangles, which all meet in its tip, and sheets that lie one upon the other.
Geometry what_does_not_come_apart(int triangles) {
    std::vector<std::array<vec3, 3>> all;
    for (int i = 0; i < triangles; i++) {
        const float a = float(i) / float(triangles) * 6.2831853f, b = float(i + 1) / float(triangles) * 6.2831853f;
        all.push_back({vec3(0), vec3(std::cos(a), 1, std::sin(a)), vec3(std::cos(b), 1, std::sin(b))});
        all.push_back({vec3(-2, -1, -2), vec3(2, -1, -2), vec3(-2, -1, 2)});
    }
    return geometry_from(all);
}

std::vector<Ray> mixed_rays(const Geometry& geometry, size_t of_each) {
    test::RaySource source(geometry, 4711, 0);
    std::vector<Ray> rays;
    for (RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel, RayKind::on_surface})
        for (size_t i = 0; i < of_each; i++) rays.push_back(source.make(kind));
    return rays;
}

/// Voxels of a cube and the triangles in their lists; of those that are refined, of each finer voxel.
struct RefinedVoxels {
    std::map<std::array<uint32_t, 3>, std::set<uint32_t>> coarse;  ///< by voxel
    std::map<std::array<uint32_t, 3>, std::set<uint32_t>> fine;    ///< by finer voxel
    std::set<std::array<uint32_t, 3>> refined;                     ///< voxels
};

class RefineTest : public DeviceTest {
  protected:
    static TracedBody body_of(Device& device, const Geometry& geometry, uint32_t resolution,
                              const Refinement& refinement = {}) {
        return TracedBody(device, geometry, resolution, HitTest::exact, {}, 0.001f, refinement);
    }

    std::set<uint32_t> list_at(const test::Tables& tables, uint32_t entry) {
        std::set<uint32_t> ids;
        for (uint32_t j = entry & 0x3fffffff;; j++) {
            EXPECT_LT(j, tables.patches.size()) << "a list without a last sample";
            if (j >= tables.patches.size()) break;
            EXPECT_TRUE(ids.insert(tables.patches[j].w >> 2).second) << "a sample stands there twice";
            if (tables.patches[j].z & 1) break;
        }
        return ids;
    }

    /// All voxels of a body that is alone in its tables.
    RefinedVoxels voxels_of(TracedBody& body) {
        const test::SingleCube& cube = body.cube();
        const test::Tables tables = test::download(body.commands(), cube.cubes, cube.builder.size());
        const uvec3 tops = cube.grid.dims / 16u;
        RefinedVoxels out;
        for (uint32_t t = 0; t < tops.x * tops.y * tops.z; t++) {
            if (!(tables.top[t].x >> 31)) continue;
            const uvec3 top(t % tops.x, t / tops.x % tops.y, t / (tops.x * tops.y));
            for (uint32_t n = 0; n < 64; n++) {
                const uint32_t node = tables.node[tables.top[t].y * 64 + n];
                if (!(node >> 31)) continue;
                for (uint32_t v = 0; v < 64; v++) {
                    const uint32_t entry = tables.voxel[(node & 0x7fffffff) * 64 + v];
                    if (!(entry >> 31)) continue;
                    const auto in_64 = [](uint32_t k) { return uvec3(k % 4, k / 4 % 4, k / 16); };
                    const uvec3 voxel = top * 16u + in_64(n) * 4u + in_64(v);
                    if (entry >> 30 == 2) {
                        out.coarse[{voxel.x, voxel.y, voxel.z}] = list_at(tables, entry);
                        continue;
                    }
                    out.refined.insert({voxel.x, voxel.y, voxel.z});
                    const uint32_t block = entry & 0x3fffffff;
                    for (uint32_t f = 0; f < 64; f++) {
                        const uint32_t finer = tables.voxel[block * 64 + f];
                        if (finer >> 31) {
                            const uvec3 cell = voxel * 4u + in_64(f);
                            out.fine[{cell.x, cell.y, cell.z}] = list_at(tables, finer);
                            continue;
                        }
                        EXPECT_LT(finer, 1u << 12);
                        const uvec3 lo(finer & 3, finer >> 2 & 3, finer >> 4 & 3),
                            hi(finer >> 6 & 3, finer >> 8 & 3, finer >> 10 & 3);
                        EXPECT_TRUE(glm::all(glm::lessThanEqual(lo, in_64(f))) &&
                                    glm::all(glm::lessThanEqual(in_64(f), hi)));
                        for (uint32_t k = 0; k < 64; k++)
                            if (glm::all(glm::lessThanEqual(lo, in_64(k))) &&
                                glm::all(glm::lessThanEqual(in_64(k), hi))) {
                                EXPECT_FALSE(tables.voxel[block * 64 + k] >> 31) << "an occupied cell in a box";
                            }
                    }
                }
            }
        }
        return out;
    }

    /// Does the triangle come into the finer voxel, enlarged by `margin` of its edge? By clipping.
    static bool touches(const Geometry& geometry, const CubeGrid& grid, uint32_t triangle, const uvec3& cell,
                        double margin) {
        Polygon polygon;
        for (int k = 0; k < 3; k++)
            polygon.push_back((dvec3(geometry.positions[geometry.triangles[triangle][k]]) - dvec3(grid.origin)) * 4.0 /
                              double(grid.voxel));
        return !clip_box(polygon, dvec3(cell) - margin, dvec3(cell) + 1.0 + margin, 3).empty();
    }

    void expect_same_hits(const Geometry& geometry, uint32_t resolution, std::initializer_list<uint32_t> limits,
                          size_t rays_of_each) {
        const std::vector<Ray> rays = mixed_rays(geometry, rays_of_each);
        TracedBody plain = body_of(device(), geometry, resolution);
        const std::vector<Hit> expected = plain.trace(rays), any = plain.trace(rays, true);
        size_t found = 0;
        for (const Hit& hit : expected) found += hit.triangle != NO_TRIANGLE;
        EXPECT_GT(found, rays.size() / 20) << "rays that hit nothing prove nothing";
        for (const uint32_t longest : limits) {
            TracedBody refined = body_of(device(), geometry, resolution, {longest});
            EXPECT_GT(refined.cube().counts().refined, 0u) << longest;
            const std::vector<Hit> hits = refined.trace(rays), some = refined.trace(rays, true);
            size_t other = 0, other_any = 0;
            for (size_t i = 0; i < rays.size(); i++) {
                other += std::bit_cast<uint32_t>(hits[i].t) != std::bit_cast<uint32_t>(expected[i].t) ||
                         hits[i].triangle != expected[i].triangle;
                other_any += (some[i].triangle == NO_TRIANGLE) != (any[i].triangle == NO_TRIANGLE);
            }
            EXPECT_EQ(other, 0u) << "lists up to " << longest << " at " << resolution;
            EXPECT_EQ(other_any, 0u) << "lists up to " << longest << " at " << resolution;
        }
    }
};

TEST_F(RefineTest, HitsAreTheSameBitForBit) {
    expect_same_hits(flatten(load_scene("builtin:blob:3000")), 16, {1, 8}, test::effort(150, 1500));
    expect_same_hits(crowd_in_a_corner(40), 32, {20}, test::effort(100, 1000));
    expect_same_hits(what_does_not_come_apart(100), 64, {1}, test::effort(50, 500));
}

TEST_F(RefineTest, FinerVoxelsHoldTheTrianglesThatTouchThem) {
    const Geometry geometry = flatten(load_scene("builtin:blob:1500"));
    const uint32_t longest = 10;
    TracedBody plain = body_of(device(), geometry, 16), refined = body_of(device(), geometry, 16, {longest});
    const RefinedVoxels whole = voxels_of(plain), parts = voxels_of(refined);
    const CubeGrid& grid = refined.cube().grid;
    EXPECT_TRUE(whole.refined.empty());
    ASSERT_GT(parts.refined.size(), 20u);
    EXPECT_EQ(parts.refined.size(), refined.cube().counts().refined);
    size_t samples = 0, longest_found = 0;
    for (const auto& [voxel, list] : whole.coarse) {
        if (!parts.refined.contains(voxel)) {
            EXPECT_EQ(parts.coarse.at(voxel), list);
            longest_found = std::max(longest_found, list.size());
            continue;
        }
        EXPECT_GT(list.size(), longest);
        for (uint32_t k = 0; k < 64; k++) {
            const uvec3 cell = uvec3(voxel[0], voxel[1], voxel[2]) * 4u + uvec3(k % 4, k / 4 % 4, k / 16);
            const auto finer = parts.fine.find({cell.x, cell.y, cell.z});
            const std::set<uint32_t> held = finer == parts.fine.end() ? std::set<uint32_t>() : finer->second;
            samples += held.size();
            longest_found = std::max(longest_found, held.size());
            for (const uint32_t id : list) {
                // What is left of the axes' tests: a corner of the box may be farther than its faces.
                if (held.contains(id))
                    EXPECT_TRUE(touches(geometry, grid, id, cell, 0.03)) << id;
                else
                    EXPECT_FALSE(touches(geometry, grid, id, cell, 0.001)) << id;
            }
            for (const uint32_t id : held) EXPECT_TRUE(list.contains(id));
        }
    }
    EXPECT_EQ(samples, refined.cube().counts().fine);
    EXPECT_EQ(longest_found, refined.cube().counts().longest);
}

TEST_F(RefineTest, WhatDoesNotComeApartStaysAList) {
    const int triangles = 300;
    TracedBody body = body_of(device(), what_does_not_come_apart(triangles), 48, {8});
    const BuildCounts& counts = body.cube().counts();
    const RefinedVoxels voxels = voxels_of(body);
    // The sheets' voxels alone would be some 16 times as many samples.
    EXPECT_GE(counts.longest, uint32_t(triangles));
    EXPECT_LT(counts.fine, counts.fragments / 4);
    for (const auto& voxel : voxels.refined) EXPECT_GT(voxel[1], 4u) << "only the cone is worth it";
    EXPECT_FALSE(voxels.refined.empty());
}

TEST_F(RefineTest, ListsOfThousandsStayLists) {
    const Geometry geometry = what_does_not_come_apart(LDC_LONGEST_REFINED + 1);
    TracedBody body = body_of(device(), geometry, 16, {LDC_LONGEST_REFINED - 1});
    EXPECT_GT(body.cube().counts().longest, LDC_LONGEST_REFINED);
    EXPECT_EQ(body.cube().counts().refine, 0u);
    EXPECT_EQ(body.cube().counts().refined, 0u);
}

TEST_F(RefineTest, OnlyWhereSomeListIsLongEnough) {
    const Geometry geometry = flatten(load_scene("builtin:blob:1500"));
    const uint32_t longest = body_of(device(), geometry, 16).cube().counts().longest;
    ASSERT_GT(longest, 12u);
    TracedBody left = body_of(device(), geometry, 16, {6, longest}),
               refined = body_of(device(), geometry, 16, {6, longest - 1});
    EXPECT_EQ(left.cube().counts().longest, longest);
    EXPECT_EQ(left.cube().counts().refined, 0u);
    EXPECT_FALSE(left.cube().cubes.refined) << "rays need not look for finer voxels";
    EXPECT_TRUE(voxels_of(left).refined.empty());
    EXPECT_GT(refined.cube().counts().refined, 0u);
    EXPECT_TRUE(refined.cube().cubes.refined);
    EXPECT_LT(refined.cube().counts().longest, longest);
}

TEST_F(RefineTest, ByVoxelAndExactAlone) {
    const Geometry geometry = crowd_in_a_corner(40);
    for (const HitTest test : {HitTest::planar, HitTest::tolerance}) {
        TracedBody body(device(), geometry, 32, test, {}, 0.001f, {1});
        EXPECT_EQ(body.cube().counts().refine, 0u);
    }
    TracedBody pixels(device(), geometry, 32, HitTest::exact, {Traversal::two_level}, 0.001f, {1});
    EXPECT_EQ(pixels.cube().counts().refine, 0u);
}

TEST_F(RefineTest, OverflowGrowsAndIsRedone) {
    // There is room for no list at first; then more samples than guessed of lists of hundreds, where lists of two are
    // long.
    const Geometry geometry = crowd_in_a_corner(80);
    TracedBody body = body_of(device(), geometry, 16, {1});
    const BuildCounts& counts = body.cube().counts();
    EXPECT_GE(body.cube().builder.redone(), 2u) << "queue, then samples";
    EXPECT_GT(counts.fine, 4 * counts.refine) << "more than the guess";
    EXPECT_EQ(voxels_of(body).refined.size(), counts.refined);
    expect_same_hits(geometry, 16, {1}, 25);
}

}  // namespace
}  // namespace peelray
