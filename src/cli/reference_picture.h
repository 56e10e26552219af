// --tracer reference: the CPU's picture and its stats. Not built without Embree (PEELRAY_REFERENCE=OFF).
#pragma once

#include <functional>

#include "cli/picture_maker.h"

namespace peelray {

MadePicture reference_picture(PreparedScene& scene, const PictureSettings& settings,
                              const std::function<void(double)>& progress);

/// Which reference this is: its pictures do not depend on the machine.
std::string reference_version();

}  // namespace peelray
