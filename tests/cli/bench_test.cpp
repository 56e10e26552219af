// `peelray bench --paper`: its table and JSON, what it leaves out, what it refuses. Without the models, so that
// built-in scenes stand in.
#include <fmt/format.h>

#include "cli/bench_fixture.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Bench : public BenchFixture {
  protected:
    Bench() : BenchFixture({"--paper", "--size", "32x24", "--repeat", "1"}) {}
};

Words way_of(const Json& row) {
    return {row["builder"].get<std::string>(), row["traversal"].get<std::string>(), row["hit"].get<std::string>()};
}

/// The cells of each line of the first table in a text, head and rule first.
std::vector<Words> table_of(const std::string& text) {
    std::vector<Words> rows;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with("| ") && !line.starts_with("|---")) continue;
        Words cells;
        std::istringstream parts(line.substr(1));
        for (std::string cell; std::getline(parts, cell, '|');) {
            const size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
            cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
        }
        rows.push_back(cells);
    }
    return rows;
}

TEST_F(Bench, TheDefaultTable) {
    const Outcome run = this->run(
        small({"--scenes", "tiny,bunny", "--ldc", "32,512", "--out", out("b.json"), "--markdown", out("b.md")}));
    expect_done(run, {"b.json", "b.md"});
    EXPECT_EQ(run.out, get(out("b.md")));
    EXPECT_NE(run.err.find("bunny: there is no bunny_7k.off: builtin:blob:6966 stands in"), std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("tiny: there is no tiny.glb: builtin:walker stands in"), std::string::npos) << run.err;

    const Json all = json();
    EXPECT_EQ(all["benchmark"], "paper");
    for (const char* part : {"device", "driver", "api_version", "commit"}) EXPECT_NE(all[part], "") << part;
    EXPECT_EQ(all["image"], Json({32, 24}));
    EXPECT_EQ(all["frames"], 1);
    EXPECT_EQ(all["block"], Json({8, 8}));
    EXPECT_EQ(all["complete"], true);

    // The paper's order of scenes, then the paper's system and ours, then the resolutions.
    const std::vector<Words> ways = {
        {"peel", "two-level", "tolerance"}, {"compute", "voxel", "exact"}, {"compute", "voxel", "planar"}};
    ASSERT_EQ(all["rows"].size(), 12u);
    const auto cells = table_of(run.out);
    ASSERT_EQ(cells.size(), 14u);
    for (size_t i = 0; i < 12; i++) {
        SCOPED_TRACE(i);
        const Json& row = all["rows"][i];
        const Words& line = cells[i + 2];
        ASSERT_EQ(line.size(), cells[0].size());
        const bool bunny = i < 6, measured = row["left_out"].is_null();
        EXPECT_EQ(row["scene"], bunny ? "bunny" : "tiny");
        EXPECT_EQ(row["stands_in"], true);
        EXPECT_EQ(row["shown"], bunny ? "builtin:blob:6966" : "builtin:walker");
        EXPECT_EQ(row["triangles"], bunny ? 6968 : 45334);
        EXPECT_EQ(way_of(row), ways[i / 2 % 3]);
        EXPECT_EQ(row["n"], i % 2 ? 512 : 32);
        EXPECT_EQ(row["paper"]["layers"], bunny ? 8 : 6);
        EXPECT_EQ(row["paper"]["a_ms"], i % 2 ? Json(bunny ? 7 : 5) : Json(nullptr));
        EXPECT_EQ(row["paper"]["b_ms"], i % 2 ? Json(bunny ? 61 : 44) : Json(nullptr));
        EXPECT_EQ(line[0], bunny ? "Bunny" : "Tiny (animation)");
        EXPECT_EQ(line[5], i % 2 ? "512²" : "32²");
        EXPECT_EQ(line[13], i % 2 ? bunny ? "7" : "5" : "–");
        EXPECT_NE(line.back().find(row["shown"].get<std::string>()), std::string::npos) << line.back();
        EXPECT_EQ(measured, line[8] != "–");
        ASSERT_TRUE(measured) << row["left_out"];
        if (!measured) {
            EXPECT_TRUE(row["a_ms"].is_null() && row["b_ms"].is_null() && row["passes"].is_null());
            EXPECT_NE(line.back().find(row["left_out"].get<std::string>()), std::string::npos) << line.back();
            continue;
        }
        const double a = row["a_ms"]["median"], b = row["b_ms"]["median"], frame = row["frame_ms"]["median"];
        EXPECT_GT(a, 0);
        EXPECT_GT(b, 0);
        EXPECT_NEAR(a + b, frame, 1e-6 * frame);
        EXPECT_EQ(line[8], fmt::format("{:.3f}", a));
        EXPECT_EQ(line[10], fmt::format("{:.3f}", b));
        double passes = 0;
        for (const Json& pass : row["passes"])
            if (pass["name"].get<std::string>().starts_with("build/")) passes += pass["ms"].get<double>();
        EXPECT_NEAR(passes, a, 1e-6 * a);
        EXPECT_EQ(row["rays"]["primary"], 32 * 24);
        EXPECT_GT(row["ldc"]["samples"], 0);
        EXPECT_GT(row["object_pixels"], row["n"].get<int>() / 6);
        EXPECT_LT(row["object_pixels"], row["n"].get<int>());
        EXPECT_EQ(line[6], fmt::format("{}", row["object_pixels"].get<int>()));
        for (const Json& cube : row["ldc"]["cubes"]) EXPECT_EQ(cube["built"], cube["bare"] ? "never" : "every frame");
    }
}

TEST_F(Bench, RepeatedFramesAndListsOfWhatToMeasure) {
    const Outcome run =
        this->run(small({"--repeat", "3", "--scenes", "tiny", "--builders", "compute", "--traversals", "voxel",
                         "--hits", "planar", "--ldc", "48", "--block", "4x8", "--out", out("b.json")}));
    expect_done(run, {"b.json"});
    const Json all = json();
    EXPECT_EQ(all["frames"], 3);
    EXPECT_EQ(all["block"], Json({4, 8}));
    ASSERT_EQ(all["rows"].size(), 1u);
    for (const char* column : {"a_ms", "b_ms", "frame_ms"}) {
        const Json& spread = all["rows"][0][column];
        EXPECT_LE(spread["least"], spread["median"]) << column;
        EXPECT_LE(spread["median"], spread["most"]) << column;
        EXPECT_LT(spread["least"], spread["most"]) << column;
    }
}

TEST_F(Bench, EveryCombinationOrTheReasonWhyNot) {
    expect_done(run(small({"--all", "--scenes", "bunny", "--ldc", "16", "--out", out("b.json")})), {"b.json"});
    const Json rows = json()["rows"];
    ASSERT_EQ(rows.size(), 27u);
    std::set<Words> ways;
    size_t measured = 0;
    for (const Json& row : rows) {
        ways.insert(way_of(row));
        const bool done = row["left_out"].is_null();
        measured += done;
        EXPECT_EQ(done, row["a_ms"].is_object());
        // Peeling captures pixel centres; all else is built.
        EXPECT_EQ(done, row["builder"] != "peel" || row["hit"] != "exact") << row["left_out"];
    }
    EXPECT_EQ(ways.size(), 27u);
    EXPECT_EQ(measured, 24u);
}

TEST_F(Bench, FilesAreFoundAndBrokenOnesLeftOut) {
    fs::create_directory(folder / "models" / "meshes");
    put("models/meshes/bunny_7k.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    put("models/car2.glb", "no glTF");
    const Outcome run = this->run(small({"--scenes", "bunny,car", "--builders", "compute", "--traversals", "voxel",
                                         "--hits", "exact", "--ldc", "32", "--out", out("b.json")}));
    expect_done(run, {"b.json"});
    const Json rows = json()["rows"];
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["shown"], "bunny_7k.off");
    EXPECT_EQ(rows[0]["stands_in"], false);
    EXPECT_EQ(rows[0]["triangles"], 3);  // with the floor
    EXPECT_TRUE(rows[0]["left_out"].is_null());
    EXPECT_EQ(rows[1]["shown"], "car2.glb");
    EXPECT_TRUE(rows[1]["triangles"].is_null());
    EXPECT_NE(rows[1]["left_out"].get<std::string>().find("car2.glb"), std::string::npos);
    EXPECT_NE(table_of(run.out).back().back().find("left out: "), std::string::npos) << run.out;
}

TEST_F(Bench, NothingMeasuredIsAFailure) {
    put("models/bunny_7k.off", "OFF\n");
    const Outcome run = this->run(small({"--scenes", "bunny", "--ldc", "32", "--out", out("b.json")}));
    EXPECT_EQ(run.status, 1);
    ASSERT_EQ(run.complaints().size(), 1u) << run.err;
    EXPECT_NE(run.err.find("none of 3 rows could be measured: "), std::string::npos) << run.err;
    EXPECT_EQ(table_of(run.out).size(), 5u);
    EXPECT_EQ(json()["rows"].size(), 3u);
}

TEST_F(Bench, AnInterruptedRunKeepsItsRows) {
    const Running running =
        start(small({"--scenes", "bunny", "--repeat", "60", "--builders", "compute", "--traversals", "voxel", "--hits",
                     "exact,planar", "--ldc", "16,24,32,48,64,80", "--out", out("b.json"), "--markdown", out("b.md")}));
    ASSERT_TRUE(wait_for(out("b.md")));
    ::kill(running.process, SIGINT);
    const Outcome run = running.wait();
    EXPECT_EQ(run.status, 1);
    ASSERT_EQ(run.complaints().size(), 1u) << run.err;
    const Json all = json();
    const size_t rows = all["rows"].size();
    EXPECT_GE(rows, 1u);
    EXPECT_LT(rows, 12u);
    EXPECT_EQ(all["complete"], false);
    EXPECT_NE(run.err.find(fmt::format("interrupted after {} of 12 rows, which {} holds", rows, out("b.json"))),
              std::string::npos)
        << run.err;
    EXPECT_EQ(table_of(run.out).size(), rows + 2);
    EXPECT_EQ(table_of(get(out("b.md"))).size(), rows + 2);
    EXPECT_EQ(outputs(), Words({"b.json", "b.md"}));
}

TEST_F(Bench, WrongUsage) {
    const std::vector<std::pair<Words, std::string>> cases = {
        {{"--scenes", "bunny,hare"}, "'bunny,hare' is not a list out of bunny,car,dragon,igea,tiny"},
        {{"--scenes", "bunny,bunny"}, "each once"},
        {{"--scenes", ""}, "--scenes"},
        {{"--builders", "magic"}, "'magic' is not a list out of peel,abuffer,compute"},
        {{"--traversals", "kd-tree"}, "'kd-tree' is not a list out of two-level,mipmap,voxel"},
        {{"--hits", "auto"}, "'auto' is not a list out of tolerance,planar,exact"},
        {{"--ldc", "auto"}, "'auto' is not a list of numbers"},
        {{"--ldc", "512,"}, "'512,' is not a list of numbers"},
        {{"--block", "x"}, "--block"},
        {{"--tolerance", "x"}, "'x' is not a number"},
        {{"--repeat", "x"}, "--repeat"},
        {{"--size", "x"}, "is not a picture size"},
        {{"--quick"}, "--paper excludes --quick"},
        {{"--rays", "mirror"}, "--paper excludes --rays"},
        {{"--plots", "plots"}, "--paper excludes --plots"},
        {{"more"}, "'more' is one argument too many"}};
    for (const auto& [words, says] : cases) {
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refused(run(small(words)), 2, says);
    }
}

TEST_F(Bench, ImpossibleValues) {
    const std::vector<std::pair<Words, std::string>> cases = {
        {{"--ldc", "512,15"}, "16 to 2048"},
        {{"--block", "0"}, "(--block)"},
        {{"--tolerance", "0"}, "above 0"},
        {{"--tolerance", "nan"}, "above 0"},
        {{"--repeat", "0"}, "1 to 10000"},
        {{"--size", "0x5"}, "a picture of 0x5"},
        {{"--models", in("nowhere")}, "there is no folder"},
        {{"--device", "no such device"}, "peelray devices"},
        {{"--out", "/proc/no/b.json"}, "/proc/no"},
        {{"--out", out("b"), "--markdown", out("b")}, "written twice"}};
    for (const auto& [words, says] : cases) {
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refused(run(small(words)), 1, says);
    }
}

using SequenceBench = SequenceTest;

TEST_F(SequenceBench, MeasuresEveryWayAndLeavesNothing) {
    const fs::path temporary = folder / "temporary";
    fs::create_directory(temporary);
    const Outcome run = this->run(
        {"bench", "--sequence", "--scenes", "blob:500", "--size", "64x48", "--repeat", "5", "--out", out("b.json")},
        {{"TMPDIR", temporary.string()}});
    expect_done(run, {"b.json"});
    EXPECT_TRUE(fs::is_empty(temporary));
    const Json json = Json::parse(get(out("b.json")));
    EXPECT_EQ(json["benchmark"], "sequence");
    EXPECT_TRUE(json["complete"]);
    const std::vector<std::string> ways = {"rendered only", "PNG files", "PNG encoder alone", "y4m into nothing",
                                           "y4m conversion alone"};
    ASSERT_EQ(json["rows"].size(), ways.size());
    for (size_t i = 0; i < ways.size(); i++) {
        const Json& row = json["rows"][i];
        EXPECT_EQ(row["way"], ways[i]);
        EXPECT_NEAR(row["frames_per_second"].get<double>() * row["seconds"].get<double>(), 5, 1e-6);
        EXPECT_EQ(row["rendering_seconds"] > 0, i != 2 && i != 4) << "encoders render nothing";
        EXPECT_EQ(row["encoding_thread_seconds"] > 0, i > 0);
        EXPECT_EQ(row["writing_thread_seconds"] > 0, i == 1 || i == 3);
    }
    EXPECT_EQ(table_of(run.out).size(), 2 + ways.size());
}

TEST_F(SequenceBench, WhatItCannotMeasureIsSaid) {
    expect_refused(run({"bench", "--sequence", "--size", "63x48"}), 1, "width and height must be even");
    expect_refused(run({"bench", "--sequence", "--quick"}), 2, "--quick");
    expect_refused(run({"bench", "--sequence"}, {{"TMPDIR", in("nowhere")}}), 1, "TMPDIR");
}

}  // namespace
}  // namespace peelray
