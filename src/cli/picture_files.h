// The files that pictures go into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/picture.h"

namespace peelray {

/// Throws Error unless the name says .png, .exr or .hdr.
void check_picture_name(const std::filesystem::path& path);

/// NAME.KIND.exr beside NAME.png; of what rays cost NAME.KIND.png as well, its heat map.
std::vector<std::filesystem::path> aov_paths(const std::filesystem::path& output, Aov aov);
std::filesystem::path heat_map_path(const std::filesystem::path& output, Aov aov);

/// The picture and, beforehand, the auxiliary ones: where a picture is, all of it is.
void write_picture(const Picture& picture, const std::vector<Aov>& aovs, const std::filesystem::path& path);

}  // namespace peelray
