#include "cli/sequence.h"

#include "base/error.h"
#include "cli/frame_pattern.h"
#include "cli/render_plan.h"
#include "cli/standard_output.h"
#include "cli/video.h"

namespace peelray {
namespace {

FrameRange choose_frames(const SequenceArguments& s) {
    const FrameRange frames = s.frames.value_or(FrameRange{0, s.turntable.value_or(0)});
    if (frames.first >= frames.end)
        fail("--frames {}:{} holds no frame: A:B are the frames from A up to B - 1", frames.first, frames.end);
    if (s.turntable && frames.end > *s.turntable)
        fail("--frames {}:{} reaches beyond the {} frames of the turntable: choose from 0:{}", frames.first, frames.end,
             *s.turntable, *s.turntable);
    if (frames.end - frames.first > kMostFrames)
        fail("{} frames are too many: choose up to {} (--frames)", frames.end - frames.first, kMostFrames);
    return frames;
}

}  // namespace

std::vector<uint32_t> Sequence::numbers() const {
    std::vector<uint32_t> numbers;
    for (uint64_t k = uint64_t(frames.first) + shard.index; k < frames.end; k += shard.count)
        numbers.push_back(uint32_t(k));
    return numbers;
}

Shot Sequence::shot(uint32_t frame) const {
    Shot shot;
    if (runs) shot.time = frame / fps;
    shot.fps = runs ? fps : 0;
    shot.number = frame;
    shot.turntable = turntable;
    return shot;
}

Sequence plan_sequence(const RenderArguments& a) {
    const SequenceArguments& s = a.sequence;
    Sequence sequence;
    sequence.frames = choose_frames(s);
    sequence.turntable = s.turntable.value_or(0);
    sequence.fps = s.fps.value_or(kUsualFps);
    sequence.shard = s.shard.value_or(Shard{});
    if (!s.turntable && a.time)
        fail("--frames show many moments and --time one: leave one of them out (a --turntable can stand at --time)");
    sequence.runs = !a.time && (!s.turntable || s.fps || !a.animation.empty());
    if (sequence.runs && a.frame_moment)
        fail(
            "--frame-moment would frame each of many moments anew: leave it out, or show one moment (--time, also with "
            "--turntable)");
    if (sequence.runs && (sequence.frames.end - 1) / sequence.fps > 1e6)
        fail("frame {} at {} frames per second is beyond 1000000 seconds: choose other --frames or --fps",
             sequence.frames.end - 1, sequence.fps);
    if (sequence.shard.index >= sequence.shard.count)
        fail("there is no shard {}/{}: the shards of n are 0/n to n-1/n (--shard)", sequence.shard.index,
             sequence.shard.count);
    if (a.repeat > 1) fail("--repeat measures one picture: leave it out for several frames");
    return sequence;
}

void check_single(const RenderArguments& a) {
    const SequenceArguments& s = a.sequence;
    if (is_video(a.output))
        fail("'{}' is a video: say which frames with --frames A:B or --turntable N", a.output.string());
    if (has_frame_number(a.output))
        fail("'{}' has a place for a frame's number: say which frames with --frames A:B or --turntable N",
             a.output.string());
    if (is_standard_output(a.output) && !a.aovs.empty())
        fail("--aov writes files beside the picture, and the standard output has none: name the picture (-o NAME.png)");
    const bool looks_back = wants(a, Aov::motion) || a.denoise == Denoise::temporal;
    const char* option = s.fps && !looks_back ? "--fps" : s.shard ? "--shard" : s.resume ? "--resume" : nullptr;
    if (option)
        fail("{} is for several frames: add --frames A:B or --turntable N{}", option,
             s.fps ? ", or --aov motion or --denoise temporal" : "");
}

}  // namespace peelray
