#include "reference/picture_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "reference/moment_before.h"
#include "reference/optics.h"
#include "reference/photon_flight.h"
#include "reference/sample_sums.h"
#include "reference/shader.h"

namespace peelray::inline PRECISION {
namespace {

constexpr uint32_t tile_size = 16;

/// Tiles of a picture, handed out to threads.
struct Tiles {
    uint32_t columns, rows;
    std::atomic<uint32_t> next{0};
    std::atomic<bool> stop{false};

    explicit Tiles(const PictureSettings& s)
        : columns((s.width + tile_size - 1) / tile_size), rows((s.height + tile_size - 1) / tile_size) {}
    uint32_t count() const { return columns * rows; }
};

/// What all rays of a pixel have in common.
Shader::Path pixel_path(const View& view, const RenderContext& context, uint32_t x, uint32_t y) {
    const PictureSettings& s = context.settings;
    Shader::Path path;
    // A pixel's share of the picture, or a sample's of the pixel.
    const real across = 2 * glm::length(Vec3(view.up)) / s.height / std::sqrt(real(s.spp));
    path.cone = view.orthographic ? Cone{across, 0} : Cone{0, across};
    path.seed = path_seed(x, y);
    path.media = context.start;
    path.guided = is_denoised(s);
    return path;
}

/// Through a sample's place in a pixel.
Ray camera_ray(const View& view, const PictureSettings& s, uint32_t x, uint32_t y, const glm::vec2& sample) {
    const Vec2 p = Vec2(x, y) + Vec2(sample);
    const Vec3 offset = Vec3(view.right) * (2 * p.x / s.width - 1) + Vec3(view.up) * (1 - 2 * p.y / s.height);
    return {Vec3(view.eye) + (view.orthographic ? offset : Vec3(0)), 0,
            glm::normalize(Vec3(view.forward) + (view.orthographic ? Vec3(0) : offset)), endless};
}

/// What the camera sees through, now and, for Aovs::motion and Denoise::temporal, at the moment before.
struct Views {
    View now;
    std::optional<MomentBefore> before;
};

void prepare_aovs(Picture& picture, const PictureSettings& s) {
    const size_t pixels = size_t(s.width) * s.height;
    picture.transparent = s.backdrop.is_transparent();
    if (!s.aovs) return;
#define AOV_NOTHING(name, type, channels, nothing) picture.aovs.name.assign(pixels, type(nothing));
    SURFACE_AOVS(AOV_NOTHING)
    RAY_SETUP_AOVS(AOV_NOTHING)
#undef AOV_NOTHING
}

/// Does any triangle have such a material?
template <typename Is>
bool has_material(const Geometry& geometry, Is is) {
    return std::ranges::any_of(geometry.materials, is);
}

/// Some samples of each pixel, which are to be added to a picture.
struct Work {
    Picture& picture;
    SampleSums& sums;
    uint32_t first_sample, end_sample;
};

}  // namespace

struct PictureTracer : PathTracer::Impl {
    const Geometry& geometry;
    Intersections triangles;
    Surfaces surfaces;
    Albedos albedos;
    Surroundings surroundings;
    Lamps lamps;
    MediaRanks media;
    bool has_blended, has_unlit;
    const Scene& scene;
    const Environment& environment;
    EmitterList emitters;
    Moment placed;  ///< only what MediaPieces reads

    PictureTracer(const Scene& scene, const Moment& moment, const Geometry& geometry, const Environment& environment,
                  std::span<const Emitter> emitters)
        : geometry(geometry),
          triangles(scene, geometry),
          surfaces(scene, geometry),
          albedos(scene, surfaces),
          surroundings(environment),
          lamps(lamps_of(moment.lights, environment.lights)),
          media(media_ranks(scene)),
          has_blended(has_material(geometry, [&](uint32_t i) { return scene.materials[i].blended; })),
          has_unlit(has_material(geometry, [&](uint32_t i) { return scene.materials[i].unlit; })),
          scene(scene),
          environment(environment),
          emitters(emitters, geometry.triangles.size()) {
        placed.worlds = moment.worlds;
    }

    /// What the rays of a camera start in; those of an orthographic one have no one start, and start in air.
    Media media_around(const Camera& camera) const {
        Media start;
        if (camera.orthographic_height > 0) return start;
        for (const uint32_t material : MediaPieces(scene).around(scene, placed, camera.eye)) start.enter(material);
        return start;
    }
    /// Where directions to an image's light are drawn, no light needs to stand for its brightest spot.
    bool draws_image(const PictureSettings& s) const {
        return s.env_mode == EnvironmentMode::sampled && environment.is_image;
    }
    std::span<const Light> lights_for(const PictureSettings& s) const {
        return std::span(lamps.lights).first(lamps.lights.size() - (draws_image(s) ? environment.lights.size() : 0));
    }
    real rough_limit_for(const PictureSettings& s) const {
        return draws_image(s) ? endless : real(environment.rough_limit);
    }
    Views views(const PictureSettings& s, const Box& box) const;
    void aovs(Picture& picture, size_t at, const Shader::Path& path, const Hit& hit, const Box& box) const;
    void pixel(const Work& work, const RenderContext& context, const Views& views, uint32_t x, uint32_t y,
               RayCounts& rays) const;
    RayCounts work(const Work& work, const RenderContext& context, const Views& views, Tiles& tiles,
                   const std::function<void(double)>& progress) const;
    void pass(const Work& work, const RenderContext& context, const Views& views,
              const std::function<void(double)>& progress, unsigned threads) const;
    void caustic_pass(const Work& work, RenderContext context, const PhotonPlan& plan, const Views& views,
                      const std::function<void(double)>& progress, unsigned threads) const;
    Picture render(const PictureSettings& settings, const PictureWatch& watch, unsigned threads,
                   PastPictures* past) const override;
};

Views PictureTracer::views(const PictureSettings& s, const Box& box) const {
    const float aspect = float(s.width) / float(s.height);
    Views views{make_view(s.camera, aspect, box.lower, box.upper), {}};
    if ((s.aovs && s.motion) || is_temporal(s))
        views.before.emplace(geometry, s.moment_before ? flatten(scene, *s.moment_before) : geometry, views.now,
                             make_view(s.camera_before, aspect, box.lower, box.upper), s);
    return views;
}

void PictureTracer::aovs(Picture& picture, size_t at, const Shader::Path& path, const Hit& hit, const Box& box) const {
    const Surface s = surfaces.at(hit.triangle, hit.u, hit.v, path.direction, path.cone.width_at(hit.t));
    Aovs& a = picture.aovs;
    a.depth[at] = float(hit.t);
    a.triangle[at] = float(hit.triangle);
    a.instance[at] = float(object_of(geometry, hit.triangle));
    a.material[at] = float(s.material);
    a.normal[at] = glm::vec4(s.normal, 0);
    a.albedo[at] = glm::vec4(s.optics.base_color, 1);
    a.position[at] = glm::vec4(s.position, 1);
    const Vec3 d = glm::reflect(glm::normalize(path.direction), s.normal);
    real t = endless;
    for (int k = 0; k < 3; k++)
        if (d[k] != 0) t = std::min(t, ((d[k] > 0 ? box.upper : box.lower)[k] - s.position[k]) / d[k]);
    a.reflection[at] = glm::vec4(d, 1);
    a.box[at] = glm::vec4(s.position + std::max(t, 0.0) * d, 1);
    a.directions[at] = glm::mat2x4(d.y, d.z, d.z, d.x, d.x, d.y, 0, 0);
}

void PictureTracer::pixel(const Work& work, const RenderContext& context, const Views& views, uint32_t x, uint32_t y,
                          RayCounts& rays) const {
    const PictureSettings& s = context.settings;
    Picture& picture = work.picture;
    const size_t at = size_t(y) * s.width + x;
    const uint32_t sample_bits = PixelSample::bits_for(s.spp);
    Shader::Path path = pixel_path(views.now, context, x, y);
    Shader shader(context, {0, sample_bits, s.seed});
    std::array<Ray, Intersections::together> cameras;
    std::array<Hit, Intersections::together> hits;
    for (uint32_t sample = work.first_sample; sample < work.end_sample; sample++) {
        const size_t of_packet = (sample - work.first_sample) % cameras.size();
        if (of_packet == 0) {
            const size_t count = std::min<size_t>(cameras.size(), work.end_sample - sample);
            for (size_t i = 0; i < count; i++)
                cameras[i] = camera_ray(views.now, s, x, y, sample_position(sample + uint32_t(i)));
            triangles.nearest(std::span(cameras).first(count), std::span(hits).first(count));
        }
        path.origin = cameras[of_packet].origin;
        path.direction = cameras[of_packet].direction;
        shader.begin({sample, sample_bits, s.seed});
        const Meeting meeting = shader.hit(path, &hits[of_packet]);
        const Hit& hit = meeting.hit;
        const Vec3 radiance = shader.radiance(path, meeting);
        const real alpha =
            s.backdrop.is_transparent() ? 1 - std::min(shader.through(), 1.0) : hit.hit() && !shader.catches();
        work.sums.add(at, sample, Vec4(radiance, alpha), shader.unlit());
        if (path.guided) work.sums.add_guide(at, sample, shader.guide(), shader.guide_motion());
        if (s.aovs && sample == 0 && hit.hit()) {
            const Hit& first = hits[of_packet];
            aovs(picture, at, path, first, context.box);
            if (s.motion) picture.aovs.motion[at] = views.before->motion({first.triangle, first.u, first.v});
        }
    }
    rays += shader.rays();
}

/// One thread's share: tiles until there are none left.
RayCounts PictureTracer::work(const Work& work, const RenderContext& context, const Views& views, Tiles& tiles,
                              const std::function<void(double)>& progress) const {
    RayCounts rays;
    for (uint32_t tile; !tiles.stop && (tile = tiles.next++) < tiles.count();) {
        const uint32_t left = tile % tiles.columns * tile_size, top = tile / tiles.columns * tile_size;
        const uint32_t width = context.settings.width, height = context.settings.height;
        // Reports come once per row: at thousands of samples per pixel a whole tile would keep an interrupt waiting.
        for (uint32_t row = 0; row < std::min(tile_size, height - top) && !tiles.stop; row++) {
            for (uint32_t x = left; x < std::min(left + tile_size, width); x++)
                pixel(work, context, views, x, top + row, rays);
            if (progress) progress((tile + row / real(tile_size)) / tiles.count());
        }
    }
    return rays;
}

/// All tiles on all cores, or on `threads` of them.
void PictureTracer::pass(const Work& work, const RenderContext& context, const Views& views,
                         const std::function<void(double)>& progress, unsigned threads) const {
    Tiles tiles(context.settings);
    std::mutex mutex;
    std::exception_ptr failure;
    const auto guarded = [&](const auto& body) {
        try {
            body();
        } catch (...) {
            tiles.stop = true;
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    };
    const auto share = [&](const std::function<void(double)>& report) {
        const RayCounts rays = this->work(work, context, views, tiles, report);
        const std::lock_guard lock(mutex);
        work.picture.rays += rays;
    };
    std::vector<std::thread> others;
    std::atomic<unsigned> done{0};
    const unsigned cores = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
    try {
        for (unsigned i = 1; i < cores; i++)
            others.emplace_back([&] {
                guarded([&] { share(nullptr); });
                done++;
            });
    } catch (const std::system_error&) {
        // No more threads can be started: those that run do the work.
    }
    guarded([&] { share(progress); });
    // The others' last tiles may take long: whoever listens for interrupts goes on listening.
    while (progress && !tiles.stop && done < others.size()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        guarded([&] { progress(1); });
    }
    for (std::thread& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}

/// Sample by sample, each with photons of its own.
void PictureTracer::caustic_pass(const Work& work, RenderContext context, const PhotonPlan& plan, const Views& views,
                                 const std::function<void(double)>& progress, unsigned threads) const {
    RenderContext flying = context;
    flying.is_photon = true;
    context.glass_is_opaque = plan.through_glass;
    const uint32_t samples = work.end_sample - work.first_sample;
    for (uint32_t sample = work.first_sample; sample < work.end_sample; sample++) {
        const PhotonPass photons = photon_pass(plan, context.settings, sample);
        const PhotonTree tree(fly_photons(flying, plan, photons), real(photons.radius));
        context.photons = &tree;
        work.picture.rays.photons += plan.photons;
        work.picture.rays.photons_kept += tree.size();
        std::function<void(double)> report;
        if (progress) report = [&](double share) { progress((sample - work.first_sample + share) / samples); };
        pass({work.picture, work.sums, sample, sample + 1}, context, views, report, threads);
    }
}

Picture PictureTracer::render(const PictureSettings& settings, const PictureWatch& watch, unsigned threads,
                              PastPictures* past) const {
    assert(settings.env_mode != EnvironmentMode::filtered || environment.filtered.levels > 0);
    assert(settings.env_mode != EnvironmentMode::sampled || !environment.distribution.quads.empty());
    const Box box = settings.bounds.value_or(Box{geometry.lower, geometry.upper});
    const Views seen = views(settings, box);
    const RenderContext context{triangles,
                                surfaces,
                                albedos,
                                surroundings,
                                lights_for(settings),
                                lamps,
                                lamps.lights,
                                emitters,
                                rough_limit_for(settings),
                                media,
                                settings,
                                box,
                                media_around(settings.camera),
                                has_blended,
                                bounce_levels(settings, has_blended),
                                last_level(settings, has_blended),
                                is_temporal(settings) ? &*seen.before : nullptr};
    PhotonPlan plan;
    if (settings.caustics > 0) plan = plan_photons(scene, geometry, context.lights, settings);
    Picture picture;
    prepare_aovs(picture, settings);
    SampleSums sums(settings, has_unlit, past);
    Passes passes(settings, watch);
    std::function<void(double)> progress;
    if (watch.progress) progress = [&](double of_pass) { watch.progress(passes.share(of_pass)); };
    const auto look = [&] {
        Picture so_far;
        sums.store(so_far, passes.done(), false);
        return so_far;
    };
    while (passes.next() > 0) {
        const Work work{picture, sums, passes.done(), passes.end_of_pass()};
        if (plan.empty())
            pass(work, context, seen, progress, threads);
        else
            caustic_pass(work, context, plan, seen, progress, threads);
        passes.finish([&] { return sums.noise(passes.done()); }, look);
    }
    sums.store(picture, passes.done(), true);
    picture.samples = passes.made();
    picture.rays.primary = uint64_t(settings.width) * settings.height * picture.samples.count;
    return picture;
}

std::unique_ptr<PathTracer::Impl> make_picture_tracer(const Scene& scene, const Moment& moment,
                                                      const Geometry& geometry, const Environment& environment,
                                                      std::span<const Emitter> emitters) {
    return std::make_unique<PictureTracer>(scene, moment, geometry, environment, emitters);
}

}  // namespace peelray::inline PRECISION
