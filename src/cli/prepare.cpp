#include "cli/prepare.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "cli/messages.h"
#include "image/image.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "motion/bounds.h"
#include "settings/aovs.h"

namespace peelray {
namespace {

Environment choose_environment(const PictureArguments& a, const Scene& scene) {
    if (!a.env.empty()) {
        const Image image = read_hdr(a.env);
        return image_environment(image.width, image.height, image.pixels);
    }
    if (a.background) return color_environment(*a.background);
    // A scene that brings its own lights gets a sky without a sun's worth of extra light only if asked for.
    if (a.sky || scene.lights.empty()) return sky_environment(default_sun_direction());
    return color_environment(glm::vec3(0.05f));
}

const Camera& find_camera(const Scene& scene, const std::vector<Camera>& cameras, const std::string& name) {
    if (cameras.empty())
        fail("the scene '{}' has no cameras: leave {} out, or use {} and {}", scene.name, setting::camera, setting::eye,
             setting::look);
    std::string names;
    for (size_t i = 0; i < cameras.size(); i++) {
        if (cameras[i].name == name || std::to_string(i) == name) return cameras[i];
        names += fmt::format("{}{}: {}", i ? ", " : "", i, cameras[i].name.empty() ? "(no name)" : cameras[i].name);
    }
    fail("the scene '{}' has no camera '{}': there is {} ({})", scene.name, name, names, setting::camera);
}

/// `cameras`: of the scene, where they are now.
Camera choose_camera(const PictureArguments& a, const Scene& scene, const std::vector<Camera>& cameras,
                     const Box& box) {
    Camera camera = frame_box(box.lower, box.upper, float(a.size.x) / float(a.size.y));
    if (!a.camera.empty())
        camera = find_camera(scene, cameras, a.camera);
    else if (!a.eye && !a.look && !cameras.empty())
        camera = cameras.front();
    if (a.eye || a.look) camera.orthographic_height = 0;
    if (a.look || a.eye) camera.look = a.look.value_or(0.5f * (box.lower + box.upper));
    if (a.eye) camera.eye = *a.eye;
    if (a.up) camera.up = *a.up;
    if (a.fov) {
        camera.vertical_fov = *a.fov * 3.14159265f / 180;
        camera.orthographic_height = 0;
    }
    return camera;
}

/// --material: what a file without materials of its own is good for.
void override_material(Scene& scene, MaterialOverride chosen, const Box& box) {
    Material material;
    material.name = name_of(chosen);
    if (chosen == MaterialOverride::mirror) {
        material.base_color = glm::vec3(0.93f, 0.92f, 0.90f);
        material.metallic = 1;
        material.roughness = 0;
    } else if (chosen == MaterialOverride::glass) {
        material.roughness = 0;
        material.transmission = 1;
        material.thickness = 1;
        material.attenuation_color = glm::vec3(0.75f, 0.92f, 0.85f);
        material.attenuation_distance = 0.5f * glm::length(box.upper - box.lower);
    } else {
        material.base_color = glm::vec3(0.62f, 0.52f, 0.44f);
        material.roughness = 0.9f;
    }
    for (Material& each : scene.materials) each = material;
}

/// --floor: two triangles just below the box, the last of the scene. Returns the box with it.
Box add_floor(Scene& scene, const Box& box) {
    const glm::vec3 size = box.upper - box.lower, centre = 0.5f * (box.lower + box.upper);
    const float longest = std::max({size.x, size.y, size.z}), half = 1.5f * longest, y = box.lower.y - 1e-4f * longest;
    Material material;
    material.name = "floor";
    material.base_color = glm::vec3(0.35f, 0.36f, 0.38f);
    material.roughness = 0;
    material.ior = 1.8f;
    Primitive primitive;
    Box with_floor = box;
    for (int i = 0; i < 4; i++) {
        primitive.positions.emplace_back(centre.x + (i == 1 || i == 2 ? half : -half), y,
                                         centre.z + (i >= 2 ? half : -half));
        with_floor.add(primitive.positions.back());
    }
    primitive.normals.assign(4, {0, 1, 0});
    primitive.triangles = {{0, 2, 1}, {0, 3, 2}};
    primitive.material = uint32_t(scene.materials.size());
    scene.materials.push_back(material);
    Node node;
    node.name = "floor";
    node.mesh = int(scene.meshes.size());
    scene.meshes.push_back({"floor", {primitive}, {}});
    scene.nodes.push_back(node);
    return with_floor;
}

/// The animation that --time and --animation choose; empty: none.
std::string choose_animation(const PictureArguments& a, const Scene& scene) {
    if (!a.animation.empty() || !a.time) return a.animation;
    if (!scene.animations.empty()) return "0";
    print_note("the scene has no animation: everything stands at rest");
    return "";
}

}  // namespace

void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment) {
    const size_t count = geometry.triangles.size();
    if (geometry.zero_area == count && !is_moment)
        fail("{}: none of its {} triangles has an area; give a file with a surface", scene.name, count);
    for (const std::string& text : scene.notes) print_note(text);
    if (geometry.zero_area > 0)
        print_note(fmt::format("{} of {} triangles have no area: they can never be hit", geometry.zero_area, count));
    for (const std::string& extension : scene.extensions_unsupported)
        print_note(fmt::format("the extension {} has no effect in this version", extension));
}

void choose_hit(RenderSettings& settings, std::optional<HitTest> hit) {
    settings.hit_auto = !hit;
    settings.cubes.hit = hit.value_or(HitTest::exact);
}

void choose_tracing(RenderSettings& settings, const TracingArguments& tracing) {
    CubeLayout& layout = settings.cubes.layout;
    settings.cubes.tolerance = float(tracing.tolerance);
    layout.traversal = tracing.traversal;
    layout.block = tracing.block;
    layout.batch = tracing.batch;
    layout.half_depth = tracing.depth == 16;
    layout.builder = tracing.builder.value_or(BuilderKind::compute);
    layout.routing = tracing.routing;
}

RenderSettings settings_of(const PictureArguments& a) {
    RenderSettings settings;
    settings.width = a.size.x;
    settings.height = a.size.y;
    settings.cubes.ldc = a.tracing.ldc.value_or(0);
    choose_tracing(settings, a.tracing);
    choose_hit(settings, a.tracing.hit);
    settings.bounces = a.bounces;
    settings.spp = a.spp;
    settings.repeat = a.repeat;
    settings.rebuild = a.rebuild;
    settings.visibility = a.visibility;
    settings.exposure = a.exposure;
    settings.tonemap = a.tonemap;
    settings.reflection = a.effects.has(Effect::reflection);
    settings.refraction = a.effects.has(Effect::refraction);
    settings.shadow = a.effects.has(Effect::shadow);
    settings.ambient = a.effects.has(Effect::ambient);
    return settings;
}

static bool wants_costs(const RenderArguments& a) {
    return std::any_of(a.aovs.begin(), a.aovs.end(), [](Aov aov) { return cost_field(aov); });
}

RenderSettings settings_of(const RenderArguments& a) {
    RenderSettings settings = settings_of(static_cast<const PictureArguments&>(a));
    settings.counters = a.counters || wants_costs(a);
    settings.aovs = std::any_of(a.aovs.begin(), a.aovs.end(), [](Aov aov) { return !cost_field(aov); });
    settings.ray_setup = std::any_of(a.aovs.begin(), a.aovs.end(), is_ray_setup);
    return settings;
}

void check_counters(const RenderArguments& a) {
    const char* option = a.counters ? "--counters" : wants_costs(a) ? "--aov cost_..." : nullptr;
    if (option && a.tracing.tracer != Tracer::ldc)
        fail("{} counts what rays cost in the cubes of --tracer ldc: --tracer {} has none", option,
             name_of(a.tracing.tracer));
    if (a.counters && a.stats.empty()) fail("what --counters counts goes into the stats: name a file (--stats)");
}

const Geometry& PreparedScene::geometry() {
    if (!geometry_) {
        simulate();
        geometry_ = flatten(scene, moment);
    }
    return *geometry_;
}

void PreparedScene::simulate() {
    if (std::exchange(simulated_, true)) return;
    simulation_.place(scene, moment);
}

void PreparedScene::move_to(double seconds) {
    moment = moment_of(scene, animation, seconds);
    time = seconds;
    simulated_ = false;
    geometry_.reset();
}

PreparedScene prepare_scene(const PictureArguments& a) {
    PreparedScene scene;
    scene.scene = load_scene(a.scene);
    scene.animation = choose_animation(a, scene.scene);
    if (!scene.animation.empty()) complete_targets(scene.scene);
    scene.framed =
        scene.animation.empty() ? bounds(scene.scene, at_rest(scene.scene)) : bounds_over(scene.scene, scene.animation);
    if (a.material) override_material(scene.scene, *a.material, scene.framed);
    scene.bounds = a.floor ? add_floor(scene.scene, scene.framed) : scene.framed;
    if (scene.animation.empty())
        scene.moment = at_rest(scene.scene);
    else
        scene.move_to(a.time.value_or(0));
    check_visible(scene.geometry(), scene.scene, scene.time.has_value());
    scene.triangles = scene.geometry().triangles.size();
    scene.camera = choose_camera(a, scene.scene, scene.moment.cameras, scene.framed);
    scene.environment = choose_environment(a, scene.scene);
    return scene;
}

void move_to(PreparedScene& scene, const PictureArguments& a, double time) {
    if (scene.animation.empty() || scene.time == time) return;
    scene.move_to(time);
    scene.camera = choose_camera(a, scene.scene, scene.moment.cameras, scene.framed);
}

}  // namespace peelray
