// The traversals against each other, and their hits on samples against the definition, in double precision.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string_view>

#include "../gpu/device_fixture.h"
#include "effort.h"
#include "loaders/load.h"
#include "ray_sets.h"
#include "traced_body.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using test::RayKind;
using test::TracedBody;

const std::vector<CubeLayout>& by_pixel() {
    static const std::vector<CubeLayout> layouts = {{Traversal::two_level, {8, 8}},
                                                    {Traversal::two_level, {2, 2}},
                                                    {Traversal::two_level, {5, 3}},
                                                    {Traversal::two_level, {32, 32}},
                                                    {Traversal::two_level, {16, 4}},
                                                    {Traversal::mipmap},
                                                    {Traversal::two_level, {8, 8}, false, Batch::layers},
                                                    {Traversal::two_level, {8, 8}, false, Batch::rays},
                                                    {Traversal::mipmap, {8, 8}, false, Batch::rays}};
    return layouts;
}

std::string name_of(const CubeLayout& layout) {
    return fmt::format("{} {}x{}", peelray::name_of(layout.traversal), layout.block.x, layout.block.y);
}

std::vector<Ray> some_rays(const Geometry& geometry, size_t of_each, double lift = 0) {
    test::RaySource source(geometry, 77, lift);
    std::vector<Ray> rays;
    for (RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel, RayKind::on_surface})
        for (size_t i = 0; i < of_each; i++) rays.push_back(source.make(kind));
    return rays;
}

/// Thousands of slivers that share a corner, some triangles without area and a few of ordinary size.
Geometry crowd() {
    Geometry g;
    const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = uint32_t(g.positions.size());
        for (const glm::vec3& p : {a, b, c}) {
            g.positions.push_back(p);
            g.lower = first + g.positions.size() == 1 ? p : glm::min(g.lower, p);
            g.upper = first + g.positions.size() == 1 ? p : glm::max(g.upper, p);
        }
        g.triangles.emplace_back(first, first + 1, first + 2);
    };
    g.lower = g.upper = glm::vec3(0);
    const int slivers = test::effort(1000, 3000);
    for (int i = 0; i < slivers; i++) {
        const float a = float(i) / slivers * 6.2831853f, b = float(i + 1) / slivers * 6.2831853f;
        add({0, 0, 0}, {std::cos(a), std::sin(a), 0.2f * std::sin(5 * a)},
            {std::cos(b), std::sin(b), 0.2f * std::sin(5 * b)});
        if (i % 2) add({0, 0, 0.3f}, {std::cos(a), std::sin(a), 0.3f}, {std::cos(a), std::sin(a), 0.3f});
    }
    for (int i = 0; i < test::effort(400, 1000); i++)
        add({-0.1f, -0.1f, -0.5f}, {0.2f, -0.1f, -0.5f}, {-0.1f, 0.2f, -0.5f});  // one upon the other
    return g;
}

class TraversalTest : public DeviceTest {
  protected:
    /// `exact`: bit for bit the same hits as by voxel, whatever the blocks.
    void expect_same(const Geometry& geometry, uint32_t resolution, size_t rays_of_each) {
        const std::vector<Ray> rays = some_rays(geometry, rays_of_each);
        TracedBody voxels(device(), geometry, resolution, HitTest::exact);
        const std::vector<Hit> expected = voxels.trace(rays), any = voxels.trace(rays, true);
        size_t found = 0;
        for (const Hit& hit : expected) found += hit.triangle != NO_TRIANGLE;
        EXPECT_GT(found, rays.size() / 20) << "rays that hit nothing prove nothing";
        for (const CubeLayout& layout : by_pixel()) {
            TracedBody pixels(device(), geometry, resolution, HitTest::exact, layout);
            const std::vector<Hit> hits = pixels.trace(rays), some = pixels.trace(rays, true);
            size_t other_t = 0, other_triangle = 0, other_any = 0;
            for (size_t i = 0; i < rays.size(); i++) {
                other_t += std::bit_cast<uint32_t>(hits[i].t) != std::bit_cast<uint32_t>(expected[i].t);
                // Of triangles at the same distance, as at an edge that they share, either may be named.
                other_triangle += (hits[i].triangle == NO_TRIANGLE) != (expected[i].triangle == NO_TRIANGLE);
                other_any += (some[i].triangle == NO_TRIANGLE) != (any[i].triangle == NO_TRIANGLE);
            }
            EXPECT_EQ(other_t, 0u) << name_of(layout);
            EXPECT_EQ(other_triangle, 0u) << name_of(layout);
            EXPECT_EQ(other_any, 0u) << name_of(layout);
        }
    }
};

TEST_F(TraversalTest, ExactHitsAreTheSameBitForBit) {
    for (const char* name : {"builtin:blob:20000", "builtin:teapots"})
        for (uint32_t resolution : {48u, 256u}) {
            // Each scene and each resolution once.
            if (test::effort(true, false) && (resolution < 100) != (std::string_view(name) == "builtin:teapots"))
                continue;
            SCOPED_TRACE(fmt::format("{} at {}", name, resolution));
            const size_t rays = resolution < 100 ? test::effort(100, 400) : test::effort(300, 1500);
            expect_same(flatten(load_scene(name)), resolution, rays);
        }
}

TEST_F(TraversalTest, ThousandsOfLayersAndTrianglesWithoutArea) {
    const Geometry geometry = crowd();
    expect_same(geometry, 64, test::effort(25, 150));
    TracedBody pixels(device(), geometry, 64, HitTest::exact, {Traversal::two_level});
    EXPECT_GE(pixels.cube().counts().longest, test::effort(500u, 1500u)) << "the depth complexity";
    EXPECT_EQ(pixels.cube().counts().degenerate, test::effort(500u, 1500u));
}

/// A sample of the by-pixel order as the tables hold it.
struct PixelSample {
    uint32_t axis, id;
    dvec2 pixel, slope;
    double w;
};

std::vector<PixelSample> download_samples(TracedBody& body) {
    const test::SingleCube& cube = body.cube();
    const uint32_t count = cube.counts().fragments;
    Commands& commands = body.commands();
    const glm::uvec3 dims = cube.grid.dims;
    const uint32_t pixels = dims.x * dims.y + dims.y * dims.z + dims.z * dims.x;
    const auto offsets = commands.download<uint32_t>(cube.cubes.pixel_offsets, pixels + 1);
    const auto data = commands.download<glm::uvec2>(cube.cubes.samples, count);
    const auto ids = commands.download<uint32_t>(cube.cubes.sample_ids, count);
    std::vector<PixelSample> samples;
    EXPECT_EQ(offsets[pixels], count);
    uint32_t first = 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        const uint32_t width = dims[int(axis + 1) % 3], height = dims[int(axis + 2) % 3];
        for (uint32_t i = 0; i < width * height; i++) {
            const uint32_t tile = i / 64, inside = i % 64;
            const dvec2 pixel(tile % (width / 8) * 8 + inside % 8, tile / (width / 8) * 8 + inside / 8);
            for (uint32_t j = offsets[first + i]; j < offsets[first + i + 1]; j++) {
                const auto part = [&](uint32_t shift) { return double(int16_t(data[j].y >> shift)) / 32767 * 1.25; };
                samples.push_back({axis, ids[j], pixel, {part(0), part(16)}, double(std::bit_cast<float>(data[j].x))});
                EXPECT_EQ(ids[j] & 3, axis);
            }
        }
        first += width * height;
    }
    return samples;
}

/// Where a ray can, and where it must, meet a sample.
struct Meeting {
    bool may = false, must = false;
    double t = 0, slack = 0;
};

/// The definition of a hit (docs/frame.md), with 2·10⁻³ voxels of doubt.
Meeting meet(const PixelSample& sample, const Ray& ray, const CubeGrid& grid, HitTest test, double tolerance) {
    const auto turn = [&](const dvec3& p) {
        return dvec3(p[int(sample.axis + 1) % 3], p[int(sample.axis + 2) % 3], p[int(sample.axis)]);
    };
    const dvec3 d = turn(dvec3(ray.direction)) / double(grid.voxel);
    const dvec3 o = turn(dvec3(ray.origin) - dvec3(grid.origin)) / double(grid.voxel) - dvec3(sample.pixel, 0);
    const double doubt = 2e-3, speed = glm::length(d);
    // While in the column.
    double in[2] = {ray.tmin, ray.tmin}, out[2] = {ray.tmax, ray.tmax};
    for (int grown = 0; grown < 2; grown++)
        for (int k = 0; k < 2; k++) {
            const double low = grown ? -doubt : doubt, high = 1 - low;
            if (std::abs(d[k]) < 1e-9 * speed) {
                if (o[k] < low || o[k] > high) out[grown] = -1e300;
                continue;
            }
            const double a = (low - o[k]) / d[k], b = (high - o[k]) / d[k];
            in[grown] = std::max(in[grown], std::min(a, b));
            out[grown] = std::min(out[grown], std::max(a, b));
        }
    Meeting m;
    if (test == HitTest::tolerance) {
        const auto nearest = [&](int grown) {
            const double at = std::abs(d.z) < 1e-12 * speed ? in[grown] : (sample.w - o.z) / d.z;
            return std::clamp(at, in[grown], std::max(in[grown], out[grown]));
        };
        m.t = nearest(1);
        const double off = std::abs(o.z + m.t * d.z - sample.w),
                     off_inside = std::abs(o.z + nearest(0) * d.z - sample.w);
        const double doubt_w = doubt * (1 + std::abs(d.z) / speed);
        m.may = in[1] <= out[1] && off <= tolerance + doubt_w;
        m.must = in[0] <= out[0] && off_inside <= tolerance - doubt_w && m.t > ray.tmin + doubt / speed;
        // A corner that is cut by less than the doubt puts the place anywhere along it.
        m.slack = 2 * doubt / speed + std::abs(m.t - nearest(0));
        if (in[0] > out[0]) m.slack += out[1] - in[1];
        // Of a ray that hardly changes its depth every place in the column is as near as any other.
        if (std::abs(d.z) < 0.1 * speed) m.slack += std::min(out[1] - in[1], doubt / std::abs(d.z));
        return m;
    }
    const double den = d.z - glm::dot(sample.slope, dvec2(d));
    const dvec2 centre = dvec2(o) - 0.5;
    m.t = (sample.w + glm::dot(sample.slope, centre) - o.z) / den;
    const dvec2 at = glm::abs(centre + m.t * dvec2(d));
    const double steep = speed / std::abs(den), doubt_at = doubt * (1 + steep), across = std::max(at.x, at.y);
    const double extent = 0.7 * (std::abs(sample.slope.x) + std::abs(sample.slope.y)) + 2e-3;
    const auto meets = [&](int grown, double sign) {
        const double a = o.z + in[grown] * d.z, b = o.z + out[grown] * d.z;
        return in[grown] <= out[grown] &&
               std::max(a, b) >= std::floor(sample.w - extent + sign * doubt) - (sign < 0 ? doubt : -doubt) &&
               std::min(a, b) <= std::floor(sample.w + extent - sign * doubt) + 1 + (sign < 0 ? doubt : -doubt);
    };
    m.slack = doubt * (1 + steep) / speed;
    m.may = across <= 0.7 + doubt_at && m.t > ray.tmin - m.slack && m.t < ray.tmax + m.slack && meets(1, -1);
    // A sample whose plane is crossed beside its own column may come after what ended the ray.
    m.must = across <= 0.7 - doubt_at && m.t > in[0] + m.slack && m.t < out[0] - m.slack && meets(0, 1);
    return m;
}

class SampleHits : public TraversalTest, public ::testing::WithParamInterface<HitTest> {};

TEST_P(SampleHits, FollowTheDefinition) {
    const HitTest test = GetParam();
    const Geometry geometry = flatten(load_scene("builtin:blob:600"));
    const std::vector<Ray> rays = some_rays(geometry, test::effort(120, 500), 0.05);
    const float tolerance = 0.02f;
    std::vector<std::vector<Hit>> answers;
    std::vector<PixelSample> samples;
    CubeGrid grid{};
    std::vector<CubeLayout> layouts = by_pixel();
    layouts.push_back({Traversal::voxel});
    for (const CubeLayout& layout : layouts) {
        TracedBody body(device(), geometry, 48, test, layout, tolerance);
        answers.push_back(body.trace(rays));
        if (layout.by_pixel() && samples.empty()) samples = download_samples(body);
        grid = body.grid();
    }
    size_t found = 0;
    std::vector<size_t> wrong(layouts.size());
    for (size_t i = 0; i < rays.size(); i++) {
        std::vector<Meeting> meetings;
        for (const PixelSample& sample : samples) {
            const Meeting m = meet(sample, rays[i], grid, test, tolerance / grid.voxel);
            if (m.may) meetings.push_back(m);
        }
        for (size_t k = 0; k < layouts.size(); k++) {
            const Hit& hit = answers[k][i];
            const bool miss = hit.triangle == NO_TRIANGLE;
            found += !miss;
            bool known = miss, overlooked = false;
            for (const Meeting& m : meetings) {
                known |= std::abs(double(hit.t) - m.t) <= m.slack + 1e-5 * std::abs(m.t);
                overlooked |= m.must && (miss || m.t < double(hit.t) - m.slack - 1e-5 * std::abs(m.t));
            }
            wrong[k] += !known || overlooked;
        }
    }
    EXPECT_GT(found, rays.size() * layouts.size() / 10);
    for (size_t k = 0; k < layouts.size(); k++) EXPECT_EQ(wrong[k], 0u) << name_of(layouts[k]);
}

TEST_P(SampleHits, AreTheSameBitForBitByPixelAndAlmostByVoxel) {
    const HitTest test = GetParam();
    const Geometry geometry = flatten(load_scene("builtin:teapots"));
    const float tolerance = 0.02f;
    const std::vector<Ray> rays = some_rays(geometry, test::effort(3000, 10'000), 0.05);
    std::vector<Hit> first;
    double voxel = 0;
    for (const CubeLayout& layout : by_pixel()) {
        TracedBody body(device(), geometry, 256, test, layout, tolerance);
        voxel = body.grid().voxel;
        const std::vector<Hit> hits = body.trace(rays);
        if (first.empty()) first = hits;
        size_t different = 0;
        for (size_t i = 0; i < rays.size(); i++)
            different += std::bit_cast<uint32_t>(hits[i].t) != std::bit_cast<uint32_t>(first[i].t);
        EXPECT_EQ(different, 0u) << name_of(layout);
    }
    // By voxel depths and slopes are rounded otherwise: what is near a footprint's edge may differ.
    TracedBody body(device(), geometry, 256, test, {}, tolerance);
    const std::vector<Hit> hits = body.trace(rays);
    size_t different = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        const bool miss = hits[i].triangle == NO_TRIANGLE, other_miss = first[i].triangle == NO_TRIANGLE;
        different += miss != other_miss ||
                     (!miss && std::abs(hits[i].t - first[i].t) * glm::length(rays[i].direction) > 0.1 * voxel);
    }
    fmt::print("  {} of {} rays differ\n", different, rays.size());
    EXPECT_LT(different, rays.size() / 200);
}

TEST_P(SampleHits, AnyHitIsAHit) {
    const Geometry geometry = flatten(load_scene("builtin:blob:20000"));
    const std::vector<Ray> rays = some_rays(geometry, test::effort(1000, 5000), 0.05);
    for (const CubeLayout& layout : {CubeLayout{Traversal::two_level}, CubeLayout{Traversal::mipmap}, CubeLayout{}}) {
        TracedBody body(device(), geometry, 128, GetParam(), layout, 0.02f);
        const std::vector<Hit> nearest = body.trace(rays), any = body.trace(rays, true);
        size_t different = 0;
        for (size_t i = 0; i < rays.size(); i++)
            different += (nearest[i].triangle == NO_TRIANGLE) != (any[i].triangle == NO_TRIANGLE);
        EXPECT_EQ(different, 0u) << name_of(layout);
    }
}

INSTANTIATE_TEST_SUITE_P(Tests, SampleHits, ::testing::Values(HitTest::planar, HitTest::tolerance),
                         [](const auto& info) { return peelray::name_of(info.param); });

TEST_F(TraversalTest, BlocksOutOfRangeAreRefused) {
    for (const glm::uvec2 block : {glm::uvec2(1, 8), glm::uvec2(8, 33), glm::uvec2(0, 0)})
        expect_error(
            [&] {
                Cubes(device(), {{0, 1, 16, glm::vec3(0), glm::vec3(1), 0}}, Sampling::centre,
                      {Traversal::two_level, block});
            },
            {"--block", "2 to 32"});
}

TEST_F(TraversalTest, DepthsOf16BitsAreHalfFloatsOfTheImagesDepth) {
    const Geometry geometry = flatten(load_scene("builtin:blob:2000"));
    CubeLayout layout{Traversal::two_level};
    TracedBody full(device(), geometry, 256, HitTest::tolerance, layout);
    layout.half_depth = true;
    TracedBody half(device(), geometry, 256, HitTest::tolerance, layout);
    const std::vector<PixelSample> a = download_samples(full), b = download_samples(half);
    ASSERT_EQ(a.size(), b.size());
    double most = 0;
    size_t changed = 0;
    for (size_t i = 0; i < a.size(); i++) {
        // Lists may change their order where depths become equal: compared by what each list holds, the i-th with the
        // i-th.
        const double depth = full.grid().dims[int(a[i].axis)];
        most = std::max(most, std::abs(a[i].w - b[i].w) / depth);
        changed += a[i].w != b[i].w;
        ASSERT_EQ(a[i].pixel, b[i].pixel);
    }
    EXPECT_LE(most, std::pow(2.0, -12)) << "half a step of a half float below 1";
    EXPECT_GT(most, std::pow(2.0, -14));
    EXPECT_GT(changed, a.size() / 2);
}

}  // namespace
}  // namespace peelray
