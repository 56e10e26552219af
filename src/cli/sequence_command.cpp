// `peelray render` of several frames: pictures by a pattern, or a video.
#include <chrono>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/frame_pattern.h"
#include "cli/manifest.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/picture_files.h"
#include "cli/render_plan.h"
#include "cli/stats_json.h"
#include "cli/video.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The arguments of the frame that comes first: what is said of --time holds for it as for a single picture.
RenderArguments at_first_frame(const RenderArguments& a, const Sequence& sequence) {
    RenderArguments first = a;
    if (sequence.runs) first.time = sequence.shot(sequence.numbers().front()).time;
    first.goes_round = sequence.turntable > 0;
    return first;
}

/// Everything that the frames of a run share.
class Run {
  public:
    Run(const RenderArguments& a, const Sequence& sequence)
        : sequence_(sequence), arguments_(at_first_frame(a, sequence)), workspace_(arguments_, print_note) {}

    const PosedScene& scene() const { return workspace_.scene(); }
    std::string renderer_name() { return workspace_.renderer_name(*arguments_.tracing.tracer); }
    size_t done() const { return done_; }

    using Write = std::function<void(uint32_t frame, const MadePicture& picture)>;
    /// Renders frames and hands each to `write`. Throws Interrupted between any two steps.
    void render(const std::vector<uint32_t>& frames, const Write& write);

    /// The stats file. `left_alone`: frames that were there already.
    Json stats(size_t left_alone) const;
    /// What to print in the end, without what was written.
    std::string summary(size_t left_alone) const;

  private:
    MadePicture make(uint32_t frame, const std::function<void(double)>& progress);
    void count(uint32_t frame, MadePicture& made);

    const Sequence& sequence_;
    Clock::time_point start_ = Clock::now();
    RenderArguments arguments_;
    Workspace workspace_;
    size_t done_ = 0;
    std::string device_;  ///< that rendered so far
    RayCounts rays_;
    double frame_ms_ = 0, build_ms_ = 0;
    struct Frame {
        uint32_t number;
        Shot shot;
        PictureStats stats;
    };
    Json frame_json(const Frame& frame) const;
    std::vector<Frame> frames_;  ///< for the stats file, if there is one
};

MadePicture Run::make(uint32_t frame, const std::function<void(double)>& progress) {
    try {
        return workspace_.render(render_settings(arguments_), sequence_.shot(frame), progress);
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        fail("frame {}: {}", frame, error.text());
    }
}

void Run::count(uint32_t frame, MadePicture& made) {
    done_++;
    device_ = made.stats.machine.name;
    rays_ += made.picture.rays;
    frame_ms_ += made.stats.render.frame_ms;
    build_ms_ += made.stats.render.build_ms;
    if (!arguments_.stats.empty()) frames_.push_back({frame, sequence_.shot(frame), std::move(made.stats)});
}

Json Run::frame_json(const Frame& frame) const {
    const std::optional<double> time = frame.shot.time ? frame.shot.time : scene().time();
    Json json = {{"frame", frame.number}, {"time", time ? Json(*time) : Json(nullptr)}};
    if (sequence_.turntable > 0) json["turn_degrees"] = frame.shot.turn() * 360;
    json.update(picture_json(frame.stats));
    return json;
}

void Run::render(const std::vector<uint32_t>& frames, const Write& write) {
    Progress bar("rendering", double(frames.size()), "frames");
    for (size_t i = 0; i < frames.size(); i++) {
        check_interrupt();
        MadePicture made = make(frames[i], [&](double share) { bar.update(double(i) + share); });
        write(frames[i], made);
        count(frames[i], made);
        bar.update(double(i + 1));
    }
}

Json Run::stats(size_t left_alone) const {
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

std::string Run::summary(size_t left_alone) const {
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

// ---- pictures

/// Throws Error where the files of a sequence would overwrite `inputs` or each other.
void check_files(const RenderArguments& a, const FramePattern& pattern, const Sequence& sequence,
                 const std::vector<fs::path>& inputs) {
    const auto is_frame = [&](const fs::path& path) {
        const auto frame = pattern.frame_of(path);
        return frame && *frame >= sequence.frames.first && *frame < sequence.frames.end;
    };
    for (const fs::path& input : inputs)
        if (is_frame(input)) fail("{} is an input and would be overwritten: name another output", input.string());
    if (is_frame(a.stats)) fail("{} would be written twice: give each output a name of its own", a.stats.string());
    const fs::path first = pattern.file(sequence.frames.first);
    std::vector<fs::path> outputs = {first, manifest_path(a.output)};
    for (const fs::path& path : paths_beside(first, a.aovs, a.exr_layers)) outputs.push_back(path);
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, inputs);
}

/// Which frames are there already, wholly and not older than the manifest: those before it may show anything.
class Finished {
  public:
    Finished(const RenderArguments& a, const FramePattern& pattern)
        : arguments_(a), pattern_(pattern), since_(fs::last_write_time(manifest_path(a.output), error_)) {}

    bool has(uint32_t frame) {
        const fs::path file = pattern_.file(frame);
        const auto time = fs::last_write_time(file, error_);
        if (error_) return false;
        const std::vector<fs::path> beside = paths_beside(file, arguments_.aovs, arguments_.exr_layers);
        const bool whole =
            std::all_of(beside.begin(), beside.end(), [&](const fs::path& path) { return fs::exists(path, error_); });
        if (whole && time >= since_) return true;
        outdated++;
        return false;
    }

    size_t outdated = 0;  ///< frames that are there, but not finished

  private:
    std::error_code error_;
    const RenderArguments& arguments_;
    const FramePattern& pattern_;
    fs::file_time_type since_;
};

/// The frames that are left to render.
std::vector<uint32_t> choose_frames(const RenderArguments& a, const FramePattern& pattern, const Sequence& sequence) {
    std::vector<uint32_t> frames = sequence.numbers();
    if (!a.sequence.resume) return frames;
    Finished finished(a, pattern);
    std::erase_if(frames, [&](uint32_t frame) { return finished.has(frame); });
    if (finished.outdated > 0)
        print_note(
            fmt::format("{} of the frames that are there are older than {} or lack their auxiliary pictures: they "
                        "are rendered again",
                        finished.outdated, manifest_path(a.output).filename().string()));
    return frames;
}

void render_pictures(const RenderArguments& a, const Sequence& sequence) {
    const FramePattern pattern(a.output);
    check_picture_name(a.output, a.exr_layers, a.is_transparent());
    check_files(a, pattern, sequence, {a.scene, a.env});
    Run run(a, sequence);
    check_files(a, pattern, sequence, run.scene().scene().files);
    watch_interrupts();
    remove_stale_temporaries(a.output.parent_path());
    settle_manifest(manifest_path(a.output), make_manifest(a, sequence, run.scene(), run.renderer_name()),
                    a.sequence.resume || a.sequence.shard);
    const std::vector<uint32_t> frames = choose_frames(a, pattern, sequence);
    const size_t left_alone = sequence.numbers().size() - frames.size();
    try {
        run.render(frames, [&](uint32_t frame, const MadePicture& made) {
            write_picture(made.picture, a.aovs, a.exr_layers, pattern.file(frame));
        });
    } catch (const Interrupted&) {
        fail("interrupted after {} of {}: the same command with --resume goes on", run.done(),
             counted("{} frame{|s}", frames.size()));
    }
    if (!a.stats.empty()) write_json(a.stats, run.stats(left_alone));
    fmt::print("{}: {}\n", a.output.string(), run.summary(left_alone));
}

// ---- videos

void check_video(const RenderArguments& a) {
    const char* option = a.sequence.resume ? "--resume" : a.sequence.shard ? "--shard" : nullptr;
    if (option)
        fail(
            "{} needs a file for each frame, a video is one: render pictures (-o NAME_%05d.png) and let ffmpeg make "
            "the video of them",
            option);
    if (!a.aovs.empty()) fail("--aov writes pictures and a video is none: render pictures (-o NAME_%05d.exr)");
    if (a.is_transparent())
        fail(
            "--background transparent needs an alpha channel and a video has none: render pictures (-o NAME_%05d.png), "
            "or give a colour");
    if (has_frame_number(a.output))
        fail("'{}' has a place for a frame's number, but a video is one file: leave it out", a.output.string());
    check_video_size(a.size);
}

void render_video(const RenderArguments& a, const Sequence& sequence) {
    check_video(a);
    const fs::path ffmpeg = find_ffmpeg();
    std::vector<fs::path> outputs = {a.output};
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, {a.scene, a.env});
    Run run(a, sequence);
    watch_interrupts();
    remove_stale_temporaries(a.output.parent_path());
    const std::vector<uint32_t> frames = sequence.numbers();
    try {
        write_atomically(a.output, [&](const fs::path& temporary) {
            VideoWriter video(ffmpeg, temporary, a.size, sequence.fps);
            run.render(frames, [&](uint32_t, const MadePicture& made) { video.add(made.picture.encoded); });
            video.finish();
            if (fs::file_size(temporary) == 0) fail("ffmpeg wrote nothing and did not say why; no video was written");
        });
    } catch (const Interrupted&) {
        fail("interrupted after {} of {}: no video was written; run it again", run.done(),
             counted("{} frame{|s}", frames.size()));
    }
    if (!a.stats.empty()) write_json(a.stats, run.stats(0));
    fmt::print("{}: {:.2f} s at {} frames/s; {}\n", a.output.string(), double(frames.size()) / sequence.fps,
               sequence.fps, run.summary(0));
}

}  // namespace

void run_sequence(const RenderArguments& a) {
    check(a);
    check_counters(a);
    check_ends(a);
    const Sequence sequence = plan_sequence(a);
    if (is_video(a.output)) return render_video(a, sequence);
    if (sequence.numbers().empty()) {
        FramePattern(a.output);
        fmt::print("{}: no frames: shard {}/{} of {} has none\n", a.output.string(), sequence.shard.index,
                   sequence.shard.count, sequence.frames.end - sequence.frames.first);
        return;
    }
    render_pictures(a, sequence);
}

}  // namespace peelray
