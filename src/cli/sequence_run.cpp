#include "cli/sequence_run.h"

#include <algorithm>

#include "base/elapsed.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/messages.h"
#include "cli/render_plan.h"
#include "cli/stats_json.h"

namespace peelray {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

namespace {

/// The arguments of the frame that comes first: what is said of --time holds for it as for a single picture.
RenderArguments at_first_frame(const RenderArguments& a, const Sequence& sequence) {
    RenderArguments first = a;
    if (sequence.runs) first.time = sequence.shot(sequence.numbers().front()).time;
    first.goes_round = sequence.turntable > 0;
    return first;
}

}  // namespace

SequenceRun::SequenceRun(const RenderArguments& arguments, const Sequence& sequence)
    : sequence_(sequence), arguments_(at_first_frame(arguments, sequence)), workspace_(arguments_, print_note) {}

MadePicture SequenceRun::make(uint32_t frame, const std::function<void(double)>& progress) {
    RenderSettings settings = render_settings(arguments_);
    // What nobody asks for is not measured.
    settings.time_passes = settings.bodies = !arguments_.stats.empty();
    try {
        return workspace_.render(settings, sequence_.shot(frame), progress);
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        fail("frame {}: {}", frame, error.text());
    }
}

void SequenceRun::count(uint32_t frame, MadePicture& made) {
    done_++;
    device_ = made.stats.machine.name;
    rays_ += made.picture.rays;
    frame_ms_ += made.stats.render.frame_ms;
    build_ms_ += made.stats.render.build_ms;
    if (!arguments_.stats.empty()) frames_.push_back({frame, sequence_.shot(frame), std::move(made.stats)});
}

Json SequenceRun::frame_json(const Frame& frame) const {
    const std::optional<double> time = frame.shot.time ? frame.shot.time : scene().time();
    Json json = {{"frame", frame.number}, {"time", time ? Json(*time) : Json(nullptr)}};
    if (sequence_.turntable > 0) json["turn_degrees"] = frame.shot.turn() * 360;
    json.update(picture_json(frame.stats));
    return json;
}

void SequenceRun::render(const std::vector<uint32_t>& frames, FramePool& pool, Rest rest, const TasksOf& tasks_of) {
    try {
        render_all(frames, pool, tasks_of);
    } catch (...) {
        // What is rendered was worth it. If it cannot be written, that is what to say.
        if (rest == Rest::written) pool.finish({});
        throw;
    }
}

void SequenceRun::render_all(const std::vector<uint32_t>& frames, FramePool& pool, const TasksOf& tasks_of) {
    Progress bar("rendering", double(frames.size()), "frames");
    double rendered = 0;
    // Frames count when they are written; what is done of the next one only makes the bar move.
    const auto show = [&] { bar.update(std::min(rendered, double(pool.finished()) + 0.999)); };
    for (size_t i = 0; i < frames.size(); i++) {
        check_interrupt();
        if (std::optional<Picture> spare = pool.spare()) workspace_.reuse(std::move(*spare));
        const Clock::time_point start = Clock::now();
        MadePicture made = make(frames[i], [&](double share) {
            rendered = double(i) + share;
            show();
        });
        render_seconds_ += seconds_since(start);
        count(frames[i], made);
        Tasks tasks = tasks_of(frames[i]);
        pool.add(std::move(made.picture), std::move(tasks.work), std::move(tasks.deliver), show);
        rendered = double(i + 1);
        show();
    }
    pool.finish(show);
}

Json SequenceRun::stats(size_t left_alone) const {
    const double seconds = seconds_since(start_);
    Json frames = Json::array();
    for (const Frame& frame : frames_) frames.push_back(frame_json(frame));
    return {{"frames", frames},
            {"totals",
             {{"frames", done_},
              {"frames_left_alone", left_alone},
              {"seconds", seconds},
              {"frames_per_second", done_ / seconds},
              {"frame_ms", frame_ms_},
              {"build_ms", build_ms_},
              {"rays", rays_json(rays_)}}}};
}

std::string SequenceRun::summary(size_t left_alone) const {
    const Sequence& s = sequence_;
    const double seconds = seconds_since(start_);
    std::string text = fmt::format("{} of {} to {}", counted("{} frame{|s}", done_), s.frames.first, s.frames.end - 1);
    if (s.shard.count > 1) text += fmt::format(" (shard {}/{})", s.shard.index, s.shard.count);
    if (left_alone > 0) text += counted(", {} {was|were} there already", left_alone);
    text += fmt::format(", {}x{}", arguments_.size.x, arguments_.size.y);
    text += fmt::format("; {:.2f} s in all", seconds);
    if (done_ > 0) text += fmt::format(", {:.3g} frames/s", done_ / seconds);
    return device_.empty() ? text : text + " on " + device_;
}

}  // namespace peelray
