#include "cli/render_plan.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/picture_files.h"
#include "cli/video.h"
#include "settings/aovs.h"
#include "workspace/automatic_tracer.h"

namespace peelray {

static bool wants_costs(const RenderArguments& a) {
    return std::any_of(a.aovs.begin(), a.aovs.end(), [](Aov aov) { return cost_field(aov); });
}

RenderArguments with_tracer(RenderArguments a) {
    if (!a.tracing.tracer)
        a.tracing.tracer = a.asks_for_cubes || wants_costs(a) ? Tracer::ldc : automatic_tracer(a.device);
    return a;
}

RenderSettings render_settings(const RenderArguments& a) {
    RenderSettings settings = render_settings(static_cast<const PictureArguments&>(a));
    settings.counters = a.counters || wants_costs(a);
    const auto any_from = [&](AovSource source) {
        return std::any_of(a.aovs.begin(), a.aovs.end(), [&](Aov aov) { return is_from(source, aov); });
    };
    settings.ray_setup = any_from(AovSource::ray_setup);
    settings.aovs = settings.ray_setup || any_from(AovSource::surface);
    settings.time_limit = a.time_limit;
    settings.noise_target = a.noise_target;
    settings.moments = any_from(AovSource::samples) || a.noise_target;
    settings.motion = wants(a, Aov::motion);
    const bool preview = !a.preview.empty(), bright_preview = preview && shows_radiance(a.preview);
    const bool bright = !is_video(a.output) && shows_radiance(a.output);
    settings.radiance = bright || bright_preview;
    settings.encoded = !bright || (preview && !bright_preview);
    return settings;
}

bool wants(const RenderArguments& a, Aov aov) {
    return std::find(a.aovs.begin(), a.aovs.end(), aov) != a.aovs.end();
}

MadePicture render_with_bar(Workspace& workspace, const RenderSettings& settings, const Shot& shot,
                            PictureWatch watch) {
    Progress bar(is_on_cpu(settings.tracer) ? "ray tracing" : "rendering", 1);
    watch.progress = [&](double share) { bar.update(share); };
    return workspace.render(settings, shot, watch);
}

void check_ends(const RenderArguments& a) {
    const char* ending = a.time_limit ? "--time-limit" : a.noise_target ? "--noise-target" : nullptr;
    if (a.denoise == Denoise::temporal && ending)
        fail(
            "{} lets pictures end with fewer samples, and --denoise temporal takes the mean of several that are alike: "
            "leave one of them out",
            ending);
    if (a.noise_target && a.spp < kLeastSamplesForNoise)
        fail(
            "of {} noise cannot be told, so --noise-target would end nothing: let --spp, the most there may be, be {} "
            "or more",
            counted("{} sample{|s}", a.spp), kLeastSamplesForNoise);
}

void check_counters(const RenderArguments& a) {
    const char* option = a.counters ? "--counters" : wants_costs(a) ? "--aov cost_..." : nullptr;
    if (option && a.tracing.tracer != Tracer::ldc)
        fail("{} counts what rays cost in the cubes of --tracer ldc: --tracer {} has none; leave one of them out",
             option, name_of(*a.tracing.tracer));
    if (a.counters && a.stats.empty()) fail("what --counters counts goes into the stats: name a file (--stats)");
}

}  // namespace peelray
