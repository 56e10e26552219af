// The cube against a CPU rasteriser: nothing lost, nothing that does not belong, every table well-formed.
#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "effort.h"
#include "meshes.h"
#include "single_cube.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::uvec3;
using glm::vec3;
using test::CpuRaster;
using test::DecodedCube;
using test::from_scene;
using test::Mesh3;
using test::Random;
using test::shrink;
using test::soup;

class CubeTest : public DeviceTest {
  protected:
    struct Built {
        LdcBody body;
        LdcCounters counts;
        test::Tables tables;
    };
    test::SingleCube cube_of(const Mesh3& mesh, uint32_t resolution, Sampling sampling) {
        return {device(), commands(), mesh.positions, mesh.triangles, mesh.lower, mesh.upper, resolution, sampling};
    }
    Built look_at(const test::SingleCube& cube) {
        return {cube.cubes.table.download(commands())[0], cube.counts(),
                test::download(commands(), cube.cubes, cube.builder.size())};
    }
    Built build(const Mesh3& mesh, uint32_t resolution, Sampling sampling) {
        return look_at(cube_of(mesh, resolution, sampling));
    }

    void expect_same(const Built& a, const Built& b) {
        EXPECT_TRUE(DecodedCube(a.body, a.tables).samples == DecodedCube(b.body, b.tables).samples);
    }

    /// Compares the cube with the CPU's and checks every sample.
    void expect_right(const Mesh3& mesh, const Built& built, Sampling sampling) {
        const DecodedCube decoded(built.body, built.tables);
        if (HasFatalFailure()) return;
        decoded.expect_whole(built.counts);
        EXPECT_EQ(expect_right(mesh, built.body, decoded, sampling), built.counts.degenerate);
        EXPECT_EQ(built.counts.invalid, 0u);
    }
    /// The same for one of several bodies, whose triangles are `mesh`; returns how many of them have no area.
    uint32_t expect_right(const Mesh3& mesh, const LdcBody& body, const DecodedCube& decoded, Sampling sampling) {
        const CubeGrid& grid = body.grid;
        const CpuRaster cpu(grid, mesh.positions, mesh.triangles);
        const auto expected = cpu.expect(sampling);
        std::vector<uint64_t> pairs = decoded.pairs, lost, foreign;
        for (uint64_t& pair : pairs) pair -= uint64_t(body.first_triangle) * 4;
        std::set_difference(expected.must.begin(), expected.must.end(), pairs.begin(), pairs.end(),
                            std::back_inserter(lost));
        std::set_difference(pairs.begin(), pairs.end(), expected.may.begin(), expected.may.end(),
                            std::back_inserter(foreign));
        EXPECT_TRUE(lost.empty()) << lost.size() << " of " << expected.must.size()
                                  << " lost; the first: " << describe(grid, lost);
        EXPECT_TRUE(foreign.empty()) << foreign.size() << " of " << pairs.size()
                                     << " foreign; the first: " << describe(grid, foreign);
        for (const auto& sample : decoded.samples)
            expect_sample(sample, cpu, sample.id - 4 * body.first_triangle, sampling);
        return expected.degenerate;
    }
    static void expect_sample(const DecodedCube::Sample& sample, const CpuRaster& cpu, uint32_t id, Sampling sampling) {
        const uint32_t axis = id & 3;
        const auto seen = cpu.seen(id >> 2, axis);
        const dvec3 corner = CpuRaster::permuted(dvec3(sample.voxel), axis);
        const bool band = sampling == Sampling::band;
        const test::SamplePlane stored =
            band ? test::plane_of_sample(glm::uvec2(sample.data)) : test::plane_of_patch(sample.data);
        // Half floats, less exact by a step where another component would be 1.
        const dvec3 normal = CpuRaster::permuted(dvec3(stored.normal), axis);
        ASSERT_EQ(normal.z, 1);
        ASSERT_NE(normal.x, 1);
        ASSERT_NE(normal.y, 1);
        if (!band) {
            // What a ray may hit in the voxel lies in the plane, a sixth of the traversal's slack at most beside it.
            const dvec3 slack(1e-3);
            for (const dvec3& p :
                 clip_box(Polygon(seen.corners.begin(), seen.corners.end()), corner - slack, corner + 1.0 + slack, 3))
                ASSERT_NEAR(glm::dot(normal, p - corner - 0.5), stored.w, 5e-4) << "triangle " << (id >> 2);
            ASSERT_TRUE(sample.data.y >> 16) << "no coverage";
            return;
        }
        // From the voxel's centre. Beside the packing's 8·10⁻⁵: coordinates up to 256 and slopes are floats.
        const double w = seen.plane(dvec2(corner) + 0.5) - corner.z - 0.5;
        ASSERT_NEAR(stored.w, std::clamp(w, -2.5, 2.5), 8e-5 + 3e-4) << "triangle " << (id >> 2);
        ASSERT_NEAR(-normal.x, seen.slope.x, 7.5e-4);
        ASSERT_NEAR(-normal.y, seen.slope.y, 7.5e-4);
    }
    void expect_right(const Mesh3& mesh, uint32_t resolution) {
        for (const Sampling sampling : {Sampling::conservative, Sampling::band}) {
            SCOPED_TRACE(testing::Message()
                         << "N = " << resolution << (sampling == Sampling::band ? ", centre" : ", conservative"));
            expect_right(mesh, build(mesh, resolution, sampling), sampling);
            if (HasFailure()) return;
        }
    }

  private:
    static std::string describe(const CubeGrid& grid, const std::vector<uint64_t>& pairs) {
        if (pairs.empty()) return "";
        const auto cell = uint32_t(pairs[0] >> 32), id = uint32_t(pairs[0]);
        return fmt::format("triangle {} axis {} voxel {} {} {}", id >> 2, id & 3, cell % grid.dims.x,
                           cell / grid.dims.x % grid.dims.y, cell / grid.dims.x / grid.dims.y);
    }
};

TEST_F(CubeTest, SoupsInACubicBox) {
    for (const uint32_t resolution : {16u, 64u, 256u})
        expect_right(soup(resolution, resolution == 256 ? 150 : 400, vec3(1), 2.0f / float(resolution)), resolution);
}

TEST_F(CubeTest, SoupsInLongAndFlatBoxes) {
    expect_right(soup(1, 300, vec3(1, 0.3f, 0.6f), 2.0f / 64), 64);
    expect_right(soup(2, 300, vec3(0.02f, 5, 0.9f), 10.0f / 256), 256);
    expect_right(soup(3, 300, vec3(40, 30, 1), 80.0f / 128), 128);
}

TEST_F(CubeTest, MoreTrianglesThanThreadsShare) {
    // From 150,000 on a thread goes through the pixels of its own triangle.
    if (test::effort(true, false)) GTEST_SKIP() << "only in the long run";
    expect_right(soup(5, 150'001, vec3(1), 0.02f), 16);
}

TEST_F(CubeTest, FarFromTheOrigin) {
    expect_right(test::moved(soup(4, 300, vec3(1), 2.0f / 64), vec3(500, -300, 100)), 64);
}

TEST_F(CubeTest, AFloorOfTwoTriangles) {
    for (const float tilt : {0.0f, 0.5f, 0.99f}) {
        const Mesh3 mesh = test::tilted_floor(tilt);
        for (const uint32_t resolution : {16u, 64u, 256u}) expect_right(mesh, resolution);
    }
}

TEST_F(CubeTest, BuiltInScenes) {
    for (const char* name : {"builtin:teapots", "builtin:blob:20000"})
        for (const uint32_t resolution : {16u, 64u, 256u}) {
            SCOPED_TRACE(name);
            expect_right(from_scene(name), resolution);
        }
}

TEST_F(CubeTest, ThousandsOfTrianglesInOneVoxel) {
    // Beyond the 256 that the short sort takes, in both shapes: all in one voxel, and slivers that meet in a pole.
    Random random(9);
    Mesh3 mesh;
    mesh.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    for (int i = 0; i < 5000; i++) {
        const vec3 at(0.5f, 0.4f, -0.3f), reach(1e-3f);
        mesh.add(at + random.point(reach), at + random.point(reach), at + random.point(reach));
    }
    for (int i = 0; i < 1500; i++) {
        const float p = 6.2831853f * float(i) / 1500, q = 6.2831853f * float(i + 1) / 1500;
        mesh.add({-0.5f, 0.6f, 0.1f}, {-0.5f + 0.3f * std::cos(p), 0.4f, 0.1f + 0.3f * std::sin(p)},
                 {-0.5f + 0.3f * std::cos(q), 0.4f, 0.1f + 0.3f * std::sin(q)});
    }
    for (const uint32_t resolution : {16u, 64u}) {
        expect_right(mesh, resolution);
        EXPECT_GT(build(mesh, resolution, Sampling::conservative).counts.longest, 4000u);
    }
}

TEST_F(CubeTest, NothingButDegenerateTrianglesIsAnEmptyCube) {
    Mesh3 mesh;
    mesh.add({0, 0, 0}, {1, 1, 1}, {0, 0, 0});
    const Built built = build(mesh, 64, Sampling::conservative);
    expect_right(mesh, built, Sampling::conservative);
    EXPECT_EQ(built.counts.fragments, 0u);
    EXPECT_EQ(built.tables.top[0], glm::uvec2(0, 3 | 3 << 10 | 3 << 20)) << "one box: everything";
}

TEST_F(CubeTest, TwoBuildsHoldTheSameSamples) {
    for (const Sampling sampling : {Sampling::conservative, Sampling::band}) {
        const Mesh3 mesh = soup(11, 800, vec3(1), 2.0f / 64);
        const Built first = build(mesh, 64, sampling), second = build(mesh, 64, sampling);
        expect_same(first, second);
        EXPECT_EQ(std::memcmp(&first.counts, &second.counts, sizeof(LdcCounters)), 0);
    }
}

TEST_F(CubeTest, OverflowsGrowAndAreRedone) {
    // Triangles of some 12 voxels: more than any first guess of large triangles, tiles, fragments, cells and nodes.
    Random random(5);
    Mesh3 many, deep;
    for (int i = 0; i < 7000; i++) {
        const vec3 centre = random.point(vec3(1)), reach(0.06f);
        many.add(centre + random.point(reach), centre + random.point(reach), centre + random.point(reach));
    }
    // 260 triangles in each of some 1300 voxels: more long lists than guessed.
    deep.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    for (int i = 0; i < 260; i++) deep.add({-0.5f, -0.5f, -0.5f}, {0.5f, 0.45f, -0.4f}, {-0.35f, 0.4f, 0.5f});
    const struct {
        const Mesh3& mesh;
        uint32_t resolution;
    } cases[] = {{many, 256}, {deep, 64}};
    for (const auto& c : cases) {
        test::SingleCube cube = cube_of(c.mesh, c.resolution, Sampling::conservative);
        const uint32_t redone = cube.builder.redone();
        EXPECT_GT(redone, 0u);
        const Built grown = look_at(cube);
        expect_right(c.mesh, grown, Sampling::conservative);
        EXPECT_GT(cube.builder.scratch_bytes(), uint64_t(grown.counts.fragments) * 12);
        // Now there is room: the same again in one go, and triangles that take little of it.
        const Mesh3 shrunk = shrink(c.mesh);
        cube.build(commands());
        expect_same(look_at(cube), grown);
        commands().upload(cube.triangles.positions, std::span<const vec3>(shrunk.positions));
        cube.build(commands());
        const Built calm = look_at(cube);
        EXPECT_LT(calm.counts.fragments, grown.counts.fragments / 4);
        expect_right(shrunk, calm, Sampling::conservative);
        expect_same(build(shrunk, c.resolution, Sampling::conservative), calm);
        commands().upload(cube.triangles.positions, std::span<const vec3>(c.mesh.positions));
        cube.build(commands());
        expect_same(look_at(cube), grown);
        EXPECT_EQ(cube.builder.redone(), redone);
    }
}

/// Several bodies, each in its own box, in one set of tables.
class BodiesTest : public CubeTest {
  protected:
    void SetUp() override {
        CubeTest::SetUp();
        meshes_ = {soup(21, 60, vec3(1), 2.0f / 48), soup(22, 90, vec3(3, 0.2f, 1), 6.0f / 96), Mesh3{},
                   soup(23, 200, vec3(0.1f), 0.2f / 128), soup(24, 40, vec3(5), 10.0f / 16)};
        meshes_[1] = test::moved(meshes_[1], vec3(10, -4, 2));
        const uint32_t resolutions[] = {48, 96, 64, 128, 16};
        for (size_t i = 0; i < meshes_.size(); i++) {
            const Mesh3& mesh = meshes_[i];
            bodies_.push_back({uint32_t(all_.triangles.size()), uint32_t(mesh.triangles.size()), resolutions[i],
                               mesh.lower, mesh.upper});
            for (const uvec3& t : mesh.triangles) all_.triangles.push_back(t + uint32_t(all_.positions.size()));
            all_.positions.insert(all_.positions.end(), mesh.positions.begin(), mesh.positions.end());
        }
    }
    /// All bodies as they lie in the tables.
    void expect_bodies(const Cubes& cubes, const TableSize& size, Sampling sampling) {
        const test::Tables tables = test::download(commands(), cubes, size);
        const std::vector<LdcBody> bodies = cubes.table.download(commands());
        uint64_t samples = 0, nodes = 0, occupied = 0;
        for (size_t i = 0; i < bodies.size(); i++) {
            SCOPED_TRACE(testing::Message() << "body " << i);
            const DecodedCube decoded(bodies[i], tables);
            if (HasFatalFailure()) return;
            if (bodies[i].triangles > 0) expect_right(meshes_[i], bodies[i], decoded, sampling);
            samples += decoded.samples.size();
            nodes += decoded.nodes;
            occupied += decoded.occupied;
        }
        EXPECT_EQ(samples, size.samples);
        EXPECT_EQ(nodes, size.nodes);
        EXPECT_EQ(occupied, size.occupied);
    }

    std::vector<Mesh3> meshes_;
    std::vector<CubeBody> bodies_;
    Mesh3 all_;
};

TEST_F(BodiesTest, AreBuiltAtOnceAsEachAlone) {
    const TriangleBuffers triangles(device(), all_.positions, all_.triangles);
    for (const Sampling sampling : {Sampling::conservative, Sampling::band}) {
        Cubes cubes(device(), bodies_, sampling);
        CubeBuilder builder(device(), commands(), cubes, 0, uint32_t(bodies_.size()));
        builder.build(commands(), triangles);
        expect_bodies(cubes, builder.size(), sampling);
    }
}

TEST_F(BodiesTest, ThatStayKeepTheirTablesWhileOthersAreRebuiltAndGrow) {
    const TriangleBuffers triangles(device(), all_.positions, all_.triangles);
    const Sampling sampling = Sampling::conservative;
    for (const uint32_t fixed : {1u, 2u, 3u}) {
        SCOPED_TRACE(fixed);
        Cubes cubes(device(), bodies_, sampling);
        CubeBuilder first(device(), commands(), cubes, 0, fixed);
        first.build(commands(), triangles);
        const test::Tables before = test::download(commands(), cubes, first.size());
        CubeBuilder second(device(), commands(), cubes, fixed, uint32_t(bodies_.size()) - fixed, first.size());
        for (int i = 0; i < 2; i++) {
            second.build(commands(), triangles);
            expect_bodies(cubes, first.size() + second.size(), sampling);
            EXPECT_TRUE(test::download(commands(), cubes, first.size()) == before);
        }
        EXPECT_GT(second.redone(), 0u) << "the tables had to grow";
    }
}

TEST_F(BodiesTest, FollowTheirBounds) {
    // The last body's bounds change on the device: so does its grid, and nothing else does.
    const TriangleBuffers triangles(device(), all_.positions, all_.triangles);
    Cubes cubes(device(), bodies_, Sampling::conservative);
    CubeBuilder builder(device(), commands(), cubes, 0, uint32_t(bodies_.size()));
    builder.build(commands(), triangles);
    const auto before = cubes.table.download(commands());
    std::vector<CubeBody> wider = bodies_;
    wider.back().upper *= 3.0f;
    const Cubes other(device(), wider, Sampling::conservative);
    commands().copy(other.table.upper, cubes.table.upper, bodies_.size() * 12);
    builder.build(commands(), triangles);
    const auto after = cubes.table.download(commands());
    for (size_t i = 0; i < bodies_.size(); i++) {
        const CubeGrid expected = make_grid(wider[i].lower, wider[i].upper, wider[i].resolution);
        EXPECT_EQ(after[i].grid.dims, expected.dims) << i;
        EXPECT_NEAR(after[i].grid.voxel / expected.voxel, 1, 1e-6) << i;
        EXPECT_EQ(after[i].first_cell, before[i].first_cell) << i;
    }
    EXPECT_GT(after.back().grid.voxel, 1.5f * before.back().grid.voxel);
    expect_bodies(cubes, builder.size(), Sampling::conservative);
}

TEST_F(CubeTest, DegenerateAndInvalidTrianglesAreCountedAndDropped) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const vec3 a(-1, -1, -1), b(1, 1, 0.5f), c(-0.5f, 1, 1);
    Mesh3 mesh;
    mesh.add(a, b, c);
    mesh.add(a, a, c);                              // 1
    mesh.add(c, c, c);                              // 2
    mesh.add({-1, 0, 0}, {0, 0, 0}, {0.5f, 0, 0});  // 3
    mesh.add({nan, 0, 0}, b, c);                    // 4
    mesh.add(a, {0, inf, 0}, c);                    // 5
    mesh.add(a, b, {0, 0, -inf});                   // 6
    mesh.add({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan});
    mesh.add(a, c, {0.3f, 0.2f, 0.1f});  // 8
    for (const Sampling sampling : {Sampling::conservative, Sampling::band}) {
        const Built built = build(mesh, 64, sampling);
        EXPECT_EQ(built.counts.degenerate, 3u);
        EXPECT_EQ(built.counts.invalid, 4u);
        std::vector<int> seen(mesh.triangles.size());
        for (const auto& sample : DecodedCube(built.body, built.tables).samples) seen[sample.id >> 2]++;
        for (size_t i = 0; i < seen.size(); i++) EXPECT_EQ(seen[i] > 0, i == 0 || i == 8) << i;
    }
}

/// Bounded on a CPU: its shaders' loops are cut off silently, so that a list too long to walk through must be refused.
TEST_F(CubeTest, SoftwareDevicesRefuseListsThatRaysCannotWalk) {
    if (device().info().kind != "CPU") GTEST_SKIP() << "GPUs sort lists of any length";
    Mesh3 mesh;
    const auto add = [&](const vec3& at) {
        const uint32_t first = uint32_t(mesh.positions.size());
        for (const vec3& corner : {vec3(0), vec3(0.1f, 0, 0), vec3(0, 0.1f, 0)}) mesh.positions.push_back(at + corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    add(vec3(0));
    add(vec3(10));
    for (int i = 0; i < 16'001; i++) add(vec3(5.1f));
    mesh.lower = vec3(0);
    mesh.upper = vec3(10.1f);
    expect_error([&] { cube_of(mesh, 16, Sampling::conservative); }, {"16001", "--ldc", "GPU"});
}

TEST_F(CubeTest, EdgesAlongAnAxisLoseNoVoxel) {
    // Seen along that axis the edge is as short as the rounding of its ends, far from the cube's corner: where it
    // points is noise.
    Mesh3 mesh;
    Random random(5);
    const auto at = [&](float from, float to) {
        return vec3(random.uniform(from, to), random.uniform(from, to), random.uniform(from, to));
    };
    for (int i = 0; i < 400; i++) {
        const vec3 a = at(-280, 120);
        vec3 edge = at(-3e-5f, 3e-5f);
        edge[i % 3] = random.uniform(-40, 40);
        mesh.add(a, a + at(-40, 40), a + edge);
    }
    expect_right(mesh, 128);
    expect_right(mesh, 512);
}

TEST_F(CubeTest, BytesAreWhatTheTablesUse) {
    const Built built = build(soup(3, 200, vec3(1, 0.5f, 0.2f), 2.0f / 64), 64, Sampling::conservative);
    const LdcCounters& c = built.counts;
    EXPECT_EQ((TableSize{c.cells, c.occupied, c.nodes, c.fragments}.bytes(16)),
              built.tables.top.size() * 8 + built.tables.node.size() * 4 + built.tables.voxel.size() * 4 +
                  built.tables.patches.size() * 16);
}

TEST(MakeGrid, HoldsTheBoxWithAVoxelAround) {
    Random random(77);
    for (int i = 0; i < 5000; i++) {
        const float scale = std::exp2(random.uniform(-20, 20));
        vec3 size = glm::abs(random.point(vec3(scale)));
        if (i % 5 == 0) size[i % 3] = 0;
        if (i % 7 == 0) size[i % 3] *= 1e-3f;
        const vec3 lower = random.point(vec3(scale * (i % 2 ? 1.0f : 20.0f))), upper = lower + size;
        const uint32_t resolution = 16 + random.below(2033), n = (resolution + 15) / 16 * 16;
        const CubeGrid grid = make_grid(lower, upper, resolution);
        EXPECT_NEAR(double(grid.voxel) * grid.inv_voxel, 1, 1e-6);
        uint32_t longest = 0;
        for (int axis = 0; axis < 3; axis++) {
            ASSERT_EQ(grid.dims[axis] % 16, 0u);
            ASSERT_LE(grid.dims[axis], n);
            ASSERT_GE(grid.dims[axis], 16u);
            longest = std::max(longest, grid.dims[axis]);
            // Less what the origin's own rounding takes.
            const double low = (double(lower[axis]) - grid.origin[axis]) / grid.voxel,
                         high = (double(upper[axis]) - grid.origin[axis]) / grid.voxel;
            const double rounding = 1.2e-7 * std::abs(grid.origin[axis]) / grid.voxel + 3e-4 + 1e-3;
            ASSERT_GE(low, 1 - rounding);
            ASSERT_LE(high, grid.dims[axis] - 1 + rounding);
        }
        ASSERT_EQ(longest, n);
    }
}

TEST(MakeGrid, RefusesOtherResolutions) {
    for (const uint32_t resolution : {0u, 1u, 15u, 2049u, ~0u})
        expect_error([&] { make_grid(vec3(0), vec3(1), resolution); },
                     {std::to_string(resolution), "16 to 2048", "--ldc"});
    EXPECT_EQ(make_grid(vec3(0), vec3(1), 16).dims, uvec3(16));
    EXPECT_EQ(make_grid(vec3(0), vec3(1), 17).dims, uvec3(32));
    EXPECT_EQ(make_grid(vec3(0), vec3(1), 2048).dims, uvec3(2048));
}

TEST(MakeGrid, APointAndAPlaneHaveVoxelsToo) {
    for (const vec3& at : {vec3(0), vec3(1000, 0, 0), vec3(-1e20f)}) {
        const CubeGrid grid = make_grid(at, at, 64);
        EXPECT_GT(grid.voxel, 0);
        EXPECT_TRUE(std::isfinite(grid.inv_voxel));
        EXPECT_EQ(grid.dims % 16u, uvec3(0));
    }
    EXPECT_EQ(make_grid(vec3(0), vec3(1, 0, 1), 64).dims, uvec3(64, 16, 64));
}

}  // namespace
}  // namespace peelray
