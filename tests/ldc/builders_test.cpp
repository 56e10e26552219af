// All builders give the same cube: those of the graphics pipeline against `compute`, and against the CPU.
#include "builders_fixture.h"
#include "effort.h"

namespace peelray {
namespace {

using glm::vec3;
using test::Builder;
using test::BuildersTest;
using test::from_scene;
using test::kGraphics;
using test::kSamplings;
using test::Mesh3;
using test::name_of;
using test::soup;

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
