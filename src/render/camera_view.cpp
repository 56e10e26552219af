#include "render/camera_view.h"

#include "view/view_params.h"

namespace peelray {

void CameraView::prepare(const GpuScene& scene, const RenderSettings& settings) {
    by_compute_ = settings.visibility == Visibility::compute ||
                  (settings.visibility == Visibility::automatic && ComputeView::preferable(device_, scene));
    target.resize(device_, settings.width, settings.height);
}

void CameraView::record(Commands& commands, const GpuScene& scene, const PathQueues& queues, uint32_t sample) {
    if (by_compute_)
        compute_.record(commands, scene, target, queues, sample_position(sample));
    else
        record_view(commands, device_, "visibility", scene, target, {}, VisibilityParams{sample_position(sample)});
}

}  // namespace peelray
