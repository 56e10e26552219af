#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "common/ray.h"
#include "khr/tracer.h"
#include "motion/bounds.h"
#include "render/compute_view.h"
#include "render/structure_bodies.h"
#include "render/time_table.h"
#include "render/transforms.h"
#include "settings/limits.h"
#include "view/view_params.h"

namespace peelray {
namespace {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

void describe_view(Frame& frame, const View& view) {
    frame.eye = view.eye;
    frame.right = view.right;
    frame.up = view.up;
    frame.forward = view.forward;
    frame.orthographic = view.orthographic;
    frame.near = view.near;
    frame.far = view.far;
}

}  // namespace

CubeChoice choose_automatically(const Device& device, uint32_t triangles, const RenderSettings& settings) {
    CubeChoice choice = settings.cubes;
    // Beyond this the triangles are smaller than what a fine cube resolves, and `exact` lists grow long.
    const uint64_t most = choice.layout.by_pixel() ? ~0ull : most_exact_triangles(device);
    if (settings.hit_auto)
        choice.hit = triangles > std::min<uint64_t>(4'000'000, most) ? HitTest::planar : HitTest::exact;
    // Peeling captures pixel centres.
    if (settings.hit_auto && choice.layout.builder == BuilderKind::peel) choice.hit = HitTest::planar;
    return choice;
}

struct Renderer::Impl {
    Device& device;
    const Assembly assembly;
    const Scene& source;
    Moment moment;
    GpuScene scene;
    std::unique_ptr<SceneCubes> cubes;
    std::unique_ptr<CubeMaps> maps;
    std::vector<StructureBody> bodies;  ///< of the structures, as they are now or would be; none without ray tracing
    std::unique_ptr<Structures> structures;
    PathQueues queues;
    Commands commands;
    ViewTarget view;
    ComputeView compute_view;
    std::unique_ptr<CostCounter> counter;  ///< where it is to be counted
    Buffer picture, encoded, aov_buffer;

    RenderSettings settings;
    HitTest hit = HitTest::exact;
    bool computes_view = false;
    bool build_fits = false;  ///< the cubes of this moment have been built before: it is known that they find room
    Frame frame{};
    Box box;  ///< what the settings say, else that of the moment
    uint32_t last_level = 0, band_rows = 0;
    RayCounts rays;
    uint32_t redone = 0, rebuilt = 0, moved = 0;
    bool maps_moved = false, structures_moved = false;
    TimeTable times;
    double frame_ms = 0;

    Impl(Device& device, const Scene& source, const Moment& moment, const Assembly& assembly,
         const Environment& environment)
        : device(device),
          assembly(without_geometry(assembly)),
          source(source),
          moment(moment),
          scene(device, source, moment, assembly, environment),
          bodies(device.features.ray_tracing ? structure_bodies(source, assembly) : std::vector<StructureBody>()),
          queues(device),
          commands(device),
          view(device),
          compute_view(device) {}

    /// What is left of an assembly when its triangles are on the device.
    static Assembly without_geometry(const Assembly& from) {
        Assembly out;
        out.bodies = from.bodies;
        out.fixed = from.fixed;
        out.instances = from.instances;
        out.shown = from.shown;
        return out;
    }

    TracedScene traced() const { return {cubes->cubes(), scene.instances, scene.triangles}; }
    void check_settings() const;
    void prepare_images();
    void prepare_cubes();
    void prepare_maps();
    void prepare_structures();
    void prepare_frame();
    void count_times();
    void build_cubes();
    void build_structures();
    void record_visibility(uint32_t sample);
    LevelParams level_params(uint32_t level, uint32_t sample, uint32_t first_row);
    void record_levels(uint32_t sample, uint32_t first_row);
    void record_scatter(const LevelParams& p);
    uint32_t lights_per_hit() const;
    void record_shadows();
    void record_shadows_khr();
    RayQueue queue_of(uint32_t level);
    void record_trace_of(uint32_t level);
    void record_band(uint32_t sample, uint32_t first_row);
    bool finish_band(uint32_t first_row);
    void render_frame(const std::function<void(double)>& progress);
    void render_aovs(Aovs& aovs);
    void render_ray_setup(Aovs& aovs);
    void describe(RenderStats& stats);
};

void Renderer::Impl::check_settings() const {
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
    check_limits(kSampleLimits, setting::spp, settings.spp);
    if (settings.visibility == Visibility::compute && !ComputeView::possible(device, scene))
        fail("the device '{}' cannot find what pixels see by compute shaders{}: use {} raster", device.info().name,
             device.features.int64_atomics ? fmt::format(" among {} triangles", scene.drawn)
                                           : ", for it lacks 64-bit atomics",
             setting::visibility);
}

void Renderer::Impl::prepare_images() {
    computes_view = settings.visibility == Visibility::compute ||
                    (settings.visibility == Visibility::automatic && ComputeView::preferable(device, scene));
    const uint64_t pixels = uint64_t(settings.width) * settings.height;
    view.resize(device, settings.width, settings.height);
    const MemoryPart part(device, "images");
    ensure_size(device, picture, "picture", pixels * 16);
    ensure_size(device, encoded, "encoded picture", pixels * 4);
}

/// The cubes that the settings ask for, not yet built; without tracing they tell no more than where things are.
void Renderer::Impl::prepare_cubes() {
    uint32_t triangles = 0;
    for (const Assembly::Body& body : assembly.bodies) triangles += body.triangles;
    CubeChoice choice = choose_automatically(device, triangles, settings);
    // Whoever traces nothing is not told what a cube cannot hold.
    if (settings.tracer != Tracer::ldc && choice.hit == HitTest::tolerance) choice.hit = HitTest::planar;
    hit = choice.hit;
    const uint32_t fixed = settings.fixed_bodies(assembly);
    if (cubes && cubes->choice() == choice && cubes->fixed() == fixed) return;
    build_fits = false;
    cubes.reset();  // first, so that both never live at once
    cubes = std::make_unique<SceneCubes>(device, assembly, choice, fixed, smallest_scales(assembly, moment.worlds));
}

void Renderer::Impl::prepare_maps() {
    const MemoryPart part(device, "cube maps");
    if (!maps) {
        maps = std::make_unique<CubeMaps>(device, scene, source, flatten(source, moment));
    } else if (maps_moved) {
        maps->move(flatten(source, moment));
    }
    maps_moved = false;
    maps->prepare(commands, settings, frame, box);
}

/// The acceleration structures that the settings ask for, not yet built.
void Renderer::Impl::prepare_structures() {
    if (settings.tracer != Tracer::khr) return;
    bool same = structures != nullptr;
    for (size_t i = 0; i < bodies.size(); i++) {
        const StructureUpdate update =
            i < settings.fixed_bodies(assembly) ? StructureUpdate::keep : settings.structures;
        same &= bodies[i].update == update;
        bodies[i].update = update;
    }
    if (same) return;
    structures.reset();  // first, so that both never live at once
    structures = std::make_unique<Structures>(device, scene.triangles, scene.instances, bodies);
}

void Renderer::Impl::prepare_frame() {
    const bool cubemap = settings.tracer == Tracer::cubemap;
    last_level = settings.tracer == Tracer::ldc || settings.tracer == Tracer::khr ? settings.bounces : 0;
    const uint32_t row_pixels = (settings.width + 7) / 8 * 8;
    frame = {};
    scene.describe(frame);
    // A band's largest queue entries are rays and branches; bands keep each queue below what the device binds, with
    // room to grow.
    const uint64_t most = std::min({uint64_t(4u << 20), device.limits().maxStorageBufferRange / (2 * sizeof(Ray)),
                                    uint64_t(queues.most_lights()) / std::max(lights_per_hit(), 1u)});
    const uint32_t rows = (settings.height + 7) / 8 * 8;
    band_rows = uint32_t(std::clamp<uint64_t>(most / row_pixels / 8 * 8, 8, rows));

    box = settings.bounds ? *settings.bounds : bounds(source, moment);
    describe_view(frame,
                  make_view(settings.camera, float(settings.width) / float(settings.height), box.lower, box.upper));
    frame.width = settings.width;
    frame.height = settings.height;
    frame.row_pixels = row_pixels;
    frame.effects = 0;
    if (settings.tracer != Tracer::none)
        frame.effects = (settings.reflection ? EFFECT_REFLECTION : 0u) |
                        (settings.refraction ? EFFECT_REFRACTION : 0u) | (settings.shadow ? EFFECT_SHADOW : 0u) |
                        (settings.ambient ? EFFECT_AMBIENT : 0u);
    // Planar hits know a surface to about a voxel: a ray counts from beyond the reach of its own surface's samples,
    // which accept hits up to 0.7 voxels beside them. Measured against the reference (docs/accuracy.md): 1.0 and 1.5
    // lose contact shadows and nothing is gained.
    // Within the tolerance of a sample a hit may lie by that and by what the surface rises over half a pixel either
    // way, which is at most 0.58 voxels along its normal.
    const bool traces = settings.tracer == Tracer::ldc;
    frame.surface_offset = !traces ? 0 : hit == HitTest::planar ? 0.7f : hit == HitTest::tolerance ? 0.6f : 0;
    frame.tolerance = traces && hit == HitTest::tolerance ? settings.cubes.tolerance : 0;
    frame.block = settings.cubes.layout.block;
    frame.spp = cubemap ? 1 : settings.spp;  // a blurred cube map is no sample of a rough lobe but all of it
    frame.last_level = last_level;
    commands.upload(view.frame, std::span<const Frame>(&frame, 1));
    if (cubemap) prepare_maps();
    queues.prepare(std::max(row_pixels * band_rows, cubemap ? maps->face() * maps->face() : 0), last_level + 1,
                   scene.has_glass, lights_per_hit());
    if (cubemap || settings.aovs) queues.keep_camera_rays();
}

void Renderer::Impl::count_times() {
    times.add(commands.times());
    frame_ms += commands.elapsed_ms();
}

/// The same as build_cubes() for the device's own ray tracing.
void Renderer::Impl::build_structures() {
    scene.record_animation(commands, cubes->cubes());
    scene.instances.record(commands, cubes->cubes(), false);
    structures->build_kept(commands, [&] { count_times(); });
    structures->record(commands, moved > 0 || structures_moved);
    commands.submit();
    count_times();
}

/// Everything up to the cubes of this moment: vertices, cubes, instances.
void Renderer::Impl::build_cubes() {
    const bool traces = settings.tracer == Tracer::ldc;
    rebuilt = 0;
    if (traces && cubes->build_fixed(commands, scene.triangles)) {
        count_times();
        rebuilt = cubes->stats().fixed;
        redone += cubes->stats().redone;
    }
    for (;; redone++) {
        scene.record_animation(commands, cubes->cubes());
        if (traces) cubes->record(commands, scene.triangles);
        scene.instances.record(commands, cubes->cubes());
        // Rays must not walk through cubes that did not find room, so that the host looks first; but once.
        if (build_fits) break;
        commands.submit();
        if (!traces || cubes->finish(commands)) {
            count_times();
            break;
        }
    }
    build_fits = true;
    if (traces) rebuilt += cubes->stats().bodies - cubes->stats().fixed;
}

void Renderer::Impl::record_visibility(uint32_t sample) {
    if (computes_view)
        compute_view.record(commands, scene, view, queues, sample_position(sample));
    else
        record_view(commands, device, "visibility", scene, view, {}, VisibilityParams{sample_position(sample)});
}

LevelParams Renderer::Impl::level_params(uint32_t level, uint32_t sample, uint32_t first_row) {
    LevelParams p{};
    p.level = level;
    p.capacity = queues.level(level).capacity;
    p.next_capacity = queues.level(level + 1).capacity;
    p.sample_index = sample;
    p.jitter = sample_position(sample);
    p.first_row = first_row;
    p.light_capacity = queues.lights().capacity;
    // Level 0 holds exactly the band's pixels; the last band may be lower.
    if (level == 0) p.capacity = frame.row_pixels * std::min(band_rows, (settings.height - first_row + 7) / 8 * 8);
    return p;
}

void Renderer::Impl::record_scatter(const LevelParams& p) {
    const PathLevel &level = queues.level(p.level), &next = queues.level(p.level + 1);
    const bool camera = p.level == 0;  // which makes its rays itself
    const std::vector<Binding> bindings =
        surface_bindings(scene, view.frame,
                         {{"environment", scene.environment},
                          Binding::if_used("rays", camera ? nullptr : &level.rays),
                          Binding::if_used("states", camera ? nullptr : &level.states),
                          Binding::if_used("hits", camera ? nullptr : &level.hits),
                          {"nodes", level.nodes},
                          {"branches", level.branches},
                          {"queue", queues.counters()},
                          {"next_rays", next.rays},
                          {"next_states", next.states},
                          {"next_skip", next.skip},
                          {"lights", scene.lights},
                          {"shadow_rays", queues.lights().rays},
                          {"shadow_skip", queues.lights().skip},
                          {"shadow_light", queues.lights().light},
                          {"visibility", view.visibility},
                          {"draws", scene.draw_table}});
    const Pass& pass = device.pass("scatter", {{"camera", camera}, {"by_number", camera && computes_view}});
    if (camera)
        commands.run(pass, bindings, p, groups_for(p.capacity, 64));
    else
        commands.run_indirect(pass, bindings, p, queues.counters(), PathQueues::groups_offset(p.level));
}

/// Shadow rays that a hit may start.
uint32_t Renderer::Impl::lights_per_hit() const {
    if (settings.tracer != Tracer::ldc && settings.tracer != Tracer::khr) return 0;
    return (settings.shadow ? frame.lights : 0) + (settings.ambient ? 1 : 0);
}

RayQueue Renderer::Impl::queue_of(uint32_t level) {
    const PathLevel& rays = queues.level(level);
    return {rays.rays,
            &rays.skip,
            rays.capacity,
            &queues.counters(),
            level,
            &queues.counters(),
            PathQueues::groups_offset(level),
            PathQueues::launch_offset(level)};
}

void Renderer::Impl::record_trace_of(uint32_t level) {
    const Buffer& hits = queues.level(level).hits;
    RayQueue queue = queue_of(level);
    if (settings.tracer == Tracer::khr)
        return record_khr_trace(commands, device, *structures, scene.triangles, queue, hits, false);
    std::optional<CountBuffers> counting;
    if (counter) queue.counting = &counting.emplace(counter->level(level));
    record_trace(commands, device, traced(), queue, hits, {hit, settings.cubes.tolerance, false, Edges::single});
}

/// The same as record_shadows() for the device's own ray tracing.
void Renderer::Impl::record_shadows_khr() {
    const LightQueue& lights = queues.lights();
    // What the shaders need of surfaces depends on whether light passes some and whether some have holes.
    std::vector<Binding> bindings = if_used(surface_bindings(scene, view.frame, {}));
    for (const Binding& binding : {Binding("shadow_rays", lights.rays), Binding::if_used("shadow_skip", lights.skip),
                                   Binding("shadow_light", lights.light), Binding("queue", queues.counters())})
        bindings.push_back(binding);
    const RayPass& pass =
        khr_pass(device, scene.has_glass ? "trace_shadow_khr_glass" : "trace_shadow_khr",
                 scene.has_glass ? KhrRays::nearest : KhrRays::occluded, scene.triangles.masks != nullptr);
    const RayQueue queue{lights.rays,
                         &lights.skip,
                         lights.capacity,
                         &queues.counters(),
                         QUEUE_LIGHT,
                         &queues.counters(),
                         PathQueues::groups_offset(QUEUE_GROUPS_LIGHT),
                         PathQueues::launch_offset(QUEUE_GROUPS_LIGHT)};
    record_khr_rays(commands, device, pass, khr_bindings(*structures, bindings), lights.capacity, queue);
}

/// The shadow rays of all levels.
void Renderer::Impl::record_shadows() {
    const LightQueue& queue = queues.lights();
    TraceParams p{};
    p.tree = scene.instances.tree();
    p.count = queue.capacity;
    p.tolerance = frame.tolerance;
    p.block = settings.cubes.layout.block;
    std::optional<CountBuffers> counting;
    if (counter) counting.emplace(counter->lights());
    std::vector<Binding> bindings =
        cube_bindings(traced(), {{"shadow_rays", queue.rays},
                                 {"shadow_skip", queue.skip},
                                 {"shadow_light", queue.light},
                                 {"queue", queues.counters()},
                                 Binding::if_used("costs", counting ? &counting->costs : nullptr),
                                 Binding::if_used("count_totals", counting ? &counting->totals : nullptr)});
    if (scene.has_glass) {
        for (const Binding& binding : base_color_bindings(scene.base_colors)) bindings.push_back(binding);
        bindings.push_back({"normals", scene.normals});
    } else {
        bindings = with_alpha_test(bindings, scene.triangles);
    }
    const Pass& pass = device.pass(std::string(scene.has_glass ? "trace_shadow_glass" : "trace_shadow") +
                                       (settings.cubes.layout.by_pixel() ? "_pixels" : ""),
                                   traversal_constants(device, traced(), hit, counter != nullptr));
    commands.run_indirect(pass, bindings, p, queues.counters(), PathQueues::groups_offset(QUEUE_GROUPS_LIGHT));
}

/// Traces and shades the levels of the tree of rays, then all their shadow rays, and gathers the light. Where a queue
/// does not find room all that follows is left out, for the band is done again.
void Renderer::Impl::record_levels(uint32_t sample, uint32_t first_row) {
    for (uint32_t i = 0; i <= last_level; i++) {
        if (i > 0) {
            record_trace_of(i);
        }
        record_scatter(level_params(i, sample, first_row));
    }
    if (lights_per_hit() > 0) settings.tracer == Tracer::khr ? record_shadows_khr() : record_shadows();
    for (uint32_t i = last_level; i-- > 1;)
        commands.run_indirect(device.pass("gather"),
                              {{"nodes", queues.level(i).nodes},
                               {"branches", queues.level(i).branches},
                               {"next_nodes", queues.level(i + 1).nodes},
                               {"shadow_light", queues.lights().light},
                               {"queue", queues.counters()}},
                              level_params(i, sample, first_row), queues.counters(), PathQueues::groups_offset(i));
}

void Renderer::Impl::record_band(uint32_t sample, uint32_t first_row) {
    commands.fill(queues.counters(), 0);
    if (counter) counter->record_band(commands, queues, last_level + 1);
    if (first_row == 0) record_visibility(sample);
    const LevelParams p = level_params(0, sample, first_row);
    if (settings.tracer == Tracer::cubemap) {
        record_primary(commands, device, scene, view, queues, p, computes_view);
        maps->record_shading(commands, view.frame, queues.level(0), p);
    } else {
        record_levels(sample, first_row);
    }
    const bool last = sample + 1 == settings.spp;
    commands.run(device.pass("accumulate"),
                 {{"frame", view.frame},
                  {"nodes", queues.level(0).nodes},
                  {"branches", queues.level(0).branches},
                  {"next_nodes", queues.level(1).nodes},
                  {"shadow_light", queues.lights().light},
                  {"queue", queues.counters()},
                  {"picture", picture},
                  {"encoded", encoded}},
                 AccumulateParams{p.capacity, p.next_capacity, p.light_capacity, first_row, sample, last,
                                  std::exp2(settings.exposure) / float(settings.spp), uint32_t(settings.tonemap)},
                 groups_for(p.capacity, 64));
    if (counter) {
        std::vector<LevelParams> params;
        for (uint32_t i = 0; i <= last_level; i++) params.push_back(level_params(i, sample, first_row));
        counter->record_sums(commands, queues, view.frame, params);
    }
    commands.copy(queues.counters(), queues.readback(), QUEUE_COUNTERS * 4);
}

/// Looks at the counters of a submitted band; false: it must be done again, with more room or fewer rows.
bool Renderer::Impl::finish_band(uint32_t first_row) {
    const bool seen = !computes_view || first_row > 0 || compute_view.finish(queues);
    if (queues.finish()) return seen;
    if (queues.crowded()) {
        if (band_rows == 8)
            fail(
                "eight rows of pixels need {} shadow rays, more than the {} that are traced at once: choose a smaller "
                "{} or fewer lights",
                queues.count(QUEUE_LIGHT), queues.most_lights(), setting::size);
        band_rows = std::max(8u, band_rows / 16 * 8);
    }
    return false;
}

void Renderer::Impl::render_frame(const std::function<void(double)>& progress) {
    rays = {};
    times = {};
    frame_ms = 0;
    if (settings.tracer == Tracer::khr)
        build_structures();
    else
        build_cubes();
    if (settings.tracer == Tracer::cubemap)
        maps->render(commands, queues, [&] {
            count_times();
            if (progress) progress(0);  // where an interrupt ends the work
        });
    if (counter) counter->record_begin(commands, uint64_t(settings.width) * settings.height);
    for (uint32_t sample = 0; sample < settings.spp; sample++)
        for (uint32_t row = 0; row < settings.height; row += band_rows) {
            for (;; redone++) {
                record_band(sample, row);
                commands.submit();
                if (finish_band(row)) break;
                // The counters told how much room is needed; the picture was left alone.
                if (progress) progress((sample + double(row) / settings.height) / settings.spp);
            }
            count_times();  // of the turn that fitted: its rays are counted, too
            if (counter) counter->finish();
            rays.reflection += queues.count(QUEUE_REFLECTION);
            rays.refraction += queues.count(QUEUE_REFRACTION);
            rays.shadow += queues.count(QUEUE_LIGHT) - queues.count(QUEUE_AMBIENT);
            rays.ambient += queues.count(QUEUE_AMBIENT);
            if (progress) progress((sample + double(row) / settings.height) / settings.spp);
        }
    rays.primary = uint64_t(settings.width) * settings.height * settings.spp;
}

void Renderer::Impl::render_aovs(Aovs& aovs) {
    const size_t pixels = size_t(settings.width) * settings.height;
    if (pixels * sizeof(AovSurface) > device.limits().maxStorageBufferRange)
        fail(
            "auxiliary pictures of {}x{} pixels need {:.0f} MiB at once, more than the device '{}' binds: choose a "
            "smaller {}",
            settings.width, settings.height, double(pixels) * sizeof(AovSurface) / (1 << 20), device.info().name,
            setting::size);
    const MemoryPart part(device, "images");
    ensure_size(device, aov_buffer, "auxiliary pictures", pixels * sizeof(AovSurface));
    commands.fill(queues.counters(), 0);
    record_visibility(0);  // it found room before
    for (uint32_t row = 0; row < settings.height; row += band_rows) {
        const LevelParams p = level_params(0, 0, row);
        record_primary(commands, device, scene, view, queues, p, computes_view);
        commands.run(device.pass("aov"),
                     surface_bindings(scene, view.frame,
                                      {{"rays", queues.level(0).rays},
                                       {"hits", queues.level(0).hits},
                                       {"aovs", aov_buffer},
                                       {"triangle_ids", scene.triangle_ids}}),
                     p, groups_for(p.capacity, 64));
    }
    commands.submit();
    const auto records = commands.download<AovSurface>(aov_buffer, pixels);
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovSurface& record : records) aovs.name.push_back(record.name);
    SURFACE_AOVS(AOV_STORE)
#undef AOV_STORE
}

/// The paper's Figure 7, in render targets.
void Renderer::Impl::render_ray_setup(Aovs& aovs) {
    const MemoryPart part(device, "images");
    const uint32_t pixels = settings.width * settings.height;
    RasterSetup setup;
    setup.colors.assign(4, VK_FORMAT_R32G32B32A32_SFLOAT);
    setup.depth = VK_COMPARE_OP_ALWAYS;
    std::vector<Image2D> images;
    DrawTargets targets;
    for (size_t i = 0; i < setup.colors.size(); i++)
        images.emplace_back(device, "mirror rays", settings.width, settings.height, setup.colors[i],
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                            VK_IMAGE_ASPECT_COLOR_BIT);
    for (const Image2D& image : images) targets.colors.push_back(&image);
    targets.width = settings.width;
    targets.height = settings.height;
    const Buffer stored(device, "mirror rays", uint64_t(pixels) * sizeof(AovRaySetup));
    const RaySetupParams p{box.lower, box.upper};
    const DrawRange whole{0, 1, 0, 1};
    const Binding bindings[] = {{"frame", view.frame}, {"aovs", aov_buffer}};
    commands.draw(device.raster_pass("ray_setup", setup), bindings, p, std::span(&whole, 1), targets);
    commands.run(device.pass("ray_setup_store"),
                 {{"frame", view.frame},
                  {"ray_setups", stored},
                  {"reflection", images[0]},
                  {"box_point", images[1]},
                  {"directions_xy", images[2]},
                  {"directions_z", images[3]}},
                 pixels, groups_for(pixels, 64));
    commands.submit();
    const auto records = commands.download<AovRaySetup>(stored, pixels);
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovRaySetup& record : records) aovs.name.push_back(record.name);
    RAY_SETUP_AOVS(AOV_STORE)
#undef AOV_STORE
}

/// The part of the program that what is uploaded is accounted for as.
static constexpr const char* kScenePart = "scene";

Renderer::Renderer(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                   const Environment& environment) {
    const MemoryPart part(device, kScenePart);
    impl_ = std::make_unique<Impl>(device, scene, moment, assembly, environment);
}

Renderer::~Renderer() = default;

void Renderer::pose(const Moment& moment) {
    const MemoryPart part(impl_->device, kScenePart);
    impl_->moment = moment;
    impl_->moved = impl_->scene.pose(impl_->commands, impl_->source, moment);
    impl_->maps_moved = true;
    impl_->build_fits = false;
    impl_->structures_moved |= impl_->moved > 0;
}

/// All but the times.
void Renderer::Impl::describe(RenderStats& stats) {
    stats.timed = device.timestamp_period() > 0;
    stats.redone = redone;
    stats.hit = hit;
    stats.choice = cubes->choice();
    stats.scene_bytes = scene.bytes();
    stats.frame_bytes =
        queues.bytes() + picture.bytes() + encoded.bytes() + view.visibility.bytes() + compute_view.bytes();
    stats.visibility = computes_view ? Visibility::compute : Visibility::raster;
    stats.tracer = settings.tracer;
    stats.moved = moved;
    if (settings.tracer == Tracer::cubemap) stats.maps = maps->stats();
    if (settings.tracer == Tracer::khr) {
        stats.structures = structures->stats();
        stats.update = settings.structures;
    }
    if (settings.tracer != Tracer::ldc) return;
    stats.counted = counter != nullptr;
    if (counter) stats.costs = counter->sums();
    stats.rebuilt = rebuilt;
    stats.cubes = cubes->stats();
    stats.bodies = cubes->cubes().download_bodies(commands);
    stats.shown.resize(stats.bodies.size());
    for (const Assembly::Instance& instance : assembly.instances) stats.shown[instance.body]++;
}

RenderResult Renderer::render(const RenderSettings& settings, const std::function<void(double)>& progress) {
    Impl& r = *impl_;
    const MemoryPart part(r.device, "frame");
    r.settings = settings;
    r.check_settings();
    r.commands.time_passes(settings.time_passes);
    r.redone = 0;
    const bool counts = settings.counters && settings.tracer == Tracer::ldc;
    if (counts != (r.counter != nullptr)) r.counter = counts ? std::make_unique<CostCounter>(r.device) : nullptr;
    r.prepare_images();
    r.prepare_cubes();
    r.prepare_structures();
    r.prepare_frame();

    RenderResult result;
    std::map<std::string, std::vector<double>> samples;
    std::vector<double> frames;
    const uint32_t repeat = std::max(settings.repeat, 1u);
    for (uint32_t i = 0; i < repeat; i++) {
        r.render_frame([&](double share) {
            if (progress) progress((i + share) / repeat);
        });
        // The first of several frames warms up: pipelines, memory, clocks.
        if (repeat > 1 && i == 0) continue;
        double build_ms = 0;
        for (const auto& row : r.times.rows()) {
            samples[row.name].push_back(row.ms);
            if (row.name.starts_with("build/")) build_ms += row.ms;
        }
        frames.push_back(r.frame_ms);
        result.stats.frames.push_back({r.frame_ms, build_ms});
    }
    RenderStats& stats = result.stats;
    for (const auto& row : r.times.rows()) {
        stats.passes.push_back({row.name, median(samples[row.name])});
        if (row.name.starts_with("build/")) stats.build_ms += stats.passes.back().ms;
        if (row.name.starts_with("probe/") || row.name.starts_with("shadow_map/"))
            stats.maps_ms += stats.passes.back().ms;
    }
    if (settings.tracer == Tracer::khr) r.structures_moved = false;
    stats.frame_ms = median(frames);
    result.rays = r.rays;
    r.describe(stats);
    result.width = settings.width;
    result.height = settings.height;
    const uint64_t pixels = uint64_t(settings.width) * settings.height;
    result.radiance = r.commands.download<glm::vec4>(r.picture, pixels);
    for (glm::vec4& pixel : result.radiance) pixel /= float(settings.spp);
    result.encoded = r.commands.download<uint32_t>(r.encoded, pixels);
    if (settings.aovs) r.render_aovs(result.aovs);
    if (settings.aovs && settings.ray_setup) r.render_ray_setup(result.aovs);
    if (r.counter) result.aovs.costs = r.counter->download_pixels(r.commands, pixels);
    stats.peak_bytes = r.device.peak_allocated();
    stats.memory = r.device.allocations();
    stats.peak_memory = r.device.peak_allocations();
    return result;
}

}  // namespace peelray
