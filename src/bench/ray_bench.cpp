#include "bench/ray_bench.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "bench/embree_contender.h"
#include "bench/khr_contender.h"
#include "bench/ldc_contender.h"
#include "workspace/posed_scene.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

/// Frames before those that are measured, beside the renderer's own first one.
constexpr uint32_t kFrameWarmUp = 2;

/// In the order of the rows' columns.
std::vector<RayKind> sorted(std::vector<RayKind> kinds) {
    std::sort(kinds.begin(), kinds.end());
    return kinds;
}

using Way = RayBench::Way;

}  // namespace

/// One scene, its rays for one picture size at a time, and its oracle.
class MeasuredScene {
  public:
    /// Throws Error where the scene cannot be loaded.
    MeasuredScene(Device& device, ClockProbe& probe, const BenchSceneChoice& choice, uint32_t repeat,
                  const Notes& notes);

    uint64_t triangles() const { return scene_.triangles(); }
    /// Makes the rays of the pictures that follow.
    void look(const glm::uvec2& size, const std::vector<RayKind>& kinds);
    /// Measures cubes; with a whole frame on demand. All of these throw Error, Interrupted.
    void measure_ours(const Way& way, bool frame, RayRow& row);
    void measure_khr(StructureUpdate update, bool frame, RayRow& row);
    void measure_embree(RayRow& row);

  private:
    void measure(RayContender& contender, uint32_t resolution, RayRow& row);
    void measure_frame(const RenderSettings& settings, RayRow& row);
    std::vector<Ray> started(const RayContender& contender, const std::vector<SurfaceRay>& set) const;
    RenderSettings settings_of_way(const Way& way) const;

    Device& device_;
    ClockProbe& probe_;
    BenchSceneChoice choice_;
    uint32_t repeat_;
    PosedScene scene_;
    Assembly assembly_;
    Oracle oracle_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<EmbreeContender> embree_;
    std::vector<RayKind> kinds_;
    RaySets sets_;
};

MeasuredScene::MeasuredScene(Device& device, ClockProbe& probe, const BenchSceneChoice& choice, uint32_t repeat,
                             const Notes& notes)
    : device_(device),
      probe_(probe),
      choice_(choice),
      repeat_(repeat),
      scene_(choice_.picture, notes),
      assembly_(scene_.assembly_of_moment()),
      oracle_(scene_.geometry(), AlphaTest(scene_.scene(), scene_.geometry())) {
    if (choice_.light) return;
    const std::vector<Light>& own = scene_.moment().lights;
    const std::vector<Light>& sky = scene_.environment().lights;
    if (!own.empty() || !sky.empty()) {
        choice_.light = own.empty() ? sky.front() : own.front();
        return;
    }
    choice_.light = Light{};
    choice_.light->direction = -default_sun_direction();
}

void MeasuredScene::look(const glm::uvec2& size, const std::vector<RayKind>& kinds) {
    choice_.picture.size = size;
    kinds_ = kinds;
    sets_ = {};
    sets_ = make_ray_sets(scene_.scene(), scene_.geometry(), oracle_,
                          {scene_.camera(), size.x, size.y, scene_.bounds(), *choice_.light}, kinds);
}

std::vector<Ray> MeasuredScene::started(const RayContender& contender, const std::vector<SurfaceRay>& set) const {
    std::vector<Ray> rays(set.size());
    parallel_for(set.size(), 8192, [&](size_t i) {
        const float offset = set[i].triangle == ~0u ? 0 : contender.start_offset(set[i].triangle);
        const StartedRay ray = leaving_ray(set[i], offset);
        rays[i] = {ray.origin, ray.tmin, ray.direction, ray.tmax};
    });
    return rays;
}

void MeasuredScene::measure(RayContender& contender, uint32_t resolution, RayRow& row) {
    row.resolution = contender.claim() == Claim::single ? 0 : resolution;
    row.build = contender.time_build(repeat_);
    row.refit = contender.time_refit(repeat_);
    for (const RayKind kind : kinds_) {
        const std::vector<SurfaceRay>& set = sets_[size_t(kind)];
        TracedSet traced{kind, set.size(), {}, {}, {}, {}};
        if (!set.empty()) {
            const std::vector<Ray> rays = started(contender, set);
            contender.take(rays);
            traced.time = contender.time_trace(is_any_hit(kind), repeat_);
            traced.way = contender.way();
            traced.judged =
                judge(oracle_, scene_.geometry(), contender, resolution, rays, contender.answers(), is_any_hit(kind));
            traced.costs = contender.costs(is_any_hit(kind));
        }
        row.sets.push_back(traced);
    }
    row.memory = contender.memory();
}

RenderSettings MeasuredScene::settings_of_way(const Way& way) const {
    PictureArguments picture = choice_.picture;
    picture.tracing.hit = way.hit;
    picture.tracing.traversal = way.traversal;
    picture.tracing.ldc = way.ldc;
    picture.rebuild = true;
    RenderSettings settings = render_settings(picture);
    settings.camera = scene_.camera();
    settings.bounds = scene_.bounds();
    return settings;
}

void MeasuredScene::measure_ours(const Way& way, bool frame, RayRow& row) {
    const RenderSettings settings = settings_of_way(way);
    {
        LdcContender cubes(device_, probe_, scene_.scene(), scene_.moment(), assembly_,
                           choose_automatically(uint32_t(scene_.triangles()), settings));
        measure(cubes, cubes.stats().resolution, row);
    }
    if (!frame) return;
    try {
        measure_frame(settings, row);
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        row.frame_left_out = error.text();
        renderer_.reset();
    }
}

void MeasuredScene::measure_frame(const RenderSettings& settings, RayRow& row) {
    if (!renderer_)
        renderer_ =
            std::make_unique<Renderer>(device_, scene_.scene(), scene_.moment(), assembly_, scene_.environment());
    RenderSettings repeated = settings;
    repeated.repeat = repeat_ + kFrameWarmUp + 1;  // the renderer leaves out the first itself
    repeated.time_passes = false;
    probe_.warm_up();
    const RenderResult result = renderer_->render(repeated, [](double) { check_interrupt(); });
    std::vector<double> ms;
    for (const RenderStats::FrameTime& time : result.stats.frames) ms.push_back(time.frame_ms);
    ms.erase(ms.begin(), ms.end() - repeat_);
    row.frame = timing_of(std::move(ms));
    row.frame.clock = probe_.clock();
}

/// `update`: of structures that are built in every frame, or never again.
void MeasuredScene::measure_khr(StructureUpdate update, bool frame, RayRow& row) {
    {
        KhrContender structures(device_, probe_, scene_.scene(), scene_.moment(), assembly_, update);
        measure(structures, 0, row);
    }
    if (!frame) return;
    RenderSettings settings = settings_of_way({HitTest::exact, Traversal::voxel, std::nullopt});
    settings.tracer = Tracer::khr;
    settings.structures = update;
    settings.rebuild = update != StructureUpdate::keep;
    measure_frame(settings, row);
}

void MeasuredScene::measure_embree(RayRow& row) {
    if (!embree_) embree_ = std::make_unique<EmbreeContender>(scene_.geometry());
    measure(*embree_, 0, row);
}

/// Rivals of each scene: the device's own ray tracing, rebuilt and static, and Embree.
static constexpr size_t kRivals = 3;

RayBench::RayBench(const BenchSettings& settings, Notes notes)
    : settings_(settings),
      notes_(std::move(notes)),
      kinds_(sorted(settings.rays)),
      device_(device_options(settings.device)) {
    check_timestamps(device_);
    // Of planar hits, auto is too fine for a software device in a hurry.
    if (settings.quick)
        ways_ = {{HitTest::exact, Traversal::voxel, std::nullopt}, {HitTest::planar, Traversal::voxel, 256}};
    for (const HitTest hit : settings.hits)
        for (const Traversal traversal : settings.traversals)
            for (const auto& ldc : settings.ldc)
                if (!settings.quick) ways_.push_back({hit, traversal, ldc});
    for (const HitTest hit : settings.hits) series_ways_.push_back({hit, Traversal::voxel, std::nullopt});
}

size_t RayBench::rows() const {
    return settings_.scenes.size() * (ways_.size() + kRivals) + series_sizes().size() * (series_ways_.size() + kRivals);
}

/// The blob nearest to 300,000 triangles, by ratio; empty: there is no blob.
std::string RayBench::series_scene() const {
    std::string best;
    double least = INFINITY;
    for (const std::string& name : settings_.scenes) {
        const size_t at = name.rfind("blob:");
        if (at == std::string::npos) continue;
        const double off = std::abs(std::log(std::atof(name.c_str() + at + 5) / 3e5));
        if (off < least) least = off, best = name;
    }
    return best;
}

std::vector<glm::uvec2> RayBench::series_sizes() const {
    return settings_.sizes && !series_scene().empty() ? *settings_.sizes : std::vector<glm::uvec2>();
}

/// Does a part of the work; why it cannot be done, empty if it was. Throws Interrupted.
static std::string reason_against(const std::function<void()>& work) {
    try {
        work();
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        return error.text();
    } catch (const std::bad_alloc&) {
        return "out of memory: the scene or its rays are too large for this machine";
    }
    return "";
}

/// Measures a row; what cannot be done is left out with the reason.
void RayBench::measure(RayRow row, const Measure& measure) {
    check_interrupt();
    if (row.left_out.empty()) row.left_out = reason_against([&] { measure(row); });
    device_.check_validation();
    add_(row);
    progress_(double(++done_));
}

void RayBench::measure_ways(MeasuredScene& scene, const RayRow& row, const std::vector<Way>& ways) {
    for (const Way& way : ways) {
        RayRow ours = row;
        ours.contender = name_of(way.hit);
        ours.hit = way.hit;
        ours.traversal = way.traversal;
        ours.ldc = way.ldc;
        measure(ours, [&](RayRow& r) { scene.measure_ours(way, !row.series, r); });
    }
    for (const StructureUpdate update : {StructureUpdate::rebuild, StructureUpdate::keep}) {
        RayRow khr = row;
        khr.contender = update == StructureUpdate::keep ? "khr static" : "khr";
        measure(khr, [&](RayRow& r) { scene.measure_khr(update, !row.series, r); });
    }
    RayRow embree = row;
    embree.contender = "Embree";
    measure(embree, [&](RayRow& r) { scene.measure_embree(r); });
}

void RayBench::measure_scene(const std::string& name) {
    const BenchSceneChoice choice = choose_bench_scene(name, settings_);
    if (choice.stands_in)
        note(notes_, fmt::format("{}: its file is missing: {} stands in ({})", name, choice.shown, Setting{"models"}));
    RayRow row;
    row.scene = name;
    row.shown = choice.shown;
    row.stands_in = choice.stands_in;
    row.size = settings_.size;
    std::optional<MeasuredScene> scene;
    const auto look = [&](const glm::uvec2& size, const std::vector<RayKind>& kinds) {
        row.size = size;
        row.left_out = reason_against([&] {
            if (!scene) scene.emplace(device_, probe_, choice, settings_.repeat, notes_);
            row.triangles = scene->triangles();
            scene->look(size, kinds);
        });
        return row.left_out.empty();
    };
    const auto measure_all = [&](const std::vector<Way>& ways) {
        if (scene) return measure_ways(*scene, row, ways);
        row.contender = "all";
        measure(row, {});
    };
    look(settings_.size, kinds_);
    measure_all(ways_);
    if (!scene || name != series_scene()) return;
    row.series = true;
    for (const glm::uvec2& size : series_sizes()) {
        look(size, {RayKind::mirror});
        measure_all(series_ways_);
    }
}

void RayBench::run(const std::function<void(const RayRow&)>& add, const RowProgress& progress) {
    add_ = add;
    progress_ = progress;
    for (const std::string& scene : settings_.scenes) measure_scene(scene);
}

}  // namespace peelray
