// The files that pictures go into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/picture.h"

namespace peelray {

/// Throws Error unless the name says .png, .exr or .hdr; where auxiliary pictures are to be layers of it, .exr; where
/// it is transparent, a format with alpha.
void check_picture_name(const std::filesystem::path& path, bool exr_layers, bool transparent);

/// What is written beside the picture NAME.png: NAME.KIND.exr, unless those are layers of the picture; of what rays
/// cost in any case NAME.KIND.png, a heat map.
std::vector<std::filesystem::path> paths_beside(const std::filesystem::path& output, const std::vector<Aov>& aovs,
                                                bool exr_layers);
std::filesystem::path heat_map_path(const std::filesystem::path& output, Aov aov);

/// The picture and, beforehand, what is beside it: where a picture is, all of it is. `exr_layers`: the auxiliary
/// pictures become layers of the picture, an EXR.
void write_picture(const Picture& picture, const std::vector<Aov>& aovs, bool exr_layers,
                   const std::filesystem::path& path);

}  // namespace peelray
