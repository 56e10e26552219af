// The CPU reference's pictures. Without Embree (PEELRAY_REFERENCE=OFF) all of these throw Error.
#pragma once

#include "workspace/workspace.h"

namespace peelray {

MadePicture reference_picture(PosedScene& scene, const PictureSettings& settings, const PictureWatch& watch);

/// Which reference this is: its pictures do not depend on the machine.
std::string reference_version();

}  // namespace peelray
