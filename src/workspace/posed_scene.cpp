#include "workspace/posed_scene.h"

#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "motion/bounds.h"
#include "workspace/camera_choice.h"
#include "workspace/scene_changes.h"

namespace peelray {
namespace {

/// The animation that the settings choose; empty: none.
std::string choose_animation(const PictureArguments& a, const Scene& scene, const Notes& notes) {
    if (!a.animation.empty() || !a.time) return a.animation;
    if (!scene.animations.empty()) return "0";
    note(notes, "the scene has no animation: everything stands at rest");
    return "";
}

Environment choose_environment(const PictureArguments& a, const Scene& scene, const Notes& notes) {
    if (!a.env.empty()) {
        std::string text;
        const Image image = read_hdr(a.env, &text);
        if (!text.empty()) note(notes, text);
        return image_environment(image.width, image.height, image.pixels);
    }
    if (a.background) return color_environment(*a.background);
    // A scene that brings its own lights gets a sky without a sun's worth of extra light only if asked for.
    if (a.sky || scene.lights.empty()) return sky_environment(default_sun_direction());
    return color_environment(glm::vec3(0.05f));
}

}  // namespace

PosedScene::PosedScene(const PictureArguments& settings, const Notes& notes) : settings_(settings) {
    auto scene = std::make_unique<Scene>(
        load_scene(settings.scene, {settings.variant, settings.point_size.value_or(0), settings.double_sided}));
    animation_ = choose_animation(settings, *scene, notes);
    if (!animation_.empty()) complete_targets(*scene);
    framed_ = animation_.empty() ? peelray::bounds(*scene, at_rest(*scene)) : bounds_over(*scene, animation_);
    if (settings.material) override_materials(*scene, *settings.material, framed_);
    bounds_ = settings.floor ? add_floor(*scene, framed_) : framed_;
    scene_ = std::move(scene);
    if (animation_.empty())
        moment_ = at_rest(*scene_);
    else
        pose(settings.time.value_or(0));
    check_visible(geometry(), *scene_, time_.has_value(), notes);
    triangles_ = geometry().triangles.size();
    camera_ = choose_camera(settings_, *scene_, moment_.cameras, framed_);
    environment_ = choose_environment(settings, *scene_, notes);
}

const Geometry& PosedScene::geometry() {
    if (!geometry_) {
        simulate();
        geometry_ = flatten(*scene_, moment_);
    }
    return *geometry_;
}

void PosedScene::simulate() {
    if (!std::exchange(simulated_, true)) simulation_.place(*scene_, moment_);
}

void PosedScene::pose(double seconds) {
    moment_ = moment_of(*scene_, animation_, seconds);
    time_ = seconds;
    simulated_ = false;
    geometry_.reset();
}

void PosedScene::move_to(double seconds) {
    if (animation_.empty() || time_ == seconds) return;
    pose(seconds);
    camera_ = choose_camera(settings_, *scene_, moment_.cameras, framed_);
}

Assembly PosedScene::assembly() const {
    return assemble(*scene_, moment_of(*scene_, animation_, 0), motion_of(*scene_, animation_));
}

Assembly PosedScene::assembly_of_moment() const {
    return assemble(*scene_, moment_, motion_of(*scene_, animation_));
}

void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment, const Notes& notes) {
    const size_t count = geometry.triangles.size();
    if (geometry.zero_area == count && !is_moment)
        fail("{}: {} area; give a file with a surface", scene.name,
             count == 1 ? "its only triangle has no" : counted("none of its {} triangles has an", count));
    for (const std::string& text : scene.notes) note(notes, text);
    if (geometry.zero_area > 0)
        note(notes, fmt::format("{} of {} {} can never be hit", geometry.zero_area, counted("{} triangle{|s}", count),
                                counted("{has no area: it|have no area: they}", geometry.zero_area)));
    for (const std::string& extension : scene.extensions_unsupported)
        note(notes, fmt::format("the extension {} has no effect in this version", extension));
}

}  // namespace peelray
