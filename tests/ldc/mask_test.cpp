// Cubes and rays of masked materials: holes give no planar samples and no exact hits.
#include <map>
#include <optional>

#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "effort.h"
#include "ldc/trace_params.h"
#include "loaders/load.h"
#include "motion/motion.h"
#include "ray_sets.h"
#include "reference/oracle.h"
#include "render/base_colors.h"
#include "render/ray_scene.h"
#include "scene/alpha_test.h"
#include "single_cube.h"

namespace peelray {
namespace {

using test::DecodedCube;
using test::RayKind;

class MaskedCubeTest : public DeviceTest {
  protected:
    const Scene scene_ = load_scene("builtin:leaves");
    const Geometry geometry_ = flatten(scene_);
    const AlphaTest alpha_{scene_, geometry_};

    BaseColorBuffers base_colors() {
        Assembly assembly;
        assembly.uvs = geometry_.uvs;
        assembly.colors = geometry_.colors;
        assembly.materials = geometry_.materials;
        return upload_base_colors(device(), commands(), scene_, assembly, used_materials(scene_, assembly),
                                  MaterialsFor::hits);
    }
    test::SingleCube cube(uint32_t resolution, Sampling sampling, const BaseColorBuffers* masks) {
        return {device(),
                commands(),
                geometry_.positions,
                geometry_.triangles,
                geometry_.lower,
                geometry_.upper,
                resolution,
                sampling,
                {},
                0,
                masks};
    }
    test::Tables tables(const test::SingleCube& cube) {
        return test::download(commands(), cube.cubes, cube.builder.size());
    }

    std::vector<DecodedCube::Sample> samples(const test::SingleCube& cube) {
        const test::Tables found = tables(cube);
        return DecodedCube(cube.cubes.table.download(commands())[0], found).samples;
    }

    /// Is there a surface at the centre of a sample's pixel? Nothing where a hundredth of a pixel beside decides
    /// otherwise.
    std::optional<bool> present(const CubeGrid& grid, const DecodedCube::Sample& sample) const {
        const test::CpuRaster raster(grid, geometry_.positions, geometry_.triangles);
        const uint32_t triangle = sample.id >> 2, axis = sample.id & 3;
        const auto corners = raster.seen(triangle, axis).corners;
        const glm::dvec2 a(corners[0]), e = glm::dvec2(corners[1]) - a, f = glm::dvec2(corners[2]) - a;
        const glm::dvec2 centre(sample.voxel[(axis + 1) % 3] + 0.5, sample.voxel[(axis + 2) % 3] + 0.5);
        std::optional<bool> all;
        for (const glm::dvec2& beside : {glm::dvec2(0), {0.01, 0}, {-0.01, 0}, {0, 0.01}, {0, -0.01}}) {
            const glm::dvec2 p = centre + beside - a;
            const double area = e.x * f.y - e.y * f.x, u = (p.x * f.y - p.y * f.x) / area,
                         v = (e.x * p.y - e.y * p.x) / area;
            const bool there = alpha_.is_present(triangle, u, v);
            if (all && *all != there) return {};
            all = there;
        }
        return all;
    }
};

TEST_F(MaskedCubeTest, CentresInHolesGiveNoSamplesAndOthersStay) {
    const BaseColorBuffers masks = base_colors();
    for (const uint32_t resolution : {96u, 512u}) {  // triangles of one thread each, and of blocks
        SCOPED_TRACE(resolution);
        const test::SingleCube with = cube(resolution, Sampling::band, &masks),
                               without = cube(resolution, Sampling::band, nullptr);
        const test::Tables masked_tables = tables(with), whole_tables = tables(without);
        const LdcBody body = with.cubes.table.download(commands())[0];
        const DecodedCube masked(body, masked_tables), whole(body, whole_tables);
        masked.expect_whole(with.counts());
        std::map<uint64_t, glm::uvec4> left;
        for (const auto& s : masked.samples) left[test::pair_of(body.grid, s.voxel, s.id)] = s.data;
        size_t holes = 0, there = 0, kept = 0, wrong = 0, unsure = 0;
        for (const auto& s : whole.samples) {
            const auto found = left.find(test::pair_of(body.grid, s.voxel, s.id));
            const bool has = found != left.end();
            if (has) wrong += found->second != s.data;
            kept += has;
            const auto expected = present(body.grid, s);
            if (!expected) {
                unsure++;
                continue;
            }
            (*expected ? there : holes)++;
            wrong += has != *expected;
        }
        fmt::print("  {}: {} samples, {} of them in holes, {} at a hole's edge\n", resolution, whole.samples.size(),
                   holes, unsure);
        EXPECT_EQ(wrong, 0u);
        EXPECT_EQ(kept, masked.samples.size()) << "nothing is added";
        EXPECT_GT(holes, 5000u);
        EXPECT_GT(there, 5000u);
        EXPECT_LT(unsure, whole.samples.size() / 20);
        // What it is made of decides nothing but which samples there are: the same input gives the same cube.
        EXPECT_TRUE(samples(cube(resolution, Sampling::band, &masks)) == masked.samples);
    }
}

TEST_F(MaskedCubeTest, ConservativeCubesHoldAllTriangles) {
    const BaseColorBuffers masks = base_colors();
    EXPECT_TRUE(samples(cube(128, Sampling::conservative, &masks)) ==
                samples(cube(128, Sampling::conservative, nullptr)));
}

TEST_F(MaskedCubeTest, RaysAgreeWithTheOracle) {
    // As `peelray trace` traces them: two of the bodies are placed by a transform that mirrors.
    const Moment rest = at_rest(scene_);
    const Assembly assembly = assemble(scene_, rest, motion_of(scene_, ""));
    const Oracle oracle(geometry_, alpha_), opaque(geometry_);
    RayScene scene(device(), scene_, rest, assembly, {});
    for (const RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel, RayKind::on_surface}) {
        test::RaySource source(geometry_, 99);
        std::vector<Ray> rays(test::effort(25'000, 50'000));
        for (Ray& ray : rays) ray = source.make(kind);
        const Buffer ray_buffer = upload(rays), hit_buffer(device(), "file hits", rays.size() * sizeof(FileHit));
        const auto trace = [&](bool any_hit) {
            scene.record(commands(), ray_buffer, uint32_t(rays.size()), hit_buffer, any_hit);
            commands().submit();
            return download<FileHit>(hit_buffer, rays.size());
        };
        const auto hits = trace(false), any = trace(true);
        size_t wrong = 0, wrong_any = 0, hit = 0, second_look = 0, through = 0;
        for (size_t i = 0; i < rays.size(); i++) {
            const OracleRay ray = test::oracle_ray(rays[i]);
            const Verdict verdict = oracle.check(ray, hits[i].t, hits[i].triangle);
            wrong += verdict == Verdict::wrong;
            second_look += verdict == Verdict::within_offset;
            wrong_any += oracle.check_any(ray, any[i].triangle != ~0u) == Verdict::wrong;
            hit += hits[i].triangle != ~0u;
            through += opaque.closest(ray).triangle != oracle.closest(ray).triangle;
        }
        fmt::print("  {}: {} hits, {} rays went through a hole, {} needed the second look\n", test::name_of(kind), hit,
                   through, second_look);
        EXPECT_EQ(wrong, 0u) << test::name_of(kind);
        EXPECT_EQ(wrong_any, 0u) << test::name_of(kind);
        EXPECT_GT(through, rays.size() / 100) << test::name_of(kind);
    }
}

}  // namespace
}  // namespace peelray
