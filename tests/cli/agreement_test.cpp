// The method's pictures against the reference's: the numbers to reach (docs/accuracy.md), at a size that a test can
// afford.
#include "cli/program_fixture.h"

namespace peelray {
namespace {

struct Case {
    std::string name;
    std::vector<std::string> words;  ///< the scene and options
};

class Agreement : public ProgramTest, public testing::WithParamInterface<Case> {};

TEST_P(Agreement, WithTheReference) {
    std::vector<std::string> words = GetParam().words;
    if (!words[0].starts_with("builtin:")) {
        words[0] = PEELRAY_MODELS "/" + words[0];
        if (!std::filesystem::exists(words[0])) GTEST_SKIP() << "the test models are not here: " << words[0];
    }
    std::vector<std::string> arguments = {"compare", words[0], "-o", out("r.html"), "--json", out("r.json")};
    arguments.insert(arguments.end(), {"--size", "400x320", "--tracers", "ldc,reference", "--hit", "exact,planar"});
    arguments.insert(arguments.end(), words.begin() + 1, words.end());
    const Outcome run = this->run(arguments);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto pictures = nlohmann::json::parse(get(out("r.json")))["pictures"];
    const auto exact = pictures[0]["difference"], planar = pictures[1]["difference"];
    fmt::print("  exact: FLIP {:.5f}, {:.4f} % of pixels off; planar: FLIP {:.5f}\n", exact["flip"].get<double>(),
               exact["share_different"].get<double>() * 100, planar["flip"].get<double>());
    EXPECT_LE(exact["flip"], 0.002);
    EXPECT_LE(exact["share_different"], 0.001);
    EXPECT_LE(planar["flip"], 0.02);
    // The rays themselves are the same: what is traced is decided alike.
    for (const char* kind : {"primary", "reflection", "refraction", "shadow"}) {
        const double ours = pictures[0]["stats"]["rays"][kind], theirs = pictures[2]["stats"]["rays"][kind];
        EXPECT_NEAR(ours, theirs, 1e-3 * theirs + 2) << kind;
    }
}

const std::string kMesh = "meshes/";
INSTANTIATE_TEST_SUITE_P(
    Scenes, Agreement,
    testing::Values(
        Case{"teapots", {"builtin:teapots", "--ldc", "1024"}}, Case{"glass", {"builtin:glass", "--ldc", "1024"}},
        Case{"tree", {"builtin:tree", "--ldc", "1024"}}, Case{"blob", {"builtin:blob:20000", "--ldc", "1024"}},
        Case{"samples",
             {"builtin:teapots", "--ldc", "1024", "--spp", "3", "--effects", "reflection,refraction,shadow,ambient"}},
        Case{"bunny", {"meshes/bunny_7k.off", "--material", "mirror", "--floor", "--ldc", "1024"}},
        Case{"car", {"meshes/car2.glb", "--floor", "--ldc", "1024"}},
        Case{"TransmissionTest", {"gltf/TransmissionTest.glb", "--ldc", "1024"}},
        Case{"tiny", {"skinned/tiny.glb", "--animation", "Walk", "--time", "0.4", "--floor", "--ldc", "1024"}},
        Case{"CesiumMan", {"skinned/CesiumMan.glb", "--time", "0.7", "--floor", "--ldc", "1024"}},
        Case{"MorphCube", {"skinned/AnimatedMorphCube.glb", "--time", "1.3", "--floor", "--ldc", "1024"}},
        Case{"InterpolationTest",
             {"skinned/InterpolationTest.glb", "--animation", "all", "--time", "0.6", "--ldc", "1024"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace peelray
