// Pictures by the tracers that need no device. Without Embree (PEELRAY_REFERENCE=OFF) all of these throw Error.
#pragma once

#include "render/render_settings.h"
#include "workspace/workspace.h"

namespace peelray {

/// By the tracer of the settings, which must be one that is_on_cpu().
MadePicture cpu_picture(PosedScene& scene, const RenderSettings& settings, const PictureWatch& watch);

/// What makes the tracer's pictures, which do not depend on the machine.
std::string cpu_version(Tracer tracer);

}  // namespace peelray
