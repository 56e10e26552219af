#include "bench/auto_check.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "bench/timing.h"
#include "workspace/render_settings.h"

namespace peelray {

/// Frames before those that are measured, beside the renderer's own first one.
static constexpr uint32_t kWarmUpOfChoice = 3;

AutoCheck::AutoCheck(const BenchSettings& settings, Notes notes)
    : settings_(settings), notes_(std::move(notes)), device_(device_options(settings.device)) {
    check_timestamps(device_);
}

void AutoCheck::time(const PictureArguments& arguments, const PosedScene& scene, Renderer& renderer,
                     AutoRow::Choice& choice) {
    PictureArguments picture = arguments;
    picture.tracing.hit = choice.hit;
    picture.tracing.ldc = choice.ldc;
    RenderSettings settings = render_settings(picture);
    settings.camera = scene.camera();
    settings.bounds = scene.bounds();
    settings.repeat = settings_.repeat + kWarmUpOfChoice + 1;
    settings.time_passes = false;
    probe_.warm_up();
    const RenderResult result = renderer.render(settings, [](double) { check_interrupt(); });
    std::vector<double> ms;
    for (const RenderStats::FrameTime& time : result.stats.frames) ms.push_back(time.frame_ms);
    ms.erase(ms.begin(), ms.end() - settings_.repeat);
    choice.ms = timing_of(ms).median;
    choice.chosen = result.stats.hit;
}

void AutoCheck::measure(const PosedScene& scene, const PictureArguments& picture, Renderer& renderer, AutoRow& row) {
    time(picture, scene, renderer, row.automatic);
    for (const HitTest hit : settings_.hits)
        for (const auto& ldc : settings_.ldc) {
            if (!ldc) continue;
            AutoRow::Choice choice{hit, ldc};
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

void AutoCheck::measure(const std::string& name, const Add& add) {
    const BenchSceneChoice choice = choose_bench_scene(name, settings_);
    AutoRow row{choice.name, choice.shown, "", choice.stands_in};
    try {
        PosedScene scene(choice.picture, notes_);
        row.triangles = scene.triangles();
        Renderer renderer(device_, scene.scene(), scene.moment(), scene.assembly_of_moment(), scene.environment());
        for (const bool rebuilt : {true, false}) {
            AutoRow each = row;
            each.rebuilt = rebuilt;
            PictureArguments picture = choice.picture;
            picture.rebuild = rebuilt;
            measure(scene, picture, renderer, each);
            add(each);
        }
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        row.left_out = error.text();
        add(row);
    }
    device_.check_validation();
}

void AutoCheck::run(const Add& add, const RowProgress& progress) {
    size_t done = 0;
    const auto counted = [&](const AutoRow& row) {
        add(row);
        progress(double(++done));
    };
    for (const std::string& scene : settings_.scenes) measure(scene, counted);
}

}  // namespace peelray
