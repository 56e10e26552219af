#include "render/gpu_scene.h"

#include <algorithm>
#include <cmath>

namespace peelray {
namespace {

/// A buffer that holds `data`; never empty, so that it can be bound.
template <typename T>
Buffer upload(Device& device, Commands& commands, const char* name, const std::vector<T>& data) {
    Buffer buffer(device, name, std::max<size_t>(data.size(), 1) * sizeof(T));
    if (!data.empty()) commands.upload(buffer, std::span<const T>(data));
    return buffer;
}

GpuMaterial gpu_material(const Material& material) {
    GpuMaterial m{};
    m.base_color = material.base_color;
    m.metallic = material.metallic;
    m.emissive = material.emissive;
    m.roughness = material.roughness;
    m.transmission = material.transmission;
    m.ior = std::max(material.ior, 1.0f);
    m.texture = material.base_color_texture;
    m.flags = (material.thickness <= 0 ? MATERIAL_THIN : 0u) | (material.unlit ? MATERIAL_UNLIT : 0u);
    m.thickness = material.thickness;
    // Beer and Lambert: white becomes attenuation_color after attenuation_distance (KHR_materials_volume).
    if (std::isfinite(material.attenuation_distance) && material.attenuation_distance > 0)
        m.absorption =
            -glm::log(glm::max(material.attenuation_color, glm::vec3(1e-6f))) / material.attenuation_distance;
    return m;
}

GpuLight gpu_light(const Light& light) {
    GpuLight g{};
    g.position = light.position;
    g.kind = uint32_t(light.kind);
    g.direction = light.direction;
    g.range = std::isfinite(light.range) ? light.range : 1e18f;
    g.color = light.color;
    // KHR_lights_punctual, section "Inner and Outer Cone Angles".
    g.cone_scale = 1 / std::max(0.001f, std::cos(light.inner_cone) - std::cos(light.outer_cone));
    g.cone_offset = -std::cos(light.outer_cone) * g.cone_scale;
    return g;
}

}  // namespace

GpuScene::GpuScene(Device& device, const Scene& scene, const Geometry& geometry, const Environment& env)
    : triangles(device, geometry.positions, geometry.triangles, geometry.lower, geometry.upper) {
    Commands commands(device);
    normals = upload(device, commands, "vertex normals", geometry.normals);
    uvs = upload(device, commands, "texture coordinates", geometry.uvs);
    colors = upload(device, commands, "vertex colours", geometry.colors);
    has_colors = !geometry.colors.empty();
    triangle_materials = upload(device, commands, "triangle materials", geometry.materials);
    upload_materials(device, commands, scene, geometry);
    upload_lights(device, commands, scene, env);
    environment = upload(device, commands, "environment map", env.texels);
    env_size_ = {env.width, env.height};
    env_levels_ = env.levels;
    sun_cosine_ = env.sun_cosine;
    rough_limit_ = env.rough_limit;
    sun_direction_ = env.sun_direction;
    sun_radiance_ = env.sun_radiance;
    irradiance_ = env.irradiance;
}

void GpuScene::upload_materials(Device& device, Commands& commands, const Scene& scene, const Geometry& geometry) {
    std::vector<GpuMaterial> gpu_materials;
    for (const Material& material : scene.materials) gpu_materials.push_back(gpu_material(material));
    std::vector<bool> used(scene.materials.size(), false);
    for (uint32_t material : geometry.materials) used[material] = true;
    for (size_t i = 0; i < used.size(); i++)
        has_glass |= used[i] && gpu_materials[i].transmission > 0 && gpu_materials[i].metallic < 1;

    std::vector<GpuTexture> infos;
    std::vector<uint32_t> all_texels;
    for (const Texture& texture : scene.textures) {
        const uint32_t flags = uint32_t(texture.wrap_u) | uint32_t(texture.wrap_v) << 2 | (texture.nearest ? 16u : 0u);
        infos.push_back({uint32_t(all_texels.size()), texture.width, texture.height, flags});
        all_texels.insert(all_texels.end(), texture.texels.begin(), texture.texels.end());
    }
    materials = upload(device, commands, "materials", gpu_materials);
    texture_infos = upload(device, commands, "texture table", infos);
    texels = upload(device, commands, "textures", all_texels);
}

void GpuScene::upload_lights(Device& device, Commands& commands, const Scene& scene, const Environment& env) {
    for (const Light& light : scene.lights) light_list.push_back(gpu_light(light));
    for (const Light& light : env.lights) light_list.push_back(gpu_light(light));
    lights = upload(device, commands, "lights", light_list);
}

uint64_t GpuScene::bytes() const {
    uint64_t sum = 0;
    for (const Buffer* buffer : {&triangles.positions, &triangles.triangles, &normals, &uvs, &colors,
                                 &triangle_materials, &materials, &texture_infos, &texels, &lights, &environment})
        sum += buffer->bytes();
    return sum;
}

void GpuScene::describe(Frame& frame) const {
    frame.lights = uint32_t(light_list.size());
    frame.has_colors = has_colors;
    frame.env_size = env_size_;
    frame.env_levels = env_levels_;
    frame.sun_cosine = sun_cosine_;
    frame.rough_limit = rough_limit_;
    frame.sun_direction = sun_direction_;
    frame.sun_radiance = sun_radiance_;
    std::copy(irradiance_.begin(), irradiance_.end(), frame.irradiance);
}

}  // namespace peelray
