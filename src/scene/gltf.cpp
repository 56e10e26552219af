#include "scene/gltf.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace peelray {

namespace {

constexpr std::array<std::string_view, 8> supported_extensions = {
    "KHR_lights_punctual",   "KHR_materials_emissive_strength",
    "KHR_materials_ior",     "KHR_materials_transmission",
    "KHR_materials_unlit",   "KHR_materials_volume",
    "KHR_mesh_quantization", "KHR_texture_transform"};

bool is_supported(const std::string& name) {
    return std::find(supported_extensions.begin(), supported_extensions.end(), name) != supported_extensions.end();
}

}  // namespace

void GltfLoader::read_extensions() {
    for (const std::string& name : file.root().texts("extensionsRequired"))
        if (!is_supported(name))
            fail("{}: requires the extension {}, which is not supported; export the scene without it", file.name(),
                 printable(name, 60));
    scene.extensions_used = file.root().texts("extensionsUsed");
    for (std::string& name : scene.extensions_used) name = printable(name, 60);
    std::sort(scene.extensions_used.begin(), scene.extensions_used.end());
    for (const std::string& name : scene.extensions_used)
        if (!is_supported(name)) scene.extensions_unsupported.push_back(name);
}

void GltfLoader::read_animations() {
    for (const JsonView& json : file.root().objects("animations")) {
        Animation animation{json.text("name", ""), 0};
        for (const JsonView& sampler : json.objects("samplers")) {
            // The accessor's own maximum is required by the format and saves reading all key frames.
            const uint32_t input = sampler.required_index("input", file.accessor_count(), "accessors");
            const std::vector<double> maximum = file.accessor_json(input).numbers("max");
            if (maximum.size() == 1)
                animation.duration = std::max(animation.duration, static_cast<float>(maximum[0]));
            else
                for (const float time : file.floats(input)) animation.duration = std::max(animation.duration, time);
        }
        scene.animations.push_back(std::move(animation));
    }
}

void GltfLoader::write_notes() {
    for (const auto& [sentence, count] : ignored) scene.notes.push_back(fmt::format(fmt::runtime(sentence), count));
}

Scene load_gltf(const std::filesystem::path& path) {
    GltfLoader loader(path);
    loader.scene.name = loader.file.name();
    loader.meshes = loader.file.root().objects("meshes");
    loader.nodes = loader.file.root().objects("nodes");
    loader.textures = loader.file.root().objects("textures");
    loader.samplers = loader.file.root().objects("samplers");
    loader.read_extensions();
    loader.read_materials();
    loader.read_nodes();
    loader.read_animations();
    loader.write_notes();
    return std::move(loader.scene);
}

}  // namespace peelray
