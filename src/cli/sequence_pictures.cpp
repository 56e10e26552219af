// `peelray render` of several frames into pictures by a pattern.
#include <atomic>

#include "base/cores.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/frame_pattern.h"
#include "cli/manifest.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/picture_files.h"
#include "cli/sequence_run.h"
#include "cli/stats_json.h"

namespace peelray {

namespace fs = std::filesystem;

namespace {

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

}  // namespace

void render_pictures(const RenderArguments& a, const Sequence& sequence) {
    const FramePattern pattern(a.output);
    check_picture_name(a);
    check_files(a, pattern, sequence, {a.scene, a.env});
    SequenceRun run(a, sequence);
    check_files(a, pattern, sequence, run.scene().scene().files);
    watch_interrupts();
    remove_stale_temporaries(a.output.parent_path());
    settle_manifest(manifest_path(a.output), make_manifest(a, sequence, run.scene(), run.renderer_name()),
                    a.sequence.resume || a.sequence.shard);
    const std::vector<uint32_t> frames = choose_frames(a, pattern, sequence);
    const size_t left_alone = sequence.numbers().size() - frames.size();
    const PictureFiles files = picture_files(a);
    std::atomic<size_t> beyond{0};  // what half floats reach
    FramePool pool(usable_cores());
    try {
        run.render(frames, pool, SequenceRun::Rest::written, [&](uint32_t frame) -> SequenceRun::Tasks {
            return {
                [&, frame](const Picture& picture) { beyond += write_picture(picture, files, pattern.file(frame)); }};
        });
    } catch (const Interrupted&) {
        fail("interrupted after {} of {}: the same command with --resume goes on", pool.finished(),
             counted("{} frame{|s}", frames.size()));
    }
    print_if_any(beyond_note(beyond));
    if (!a.stats.empty()) write_json(a.stats, run.stats(left_alone));
    print_result(a.output, run.summary(left_alone));
}

}  // namespace peelray
