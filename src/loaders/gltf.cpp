#include "loaders/gltf.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/setting.h"
#include "base/text.h"
#include "loaders/gltf_check.h"
#include "loaders/gltf_image_light.h"

namespace peelray {

void GltfLoader::read_extensions() {
    for (const std::string& name : file.model().extensionsUsed) {
        scene.extensions_used.push_back(printable(name, 60));
        if (!is_supported_extension(name)) scene.extensions_unsupported.push_back(printable(name, 60));
    }
    std::sort(scene.extensions_used.begin(), scene.extensions_used.end());
    std::sort(scene.extensions_unsupported.begin(), scene.extensions_unsupported.end());
}

void GltfLoader::choose_variant(const std::string& name) {
    const std::vector<std::string>& all = file.extensions().variants;
    for (const std::string& variant : all) scene.variants.push_back(printable(variant, 60));
    if (name.empty() || all.empty()) return;
    const auto found = std::find(all.begin(), all.end(), name);
    if (found == all.end())
        fail("{}: the scene has no variant \"{}\"; choose another {}: {}", scene.name, printable(name, 60),
             setting::variant, fmt::join(scene.variants, ", "));
    variant = size_t(found - all.begin());
}

void GltfLoader::write_notes() {
    if (damaged_images.size() == 1)
        scene.notes.push_back(fmt::format("{} (the factor is used)", damaged_images.begin()->second));
    if (damaged_images.size() > 1)
        scene.notes.push_back(fmt::format("{} images are damaged, the factors are used: the first is {}",
                                          damaged_images.size(), damaged_images.begin()->second));
    add_notes(ignored, scene.notes);
}

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
    GltfLoader loader(path);
    loader.scene.name = loader.file.name();
    loader.read_extensions();
    loader.choose_variant(options.variant);
    loader.point_size = options.point_size;
    loader.read_materials();
    loader.read_nodes();
    if (const auto& light = loader.file.extensions().image_light)
        loader.scene.cube_light = read_image_light(loader.file, *light);
    loader.read_skins();
    loader.read_animations();
    settle_origin(loader.scene, loader.exact_nodes);
    loader.write_notes();
    loader.scene.files = loader.file.files();
    return std::move(loader.scene);
}

}  // namespace peelray
