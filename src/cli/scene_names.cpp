#include "cli/scene_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

bool ends_like_model(const fs::path& path) {
    // Those that are not read, too: the loader's line says what is.
    constexpr std::array<std::string_view, 11> extensions = {".gltf", ".glb", ".obj", ".ply",  ".stl",  ".off",
                                                             ".fbx",  ".dae", ".3ds", ".usdz", ".blend"};
    return std::find(extensions.begin(), extensions.end(), lower_extension(path)) != extensions.end();
}

}  // namespace

bool is_scene_name(const std::string& word) {
    std::error_code unknown;
    if (word.empty() || word.front() == '-') return false;
    return word.starts_with("builtin:") || ends_like_model(word) || fs::exists(word, unknown);
}

std::string scene_in(const std::string& word) {
    std::error_code error;
    if (!fs::is_directory(word, error)) return word;
    std::vector<fs::path> models;
    for (fs::directory_iterator entry(word, error); !error && entry != fs::directory_iterator(); entry.increment(error))
        if (ends_like_model(entry->path())) models.push_back(entry->path());
    return models.empty() ? (fs::path(word) / "MODEL.glb").string()
                          : std::min_element(models.begin(), models.end())->string();
}

}  // namespace peelray
