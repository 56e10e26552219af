// Pictures by the tracers that need no device. Without Embree (PEELRAY_REFERENCE=OFF) all of these throw Error.
#pragma once

#include "render/render_settings.h"
#include "workspace/workspace.h"

namespace peelray {

/// What is kept of pictures for later ones (Denoise::temporal).
std::unique_ptr<CpuPast> make_cpu_past();

/// By the tracer of the settings, which must be one that is_on_cpu(). `past`: null unless is_temporal(settings).
MadePicture cpu_picture(PosedScene& scene, const RenderSettings& settings, const PictureWatch& watch, CpuPast* past);

/// As Renderer::warm_up(); returns milliseconds.
double cpu_warm_up(PosedScene& scene, const RenderSettings& settings, const PictureWatch& watch, CpuPast& past);

/// What makes the tracer's pictures, which do not depend on the machine.
std::string cpu_version(Tracer tracer);

}  // namespace peelray
