// The files that pictures go into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "image/image.h"
#include "scene/picture.h"

namespace peelray {

/// How pictures become files.
struct PictureFiles {
    std::vector<Aov> aovs;    ///< auxiliary pictures that are written, too
    bool exr_layers = false;  ///< into the picture, an EXR, rather than beside it
    ExrFormat exr;
};
PictureFiles picture_files(const RenderArguments& arguments);

/// Throws Error unless the output's name says .png, .exr or .hdr or is that of the standard output, and is an .exr
/// where the other options need one.
void check_picture_name(const RenderArguments& arguments);
/// Throws Error unless it is a picture file's name and, where the picture is transparent, one with alpha.
void check_picture_name(const std::filesystem::path& path, bool transparent);

/// Does such a file hold Picture::radiance? Else it holds what Picture::encoded does.
bool shows_radiance(const std::filesystem::path& path);

/// What is written beside the picture NAME.png: NAME.KIND.exr, unless those are layers of the picture; of what rays
/// cost in any case NAME.KIND.png, a heat map.
std::vector<std::filesystem::path> paths_beside(const std::filesystem::path& output, const std::vector<Aov>& aovs,
                                                bool exr_layers);
std::filesystem::path heat_map_path(const std::filesystem::path& output, Aov aov);

/// Writes the picture and, beforehand, what is beside it: where a picture is, all of it is. Returns how many values
/// half floats do not reach (write_hdr).
size_t write_picture(const Picture& picture, const PictureFiles& files, const std::filesystem::path& path);

/// What to say of so many values; none: empty.
std::string beyond_note(size_t values);

}  // namespace peelray
