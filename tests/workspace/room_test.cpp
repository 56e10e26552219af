// What becomes of a picture where the device binds or holds less than its cubes take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <vector>

#include "effort.h"
#include "image/temp_folder.h"
#include "made_pictures.h"

namespace peelray {
namespace {

/// A device that binds, or holds, only so many bytes, for every workspace that opens one meanwhile.
class Limit {
  public:
    Limit(const char* variable, uint64_t bytes) : variable_(variable) {
        ::setenv(variable, std::to_string(bytes).c_str(), 1);
    }
    ~Limit() { ::unsetenv(variable_); }
    Limit(const Limit&) = delete;
    Limit& operator=(const Limit&) = delete;

  private:
    const char* variable_;
};

constexpr const char *kBound = "PEELRAY_MOST_BOUND", *kHeld = "PEELRAY_MOST_HELD";

/// Of the field: whose samples take more than its corners, and both more than the nodes of its cube.
constexpr uint64_t kTriangles = 20'000;

/// `folder` holds a wavy height field.
class Room : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        constexpr int n = 100;
        std::string text;
        for (int y = 0; y <= n; y++)
            for (int x = 0; x <= n; x++)
                text += fmt::format("v {} {} {}\n", 0.1 * x, 0.5 * std::sin(0.2 * x) * std::cos(0.2 * y), 0.1 * y);
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++) {
                const int a = y * (n + 1) + x + 1, b = a + n + 1;
                text += fmt::format("f {} {} {}\nf {} {} {}\n", a, b + 1, a + 1, a, b, b + 1);
            }
        put("field.obj", text);
    }
    PictureArguments field() const { return small((folder / "field.obj").string()); }
    static PictureArguments small(const std::string& scene) {
        PictureArguments settings;
        settings.scene = scene;
        settings.size = {32, 24};
        settings.material = MaterialOverride::mirror;
        settings.background = glm::vec3(0.5f);  // a small environment
        return settings;
    }
};

struct Made : MadePicture {
    std::vector<std::string> notes;
    size_t noted(const std::string& part) const {
        size_t count = 0;
        for (const std::string& text : notes) count += text.find(part) != std::string::npos;
        return count;
    }
    const SceneCubes::Stats& cubes() const { return stats.render.cubes; }
    uint64_t bytes_of(const std::string& part) const {
        uint64_t bytes = 0;
        for (const Allocation& a : stats.render.peak_memory) bytes += a.part == part ? a.bytes : 0;
        return bytes;
    }
    /// Of the tables that stay.
    uint64_t largest_table() const {
        uint64_t bytes = 0;
        for (const Allocation& a : stats.render.memory)
            if (a.part == "cubes") bytes = std::max(bytes, a.bytes);
        return bytes;
    }
};

/// The picture, made twice by one workspace: notes come once.
Made make(const PictureArguments& settings) {
    Made made;
    Workspace workspace(settings, [&](const std::string& text) { made.notes.push_back(text); });
    static_cast<MadePicture&>(made) = workspace.render();
    expect_identical(workspace.render(), made);
    return made;
}

/// The line of the Error that `settings` give.
std::string refusal(const PictureArguments& settings) {
    try {
        Workspace(settings).render();
    } catch (const Error& error) {
        return error.line("--");
    }
    return "";
}

TEST_F(Room, AutoGoesCoarserWithTheSamePicture) {
    const Made all = make(field());
    EXPECT_EQ(all.cubes().no_room, "");
    EXPECT_EQ(all.noted("binds at once"), 0u);
    EXPECT_GT(all.stats.rays.reflection, 0u);
    const Limit limit(kBound, all.largest_table() * 3 / 4);
    const Made less = make(field());
    EXPECT_LT(less.cubes().resolution, all.cubes().resolution);
    EXPECT_EQ(less.stats.render.hit, HitTest::exact);
    EXPECT_NE(less.cubes().no_room.find("binds at once"), std::string::npos) << less.cubes().no_room;
    EXPECT_EQ(less.cubes().no_room_resolution, all.cubes().resolution);
    EXPECT_EQ(less.cubes().no_room_hit, HitTest::exact);
    EXPECT_EQ(less.noted("binds at once"), 1u);
    EXPECT_EQ(less.noted("planar"), 0u);
    expect_same_picture(less, all);
    // An explicit exact may become coarser, too: no hit depends on it.
    PictureArguments exact = field();
    exact.tracing.hit = HitTest::exact;
    const Made asked = make(exact);
    EXPECT_EQ(asked.cubes().resolution, less.cubes().resolution);
    expect_identical(asked, less);
}

TEST_F(Room, PlanarIsTheLastThatAutoTriesAndNeverStandsForAnExplicitExact) {
    // The corners of all triangles are one buffer, whatever the resolution.
    const Limit limit(kBound, kTriangles * 48 - 16);
    const Made made = make(field());
    EXPECT_EQ(made.stats.render.hit, HitTest::planar);
    EXPECT_EQ(made.cubes().no_room_hit, HitTest::exact);
    EXPECT_EQ(made.noted("by planar hits"), 1u);
    PictureArguments exact = field();
    exact.tracing.hit = HitTest::exact;
    EXPECT_NE(refusal(exact).find("use --hit auto"), std::string::npos) << refusal(exact);
    exact.tracing.ldc = 64;
    EXPECT_NE(refusal(exact).find("use --hit auto"), std::string::npos) << refusal(exact);
    exact.tracing.hit.reset();  // as the line says
    EXPECT_EQ(refusal(exact), "");
}

TEST_F(Room, AResolutionOfTheUserStays) {
    PictureArguments settings = field();
    settings.tracing.ldc = 128;
    const Made all = make(settings);
    EXPECT_EQ(all.stats.render.hit, HitTest::exact);
    const uint64_t bound = all.largest_table() * 9 / 10;
    ASSERT_GT(bound, kTriangles * 48) << "the samples decide, not the corners";
    const Limit limit(kBound, bound);
    const Made less = make(settings);
    EXPECT_EQ(less.stats.render.hit, HitTest::planar) << less.cubes().no_room;
    EXPECT_EQ(less.cubes().resolution, 128u);
    EXPECT_EQ(less.noted("by planar hits"), 1u);
    settings.tracing.hit = HitTest::exact;
    EXPECT_NE(refusal(settings).find("use --ldc auto"), std::string::npos) << refusal(settings);
    settings.tracing.ldc.reset();  // as the line says
    const Made coarser = make(settings);
    EXPECT_LT(coarser.cubes().resolution, 128u);
    expect_same_picture(coarser, all);
}

TEST_F(Room, EveryBuilderAndTraversal) {
    struct Case {
        BuilderKind builder;
        Traversal traversal;
        HitTest hit;
    };
    const std::vector<Case> all_cases = {{BuilderKind::compute, Traversal::voxel, HitTest::exact},
                                         {BuilderKind::abuffer, Traversal::voxel, HitTest::exact},
                                         {BuilderKind::compute, Traversal::two_level, HitTest::exact},
                                         {BuilderKind::abuffer, Traversal::mipmap, HitTest::exact},
                                         {BuilderKind::peel, Traversal::two_level, HitTest::planar}};
    // Every builder; the first two walk by voxel, as the other tests here do.
    for (const Case& c : std::span(all_cases).subspan(test::effort(2, 0))) {
        SCOPED_TRACE(fmt::format("{} {}", name_of(c.builder), name_of(c.traversal)));
        PictureArguments settings = field();
        settings.tracing.builder = c.builder;
        settings.tracing.traversal = c.traversal;
        settings.tracing.routing = Routing::draws;
        const Made all = make(settings);
        ASSERT_EQ(all.stats.render.hit, c.hit);
        const Limit limit(kBound, all.largest_table() * 19 / 20);
        const Made less = make(settings);
        EXPECT_LT(less.cubes().resolution, all.cubes().resolution);
        EXPECT_EQ(less.stats.render.hit, c.hit);
        EXPECT_NE(less.cubes().no_room, "");
        if (c.hit == HitTest::exact) expect_same_picture(less, all);
    }
}

TEST_F(Room, MemoryToo) {
    const Made all = make(field());
    uint64_t peak = 0;
    for (const Allocation& a : all.stats.render.peak_memory) peak += a.bytes;
    {
        const Limit limit(kHeld, peak * 9 / 10);
        const Made less = make(field());
        EXPECT_NE(less.cubes().no_room.find("has no room"), std::string::npos) << less.cubes().no_room;
        EXPECT_LT(less.cubes().resolution, all.cubes().resolution);
        expect_same_picture(less, all);
    }
    const Limit limit(kHeld, 100'000);
    const std::string line = refusal(field());
    EXPECT_NE(line.find("has no room"), std::string::npos) << line;
    EXPECT_NE(line.find("--tracer reference"), std::string::npos) << line;
}

/// Bytes of the largest buffer that planar hits by voxel need: fragments, or nodes.
uint64_t planar_need(const MadePicture& made) {
    const LdcCounters& counts = made.stats.render.cubes.counts;
    return std::max<uint64_t>(uint64_t(counts.fragments) * 12, uint64_t(counts.nodes) * 256);
}

TEST_F(Room, AMomentDoesNotDependOnThoseBefore) {
    PictureArguments settings = small("builtin:blob:5000");
    settings.animation = "swell";
    settings.tracing.hit = HitTest::planar;
    using Times = std::vector<double>;
    const Times times = test::effort(Times{0, 1.1, 0}, Times{0, 1.1, 0.3, 0});
    std::vector<MadePicture> alone;
    uint64_t least = ~0ull, most = 0;
    for (const double time : times) {
        settings.time = time;
        alone.push_back(Workspace(settings).render());
        least = std::min(least, planar_need(alone.back()));
        most = std::max(most, planar_need(alone.back()));
    }
    ASSERT_LT(least * 51 / 50, most) << "the number of samples changes";
    const Limit limit(kBound, (least + most) / 2);
    settings.time = 0;
    Workspace sequence(settings);
    size_t coarser = 0;
    for (size_t i = 0; i < std::size(times); i++) {
        const MadePicture one = sequence.render({.time = times[i]});
        settings.time = times[i];
        const MadePicture again = Workspace(settings).render();
        const SceneCubes::Stats &ours = one.stats.render.cubes, &theirs = again.stats.render.cubes;
        EXPECT_EQ(ours.resolution, theirs.resolution);
        expect_identical(one, again);
        EXPECT_EQ(ours.no_room, theirs.no_room);
        if (ours.no_room.empty()) expect_identical(one, alone[i]);
        coarser += !ours.no_room.empty();
    }
    EXPECT_GT(coarser, 0u);
    EXPECT_LT(coarser, std::size(times));
}

TEST_F(Room, NothingIsBuiltWhereNoRayIsTraced) {
    PictureArguments settings = field();
    settings.effects = {};
    const Made none = make(settings);
    EXPECT_EQ(none.cubes().bodies, 0u);
    EXPECT_EQ(none.bytes_of("cubes") + none.bytes_of("build scratch"), 0u);
    for (const PassTime& pass : none.stats.render.passes) EXPECT_FALSE(pass.name.starts_with("build/")) << pass.name;
    EXPECT_EQ(none.stats.rays.secondary(), 0u);
    // Whatever the device binds, as long as the scene fits.
    const Limit limit(kBound, kTriangles * 12 + 64);
    expect_identical(make(settings), none);
}

TEST_F(Room, ASceneThatTheDeviceCannotBindIsOneLine) {
    const Limit limit(kBound, kTriangles * 12 - 16);
    const std::string line = refusal(field());
    EXPECT_NE(line.find("20000 triangles"), std::string::npos) << line;
    EXPECT_NE(line.find("--tracer reference"), std::string::npos) << line;
    PictureArguments settings = field();
    settings.tracing.tracer = Tracer::reference;  // as the line says
    EXPECT_EQ(refusal(settings), "");
}

TEST(CutRays, AreNotedAboveATenthOfAPercent) {
    RayCounts rays;
    rays.primary = 10'000;
    rays.cut_refraction = 10;
    EXPECT_EQ(cut_note(rays, 4), "") << "0.1 % is not above it";
    rays.cut_refraction = 11;
    const std::string text = Error(cut_note(rays, 4)).line("--");
    EXPECT_NE(text.find("11 rays"), std::string::npos) << text;
    EXPECT_NE(text.find("--bounces 8 goes further"), std::string::npos) << text;
    EXPECT_EQ(Error(cut_note(rays, 16)).line("--").find("goes further"), std::string::npos) << "there is no more";
    EXPECT_NE(Error(cut_note(rays, 10)).line("--").find("--bounces 16"), std::string::npos);
    rays.primary = 10;
    rays.cut_refraction = 1;
    EXPECT_EQ(Error(cut_note(rays, 16)).line("--"),
              "1 ray (10.0 % of the camera's) would pass through more glass or blended surfaces than --bounces 16 "
              "follows: it sees the "
              "environment there");
}

TEST(CrowdedRays, AreCounted) {
    RayCounts rays;
    EXPECT_EQ(crowded_note(rays), "");
    rays.crowded = 1;
    EXPECT_EQ(crowded_note(rays).find("1 ray was in more than"), 0u) << crowded_note(rays);
    rays.crowded = 2;
    EXPECT_EQ(crowded_note(rays).find("2 rays were in more than"), 0u) << crowded_note(rays);
}

/// Five panes of glass, one behind the other, at the default of four bounces.
TEST_F(Room, PanesBehindEachOtherAreNotedByEveryTracer) {
    put("panes.mtl", "newmtl glass\nKd 1 1 1\nTf 1 1 1\nNi 1.5\nillum 4\n");
    const auto panes = [&](int count) {
        std::string text = "mtllib panes.mtl\nusemtl glass\n";
        for (int i = 0; i < count; i++)
            text += fmt::format("v -1 -1 {0}\nv 1 -1 {0}\nv 1 1 {0}\nv -1 1 {0}\nf -4 -3 -2 -1\n", -0.1 * i);
        PictureArguments settings = small(put(fmt::format("panes{}.obj", count), text).string());
        settings.material.reset();
        settings.eye = glm::vec3(0, 0, 4);
        settings.look = glm::vec3(0);
        return settings;
    };
    for (const Tracer tracer : {Tracer::ldc, Tracer::reference}) {
        PictureArguments five = panes(5), one = panes(1);
        five.tracing.tracer = one.tracing.tracer = tracer;
        const Made many = make(five), single = make(one);
        EXPECT_GT(many.stats.rays.cut_refraction, 32u) << name_of(tracer);
        EXPECT_EQ(many.noted("would pass through more glass"), 1u) << name_of(tracer);
        EXPECT_EQ(single.stats.rays.cut_refraction, 0u) << name_of(tracer);
        EXPECT_EQ(single.noted("more glass"), 0u) << name_of(tracer);
        five.bounces = 16;  // as the note says, twice
        EXPECT_EQ(make(five).noted("more glass"), 0u) << name_of(tracer);
    }
}

/// --memory-limit, at a size where the queues of rays take the most.
class MemoryLimit : public Room {
  protected:
    PictureArguments limited(std::optional<uint32_t> mib) const {
        PictureArguments settings = field();
        settings.size = {320, 240};
        settings.device.memory_limit = mib;
        return settings;
    }
};

TEST_F(MemoryLimit, PicturesAreMadeInBandsThatLeaveThemAsTheyAre) {
    const Made all = make(limited({}));
    EXPECT_EQ(all.stats.render.bands, 1u);
    // Room for all but the lower half of the queues.
    const auto mib = uint32_t((all.stats.render.peak_bytes - all.bytes_of("frame") * 2 / 5) >> 20);
    const Made less = make(limited(mib));
    EXPECT_GT(less.stats.render.bands, 1u);
    EXPECT_LE(less.stats.render.peak_bytes, uint64_t(mib) << 20);
    EXPECT_EQ(less.noted(fmt::format("memory-limit\x0f {}: the picture is made in {} bands of {} rows", mib,
                                     less.stats.render.bands, less.stats.render.band_rows)),
              1u);
    EXPECT_EQ(less.cubes().resolution, all.cubes().resolution);
    expect_identical(less, all);
}

TEST_F(MemoryLimit, ThenCubesBecomeCoarser) {
    const Made all = make(limited({}));
    const uint64_t least = all.bytes_of("scene") + all.bytes_of("triangles") + all.bytes_of("images");
    const auto mib = uint32_t((least + all.bytes_of("cubes")) >> 20);
    const Made less = make(limited(mib));
    EXPECT_LE(less.stats.render.peak_bytes, uint64_t(mib) << 20);
    EXPECT_LT(less.cubes().resolution, all.cubes().resolution);
    EXPECT_EQ(less.noted("has no room for another"), 1u);
    expect_same_picture(less, all);
}

TEST_F(MemoryLimit, TooLittleIsSaidInOneLine) {
    const std::string line = refusal(limited(1));
    EXPECT_NE(line.find("--memory-limit 1 has no room for another"), std::string::npos) << line;
    EXPECT_NE(line.find(": raise --memory-limit, or "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST_F(MemoryLimit, OnTheCpuThereIsNothingToLimit) {
    PictureArguments settings = limited(1);
    settings.tracing.tracer = Tracer::cpu;
    EXPECT_EQ(make(settings).noted("changes nothing"), 1u);
}

}  // namespace
}  // namespace peelray
