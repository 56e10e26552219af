// Many bodies placed in the world: the hierarchy over their boxes, and rays in them against the oracle.
#include <glm/gtc/matrix_transform.hpp>

#include "../gpu/device_fixture.h"
#include "builtin/shapes.h"
#include "effort.h"
#include "ldc/cube_builder.h"
#include "ldc/trace_params.h"
#include "ldc/tracer.h"
#include "ray_sets.h"
#include "reference/oracle.h"

namespace peelray {
namespace {

using glm::vec3;

class InstancesTest : public DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        add(sphere({0, 0, 0}, 1, 6));
        add(torus({0.5f, 2, 0}, 1, 0.3f, 24, 12));  // far from its own origin
        add(box({-1, -0.2f, -1}, {1, 0.2f, 1}));
    }
    void add(const Primitive& shape, bool bare = false) {
        const auto first = uint32_t(positions_.size());
        CubeBody body{uint32_t(triangles_.size()), uint32_t(shape.triangles.size()), 32, vec3(INFINITY),
                      vec3(-INFINITY)};
        for (const vec3& p : shape.positions) {
            body.lower = glm::min(body.lower, p);
            body.upper = glm::max(body.upper, p);
            positions_.push_back(p);
        }
        for (const glm::uvec3& t : shape.triangles) {
            triangles_.push_back(t + first);
            ids_.push_back(uint32_t(triangles_.size()) - 1 - body.first_triangle);
        }
        body.bare = bare;
        bodies_.push_back(body);
    }
    /// Bodies 3, 4 and 5: a square across y, one triangle, and the four of a tetrahedron.
    void add_bare() {
        Primitive square, triangle, tetrahedron;
        square.positions = {{-2, -1, -2}, {2, -1, -2}, {2, -1, 2}, {-2, -1, 2}};
        square.triangles = {{0, 2, 1}, {0, 3, 2}};
        triangle.positions = {{3, 0.1f, 0}, {4, 1.2f, 0.3f}, {3.2f, 0.5f, 1.7f}};
        triangle.triangles = {{0, 1, 2}};
        tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        for (const Primitive& shape : {square, triangle, tetrahedron}) add(shape, true);
    }

    struct Placed {
        uint32_t body;
        glm::mat4 to_world;
    };
    /// Anywhere within `size`, turned, of different sizes, some squeezed or mirrored.
    std::vector<Placed> scatter(uint32_t count, float size, uint32_t seed) {
        std::mt19937 random(seed);
        const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
        std::vector<Placed> list;
        for (uint32_t i = 0; i < count; i++) {
            const vec3 at = size * (vec3(unit(), unit(), unit()) - 0.5f);
            const glm::quat turn =
                glm::normalize(glm::quat(unit() - 0.5f, unit() - 0.5f, unit() - 0.5f, unit() - 0.5f));
            vec3 scale(0.3f + 0.7f * unit());
            if (i % 3 == 1) scale *= vec3(0.4f + unit(), 1, 0.3f + unit());
            if (i % 5 == 2) scale.x = -scale.x;
            list.push_back({i % 3, glm::scale(glm::translate(glm::mat4(1), at) * glm::mat4_cast(turn), scale)});
        }
        return list;
    }

    /// The cubes and the placed instances on the device.
    struct World {
        TriangleBuffers triangles;
        Cubes cubes;
        CubeBuilder builder;
        Instances instances;
        TracedScene traced() const { return {cubes, instances, triangles}; }

        World(InstancesTest& test, Sampling sampling, const std::vector<InstanceInfo>& infos)
            : triangles(device(), test.positions_, test.triangles_),
              cubes(device(), test.bodies_, sampling),
              builder(device(), test.commands(), cubes, 0, uint32_t(test.bodies_.size())),
              instances(device(), infos) {
            builder.build(test.commands(), triangles);
        }
    };
    std::unique_ptr<World> place(const std::vector<Placed>& placed, Sampling sampling = Sampling::conservative) {
        std::vector<InstanceInfo> infos;
        uint32_t first = 0;
        for (const Placed& p : placed) {
            infos.push_back({p.body, first, 0});
            first += bodies_[p.body].triangles;
        }
        auto world = std::make_unique<World>(*this, sampling, infos);
        move(*world, placed);
        return world;
    }
    void move(World& world, const std::vector<Placed>& placed) {
        std::vector<GpuTransform> transforms;
        for (const Placed& p : placed) transforms.push_back({glm::mat3(p.to_world), vec3(p.to_world[3])});
        world.instances.place(commands(), std::span<const GpuTransform>(transforms));
        world.instances.record(commands(), world.cubes.table);
        commands().submit();
    }

    /// All placed triangles in the world, as a file would have them.
    Geometry flat(const std::vector<Placed>& placed) const {
        Geometry g;
        g.lower = vec3(INFINITY);
        g.upper = vec3(-INFINITY);
        for (const Placed& p : placed) {
            const bool mirrored = glm::determinant(p.to_world) < 0;
            const CubeBody& body = bodies_[p.body];
            for (uint32_t t = body.first_triangle; t < body.first_triangle + body.triangles; t++) {
                glm::uvec3 corners = triangles_[t];
                if (mirrored) std::swap(corners.y, corners.z);
                const auto first = uint32_t(g.positions.size());
                for (int k = 0; k < 3; k++) {
                    const vec3 at = vec3(p.to_world * glm::vec4(positions_[corners[k]], 1));
                    g.positions.push_back(at);
                    g.lower = glm::min(g.lower, at);
                    g.upper = glm::max(g.upper, at);
                }
                g.triangles.push_back({first, first + 1, first + 2});
            }
        }
        return g;
    }

    std::vector<FileHit> trace(World& world, const std::vector<Ray>& rays, bool any_hit = false,
                               const std::vector<SurfaceId>& skip = {}) {
        return trace(world, rays, {HitTest::exact, 0, any_hit}, skip);
    }
    std::vector<FileHit> trace(World& world, const std::vector<Ray>& rays, const TraceOptions& options,
                               const std::vector<SurfaceId>& skip = {}) {
        const Buffer ray_buffer = upload(rays), ids = upload(ids_), hits(device(), "hits", rays.size() * sizeof(Hit)),
                     file_hits(device(), "file hits", rays.size() * sizeof(FileHit));
        Buffer skip_buffer;
        if (!skip.empty()) skip_buffer = upload(skip);
        record_trace(commands(), device(), world.traced(),
                     {ray_buffer, skip.empty() ? nullptr : &skip_buffer, uint32_t(rays.size())}, hits, options);
        record_file_hits(commands(), device(), world.instances, ids, hits, uint32_t(rays.size()), file_hits);
        commands().submit();
        return download<FileHit>(file_hits, rays.size());
    }

    /// Does the ray lie in the triangle's plane as far as placing its corners in single precision tells? The oracle's
    /// triangles are rounded in the world, those of the cubes are not: that turns a plane by the rounding over the
    /// size.
    static bool in_the_plane(const Geometry& g, const Ray& ray, uint32_t triangle) {
        if (triangle == ~0u) return false;
        const glm::uvec3 t = g.triangles[triangle];
        const glm::dvec3 a = g.positions[t.x], b = g.positions[t.y], c = g.positions[t.z];
        const glm::dvec3 cross = glm::cross(b - a, c - a),
                         reach = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
        const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        const double height = glm::length(cross) / longest;
        const double slope = std::abs(glm::dot(glm::normalize(cross), glm::normalize(glm::dvec3(ray.direction))));
        return slope < 1e-6 * std::max({reach.x, reach.y, reach.z}) / height;
    }

    /// Rays of all kinds have right answers, weights and any-hit answers included.
    void expect_right(World& world, const Geometry& geometry, size_t rays_per_kind) {
        const Oracle oracle(geometry);
        size_t hit = 0;
        for (test::RayKind kind : {test::RayKind::uniform, test::RayKind::grazing, test::RayKind::axis_parallel}) {
            test::RaySource source(geometry, 77);
            std::vector<Ray> rays(rays_per_kind);
            for (Ray& ray : rays) ray = source.make(kind);
            const auto hits = trace(world, rays), any = trace(world, rays, true);
            size_t wrong = 0, wrong_any = 0;
            for (size_t i = 0; i < rays.size(); i++) {
                const test::RayKind grazing = test::RayKind::grazing;
                const bool is_wrong =
                    oracle.check(test::oracle_ray(rays[i]), hits[i].t, hits[i].triangle) == Verdict::wrong;
                wrong += is_wrong && !(kind == grazing && in_the_plane(geometry, rays[i], hits[i].triangle));
                wrong_any += oracle.check_any(test::oracle_ray(rays[i]), any[i].triangle != ~0u) == Verdict::wrong;
                if (hits[i].triangle == ~0u) continue;
                hit++;
                if (kind == grazing) continue;  // along the surface any error is large
                const glm::uvec3 t = geometry.triangles[hits[i].triangle];
                const vec3 p = geometry.positions[t.x] * (1 - hits[i].u - hits[i].v) +
                               geometry.positions[t.y] * hits[i].u + geometry.positions[t.z] * hits[i].v;
                const float diagonal = glm::length(geometry.upper - geometry.lower);
                ASSERT_LT(glm::length(p - (rays[i].origin + hits[i].t * rays[i].direction)), 2e-5f * diagonal);
            }
            EXPECT_EQ(wrong, 0u) << test::name_of(kind);
            EXPECT_EQ(wrong_any, 0u) << test::name_of(kind);
        }
        EXPECT_GT(hit, rays_per_kind / 20) << "rays that hit nothing prove nothing";
    }

    /// Every instance is one leaf; every box holds those below it.
    void expect_hierarchy(const World& world, uint32_t empty = 0) {
        const PeelrayTree& tree = world.instances.tree();
        std::vector<uint32_t> counts;
        uint32_t count = (tree.instances + 7) / 8 * 8;
        for (uint32_t level = 0; level < tree.levels; level++) {
            counts.push_back(count);
            count = (count / 8 + 7) / 8 * 8;
        }
        ASSERT_EQ(counts.back(), 8u);
        const auto boxes = download<PeelrayBox>(world.instances.boxes(), tree.first[tree.levels - 1] + 8);
        std::vector<int> seen(tree.instances);
        uint32_t nothing = 0;
        for (uint32_t i = 0; i < counts[0]; i++) {
            const bool is_box = boxes[i].lower.x <= boxes[i].upper.x;
            nothing += !is_box;
            if (is_box) seen[boxes[i].instance]++;
        }
        EXPECT_EQ(nothing, counts[0] - tree.instances + empty);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), ptrdiff_t(tree.instances - empty));
        for (uint32_t level = 1; level < tree.levels; level++)
            for (uint32_t i = 0; i < counts[level - 1]; i++) {
                const PeelrayBox &child = boxes[tree.first[level - 1] + i], &parent = boxes[tree.first[level] + i / 8];
                if (!(child.lower.x <= child.upper.x)) continue;
                ASSERT_TRUE(glm::all(glm::lessThanEqual(parent.lower, child.lower)) &&
                            glm::all(glm::greaterThanEqual(parent.upper, child.upper)));
            }
    }

    std::vector<vec3> positions_;
    std::vector<glm::uvec3> triangles_;
    std::vector<uint32_t> ids_;
    std::vector<CubeBody> bodies_;
};

TEST_F(InstancesTest, OfAnyNumberAreFoundByRays) {
    using Counts = std::vector<uint32_t>;
    for (const uint32_t count :
         test::effort(Counts{1, 8, 9, 64, 65, 1025}, Counts{1, 2, 7, 8, 9, 64, 65, 500, 1024, 1025, 3000})) {
        SCOPED_TRACE(count);
        const auto placed = scatter(count, 3 * std::cbrt(float(count)), count);
        const auto world = place(placed);
        expect_hierarchy(*world);
        expect_right(*world, flat(placed), test::effort(800, 4000));
    }
}

TEST_F(InstancesTest, OfBareBodiesAreFoundByRaysAndHaveNoCube) {
    add_bare();
    const glm::mat4 still(1), aside = glm::translate(still, vec3(3, 0.5f, -1));
    const glm::mat4 turned = glm::rotate(aside, 0.7f, glm::normalize(vec3(1, 2, 3)));
    // Alone, with one cube and with several, before and behind them, moved and not; more than eight have a hierarchy.
    const std::vector<std::vector<Placed>> scenes = {{{3, still}},
                                                     {{5, turned}},
                                                     {{0, still}, {3, still}},
                                                     {{3, still}, {4, still}, {0, aside}, {2, still}, {5, turned}},
                                                     {{4, turned}, {3, turned}, {5, still}, {4, still}},
                                                     scatter(60, 9, 4)};
    for (std::vector<Placed> placed : scenes) {
        SCOPED_TRACE(testing::Message() << placed.size() << " instances");
        if (placed.size() > 8)
            for (size_t i = 0; i < placed.size(); i += 2) placed[i].body = 3 + uint32_t(i / 2 % 3);
        const auto world = place(placed);
        expect_hierarchy(*world);
        expect_right(*world, flat(placed), test::effort(800, 4000));
    }
    // As much is built as without them.
    const auto with = place({{0, still}}), boxed = [&] {
        for (CubeBody& body : bodies_) body.bare = false;
        return place({{0, still}});
    }();
    bodies_.resize(3);
    const auto without = place({{0, still}});
    EXPECT_EQ(with->builder.counts().fragments, without->builder.counts().fragments);
    EXPECT_EQ(with->builder.counts().cells, without->builder.counts().cells);
    EXPECT_GT(boxed->builder.counts().fragments, without->builder.counts().fragments);
}

TEST_F(InstancesTest, OneCubeThatStandsNowhereBesideABareBodyIsNotWalkedThrough) {
    add_bare();
    const auto world = place({{3, glm::mat4(1)}, {0, glm::scale(glm::mat4(1), vec3(NAN))}});
    test::RaySource source(flat({{3, glm::mat4(1)}}), 3);
    std::vector<Ray> rays(2000);
    for (Ray& ray : rays) ray = source.make(test::RayKind::uniform);
    rays.push_back({{0.5f, 4, 0.2f}, 0, {0, -1, 0}, INFINITY});
    const auto hits = trace(*world, rays);
    for (const FileHit& hit : hits) EXPECT_TRUE(hit.triangle == ~0u || hit.triangle < 2u) << hit.triangle;
    EXPECT_LT(hits.back().triangle, 2u);
}

TEST_F(InstancesTest, RaysThatLeaveABareBodyDoNotMeetItAgain) {
    add_bare();
    const auto world = place({{3, glm::mat4(1)}, {0, glm::mat4(1)}});
    const vec3 on_it(1.7f, -1, 0.4f);
    const std::vector<Ray> rays = {
        {on_it, 0, {0, 1, 0}, INFINITY},            // along the normal
        {on_it, 0, {0.3f, 1e-6f, 0.2f}, INFINITY},  // nearly in its plane
        {on_it, 1e-3f, {0, -1, 0}, INFINITY},      {{1.7f, 4, 0.4f}, 0, {0, -1, 0}, INFINITY},
        {{1.7f, 4, 0.4f}, 0, {0, -1, 0}, 4.99f},   {{1.7f, 4e6f, 0.4f}, 0, {0, -1, 0}, INFINITY},  // from far away
        {{0, 4, 0}, 0, {0, -1, 0}, INFINITY}};  // the sphere is before it
    std::vector<SurfaceId> skip(rays.size(), {~0u, ~0u});
    skip[0] = skip[1] = {0, bodies_[3].first_triangle};
    const auto hits = trace(*world, rays, false, skip);
    for (const size_t missing : {0, 1, 2, 4}) EXPECT_EQ(hits[missing].triangle, ~0u) << missing;
    for (const size_t found : {3, 5}) EXPECT_LT(hits[found].triangle, 2u) << found;
    EXPECT_FLOAT_EQ(hits[3].t, 5);
    EXPECT_FLOAT_EQ(hits[5].t, 4e6f + 1);
    EXPECT_GE(hits[6].triangle, 2u);
}

TEST_F(InstancesTest, BoxesHoldTheirBodies) {
    const auto placed = scatter(100, 20, 3);
    const auto world = place(placed);
    const auto boxes = download<PeelrayBox>(world->instances.boxes(), 104);
    for (const PeelrayBox& box : boxes) {
        if (!(box.lower.x <= box.upper.x)) continue;
        const Geometry g = flat({placed[box.instance]});
        EXPECT_TRUE(glm::all(glm::lessThan(box.lower, g.lower)) && glm::all(glm::greaterThan(box.upper, g.upper)));
    }
}

TEST_F(InstancesTest, InOnePlaceAreFoundToo) {
    // Hundreds of boxes with one middle: no order, and every ray meets all of them.
    for (const uint32_t count : {30u, 1500u}) {
        auto placed = scatter(count, 0, 5);
        const auto world = place(placed);
        expect_hierarchy(*world);
        expect_right(*world, flat(placed), test::effort(100, 500));
    }
}

TEST_F(InstancesTest, FarAwayAndVeryLargeOrSmallStayExact) {
    for (const auto& [scale, shift] :
         {std::pair(1e-4f, vec3(0)), std::pair(1e5f, vec3(0)), std::pair(1.f, vec3(20, -30, 40))}) {
        SCOPED_TRACE(scale);
        auto placed = scatter(40, 8, 9);
        for (Placed& p : placed)
            p.to_world = glm::translate(glm::mat4(1), shift) * glm::scale(glm::mat4(1), vec3(scale)) * p.to_world;
        expect_right(*place(placed), flat(placed), 4000);
    }
}

TEST_F(InstancesTest, MoveWithTheirTransforms) {
    auto placed = scatter(200, 15, 1);
    const auto world = place(placed);
    for (uint32_t seed = 2; seed < 5; seed++) {
        const auto next = scatter(200, 15 * float(seed), seed);
        move(*world, next);
        expect_hierarchy(*world);
        expect_right(*world, flat(next), 2000);
    }
    move(*world, placed);
    const auto again = place(placed);
    test::RaySource source(flat(placed), 3);
    std::vector<Ray> rays(5000);
    for (Ray& ray : rays) ray = source.make(test::RayKind::uniform);
    const auto a = trace(*world, rays), b = trace(*again, rays);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(FileHit)), 0) << "nothing is left of what was before";
}

TEST_F(InstancesTest, TolerancesAreOfTheWorldUnderScalesAndMirrors) {
    // A sphere of radius 1 at several sizes: a tolerance of the world is another one in each, and along each axis.
    const float tolerance = 0.09f;
    bodies_[0].tolerance = tolerance;
    const std::vector<Placed> placed = {
        {0, glm::scale(glm::mat4(1), {3, 1, 1.5f})},
        {0, glm::scale(glm::translate(glm::mat4(1), {0, 5, 0}), {-2, 1, 1})},
        {0, glm::scale(glm::rotate(glm::translate(glm::mat4(1), {0, -5, 0}), 0.7f, vec3(0, 0, 1)), {1, 1, 2})}};
    const auto fuzzy = place(placed, Sampling::centre), exact = place(placed);
    std::vector<Ray> rays;
    std::mt19937 random(3);
    const auto unit = [&] { return float(random() >> 8) / 8388608.0f - 1; };
    for (int i = 0; i < 20000; i++) {
        const vec3 to = vec3(0, 5 * float(i % 3 - 1), 0) + 0.6f * vec3(unit(), unit(), unit());
        const vec3 from = to + 9.0f * glm::normalize(vec3(unit(), unit(), unit()) + 1e-3f);
        rays.push_back({from, 0, glm::normalize(to - from), 100});
    }
    const auto expected = trace(*exact, rays);
    const auto hits = trace(*fuzzy, rays, {HitTest::tolerance, tolerance});
    size_t lost = 0, far = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        ASSERT_NE(expected[i].triangle, ~0u);
        lost += hits[i].triangle == ~0u || hits[i].t > expected[i].t + 0.5f;
        far += hits[i].triangle != ~0u && hits[i].t < expected[i].t - 1.2f;
    }
    fmt::print("  {} lost, {} far before their surface of {}\n", lost, far, rays.size());
    EXPECT_LT(lost, rays.size() / 50);
    EXPECT_LT(far, rays.size() / 200);
}

TEST_F(InstancesTest, OfTheSameBodySkipTheirOwnTriangleOnly) {
    const std::vector<Placed> placed = {{0, glm::mat4(1)}, {0, glm::translate(glm::mat4(1), vec3(0, 0, 5))}};
    const auto world = place(placed);
    const std::vector<Ray> rays(3, Ray{{0.1f, 0.2f, -4}, 0, {0, 0, 1}, INFINITY});
    const auto first = trace(*world, rays);
    const uint32_t own = first[0].triangle;
    ASSERT_LT(own, bodies_[0].triangles);
    const auto hits = trace(*world, rays, false, {{~0u, ~0u}, {0, own}, {1, own}});
    EXPECT_EQ(hits[0].t, first[0].t);
    EXPECT_GT(hits[1].t, first[0].t);
    EXPECT_EQ(hits[2].t, first[0].t) << "the other instance's triangle of that number";
}

TEST_F(InstancesTest, WithImpossibleTransformsAreNowhere) {
    const float nan = std::nanf("");
    auto placed = scatter(30, 8, 2);
    const Geometry without = flat({placed.begin() + 4, placed.end()});
    uint32_t before = 0;
    for (int i = 0; i < 4; i++) before += bodies_[placed[size_t(i)].body].triangles;
    placed[0].to_world[3][1] = nan;
    placed[1].to_world[0][0] = nan;
    placed[2].to_world[3][2] = INFINITY;
    placed[3].to_world = glm::scale(glm::mat4(1), vec3(0));
    placed[3].to_world[3] = {100, 0, 0, 1};  // nothing is left of it, and nothing hits it
    const auto world = place(placed);
    expect_hierarchy(*world, 3);
    const Oracle oracle(without);
    test::RaySource source(without, 8);
    std::vector<Ray> rays(4000);
    for (Ray& ray : rays) ray = source.make(test::RayKind::uniform);
    const auto hits = trace(*world, rays);
    size_t wrong = 0;
    for (size_t i = 0; i < rays.size(); i++)
        wrong += oracle.check(test::oracle_ray(rays[i]), hits[i].t,
                              hits[i].triangle == ~0u ? ~0u : hits[i].triangle - before) == Verdict::wrong;
    EXPECT_EQ(wrong, 0u);
}

TEST_F(InstancesTest, AreBounded) {
    expect_error([&] { Instances(device(), std::vector<InstanceInfo>((1u << 24) + 1)); }, {"16777217", "2^24"});
}

}  // namespace
}  // namespace peelray
