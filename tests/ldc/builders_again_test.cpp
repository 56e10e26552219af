// What one builder builds again, and beside others: the cube is the one that it would have built at once.
#include "builders_fixture.h"

namespace peelray {
namespace {

using glm::vec3;
using test::Builder;
using test::BuildersTest;
using test::kGraphics;
using test::Mesh3;
using test::name_of;
using test::Random;
using test::shrink;
using test::soup;

TEST_F(BuildersTest, PassesFollowTheLayersOneByOne) {
    // As many layers as the first guess has passes, one more, one fewer, built again and again by one builder.
    const auto stack = [](int layers) {
        Mesh3 mesh;
        for (int i = 0; i < 12; i++) {  // what is too much is moved out of the way, into one place each
            const float z = -0.9f + 0.15f * float(i), x = i < layers ? 0 : -0.9f + 0.15f * float(i);
            mesh.add({x - 0.05f, -0.05f, z}, {x + 0.05f, -0.05f, z}, {x, 0.05f, z});
        }
        mesh.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
        return mesh;
    };
    for (const Routing routing : {Routing::geometry, Routing::draws}) {
        CubeLayout layout{Traversal::two_level};
        layout.builder = BuilderKind::peel;
        layout.routing = routing;
        const Mesh3 first = stack(8);
        test::SingleCube cube(device(), commands(), first.positions, first.triangles, first.lower, first.upper, 64,
                              Sampling::centre, layout);
        for (const int layers : {8, 9, 8, 7, 10, 11, 12, 11, 12, 10}) {
            const Mesh3 mesh = stack(layers);
            commands().upload(cube.triangles.positions, std::span<const glm::vec3>(mesh.positions));
            cube.build(commands());
            const Built compute = build(mesh, 64, Sampling::centre, CubeLayout{Traversal::two_level});
            EXPECT_EQ(cube.counts().complexity, compute.counts.longest) << layers;
            EXPECT_EQ(cube.counts().fragments, compute.counts.fragments) << layers;
        }
    }
}

TEST_F(BuildersTest, GrowAndShrinkWithTheirTriangles) {
    Random random(5);
    Mesh3 many;
    for (int i = 0; i < 1500; i++) {
        const vec3 centre = random.point(vec3(1)), reach(0.2f);
        many.add(centre + random.point(reach), centre + random.point(reach), centre + random.point(reach));
    }
    const Mesh3 shrunk = shrink(many);
    for (const Traversal traversal : {Traversal::voxel, Traversal::two_level}) {
        const Built large = build(many, 48, Sampling::band, layout_of({}, traversal));
        const Built small = build(shrunk, 48, Sampling::band, layout_of({}, traversal));
        for (const Builder& builder : kGraphics) {
            SCOPED_TRACE(name_of(builder, Sampling::band, traversal));
            test::SingleCube cube = cube_of(many, 48, Sampling::band, layout_of(builder, traversal));
            EXPECT_GT(cube.builder.redone(), 0u);
            expect_same(many, large.body, large.samples, look_at(cube).samples, Sampling::band);
            const uint32_t redone = cube.builder.redone();
            cube.build(commands());
            EXPECT_EQ(cube.builder.redone(), redone) << "now there is room";
            commands().upload(cube.triangles.positions, std::span<const vec3>(shrunk.positions));
            cube.build(commands());
            EXPECT_EQ(cube.builder.redone(), redone);
            expect_same(shrunk, small.body, small.samples, look_at(cube).samples, Sampling::band);
            // A few layers are peeled now: the many must be noticed again.
            cube.build(commands());
            commands().upload(cube.triangles.positions, std::span<const vec3>(many.positions));
            cube.build(commands());
            expect_same(many, large.body, large.samples, look_at(cube).samples, Sampling::band);
            if (HasFailure()) return;
        }
    }
}

TEST_F(BuildersTest, TwoBuildsAreTheSameByteForByte) {
    const Mesh3 mesh = soup(11, 300, vec3(1), 2.0f / 64);
    for (const Builder& builder : kGraphics) {
        const auto tables = [&] {
            const test::SingleCube cube = cube_of(mesh, 64, Sampling::band, layout_of(builder, Traversal::two_level));
            return test::download_pixels(commands(), cube.cubes, cube.builder.size());
        };
        EXPECT_TRUE(tables() == tables());
    }
}

TEST_F(BuildersTest, ManyBodiesInOneBuildAndBesideOthers) {
    std::vector<Mesh3> meshes = {soup(21, 60, vec3(1), 2.0f / 48), soup(22, 90, vec3(3, 0.2f, 1), 6.0f / 96), Mesh3{},
                                 soup(23, 120, vec3(0.1f), 0.2f / 128), soup(24, 40, vec3(5), 10.0f / 16)};
    meshes[1] = test::moved(meshes[1], vec3(10, -4, 2));
    const uint32_t resolutions[] = {48, 96, 64, 128, 16};
    Mesh3 all;
    std::vector<CubeBody> bodies;
    for (size_t i = 0; i < meshes.size(); i++) {
        bodies.push_back({uint32_t(all.triangles.size()), uint32_t(meshes[i].triangles.size()), resolutions[i],
                          meshes[i].lower, meshes[i].upper});
        for (const auto& t : meshes[i].triangles) all.triangles.push_back(t + uint32_t(all.positions.size()));
        all.positions.insert(all.positions.end(), meshes[i].positions.begin(), meshes[i].positions.end());
    }
    const TriangleBuffers triangles(device(), all.positions, all.triangles);
    const uint32_t count = uint32_t(bodies.size());
    for (const Sampling sampling : {Sampling::conservative, Sampling::band})
        for (const Traversal traversal : {Traversal::voxel, Traversal::mipmap})
            for (const Builder& builder : kGraphics) {
                if (builder.kind == BuilderKind::peel && sampling == Sampling::conservative) continue;
                SCOPED_TRACE(name_of(builder, sampling, traversal));
                Cubes expected(device(), bodies, sampling, layout_of({}, traversal));
                CubeBuilder compute(device(), commands(), expected, 0, count);
                compute.build(commands(), triangles);
                // Two of them first, which stay while the rest is built twice.
                Cubes cubes(device(), bodies, sampling, layout_of(builder, traversal));
                CubeBuilder first(device(), commands(), cubes, 0, 2);
                first.build(commands(), triangles);
                CubeBuilder second(device(), commands(), cubes, 2, count - 2, first.size());
                second.build(commands(), triangles);
                second.build(commands(), triangles);
                const auto tables = cubes.table.download(commands()), others = expected.table.download(commands());
                uint64_t samples = 0;
                for (size_t i = 0; i < bodies.size(); i++) {
                    if (bodies[i].triangles == 0) continue;
                    SCOPED_TRACE(testing::Message() << "body " << i);
                    const auto found = samples_of(cubes, tables[i], first.size() + second.size(), nullptr);
                    expect_same(meshes[i], tables[i], samples_of(expected, others[i], compute.size(), nullptr), found,
                                sampling);
                    samples += found.size();
                    if (HasFailure()) return;
                }
                EXPECT_EQ(samples, (first.size() + second.size()).samples);
            }
}

}  // namespace
}  // namespace peelray
