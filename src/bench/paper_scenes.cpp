#include "bench/paper_scenes.h"

#include <algorithm>

namespace peelray {

namespace fs = std::filesystem;

const PaperScene::Time* PaperScene::at(uint32_t ldc) const {
    const auto found = std::find_if(times.begin(), times.end(), [&](const Time& time) { return time.ldc == ldc; });
    return found == times.end() ? nullptr : &*found;
}

const std::vector<PaperScene>& paper_scenes() {
    // The stand-ins bring floors of their own, and their metal mirrors already.
    static const std::vector<PaperScene> scenes = {
        {"bunny",
         "Bunny",
         8192,
         8,
         {{{512, 7, 61}, {1024, 19, 115}}},
         "bunny_7k.off",
         MaterialOverride::mirror,
         "",
         "builtin:blob:6966",
         ""},
        {"car",
         "Car",
         20264,
         12,
         {{{512, 9, 82}, {1024, 25, 250}}},
         "car2.glb",
         std::nullopt,
         "",
         "builtin:blob:47002",
         ""},
        {"dragon",
         "Dragon",
         120'000,
         7,
         {{{512, 12, 205}, {1024, 31, 441}}},
         "chinesedragon.gltf",
         MaterialOverride::mirror,
         "",
         "builtin:blob:100960",
         ""},
        {"igea",
         "Max Planck (igea)",
         300'000,
         6,
         {{{512, 19, 160}, {1024, 53, 346}}},
         "igea.ply",
         MaterialOverride::mirror,
         "",
         "builtin:blob:268686",
         ""},
        {"tiny",
         "Tiny (animation)",
         1628,
         6,
         {{{512, 5, 44}, {1024, 16, 95}}},
         "tiny.glb",
         std::nullopt,
         "Walk",
         "builtin:walker",
         "walk"},
    };
    return scenes;
}

std::optional<fs::path> find_model(const fs::path& folder, const PaperScene& scene) {
    std::error_code error;
    for (const char* below : {"", "meshes", "skinned"}) {
        const fs::path path = folder / below / scene.file;
        if (fs::is_regular_file(path, error)) return path;
    }
    return std::nullopt;
}

}  // namespace peelray
