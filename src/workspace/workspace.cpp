#include "workspace/workspace.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "motion/animation.h"
#include "render/gpu_scene.h"
#include "scene/sidedness.h"
#include "workspace/cpu_pictures.h"
#include "workspace/culled_view.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

/// What to say of a picture that is to be denoised and has no noise; else "".
std::string clean_note(const RenderSettings& settings) {
    if (settings.denoise == Denoise::none) return "";
    if (settings.tracer == Tracer::cubemap)
        return fmt::format("{} changes nothing: with {} cubemap no light is drawn at random", Setting{"denoise"},
                           setting::tracer);
    if (draws_at_random(settings)) return "";
    return fmt::format("{} changes nothing: with {} 1 no light is drawn at random but that of {} ambient",
                       Setting{"denoise"}, setting::spp, setting::effects);
}

}  // namespace

Workspace::Workspace(const PictureArguments& settings, Notes notes)
    : settings_(settings), notes_(std::move(notes)), scene_(settings_, notes_) {}

Workspace::~Workspace() = default;

Device& Workspace::device() {
    if (!device_) device_ = std::make_unique<Device>(device_options(settings_.device));
    return *device_;
}

std::string Workspace::renderer_name(Tracer tracer) {
    return is_on_cpu(tracer) ? cpu_version(tracer) : device().info().name;
}

void Workspace::check(Tracer tracer) {
    if (tracer == Tracer::cubemap && settings_.shadow_catcher)
        fail("{} cubemap has no {}: use {} ldc, khr, cpu or reference", setting::tracer, setting::shadow_catcher,
             setting::tracer);
    if (tracer == Tracer::khr) device().check_ray_tracing();
}

void Workspace::renew_device() {
    renderer_.reset();
    device_.reset();
    kept_.clear();
    noted_ = {};
}

void Workspace::reuse(Picture picture) {
    if (renderer_) renderer_->reuse(std::move(picture));
}

void Workspace::check_validation() const {
    if (device_) device_->check_validation();
}

MadePicture Workspace::render(const Shot& shot, const PictureWatch& watch) {
    return render(render_settings(settings_), shot, watch);
}

MadePicture Workspace::render(RenderSettings settings, const Shot& given, const PictureWatch& watch) {
    check(settings.tracer);
    if (given.time) scene_.move_to(*given.time);
    const Shot shot = given.at(scene_.time());
    settings.env_mode = scene_.env_mode();
    note_settings(settings);
    if (settings.tracer == Tracer::cubemap) settings.denoise = Denoise::none;
    // Another moment may have framed them otherwise.
    if (!is_temporal(settings) || settings_.frame_moment) kept_.clear();
    PictureWatch interrupts = watch;
    bool whole = false;  // there is something to keep
    double share_before = 0;
    interrupts.progress = [&](double share) {
        if (!whole) check_interrupt();
        if (watch.progress) watch.progress(share_before + (1 - share_before) * share);
    };
    if (watch.stop) interrupts.stop = [&] { return whole = true, watch.stop(); };
    const WarmUp warm = is_temporal(settings) ? warm_up(settings, shot, interrupts.progress) : WarmUp{};
    share_before = double(warm.pictures) / (warm.pictures + 1);
    const RenderSettings asked = settings;
    settings.seen = may_note_culled();
    const std::unique_ptr<PosedScene::Glimpse> before = pose(settings, shot);
    if (is_temporal(settings)) kept_.begin(shot);
    MadePicture made = is_on_cpu(settings.tracer) ? cpu_picture(scene_, settings, interrupts, past_for(settings))
                                                  : render_on_device(settings, interrupts);
    if (is_temporal(settings) && made.picture.samples.end == PictureEnd::samples) kept_.add(asked, shot);
    made.stats.warm_up_pictures = warm.pictures;
    made.stats.warm_up_ms = warm.ms;
    note_uncaught(settings);
    const std::string cut = cut_note(made.stats.rays, settings.bounces);
    if (!cut.empty() && !std::exchange(noted_.cut, true)) note(notes_, cut);
    const bool emissive = samples_emitters(settings) && std::ranges::any_of(scene_.scene().materials, is_emissive);
    const std::string caustics = caustics_note(made.stats.rays, settings, emissive);
    if (!caustics.empty() && !std::exchange(noted_.caustics, true)) note(notes_, caustics);
    const std::string crowded = is_on_cpu(settings.tracer) ? "" : crowded_note(made.stats.rays);
    if (!crowded.empty() && !std::exchange(noted_.crowded, true)) note(notes_, crowded);
    note_culled(settings, made.picture);
    return in_world(std::move(made));
}

/// Says so, once each, where settings change nothing.
void Workspace::note_settings(const RenderSettings& settings) {
    if (settings.tracer == Tracer::cubemap && settings.ambient && !std::exchange(noted_.ambient, true))
        note(notes_, fmt::format("{} cubemap has no ambient: the sky's diffuse light is unoccluded", setting::tracer));
    if (is_on_cpu(settings.tracer) && settings_.device.memory_limit && !std::exchange(noted_.bands, true))
        note(notes_, fmt::format("{} changes nothing: {} {} holds no memory of a device", setting::memory_limit,
                                 setting::tracer, name_of(settings.tracer)));
    const std::string clean = clean_note(settings);
    if (!clean.empty() && !std::exchange(noted_.denoise, true)) note(notes_, clean);
}

std::unique_ptr<PosedScene::Glimpse> Workspace::pose(RenderSettings& settings, const Shot& shot) {
    if (shot.time) scene_.visit(*shot.time);
    settings.camera = turned(scene_.camera(), shot.turn());
    settings.bounds = scene_.bounds();
    settings.env_mode = scene_.env_mode();
    if (is_temporal(settings)) {
        settings.number = *shot.number;
        settings.seed = seed_of(settings.seed, *shot.number);
    }
    std::unique_ptr<PosedScene::Glimpse> before;
    if (!(settings.aovs && settings.motion) && !is_temporal(settings)) return before;
    const Shot earlier = shot.before();
    if (earlier.time && shot.fps > 0)
        before = std::make_unique<PosedScene::Glimpse>(scene_.glimpse(*earlier.time, is_on_cpu(settings.tracer)));
    settings.camera_before = turned(before ? before->camera : scene_.camera(), earlier.turn());
    settings.moment_before = before ? &before->moment : nullptr;
    return before;
}

/// Renders those of the pictures before that are not kept from earlier ones, oldest first.
Workspace::WarmUp Workspace::warm_up(const RenderSettings& settings, const Shot& shot,
                                     const std::function<void(double)>& progress) {
    std::vector<Shot> shots;
    for (Shot earlier = shot.before(); shots.size() < DENOISE_WARM_UP; earlier = earlier.before())
        shots.insert(shots.begin(), earlier);
    WarmUp made;
    for (size_t i = 0; i < shots.size(); i++) {
        if (kept_.has(settings, shots[i])) continue;
        kept_.begin(shots[i]);
        RenderSettings of_picture = settings;
        of_picture.aovs = of_picture.counters = of_picture.moments = false;
        const std::unique_ptr<PosedScene::Glimpse> before = pose(of_picture, shots[i]);
        const PictureWatch watch([&](double share) { progress((double(i) + share) / double(shots.size() + 1)); });
        made.ms += is_on_cpu(of_picture.tracer) ? cpu_warm_up(scene_, of_picture, watch, *past_for(of_picture))
                                                : renderer_for(of_picture).warm_up(of_picture, watch);
        made.pictures++;
        kept_.add(settings, shots[i]);
    }
    return made;
}

/// Null: pictures do not depend on others.
CpuPast* Workspace::past_for(const RenderSettings& settings) {
    if (!is_temporal(settings)) past_.reset();
    if (is_temporal(settings) && !past_) past_ = make_cpu_past();
    return past_.get();
}

bool Workspace::may_note_culled() const {
    return !noted_.culled && has_single_sided(scene_.scene());
}

/// Says so, once, where the camera sees nothing because it is behind what it looks at. What would be seen is looked at
/// only where next to nothing is.
void Workspace::note_culled(const PictureSettings& settings, Picture& picture) {
    if (!may_note_culled()) return;
    const double seen = seen_share(picture);
    if (seen > kMostSeenInNote || seen >= noted_.least_seen) return;
    noted_.least_seen = seen / 2;
    if (picture.radiance.empty()) renderer_->add_radiance(picture);
    const std::string text = culled_note(seen, culled_share(scene_.scene(), scene_.geometry(), settings, picture));
    if (text.empty()) return;
    noted_.culled = true;
    note(notes_, text);
}

/// The picture with positions in the world.
MadePicture Workspace::in_world(MadePicture made) const {
    const glm::dvec3& origin = scene_.scene().origin;
    if (origin == glm::dvec3(0)) return made;
    // w: 1 where there is a surface.
    for (std::vector<glm::vec4>* points : {&made.picture.aovs.position, &made.picture.aovs.box})
        for (glm::vec4& point : *points)
            if (point.w > 0) point = glm::vec4(glm::vec3(glm::dvec3(point) + origin), point.w);
    return made;
}

/// The renderer for pictures like this one. It stays from moment to moment; another tracer or hit test gets another,
/// since what one needed must not count as another's memory.
Renderer& Workspace::renderer_for(const RenderSettings& settings) {
    // Cube maps stand in the middle of objects, whose boxes the CPU knows.
    if (settings.tracer == Tracer::cubemap) scene_.simulate();
    const Kind kind{settings.tracer, settings.hit_auto, settings.cubes.hit};
    if (!renderer_ || !(kind == kind_)) {
        renderer_.reset();
        kept_.clear();
        device().reset_peak();
        check_room(*device_, scene_.scene());
        note_environment();
        renderer_ = std::make_unique<Renderer>(*device_, scene_.scene(), scene_.moment(), scene_.assembly(),
                                               scene_.environment());
        kind_ = kind;
        posed_ = scene_.time();
    }
    if (posed_ != scene_.time()) renderer_->pose(scene_.moment());
    posed_ = scene_.time();
    return *renderer_;
}

/// Says so, once, where a floor that is there for shadows can have none.
void Workspace::note_uncaught(const PictureSettings& settings) {
    const bool lamps = !scene_.moment().lights.empty() || !scene_.environment().lights.empty();
    const bool sky = occludes_sky(settings) || (settings.env_mode == EnvironmentMode::sampled && settings.shadow);
    if (!settings_.shadow_catcher || sky || (lamps && settings.shadow)) return;
    if (std::exchange(noted_.uncaught, true)) return;
    note(notes_, fmt::format("nothing that casts shadows lights the floor of {}: {}", setting::shadow_catcher,
                             "add ambient or shadow to the effects, or choose an environment with a sun"));
}

/// Says so, once, where the device shows less of the environment map than there is.
void Workspace::note_environment() {
    const Environment& environment = scene_.environment();
    const EnvironmentLevels shown = levels_on(*device_, environment);
    if (shown.first == 0 || std::exchange(noted_.environment, true)) return;
    note(notes_, fmt::format("the device '{}' binds {}x{} texels of the environment map at once: those of {}x{} are "
                             "reduced to them",
                             device_->info().name, shown.width, shown.height, environment.width, environment.height));
}

/// Once for all pictures; of too little room once for each hit test that is left.
void Workspace::note_cubes(const RenderStats& stats) {
    const std::string room = room_note(stats.cubes);
    if (!room.empty() && !noted_.room.has(stats.hit)) note(notes_, room);
    if (!room.empty()) noted_.room.add(stats.hit);
    const std::string tolerance = tolerance_note(stats.bodies, stats.choice);
    if (!tolerance.empty() && !std::exchange(noted_.tolerance, true)) note(notes_, tolerance);
}

void Workspace::note_bands(const RenderStats& stats) {
    if (stats.bands == 1 || !settings_.device.memory_limit || std::exchange(noted_.bands, true)) return;
    note(notes_, fmt::format("{} {}: the picture is made in {} bands of {} rows", setting::memory_limit,
                             *settings_.device.memory_limit, stats.bands, stats.band_rows));
}

MadePicture Workspace::render_on_device(const RenderSettings& settings, const PictureWatch& watch) {
    RenderResult result = renderer_for(settings).render(settings, watch);
    device_->check_validation();
    MadePicture made;
    made.stats = picture_stats(machine_of(*device_), scene_, result);
    made.stats.render = std::move(result.stats);
    for (const RayCostField& field : kRayCostFields)
        made.stats.largest_of_a_pixel.*field.value = largest_of(result.aovs.costs, field);
    note_cubes(made.stats.render);
    note_bands(made.stats.render);
    made.picture = std::move(result);
    return made;
}

}  // namespace peelray
