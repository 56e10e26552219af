#include "cli/picture_maker.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "cli/messages.h"
#include "motion/animation.h"
#ifdef PEELRAY_WITH_REFERENCE
#include "cli/reference_picture.h"
#endif

namespace peelray {

#ifndef PEELRAY_WITH_REFERENCE
[[noreturn]] static void fail_reference() {
    fail("this program was built without the reference (PEELRAY_REFERENCE=OFF): use {} ldc", setting::tracer);
}
#endif

PictureMaker::PictureMaker(PreparedScene& scene, const PictureArguments& arguments)
    : scene_(scene), arguments_(arguments) {}

PictureMaker::~PictureMaker() = default;

Device& PictureMaker::device() {
    const DeviceArguments& a = arguments_.device;
    if (!device_) device_ = std::make_unique<Device>(DeviceOptions{a.device, a.validate});
    return *device_;
}

std::string PictureMaker::renderer_name(Tracer tracer) {
    if (tracer != Tracer::reference) return device().info().name;
#ifdef PEELRAY_WITH_REFERENCE
    return reference_version();
#else
    fail_reference();
#endif
}

void PictureMaker::check(Tracer tracer) {
    if (tracer == Tracer::khr) device().check_ray_tracing();
}

void PictureMaker::check_validation() const {
    if (device_) device_->check_validation();
}

MadePicture PictureMaker::make(Tracer tracer, RenderSettings settings, const Shot& shot,
                               const std::function<void(double)>& progress) {
    if (shot.time) move_to(scene_, arguments_, *shot.time);
    settings.camera = turned(scene_.camera, shot.turn);
    settings.bounds = scene_.bounds;
    std::optional<Progress> bar;
    if (!progress) bar.emplace(tracer == Tracer::reference ? "ray tracing" : "rendering", 1);
    const auto report = [&](double share) {
        check_interrupt();
        bar ? bar->update(share) : progress(share);
    };
    if (tracer == Tracer::reference) return make_reference(settings, report);
    if (tracer == Tracer::cubemap && settings.ambient && !std::exchange(noted_, true))
        print_note(fmt::format("{} cubemap has no ambient: the sky's diffuse light is unoccluded", setting::tracer));
    settings.tracer = tracer;
    return make_on_gpu(settings, report);
}

/// The renderer for pictures like this one. It stays from moment to moment; another tracer or hit test gets another,
/// since what one needed must not count as another's memory.
Renderer& PictureMaker::renderer_for(const RenderSettings& settings) {
    if (settings.tracer == Tracer::cubemap) scene_.simulate();
    const Kind kind{settings.tracer, settings.hit_auto, settings.cubes.hit};
    if (!renderer_ || !(kind == kind_)) {
        renderer_.reset();
        device().reset_peak();
        // Taken apart as it is in the beginning: where a picture's moment lies must not shape its cubes.
        const Assembly assembly = assemble(scene_.scene, moment_of(scene_.scene, scene_.animation, 0),
                                           motion_of(scene_.scene, scene_.animation));
        renderer_ = std::make_unique<Renderer>(*device_, scene_.scene, scene_.moment, assembly, scene_.environment);
        kind_ = kind;
        posed_ = scene_.time;
    }
    if (posed_ != scene_.time) renderer_->pose(scene_.moment);
    posed_ = scene_.time;
    return *renderer_;
}

MadePicture PictureMaker::make_on_gpu(const RenderSettings& settings, const std::function<void(double)>& progress) {
    RenderResult result = renderer_for(settings).render(settings, progress);
    device_->check_validation();
    MadePicture made;
    PictureStats& stats = made.stats;
    stats.machine = machine_of(*device_);
    stats.width = result.width;
    stats.height = result.height;
    stats.triangles = scene_.triangles;
    stats.box = scene_.bounds;
    stats.rays = result.rays;
    stats.render = std::move(result.stats);
    for (const RayCostField& field : kRayCostFields)
        stats.largest_of_a_pixel.*field.value = largest_of(result.aovs.costs, field);
    const std::string note = tolerance_note(stats.render.bodies, stats.render.choice);
    if (!note.empty() && !noted_tolerance_) print_note(note);
    noted_tolerance_ |= !note.empty();
    made.picture = std::move(result);
    return made;
}

MadePicture PictureMaker::make_reference(const RenderSettings& settings, const std::function<void(double)>& progress) {
#ifdef PEELRAY_WITH_REFERENCE
    return reference_picture(scene_, settings, progress);
#else
    (void)settings, (void)progress;
    fail_reference();
#endif
}

}  // namespace peelray
