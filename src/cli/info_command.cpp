// `peelray info` and `peelray devices`.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "gpu/device.h"
#include "loaders/files.h"
#include "loaders/load.h"
#include "scene/origin.h"
#include "scene/scene.h"
#include "scene/sidedness.h"
#include "workspace/camera_choice.h"

namespace peelray {
namespace {

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "none" : text;
}

std::string named(const std::string& name) {
    return name.empty() ? "(no name)" : printable(name);
}

/// What lies on the surface or changes how it reflects and lets light through, by extensions of the format.
std::string describe_extras(const Material& m) {
    std::string text;
    if (m.specular != 1 || m.specular_color != glm::vec3(1))
        text += fmt::format(", specular {:.3g} times {:.3g} {:.3g} {:.3g}", m.specular, m.specular_color.x,
                            m.specular_color.y, m.specular_color.z);
    if (m.clearcoat > 0) text += fmt::format(", clear coat {:.3g} of roughness {:.3g}", m.clearcoat, m.coat_roughness);
    if (m.sheen_color != glm::vec3(0))
        text += fmt::format(", sheen {:.3g} {:.3g} {:.3g} of roughness {:.3g}", m.sheen_color.x, m.sheen_color.y,
                            m.sheen_color.z, m.sheen_roughness);
    if (m.iridescence > 0) {
        text += fmt::format(", iridescence {:.3g} by a film of index {:.3g}, ", m.iridescence, m.film_ior);
        if (m.film_thickness_texture) text += fmt::format("{:.4g} to ", m.film_least);
        text += fmt::format("{:.4g} nm", m.film_most);
    }
    if (m.anisotropy > 0) text += fmt::format(", anisotropy {:.3g}", m.anisotropy);
    if (m.anisotropy > 0 && m.anisotropy_rotation != 0)
        text += fmt::format(" turned by {:.3g} degrees", m.anisotropy_rotation * 57.29578f);
    if (m.dispersion > 0) text += fmt::format(", dispersion {:.3g}", m.dispersion);
    if (m.diffuse_transmission > 0)
        text +=
            fmt::format(", diffuse transmission {:.3g} of colour {:.3g} {:.3g} {:.3g}", m.diffuse_transmission,
                        m.diffuse_transmission_color.x, m.diffuse_transmission_color.y, m.diffuse_transmission_color.z);
    return text;
}

std::string describe(const Material& m) {
    std::string text = fmt::format("colour {:.3g} {:.3g} {:.3g}, metallic {:.3g}, roughness {:.3g}", m.base_color.x,
                                   m.base_color.y, m.base_color.z, m.metallic, m.roughness);
    constexpr std::array uses = {"",
                                 "emission ",
                                 "metal ",
                                 "roughness ",
                                 "transmission ",
                                 "thickness ",
                                 "normal ",
                                 "occlusion ",
                                 "specular ",
                                 "specular colour ",
                                 "coat ",
                                 "coat roughness ",
                                 "coat normal ",
                                 "sheen colour ",
                                 "sheen roughness ",
                                 "iridescence ",
                                 "film thickness ",
                                 "anisotropy ",
                                 "diffuse transmission ",
                                 "diffuse transmission colour "};
    static_assert(uses.size() == material_textures.size());
    for (size_t i = 0; i < material_textures.size(); i++)
        if (const MaterialTexture& used = m.*material_textures[i])
            text += fmt::format(", {}texture {}", uses[i], used.texture);
    if (m.blended) text += fmt::format(", blended by its alpha of {:.3g}", m.alpha);
    if (m.alpha_cutoff > 0 && !m.blended) text += fmt::format(", holes where alpha is below {:.3g}", m.alpha_cutoff);
    if (m.emissive != glm::vec3(0))
        text += fmt::format(", emits {:.3g} {:.3g} {:.3g}", m.emissive.x, m.emissive.y, m.emissive.z);
    if (m.transmission > 0)
        text += fmt::format(", transmission {:.3g}, index of refraction {:.3g}, {}", m.transmission, m.ior,
                            m.thickness > 0 ? "volume" : "thin wall");
    text += describe_extras(m);
    if (m.unlit) text += ", unlit";
    if (is_single_sided(m)) text += ", front only";
    return text;
}

/// A point of the scene in the world. Far from its origin, to the millionth part of what the scene measures; near it,
/// with so many digits.
std::string in_world(const glm::dvec3& p, const Scene& scene, const Geometry& geometry, int digits) {
    const double extent = reach_of(geometry.upper - geometry.lower);
    if (scene.origin == glm::dvec3(0) || !(extent > 0))
        return fmt::format("{:.{}g} {:.{}g} {:.{}g}", p.x, digits, p.y, digits, p.z, digits);
    const double step = std::pow(10, std::floor(std::log10(extent)) - 6);
    const glm::dvec3 at = glm::round((scene.origin + p) / step) * step;
    return fmt::format("{:.15g} {:.15g} {:.15g}", at.x, at.y, at.z);
}

std::string lens_of(const Camera& camera) {
    return camera.orthographic_height > 0
               ? fmt::format("orthographic, height {:.4g}", camera.orthographic_height)
               : fmt::format("vertical field of view {:.1f} degrees", camera.vertical_fov * 57.29578f);
}

/// What --camera chooses from, with its numbers.
void print_cameras(const Scene& scene, const Geometry& geometry) {
    fmt::print("cameras     {}\n", scene.cameras.size());
    for (size_t i = 0; i < scene.cameras.size(); i++) {
        const Camera& camera = scene.cameras[i];
        const bool own = camera.node.empty() || camera.node == camera.name;
        fmt::print("  {} {}{}: eye {}, {}\n", camera_label(scene.cameras, i), named(camera.name),
                   own ? "" : fmt::format(" (node {})", named(camera.node)), in_world(camera.eye, scene, geometry, 4),
                   lens_of(camera));
    }
    for (const Camera& camera : scene.unplaced_cameras)
        fmt::print("  {} {}: on no node, without a place; {}\n", camera.number, named(camera.name), lens_of(camera));
}

const char* kind_of(const Light& light) {
    const char* kinds[] = {"directional", "point", "spot"};
    return kinds[int(light.kind)];
}

}  // namespace

void run_info(const std::string& name) {
    const Scene scene = load_scene(name);
    const Geometry geometry = flatten(scene);
    size_t primitives = 0;
    for (const Mesh& mesh : scene.meshes) primitives += mesh.primitives.size();
    fmt::print("scene       {}\n", scene.name);
    fmt::print("triangles   {} ({} without area)\n", geometry.triangles.size(), geometry.zero_area);
    fmt::print("vertices    {}\n", geometry.positions.size());
    fmt::print("bounds      {}  to  {}\n", in_world(geometry.lower, scene, geometry, 6),
               in_world(geometry.upper, scene, geometry, 6));
    fmt::print("nodes       {}\n", scene.nodes.size());
    fmt::print("meshes      {} ({})\n", scene.meshes.size(), counted("{} primitive{|s}", primitives));
    for (const Mesh& mesh : scene.meshes) {
        size_t count = 0;
        for (const Primitive& primitive : mesh.primitives) count += primitive.triangles.size();
        fmt::print("  {}: {}\n", named(mesh.name), counted("{} triangle{|s}", count));
    }
    fmt::print("materials   {}\n", scene.materials.size());
    for (const Material& material : scene.materials) fmt::print("  {}: {}\n", named(material.name), describe(material));
    fmt::print("textures    {}\n", scene.textures.size());
    for (const Texture& texture : scene.textures)
        fmt::print("  {}: {}x{}\n", named(texture.name), texture.width, texture.height);
    print_cameras(scene, geometry);
    fmt::print("lights      {}\n", scene.lights.size());
    for (const Light& light : scene.lights) fmt::print("  {}: {}\n", named(light.name), kind_of(light));
    fmt::print("animations  {}\n", scene.animations.size());
    for (const Animation& animation : scene.animations)
        fmt::print("  {}: {}\n", named(animation.name),
                   std::isinf(animation.duration) ? "without end" : fmt::format("{:.3g} s", animation.duration));
    if (!scene.variants.empty()) fmt::print("variants    {}\n", joined(scene.variants));
    fmt::print("extensions used           {}\n", joined(scene.extensions_used));
    fmt::print("extensions without effect {}\n", joined(scene.extensions_unsupported));
    for (const std::string& note : scene.notes) fmt::print("note        {}\n", note);
}

void run_devices() {
    for (const DeviceInfo& device : list_devices()) {
        fmt::print("{}: {}\n", device.index, device.name);
        fmt::print("   {}, Vulkan {}, driver {}, {:.1f} GiB{}\n", device.kind, device.api_version, device.driver,
                   double(device.memory) / (1ull << 30),
                   device.usable ? "" : fmt::format("; not usable: lacks {}", device.lacking));
    }
}

}  // namespace peelray
