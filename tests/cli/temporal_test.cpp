// --denoise: its values, and frames by it in sequences, shards, resumed runs and alone.
#include "cli/sequence_fixture.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

class TemporalSequence : public SequenceTest {
  protected:
    /// Noisy, and of small cost.
    static Words noisy(Words more) {
        Words all = {"--effects", "shadow,ambient", "--denoise", "temporal", "--floor"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

TEST_F(TemporalSequence, AFrameIsTheSameInWholeShardedAndResumedRunsAndAlone) {
    ASSERT_EQ(sequence("f%d.png", noisy({"--frames", "0:9"})).status, 0);
    const auto whole = contents();
    // The second half of a run that was interrupted, without any frame of the first.
    for (const int frame : {4, 6, 7, 8}) fs::remove(out(fmt::format("f{}.png", frame)));
    const Outcome resumed = sequence("f%d.png", noisy({"--frames", "0:9", "--resume"}));
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_TRUE(contents() == whole);
    remove_outputs();
    ASSERT_EQ(sequence("f%d.png", noisy({"--frames", "0:9", "--shard", "1/4"})).status, 0);
    for (const int frame : {1, 5})
        EXPECT_EQ(get(out(fmt::format("f{}.png", frame))), whole.at(fmt::format("f{}.png", frame))) << frame;
    remove_outputs();
    ASSERT_EQ(sequence("a.png", noisy({"--time", fmt::format("{}", 7 / 30.0)})).status, 0);
    EXPECT_EQ(get(out("a.png")), whole.at("f7.png"));
    const Outcome slow = sequence("a.png", noisy({"--time", "0.2", "--fps", "10"}));
    EXPECT_EQ(slow.status, 0) << slow.err;
    EXPECT_NE(get(out("a.png")), whole.at("f6.png")) << "it looks back by a tenth of a second";
}

TEST_F(TemporalSequence, TheValueMayBeLeftOut) {
    const auto made = [&](const Words& options) {
        const Outcome run = sequence("a.png", options);
        EXPECT_EQ(run.status, 0) << run.err;
        return get(out("a.png"));
    };
    const Words noise = {"--tracer", "reference", "--effects", "shadow,ambient"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), noise.begin(), noise.end());
        return made(more);
    };
    const std::string plain = with({}), spatial = with({"--denoise", "spatial"}),
                      temporal = with({"--denoise=temporal"});
    EXPECT_NE(plain, spatial);
    EXPECT_NE(spatial, temporal);
    EXPECT_EQ(with({"--denoise"}), spatial);
    EXPECT_EQ(with({"--denoise", "--floor", "--denoise", "none"}), with({"--floor"}));
    // Before the scene, which is no value of it.
    const Outcome first = run({"render", "--denoise", in("moving.gltf"), "-o", out("a.png"), "--size", "64x48",
                               "--tracer", "reference", "--effects", "shadow,ambient"});
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(get(out("a.png")), spatial);
    remove_outputs();
    expect_refused(sequence("a.png", {"--denoise=temporary"}), 2, "'temporary' is not one of spatial|temporal|none");
    expect_refused(sequence("a.png", {"--denoise", "temporary"}), 2, "'temporary' is one argument too many");
    expect_refused(sequence("a.png", {"--denoise", "temporal", "--time-limit", "1"}), 1, "--time-limit");
}

}  // namespace
}  // namespace peelray
