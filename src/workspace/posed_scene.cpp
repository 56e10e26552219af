#include "workspace/posed_scene.h"

#include <span>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "motion/bounds.h"
#include "workspace/camera_choice.h"
#include "workspace/environment_choice.h"
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

/// A framing by what is visible of points that are visited; by all of them where nothing is.
template <typename Visit>
Framing framing_of(const PictureArguments& a, Visit visit) {
    const auto around = [&](const std::optional<glm::vec3>& pivot) {
        Framing framing(framing_lens(a), pivot);
        const auto add = [&](std::span<const glm::vec3> points) { framing.add(points); };
        // Another material has no holes.
        if (!a.material) visit(Counted::visible, add);
        if (framing.box().lower.x > framing.box().upper.x) visit(Counted::all, add);
        return framing;
    };
    const Framing standing = around({});
    return a.goes_round ? around(0.5f * (standing.box().lower + standing.box().upper)) : standing;
}

}  // namespace

PosedScene::PosedScene(const PictureArguments& settings, const Notes& notes) : settings_(settings) {
    auto scene = std::make_unique<Scene>(
        load_scene(settings.scene, {settings.variant, settings.point_size.value_or(0), settings.double_sided}));
    animation_ = choose_animation(settings, *scene, notes);
    if (!animation_.empty()) complete_targets(*scene);
    frame_animation(*scene);
    own_nodes_ = scene->nodes.size();
    for (Light& light : scene->lights)
        if (light.kind != Light::Kind::directional) light.radius = settings.light_radius;
    if (settings.material) override_materials(*scene, *settings.material, framed_);
    bounds_ = peelray::bounds(*scene, at_rest(*scene));
    const Box shown =
        settings.floor || settings.shadow_catcher ? add_floor(*scene, framed_, settings.shadow_catcher) : framed_;
    bounds_.add(shown.lower);
    bounds_.add(shown.upper);
    scene_ = std::move(scene);
    if (animation_.empty())
        moment_ = at_rest(*scene_);
    else
        pose(settings.time.value_or(0));
    check_visible(geometry(), *scene_, time_.has_value(), notes);
    triangles_ = geometry().triangles.size();
    if (settings.frame_moment) frame_moment();
    camera_ = choose_camera(settings_, *scene_, moment_.cameras, framing_);
    environment_ = choose_environment(settings, *scene_, notes);
    env_mode_ = settings.env_mode.value_or(environment_.is_image ? EnvironmentMode::sampled : EnvironmentMode::open);
    if (env_mode_ == EnvironmentMode::sampled) environment_.distribution = EnvironmentDistribution(environment_);
    if (env_mode_ == EnvironmentMode::filtered) environment_.filtered = FilteredEnvironment(environment_);
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
    if (settings_.frame_moment) frame_moment();
    camera_ = choose_camera(settings_, *scene_, moment_.cameras, framing_);
}

void PosedScene::visit(double seconds) {
    if (animation_.empty() || time_ == seconds) return;
    pose(seconds);
    camera_ = choose_camera(settings_, *scene_, moment_.cameras, framing_);
}

PosedScene::Glimpse PosedScene::glimpse(double seconds, bool simulate) {
    Moment moment = moment_of(*scene_, animation_, seconds);
    if (simulate) glimpsed_.place(*scene_, moment);
    const Camera camera = choose_camera(settings_, *scene_, moment.cameras, framing_);
    return {std::move(moment), camera};
}

void PosedScene::frame_animation(const Scene& scene) {
    const auto visit = [&](Counted counted, const PointVisitor& add) { visit_reach(scene, animation_, counted, add); };
    framing_ = framing_of(settings_, visit);
    framed_ = framing_.box();
}

void PosedScene::frame_moment() {
    simulate();
    const auto visit = [&](Counted counted, const PointVisitor& add) {
        visit_points(*scene_, moment_, own_nodes_, counted, add);
    };
    framing_ = framing_of(settings_, visit);
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
