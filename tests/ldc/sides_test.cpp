// Rays in scenes with single-sided materials: whatever builds the cubes and whatever walks them, no ray hits a back.
#include "../gpu/device_fixture.h"
#include "effort.h"
#include "ldc/trace_params.h"
#include "loaders/load.h"
#include "motion/motion.h"
#include "ray_sets.h"
#include "reference/oracle.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

using test::RayKind;

/// Holes, instances that a transform mirrors, and bodies without a cube (the floor).
class SidesOfCubesTest : public DeviceTest {
  protected:
    SidesOfCubesTest() : scene_(load_scene("builtin:leaves")), geometry_(flatten(scene_)) {
        // Every other material, so that both kinds lie in one cube.
        for (size_t i = 0; i < scene_.materials.size(); i += 2) scene_.materials[i].double_sided = false;
    }

    std::vector<FileHit> trace(RayScene& scene, const std::vector<Ray>& rays, bool any_hit) {
        const Buffer ray_buffer = upload(rays), hit_buffer(device(), "file hits", rays.size() * sizeof(FileHit));
        scene.record(commands(), ray_buffer, uint32_t(rays.size()), hit_buffer, any_hit);
        commands().submit();
        return download<FileHit>(hit_buffer, rays.size());
    }
    std::vector<Ray> rays_of(RayKind kind, size_t count) {
        test::RaySource source(geometry_, 99);
        std::vector<Ray> rays(count);
        for (Ray& ray : rays) ray = source.make(kind);
        return rays;
    }
    std::array<glm::vec3, 3> corners(uint32_t triangle) const {
        const glm::uvec3 t = geometry_.triangles[triangle];
        return {geometry_.positions[t.x], geometry_.positions[t.y], geometry_.positions[t.z]};
    }
    RayScene make(const CubeChoice& cubes) {
        const Moment rest = at_rest(scene_);
        TracerChoice choice;
        choice.cubes = cubes;
        return {device(), scene_, rest, assemble(scene_, rest, motion_of(scene_, "")), choice};
    }

    Scene scene_;
    const Geometry geometry_;
};

TEST_F(SidesOfCubesTest, ExactHitsAreTheOraclesWithEveryTraversal) {
    const AlphaTest alpha(scene_, geometry_);
    const Sidedness sides(scene_, geometry_);
    const Oracle oracle(geometry_, alpha, sides), both(geometry_, alpha);
    for (const Traversal traversal : {Traversal::voxel, Traversal::two_level, Traversal::mipmap})
        for (const Batch batch : {Batch::none, Batch::layers, Batch::rays}) {
            if (traversal == Traversal::voxel && batch != Batch::none) continue;
            // Every batch and every traversal; compiling them takes longer than the rays.
            if (test::effort(traversal == Traversal::mipmap && batch != Batch::none, false)) continue;
            CubeChoice cubes;
            cubes.layout.traversal = traversal;
            cubes.layout.batch = batch;
            RayScene scene = make(cubes);
            for (const RayKind kind : {RayKind::uniform, RayKind::on_surface}) {
                SCOPED_TRACE(fmt::format("{} {} {}", name_of(traversal), name_of(batch), test::name_of(kind)));
                const std::vector<Ray> rays = rays_of(kind, test::effort(1'000, 20'000));
                const auto hits = trace(scene, rays, false), any = trace(scene, rays, true);
                size_t wrong = 0, wrong_any = 0, through = 0;
                for (size_t i = 0; i < rays.size(); i++) {
                    const OracleRay ray = test::oracle_ray(rays[i]);
                    wrong += oracle.check(ray, hits[i].t, hits[i].triangle) == Verdict::wrong;
                    wrong_any += oracle.check_any(ray, any[i].triangle != ~0u) == Verdict::wrong;
                    through += both.closest(ray).triangle != oracle.closest(ray).triangle;
                }
                EXPECT_EQ(wrong, 0u);
                EXPECT_EQ(wrong_any, 0u);
                EXPECT_GT(through, rays.size() / 100) << "rays that meet no back prove nothing";
            }
        }
}

TEST_F(SidesOfCubesTest, NoHitTestOfAnyBuildersCubesHitsBacks) {
    struct Way {
        HitTest hit;
        BuilderKind builder;
        Traversal traversal;
    };
    const Sidedness sides(scene_, geometry_);
    for (const auto& [hit, builder, traversal] : {Way{HitTest::exact, BuilderKind::abuffer, Traversal::voxel},
                                                  Way{HitTest::planar, BuilderKind::compute, Traversal::voxel},
                                                  Way{HitTest::planar, BuilderKind::abuffer, Traversal::mipmap},
                                                  Way{HitTest::planar, BuilderKind::peel, Traversal::two_level},
                                                  Way{HitTest::tolerance, BuilderKind::compute, Traversal::voxel},
                                                  Way{HitTest::tolerance, BuilderKind::peel, Traversal::two_level}}) {
        SCOPED_TRACE(fmt::format("{} {} {}", name_of(hit), name_of(builder), name_of(traversal)));
        CubeChoice cubes;
        cubes.hit = hit;
        cubes.ldc = 128;
        cubes.tolerance = 0.02f;
        cubes.layout.builder = builder;
        cubes.layout.traversal = traversal;
        const std::vector<Ray> rays = rays_of(RayKind::uniform, test::effort(2'000, 20'000));
        RayScene single = make(cubes);
        const auto hits = trace(single, rays, false), any = trace(single, rays, true);
        Scene shown = scene_;
        show_both_sides(shown);
        std::swap(scene_, shown);
        RayScene both = make(cubes);
        std::swap(scene_, shown);
        const auto all = trace(both, rays, false);
        size_t backs = 0, changed = 0, found = 0, lost = 0, any_differs = 0;
        for (size_t i = 0; i < rays.size(); i++) {
            const auto is_hidden = [&](uint32_t triangle) {
                const glm::dvec3 direction(rays[i].direction);
                return triangle != ~0u && sides.is_single(triangle) && !comes_from_front(corners(triangle), direction);
            };
            backs += is_hidden(hits[i].triangle) + is_hidden(any[i].triangle);
            found += hits[i].triangle != ~0u;
            any_differs += (hits[i].triangle != ~0u) != (any[i].triangle != ~0u);
            // What is nearest and shown stays so.
            if (is_hidden(all[i].triangle))
                changed++;
            else
                lost += hits[i].triangle != all[i].triangle || hits[i].t != all[i].t;
        }
        EXPECT_EQ(backs, 0u);
        EXPECT_EQ(lost, 0u);
        EXPECT_EQ(any_differs, 0u);
        EXPECT_GT(changed, rays.size() / 100);
        EXPECT_GT(found, rays.size() / 20);
    }
}

}  // namespace
}  // namespace peelray
