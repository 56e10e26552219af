// Hits of the device's own ray tracing on whole scenes: those of the cubes and of the oracle.
#include "common/ray.h"
#include "khr_fixture.h"
#include "ldc/trace_params.h"
#include "loaders/load.h"
#include "motion/motion.h"
#include "ray_sets.h"
#include "reference/oracle.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

using test::RayKind;

class KhrOnScene : public KhrTest, public ::testing::WithParamInterface<const char*> {
  protected:
    std::vector<FileHit> trace(RayScene& scene, const std::vector<Ray>& rays, bool any_hit = false) {
        const Buffer ray_buffer = upload(rays), hits(device(), "file hits", rays.size() * sizeof(FileHit));
        scene.record(commands(), ray_buffer, uint32_t(rays.size()), hits, any_hit);
        commands().submit();
        return download<FileHit>(hits, rays.size());
    }
    void expect_those_of_cubes_and_oracle(const Scene& scene);
};

/// The device intersects in single precision and as it likes: of so many rays one may be wrong, at an edge.
constexpr size_t kRaysPerWrong = 2000;

void KhrOnScene::expect_those_of_cubes_and_oracle(const Scene& scene) {
    const Geometry geometry = flatten(scene);
    const AlphaTest alpha(scene, geometry);
    const Oracle oracle(geometry, alpha, Sidedness(scene, geometry));
    const Moment rest = at_rest(scene);
    const Assembly assembly = assemble(scene, rest, motion_of(scene, ""));
    TracerChoice structures;
    structures.tracer = Tracer::khr;
    structures.structures = StructureUpdate::keep;
    RayScene khr(device(), scene, rest, assembly, structures), ldc(device(), scene, rest, assembly, {});
    EXPECT_EQ(khr.stats(commands()).structures.bodies, assembly.bodies.size());
    for (const RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel}) {
        test::RaySource source(geometry, 77);
        std::vector<Ray> rays(20'000);
        for (Ray& ray : rays) ray = source.make(kind);
        const auto hits = trace(khr, rays), others = trace(ldc, rays), any = trace(khr, rays, true);
        size_t wrong = 0, wrong_any = 0, hit = 0, same = 0;
        for (size_t i = 0; i < rays.size(); i++) {
            const OracleRay ray = test::oracle_ray(rays[i]);
            wrong += oracle.check(ray, hits[i].t, hits[i].triangle) == Verdict::wrong;
            wrong_any += oracle.check_any(ray, any[i].triangle != ~0u) == Verdict::wrong;
            hit += hits[i].triangle != ~0u;
            same += hits[i].triangle == others[i].triangle;
            if (hits[i].triangle != others[i].triangle || hits[i].triangle == ~0u) continue;
            // The weights tell the same point.
            const glm::uvec3 t = geometry.triangles[hits[i].triangle];
            const glm::vec3 e = geometry.positions[t.y] - geometry.positions[t.x],
                            f = geometry.positions[t.z] - geometry.positions[t.x];
            const glm::vec3 apart = e * (hits[i].u - others[i].u) + f * (hits[i].v - others[i].v);
            wrong += kind != RayKind::grazing && glm::length(apart) > 1e-3f * float(oracle.diagonal());
        }
        fmt::print("  {} {}: {} hits, {} % as in the cubes, {} wrong, {} any-hits wrong\n", GetParam(),
                   test::name_of(kind), hit, 100.0 * double(same) / double(rays.size()), wrong, wrong_any);
        EXPECT_LE(wrong, rays.size() / kRaysPerWrong) << test::name_of(kind);
        EXPECT_LE(wrong_any, rays.size() / kRaysPerWrong) << test::name_of(kind);
        EXPECT_GT(hit, rays.size() / 50) << "rays that hit nothing prove nothing";
        // The other kinds go along edges, between triangles that are hit alike.
        EXPECT_GE(same, kind == RayKind::uniform ? rays.size() - rays.size() / 500 : rays.size() / 2);
    }
}

TEST_P(KhrOnScene, HitsAreThoseOfTheCubesAndTheOracle) {
    expect_those_of_cubes_and_oracle(load_scene(GetParam()));
}

TEST_P(KhrOnScene, RaysFromBehindPassSingleSidedTriangles) {
    Scene scene = load_scene(GetParam());
    for (size_t i = 0; i < scene.materials.size(); i += 2) scene.materials[i].double_sided = false;
    expect_those_of_cubes_and_oracle(scene);
}

// Instances in motion and mirrored, masked materials beside opaque ones, many small triangles.
INSTANTIATE_TEST_SUITE_P(Scenes, KhrOnScene,
                         ::testing::Values("builtin:teapots", "builtin:leaves", "builtin:particles:50",
                                           "builtin:blob:20000"),
                         [](const auto& info) {
                             std::string name = info.param;
                             for (char& c : name)
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             return name;
                         });

}  // namespace
}  // namespace peelray
