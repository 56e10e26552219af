// Plain `peelray bench` and --auto-check: rows, plots, what is left out, what is refused, and that wrong answers cost
// their time.
#include <fmt/format.h>

#include "cli/bench_fixture.h"

namespace peelray {
namespace {

using Json = nlohmann::json;

class RayBenchTest : public BenchFixture {
  protected:
    RayBenchTest()
        : BenchFixture({"--scenes", "blob:500", "--size", "64x48", "--repeat", "2", "--sizes", "none", "--ldc", "64"}) {
    }
};

TEST_F(RayBenchTest, EverySetOfRaysThroughOursAndEmbree) {
    const Outcome run = this->run(small({"--ldc", "auto,64", "--out", out("b.json"), "--markdown", out("b.md")}));
    expect_done(run, {"b.json", "b.md"});
    EXPECT_EQ(run.out, get(out("b.md")));
    const Json all = json();
    EXPECT_EQ(all["benchmark"], "rays");
    EXPECT_EQ(all["complete"], true);
    EXPECT_EQ(all["repeat"], 2);
    for (const char* part : {"device", "driver", "api_version", "commit", "embree"}) EXPECT_NE(all[part], "") << part;

    ASSERT_EQ(all["rows"].size(), 7u);  // exact and planar at two resolutions, khr twice, Embree
    Json counts;
    for (const Json& row : all["rows"]) {
        SCOPED_TRACE(row.dump().substr(0, 300));
        EXPECT_EQ(row["scene"], "blob:500");
        EXPECT_EQ(row["triangles"], 502);
        EXPECT_EQ(row["image"], Json({64, 48}));
        if (row["contender"].get<std::string>().starts_with("khr")) continue;
        EXPECT_TRUE(row["left_out"].is_null());
        EXPECT_GT(row["build_ms"]["median"], 0);
        EXPECT_LE(row["build_ms"]["least"], row["build_ms"]["median"]);
        EXPECT_GE(row["build_ms"]["most"], row["build_ms"]["median"]);
        EXPECT_GT(row["build_ms"]["drift"], 0);
        ASSERT_EQ(row["rays"].size(), 6u);
        double sum = row["build_ms"]["median"];
        for (const auto& [kind, set] : row["rays"].items()) {
            SCOPED_TRACE(kind);
            EXPECT_GT(set["rays"], 0);
            EXPECT_EQ(set["checked"], std::min(20'000, set["rays"].get<int>()));
            if (row["contender"] != "ldc" || row["hit"] != "planar") {
                EXPECT_EQ(set["wrong"], 0);
                EXPECT_TRUE(set["withheld"].is_null());
            }
            if (!set["withheld"].is_null()) continue;
            const double ms = set["trace_ms"]["median"];
            EXPECT_NEAR(set["mrays_per_second"], set["rays"].get<double>() / ms * 1e-3, 1e-6 + 1e-6 / ms);
            if (kind == "mirror" || kind == "shadow") sum += ms;
            // All trace the same rays.
            if (!counts.contains(kind)) counts[kind] = set["rays"];
            EXPECT_EQ(counts[kind], set["rays"]);
        }
        if (!row["dynamic_ms"].is_null()) {
            EXPECT_NEAR(row["dynamic_ms"], sum, 1e-6);
        }
        if (row["contender"] != "ldc") continue;
        EXPECT_GT(row["frame_ms"]["median"], 0);
        EXPECT_GT(row["memory_bytes"]["samples"], 0);
        EXPECT_EQ(row["n"].is_number(), true);
    }
    EXPECT_EQ(counts["primary"], 64 * 48);
    EXPECT_EQ(counts["ambient"], 4 * counts["mirror"].get<int>());
    EXPECT_NE(run.out.find("Time of ours by that of the rival"), std::string::npos);
}

TEST_F(RayBenchTest, ChosenRaysTraversalsSizesAndPlots) {
    const Outcome run = this->run(small({"--rays", "shadow,mirror", "--traversals", "two-level,voxel", "--hits",
                                         "exact", "--scenes", "blob:500,blob:2000", "--sizes", "16x16,40x30", "--ldc",
                                         "32,64", "--out", out("b.json"), "--plots", out("plots")}));
    expect_done(run, {"b.json", "plots"});
    size_t two_level = 0, series = 0;
    const Json all = json();
    for (const Json& row : all["rows"]) {
        two_level += row["traversal"] == "two-level";
        series += row["series"] == "rays";
        if (row["left_out"].is_null()) {
            EXPECT_EQ(row["rays"].size(), row["series"] == "rays" ? 1u : 2u);
        }
    }
    EXPECT_EQ(two_level, 4u);
    EXPECT_EQ(series, 8u);  // exact, khr twice and Embree at two sizes, of the blob that is nearer to 300000
    for (const char* name :
         {"triangles_rate", "triangles_dynamic", "triangles_build", "rays", "ldc_rate", "ldc_dynamic"}) {
        const std::string svg = get(out("plots") + "/" + name + ".svg");
        EXPECT_NE(svg.find("<polyline"), std::string::npos) << name;
    }
}

TEST_F(RayBenchTest, WhatCannotBeMeasuredIsLeftOutWithTheReason) {
    put("broken.obj", "v 0 0 nothing\n");
    const Outcome run = this->run(small(
        {"--scenes", in("broken.obj") + ",blob:500", "--rays", "mirror", "--hits", "exact", "--out", out("b.json")}));
    expect_done(run, {"b.json"});
    const Json rows = json()["rows"];
    ASSERT_EQ(rows.size(), 5u);
    EXPECT_NE(rows[0]["left_out"].get<std::string>().find("broken.obj"), std::string::npos);
    EXPECT_TRUE(rows[1]["left_out"].is_null());
    EXPECT_EQ(rows[2]["contender"], "khr");
    EXPECT_EQ(rows[3]["contender"], "khr static");
    EXPECT_NE(run.out.find("left out: "), std::string::npos);
}

TEST_F(RayBenchTest, NothingMeasuredIsAFailure) {
    put("broken.obj", "v 0 0 nothing\n");
    const Outcome run = this->run(small({"--scenes", in("broken.obj"), "--out", out("b.json")}));
    EXPECT_EQ(run.status, 1);
    ASSERT_EQ(run.complaints().size(), 1u) << run.err;
    EXPECT_NE(run.err.find("none of 1 row could be measured: "), std::string::npos) << run.err;
}

TEST_F(RayBenchTest, StandInsAndAnimatedScenes) {
    const Outcome run = this->run(
        small({"--scenes", "tiny", "--rays", "mirror", "--hits", "exact", "--ldc", "auto", "--out", out("b.json")}));
    expect_done(run, {"b.json"});
    EXPECT_NE(run.err.find("tiny: its file is missing: builtin:walker stands in"), std::string::npos) << run.err;
    const Json row = json()["rows"][0];
    EXPECT_EQ(row["stands_in"], true);
    EXPECT_EQ(row["ldc"], "auto");
    EXPECT_EQ(row["rays"]["mirror"]["wrong"], 0);
}

TEST_F(RayBenchTest, AnInterruptedRunKeepsItsRows) {
    const Running running = start(small({"--rays", "mirror", "--repeat", "200", "--ldc", "16,32,48,64,80,96,112,128",
                                         "--out", out("b.json"), "--markdown", out("b.md")}));
    ASSERT_TRUE(wait_for(out("b.md")));
    ::kill(running.process, SIGINT);
    const Outcome run = running.wait();
    EXPECT_EQ(run.status, 1);
    ASSERT_EQ(run.complaints().size(), 1u) << run.err;
    const Json all = json();
    EXPECT_EQ(all["complete"], false);
    EXPECT_GE(all["rows"].size(), 1u);
    EXPECT_LT(all["rows"].size(), 18u);
    const size_t rows = all["rows"].size();
    const std::string after =
        fmt::format("interrupted after {} row{}, which {} holds", rows, rows == 1 ? "" : "s", out("b.json"));
    EXPECT_NE(run.err.find(after), std::string::npos) << run.err;
    EXPECT_EQ(run.out, get(out("b.md")));
}

TEST_F(RayBenchTest, AutoAgainstFixedChoices) {
    const Outcome run = this->run({"bench", "--auto-check", "--scenes", "blob:500", "--size", "48x32", "--repeat", "2",
                                   "--ldc", "32,64", "--out", out("b.json"), "--markdown", out("b.md")});
    expect_done(run, {"b.json", "b.md"});
    EXPECT_EQ(run.out, get(out("b.md")));
    const Json all = json();
    EXPECT_EQ(all["benchmark"], "auto");
    ASSERT_EQ(all["rows"].size(), 2u);
    for (const Json& row : all["rows"]) {
        EXPECT_EQ(row["cubes"], &row == &all["rows"][0] ? "rebuilt" : "kept");
        ASSERT_EQ(row["fixed"].size(), 4u);
        double best = 1e30;
        for (const Json& choice : row["fixed"]) best = std::min(best, choice["frame_ms"].get<double>());
        EXPECT_NEAR(row["ratio_to_best"], row["auto_ms"].get<double>() / best, 1e-9);
        EXPECT_EQ(row["auto_hit"], "exact");
    }
    EXPECT_NE(run.out.find("At worst auto takes"), std::string::npos);
}

TEST_F(RayBenchTest, WrongUsage) {
    const std::vector<std::pair<Words, std::string>> cases = {
        {{"--scenes", "blob:500,blob:500"}, "each once"},
        {{"--scenes", "blob:500,"}, "--scenes"},
        {{"--rays", "gamma"}, "'gamma' is not a list out of primary,mirror,refraction,shadow,ambient,diffuse"},
        {{"--hits", "best"}, "'best' is not a list out of tolerance,planar,exact"},
        {{"--ldc", "many"}, "'many' is not a list of numbers"},
        {{"--sizes", "10"}, "'10' is not a list of picture sizes"},
        {{"--builders", "peel"}, "--builders requires --paper"},
        {{"--block", "8"}, "--block requires --paper"},
        {{"--all"}, "--all requires --paper"},
        {{"--auto-check", "--quick"}, "excludes"},
        {{"--quick"}, "excludes"},
        {{"--unknown"}, "unknown option '--unknown'"}};
    for (const auto& [words, says] : cases) {
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refused(run(small(words)), 2, says);
    }
    expect_refused(run({"bench", "--auto-check", "--rays", "mirror"}), 2, "excludes");
}

TEST_F(RayBenchTest, ImpossibleValues) {
    put("file", "");
    const std::vector<std::pair<Words, std::string>> cases = {
        {{"--scenes", "hare"}, "there is no scene 'hare': choose bunny"},
        {{"--scenes", "builtin:moon"}, "there is no scene 'builtin:moon'"},
        {{"--hits", "tolerance"}, "'bench --paper'"},
        {{"--ldc", "15"}, "16 to 2048"},
        {{"--repeat", "0"}, "1 to 10000"},
        {{"--size", "0x5"}, "a picture of 0x5"},
        {{"--sizes", "8x8,0x5"}, "a picture of 0x5"},
        {{"--models", in("nowhere")}, "there is no folder"},
        {{"--device", "no such device"}, "peelray devices"},
        {{"--out", in("file/b.json")}, "file"},
        {{"--out", out("b"), "--markdown", out("b")}, "written twice"},
        {{"--plots", in("file")}, "is not a folder"}};
    for (const auto& [words, says] : cases) {
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refused(run(small(words)), 1, says);
    }
}

}  // namespace
}  // namespace peelray
