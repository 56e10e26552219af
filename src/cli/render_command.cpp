// `peelray render`.
#include <chrono>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/picture_files.h"
#include "cli/preview.h"
#include "cli/render_plan.h"
#include "cli/sequence.h"
#include "cli/standard_output.h"
#include "cli/stats_json.h"
#include "image/image.h"
#include "settings/aovs.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

/// Who answered for the rays, and times.
std::string summary_of(const PictureStats& stats) {
    const RenderStats& s = stats.render;
    std::string text = s.tracer == Tracer::none ? "" : fmt::format(" by {}", name_of(s.tracer));
    if (stats.by_cpu())
        return text + fmt::format("; BVH {:.2f} s, rays {:.2f} s", s.build_ms * 1e-3, s.frame_ms * 1e-3);
    if (stats.has_cubes()) text += fmt::format(", {} ({})", count_of_cubes(s.cubes), name_of(s.hit));
    if (s.tracer == Tracer::cubemap)
        text += fmt::format(", {} of {}² texels a face, {}", counted("{} cube map{|s}", s.maps.probes), s.maps.face,
                            counted("{} shadow map{|s}", s.maps.shadows.maps));
    if (s.tracer == Tracer::khr) text += ", " + counted("{} acceleration structure{|s}", s.structures.bodies);
    if (s.timed)
        text += fmt::format("; GPU {:.2f} ms ({} {:.2f} ms)", s.frame_ms,
                            s.tracer == Tracer::cubemap ? "maps"
                            : s.tracer == Tracer::khr   ? "structures"
                                                        : "cube",
                            s.tracer == Tracer::cubemap ? s.maps_ms : s.build_ms);
    return text;
}

/// How many, where it ended early.
std::string samples_of(const RenderArguments& a, const SamplesMade& samples) {
    if (samples.end == PictureEnd::samples) return {};
    std::string text = fmt::format("{} of {} samples ({}", samples.count, a.spp, name_of(samples.end));
    if (samples.noise && a.noise_target) text += fmt::format(", noise {:.3g}", *samples.noise);
    return text + "), ";
}

/// What a reader of the terminal wants to know, once.
void report(const RenderArguments& a, const MadePicture& made, size_t triangles, double seconds) {
    const Picture& picture = made.picture;
    const uint64_t rays = picture.rays.primary + picture.rays.secondary();
    print_result(a.output, fmt::format("{}x{}, {}{}, {}{}; {:.2f} s in all on {}", picture.width, picture.height,
                                       samples_of(a, picture.samples), counted("{} triangle{|s}", triangles),
                                       rays < 100'000 ? counted("{} ray{|s}", rays)
                                                      : fmt::format("{:.1f} M rays", double(rays) * 1e-6),
                                       summary_of(made.stats), seconds, made.stats.machine.name));
}

std::string png_of(const Picture& picture) {
    return encode_png("the standard output", {picture.width, picture.height, picture.encoded}, picture.transparent);
}

}  // namespace

void run_render(const RenderArguments& given) {
    const auto start = std::chrono::steady_clock::now();
    check(given);
    const RenderArguments a = with_tracer(given);
    if (a.is_sequence()) return run_sequence(a);
    check_single(a);
    check_counters(a);
    check_ends(a);
    check_picture_name(a);
    if (!a.preview.empty()) check_picture_name(a.preview, a.is_transparent());
    if (is_on_cpu(*a.tracing.tracer) && a.repeat > 1)
        fail("--repeat measures GPU frames; with --tracer {} leave it out", name_of(*a.tracing.tracer));
    const RenderSettings settings = render_settings(a);
    std::vector<fs::path> outputs;
    std::optional<StandardOutput> standard_output;
    if (is_standard_output(a.output))
        standard_output.emplace();
    else
        outputs.push_back(a.output);
    for (const fs::path& path : paths_beside(a.output, a.aovs, a.exr_layers)) outputs.push_back(path);
    for (const fs::path& path : {a.stats, a.preview})
        if (!path.empty()) outputs.push_back(path);
    check_outputs(outputs, {a.scene, a.env});

    Workspace workspace(a, print_note);
    watch_interrupts();
    Shot shot;
    shot.fps = a.sequence.fps.value_or(kUsualFps);
    Preview preview(a.preview);
    PictureWatch watch;
    if (preview) watch.pass_ended = [&](const std::function<Picture()>& look) { preview.update(look); };
    if (a.keep_partial) watch.stop = was_interrupted;
    const MadePicture made = render_with_bar(workspace, settings, shot, watch);
    if (standard_output)
        standard_output->write(png_of(made.picture));
    else
        print_if_any(beyond_note(write_picture(made.picture, picture_files(a), a.output)));
    for (const Aov aov : a.aovs)
        if (const RayCostField* field = cost_field(aov))
            print_note(fmt::format("{}: from 0, black, to {}, light yellow", heat_map_path(a.output, aov).string(),
                                   largest_of(made.picture.aovs.costs, *field)));
    preview.finish(made.picture);
    if (!a.stats.empty()) write_json(a.stats, picture_json(made.stats));
    const SamplesMade& samples = made.picture.samples;
    if (samples.end == PictureEnd::interrupt)
        throw Interrupted(fmt::format("interrupted after {} of {}: {} shows the mean of those", samples.count,
                                      counted("{} sample{|s}", a.spp), a.output.string()));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report(a, made, workspace.scene().triangles(), seconds);
}

}  // namespace peelray
