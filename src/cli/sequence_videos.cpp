// `peelray render` of several frames into a video: a file, by ffmpeg, or the standard output.
#include "base/cores.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/frame_pattern.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/sequence_run.h"
#include "cli/standard_output.h"
#include "cli/stats_json.h"
#include "cli/video.h"
#include "image/image.h"
#include "image/y4m.h"

namespace peelray {

namespace fs = std::filesystem;

namespace {

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
    if (a.half || a.exr_compression)
        fail("{} is for .exr files and a video is none: render pictures (-o NAME_%05d.exr), or leave it out",
             a.half ? "--half" : "--exr-compression");
    if (has_frame_number(a.output))
        fail("'{}' has a place for a frame's number, but a video is one file: leave it out", a.output.string());
    check_video_size(a.size);
}

std::string length_of(const Sequence& sequence, size_t frames) {
    return fmt::format("{:.2f} s at {} frames/s", double(frames) / sequence.fps, sequence.fps);
}

}  // namespace

void render_video(const RenderArguments& a, const Sequence& sequence) {
    check_video(a);
    const fs::path ffmpeg = find_ffmpeg();
    std::vector<fs::path> outputs = {a.output};
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, {a.scene, a.env});
    SequenceRun run(a, sequence);
    watch_interrupts();
    remove_stale_temporaries(a.output.parent_path());
    const std::vector<uint32_t> frames = sequence.numbers();
    size_t done = 0;
    try {
        write_atomically(a.output, [&](const fs::path& temporary) {
            VideoWriter video(ffmpeg, temporary, a.size, sequence.fps);
            FramePool pool(1);  // which feeds ffmpeg, that works on threads of its own
            run.render(frames, pool, SequenceRun::Rest::dropped, [&](uint32_t) -> SequenceRun::Tasks {
                return {[&](const Picture& picture) {
                    video.add(picture.encoded);
                    done++;
                }};
            });
            video.finish();
            if (fs::file_size(temporary) == 0) fail("ffmpeg wrote nothing and did not say why; no video was written");
        });
    } catch (const Interrupted&) {
        fail("interrupted after {} of {}: no video was written; run it again", done,
             counted("{} frame{|s}", frames.size()));
    }
    if (!a.stats.empty()) write_json(a.stats, run.stats(0));
    print_result(a.output, length_of(sequence, frames.size()) + "; " + run.summary(0));
}

void render_stream(const RenderArguments& a, const Sequence& sequence) {
    check_video(a);
    StandardOutput out;
    if (!a.stats.empty()) check_outputs({a.stats}, {a.scene, a.env});
    SequenceRun run(a, sequence);
    watch_interrupts();
    const std::vector<uint32_t> frames = sequence.numbers();
    out.write(y4m_header(a.size.x, a.size.y, sequence.fps));
    FramePool pool(usable_cores());
    try {
        run.render(frames, pool, SequenceRun::Rest::dropped, [&](uint32_t) -> SequenceRun::Tasks {
            const auto bytes = std::make_shared<std::string>();
            return {[=](const Picture& picture) {
                        *bytes = y4m_frame({picture.width, picture.height, picture.encoded});
                    },
                    [=, &out] { out.write(*bytes); }};
        });
    } catch (const Interrupted&) {
        fail("interrupted after {} of {}: the video on the standard output ends there; run it again", pool.finished(),
             counted("{} frame{|s}", frames.size()));
    }
    if (!a.stats.empty()) write_json(a.stats, run.stats(0));
    print_result(a.output, length_of(sequence, frames.size()) + "; " + run.summary(0));
}

}  // namespace peelray
