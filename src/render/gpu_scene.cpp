#include "render/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "assembly/emitters.h"
#include "base/error.h"
#include "path/media_params.h"
#include "path/tables.h"
#include "path_tables.h"
#include "render/base_colors.h"
#include "render/transforms.h"
#include "scene/alpha_test.h"
#include "scene/lamps.h"
#include "scene/pi.h"
#include "scene/picture.h"
#include "scene/sidedness.h"
#include "view/view_params.h"

namespace peelray {
namespace {

GpuLight gpu_light(const Light& light) {
    GpuLight g{};
    g.position = light.position;
    g.kind = uint32_t(light.kind);
    g.direction = light.direction;
    g.range = std::isfinite(light.range) ? light.range : 1e18f;
    g.color = light.color;
    g.sine = light.kind == Light::Kind::directional ? std::sin(light.radius) : light.radius;
    // KHR_lights_punctual, section "Inner and Outer Cone Angles".
    g.cone_scale = 1 / std::max(0.001f, std::cos(light.inner_cone) - std::cos(light.outer_cone));
    g.cone_offset = -std::cos(light.outer_cone) * g.cone_scale;
    return g;
}

/// As the lookups hold them.
std::vector<glm::vec4> emitter_table(const Emitters& emitters) {
    std::vector<glm::vec4> table;
    table.reserve(emitters.size());
    for (const Emitter& e : emitters)
        table.emplace_back(std::bit_cast<float>(e.instance), std::bit_cast<float>(e.triangle), e.cumulative,
                           e.probability);
    return table;
}

/// Instances are in the order of their bodies.
std::vector<DrawRange> draw_ranges(const Assembly& assembly) {
    std::vector<DrawRange> draws;
    for (uint32_t i = 0; i < assembly.instances.size(); i++) {
        const Assembly::Body& body = assembly.bodies[assembly.instances[i].body];
        if (draws.empty() || draws.back().first_triangle != body.first_triangle)
            draws.push_back({body.first_triangle, body.triangles, i, 0});
        draws.back().instances++;
    }
    return draws;
}

std::vector<glm::vec4> direction_table(const std::vector<FixedDirection>& directions) {
    std::vector<glm::vec4> table;
    for (const FixedDirection& fixed : directions) {
        table.emplace_back(fixed.direction, 0);
        table.emplace_back(fixed.light, 0);
    }
    return table;
}

}  // namespace

void check_room(const Device& device, const Scene& scene) {
    std::vector<bool> shown(scene.meshes.size());
    for (const Node& node : scene.nodes)
        if (node.mesh >= 0) shown[size_t(node.mesh)] = true;
    uint64_t triangles = 0, vertices = 0;
    for (size_t i = 0; i < shown.size(); i++)
        for (const Primitive& primitive : scene.meshes[i].primitives) {
            triangles += shown[i] ? primitive.triangles.size() : 0;
            vertices += shown[i] ? primitive.positions.size() : 0;
        }
    const uint64_t bytes = std::max(triangles * sizeof(glm::uvec3), vertices * sizeof(glm::vec3));
    const uint64_t most = device.limits().maxStorageBufferRange;
    if (bytes > most)
        throw NoRoom(fmt::format("{} triangles with {} vertices are more than the device '{}' binds at once ({})",
                                 triangles, vertices, device.info().name, most / sizeof(glm::vec3)),
                     device.room_advice());
}

EnvironmentLevels levels_on(const Device& device, const Environment& environment) {
    EnvironmentLevels shown{0, environment.width, environment.height, environment.levels};
    const FilteredEnvironment& filtered = environment.filtered;
    const size_t all = environment.texels.size() + environment.distribution.quads.size() + filtered.texels.size() +
                       2 * filtered.directions.size();
    const auto bytes = [&] { return sizeof kTables + (all - shown.first) * sizeof(glm::vec4); };
    while (bytes() > device.limits().maxStorageBufferRange && shown.levels > 1) {
        shown.first += size_t(shown.width) * shown.height;
        shown.width = std::max(shown.width / 2, 1u);
        shown.height = std::max(shown.height / 2, 1u);
        shown.levels--;
    }
    return shown;
}

GpuScene::GpuScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                   const Environment& env)
    : triangles(device, assembly.positions, assembly.triangles),
      instances(device, instance_infos(assembly)),
      draws(draw_ranges(assembly)),
      device_(device),
      placed_(assembly.instances),
      fixed_bodies_(assembly.fixed),
      bodies_(uint32_t(assembly.bodies.size())),
      deformer_(device, scene, moment, assembly),
      generators_(device, scene, assembly),
      media_order_(peelray::media_ranks(scene)),
      media_pieces_(scene) {
    Commands commands(device);
    std::vector<GpuDraw> table;
    for (const DrawRange& draw : draws) {
        table.push_back({uint32_t(drawn), draw.first_triangle, draw.triangles, draw.first_instance});
        drawn += uint64_t(draw.triangles) * draw.instances;
    }
    draw_table = upload(device, commands, "draws", table);
    normals = upload(device, commands, "vertex normals", assembly.normals);
    const std::vector<bool> used = used_materials(scene, assembly);
    base_colors = upload_base_colors(device, commands, scene, assembly, used, MaterialsFor::shading);
    if (has_masks(scene, assembly.materials)) triangles.masks = &base_colors;
    if (has_single_sided(scene, assembly.materials)) triangles.sides = &base_colors;
    triangle_ids = upload(device, commands, "places of triangles in the file", assembly.ids);
    triangle_objects = upload(device, commands, "objects of the triangles", assembly.objects);
    for (size_t i = 0; i < used.size(); i++) {
        has_glass |= used[i] && lets_through(scene.materials[i]);
        splits |= used[i] && (transmits(scene.materials[i]) || scene.materials[i].clearcoat > 0);
        has_blended |= used[i] && scene.materials[i].blended;
        has_unlit |= used[i] && scene.materials[i].unlit;
    }
    environment_lights_ = env.lights;
    upload_media(commands);
    upload_lookups(commands, env, emitter_table(emitters_of(scene, assembly)));
    pose(commands, scene, moment);
}

/// Tables, environment, its distribution and emitters, one behind the other.
void GpuScene::upload_lookups(Commands& commands, const Environment& env, const std::vector<glm::vec4>& emitters) {
    static_assert(sizeof kTables == TABLES_END * sizeof(glm::vec4));
    const EnvironmentLevels shown = levels_on(device_, env);
    const std::span<const glm::vec4> texels = std::span(env.texels).subspan(shown.first);
    const std::vector<glm::vec4> directions = direction_table(env.filtered.directions);
    lookups = Buffer(device_, "tables and environment map",
                     sizeof kTables + (texels.size() + env.distribution.quads.size() + emitters.size() +
                                       env.filtered.texels.size() + directions.size()) *
                                          sizeof(glm::vec4));
    commands.upload(lookups, std::span<const float>(kTables[0], sizeof kTables / sizeof(float)));
    commands.upload(lookups, texels, sizeof kTables);
    const uint64_t texels_end = sizeof kTables + texels.size() * sizeof(glm::vec4);
    if (!env.distribution.quads.empty())
        commands.upload(lookups, std::span<const glm::vec4>(env.distribution.quads), texels_end);
    env_quads_ = uint32_t(texels_end / sizeof(glm::vec4));
    first_emitter_ = env_quads_ + uint32_t(env.distribution.quads.size());
    emitters_ = uint32_t(emitters.size());
    if (emitters_ > 0)
        commands.upload(lookups, std::span<const glm::vec4>(emitters), first_emitter_ * sizeof(glm::vec4));
    filtered_first_ = first_emitter_ + emitters_;
    filtered_directions_ = filtered_first_ + uint32_t(env.filtered.texels.size());
    filtered_size_ = {env.filtered.width, env.filtered.height};
    filtered_levels_ = env.filtered.levels;
    if (filtered_levels_ > 0) {
        commands.upload(lookups, std::span<const glm::vec4>(env.filtered.texels), filtered_first_ * sizeof(glm::vec4));
        commands.upload(lookups, std::span<const glm::vec4>(directions), filtered_directions_ * sizeof(glm::vec4));
    }
    env_depth_ = env.distribution.depth;
    env_is_image_ = env.is_image;
    if (env.is_pyramid) env_texels_ = float(shown.height) / kPi;
    env_size_ = {shown.width, shown.height};
    env_levels_ = shown.levels;
    blurred_first_ = uint32_t(env.level_texels() - shown.first);
    sun_cosine_ = env.sun_cosine;
    rough_limit_ = env.rough_limit;
    sun_direction_ = env.sun_direction;
    sun_radiance_ = env.sun_radiance;
    irradiance_ = env.irradiance;
}

uint32_t GpuScene::pose(Commands& commands, const Scene& scene, const Moment& moment) {
    std::vector<GpuTransform> transforms = transforms_of(placed_, moment.worlds);
    uint32_t moved = 0;
    for (size_t i = 0; i < transforms_.size(); i++)
        moved += generators_.places(placed_[i].node) ||
                 std::memcmp(&transforms[i], &transforms_[i], sizeof transforms[i]) != 0;
    if (moved > 0 || transforms_.empty()) instances.place(commands, std::span<const GpuTransform>(transforms));
    transforms_ = std::move(transforms);
    deformer_.pose(commands, scene, moment, triangles.triangles);
    generators_.pose(commands, scene, moment.generated_time);
    upload_lights(commands, moment.lights);
    layered = media_ranks && media_pieces_.may_overlap(scene, moment);
    return moved;
}

void GpuScene::record_animation(Commands& commands, const BodyTable& bodies) {
    bodies.record_emptying(commands, fixed_bodies_, bodies_);
    deformer_.record(commands, bodies, triangles, normals, base_colors);
    generators_.record(commands, bodies, triangles, normals, instances);
}

/// Where there are more media than a stack has numbers for, they do not overlap.
void GpuScene::upload_media(Commands& commands) {
    const MediaRanks& ranks = media_order_;
    if (ranks.materials.empty() || ranks.materials.size() > MEDIA_MOST_RANKS) return;
    std::vector<uint32_t> words = {uint32_t(ranks.of_material.size())};
    words.insert(words.end(), ranks.of_material.begin(), ranks.of_material.end());
    words.insert(words.end(), ranks.materials.begin(), ranks.materials.end());
    media_ranks = upload(device_, commands, "ranks of media", words);
}

MediaStack GpuScene::media_at(const Scene& scene, const Moment& moment, const glm::vec3& point) const {
    if (!media_ranks) return {};
    std::map<uint32_t, uint32_t> counts;  // by rank
    for (const uint32_t material : media_pieces_.around(scene, moment, point))
        counts[media_order_.of_material[material]]++;
    uint32_t entries[4] = {}, used = 0;
    for (const auto& [rank, count] : counts)
        if (used < 4) entries[used++] = (rank + 1) << 4 | std::min(count, 15u);
    return {entries[0] | entries[1] << 16, entries[2] | entries[3] << 16};
}

void GpuScene::upload_lights(Commands& commands, const std::vector<Light>& own) {
    std::vector<GpuLight> list;
    const Lamps lamps = lamps_of(own, environment_lights_);
    for (const Light& light : lamps.lights) list.push_back(gpu_light(light));
    for (uint32_t i = 0; i < lamps.count; i++) list[lamps.first + i].cumulative = lamps.cumulative[i];
    lamp_list = lamps.lights;
    first_placed_ = lamps.first;
    placed_lamps_ = lamps.count;
    const size_t bytes = list.size() * sizeof(GpuLight);
    if (lights && list.size() == light_list.size() && std::memcmp(list.data(), light_list.data(), bytes) == 0) return;
    light_list = std::move(list);
    lights = upload(device_, commands, "lights", light_list);
}

uint64_t GpuScene::bytes() const {
    uint64_t sum = instances.bytes() + base_colors.bytes() + deformer_.bytes() + generators_.bytes();
    for (const Buffer* buffer : {&triangles.positions, &triangles.triangles, &normals, &triangle_ids, &triangle_objects,
                                 &lights, &lookups, &draw_table, &media_ranks})
        sum += buffer->bytes();
    return sum;
}

uint32_t GpuScene::lamps(bool env_sampled) const {
    // What stands for a part of an image is found in it.
    return uint32_t(light_list.size() - (env_sampled && env_is_image_ ? environment_lights_.size() : 0));
}

void GpuScene::describe(Frame& frame, bool env_sampled) const {
    frame.tree = instances.tree();
    frame.draws = uint32_t(draws.size());
    frame.lights = lamps(env_sampled);
    frame.env_size = env_size_;
    frame.env_levels = env_levels_;
    frame.backdrop_first = blurred_first_;
    frame.all_lights = uint32_t(light_list.size());
    frame.sun_cosine = sun_cosine_;
    frame.rough_limit = env_sampled && env_is_image_ ? std::numeric_limits<float>::max() : rough_limit_;
    frame.env_quads = env_quads_;
    frame.env_depth = env_depth_;
    frame.first_emitter = first_emitter_;
    frame.filtered_size = filtered_size_;
    frame.filtered_first = filtered_first_;
    frame.filtered_levels = filtered_levels_;
    frame.filtered_directions = filtered_directions_;
    frame.env_texels = env_texels_;
    frame.sun_direction = sun_direction_;
    frame.sun_radiance = sun_radiance_;
    std::copy(irradiance_.begin(), irradiance_.end(), frame.irradiance);
}

}  // namespace peelray
