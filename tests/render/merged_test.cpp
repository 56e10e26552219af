// Small bodies whose copies share a cube: rays find what they find in cubes of their own.
#include <pictures.h>

#include <glm/gtc/matrix_transform.hpp>

#include "../ldc/ray_sets.h"
#include "builtin/builtin.h"
#include "common/ray.h"
#include "motion/simulation.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

using glm::vec3;

constexpr uint32_t kAll = 1000;

/// 64 bodies in flight over a floor, a mirror and two balls.
class MergedTest : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        scene_ = make_builtin("particles:64");
        pose(1.5);
    }
    void pose(double time) {
        moment_ = moment_of(scene_, "0", time);
        Simulation().place(scene_, moment_);
        assembly_ = assemble(scene_, moment_, motion_of(scene_, "0"));
        geometry_ = flatten(scene_, moment_);
    }
    std::unique_ptr<RayScene> traced(uint32_t merge, bool rebuild = false) {
        TracerChoice choice;
        choice.cubes.merge = merge;
        choice.rebuild = rebuild;
        return std::make_unique<RayScene>(device(), scene_, moment_, assembly_, choice);
    }
    SceneCubes::Stats stats(uint32_t merge) { return traced(merge)->stats(commands()).cubes; }

    std::vector<Ray> rays(size_t count) const {
        std::vector<Ray> rays;
        test::RaySource source(geometry_, 5);
        for (size_t i = 0; i < count; i++) rays.push_back(source.make(test::RayKind(i % 4)));
        // A fourth aims at the bodies in flight, which are small.
        for (size_t i = 0; i < count; i += 4) {
            const Geometry::Object& object = geometry_.objects[4 + i / 4 % 64];
            const glm::uvec3 t = geometry_.triangles[object.first + i % object.count];
            const vec3 at = (geometry_.positions[t.x] + geometry_.positions[t.y] + geometry_.positions[t.z]) / 3.0f;
            rays[i].direction = at - rays[i].origin;
            rays[i].tmin = 0;
            rays[i].tmax = 1e30f;
        }
        return rays;
    }
    std::vector<FileHit> trace(RayScene& in, const std::vector<Ray>& rays, bool any_hit) {
        const Buffer ray_buffer = upload<Ray>(rays), hits(device(), "hits", rays.size() * sizeof(FileHit));
        in.record(commands(), ray_buffer, uint32_t(rays.size()), hits, any_hit);
        commands().submit();
        return download<FileHit>(hits, rays.size());
    }
    /// With the instances; `skip`: of each ray, or empty.
    std::vector<Hit> hits_of(RayScene& in, const std::vector<Ray>& rays, const std::vector<SurfaceId>& skip) {
        const Buffer ray_buffer = upload<Ray>(rays), hits(device(), "hits", rays.size() * sizeof(Hit));
        const Buffer skip_buffer = skip.empty() ? Buffer() : upload<SurfaceId>(skip);
        in.record_hits(commands(), {ray_buffer, skip.empty() ? nullptr : &skip_buffer, uint32_t(rays.size())}, hits,
                       false, Edges::precise);
        commands().submit();
        return download<Hit>(hits, rays.size());
    }

    Scene scene_;
    Moment moment_;
    Assembly assembly_;
    Geometry geometry_;
};

TEST_F(MergedTest, SmallInstancesAreMerged) {
    EXPECT_EQ(stats(kAll).merged, 64u);
    EXPECT_EQ(stats(kAll).merged_triangles, 16u * (300 + 32 * 2 / 2 + 324 + 12)) << "pearls, gems, rings, cubes";
    EXPECT_EQ(stats(12).merged, 16u) << "the cubes alone";
    EXPECT_EQ(stats(11).merged, 0u);
    EXPECT_EQ(stats(0).merged, 0u);
    scene_ = make_builtin("particles:8");
    pose(1.5);
    EXPECT_EQ(stats(kAll).merged, 0u) << "so few need no stack anyway";
}

TEST_F(MergedTest, RaysFindWhatTheOracleFinds) {
    const Oracle oracle(geometry_);
    const std::vector<Ray> list = rays(8000);
    for (const bool rebuild : {false, true}) {
        const auto scene = traced(kAll, rebuild);
        const std::vector<FileHit> nearest = trace(*scene, list, false), any = trace(*scene, list, true);
        size_t wrong = 0, wrong_any = 0, flying = 0;
        for (size_t i = 0; i < list.size(); i++) {
            const OracleRay ray = test::oracle_ray(list[i]);
            wrong += oracle.check(ray, nearest[i].t, nearest[i].triangle) == Verdict::wrong;
            wrong_any += oracle.check_any(ray, any[i].triangle != ~0u) == Verdict::wrong;
            flying += nearest[i].triangle != ~0u && nearest[i].triangle >= geometry_.objects[4].first;
        }
        EXPECT_EQ(wrong, 0u);
        EXPECT_EQ(wrong_any, 0u);
        EXPECT_GT(flying, 1500u) << "of bodies that are merged";
    }
}

TEST_F(MergedTest, HitsTellTheirInstanceAndSkipIt) {
    const auto merged = traced(kAll), apart = traced(0);
    std::vector<Ray> list;
    const std::vector<Ray> all = rays(16'000);
    for (size_t i = 0; i < all.size(); i += 4) list.push_back(all[i]);
    const std::vector<Hit> first = hits_of(*merged, list, {});
    std::vector<SurfaceId> skip;
    for (const Hit& hit : first) {
        skip.push_back({hit.instance, hit.triangle});
        if (hit.triangle == ~0u) continue;
        ASSERT_LT(hit.instance, assembly_.instances.size());
        const Assembly::Body& body = assembly_.bodies[assembly_.instances[hit.instance].body];
        ASSERT_GE(hit.triangle, body.first_triangle);
        ASSERT_LT(hit.triangle, body.first_triangle + body.triangles);
    }
    const std::vector<Hit> second = hits_of(*merged, list, skip), expected = hits_of(*apart, list, skip);
    size_t same = 0, behind = 0;
    for (size_t i = 0; i < list.size(); i++) {
        if (second[i].triangle != ~0u) {
            EXPECT_FALSE(second[i].triangle == skip[i].triangle && second[i].instance == skip[i].instance) << i;
            behind += second[i].t > first[i].t;
        }
        same += second[i].triangle == expected[i].triangle &&
                (second[i].triangle == ~0u || second[i].instance == expected[i].instance);
    }
    EXPECT_GT(behind, 1000u);
    EXPECT_GE(same, list.size() * 995 / 1000) << "but for edges, and for surfaces that rays graze";
}

TEST_F(MergedTest, MirroredInstancesStayApart) {
    SceneBuilder build("still");
    const uint32_t red = build.material(matte("red", {1, 0, 0}));
    const Primitive shape = sphere({0, 0, 0}, 0.4f, 8);
    const int first = build.add("ball", shape, red), mesh = build.mesh_of(first);
    for (int i = 1; i < 30; i++)
        build.again("ball", mesh,
                    glm::scale(glm::translate(glm::mat4(1), vec3(i % 6, i / 6, 0)), vec3(i % 3 == 0 ? -1 : 1, 1, 1)));
    scene_ = build.take();
    moment_ = at_rest(scene_);
    assembly_ = assemble(scene_, moment_, motion_of(scene_, ""));
    geometry_ = flatten(scene_, moment_);
    const auto scene = traced(kAll);
    const SceneCubes::Stats stats = scene->stats(commands()).cubes;
    EXPECT_EQ(stats.merged, 21u);
    EXPECT_EQ(stats.fixed, stats.bodies) << "nothing moves: the copies' cube is built once";
    const Oracle oracle(geometry_);
    std::vector<Ray> list;
    test::RaySource source(geometry_, 9);
    for (size_t i = 0; i < 4000; i++) list.push_back(source.make(test::RayKind::uniform));
    const std::vector<FileHit> hits = trace(*scene, list, false);
    for (size_t i = 0; i < list.size(); i++)
        ASSERT_NE(oracle.check(test::oracle_ray(list[i]), hits[i].t, hits[i].triangle), Verdict::wrong) << i;
}

/// Share of the pixels that two pictures do not agree on.
double differing(const RenderResult& a, const RenderResult& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.radiance.size(); i++)
        count +=
            glm::length(vec3(a.radiance[i]) - vec3(b.radiance[i])) > 0.02f * (1 + glm::length(vec3(a.radiance[i])));
    return double(count) / double(a.radiance.size());
}

/// Holes, single sides, glass in glass, and everything elsewhere a moment later.
TEST_F(MergedTest, PicturesAreTheSameWhateverTheMaterials) {
    scene_.textures.push_back(pattern());
    for (Material& material : scene_.materials) {
        if (material.name == "red") {
            material.alpha_cutoff = 0.5f;
            material.base_color_texture = int(scene_.textures.size()) - 1;
        }
        if (material.name == "emerald") material.double_sided = false;
        if (material.name == "gold") material = glass("gold", {1, 0.8f, 0.4f}, 1, 0.1f);
    }
    RenderSettings s = settings_for(scene_.cameras.at(0), 96);
    s.cubes.ldc = 0;
    s.shadow = true;
    s.spp = 4;
    const Environment sky = color_environment(vec3(0.5f, 0.7f, 1));
    Light lamp;
    lamp.kind = Light::Kind::point;
    lamp.position = {2, 4, 3};
    lamp.color = vec3(60);
    scene_.lights.push_back(lamp);
    pose(1.2);
    std::vector<RenderResult> apart, merged;
    for (const uint32_t merge : {0u, kAll}) {
        s.cubes.merge = merge;
        Renderer renderer(device(), scene_, moment_, assembly_, sky);
        for (const double time : {1.2, 2.9}) {
            renderer.pose(moment_of(scene_, "0", time));
            (merge == 0 ? apart : merged).push_back(renderer.render(s));
        }
    }
    for (size_t i = 0; i < apart.size(); i++) {
        EXPECT_EQ(apart[i].stats.cubes.merged, 0u);
        EXPECT_EQ(merged[i].stats.cubes.merged, 64u);
        EXPECT_LE(differing(apart[i], merged[i]), 0.004) << i;
    }
    EXPECT_GE(differing(merged[0], merged[1]), 0.02) << "they have moved";
}

}  // namespace
}  // namespace peelray
