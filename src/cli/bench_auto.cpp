// `peelray bench --auto-check`: what `auto` chooses against the best fixed choice.
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "bench/clock_probe.h"
#include "cli/bench.h"
#include "cli/bench_scenes.h"
#include "cli/messages.h"
#include "cli/paper_table.h"
#include "cli/stats_json.h"
#include "cli/version.h"
#include "workspace/posed_scene.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kWarmUpOfChoice = 3;  ///< frames, beside the renderer's own first one

/// A frame's time with one choice.
struct Choice {
    std::optional<HitTest> hit;  ///< none: auto
    std::optional<uint32_t> ldc;
    double ms = 0;
    HitTest chosen = HitTest::exact;  ///< the hit test that it came to

    std::string text() const {
        return ldc ? fmt::format("{} {}", name_of(hit), *ldc) : fmt::format("auto ({})", name_of(chosen));
    }
};

/// One scene, everything rebuilt or kept: the automatic choice and the best fixed ones.
struct AutoRow {
    std::string scene, shown, left_out;
    bool stands_in = false, rebuilt = false;
    uint64_t triangles = 0;
    Choice automatic, best, best_same;  ///< best_same: among those with the hit test that `auto` chose
    std::vector<Choice> fixed;

    double ratio() const { return best.ms > 0 ? automatic.ms / best.ms : 0; }
    double ratio_same() const { return best_same.ms > 0 ? automatic.ms / best_same.ms : 0; }
};

class AutoCheck {
  public:
    explicit AutoCheck(const BenchArguments& a) : a_(a), device_(DeviceOptions{a.device.device, a.device.validate}) {
        check_timestamps(device_);
    }

    void run();

  private:
    void measure(const std::string& name, Progress& bar);
    void measure(const PosedScene& scene, const PictureArguments& picture, Renderer& renderer, AutoRow& row);
    void time(const PictureArguments& picture, const PosedScene& scene, Renderer& renderer, Choice& choice);
    void add(const AutoRow& row, Progress& bar);
    void say(const std::string& text);
    void write(bool complete) const;

    const BenchArguments& a_;
    Device device_;
    ClockProbe probe_{device_};
    Json rows_ = Json::array();
    std::string text_, reason_;
    size_t measured_ = 0;
    double worst_ = 0, worst_same_ = 0;
};

void AutoCheck::say(const std::string& text) {
    text_ += text;
    fmt::print("{}", text);
    std::fflush(stdout);
}

void AutoCheck::write(bool complete) const {
    if (!a_.output.empty()) {
        Json json = {{"benchmark", "auto"}};
        json.update(machine_json(machine_of(device_)));
        json["image"] = {a_.size.x, a_.size.y};
        json["repeat"] = a_.repeat;
        json["complete"] = complete;
        json["rows"] = rows_;
        write_json(a_.output, json);
    }
    if (!a_.markdown.empty()) write_text(a_.markdown, text_);
}

void AutoCheck::time(const PictureArguments& arguments, const PosedScene& scene, Renderer& renderer, Choice& choice) {
    PictureArguments picture = arguments;
    picture.tracing.hit = choice.hit;
    picture.tracing.ldc = choice.ldc;
    RenderSettings settings = render_settings(picture);
    settings.camera = scene.camera();
    settings.bounds = scene.bounds();
    settings.repeat = a_.repeat + kWarmUpOfChoice + 1;
    settings.time_passes = false;
    probe_.warm_up();
    const RenderResult result = renderer.render(settings, [](double) { check_interrupt(); });
    std::vector<double> ms;
    for (const RenderStats::FrameTime& time : result.stats.frames) ms.push_back(time.frame_ms);
    ms.erase(ms.begin(), ms.end() - a_.repeat);
    choice.ms = spread_of(ms).median;
    choice.chosen = result.stats.hit;
}

void AutoCheck::measure(const PosedScene& scene, const PictureArguments& picture, Renderer& renderer, AutoRow& row) {
    time(picture, scene, renderer, row.automatic);
    for (const HitTest hit : a_.hits)
        for (const auto& ldc : a_.ldc) {
            if (!ldc) continue;
            Choice choice{hit, ldc};
            try {
                time(picture, scene, renderer, choice);
            } catch (const Interrupted&) {
                throw;
            } catch (const Error&) {
                continue;  // a resolution that does not fit is no choice
            }
            row.fixed.push_back(choice);
            if (row.best.ms == 0 || choice.ms < row.best.ms) row.best = choice;
            if (hit == row.automatic.chosen && (row.best_same.ms == 0 || choice.ms < row.best_same.ms))
                row.best_same = choice;
        }
}

void AutoCheck::add(const AutoRow& row, Progress& bar) {
    const bool measured = row.left_out.empty();
    Json fixed = Json::array();
    for (const Choice& choice : row.fixed)
        fixed.push_back({{"hit", name_of(choice.hit)}, {"n", *choice.ldc}, {"frame_ms", choice.ms}});
    rows_.push_back({{"scene", row.scene},
                     {"shown", row.shown},
                     {"stands_in", row.stands_in},
                     {"triangles", row.triangles},
                     {"cubes", row.rebuilt ? "rebuilt" : "kept"},
                     {"left_out", measured ? Json(nullptr) : Json(row.left_out)},
                     {"auto_hit", measured ? name_of(row.automatic.chosen) : ""},
                     {"auto_ms", row.automatic.ms},
                     {"ratio_to_best", row.ratio()},
                     {"ratio_to_best_of_its_hit_test", row.ratio_same()},
                     {"fixed", fixed}});
    if (measured) {
        measured_++;
        worst_ = std::max(worst_, row.ratio());
        worst_same_ = std::max(worst_same_, row.ratio_same());
        say(fmt::format("| {} | {} | {} | {} | {:.3f} | {} | {:.3f} | {:.2f} | {} | {:.2f} |\n", row.scene,
                        row.triangles, row.rebuilt ? "rebuilt" : "kept", row.automatic.text(), row.automatic.ms,
                        row.best.text(), row.best.ms, row.ratio(), row.best_same.text(), row.ratio_same()));
    } else {
        if (reason_.empty()) reason_ = row.left_out;
        say(fmt::format("| {} | – | – | left out: {} | – | – | – | – | – | – |\n", row.scene, one_line(row.left_out)));
    }
    write(false);
    bar.update(double(rows_.size()));
}

void AutoCheck::measure(const std::string& name, Progress& bar) {
    const BenchSceneChoice choice = choose_bench_scene(name, a_);
    AutoRow row{choice.name, choice.shown, "", choice.stands_in};
    try {
        PosedScene scene(choice.picture, print_note);
        row.triangles = scene.triangles();
        Renderer renderer(device_, scene.scene(), scene.moment(), scene.assembly_of_moment(), scene.environment());
        for (const bool rebuilt : {true, false}) {
            AutoRow each = row;
            each.rebuilt = rebuilt;
            PictureArguments picture = choice.picture;
            picture.rebuild = rebuilt;
            measure(scene, picture, renderer, each);
            add(each, bar);
        }
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        row.left_out = message_of(error);
        add(row, bar);
    }
    device_.check_validation();
}

void AutoCheck::run() {
    const Machine device = machine_of(device_);
    say(
        fmt::format("{}, driver {}, commit {}; {}x{} pixels, {} frames each; milliseconds of a frame, medians\n\n"
                    "| scene | triangles | cubes | auto | frame | best of all | frame | auto by best | best of its hit "
                    "test | auto by that |\n|---|---:|---|---|---:|---|---:|---:|---|---:|\n",
                    device.name, device.driver, build_commit(), a_.size.x, a_.size.y, a_.repeat));
    Progress bar("measuring", double(2 * a_.scenes.size()), "rows");
    try {
        for (const std::string& scene : a_.scenes) measure(scene, bar);
    } catch (const Interrupted&) {
        write(false);
        fail("interrupted after {} rows{}", rows_.size(),
             a_.output.empty() ? "" : fmt::format(", which {} holds", a_.output.string()));
    }
    if (measured_ > 0)
        say(
            fmt::format("\nAt worst auto takes {:.2f} times as long as the best fixed choice, {:.2f} times as long as "
                        "the best of its own hit test.\n",
                        worst_, worst_same_));
    write(true);
    if (measured_ == 0) fail("none of the {} rows could be measured: {}", rows_.size(), reason_);
}

}  // namespace

void run_auto_check(const BenchArguments& a) {
    AutoCheck(a).run();
}

}  // namespace peelray
