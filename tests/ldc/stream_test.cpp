// Drawn streams: a tessellated patch with a hole and ribbons displaced in the vertex stage, against the same triangles
// made on the CPU.
#include <glm/gtc/packing.hpp>
#include <map>

#include "../gpu/device_fixture.h"
#include "decoded_cube.h"
#include "decoded_pixels.h"
#include "gpu/shader_table.h"
#include "meshes.h"
#include "single_cube.h"

namespace peelray {
std::span<const EmbeddedShader> stream_shaders();

namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec2;
using glm::vec3;
using test::CpuRaster;
using test::DecodedPixels;
using test::kSnap;
using test::Mesh3;

constexpr uint32_t kLevel = 6, kRibbon = 1000;

float height(float x) {
    return 0.7f * x * (1 - x * x);
}
vec3 normal_of(float x) {
    return glm::normalize(vec3(-0.7f * (1 - 3 * x * x), 0, 1));
}

class StreamTest : public DeviceTest {
  protected:
    static void SetUpTestSuite() {
        static const bool once = (register_shaders(stream_shaders()), true);
        (void)once;
    }
    void SetUp() override {
        DeviceTest::SetUp();
        const uint32_t n = 2 * kLevel;
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++) {
                const auto at = [&](uint32_t i, uint32_t j) {
                    const vec2 p = vec2(i, j) / float(kLevel) - 1.0f;
                    return vec3(p, height(p.x));
                };
                quad(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
            }
        wave_ = uint32_t(mesh_.triangles.size());
        for (const vec2& place : places_)
            for (uint32_t i = 0; i < 16; i++) {
                const auto at = [&](uint32_t k, float side) {
                    const float x = -1 + float(k) / 8;
                    return vec3(x, place.x + height(x), place.y + side);
                };
                quad(at(i, 0), at(i + 1, 0), at(i + 1, 0.2f), at(i, 0.2f));
            }
    }
    void quad(const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
        mesh_.add(a, b, c);
        mesh_.add(a, c, d);
    }
    /// -1: in the hole, 1: not, 0: too near its rim to tell.
    static int hole(const vec2& p) {
        const float r = glm::distance(p, vec2(0.3f, -0.2f));
        return r < 0.38f ? -1 : r > 0.42f ? 1 : 0;
    }

    Mesh3 mesh_;
    uint32_t wave_ = 0;  ///< triangles of it
    std::vector<vec2> places_ = {{0.2f, 0.5f}, {-0.4f, -0.9f}, {0, 0.1f}};
};

TEST_F(StreamTest, GivesTheCubeOfTheSameTriangles) {
    const Buffer places = upload(places_);
    // The wave's four patches in two draws; the last two ribbons.
    const Buffer patches = upload(std::vector<DrawArguments>{{8, 1, 0, 0}, {8, 1, 8, 0}}),
                 ribbons = upload(std::vector<DrawArguments>{{96, 1, 0, 0}, {96, 2, 0, 1}});
    const TriangleBuffers triangles(device(), mesh_.positions, mesh_.triangles);
    const std::vector<CubeBody> bodies = {{0, uint32_t(mesh_.triangles.size()), 64, vec3(-1.1f), vec3(1.1f)}};
    for (const Sampling sampling : {Sampling::band, Sampling::centre}) {
        CubeLayout layout;
        layout.traversal = Traversal::two_level;
        Cubes expected(device(), bodies, sampling, layout);
        CubeBuilder compute(device(), commands(), expected, 0, 1);
        compute.build(commands(), triangles);
        layout.builder = BuilderKind::abuffer;
        layout.streams = true;
        Cubes cubes(device(), bodies, sampling, layout);
        CubeBuilder builder(device(), commands(), cubes, 0, 1);
        builder.set_streams({{"stream_wave", "stream_holes", 4, {}, {{"LEVEL", kLevel}}, &patches, 2, 0},
                             {"stream_ribbons", "stream_holes", 0, {{"places", places}}, {}, &ribbons, 2, 0}});
        builder.build(commands(), triangles);

        const LdcBody body = cubes.table.download(commands())[0];
        const auto tables = test::download_pixels(commands(), cubes, builder.size()),
                   others = test::download_pixels(commands(), expected, compute.size());
        const auto attributes = commands().download<glm::uvec2>(cubes.sample_attributes, tables.ids.size());
        LdcBody numbered = body;
        numbered.triangles = 2000;  // the streams' own numbers
        const DecodedPixels found(numbered, tables), wanted(body, others);
        found.expect_whole(builder.counts());

        const CpuRaster cpu(body.grid, mesh_.positions, mesh_.triangles);
        using Pixel = std::tuple<uint32_t, uint32_t, uint32_t>;
        const auto pixel_of = [](const DecodedPixels::Sample& s) { return Pixel(s.axis, s.pixel.x, s.pixel.y); };
        const auto point_of = [&](const DecodedPixels::Sample& s) {
            vec3 p;
            p[(s.axis + 1) % 3] = float(s.pixel.x) + 0.5f;
            p[(s.axis + 2) % 3] = float(s.pixel.y) + 0.5f;
            p[s.axis] = s.w;
            return p * body.grid.voxel + body.grid.origin;
        };
        std::multimap<Pixel, const DecodedPixels::Sample*> have, want;
        for (const auto& s : found.samples) have.emplace(pixel_of(s), &s);
        for (const auto& s : wanted.samples) want.emplace(pixel_of(s), &s);
        const auto holds = [](const auto& map, const Pixel& pixel, float w) {
            const auto [from, to] = map.equal_range(pixel);
            return std::count_if(from, to, [&](auto& other) { return std::abs(other.second->w - w) < 2e-3f; });
        };
        uint32_t cut = 0, sure = 0;
        for (const auto& s : wanted.samples) {
            const auto seen = cpu.seen(s.id >> 2, s.axis);
            const int here = (s.id >> 2) < wave_ ? hole(point_of(s)) : 1;
            if (here == 0 || edge_distance(seen.corners, dvec2(s.pixel) + 0.5, 0) < kSnap) continue;
            ASSERT_EQ(holds(have, pixel_of(s), s.w), here > 0 ? 1 : 0) << "triangle " << (s.id >> 2);
            (here > 0 ? sure : cut)++;
        }
        EXPECT_GT(sure, 3000u);
        EXPECT_GT(cut, 200u);
        uint32_t foreign = 0;
        for (const auto& s : found.samples) foreign += holds(want, pixel_of(s), s.w) == 0;
        EXPECT_LE(foreign, found.samples.size() / 50) << "at the rims, where corners are rounded";
        uint64_t at = 0;
        for (const uint32_t index : found.places) {
            const auto& s = found.samples[at++];
            const bool ribbon = s.id >> 2 >= kRibbon;
            const vec3 p = point_of(s), normal = normal_of(p.x);
            const vec3 stored_normal(glm::unpackSnorm4x8(attributes[index].x));
            const glm::vec4 color = glm::unpackUnorm4x8(attributes[index].y);
            ASSERT_LT(glm::distance(stored_normal, ribbon ? vec3(normal.x, normal.z, normal.y) : normal), 0.03f);
            ASSERT_NEAR(color.x, 0.5f + 0.5f * p.x, 0.01f);
            ASSERT_NEAR(color.y, ribbon ? 0.5f : 0.5f + 0.5f * p.y, 0.01f);
            ASSERT_EQ(color.z, ribbon ? 1 : 0);
            ASSERT_LT(s.id >> 2, ribbon ? kRibbon + 3 : 4);
        }
    }
}

TEST_F(StreamTest, SayWhatCapturesThem) {
    CubeLayout layout;
    layout.streams = true;
    Cubes cubes(device(), {{0, 0, 16, vec3(0), vec3(1)}}, Sampling::band, layout);
    expect_error([&] { CubeBuilder(device(), commands(), cubes, 0, 1); },
                 {"--builder abuffer", "--routing geometry", "two-level", "planar"});
}

}  // namespace
}  // namespace peelray
