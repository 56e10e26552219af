// Which frames a run renders and what each of them shows.
#include "cli/sequence.h"

#include "image/temp_folder.h"

namespace peelray {
namespace {

using Numbers = std::vector<uint32_t>;

RenderArguments of_frames(uint32_t first, uint32_t end) {
    RenderArguments arguments;
    arguments.sequence.frames = FrameRange{first, end};
    return arguments;
}

RenderArguments of_turntable(uint32_t frames) {
    RenderArguments arguments;
    arguments.sequence.turntable = frames;
    return arguments;
}

TEST(SequencePlan, FramesAreMomentsOfTheAnimation) {
    const Sequence sequence = plan_sequence(of_frames(10, 13));
    EXPECT_EQ(sequence.numbers(), Numbers({10, 11, 12}));
    EXPECT_EQ(sequence.shot(10).time, 10 / 30.0);
    EXPECT_EQ(sequence.shot(10).turn(), 0);
    RenderArguments slow = of_frames(0, 3);
    slow.sequence.fps = 0.5;
    EXPECT_EQ(plan_sequence(slow).shot(2).time, 4.0);
}

TEST(SequencePlan, ATurntableStandsUnlessTheAnimationIsAskedFor) {
    const Sequence standing = plan_sequence(of_turntable(8));
    EXPECT_EQ(standing.numbers().size(), 8u);
    EXPECT_EQ(standing.shot(2).turn(), 0.25);
    EXPECT_EQ(standing.shot(2).time, std::nullopt);

    RenderArguments with_fps = of_turntable(8), with_animation = of_turntable(8), at_a_time = of_turntable(8);
    with_fps.sequence.fps = 10;
    EXPECT_EQ(plan_sequence(with_fps).shot(2).time, 0.2);
    with_animation.animation = "walk";
    EXPECT_EQ(plan_sequence(with_animation).shot(3).time, 0.1);
    at_a_time.time = 1.5;
    at_a_time.animation = "walk";
    EXPECT_EQ(plan_sequence(at_a_time).shot(3).time, std::nullopt);

    RenderArguments part = of_turntable(8);
    part.sequence.frames = FrameRange{6, 8};
    EXPECT_EQ(plan_sequence(part).numbers(), Numbers({6, 7}));
    EXPECT_EQ(plan_sequence(part).shot(6).turn(), 0.75);
}

TEST(SequencePlan, ShardsShareTheFramesOutAndLoseNone) {
    for (const uint32_t count : {1u, 2u, 3u, 7u, 100u}) {
        Numbers all;
        for (uint32_t index = 0; index < count; index++) {
            RenderArguments arguments = of_frames(5, 25);
            arguments.sequence.shard = Shard{index, count};
            const Numbers numbers = plan_sequence(arguments).numbers();
            EXPECT_LE(numbers.size(), (20 + count - 1) / count);
            all.insert(all.end(), numbers.begin(), numbers.end());
        }
        std::sort(all.begin(), all.end());
        ASSERT_EQ(all.size(), 20u);
        for (uint32_t k = 0; k < 20; k++) EXPECT_EQ(all[k], 5 + k);
    }
    // No number is added to beyond its type.
    Sequence last;
    last.frames = {4294967290u, 4294967295u};
    last.shard = {1, 4294967295u};
    EXPECT_EQ(last.numbers(), Numbers({4294967291u}));
}

TEST(SequencePlan, WhatContradictsItselfIsRefused) {
    const auto refused = [](RenderArguments arguments, const std::string& says) {
        expect_error([&] { plan_sequence(arguments); }, says);
    };
    refused(of_frames(5, 5), "--frames 5:5 holds no frame");
    refused(of_frames(6, 5), "--frames 6:5 holds no frame");
    refused(of_turntable(0), "holds no frame");
    refused(of_frames(0, kMostFrames + 1), "frames are too many");
    EXPECT_NO_THROW(plan_sequence(of_frames(0, kMostFrames)));

    RenderArguments beyond = of_turntable(8);
    beyond.sequence.frames = FrameRange{4, 9};
    refused(beyond, "--frames 4:9 reaches beyond the 8 frames of the turntable");

    RenderArguments moment = of_frames(0, 2);
    moment.time = 1;
    refused(moment, "leave one of them out");

    RenderArguments framed = of_frames(0, 2);
    framed.frame_moment = true;
    refused(framed, "--frame-moment would frame each of many moments anew");
    RenderArguments runs = of_turntable(8);
    runs.frame_moment = true;
    EXPECT_NO_THROW(plan_sequence(runs)) << "one moment, seen from all sides";
    runs.sequence.fps = 30;
    refused(runs, "--frame-moment");

    RenderArguments late = of_frames(10, 12);
    late.sequence.fps = 1e-5;
    refused(late, "frame 11 at 1e-05 frames per second is beyond 1000000 seconds");

    for (const Shard shard : {Shard{2, 2}, Shard{0, 0}}) {
        RenderArguments sharded = of_frames(0, 2);
        sharded.sequence.shard = shard;
        refused(sharded, "there is no shard " + print_text(shard));
    }

    RenderArguments repeated = of_frames(0, 2);
    repeated.repeat = 2;
    refused(repeated, "--repeat measures one picture");
}

TEST(SequencePlan, APictureTakesNoOptionsOfSequences) {
    RenderArguments single;
    single.output = "a.png";
    EXPECT_NO_THROW(check_single(single));
    for (const auto& [name, says] : {std::pair("a.mp4", "'a.mp4' is a video"), std::pair("a.WEBM", "is a video"),
                                     std::pair("a_%d.png", "has a place for a frame's number")}) {
        single.output = name;
        expect_error([&] { check_single(single); }, says);
    }
    single.output = "a.png";
    RenderArguments fps = single, shard = single, resume = single;
    fps.sequence.fps = 25;
    shard.sequence.shard = Shard{0, 2};
    resume.sequence.resume = true;
    expect_error([&] { check_single(fps); }, "--fps is for several frames");
    expect_error([&] { check_single(shard); }, "--shard is for several frames");
    expect_error([&] { check_single(resume); }, "--resume is for several frames");
}

}  // namespace
}  // namespace peelray
