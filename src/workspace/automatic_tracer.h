// Which tracer a machine is best served by.
#pragma once

#include "settings/settings.h"

namespace peelray {

/// By the kind of the device alone, so that the same machine always gives the same pictures: `ldc` on a GPU; `cpu` on a
/// software device, which plays a GPU on the cores that could trace, and where there is no Vulkan. Throws Error where
/// the device that is asked for is not there.
Tracer automatic_tracer(const DeviceArguments& device);

}  // namespace peelray
