// The cube against a CPU rasteriser: nothing lost, nothing that does not belong, every table well-formed.
#include <random>

#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "ldc/compute_builder.h"
#include "scene/scene.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::uvec3;
using glm::vec3;
using test::CpuRaster;
using test::DecodedCube;

/// Triangles with their bounds.
struct Mesh3 {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    vec3 lower{1e30f}, upper{-1e30f};

    void add(const vec3& a, const vec3& b, const vec3& c) {
        const auto first = uint32_t(positions.size());
        for (const vec3& p : {a, b, c}) {
            positions.push_back(p);
            if (!(glm::length(p) < 1e20f)) continue;  // NaN and infinite corners bound nothing
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        triangles.emplace_back(first, first + 1, first + 2);
    }
};

class Random {
  public:
    explicit Random(uint32_t seed) : generator_(seed) {}
    float uniform(float low, float high) { return low + (high - low) * (float(generator_() >> 8) / 16777216.0f); }
    vec3 point(const vec3& size) {
        const float x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
        return vec3(x, y, z) * size;
    }
    uint32_t below(uint32_t n) { return uint32_t(generator_() % n); }

  private:
    std::mt19937 generator_;
};

/// Random triangles in a box of half-size `size`: big, tiny, needles, axis-aligned, coplanar duplicates and some
/// without area.
Mesh3 soup(uint32_t seed, uint32_t count, const vec3& size, float voxel) {
    Random random(seed);
    Mesh3 mesh;
    mesh.add(-size, size, vec3(-size.x, size.y, -size.z));  // fixes the bounds
    for (uint32_t i = 0; i < count; i++) {
        const vec3 centre = random.point(size * 0.95f);
        const auto near = [&](float reach) { return glm::clamp(centre + random.point(vec3(reach)), -size, size); };
        switch (i % 8) {
            case 0:
                mesh.add(random.point(size), random.point(size), random.point(size));
                break;
            case 1:
                mesh.add(near(voxel * 0.3f), near(voxel * 0.3f), near(voxel * 0.3f));
                break;
            case 2: {  // a needle, far longer than wide
                const vec3 a = random.point(size), b = random.point(size), c = a + (b - a) * random.uniform(0, 1);
                mesh.add(a, b, glm::clamp(c + random.point(vec3(voxel * 1e-3f)), -size, size));
                break;
            }
            case 3: {  // in a plane across an axis, often exactly between two voxels
                const int axis = int(random.below(3));
                vec3 a = near(voxel * 9), b = near(voxel * 9), c = near(voxel * 9);
                a[axis] = b[axis] = c[axis] = i % 16 < 8 ? std::floor(a[axis] / voxel) * voxel : a[axis];
                mesh.add(a, b, c);
                break;
            }
            case 4: {  // the same triangle again, and turned over
                const uvec3 last =
                    mesh.triangles[mesh.triangles.size() - 1 - random.below(3) % uint32_t(mesh.triangles.size())];
                const vec3 a = mesh.positions[last.x], b = mesh.positions[last.y], c = mesh.positions[last.z];
                mesh.add(a, b, c);
                mesh.add(b, a, c);
                break;
            }
            case 5:
                mesh.add(near(voxel * 3), near(voxel * 3), near(voxel * 3));
                break;
            case 6: {
                const vec3 a = near(voxel), b = near(voxel);
                mesh.add(a, i % 3 ? a : b, b);
                break;
            }
            case 7: {  // a diagonal normal: ties and the overlap band
                const float r = voxel * random.uniform(1, 12);
                const vec3 s(random.below(2) ? r : -r, random.below(2) ? r : -r, random.below(2) ? r : -r);
                mesh.add(glm::clamp(centre + vec3(s.x, 0, 0), -size, size),
                         glm::clamp(centre + vec3(0, s.y * random.uniform(0.8f, 1.2f), 0), -size, size),
                         glm::clamp(centre + vec3(0, 0, s.z), -size, size));
                break;
            }
        }
    }
    return mesh;
}

Mesh3 from_scene(const char* name) {
    const Geometry geometry = flatten(load_scene(name));
    return {geometry.positions, geometry.triangles, geometry.lower, geometry.upper};
}

class CubeTest : public DeviceTest {
  protected:
    struct Built {
        Cube cube;
        test::Tables tables;
    };
    Built build(ComputeBuilder& builder, const Mesh3& mesh, uint32_t resolution, Sampling sampling) {
        const TriangleBuffers triangles(device(), mesh.positions, mesh.triangles, mesh.lower, mesh.upper);
        Built built;
        builder.build(commands(), triangles, built.cube, resolution, sampling);
        built.tables = test::download(commands(), built.cube);
        return built;
    }
    Built build(const Mesh3& mesh, uint32_t resolution, Sampling sampling) {
        ComputeBuilder builder(device());
        return build(builder, mesh, resolution, sampling);
    }

    /// Compares the cube with the CPU's and checks every sample.
    void expect_right(const Mesh3& mesh, const Built& built, Sampling sampling) {
        const DecodedCube decoded(built.cube, built.tables);
        if (HasFatalFailure()) return;
        const CpuRaster cpu(built.cube.grid, mesh.positions, mesh.triangles);
        const auto expected = cpu.expect(sampling);
        EXPECT_EQ(built.cube.counts.degenerate, expected.degenerate);
        EXPECT_EQ(built.cube.counts.invalid, 0u);
        std::vector<uint64_t> lost, foreign;
        std::set_difference(expected.must.begin(), expected.must.end(), decoded.pairs.begin(), decoded.pairs.end(),
                            std::back_inserter(lost));
        std::set_difference(decoded.pairs.begin(), decoded.pairs.end(), expected.may.begin(), expected.may.end(),
                            std::back_inserter(foreign));
        EXPECT_TRUE(lost.empty()) << lost.size() << " of " << expected.must.size()
                                  << " lost; the first: " << describe(built.cube.grid, lost);
        EXPECT_TRUE(foreign.empty()) << foreign.size() << " of " << decoded.pairs.size()
                                     << " foreign; the first: " << describe(built.cube.grid, foreign);
        for (const auto& sample : decoded.samples) {
            const uint32_t axis = sample.id & 3;
            ASSERT_EQ(sample.data.y >> 28 & 3, axis);
            const auto seen = cpu.seen(sample.id >> 2, axis);
            const dvec3 corner = CpuRaster::permuted(dvec3(sample.voxel), axis);
            const double w = seen.plane(dvec2(corner) + 0.5) - corner.z,
                         stored = double(sample.data.x & 0xffff) * 5 / 65535 - 2;
            // Beside the packing's 4·10⁻⁵: coordinates up to 256 and slopes are floats.
            ASSERT_NEAR(stored, std::clamp(w, -2.0, 3.0), 4.4e-5 + 3e-4) << "triangle " << (sample.id >> 2);
            const auto slope = [&](uint32_t bits) { return double(int32_t(bits << 18) >> 18) * 1.25 / 8191; };
            ASSERT_NEAR(slope(sample.data.y), seen.slope.x, 7.8e-5);
            ASSERT_NEAR(slope(sample.data.y >> 14), seen.slope.y, 7.8e-5);
            ASSERT_TRUE(sampling == Sampling::centre || sample.data.x >> 16) << "no coverage";
        }
    }
    void expect_right(const Mesh3& mesh, uint32_t resolution) {
        for (const Sampling sampling : {Sampling::conservative, Sampling::centre}) {
            SCOPED_TRACE(testing::Message()
                         << "N = " << resolution << (sampling == Sampling::centre ? ", centre" : ", conservative"));
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

TEST_F(CubeTest, FarFromTheOrigin) {
    Mesh3 mesh = soup(4, 300, vec3(1), 2.0f / 64), moved;
    for (const auto& t : mesh.triangles)
        moved.add(mesh.positions[t.x] + vec3(500, -300, 100), mesh.positions[t.y] + vec3(500, -300, 100),
                  mesh.positions[t.z] + vec3(500, -300, 100));
    expect_right(moved, 64);
}

TEST_F(CubeTest, AFloorOfTwoTriangles) {
    for (const float tilt : {0.0f, 0.5f, 0.99f}) {
        Mesh3 mesh;
        const vec3 a(-1, -tilt, -1), b(1, tilt, -1), c(1, tilt, 1), d(-1, -tilt, 1);
        mesh.add(a, b, c);
        mesh.add(a, c, d);
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
        EXPECT_GT(build(mesh, resolution, Sampling::conservative).cube.counts.longest, 4000u);
    }
}

TEST_F(CubeTest, NothingButDegenerateTrianglesIsAnEmptyCube) {
    Mesh3 mesh;
    mesh.add({0, 0, 0}, {1, 1, 1}, {0, 0, 0});
    const Built built = build(mesh, 64, Sampling::conservative);
    expect_right(mesh, built, Sampling::conservative);
    EXPECT_EQ(built.cube.counts.fragments, 0u);
    EXPECT_EQ(built.tables.top[0], glm::uvec2(0, 3 | 3 << 10 | 3 << 20)) << "one box: everything";
}

TEST_F(CubeTest, TwoBuildsAreTheSameByteForByte) {
    for (const Sampling sampling : {Sampling::conservative, Sampling::centre}) {
        const Mesh3 mesh = soup(11, 800, vec3(1), 2.0f / 64);
        const Built first = build(mesh, 64, sampling), second = build(mesh, 64, sampling);
        EXPECT_TRUE(first.tables == second.tables);
        EXPECT_EQ(std::memcmp(&first.cube.counts, &second.cube.counts, sizeof(LdcCounters)), 0);
    }
}

TEST_F(CubeTest, OverflowsGrowAndAreRedone) {
    // Triangles of some 12 voxels: more than any first guess of large triangles, tiles, fragments, cells and nodes.
    Random random(5);
    Mesh3 many, deep, small;
    for (int i = 0; i < 7000; i++) {
        const vec3 centre = random.point(vec3(1)), reach(0.06f);
        many.add(centre + random.point(reach), centre + random.point(reach), centre + random.point(reach));
    }
    // 260 triangles in each of some 1300 voxels: more long lists than guessed.
    deep.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    for (int i = 0; i < 260; i++) deep.add({-0.5f, -0.5f, -0.5f}, {0.5f, 0.45f, -0.4f}, {-0.35f, 0.4f, 0.5f});
    small.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    const struct {
        const Mesh3& mesh;
        uint32_t resolution;
    } cases[] = {{many, 256}, {deep, 64}};
    for (const auto& c : cases) {
        ComputeBuilder builder(device());
        const Built first = build(builder, small, 16, Sampling::conservative);
        EXPECT_EQ(builder.redone(), 0u);
        const Built grown = build(builder, c.mesh, c.resolution, Sampling::conservative);
        const uint32_t redone = builder.redone();
        EXPECT_GT(redone, 0u);
        expect_right(c.mesh, grown, Sampling::conservative);
        // Now there is room: the same again in one go, and a small scene in large buffers.
        const Built again = build(builder, c.mesh, c.resolution, Sampling::conservative);
        EXPECT_EQ(builder.redone(), redone);
        EXPECT_TRUE(again.tables == grown.tables);
        EXPECT_TRUE(build(c.mesh, c.resolution, Sampling::conservative).tables == grown.tables);
        EXPECT_TRUE(build(builder, small, 16, Sampling::conservative).tables == first.tables);
        EXPECT_GT(builder.scratch_bytes(), uint64_t(grown.cube.counts.fragments) * 12);
    }
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
    for (const Sampling sampling : {Sampling::conservative, Sampling::centre}) {
        const Built built = build(mesh, 64, sampling);
        EXPECT_EQ(built.cube.counts.degenerate, 3u);
        EXPECT_EQ(built.cube.counts.invalid, 4u);
        std::vector<int> seen(mesh.triangles.size());
        for (const auto& sample : DecodedCube(built.cube, built.tables).samples) seen[sample.id >> 2]++;
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
    const TriangleBuffers triangles(device(), mesh.positions, mesh.triangles, vec3(0), vec3(10.1f));
    ComputeBuilder builder(device());
    Commands commands(device());
    Cube cube;
    expect_error([&] { builder.build(commands, triangles, cube, 16, Sampling::conservative); },
                 {"16001", "--ldc", "GPU"});
}

TEST_F(CubeTest, BytesAreWhatTheTablesUse) {
    const Built built = build(soup(3, 200, vec3(1, 0.5f, 0.2f), 2.0f / 64), 64, Sampling::conservative);
    const Cube::Bytes bytes = built.cube.bytes();
    EXPECT_EQ(bytes.top, built.tables.top.size() * 8);
    EXPECT_EQ(bytes.node, built.tables.node.size() * 4);
    EXPECT_EQ(bytes.voxel, built.tables.voxel.size() * 4);
    EXPECT_EQ(bytes.samples, built.tables.samples.size() * 12);
    EXPECT_EQ(bytes.total(), bytes.top + bytes.node + bytes.voxel + bytes.samples);
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
