// What the settings change about a scene after it is loaded.
#pragma once

#include "scene/box.h"
#include "scene/scene.h"
#include "settings/settings.h"

namespace peelray {

/// Makes every surface of one material, for files without materials of their own. `box`: of the scene.
void override_materials(Scene& scene, MaterialOverride material, const Box& box);

/// Adds two triangles just below the box, the last of the scene. `catcher`: Material::catcher, and seen from above
/// alone. Returns the box with them.
Box add_floor(Scene& scene, const Box& box, bool catcher);

}  // namespace peelray
