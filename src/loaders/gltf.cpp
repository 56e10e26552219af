#include "loaders/gltf.h"

#include <algorithm>

#include "base/text.h"
#include "loaders/gltf_check.h"

namespace peelray {

void GltfLoader::read_extensions() {
    for (const std::string& name : file.model().extensionsUsed) {
        scene.extensions_used.push_back(printable(name, 60));
        if (!is_supported_extension(name)) scene.extensions_unsupported.push_back(printable(name, 60));
    }
    std::sort(scene.extensions_used.begin(), scene.extensions_used.end());
    std::sort(scene.extensions_unsupported.begin(), scene.extensions_unsupported.end());
}

/// A file may offer its triangles in an extension's compression only, although it does not say that it requires that.
void GltfLoader::refuse_compressed() {
    if (compressed > 0 && triangles == 0)
        fail(
            "{}: its triangles are compressed with KHR_draco_mesh_compression only, which is not supported; export the "
            "scene without it",
            scene.name);
    if (compressed > 0) ignored["{} primitives dropped that KHR_draco_mesh_compression alone holds"] += compressed;
}

void GltfLoader::write_notes() {
    if (damaged_images.size() == 1)
        scene.notes.push_back(fmt::format("{} (the factor is used)", damaged_images.begin()->second));
    if (damaged_images.size() > 1)
        scene.notes.push_back(fmt::format("{} images are damaged, the factors are used: the first is {}",
                                          damaged_images.size(), damaged_images.begin()->second));
    for (const auto& [sentence, count] : file.faults()) ignored[sentence] += count;
    for (const auto& [sentence, count] : ignored) scene.notes.push_back(fmt::format(fmt::runtime(sentence), count));
}

Scene load_gltf(const std::filesystem::path& path) {
    GltfLoader loader(path);
    loader.scene.name = loader.file.name();
    loader.read_extensions();
    loader.read_materials();
    loader.read_nodes();
    loader.read_skins();
    loader.read_animations();
    loader.refuse_compressed();
    loader.write_notes();
    loader.scene.files = loader.file.files();
    return std::move(loader.scene);
}

}  // namespace peelray
