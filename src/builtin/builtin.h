// Scenes that need no file.
#pragma once

#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace peelray {

/// The built-in scenes' names with a line of description each ("blob:N" stands for any N).
struct BuiltinScene {
    std::string_view name, description;
};
std::vector<BuiltinScene> builtin_scenes();

/// Makes a built-in scene; `name` without "builtin:". Throws Error for an unknown name (listing the known ones) or an
/// impossible N.
Scene make_builtin(std::string_view name);

}  // namespace peelray
