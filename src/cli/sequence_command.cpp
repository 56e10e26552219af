// `peelray render` of several frames: what is asked for, and into what.
#include "base/error.h"
#include "cli/commands.h"
#include "cli/frame_pattern.h"
#include "cli/render_plan.h"
#include "cli/sequence_run.h"
#include "cli/standard_output.h"
#include "cli/video.h"

namespace peelray {

void run_sequence(const RenderArguments& a) {
    check(a);
    check_counters(a);
    check_ends(a);
    const Sequence sequence = plan_sequence(a);
    if (is_video(a.output)) return render_video(a, sequence);
    if (is_standard_output(a.output)) return render_stream(a, sequence);
    if (sequence.numbers().empty()) {
        FramePattern(a.output);
        fmt::print("{}: no frames: shard {}/{} of {} has none\n", a.output.string(), sequence.shard.index,
                   sequence.shard.count, sequence.frames.end - sequence.frames.first);
        return;
    }
    render_pictures(a, sequence);
}

}  // namespace peelray
