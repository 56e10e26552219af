#include "loaders/load.h"
#include "builtin/builtin.h"
#include "scene/scene.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/setting.h"
#include "base/text.h"
#include "loaders/files.h"
#include "loaders/gltf.h"
#include "loaders/obj.h"
#include "loaders/off.h"
#include "loaders/ply.h"
#include "loaders/stl.h"
#include "scene/sidedness.h"
#include "scene/tangents.h"

namespace peelray {

namespace {

Scene load_file(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string extension = lower_extension(path);
    if (extension == ".gltf" || extension == ".glb") return load_gltf(path, options);
    if (extension == ".obj") return load_obj(path);
    if (extension == ".ply") return load_ply(path);
    if (extension == ".stl") return load_stl(path);
    if (extension == ".off") return load_off(path);
    std::error_code unknown;
    if (std::filesystem::is_directory(path, unknown))
        fail("{}: not a regular file but a folder; name a scene in it", printable(path.string(), 1000));
    fail("{}: the extension \"{}\" is unknown; supported are .gltf, .glb, .obj, .ply, .stl, .off and builtin:NAME",
         printable(path.string(), 1000), printable(extension, 20));
}

bool has_triangles(const Scene& scene) {
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
        if (node.mesh < 0) return false;
        const std::vector<Primitive>& primitives = scene.meshes[static_cast<size_t>(node.mesh)].primitives;
        return std::any_of(primitives.begin(), primitives.end(),
                           [](const Primitive& p) { return !p.triangles.empty(); });
    });
}

}  // namespace

Scene load_scene(const std::string& name, const LoadOptions& options) {
    constexpr std::string_view prefix = "builtin:";
    const auto apply_options = [&](Scene& scene) {
        if (!options.variant.empty() && scene.variants.empty())
            fail("{}: the scene has no variants of its materials; leave out {}", scene.name, setting::variant);
        if (options.double_sided) show_both_sides(scene);
    };
    if (name.starts_with(prefix)) {
        Scene scene = make_builtin(std::string_view(name).substr(prefix.size()));
        apply_options(scene);
        return scene;
    }
    const std::filesystem::path path(name);
    try {
        Scene scene = load_file(path, options);
        apply_options(scene);
        complete_tangents(scene);
        if (!has_triangles(scene)) fail("{}: the scene has no triangles; give a file with a surface", scene.name);
        return scene;
    } catch (const std::bad_alloc&) {
        fail("{}: out of memory while reading the scene; use a smaller one", printable(name, 1000));
    }
}

}  // namespace peelray
