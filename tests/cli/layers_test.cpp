// `--exr-layers`: the channels of the one file, by the names that other programs look for.
#include <map>
#include <set>

#include "cli/channels.h"
#include "cli/sequence_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

class Layers : public SequenceTest {
  protected:
    void SetUp() override {
        SequenceTest::SetUp();
        put("cube.obj", kCube);
    }
    static Words names_of(const std::filesystem::path& path) {
        Imf::InputFile file(path.c_str());
        Words names;
        for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c)
            names.push_back(c.name());
        return names;
    }
    static std::vector<std::string> layers_of(const std::filesystem::path& path) {
        Imf::InputFile file(path.c_str());
        std::set<std::string> layers;
        file.header().channels().layers(layers);
        return {layers.begin(), layers.end()};
    }
    /// One channel of channels_of().
    static std::vector<float> channel(const std::filesystem::path& path, const std::string& name) {
        const Words names = names_of(path);
        const auto at = std::find(names.begin(), names.end(), name);
        EXPECT_NE(at, names.end()) << name;
        const std::vector<float> all = channels_of(path);
        const size_t pixels = all.size() / names.size(), first = size_t(at - names.begin()) * pixels;
        return {all.begin() + long(first), all.begin() + long(first + pixels)};
    }
};

const Words kView = {"--eye", "0.5,0.6,3", "--look", "0.5,0.5,0"};

Words with(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST_F(Layers, AllInOneFile) {
    for (const std::string tracer : {"ldc", "reference"}) {
        remove_outputs();
        const Words all = with(kView, {"--aov", "all", "--tracer", tracer});
        expect_done(render(in("cube.obj"), with(all, {"--exr-layers"}), "a.exr"), {"a.exr"});
        EXPECT_EQ(names_of(out("a.exr")),
                  (Words{"A",          "B",          "G",          "R",          "Vector.W",  "Vector.X",
                         "Vector.Y",   "Vector.Z",   "albedo.B",   "albedo.G",   "albedo.R",  "backward.u",
                         "backward.v", "depth.Z",    "instance.X", "material.X", "normal.X",  "normal.Y",
                         "normal.Z",   "position.X", "position.Y", "position.Z", "triangle.X"}));
        EXPECT_EQ(layers_of(out("a.exr")), (Words{"Vector", "albedo", "backward", "depth", "instance", "material",
                                                  "normal", "position", "triangle"}));
        // The same as beside it, and the picture is the same picture.
        const Image layered = read_hdr(out("a.exr"));
        expect_done(render(in("cube.obj"), all, "b.exr"),
                    {"a.exr", "b.albedo.exr", "b.depth.exr", "b.exr", "b.instance.exr", "b.material.exr",
                     "b.motion.exr", "b.normal.exr", "b.position.exr", "b.triangle.exr"});
        EXPECT_EQ(layered.pixels, read_hdr(out("b.exr")).pixels);
        for (const auto& [kind, names] : std::map<std::string, Words>{{"albedo", {"B", "G", "R"}},
                                                                      {"depth", {"Z"}},
                                                                      {"instance", {"instance"}},
                                                                      {"motion", {"X", "Y"}},
                                                                      {"normal", {"X", "Y", "Z"}}})
            EXPECT_EQ(names_of(out("b." + kind + ".exr")), names) << kind;
        EXPECT_EQ(channel(out("a.exr"), "normal.Y"), channel(out("b.normal.exr"), "Y"));
        EXPECT_EQ(channel(out("a.exr"), "depth.Z"), channel(out("b.depth.exr"), "Z"));
        EXPECT_EQ(channel(out("a.exr"), "triangle.X"), channel(out("b.triangle.exr"), "triangle"));
        EXPECT_EQ(channel(out("a.exr"), "instance.X")[0], -1);
        EXPECT_EQ(channel(out("a.exr"), "instance.X")[24 * 64 + 32], 0);
    }
}

TEST_F(Layers, PictureAndAuxiliariesInTheirPrecision) {
    expect_done(render(in("cube.obj"), with(kView, {"--aov", "depth", "--exr-layers"}), "a.EXR"), {"a.EXR"});
    Imf::InputFile file(out("a.EXR").c_str());
    EXPECT_EQ(file.header().channels().findChannel("R")->type, Imf::HALF);
    EXPECT_EQ(file.header().channels().findChannel("depth.Z")->type, Imf::FLOAT);
}

TEST_F(Layers, WithWhatRaysCostAndWhatThePaperSetsUp) {
    expect_done(render(in("cube.obj"), with(kView, {"--aov", "cost_steps,directions", "--exr-layers"}), "a.exr"),
                {"a.cost_steps.png", "a.exr"});
    EXPECT_EQ(names_of(out("a.exr")), (Words{"A", "B", "G", "R", "cost_steps.X", "directions.x.U", "directions.x.V",
                                             "directions.y.U", "directions.y.V", "directions.z.U", "directions.z.V"}));
}

TEST_F(Layers, OnlyInAnExr) {
    for (const std::string name : {"a.png", "a.hdr", "a.PNG"}) {
        SCOPED_TRACE(name);
        expect_refused(render(in("cube.obj"), {"--aov", "depth", "--exr-layers"}, name), 1, "name it .exr");
        expect_refused(render(in("cube.obj"), {"--aov", "depth", "--exr-layers"}, name), 1, name);
    }
    expect_refused(sequence("f%d.png", {"--frames", "0:2", "--aov", "depth", "--exr-layers"}), 1, "name it .exr");
    expect_refused(sequence("f.mp4", {"--frames", "0:2", "--aov", "depth", "--exr-layers"}), 1, "--aov");
    expect_refused(render(in("cube.obj"), {"--exr-layers"}, "a.exr"), 2, "--aov");
}

TEST_F(Layers, ASequenceIsTheSameAloneInPartsAndResumed) {
    for (const std::string tracer : {"ldc", "reference"}) {
        SCOPED_TRACE(tracer);
        remove_outputs();
        const Words options = {"--aov",
                               "motion,instance,cost_steps",
                               "--exr-layers",
                               "--fps",
                               "7",
                               "--tracer",
                               tracer,
                               "--floor",
                               "--bounces",
                               "1"};
        Words plain = options;
        if (tracer == "reference") plain[1] = "motion,instance";
        const auto frames = [&](const Words& more) { return sequence("f%d.exr", with(plain, more), "camera.gltf"); };
        ASSERT_EQ(frames({"--frames", "0:5"}).status, 0);
        const auto whole = contents();
        EXPECT_EQ(whole.size(), tracer == "ldc" ? 11u : 6u);
        // Without motion in the first frame, and with it later.
        EXPECT_EQ(channel(out("f0.exr"), "Vector.X"), std::vector<float>(64 * 48, 0));
        const std::vector<float> third = channel(out("f3.exr"), "Vector.X");
        EXPECT_GT(std::count_if(third.begin(), third.end(), [](float v) { return std::abs(v) > 0.5f; }), 300);
        EXPECT_EQ(channel(out("f3.exr"), "backward.u"), third);
        EXPECT_EQ(channel(out("f3.exr"), "Vector.Z"), third);
        // A single picture of the moment.
        remove_outputs();
        ASSERT_EQ(sequence("one.exr", with(plain, {"--time", fmt::format("{}", 3 / 7.0)}), "camera.gltf").status, 0);
        EXPECT_TRUE(get(out("one.exr")) == whole.at("f3.exr"));
        // Shards, of which one has lost a frame.
        remove_outputs();
        for (const char* shard : {"1/2", "0/2"}) ASSERT_EQ(frames({"--frames", "0:5", "--shard", shard}).status, 0);
        EXPECT_TRUE(contents() == whole);
        std::filesystem::remove(out("f2.exr"));
        const Outcome rest = frames({"--frames", "0:5", "--resume"});
        EXPECT_NE(rest.out.find("1 frame of 0 to 4, 4 were there already"), std::string::npos) << rest.out << rest.err;
        EXPECT_TRUE(contents() == whole);
        if (tracer == "reference") continue;
        // The heat map belongs to the frame.
        std::filesystem::remove(out("f1.cost_steps.png"));
        const Outcome again = frames({"--frames", "0:5", "--resume"});
        EXPECT_NE(again.out.find("1 frame of 0 to 4"), std::string::npos) << again.out << again.err;
        EXPECT_TRUE(contents() == whole);
        // Frames of another form are not mixed with these.
        Words beside = plain;
        std::erase(beside, "--exr-layers");
        expect_refused_untouched(sequence("f%d.exr", with(beside, {"--frames", "0:5", "--resume"}), "camera.gltf"),
                                 {"--exr-layers was given, is not given"});
        EXPECT_TRUE(contents() == whole);
    }
}

TEST_F(Layers, ATurntablesFirstFrameFollowsItsLast) {
    const Words options = {"--turntable", "40", "--aov", "motion", "--tracer", "none", "--exr-layers"};
    ASSERT_EQ(sequence("f%d.exr", with(options, {"--frames", "0:2"})).status, 0);
    for (const char* name : {"f0.exr", "f1.exr"}) {
        const std::vector<float> x = channel(out(name), "Vector.X");
        EXPECT_GT(std::count_if(x.begin(), x.end(), [](float v) { return std::abs(v) > 0.2f; }), 100) << name;
    }
}

TEST_F(Layers, FramesPerSecondSayHowFarToLookBack) {
    const auto largest = [&](const Words& more) {
        EXPECT_EQ(sequence("a.png", with({"--time", "0.4", "--aov", "motion", "--tracer", "none"}, more)).status, 0);
        const std::vector<float> x = channel(out("a.motion.exr"), "X");
        return -*std::min_element(x.begin(), x.end());
    };
    const float usual = largest({});
    EXPECT_GT(usual, 0.1f);
    EXPECT_NEAR(largest({"--fps", "60"}), usual / 2, 0.05 * double(usual));
    EXPECT_EQ(largest({"--fps", "30"}), usual);
}

}  // namespace
}  // namespace peelray
