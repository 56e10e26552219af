// Settings as the renderer takes them.
#pragma once

#include "render/renderer.h"
#include "settings/settings.h"

namespace peelray {

DeviceOptions device_options(const DeviceArguments& arguments);

/// All but the camera and its bounds, which are the scene's.
RenderSettings render_settings(const PictureArguments& arguments);

/// Parts of it: a builder, a traversal and what belongs to them; a hit test, none: chosen by the number of triangles.
void choose_tracing(RenderSettings& settings, const TracingArguments& tracing);
void choose_hit(RenderSettings& settings, std::optional<HitTest> hit);

}  // namespace peelray
