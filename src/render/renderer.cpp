#include "render/renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/error.h"
#include "common/ray.h"
#include "motion/bounds.h"
#include "render/aov_pictures.h"
#include "render/paths.h"
#include "settings/limits.h"

namespace peelray {
namespace {

/// The part of the program that what is uploaded is accounted for as.
constexpr const char* kScenePart = "scene";

using Progress = std::function<void(double)>;

void check_settings(const Device& device, const GpuScene& scene, const RenderSettings& settings) {
    const uint32_t largest = std::min(device.limits().maxImageDimension2D, device.limits().maxFramebufferWidth);
    if (settings.width < 1 || settings.height < 1 || settings.width > largest || settings.height > largest)
        fail("a picture of {}x{} pixels is impossible: the device '{}' draws 1x1 to {}x{} ({})", settings.width,
             settings.height, device.info().name, largest, largest, setting::size);
    const uint64_t bytes = uint64_t(settings.width) * settings.height * sizeof(glm::vec4);
    if (bytes > device.limits().maxStorageBufferRange)
        fail(
            "a picture of {}x{} pixels needs {:.0f} MiB at once, but the device '{}' binds at most {:.0f}: choose a "
            "smaller {}",
            settings.width, settings.height, double(bytes) / (1 << 20), device.info().name,
            double(device.limits().maxStorageBufferRange) / (1 << 20), setting::size);
    static_assert(kBounceLimits.most == QUEUE_LEVELS - 1);
    check_limits(kBounceLimits, setting::bounces, settings.bounces);
    check_limits(kBounceLimits, setting::gi, settings.gi);
    check_limits(kPhotonLimits, setting::caustics, settings.caustics);
    check_limits(kSampleLimits, setting::spp, settings.spp);
    if (settings.visibility == Visibility::compute && !ComputeView::possible(device, scene))
        fail("the device '{}' cannot find what pixels see by compute shaders{}: use {} raster", device.info().name,
             device.features.int64_atomics ? fmt::format(" among {} triangles", scene.drawn)
                                           : ", for it lacks 64-bit atomics",
             setting::visibility);
}

/// `samples`: as many stand for a pixel, each for its share.
void describe_view(Frame& frame, const View& view, uint32_t height, uint32_t samples) {
    frame.eye = view.eye;
    frame.right = view.right;
    frame.up = view.up;
    frame.forward = view.forward;
    frame.orthographic = view.orthographic;
    frame.near = view.near;
    frame.far = view.far;
    const float across = 2 * glm::length(view.up) / (float(height) * std::sqrt(float(samples)));
    frame.cone = view.orthographic ? glm::vec2(across, 0) : glm::vec2(0, across);
}

/// What is traced or, with `maps`, looked up; in maps nobody sees whether the sky is hidden.
uint32_t effects_of(const PictureSettings& settings, bool maps) {
    return (settings.reflection ? EFFECT_REFLECTION : 0u) | (settings.refraction ? EFFECT_REFRACTION : 0u) |
           (settings.shadow ? EFFECT_SHADOW : 0u) | (occludes_sky(settings) && !maps ? EFFECT_AMBIENT : 0u);
}

}  // namespace

struct Renderer::Impl {
    FrameState f;
    const Assembly assembly;
    const Scene& source;
    Moment moment;
    std::vector<StructureBody> structure_bodies;  ///< none without ray tracing
    TracerChoice made_for;                        ///< what f.tracer was made for
    PictureOutput output;
    AovPictures aovs;
    Box box;  ///< what the settings say, else that of the moment
    RayCounts rays;
    PictureSettings made;  ///< those of the settings; spp: the samples that there are
    SamplesMade samples;
    Picture spare;  ///< of which the memory is free
    uint32_t moved = 0;
    bool maps_moved = false;
    uint32_t most_rows = 1u << 20;  ///< of a band: of higher ones the queues found no room

    Impl(Device& device, const Scene& source, const Moment& moment, const Assembly& assembly,
         const Environment& environment)
        : f(device, source, moment, assembly, environment),
          assembly(assembly.without_geometry()),
          source(source),
          moment(moment),
          output(device) {
        if (device.features.ray_tracing) structure_bodies = peelray::structure_bodies(source, assembly);
    }

    void prepare(const RenderSettings& settings, bool open);
    void prepare_tracer();
    glm::uvec2 camera_media() const;
    void prepare_view();
    void prepare_maps();
    void prepare_photons();
    PathQueues::Needs queue_needs() const;
    void fit_bands();
    void prepare_queues();
    bool smaller_bands();
    void look_back();
    FrameMeter render_frame(const PictureWatch& watch, bool only_kept = false);
    void render_pass(const Passes& passes, FrameMeter& meter, const Progress& progress);
    void end_pass(Passes& passes);
    void describe_tracer();
    void render_maps(FrameMeter& meter, const Progress& progress);
    void render_band(uint32_t sample, uint32_t first_row, FrameMeter& meter, const std::function<void()>& progress);
    void record_band(uint32_t sample, uint32_t first_row);
    void record_shading(uint32_t sample, uint32_t first_row);
    bool finish_band(uint32_t first_row);
    void count_rays();
    void finish_picture(FrameMeter& meter, bool only_kept);
    void describe(RenderStats& stats);
};

void Renderer::Impl::prepare(const RenderSettings& settings, bool open) {
    f.settings = settings;
    made = settings;
    check_settings(f.device, f.scene, settings);
    f.commands.time_passes(settings.time_passes);
    f.view.prepare(f.scene, settings);
    output.prepare(settings, f.scene.has_unlit, open, is_denoised(settings) && !shades_by_maps(settings));
    prepare_tracer();
    prepare_view();
    if (f.maps) prepare_maps();
    prepare_photons();
    prepare_queues();
}

/// The tracer that the settings ask for, or none where neither an effect nor the media before what is seen need any;
/// not yet built.
void Renderer::Impl::prepare_tracer() {
    f.settings.cubes = choose_automatically(assembly.bodies_triangles(), f.settings);
    TracerChoice choice = f.settings;
    if (choice.tracer == Tracer::khr) f.device.check_ray_tracing();
    if (choice.tracer != Tracer::cubemap && !needs_rays(f.settings, f.scene.has_blended) && !f.scene.layered &&
        camera_media() == glm::uvec2(0))
        choice.tracer = Tracer::none;
    if (!f.tracer || made_for != choice) {
        f.tracer.reset();  // first, so that both never live at once
        f.merged = MergedInstances::make(f.device, f.commands, assembly, moment.worlds, choice, f.scene.triangles);
        f.tracer = make_tracer(choice, {f.device, f.scene.triangles, f.scene.instances, assembly, moment.worlds,
                                        structure_bodies, f.merged.get()});
        f.tracer->pose(moved > 0);
        made_for = choice;
    }
    const bool counts = f.settings.counters && f.tracer->counts();
    if (counts != (f.counter != nullptr)) f.counter = counts ? std::make_unique<CostCounter>(f.device) : nullptr;
    if (!shades_by_maps(f.settings)) {
        f.maps.reset();
    } else if (!f.maps) {
        const MemoryPart part(f.device, "cube maps");
        f.maps = std::make_unique<CubeMaps>(f.device, f.scene, source, flatten(source, moment));
        maps_moved = false;
    }
}

/// What the camera is in.
glm::uvec2 Renderer::Impl::camera_media() const {
    const Camera& camera = f.settings.camera;
    if (camera.orthographic_height > 0) return {};  // its rays have no one start
    const MediaStack stack = f.scene.media_at(source, moment, camera.eye);
    return {stack.low, stack.high};
}

/// Bands of the picture, and its constants.
void Renderer::Impl::prepare_view() {
    const RenderSettings& settings = f.settings;
    f.last_level = f.tracer->traces() ? last_level(settings, f.scene.has_blended) : 0;
    box = settings.bounds ? *settings.bounds : bounds(source, moment);
    Frame& frame = f.constants = {};
    f.scene.describe(frame, f.env_sampled());
    describe_view(frame,
                  make_view(settings.camera, float(settings.width) / float(settings.height), box.lower, box.upper),
                  settings.height, settings.spp);
    f.tracer->describe(frame);
    frame.camera_media = camera_media();
    // A band's largest queue entries are rays and branches, or the walls of media; bands keep each queue below what the
    // device binds, with room to grow.
    const uint64_t entry = f.layered() ? sizeof(MediaWall) : sizeof(Ray);
    const uint64_t each =
        (f.scene.base_colors.kinds & MATERIALS_DISPERSIVE ? 4 : 2) + (f.indirect() ? 1 : 0);  // rays from a hit
    const uint64_t most = std::min({uint64_t(4u << 20), f.device.limits().maxStorageBufferRange / (each * entry),
                                    uint64_t(f.queues.most_lights()) / std::max(f.lights_per_hit(), 1u)});
    f.bands = Bands(settings.width, settings.height, std::min(most, uint64_t(most_rows) * settings.width));
    frame.width = settings.width;
    frame.height = settings.height;
    frame.row_pixels = f.bands.row_pixels();
    const bool maps = f.maps != nullptr;
    frame.effects = (f.tracer->traces() || maps ? effects_of(settings, maps) : 0) |
                    (settings.energy_compensation ? EFFECT_COMPENSATION : 0u) |
                    (is_sampled(settings) && !maps ? EFFECT_SAMPLED : 0u);  // a blurred cube map is all of a rough lobe
    // All of a pixel's cone, not a sample's share of it: a sun that fills a part of it is seen by that part.
    frame.env_texels *= std::sqrt(float(settings.spp));
    frame.sample_bits = uint32_t(std::bit_width(settings.spp - 1));
    frame.seed = settings.seed;
    frame.bounces = settings.bounces;
    frame.bounce_levels = bounce_levels(settings, f.scene.has_blended);
    frame.first_drawn = f.scene.first_drawn();
    frame.drawn_lamps = f.drawn_lamps();
    frame.lights -= frame.drawn_lamps;
    frame.emitters = f.emitting() ? f.scene.emitters() : 0;
    frame.gi = f.indirect() ? settings.gi : 0;
    frame.last_level = f.last_level;
    frame.backdrop = uint32_t(settings.backdrop.kind);
    frame.backdrop_color = settings.backdrop.color;
    f.commands.upload(f.view.target.frame, std::span<const Frame>(&frame, 1));
}

void Renderer::Impl::prepare_maps() {
    const MemoryPart part(f.device, "cube maps");
    if (maps_moved) f.maps->move(flatten(source, moment));
    maps_moved = false;
    f.maps->prepare(f.commands, f.settings, f.constants, box);
}

/// Where none would come to anything there are none.
void Renderer::Impl::prepare_photons() {
    PhotonPlan plan;
    if (f.settings.caustics > 0 && f.tracer->traces() && !f.maps)
        plan = plan_photons(source, flatten(source, moment),
                            std::span(f.scene.lamp_list).first(f.scene.lamps(f.env_sampled())), f.settings);
    if (plan.empty()) return f.photons.reset();
    if (!f.photons) f.photons = std::make_unique<PhotonMap>(f.device);
    f.photons->prepare(f, std::move(plan));
}

PathQueues::Needs Renderer::Impl::queue_needs() const {
    const uint32_t face = f.maps ? f.maps->face() : 0;
    return {std::max(f.bands.most_pixels(), face * face),
            f.last_level + 1,
            f.settings.bounces + f.settings.gi + 1,
            f.scene.splits || f.indirect(),
            f.lights_per_hit(),
            f.usual_lights_per_hit(),
            f.layered(),
            is_denoised(f.settings) && !f.maps};
}

/// Where memory is limited, two thirds of what is left are for the queues of a band; cubes take the rest.
void Renderer::Impl::fit_bands() {
    const uint64_t room = f.device.room();
    if (room == ~0ull) return;
    while (f.queues.bytes_of(queue_needs()) > (room + f.queues.bytes()) / 3 * 2)
        if (!f.bands.halve()) return;
}

void Renderer::Impl::prepare_queues() {
    fit_bands();
    for (;;) {
        try {
            f.queues.prepare(queue_needs());
            if (f.maps || f.settings.aovs) f.queues.keep_camera_rays();
            return;
        } catch (const NoRoom&) {
            if (!smaller_bands()) throw;
        }
    }
}

/// Gives back what the queues have; false: a band is as low as it can be.
bool Renderer::Impl::smaller_bands() {
    f.queues.release();
    const bool halved = f.bands.halve();
    most_rows = f.bands.rows();
    return halved;
}

/// For Aovs::motion and Denoise::temporal.
void Renderer::Impl::look_back() {
    const PictureSettings& s = f.settings;
    if (!(s.aovs && s.motion) && !is_temporal(s)) return;
    const View view = make_view(s.camera_before, float(s.width) / float(s.height), box.lower, box.upper);
    f.before.look_back(f, source, s.moment_before ? *s.moment_before : moment, moment, assembly, view);
}

/// The stages are those of docs/frame.md. `only_kept`: the picture is made for later ones.
FrameMeter Renderer::Impl::render_frame(const PictureWatch& watch, bool only_kept) {
    FrameMeter meter;
    Passes passes(f.settings, watch);
    const Progress progress = [&](double of_pass) {
        if (watch.progress) watch.progress(passes.share(of_pass));
    };
    rays = {};
    f.tracer->build(
        f.commands, [&] { f.scene.record_animation(f.commands, f.tracer->bodies()); }, meter);
    describe_tracer();
    if (f.maps) render_maps(meter, progress);
    if (f.counter) f.counter->record_begin(f.commands, f.pixels());
    while (passes.next() > 0) {
        render_pass(passes, meter, progress);
        end_pass(passes);
    }
    finish_picture(meter, only_kept);
    rays.primary = f.pixels() * made.spp;
    return meter;
}

void Renderer::Impl::render_pass(const Passes& passes, FrameMeter& meter, const Progress& progress) {
    const uint32_t first = passes.done(), end = passes.end_of_pass();
    for (uint32_t sample = first; sample < end; sample++)
        for (uint32_t row = 0; row < f.settings.height; row += f.bands.rows())
            render_band(sample, row, meter,
                        [&] { progress((sample - first + double(row) / f.settings.height) / (end - first)); });
}

void Renderer::Impl::end_pass(Passes& passes) {
    made.spp = passes.end_of_pass();
    passes.finish([&] { return output.noise(f.commands, made); }, [&] { return output.look(f.commands, made); });
    samples = passes.made();
}

/// Where hits became planar for want of room, the constants say so.
void Renderer::Impl::describe_tracer() {
    const Frame before = f.constants;
    f.tracer->describe(f.constants);
    if (std::memcmp(&before, &f.constants, sizeof before) != 0)
        f.commands.upload(f.view.target.frame, std::span<const Frame>(&f.constants, 1));
}

void Renderer::Impl::render_maps(FrameMeter& meter, const Progress& progress) {
    f.maps->render(f.commands, f.queues, [&] {
        meter.add(f.commands);
        progress(0);  // where an interrupt ends the work
    });
}

/// A band of a sample, as often as it takes to find room for all of its rays.
void Renderer::Impl::render_band(uint32_t sample, uint32_t first_row, FrameMeter& meter,
                                 const std::function<void()>& progress) {
    for (;; meter.redone++) {
        record_band(sample, first_row);
        f.commands.submit();
        if (finish_band(first_row)) break;
        // The counters told how much room is needed; the picture was left alone.
        progress();
    }
    meter.add(f.commands);  // of the turn that fitted: its rays are counted, too
    count_rays();
    progress();
}

void Renderer::Impl::record_band(uint32_t sample, uint32_t first_row) {
    f.commands.fill(f.queues.counters(), 0);
    if (f.counter) f.counter->record_band(f.commands, f.queues, f.last_level + 1);
    if (first_row == 0) f.view.record(f.commands, f.scene, f.queues, sample);
    if (first_row == 0 && f.photons) f.photons->record(f, sample);
    record_shading(sample, first_row);
    const Buffer& frame = f.view.target.frame;
    output.record_accumulation(f.commands, f.queues, frame, level_params(f, 0, sample, first_row), f.settings);
    if (Denoiser* denoiser = output.denoiser()) denoiser->record_guides(f, sample, first_row);
    f.commands.copy(f.queues.counters(), f.queues.readback(), QUEUE_COUNTERS * 4);
}

/// By the tree of rays, or by cube maps.
void Renderer::Impl::record_shading(uint32_t sample, uint32_t first_row) {
    if (!f.maps) return record_paths(f, sample, first_row);
    const LevelParams p = level_params(f, 0, sample, first_row);
    record_primary(f.commands, f.device, f.scene, f.view.target, f.queues, p, f.view.by_number());
    f.maps->record_shading(f.commands, f.view.target.frame, f.queues.level(0), p);
}

/// Looks at the counters of a submitted band; false: it must be done again, with more room or fewer rows.
bool Renderer::Impl::finish_band(uint32_t first_row) {
    const bool seen = first_row > 0 || f.view.finish(f.queues);
    try {
        if (f.queues.finish()) return seen;
    } catch (const NoRoom&) {
        if (!smaller_bands()) throw;
        prepare_queues();
        return false;
    }
    if (f.queues.crowded() && !f.bands.halve())
        fail(
            "eight rows of pixels need {} shadow rays, more than the {} that are traced at once: choose a smaller "
            "{} or fewer lights",
            f.queues.count(QUEUE_LIGHT), f.queues.most_lights(), setting::size);
    return false;
}

void Renderer::Impl::count_rays() {
    const PathQueues& queues = f.queues;
    if (f.counter) f.counter->finish();
    rays.reflection += queues.count(QUEUE_REFLECTION);
    rays.refraction += queues.count(QUEUE_REFRACTION);
    rays.diffuse += queues.count(QUEUE_DIFFUSE);
    rays.shadow += queues.count(QUEUE_LIGHT) - queues.count(QUEUE_AMBIENT);
    rays.ambient += queues.count(QUEUE_AMBIENT);
    rays.cut_reflection += queues.count(QUEUE_CUT_REFLECTION);
    rays.cut_refraction += queues.count(QUEUE_CUT_REFRACTION);
    rays.crowded += queues.count(QUEUE_CROWDED);
    rays.photons += queues.count(QUEUE_PHOTON_RAYS);
    rays.photons_kept += queues.count(QUEUE_PHOTONS);
}

/// Post passes change the picture in place: not before its last band is known to have fitted.
void Renderer::Impl::finish_picture(FrameMeter& meter, bool only_kept) {
    if (only_kept)
        output.record_memory(f.commands, made);
    else if (!output.record_post(f.commands, made))
        return;
    f.commands.submit();
    meter.add(f.commands);
}

/// All but the times.
void Renderer::Impl::describe(RenderStats& stats) {
    stats.timed = f.device.timestamp_period() > 0;
    stats.tracer = f.settings.tracer;
    stats.visibility = f.view.by_number() ? Visibility::compute : Visibility::raster;
    stats.scene_bytes = f.scene.bytes();
    stats.band_rows = f.bands.rows();
    stats.bands = (f.settings.height + f.bands.rows() - 1) / f.bands.rows();
    stats.frame_bytes = f.queues.bytes() + output.bytes() + f.view.bytes() + (f.photons ? f.photons->bytes() : 0);
    stats.moved = moved;
    stats.counted = f.counter != nullptr;
    if (f.counter) stats.costs = f.counter->sums();
    if (f.maps) stats.maps = f.maps->stats();
    f.tracer->describe(f.commands, stats, f.settings.bodies || f.settings.cubes.hit == HitTest::tolerance);
    stats.choice = stats.cubes.bodies > 0 ? stats.cubes.choice : f.settings.cubes;
    stats.hit = stats.choice.hit;
}

Renderer::Renderer(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                   const Environment& environment) {
    const MemoryPart part(device, kScenePart);
    impl_ = std::make_unique<Impl>(device, scene, moment, assembly, environment);
}

Renderer::~Renderer() = default;

void Renderer::pose(const Moment& moment) {
    FrameState& f = impl_->f;
    const MemoryPart part(f.device, kScenePart);
    impl_->moment = moment;
    impl_->moved = f.scene.pose(f.commands, impl_->source, moment);
    impl_->maps_moved = true;
    if (f.tracer) f.tracer->pose(impl_->moved > 0);
}

void Renderer::add_post_pass(PostPass pass) {
    impl_->output.add(std::move(pass));
}

double Renderer::warm_up(const RenderSettings& settings, const PictureWatch& watch) {
    Impl& r = *impl_;
    const MemoryPart part(r.f.device, "frame");
    r.prepare(settings, Passes(settings, watch).are_several());
    r.look_back();
    return r.render_frame(watch, true).ms;
}

RenderResult Renderer::render(const RenderSettings& settings, const PictureWatch& watch) {
    Impl& r = *impl_;
    Device& device = r.f.device;
    const MemoryPart part(device, "frame");
    r.prepare(settings, Passes(settings, watch).are_several());
    r.look_back();

    RenderResult result;
    Measurement measurement(settings.repeat);
    PictureWatch frame_watch = watch;
    for (uint32_t i = 0; i < measurement.frames(); i++) {
        frame_watch.progress = [&](double share) {
            if (watch.progress) watch.progress((i + share) / measurement.frames());
        };
        measurement.add(r.render_frame(frame_watch));
    }
    RenderStats& stats = result.stats;
    measurement.describe(stats);
    r.describe(stats);
    result.rays = r.rays;
    result.radiance = std::move(r.spare.radiance);
    result.encoded = std::move(r.spare.encoded);
    r.output.download(r.f.commands, r.made, result);
    result.samples = r.samples;
    if (settings.aovs) r.aovs.render(r.f, result.aovs);
    if (settings.aovs && settings.ray_setup) r.aovs.render_ray_setup(r.f, r.box, result.aovs);
    if (r.f.counter) result.aovs.costs = r.f.counter->download_pixels(r.f.commands, r.f.pixels());
    stats.peak_bytes = device.peak_allocated();
    stats.memory = device.allocations();
    stats.peak_memory = device.peak_allocations();
    return result;
}

void Renderer::reuse(Picture picture) {
    impl_->spare = std::move(picture);
}

void Renderer::add_radiance(Picture& picture) {
    impl_->output.download_radiance(impl_->f.commands, impl_->made, picture);
}

}  // namespace peelray
