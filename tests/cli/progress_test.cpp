// Pictures of many samples: previews, early ends, interrupts, and what is said of them.
#include <cmath>
#include <csignal>
#include <regex>
#include <thread>

#include "cli/channels.h"
#include "cli/program_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

class ProgressTest : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("cube.obj", kCube);
    }
    Json stats() const { return Json::parse(get(out("s.json"))); }

    /// Renders far too many samples, and sends a signal once the preview is there, which is when some are done; it is
    /// removed.
    Outcome interrupted(Words more, int signal) const {
        Words arguments = {"render", in("cube.obj"), "-o",    out("a.exr"), "--size",
                           "64x48",  "--spp",        "65536", "--preview",  out("p.png")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Running running = start(arguments);
        for (int i = 0; i < 4800 && !std::filesystem::exists(out("p.png")); i++)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_TRUE(std::filesystem::exists(out("p.png"))) << "a picture on the way";
        ::kill(running.process, signal);
        return running.wait();
    }
};

TEST_F(ProgressTest, ThePreviewShowsTheFinishedPictureInTheEnd) {
    for (const std::string tracer : {"none", "reference"}) {
        SCOPED_TRACE(tracer);
        const Words options = {"--spp", "9", "--tracer", tracer, "--floor"};
        expect_done(render(in("cube.obj"), options), {"a.png"});
        const std::string plain = get(out("a.png"));
        Words with = options;
        with.insert(with.end(), {"--preview", out("p.png"), "--keep-partial"});
        expect_done(render(in("cube.obj"), with), {"a.png", "p.png"});
        EXPECT_EQ(get(out("a.png")), plain) << "passes change no pixel";
        EXPECT_EQ(get(out("p.png")), plain);
        with[with.size() - 2] = out("p.exr");
        expect_done(render(in("cube.obj"), with), {"a.png", "p.exr", "p.png"});
        EXPECT_EQ(read_hdr(out("p.exr")).width, 64u);
        remove_outputs();
    }
}

TEST_F(ProgressTest, AnInterruptKeepsWhatIsThereIfItIsToBe) {
    for (const std::string tracer : {"none", "reference"})
        for (const int signal : {SIGINT, SIGTERM}) {
            SCOPED_TRACE(tracer);
            const Outcome kept = interrupted({"--tracer", tracer, "--keep-partial", "--stats", out("s.json")}, signal);
            EXPECT_EQ(kept.status, 1);
            EXPECT_EQ(kept.out, "");
            EXPECT_EQ(outputs(), (Words{"a.exr", "p.png", "s.json"}));
            std::smatch said;
            ASSERT_TRUE(std::regex_match(kept.err, said,
                                         std::regex("peelray: interrupted after (\\d+) of 65536 samples: .*a\\.exr "
                                                    "shows the mean of those\n")))
                << kept.err;
            const Json samples = stats()["samples"];
            EXPECT_EQ(samples["count"], std::stoi(said[1]));
            EXPECT_EQ(samples["end"], "interrupt");
            EXPECT_GE(samples["count"], 1);
            EXPECT_LT(samples["count"], 65536);
            remove_outputs();
        }
}

TEST_F(ProgressTest, AnInterruptElseLeavesNothing) {
    for (const std::string tracer : {"none", "reference"}) {
        const Outcome run = interrupted({"--tracer", tracer, "--stats", out("s.json")}, SIGINT);
        expect_refused(run, 1, "interrupted: nothing was written; run it again");
    }
}

TEST_F(ProgressTest, LimitsEndItAndAreToldOf) {
    const Words common = {"--tracer", "none", "--stats", out("s.json"), "--spp", "65536"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), common.begin(), common.end());
        return render(in("cube.obj"), more);
    };
    const Outcome timed = with({"--time-limit", "0.5"});
    expect_done(timed, {"a.png", "s.json"});
    EXPECT_TRUE(std::regex_search(timed.out, std::regex(": 64x48, \\d+ of 65536 samples \\(time limit\\), 12 tri")))
        << timed.out;
    EXPECT_EQ(stats()["samples"]["end"], "time limit");
    EXPECT_EQ(stats()["samples"]["noise"], nullptr);

    const Outcome calm = with({"--noise-target", "0.05"});
    expect_done(calm, {"a.png", "s.json"});
    EXPECT_TRUE(std::regex_search(calm.out, std::regex(" of 65536 samples \\(noise target, noise 0\\.0\\d+\\), ")))
        << calm.out;
    EXPECT_EQ(stats()["samples"]["end"], "noise target");
    EXPECT_LE(stats()["samples"]["noise"], 0.05);

    const Outcome shortest = with({"--time-limit", "0.000001"});
    expect_done(shortest, {"a.png", "s.json"});
    EXPECT_NE(shortest.out.find("1 of 65536 samples (time limit)"), std::string::npos) << "a whole pass";
}

TEST_F(ProgressTest, FramesEndByThemselves) {
    const Outcome run =
        this->run({"render", in("cube.obj"), "-o", out("f%d.png"), "--size", "64x48", "--turntable", "2", "--tracer",
                   "none", "--spp", "4096", "--noise-target", "0.2", "--stats", out("s.json")});
    expect_done(run, {"f%d.png.json", "f0.png", "f1.png", "s.json"});
    for (const Json& frame : stats()["frames"]) EXPECT_EQ(frame["samples"]["end"], "noise target");
    EXPECT_EQ(Json::parse(get(out("f%d.png.json")))["settings"]["--noise-target"], "0.2");
}

/// The same rays are traced, so the same pixels are noisy. Here and there a ray meets something else.
TEST_F(ProgressTest, TracersAgreeOnTheVariance) {
    std::vector<std::vector<float>> variances;
    for (const std::string tracer : {"ldc", "reference"}) {
        expect_done(render("builtin:teapots", {"--tracer", tracer, "--spp", "8", "--aov", "variance,sample_count"}),
                    {"a.png", "a.sample_count.exr", "a.variance.exr"});
        variances.push_back(channels_of(out("a.variance.exr")));
        for (const float count : channels_of(out("a.sample_count.exr"))) ASSERT_EQ(count, 8);
    }
    size_t noisy = 0, different = 0;
    for (size_t i = 0; i < variances[0].size(); i++) {
        const double a = std::sqrt(variances[0][i]), b = std::sqrt(variances[1][i]);
        noisy += b > 1e-3;
        different += std::abs(a - b) > 0.02 * b + 1e-3;
    }
    EXPECT_GT(noisy, 300u);
    EXPECT_LT(double(different), 0.02 * double(variances[0].size()));
}

TEST_F(ProgressTest, WhatCannotBeIsRefused) {
    const auto refused = [&](const Words& more, int status, const std::string& says) {
        SCOPED_TRACE(testing::PrintToString(more));
        expect_refused(render(in("cube.obj"), more), status, says);
    };
    for (const std::string bad : {"0", "-1", "nan", "inf"}) {
        refused({"--clamp", bad}, 1, "choose a radiance above 0 (--clamp)");
        refused({"--spp", "9", "--time-limit", bad}, 1, "choose one above 0 (--time-limit)");
        refused({"--spp", "9", "--noise-target", bad}, 1, "above 0, such as 0.05 (--noise-target)");
    }
    refused({"--noise-target", "0.1"}, 1, "--spp, the most there may be, be 8 or more");
    refused({"--spp", "9", "--preview", out("p.jpg")}, 1, "p.jpg");
    refused({"--spp", "9", "--preview", out("a.png")}, 1, "written twice");
    refused({"--spp", "9", "--preview", "/proc/p.png"}, 1, "/proc/p.png");
    refused({"--repeat", "2", "--time-limit", "1"}, 2, "--repeat");
    for (const Words& option : {Words{"--preview", out("p.png")}, Words{"--keep-partial"}}) {
        Words sequence = {"render", in("cube.obj"), "-o", out("f%d.png"), "--turntable", "2"};
        sequence.insert(sequence.end(), option.begin(), option.end());
        expect_refused(run(sequence), 2, option[0]);
    }
}

}  // namespace
}  // namespace peelray
