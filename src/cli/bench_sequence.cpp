// `peelray bench --sequence`: frames on their whole way, and where the time goes.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>

#include "base/cores.h"
#include "base/elapsed.h"
#include "base/error.h"
#include "bench/scenes.h"
#include "cli/bench.h"
#include "cli/bench_output.h"
#include "cli/messages.h"
#include "cli/render_plan.h"
#include "cli/sequence_run.h"
#include "cli/stats_json.h"
#include "cli/version.h"
#include "cli/video.h"
#include "image/image.h"
#include "image/y4m.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;
using SequenceClock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// Seconds of several threads, added up.
class Stopwatch {
  public:
    template <typename Work>
    auto operator()(const Work& work) {
        const auto start = SequenceClock::now();
        auto result = work();
        nanoseconds_ += std::chrono::nanoseconds(SequenceClock::now() - start).count();
        return result;
    }
    double seconds() const { return double(nanoseconds_) * 1e-9; }

  private:
    std::atomic<int64_t> nanoseconds_{0};
};

/// A folder beside others' temporary files (TMPDIR), gone in the end.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::error_code error;
        std::string name = (fs::temp_directory_path(error) / "peelray-bench-XXXXXX").string();
        if (error || !::mkdtemp(name.data()))
            fail("cannot make a folder for temporary files: set TMPDIR to one that can be written");
        path = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    fs::path path;
};

/// A way to go for frames: each stopwatch that is named measures one part of it.
struct Way {
    explicit Way(std::string name) : name(std::move(name)) {}

    std::string name;
    double seconds = 0, rendering = 0, waiting = 0;
    Stopwatch encoding, writing;
};

class SequenceBench {
  public:
    SequenceBench(const BenchArguments& a, const std::string& scene) : frames_(a.repeat) {
        const BenchSceneChoice choice = choose_bench_scene(scene, a);
        static_cast<PictureArguments&>(arguments_) = choice.picture;
        arguments_.size = a.size;
        arguments_.device = a.device;
        arguments_.output = "frame_%d.png";
        // The camera goes around what moves or stands.
        arguments_.sequence.turntable = frames_;
        if (arguments_.scene == "builtin:walker") arguments_.animation = "walk";
        if (!arguments_.animation.empty()) arguments_.time.reset();
        arguments_ = with_tracer(arguments_);
        sequence_ = plan_sequence(arguments_);
    }

    /// Frames by way of `tasks_of`; the first run of a renderer has everything compiled.
    void run(Way& way, const SequenceRun::TasksOf& tasks_of) {
        SequenceRun run(arguments_, sequence_);
        FramePool first(1), pool(usable_cores());
        run.render({0}, first, SequenceRun::Rest::dropped,
                   [](uint32_t) -> SequenceRun::Tasks { return {[](const Picture&) {}}; });
        const double before = run.render_seconds();
        const auto start = SequenceClock::now();
        run.render(sequence_.numbers(), pool, SequenceRun::Rest::dropped, tasks_of);
        way.seconds = seconds_since(start);
        way.rendering = run.render_seconds() - before;
        way.waiting = pool.times().waited;
    }

    /// Rendered, and nothing done with it but that one is kept.
    void run_alone(Way& way) {
        run(way, [&](uint32_t frame) -> SequenceRun::Tasks {
            return {[&, frame](const Picture& picture) {
                if (frame == 0) picture_ = picture;
            }};
        });
    }
    /// PNG files in `folder`.
    void run_png(Way& way, const fs::path& folder) {
        run(way, [&](uint32_t frame) -> SequenceRun::Tasks {
            return {[&, frame](const Picture& p) {
                const fs::path file = folder / fmt::format("frame_{}.png", frame);
                const std::string bytes = way.encoding([&] {
                    return encode_png(file, {p.width, p.height, p.encoded});
                });
                way.writing([&] { return store_file(file, bytes), true; });
            }};
        });
    }
    /// YUV4MPEG2 into nothing.
    void run_y4m(Way& way) {
        std::ofstream nothing("/dev/null", std::ios::binary);
        run(way, [&](uint32_t) -> SequenceRun::Tasks {
            const auto bytes = std::make_shared<std::string>();
            return {
                [&, bytes](const Picture& p) {
                    *bytes = way.encoding([&] { return y4m_frame({p.width, p.height, p.encoded}); });
                },
                [&, bytes] { way.writing([&] { return bool(nothing.write(bytes->data(), long(bytes->size()))); }); }};
        });
    }
    /// Encodes the same picture again and again, on all cores.
    template <typename Encode>
    void run_encoder(Way& way, const Encode& encode) {
        const auto start = SequenceClock::now();
        WorkerPool pool({usable_cores(), 2 * usable_cores()});
        for (uint32_t i = 0; i < frames_; i++)
            pool.add(0, [&] {
                way.encoding([&] { return encode(Image8View(picture_.width, picture_.height, picture_.encoded)); });
            });
        pool.finish();
        way.seconds = seconds_since(start);
    }

    std::string renderer_name() { return SequenceRun(arguments_, sequence_).renderer_name(); }
    uint32_t frames() const { return frames_; }

  private:
    uint32_t frames_;
    RenderArguments arguments_;
    Sequence sequence_;
    Picture picture_;
};

void add_row(BenchOutput& output, const std::string& scene, const Way& way, uint32_t frames) {
    const double rate = frames / way.seconds, encoding = way.encoding.seconds(), writing = way.writing.seconds();
    output.add({{"scene", scene},
                {"way", way.name},
                {"frames", frames},
                {"seconds", way.seconds},
                {"frames_per_second", rate},
                {"rendering_seconds", way.rendering},
                {"waiting_seconds", way.waiting},
                {"encoding_thread_seconds", encoding},
                {"writing_thread_seconds", writing}},
               fmt::format("| {} | {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", scene, way.name, rate,
                           way.seconds, way.rendering, way.waiting, encoding, writing),
               "");
}

void measure(const BenchArguments& a, const std::string& scene, const fs::path& folder, BenchOutput& output) {
    SequenceBench bench(a, scene);
    Way alone{"rendered only"}, png{"PNG files"}, y4m{"y4m into nothing"}, png_encoder{"PNG encoder alone"},
        y4m_encoder{"y4m conversion alone"};
    const auto add = [&](const Way& way) { add_row(output, scene, way, bench.frames()); };
    bench.run_alone(alone);
    add(alone);
    bench.run_png(png, folder);
    add(png);
    bench.run_encoder(png_encoder, [](const Image8View& image) { return encode_png("nothing.png", image); });
    add(png_encoder);
    bench.run_y4m(y4m);
    add(y4m);
    bench.run_encoder(y4m_encoder, [](const Image8View& image) { return y4m_frame(image); });
    add(y4m_encoder);
}

}  // namespace

void run_sequence_bench(const BenchArguments& a) {
    check_video_size(a.size);
    const ScratchFolder folder;
    const std::string renderer = SequenceBench(a, a.scenes.front()).renderer_name();
    BenchOutput output(a, {{"benchmark", "sequence"},
                           {"commit", build_commit()},
                           {"renderer", renderer},
                           {"cores", usable_cores()},
                           {"image", {a.size.x, a.size.y}}});
    output.say(
        fmt::format("{}, {} cores, commit {}; {}x{} pixels, {} frames; seconds, of encoding and writing on all "
                    "threads together\n\n| scene | way | frames/s | in all | rendering | waiting for room | "
                    "encoding | writing |\n|---|---|---:|---:|---:|---:|---:|---:|\n",
                    renderer, usable_cores(), build_commit(), a.size.x, a.size.y, a.repeat));
    output.run(
        5 * a.scenes.size(),
        [&] {
            for (const std::string& scene : a.scenes) measure(a, scene, folder.path, output);
        },
        [](bool) {});
}

}  // namespace peelray
