// All builders give the same cube: those of the graphics pipeline against `compute`, and against the CPU.
#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "decoded_pixels.h"
#include "effort.h"
#include "ldc/graphics_raster.h"
#include "meshes.h"
#include "single_cube.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using test::CpuRaster;
using test::DecodedCube;
using test::DecodedPixels;
using test::from_scene;
using test::kSnap;
using test::Mesh3;
using test::Random;
using test::shrink;
using test::soup;

/// By how much ldcCovers reaches beyond an edge's line, at most.
constexpr double kSlack = 1.5e-3;

struct Builder {
    BuilderKind kind;
    Routing routing;
};
constexpr Builder kGraphics[] = {{BuilderKind::abuffer, Routing::geometry},
                                 {BuilderKind::abuffer, Routing::draws},
                                 {BuilderKind::peel, Routing::geometry},
                                 {BuilderKind::peel, Routing::draws}};
constexpr Sampling kSamplings[] = {Sampling::conservative, Sampling::band, Sampling::centre};

std::string name_of(const Builder& builder, Sampling sampling, Traversal traversal) {
    const char* builders[] = {"compute", "abuffer", "peel"};
    const char* routings[] = {"geometry", "draws"};
    const char* samplings[] = {"conservative", "band", "centre"};
    return fmt::format("{} {} {} {}", builders[int(builder.kind)], routings[int(builder.routing)],
                       samplings[int(sampling)], traversal == Traversal::voxel ? "by voxel" : "by pixel");
}

/// A sample in either order, as far as it must be the same.
struct Found {
    uint32_t id;         ///< triangle · 4 + axis, of the whole triangle buffer
    glm::uvec3 cell;     ///< u, v and, by voxel, w
    glm::uvec4 data{0};  ///< by voxel: as it is stored
    float w = 0;         ///< by pixel

    auto key() const { return std::tuple(id, cell.y, cell.x, cell.z); }
};

class BuildersTest : public DeviceTest {
  protected:
    struct Built {
        LdcBody body;
        LdcCounters counts;
        std::vector<Found> samples;  ///< sorted by key
    };

    static CubeLayout layout_of(const Builder& builder, Traversal traversal, bool half = false) {
        CubeLayout layout;
        layout.traversal = traversal;
        layout.builder = builder.kind;
        layout.routing = builder.routing;
        layout.half_depth = half;
        return layout;
    }
    test::SingleCube cube_of(const Mesh3& mesh, uint32_t resolution, Sampling sampling, const CubeLayout& layout) {
        return {device(),   commands(), mesh.positions, mesh.triangles, mesh.lower,
                mesh.upper, resolution, sampling,       layout};
    }
    /// The samples of one body.
    std::vector<Found> samples_of(const Cubes& cubes, const LdcBody& body, const TableSize& size,
                                  const LdcCounters* whole) {
        std::vector<Found> found;
        if (cubes.layout().by_pixel()) {
            const test::PixelTables tables = test::download_pixels(commands(), cubes, size);
            const DecodedPixels decoded(body, tables);
            if (whole) decoded.expect_whole(*whole);
            for (const auto& s : decoded.samples) found.push_back({s.id, {s.pixel, 0}, {}, s.w});
        } else {
            const test::Tables tables = test::download(commands(), cubes, size);
            const DecodedCube decoded(body, tables);
            if (HasFatalFailure()) return {};
            if (whole) decoded.expect_whole(*whole);
            for (const auto& s : decoded.samples) {
                const uint32_t axis = s.id & 3;
                found.push_back({s.id, {s.voxel[(axis + 1) % 3], s.voxel[(axis + 2) % 3], s.voxel[axis]}, s.data, 0});
            }
        }
        std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.key() < b.key(); });
        return found;
    }
    Built look_at(const test::SingleCube& cube) {
        const LdcBody body = cube.cubes.table.download(commands())[0];
        return {body, cube.counts(), samples_of(cube.cubes, body, cube.builder.size(), &cube.counts())};
    }
    Built build(const Mesh3& mesh, uint32_t resolution, Sampling sampling, const CubeLayout& layout) {
        return look_at(cube_of(mesh, resolution, sampling, layout));
    }

    static double segment_distance(const dvec2& p, const dvec2& a, const dvec2& b) {
        const dvec2 e = b - a;
        const double length2 = glm::dot(e, e), t = length2 > 0 ? std::clamp(glm::dot(p - a, e) / length2, 0.0, 1.0) : 0;
        return glm::length(p - a - t * e);
    }
    /// How far the pixel's centre is from the nearest edge.
    static bool near_edge(const CpuRaster& cpu, const Found& f, uint32_t first_triangle) {
        const auto seen = cpu.seen((f.id >> 2) - first_triangle, f.id & 3);
        const dvec2 centre = dvec2(f.cell) + 0.5;
        if (std::abs(edge_distance(seen.corners, centre, 0)) <= kSlack) return true;
        for (size_t k = 0; k < 3; k++)
            if (segment_distance(centre, seen.corners[k], seen.corners[(k + 1) % 3]) <= kSnap) return true;
        return false;
    }

    /// `other` is the same cube as `compute`, but for samples at edges.
    static void expect_same(const Mesh3& mesh, const LdcBody& body, const std::vector<Found>& compute,
                            const std::vector<Found>& other, Sampling sampling) {
        const CpuRaster cpu(body.grid, mesh.positions, mesh.triangles);
        size_t lonely = 0;
        const auto alone = [&](const Found& f, const char* who) {
            lonely++;
            ASSERT_TRUE(sampling != Sampling::conservative && near_edge(cpu, f, body.first_triangle))
                << "only " << who << ": triangle " << (f.id >> 2) << " axis " << (f.id & 3) << " pixel " << f.cell.x
                << " " << f.cell.y;
        };
        auto a = compute.begin(), b = other.begin();
        while (a != compute.end() || b != other.end()) {
            if (b == other.end() || (a != compute.end() && a->key() < b->key())) {
                alone(*a++, "compute");
            } else if (a == compute.end() || b->key() < a->key()) {
                alone(*b++, "the other");
            } else {
                ASSERT_EQ(a->data, b->data);
                ASSERT_NEAR(a->w, b->w, 1e-3);
                a++, b++;
            }
            if (HasFatalFailure()) return;
        }
        EXPECT_LE(lonely, (compute.size() + other.size()) / 20 + 8) << "of " << compute.size();
    }
    /// Every builder, way, sampling and order.
    void expect_all_same(const Mesh3& mesh, uint32_t resolution, std::span<const Builder> builders = kGraphics) {
        for (const Sampling sampling : kSamplings)
            for (const Traversal traversal : {Traversal::voxel, Traversal::two_level}) {
                const Built compute = build(mesh, resolution, sampling, layout_of({}, traversal));
                for (const Builder& builder : builders) {
                    if (builder.kind == BuilderKind::peel && sampling == Sampling::conservative) continue;
                    SCOPED_TRACE(name_of(builder, sampling, traversal));
                    const Built other = build(mesh, resolution, sampling, layout_of(builder, traversal));
                    EXPECT_EQ(compute.counts.degenerate, other.counts.degenerate);
                    EXPECT_EQ(compute.counts.invalid, other.counts.invalid);
                    expect_same(mesh, compute.body, compute.samples, other.samples, sampling);
                    if (builder.kind == BuilderKind::peel) {
                        EXPECT_EQ(other.counts.passes, other.counts.complexity);
                        if (traversal != Traversal::voxel) {
                            EXPECT_EQ(other.counts.complexity, other.counts.longest);
                        }
                    }
                    if (HasFailure()) return;
                }
            }
    }

    /// The by-pixel cube against the CPU. Must: the pixel's centre is inside by more than 1/128, or, conservatively,
    /// its square touches the triangle. May: it is outside by no more than that.
    void expect_right(const Mesh3& mesh, const Built& built, Sampling sampling, bool half) {
        const CubeGrid& grid = built.body.grid;
        const CpuRaster cpu(grid, mesh.positions, mesh.triangles);
        const bool conservative = sampling == Sampling::conservative;
        uint32_t degenerate = 0;
        std::vector<std::tuple<uint32_t, uint32_t, uint32_t>> keys;
        for (const Found& f : built.samples) {
            keys.emplace_back(f.id, f.cell.y, f.cell.x);
            const auto seen = cpu.seen(f.id >> 2, f.id & 3);
            const dvec2 centre = dvec2(f.cell) + 0.5;
            const double distance = edge_distance(seen.corners, centre, conservative ? 0.5 : 0);
            ASSERT_TRUE(distance > (conservative ? -2e-3 : -kSnap) || near_edge(cpu, f, 0));
            const double w = seen.plane(centre);
            ASSERT_NEAR(f.w, w, 3e-4 + (half ? w / 2048 : 0));
        }
        for (uint32_t i = 0; i < mesh.triangles.size(); i++) {
            const dvec3 m = glm::abs(cpu.normal(i));
            const double largest = std::max({m.x, m.y, m.z});
            if (largest == 0) {
                degenerate++;
                continue;
            }
            for (uint32_t axis = 0; axis < 3; axis++) {
                // Sure to be captured there: no tie, and not at the limit of the overlap band.
                const double share = m[int(axis)] / largest, rest = std::max(m[(axis + 1) % 3], m[(axis + 2) % 3]);
                const bool sure = sampling == Sampling::band ? share > 0.8 + 1e-6 : m[int(axis)] > rest * (1 + 1e-6);
                if (sure) expect_held(cpu.seen(i, axis), i << 2 | axis, conservative, keys);
            }
        }
        EXPECT_EQ(degenerate, built.counts.degenerate);
    }

  private:
    static void expect_held(const test::SeenTriangle& seen, uint32_t id, bool conservative,
                            const std::vector<std::tuple<uint32_t, uint32_t, uint32_t>>& keys) {
        dvec2 low(seen.corners[0]), high = low;
        for (const dvec3& p : seen.corners) low = glm::min(low, dvec2(p)), high = glm::max(high, dvec2(p));
        for (int y = int(std::floor(low.y)); y <= int(std::floor(high.y)); y++)
            for (int x = int(std::floor(low.x)); x <= int(std::floor(high.x)); x++) {
                const double distance = edge_distance(seen.corners, {x + 0.5, y + 0.5}, conservative ? 0.5 : 0);
                if (distance < (conservative ? 0 : kSnap)) continue;
                ASSERT_TRUE(std::binary_search(keys.begin(), keys.end(), std::tuple(id, uint32_t(y), uint32_t(x))))
                    << "triangle " << (id >> 2) << " axis " << (id & 3) << " pixel " << x << " " << y << " is lost";
            }
    }
};

TEST_F(BuildersTest, SoupsInACubicBox) {
    const uint32_t count = test::effort(80u, 250u);
    for (const uint32_t resolution : {16u, 64u, 144u})
        expect_all_same(soup(resolution, resolution == 144 ? count * 2 / 5 : count, vec3(1), 2.0f / float(resolution)),
                        resolution);
}

TEST_F(BuildersTest, SoupsInLongAndFlatBoxes) {
    expect_all_same(soup(1, test::effort(60, 150), vec3(1, 0.3f, 0.6f), 2.0f / 64), 64);
    expect_all_same(soup(2, test::effort(40, 100), vec3(0.02f, 5, 0.9f), 10.0f / 128), 128);
}

TEST_F(BuildersTest, FarFromTheOrigin) {
    expect_all_same(test::moved(soup(4, 150, vec3(1), 2.0f / 64), vec3(500, -300, 100)), 64);
}

TEST_F(BuildersTest, AFloorOfTwoTriangles) {
    for (const float tilt : {0.0f, 0.5f, 0.99f}) {
        const Mesh3 mesh = test::tilted_floor(tilt);
        for (const uint32_t resolution : {16u, 64u}) expect_all_same(mesh, resolution);
    }
}

TEST_F(BuildersTest, BuiltInScenes) {
    using Names = std::vector<const char*>;
    for (const char* name : test::effort(Names{"builtin:blob:5000"}, Names{"builtin:teapots", "builtin:blob:5000"})) {
        SCOPED_TRACE(name);
        expect_all_same(from_scene(name), 64);
    }
}

TEST_F(BuildersTest, AgreeWithTheCpuByPixel) {
    const Mesh3 mesh = soup(31, 200, vec3(1, 0.7f, 0.4f), 2.0f / 80);
    for (const Sampling sampling : kSamplings)
        for (const Builder& builder : {Builder{}, kGraphics[0], kGraphics[1], kGraphics[2], kGraphics[3]})
            for (const bool half : {false, true}) {
                if (builder.kind == BuilderKind::peel && sampling == Sampling::conservative) continue;
                SCOPED_TRACE(name_of(builder, sampling, Traversal::mipmap) + (half ? ", 16 bits" : ""));
                const CubeLayout layout = layout_of(builder, Traversal::mipmap, half);
                expect_right(mesh, build(mesh, 80, sampling, layout), sampling, half);
                if (HasFailure()) return;
            }
}

TEST_F(BuildersTest, CoplanarFragmentsAreAllThere) {
    // Hundreds of the same triangle, some turned over, with others before, between and behind.
    const int count = test::effort(300, 1000);
    Mesh3 mesh;
    mesh.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    const vec3 a(-0.5f, -0.5f, 0.1f), b(0.5f, -0.4f, 0.15f), c(0, 0.5f, 0.2f);
    for (int i = 0; i < count; i++) {
        if (i % 3)
            mesh.add(a, b, c);
        else
            mesh.add(b, a, c);
        if (i % 100 == 50) mesh.add(a + vec3(0, 0, 0.01f * float(i - count / 2)), b, c);
    }
    expect_all_same(mesh, 16, std::span(kGraphics, 2));
    for (const bool half : {false, true}) {
        const Built built = build(mesh, 16, Sampling::centre, layout_of(kGraphics[2], Traversal::two_level, half));
        EXPECT_GE(built.counts.complexity, uint32_t(count));
        EXPECT_EQ(built.counts.passes, built.counts.complexity);
        expect_right(mesh, built, Sampling::centre, half);
    }
    const Built compute = build(mesh, 16, Sampling::band, layout_of({}, Traversal::voxel));
    const Built peel = build(mesh, 16, Sampling::band, layout_of(kGraphics[3], Traversal::voxel));
    expect_same(mesh, compute.body, compute.samples, peel.samples, Sampling::band);
}

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

TEST_F(BuildersTest, ThousandsOfSliversInOnePixel) {
    // As around a pole: the pixel at the pole sees all of them.
    const int slivers = test::effort(1100, 2500);
    Mesh3 mesh;
    mesh.add({-1, -1, -1}, {1, 1, 1}, {-1, 1, -1});
    for (int i = 0; i < slivers; i++) {
        const float p = 6.2831853f * float(i) / float(slivers), q = p + 0.4f, y = 0.3f + 1e-4f * float(i % 7);
        mesh.add({0.05f, y, 0.05f}, {0.05f + 0.3f * std::cos(p), y, 0.05f + 0.3f * std::sin(p)},
                 {0.05f + 0.3f * std::cos(q), y, 0.05f + 0.3f * std::sin(q)});
    }
    for (int i = 0; i < slivers * 22 / 25; i++)
        mesh.add({-0.6f, 0.6f, -0.6f}, {-0.4f, 0.6f, -0.6f}, {-0.5f, 0.6f + 1e-5f * float(i), -0.35f});
    expect_all_same(mesh, 16, std::span(kGraphics, 2));
    const Built compute = build(mesh, 16, Sampling::centre, layout_of({}, Traversal::two_level));
    const Built peel = build(mesh, 16, Sampling::centre, layout_of(kGraphics[2], Traversal::two_level));
    expect_same(mesh, compute.body, compute.samples, peel.samples, Sampling::centre);
    EXPECT_GT(peel.counts.complexity, uint32_t(slivers) * 4 / 5);
}

TEST_F(BuildersTest, DegenerateAndInvalidTrianglesAreCountedAndDropped) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const vec3 a(-1, -1, -1), b(1, 1, 0.5f), c(-0.5f, 1, 1);
    Mesh3 mesh;
    mesh.add(a, b, c);
    mesh.add(a, a, c);
    mesh.add(c, c, c);
    mesh.add({-1, 0, 0}, {0, 0, 0}, {0.5f, 0, 0});
    mesh.add({nan, 0, 0}, b, c);
    mesh.add(a, {0, inf, 0}, c);
    mesh.add(a, b, {0, 0, -inf});
    mesh.add({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan});
    mesh.add(a, c, {0.3f, 0.2f, 0.1f});
    expect_all_same(mesh, 64);
    for (const Builder& builder : kGraphics) {
        const Built built = build(mesh, 64, Sampling::band, layout_of(builder, Traversal::two_level));
        EXPECT_EQ(built.counts.degenerate, 3u);
        EXPECT_EQ(built.counts.invalid, 4u);
    }
}

TEST_F(BuildersTest, NothingButDegenerateTrianglesIsAnEmptyCube) {
    Mesh3 mesh;
    mesh.add({0, 0, 0}, {1, 1, 1}, {0, 0, 0});
    expect_all_same(mesh, 32);
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

/// A device that lacks something, for a while.
class Without {
  public:
    explicit Without(Device& device) : device_(device), features_(device.features) {}
    ~Without() { device_.features = features_; }

  private:
    Device& device_;
    DeviceFeatures features_;
};

TEST_F(BuildersTest, WithoutSubgroupsAndWithoutTheExtension) {
    const Without guard(device());
    device().features.fragment_subgroups = false;
    device().features.overestimation = 0;
    expect_all_same(soup(6, 200, vec3(1), 2.0f / 64), 64, std::span(kGraphics, 2));
}

TEST_F(BuildersTest, SayWhatADeviceLacks) {
    const Mesh3 mesh = soup(7, 10, vec3(1), 2.0f / 16);
    const auto built = [&](const Builder& builder, Sampling sampling) {
        return
            [&mesh, this, builder, sampling] { build(mesh, 16, sampling, layout_of(builder, Traversal::two_level)); };
    };
    expect_error(built(kGraphics[2], Sampling::conservative),
                 {"--builder peel captures pixel centres, not all that a triangle touches", "--hit planar or tolerance",
                  "--builder abuffer or compute"});
    const Without guard(device());
    device().features.geometry_shader = false;
    expect_error(built(kGraphics[0], Sampling::band), {device().info().name, "geometry shader", "--routing draws"});
    expect_error(built(kGraphics[2], Sampling::band), {device().info().name, "geometry shader", "--routing draws"});
    built(kGraphics[1], Sampling::band)();
    device().features.first_instance = false;
    expect_error(built(kGraphics[3], Sampling::band),
                 {device().info().name, "--routing geometry", "--builder abuffer"});
    built(kGraphics[1], Sampling::band)();
    device().features.fragment_stores = false;
    for (const Builder& builder : kGraphics)
        expect_error(built(builder, Sampling::band), {device().info().name, "--builder compute"});
    built({}, Sampling::band)();

    VkPhysicalDeviceLimits limits = device().limits();
    limits.maxFramebufferWidth = 1024;
    expect_error(
        [&] {
            check_builder({true, true, true, true, true, 0}, limits, "small", layout_of(kGraphics[2], Traversal::voxel),
                          Sampling::band, 1040);
        },
        {"small", "1024", "1040", "--ldc", "--builder compute"});
}

}  // namespace
}  // namespace peelray
