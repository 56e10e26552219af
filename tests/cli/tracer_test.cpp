// Which tracer draws a picture that names none, and how near the one on the CPU comes to the reference. The tests'
// device is a software device.
#include "cli/program_fixture.h"

namespace peelray {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

class TracerTest : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("cube.obj", kCube);
    }
    Json stats_of(Words more) {
        more.insert(more.end(), {"--stats", out("s.json")});
        last_ = render(in("cube.obj"), more);
        EXPECT_EQ(last_.status, 0) << last_.err;
        return Json::parse(get(out("s.json")));
    }
    Outcome last_;
};

/// How many passes build cubes.
int cube_passes(const Json& stats) {
    int count = 0;
    for (const Json& pass : stats["passes"]) count += pass["name"].get<std::string>().starts_with("build/ldc_");
    return count;
}

TEST_F(TracerTest, ASoftwareDeviceIsLeftToTheCpu) {
    const Json stats = stats_of({"--material", "mirror"});
    EXPECT_EQ(stats["tracer"], "cpu");
    EXPECT_EQ(stats["hit"], "single");
    EXPECT_EQ(cube_passes(stats), 0);
    EXPECT_NE(last_.out.find(" rays by cpu; BVH "), std::string::npos) << last_.out;
    EXPECT_EQ(stats_of({"--tracer", "auto"})["tracer"], "cpu");
    EXPECT_EQ(stats_of({"--device", "0"})["tracer"], "cpu") << "the kind of the device decides";
    remove_outputs();
    expect_refused(render(in("cube.obj"), {"--device", "no such device"}), 1, "no Vulkan device 'no such device'");
}

/// Whoever speaks of cubes, or wants to have a device measured or checked, means them.
TEST_F(TracerTest, OptionsOfTheCubesChooseThem) {
    const Words mirror = {"--material", "mirror", "--size", "16x16"};
    for (const Words& words : {Words{"--hit", "auto"}, {"--counters"}, {"--aov", "cost_steps"}, {"--validate"}}) {
        SCOPED_TRACE(words[0]);
        Words all = words;
        all.insert(all.end(), mirror.begin(), mirror.end());
        const Json stats = stats_of(all);
        EXPECT_EQ(stats["tracer"], "ldc");
        EXPECT_GT(cube_passes(stats), 0);
    }
    EXPECT_EQ(stats_of({"--tracer", "cpu", "--ldc", "32"})["tracer"], "cpu") << "what is said is done";
}

TEST_F(TracerTest, TheManifestNamesWhatAutoStandsFor) {
    ASSERT_EQ(render(in("cube.obj"), {"--turntable", "2"}, "f%d.png").status, 0);
    const Json manifest = Json::parse(get(out("f%d.png.json")));
    EXPECT_EQ(manifest["settings"]["--tracer"], "cpu");
    EXPECT_TRUE(manifest["device"].get<std::string>().starts_with("cpu, Embree"));
}

/// The same samples of the same rays, in single precision.
TEST_F(TracerTest, CpuIsNearTheReference) {
    for (const Words& words : {Words{"builtin:teapots"},
                               {"builtin:glass"},
                               {"builtin:leaves"},
                               {"builtin:walker"},
                               {"builtin:room", "--effects", "reflection,refraction,shadow,ambient", "--gi", "1"},
                               {in("cube.obj"), "--material", "glass", "--floor", "--spp", "4"}}) {
        SCOPED_TRACE(words[0]);
        Words all = {"compare",   words[0],        "-o",     out("r.html"), "--json", out("r.json"),
                     "--tracers", "cpu,reference", "--size", "200x160"};
        all.insert(all.end(), words.begin() + 1, words.end());
        ASSERT_EQ(run(all).status, 0);
        const Json difference = Json::parse(get(out("r.json")))["pictures"][0]["difference"];
        EXPECT_LT(difference["flip"], 0.002);
        EXPECT_LT(difference["share_different"], 0.002);
    }
}

}  // namespace
}  // namespace peelray
