// Runs that end early and go on, runs that share the work, and the manifest that keeps them from mixing pictures.
#include <regex>

#include "cli/sequence_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

class Resume : public SequenceTest {
  protected:
    /// Eight frames that take long enough to be caught in the middle.
    Words slow(const Words& more = {}) const {
        Words all = words("f_%02d.png", {"--frames", "0:8", "--size", "96x72", "--spp", "64", "--floor", "--tracer",
                                         "reference", "--aov", "depth"});
        all.erase(all.begin() + 4, all.begin() + 6);  // the other --size
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Ends a slow run with a signal once `count` frames are there.
    Outcome end_early(int signal, int count) const {
        const Running running = start(slow());
        EXPECT_TRUE(wait_for(out(fmt::format("f_{:02}.png", count - 1))));
        ::kill(running.process, signal);
        return running.wait();
    }
    nlohmann::json manifest(const std::string& name = "f%d.png.json") const {
        return nlohmann::json::parse(get(out(name)));
    }
    /// Time and number of each file: whether it was written anew.
    std::map<std::string, std::pair<fs::file_time_type, ino_t>> stamps() const;
};

std::map<std::string, std::pair<fs::file_time_type, ino_t>> Resume::stamps() const {
    std::map<std::string, std::pair<fs::file_time_type, ino_t>> all;
    for (const auto& entry : fs::directory_iterator(folder / "out"))
        all[entry.path().filename()] = {fs::last_write_time(entry), std::hash<std::string>()(get(entry.path()))};
    return all;
}

bool is_temporary(const std::string& name) {
    return name.starts_with(".peelray-");
}

TEST_F(Resume, AKilledRunGoesOnToTheSameFiles) {
    ASSERT_EQ(run(slow()).status, 0);
    const auto whole = contents();
    ASSERT_EQ(whole.size(), 17u);  // eight pictures, eight depths, the manifest
    remove_outputs();
    ASSERT_EQ(end_early(SIGKILL, 3).status, -SIGKILL);
    // Whatever bears a frame's name is whole.
    size_t there = 0;
    for (const auto& [name, bytes] : contents()) {
        if (is_temporary(name)) continue;
        EXPECT_TRUE(whole.at(name) == bytes) << name;
        there += name.ends_with(".png");
    }
    ASSERT_GE(there, 3u);
    ASSERT_LT(there, 8u);
    const auto before = stamps();
    const Outcome rest = run(slow({"--resume", "--stats", in("s.json")}));
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_EQ(rest.err, "");
    EXPECT_NE(rest.out.find(fmt::format("{} frame", 8 - there)), std::string::npos) << rest.out;
    EXPECT_NE(rest.out.find(fmt::format("{} were there already", there)), std::string::npos) << rest.out;
    const auto stats = nlohmann::json::parse(get(in("s.json")));
    EXPECT_EQ(stats["frames"].size(), 8 - there);
    EXPECT_EQ(stats["totals"]["frames_left_alone"], there);
    auto after = contents();
    std::erase_if(after, [](const auto& entry) { return is_temporary(entry.first); });
    EXPECT_TRUE(after == whole);
    const auto later = stamps();
    for (const auto& [name, stamp] : before)
        if (name.ends_with(".png") || name.ends_with(".json")) {
            EXPECT_EQ(later.at(name), stamp) << name;
        }
}

TEST_F(Resume, AnInterruptSaysHowFarItGot) {
    for (const int signal : {SIGINT, SIGTERM}) {
        remove_outputs();
        const Outcome run = end_early(signal, 2);
        EXPECT_EQ(run.status, 1);
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(
            std::regex_match(run.err, std::regex("peelray: interrupted after [2-7] of 8 frames: the same command "
                                                 "with --resume goes on\n")))
            << run.err;
        int said = 0, there = 0;
        std::sscanf(run.err.c_str(), "peelray: interrupted after %d", &said);
        for (const std::string& name : outputs()) {
            EXPECT_FALSE(is_temporary(name)) << name;
            there += name.ends_with(".png");
        }
        EXPECT_EQ(said, there);
    }
    const Outcome rest = run(slow({"--resume"}));
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_EQ(outputs().size(), 17u);
}

TEST_F(Resume, MoreFramesMayFollow) {
    const Words options = {"--tracer", "cpu", "--frames"};
    const auto frames = [&](const std::string& range) {
        Words more = options;
        more.insert(more.end(), {range, "--resume"});
        return sequence("f%d.png", more);
    };
    expect_done(frames("2:4"), {"f%d.png.json", "f2.png", "f3.png"});
    const auto before = stamps();
    const Outcome more = frames("1:6");
    expect_done(more, {"f%d.png.json", "f1.png", "f2.png", "f3.png", "f4.png", "f5.png"});
    EXPECT_NE(more.out.find("3 frames of 1 to 5, 2 were there already"), std::string::npos) << more.out;
    for (const auto& [name, stamp] : before) EXPECT_EQ(stamps()[name], stamp) << name;
    const Outcome nothing = frames("2:5");
    EXPECT_EQ(nothing.status, 0);
    EXPECT_NE(nothing.out.find("0 frames of 2 to 4, 3 were there already"), std::string::npos) << nothing.out;
}

TEST_F(Resume, FramesOfUnknownOriginAreRenderedAgain) {
    const Words options = {"--tracer", "cpu", "--frames", "0:3", "--aov", "depth"};
    ASSERT_EQ(sequence("f%d.png", options).status, 0);
    const auto whole = contents();
    Words resume = options;
    resume.push_back("--resume");
    // Without a manifest nothing vouches for what is there.
    fs::remove(out("f%d.png.json"));
    put("out/f1.png", "old");
    const Outcome without = sequence("f%d.png", resume);
    EXPECT_EQ(without.status, 0);
    EXPECT_NE(without.err.find("peelray: note: 3 of the frames that are there are older than f%d.png.json"),
              std::string::npos)
        << without.err;
    EXPECT_TRUE(contents() == whole);
    // A frame without its auxiliary picture is not finished.
    fs::remove(out("f2.depth.exr"));
    const Outcome lacking = sequence("f%d.png", resume);
    EXPECT_NE(lacking.out.find("1 frame of 0 to 2, 2 were there already"), std::string::npos) << lacking.out;
    EXPECT_TRUE(contents() == whole);
    // Other settings, without --resume: a new beginning, to which the old frames do not belong.
    ASSERT_EQ(sequence("f%d.png", {"--tracer", "cpu", "--frames", "0:1", "--aov", "depth", "--floor"}).status, 0);
    const Outcome mixed =
        sequence("f%d.png", {"--tracer", "cpu", "--frames", "0:3", "--aov", "depth", "--floor", "--resume"});
    EXPECT_NE(mixed.out.find("2 frames of 0 to 2, 1 was there already"), std::string::npos) << mixed.out;
    EXPECT_NE(mixed.err.find("2 of the frames that are there"), std::string::npos) << mixed.err;
    const auto mixture = contents();
    remove_outputs();
    ASSERT_EQ(sequence("f%d.png", {"--tracer", "cpu", "--frames", "0:3", "--aov", "depth", "--floor"}).status, 0);
    EXPECT_TRUE(contents() == mixture);
}

TEST_F(Resume, WhereAPictureIsItsAuxiliaryPicturesAre) {
    // The second frame's cannot be written: then it has no main picture either.
    fs::create_directory(out("f1.normal.exr"));
    const Words options = {"--tracer", "cpu", "--frames", "0:3", "--aov", "depth,normal"};
    const Outcome run = sequence("f%d.png", options);
    expect_refused_untouched(run, {"f1.normal.exr", "it is a folder"});
    EXPECT_TRUE(fs::exists(out("f0.png")));
    EXPECT_FALSE(fs::exists(out("f1.png")));
    fs::remove(out("f1.normal.exr"));
    Words resume = options;
    resume.push_back("--resume");
    EXPECT_EQ(sequence("f%d.png", resume).status, 0);
    EXPECT_EQ(outputs().size(), 10u);
}

TEST_F(Resume, OldTemporariesGo) {
    const auto aged = [&](const std::string& name, int hours) {
        put("out/" + name, "half");
        fs::last_write_time(out(name), fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    aged(".peelray-1-0.tmp.png", 25);
    aged(".peelray-1-1.tmp.png", 23);
    aged("peelray-1-0.tmp.png", 25);
    ASSERT_EQ(sequence("f%d.png", {"--tracer", "cpu", "--frames", "0:1", "--resume"}).status, 0);
    EXPECT_EQ(outputs(), (Words{".peelray-1-1.tmp.png", "f%d.png.json", "f0.png", "peelray-1-0.tmp.png"}));
}

// ---- the manifest

TEST_F(Resume, AnotherSettingIsRefused) {
    write_hdr(in("sky.hdr"), Image{2, 1, {glm::vec4(1), glm::vec4(0.5f)}});
    const Words base = {"--frames", "0:2", "--tracer", "none", "--env", in("sky.hdr"), "--time"};
    const auto with = [&](Words more) {
        Words all = {"--frames", "0:2", "--tracer", "none", "--env", in("sky.hdr"), "--resume"};
        all.insert(all.end(), more.begin(), more.end());
        return sequence("f%d.png", all);
    };
    ASSERT_EQ(with({}).status, 0);
    const auto before = stamps();
    struct Case {
        Words options;
        std::string says;
    };
    for (const Case& c : std::vector<Case>{
             {{"--spp", "2"}, "--spp was 1, is 2 "},
             {{"--eye", "1,2.5,3"}, "--eye was not given, is 1,2.5,3 "},
             {{"--floor"}, "--floor was not given, is given "},
             {{"--fps", "29.97"}, "--fps was 30, is 29.97 "},
             {{"--animation", "grow"}, "--animation was 0, is grow "},
             {{"--turntable", "5"}, "--turntable was not given, is 5"},
             {{"--ldc", "64"}, "--ldc was not given, is 64 "},
             {{"--aov", "normal,depth"}, "--aov was not given, is depth,normal "},
             {{"--effects", "shadow"}, "--effects was reflection,refraction,shadow, is shadow "},
             {{"--exposure", "1", "--bounces", "2"}, "--exposure was 0, is 1; --bounces was 4, is 2 "},
             {{"--exposure", "1", "--bounces", "2", "--spp", "2", "--floor"}, "--spp was 1, is 2; and 1 more "}}) {
        SCOPED_TRACE(c.says);
        expect_refused_untouched(with(c.options), {c.says, "f%d.png.json", "remove that file to start anew"});
    }
    expect_refused_untouched(sequence("f%d.png", {"--frames", "0:2", "--tracer", "none", "--resume"}),
                             {"--env was sky.hdr, is not given"});
    expect_refused_untouched(
        sequence("f%d.png", {"--frames", "0:2", "--tracer", "reference", "--env", in("sky.hdr"), "--resume"}),
        {"the device was ", ", is reference, Embree", "--tracer was none, is reference"});
    expect_refused_untouched(
        sequence("f%d.png", {"--frames", "0:2", "--tracer", "none", "--env", in("sky.hdr"), "--resume"}, "camera.gltf"),
        {"the scene was moving.gltf, is camera.gltf "});
    EXPECT_EQ(stamps(), before);
    // The same said in other words, and what shapes no picture, may differ.
    const Outcome same = with({"--fps", "30.0", "--spp", "1", "--effects", "shadow,refraction,reflection", "--validate",
                               "--stats", in("s.json"), "--shard", "0/1", "--device", "0"});
    EXPECT_EQ(same.status, 0) << same.err;
    EXPECT_EQ(stamps(), before);
}

TEST_F(Resume, AnotherFileIsRefused) {
    write_hdr(in("sky.hdr"), Image{2, 1, {glm::vec4(1), glm::vec4(0.5f)}});
    auto gltf = moving_gltf();
    gltf["images"] = {{{"uri", "t.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    put("moving.gltf", gltf.dump());
    write_png(in("t.png"), Image8{1, 1, {0xff0000ffu}});
    const Words options = {"--frames", "0:2", "--tracer", "none", "--env", in("sky.hdr"), "--resume"};
    ASSERT_EQ(sequence("f%d.png", options).status, 0);
    EXPECT_EQ(manifest()["files"].size(), 5u) << manifest();
    const auto before = stamps();
    const auto refuse_other = [&](const std::string& name, const std::string& bytes, const std::string& says) {
        const std::string old = get(in(name));
        put(name, bytes);
        expect_refused_untouched(sequence("f%d.png", options),
                                 {"the content of " + says + " was xxh128:", ", is xxh128:"});
        put(name, old);
    };
    gltf["nodes"][0]["translation"] = {0, 0, -1};
    refuse_other("moving.gltf", gltf.dump(), "moving.gltf");
    std::string keys = moving_keys();
    keys[20] ^= 1;
    refuse_other("keys.bin", keys, "keys.bin");
    refuse_other("square.bin", square_bytes({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1.5f, 0}), "square.bin");
    write_png(in("u.png"), Image8{1, 1, {0xff00ff00u}});
    refuse_other("t.png", get(in("u.png")), "t.png");
    write_hdr(in("other.hdr"), Image{2, 1, {glm::vec4(2), glm::vec4(0.5f)}});
    refuse_other("sky.hdr", get(in("other.hdr")), "--env sky.hdr");
    EXPECT_EQ(stamps(), before);
    // The same files in another place are the same.
    fs::create_directory(folder / "moved");
    for (const std::string name : {"moving.gltf", "keys.bin", "square.bin", "t.png"})
        fs::rename(in(name), folder / "moved" / name);
    const Outcome moved = sequence("f%d.png", options, "moved/moving.gltf");
    EXPECT_EQ(moved.status, 0) << moved.err;
    EXPECT_EQ(stamps(), before);
}

TEST_F(Resume, AManifestThatIsNone) {
    const Words options = {"--frames", "0:1", "--tracer", "cpu", "--resume"};
    for (const std::string text : {"", "{", "[1]", "{}", "{\"manifest\": 2}", "null"}) {
        put("out/f%d.png.json", text);
        expect_refused_untouched(sequence("f%d.png", options), {"f%d.png.json is no manifest"});
        EXPECT_EQ(outputs(), Words{"f%d.png.json"});
    }
    // A new beginning replaces it.
    ASSERT_EQ(sequence("f%d.png", {"--frames", "0:1", "--tracer", "cpu"}).status, 0);
    EXPECT_EQ(manifest()["manifest"], 1);
}

TEST_F(Resume, TheManifestKnowsEveryOptionThatShapesAPicture) {
    ASSERT_EQ(sequence("f%d.png", {"--frames", "0:1", "--tracer", "cpu"}).status, 0);
    const auto json = manifest();
    for (const char* key : {"program", "commit", "device", "scene"}) EXPECT_TRUE(json[key].is_string()) << key;
    // An option that is in neither was forgotten.
    const std::vector<std::string> shapeless = {
        "--help",   "--output",   "--stats",    "--frames",  "--shard",        "--resume",      "--repeat",
        "--device", "--validate", "--counters", "--preview", "--keep-partial", "--memory-limit"};
    const std::string help = run({"render", "--help"}).out;
    const std::regex option("\n  (?:-.,)?(--[a-z-]+)");
    size_t count = 0;
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it, ++count) {
        const std::string name = (*it)[1];
        const bool listed = std::find(shapeless.begin(), shapeless.end(), name) != shapeless.end();
        EXPECT_NE(json["settings"].contains(name), listed) << name;
    }
    EXPECT_GT(count, 30u);
}

// ---- shards

TEST_F(Resume, ShardsMakeTheWhole) {
    const Words options = {"--frames", "1:8", "--floor", "--aov", "normal", "--tracer", "ldc"};
    ASSERT_EQ(sequence("f%d.png", options).status, 0);
    const auto whole = contents();
    remove_outputs();
    std::vector<Running> shards;
    for (const std::string shard : {"0/3", "1/3", "2/3"}) {
        Words more = options;
        more.insert(more.end(), {"--shard", shard});
        shards.push_back(start(words("f%d.png", more), {}, shard.substr(0, 1)));
    }
    for (size_t i = 0; i < shards.size(); i++) {
        const Outcome run = shards[i].wait();
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.out.find(fmt::format("{} frames of 1 to 7 (shard {}/3)", i == 0 ? 3 : 2, i)), std::string::npos)
            << run.out;
    }
    EXPECT_TRUE(contents() == whole);
}

TEST_F(Resume, AShardTakesItsPositionsInTheRange) {
    const auto shard = [&](const std::string& range, const std::string& part) {
        return sequence("f%d.png", {"--frames", range, "--tracer", "cpu", "--shard", part});
    };
    expect_done(shard("3:8", "1/2"), {"f%d.png.json", "f4.png", "f6.png"});
    const Outcome none = shard("3:5", "2/4");
    EXPECT_EQ(none.status, 0);
    EXPECT_NE(none.out.find("no frames: shard 2/4 of 2"), std::string::npos) << none.out;
    // Shards share their frames: one that is told otherwise than the others is refused, also without --resume.
    expect_refused_untouched(
        sequence("f%d.png", {"--frames", "3:8", "--tracer", "cpu", "--shard", "0/2", "--spp", "2"}),
        {"--spp was 1, is 2"});
    // Each goes on by itself.
    fs::remove(out("f6.png"));
    const Outcome rest = sequence("f%d.png", {"--frames", "3:8", "--tracer", "cpu", "--shard", "1/2", "--resume"});
    expect_done(rest, {"f%d.png.json", "f4.png", "f6.png"});
    EXPECT_NE(rest.out.find("1 frame of 3 to 7 (shard 1/2), 1 was there already"), std::string::npos) << rest.out;
}

}  // namespace
}  // namespace peelray
