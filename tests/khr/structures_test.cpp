// Rays with a known answer in a few squares: what counts as a hit, and structures that follow what moves.
#include <cmath>

#include "common/ray.h"
#include "khr/tracer.h"
#include "khr_fixture.h"
#include "single_cube.h"

namespace peelray {
namespace {

using glm::vec3;
constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

class StructuresTest : public KhrTest {
  protected:
    /// Squares across z, of two triangles each: at z = 1, 2, 2 again, and 3.
    std::vector<vec3> positions_;
    std::vector<glm::uvec3> triangles_;
    std::unique_ptr<test::SingleCube> body_;
    std::unique_ptr<Structures> structures_;

    void SetUp() override {
        KhrTest::SetUp();
        for (const float z : {1.f, 2.f, 2.f, 3.f}) {
            const auto first = uint32_t(positions_.size());
            for (const vec3& p : {vec3(-1, -1, z), vec3(1, -1, z), vec3(1, 1, z), vec3(-1, 1, z)})
                positions_.push_back(p);
            triangles_.push_back({first, first + 1, first + 2});
            triangles_.push_back({first, first + 2, first + 3});
        }
    }
    void build(StructureUpdate update) {
        body_ = std::make_unique<test::SingleCube>(device(), commands(), positions_, triangles_, vec3(-1, -1, 1),
                                                   vec3(1, 1, 3), 16, Sampling::conservative);
        StructureBody body;
        // In two parts: hits must be counted over both.
        body.parts = {{0, 3, true}, {3, uint32_t(triangles_.size()) - 3, true}};
        body.last_vertex = uint32_t(positions_.size()) - 1;
        body.update = update;
        structures_ = std::make_unique<Structures>(device(), body_->triangles, body_->instances, std::vector{body});
        structures_->build_kept(commands(), [] {});
        structures_->record(commands(), true);
        commands().submit();
    }
    std::vector<Hit> trace(const std::vector<Ray>& rays, const std::vector<SurfaceId>& skip = {},
                           bool any_hit = false) {
        const Buffer ray_buffer = upload(rays), hits(device(), "hits", rays.size() * sizeof(Hit));
        Buffer skip_buffer;
        if (!skip.empty()) skip_buffer = upload(skip);
        record_khr_trace(commands(), device(), *structures_, body_->triangles,
                         {ray_buffer, skip.empty() ? nullptr : &skip_buffer, uint32_t(rays.size())}, hits, any_hit);
        commands().submit();
        return download<Hit>(hits, rays.size());
    }
    static void expect_miss(const Hit& hit) {
        EXPECT_EQ(hit.t, kInfinity);
        EXPECT_EQ(hit.triangle, NO_TRIANGLE);
        EXPECT_EQ(hit.instance, NO_TRIANGLE);
    }
    static void expect_hit(const Hit& hit, float t, uint32_t triangle) {
        EXPECT_NEAR(hit.t, t, 1e-5f * std::abs(t));
        EXPECT_EQ(hit.triangle, triangle);
        EXPECT_EQ(hit.instance, 0u);
    }
};

TEST_F(StructuresTest, HitsTellTriangleDistanceAndWeights) {
    build(StructureUpdate::keep);
    const auto hits = trace({{{0.5f, -0.5f, 0}, 0, {0, 0, 1}, kInfinity},
                             {{-0.5f, 0.5f, 0}, 0, {0, 0, 1e-20f}, kInfinity},
                             {{-0.5f, 0.5f, 4}, 0, {0, 0, -1e20f}, kInfinity},
                             {{2, 0, 0}, 0, {0, 0, 1}, kInfinity}});
    expect_hit(hits[0], 1, 0);
    EXPECT_NEAR(hits[0].u, 0.5f, 1e-6f);
    EXPECT_NEAR(hits[0].v, 0.25f, 1e-6f);
    expect_hit(hits[1], 1e20f, 1);
    expect_hit(hits[2], 1e-20f, 7);
    expect_miss(hits[3]);
}

TEST_F(StructuresTest, OnlyWhatLiesBetweenTheEndsCounts) {
    build(StructureUpdate::keep);
    const vec3 o(0.5f, -0.5f, 0), d(0, 0, 1);
    const auto hits = trace({{o, 1, d, kInfinity},
                             {o, 0, d, 1},
                             {o, 0, d, 1.001f},
                             {o, 1, d, 2},
                             {o + 4.f * d, -4, d, kInfinity},
                             {o + 4.f * d, -2.5f, d, 0}});
    EXPECT_TRUE(hits[0].triangle == 2 || hits[0].triangle == 4) << hits[0].triangle;
    EXPECT_NEAR(hits[0].t, 2, 1e-5f);
    expect_miss(hits[1]);
    expect_hit(hits[2], 1, 0);
    expect_miss(hits[3]);
    expect_hit(hits[4], -3, 0);
    EXPECT_NEAR(hits[5].t, -2, 1e-5f);
}

TEST_F(StructuresTest, TheTriangleThatARayLeavesDoesNotCount) {
    build(StructureUpdate::keep);
    const vec3 o(0.5f, -0.5f, 0), d(0, 0, 1);
    const std::vector<Ray> rays = {{o, 0, d, kInfinity},
                                   {o, 1.5f, d, kInfinity},
                                   {o, 1.5f, d, kInfinity},
                                   {o, 2.5f, d, kInfinity},
                                   {o, 0, d, kInfinity}};
    // Another instance's triangle of that number is another triangle.
    const std::vector<SurfaceId> skip = {{0, 0}, {0, 2}, {0, 4}, {0, 6}, {1, 0}};
    const auto hits = trace(rays, skip);
    EXPECT_NEAR(hits[0].t, 2, 1e-5f);
    // Of two in one place the other one is met.
    expect_hit(hits[1], 2, 4);
    expect_hit(hits[2], 2, 2);
    expect_miss(hits[3]);
    expect_hit(hits[4], 1, 0);
    const auto any = trace(rays, skip, true);
    for (size_t i = 0; i < rays.size(); i++) {
        EXPECT_EQ(any[i].triangle == NO_TRIANGLE, hits[i].triangle == NO_TRIANGLE) << i;
        EXPECT_FALSE(any[i].instance == skip[i].instance && any[i].triangle == skip[i].triangle) << i;
    }
}

TEST_F(StructuresTest, RaysThatAreNoneMiss) {
    build(StructureUpdate::keep);
    const Ray good{{0.5f, -0.5f, 0}, 0, {0, 0, 1}, kInfinity};
    std::vector<Ray> rays;
    const auto with = [&](auto change) {
        rays.push_back(good);
        change(rays.back());
    };
    for (const float bad : {kNan, kInfinity, -kInfinity})
        for (int k = 0; k < 3; k++) {
            with([&](Ray& r) { r.origin[k] = bad; });
            with([&](Ray& r) { r.direction[k] = bad; });
        }
    with([](Ray& r) { r.direction = vec3(0); });
    with([](Ray& r) { r.tmin = kNan; });
    with([](Ray& r) { r.tmax = kNan; });
    with([](Ray& r) { r.tmin = r.tmax = 1; });
    with([](Ray& r) { r.tmin = 5, r.tmax = 0; });
    for (const bool any_hit : {false, true})
        for (const Hit& hit : trace(rays, {}, any_hit)) expect_miss(hit);
    expect_hit(trace({good})[0], 1, 0);
}

TEST_F(StructuresTest, FollowWhatChangesItsShape) {
    const Ray ray{{0.5f, -0.5f, 0}, 0, {0, 0, 1}, kInfinity};
    for (const StructureUpdate update : {StructureUpdate::rebuild, StructureUpdate::refit, StructureUpdate::keep}) {
        SCOPED_TRACE(name_of(update));
        build(update);
        expect_hit(trace({ray})[0], 1, 0);
        for (const float by : {0.25f, -0.5f}) {
            std::vector<vec3> moved = positions_;
            for (vec3& p : moved) p.z += by;
            commands().upload(body_->triangles.positions, std::span<const vec3>(moved));
            structures_->record(commands(), false);
            commands().submit();
            expect_hit(trace({ray})[0], update == StructureUpdate::keep ? 1 : 1 + by, 0);
        }
        const Structures::Stats stats = structures_->stats();
        EXPECT_EQ(stats.kept, update == StructureUpdate::keep ? 1u : 0u);
        EXPECT_GT(stats.bytes, 0u);
    }
}

TEST_F(StructuresTest, FollowInstancesThatMove) {
    build(StructureUpdate::keep);
    const Ray ray{{0.5f, -0.25f, 0}, 0, {0, 0, 1}, kInfinity};
    const auto place = [&](const GpuTransform& at) {
        body_->instances.place(commands(), std::span<const GpuTransform>(&at, 1));
        body_->instances.record(commands(), body_->cubes.table, false);
        structures_->record(commands(), true);
        commands().submit();
    };
    place({glm::mat3(2), vec3(0, 0, 5)});
    expect_hit(trace({ray})[0], 7, 0);
    glm::mat3 mirror(1);
    mirror[0][0] = -1;
    place({mirror, vec3(0)});
    expect_hit(trace({ray})[0], 1, 1);
    place({glm::mat3(0), vec3(0)});
    expect_miss(trace({ray})[0]);
    place({glm::mat3(1), vec3(kNan)});
    expect_miss(trace({ray})[0]);
}

}  // namespace
}  // namespace peelray
