// What a run of `peelray bench` leaves behind, however it ends.
#include "cli/bench_output.h"

#include "base/interrupt.h"
#include "cli/bench_plots.h"
#include "image/temp_folder.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class BenchOutputTest : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        arguments.output = folder / "b.json";
        arguments.markdown = folder / "b.md";
        testing::internal::CaptureStdout();
    }
    void TearDown() override {
        said();
        TempFolder::TearDown();
    }
    std::string said() {
        if (!captured_) text_ = testing::internal::GetCapturedStdout();
        captured_ = true;
        return text_;
    }
    Json json() const { return Json::parse(get(arguments.output)); }

    BenchArguments arguments;

  private:
    bool captured_ = false;
    std::string text_;
};

TEST_F(BenchOutputTest, EveryRowIsInTheFilesAtOnce) {
    BenchOutput output(arguments, {{"benchmark", "mine"}}, "(not finished)\n");
    output.say("| head |\n");
    output.run(
        2,
        [&] {
            output.add({{"row", 1}}, "| 1 |\n", "");
            EXPECT_EQ(json(), Json({{"benchmark", "mine"}, {"complete", false}, {"rows", {{{"row", 1}}}}}));
            EXPECT_EQ(get(arguments.markdown), "| head |\n| 1 |\n(not finished)\n");
            output.add({{"row", 2}}, "| 2 |\n", "there is none");
        },
        [&](bool complete) {
            EXPECT_TRUE(complete);
            output.say("foot\n");
        });
    EXPECT_EQ(json()["complete"], true);
    EXPECT_EQ(json()["rows"].size(), 2u);
    EXPECT_EQ(get(arguments.markdown), "| head |\n| 1 |\n| 2 |\nfoot\n");
    EXPECT_EQ(said(), get(arguments.markdown));
}

TEST_F(BenchOutputTest, AnInterruptedRunKeepsItsRowsAndSaysHowMany) {
    BenchOutput output(arguments, {});
    const auto measure = [&] {
        output.add({{"row", 1}}, "| 1 |\n", "");
        throw Interrupted("interrupted");
    };
    bool last = true;
    expect_error([&] { output.run(5, measure, [&](bool complete) { last = complete; }); },
                 fmt::format("interrupted after 1 of 5 rows, which {} holds", arguments.output.string()));
    EXPECT_FALSE(last);
    EXPECT_EQ(json()["complete"], false);
    EXPECT_EQ(json()["rows"].size(), 1u);
    arguments.output.clear();
    BenchOutput silent(arguments, {});
    expect_error(
        [&] {
            silent.run(
                {}, [] { throw Interrupted("interrupted"); }, [](bool) {});
        },
        "interrupted after 0 rows");
}

TEST_F(BenchOutputTest, NothingMeasuredIsAFailureWithTheFirstReason) {
    BenchOutput output(arguments, {});
    const auto measure = [&] {
        output.add({}, "| 1 |\n", "the first reason");
        output.add({}, "| 2 |\n", "the second reason");
    };
    expect_error([&] { output.run(2, measure, [](bool) {}); }, "none of 2 rows could be measured: the first reason");
    EXPECT_EQ(json()["complete"], true);
}

TEST_F(BenchOutputTest, OtherErrorsPass) {
    BenchOutput output(arguments, {});
    expect_error(
        [&] {
            output.run(
                2, [] { fail("the device is lost"); }, [](bool) {});
        },
        "the device is lost");
}

TEST(TimingJson, OfNoRunsIsNull) {
    EXPECT_TRUE(timing_json({}).is_null());
    const Json json = timing_json({3, 2, 1, 4, 0.5, 0.75});
    EXPECT_EQ(json, Json({{"median", 2}, {"least", 1}, {"most", 4}, {"drift", 0.5}, {"clock", 0.75}, {"runs", 3}}));
}

TEST_F(BenchOutputTest, PlotsAreDrawnOfWhatThereIs) {
    RayRow row;
    row.scene = "blob:500";
    row.triangles = 502;
    row.contender = "exact";
    row.traversal = Traversal::voxel;
    row.build = {1, 5, 5, 5};
    write_plots(folder, {});
    EXPECT_EQ(files(), 0u);
    write_plots(folder, {row});
    EXPECT_EQ(files(), 1u) << "no rays: only the build is known";
    EXPECT_NE(get(folder / "triangles_build.svg").find("<svg"), std::string::npos);
    row.scene = "bunny";
    fs::remove(folder / "triangles_build.svg");
    write_plots(folder, {row});
    EXPECT_EQ(files(), 0u) << "plots against triangles are of blobs";
}

}  // namespace
}  // namespace peelray
