#include "cli/picture_maker.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "cli/stats.h"
#ifdef PEELRAY_WITH_REFERENCE
#include "cli/reference_picture.h"
#endif

namespace peelray {

PictureMaker::PictureMaker(const PreparedScene& scene, const DeviceArguments& device)
    : scene_(scene), arguments_(device) {}

PictureMaker::~PictureMaker() = default;

MadePicture PictureMaker::make(const std::string& tracer, RenderSettings settings) {
    settings.camera = scene_.camera;
    if (tracer == "reference") return make_reference(settings);
    if (tracer == "cubemap" && settings.ambient)
        print_note("--tracer cubemap has no ambient: the sky's diffuse light is unoccluded");
    settings.tracer = tracer == "cubemap" ? Tracer::cubemap : tracer == "none" ? Tracer::none : Tracer::ldc;
    return make_on_gpu(settings);
}

MadePicture PictureMaker::make_on_gpu(const RenderSettings& settings) {
    if (!device_) device_ = std::make_unique<Device>(DeviceOptions{arguments_.device, arguments_.validate});
    // Each picture has a renderer of its own: what one needed must not count as another's memory.
    device_->reset_peak();
    const Assembly assembly = assemble(scene_.scene, motion_of(scene_.scene, ""));
    Renderer renderer(*device_, scene_.scene, assembly, {scene_.geometry.lower, scene_.geometry.upper},
                      scene_.environment);
    Progress progress("rendering", 1);
    RenderResult result = renderer.render(settings, [&](double share) {
        check_interrupt();
        progress.update(share);
    });
    device_->check_validation();
    MadePicture made;
    const RenderStats& s = result.stats;
    made.stats = render_stats(*device_, result, scene_.geometry.triangles.size(),
                              {scene_.geometry.lower, scene_.geometry.upper});
    made.device = device_->info().name;
    if (s.cubes.bodies)
        made.summary = fmt::format(", {} cube{} of up to {} ({})", s.cubes.bodies, s.cubes.bodies == 1 ? "" : "s",
                                   s.cubes.resolution, s.hit == HitTest::exact ? "exact" : "planar");
    if (s.tracer == Tracer::cubemap)
        made.summary = fmt::format(", {} cube maps of {}² texels a face, {} shadow maps", s.maps.probes, s.maps.face,
                                   s.maps.shadows.maps);
    if (s.timed)
        made.summary += s.tracer == Tracer::cubemap
                            ? fmt::format("; GPU {:.2f} ms (maps {:.2f} ms)", s.frame_ms, s.maps_ms)
                            : fmt::format("; GPU {:.2f} ms (cube {:.2f} ms)", s.frame_ms, s.build_ms);
    made.picture = std::move(result);
    return made;
}

MadePicture PictureMaker::make_reference(const RenderSettings& settings) {
#ifdef PEELRAY_WITH_REFERENCE
    Progress progress("ray tracing", 1);
    return reference_picture(scene_, settings, [&](double share) {
        check_interrupt();
        progress.update(share);
    });
#else
    (void)settings;
    fail("this program was built without the reference (PEELRAY_REFERENCE=OFF): use --tracer ldc");
#endif
}

}  // namespace peelray
