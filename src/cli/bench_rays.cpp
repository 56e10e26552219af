// `peelray bench`: the same rays through our cubes and their rivals, and whole frames.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "bench/embree_contender.h"
#include "bench/khr_contender.h"
#include "bench/ldc_contender.h"
#include "cli/bench.h"
#include "cli/bench_plots.h"
#include "cli/bench_rows.h"
#include "cli/bench_scenes.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "cli/version.h"
#include "workspace/posed_scene.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

/// Frames before those that are measured, beside the renderer's own first one.
constexpr uint32_t kFrameWarmUp = 2;

/// In the order of the rows' columns.
std::vector<RayKind> sorted(std::vector<RayKind> kinds) {
    std::sort(kinds.begin(), kinds.end());
    return kinds;
}

/// One way of ours to build and trace.
struct Way {
    HitTest hit;
    Traversal traversal;
    std::optional<uint32_t> ldc;
};

/// One scene, its rays for one picture size at a time, and its oracle.
class MeasuredScene {
  public:
    /// Throws Error where the scene cannot be had.
    MeasuredScene(Device& device, ClockProbe& probe, const BenchSceneChoice& choice, uint32_t repeat);

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

MeasuredScene::MeasuredScene(Device& device, ClockProbe& probe, const BenchSceneChoice& choice, uint32_t repeat)
    : device_(device),
      probe_(probe),
      choice_(choice),
      repeat_(repeat),
      scene_(choice_.picture, print_note),
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
        TracedSet traced{kind, set.size(), {}, {}, {}};
        if (!set.empty()) {
            const std::vector<Ray> rays = started(contender, set);
            contender.take(rays);
            traced.time = contender.time_trace(is_any_hit(kind), repeat_);
            traced.way = contender.way();
            traced.judged =
                judge(oracle_, scene_.geometry(), contender, resolution, rays, contender.answers(), is_any_hit(kind));
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
                           choose_automatically(device_, uint32_t(scene_.triangles()), settings));
        measure(cubes, cubes.stats().resolution, row);
    }
    if (!frame) return;
    try {
        measure_frame(settings, row);
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        row.frame_left_out = message_of(error);
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

/// A run of `bench`.
class RayBench {
  public:
    explicit RayBench(const BenchArguments& a)
        : a_(a), kinds_(sorted(a.rays)), device_(DeviceOptions{a.device.device, a.device.validate}) {
        check_timestamps(device_);
        // Of planar hits, auto is too fine for a software device in a hurry.
        if (a.quick)
            ways_ = {{HitTest::exact, Traversal::voxel, std::nullopt}, {HitTest::planar, Traversal::voxel, 256}};
        for (const HitTest hit : a.hits)
            for (const Traversal traversal : a.traversals)
                for (const auto& ldc : a.ldc)
                    if (!a.quick) ways_.push_back({hit, traversal, ldc});
        for (const HitTest hit : a.hits) series_ways_.push_back({hit, Traversal::voxel, std::nullopt});
        for (const std::string& scene : a.scenes) rows_in_all_ += ways_.size() + rivals(scene);
        if (!series_sizes().empty()) rows_in_all_ += (series_ways_.size() + 3) * series_sizes().size();
    }

    void run();

  private:
    static size_t rivals(const std::string&) { return 3; }
    std::vector<glm::uvec2> series_sizes() const;
    std::string series_scene() const;
    void measure_scene(const std::string& name, Progress& bar);
    void measure_looks(MeasuredScene& scene, const RayRow& row, const std::vector<Way>& ways, Progress& bar);
    void add(RayRow row, const std::function<void(RayRow&)>& measure, Progress& bar);
    void say(const std::string& text);
    void write(bool complete);
    void end(bool complete);

    const BenchArguments& a_;
    std::vector<RayKind> kinds_;
    Device device_;
    ClockProbe probe_{device_};
    std::vector<Way> ways_, series_ways_;
    std::vector<RayRow> rows_;
    Json json_rows_ = Json::array();
    size_t rows_in_all_ = 0, measured_ = 0;
    bool ended_ = false;  ///< the text has its foot
    std::string text_, reason_;
};

void RayBench::say(const std::string& text) {
    text_ += text;
    fmt::print("{}", text);
    std::fflush(stdout);
}

/// The blob nearest to 300,000 triangles, by ratio; empty: there is no blob.
std::string RayBench::series_scene() const {
    std::string best;
    double least = INFINITY;
    for (const std::string& name : a_.scenes) {
        const size_t at = name.rfind("blob:");
        if (at == std::string::npos) continue;
        const double off = std::abs(std::log(std::atof(name.c_str() + at + 5) / 3e5));
        if (off < least) least = off, best = name;
    }
    return best;
}

std::vector<glm::uvec2> RayBench::series_sizes() const {
    return a_.sizes && !series_scene().empty() ? *a_.sizes : std::vector<glm::uvec2>();
}

void RayBench::write(bool complete) {
    if (!a_.output.empty()) {
        Json json = {{"benchmark", "rays"}};
        json.update(machine_json(machine_of(device_)));
        json["cpu_threads"] = std::thread::hardware_concurrency();
        json["embree"] = EmbreeContender::version();
        json["image"] = {a_.size.x, a_.size.y};
        json["repeat"] = a_.repeat;
        for (const RayKind kind : a_.rays) json["rays"].push_back(name_of(kind));
        json["complete"] = complete;
        json["rows"] = json_rows_;
        write_json(a_.output, json);
    }
    if (!a_.markdown.empty()) write_text(a_.markdown, text_ + (ended_ ? "" : ray_table_foot()));
}

/// Does a part of the work; why it cannot be done, empty if it was. Throws Interrupted.
std::string reason_against(const std::function<void()>& work) {
    try {
        work();
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        return message_of(error);
    } catch (const std::bad_alloc&) {
        return "out of memory: the scene or its rays are too large for this machine";
    }
    return "";
}

/// Measures a row; what cannot be done is left out with the reason. What there is goes to the files at once.
void RayBench::add(RayRow row, const std::function<void(RayRow&)>& measure, Progress& bar) {
    check_interrupt();
    if (row.left_out.empty()) {
        row.left_out = reason_against([&] { measure(row); });
        if (row.left_out.empty()) measured_++;
    }
    device_.check_validation();
    if (reason_.empty()) reason_ = row.left_out;
    json_rows_.push_back(ray_row_json(row));
    say(ray_table_row(row, kinds_));
    rows_.push_back(std::move(row));
    write(false);
    bar.update(double(rows_.size()));
}

void RayBench::measure_looks(MeasuredScene& scene, const RayRow& row, const std::vector<Way>& ways, Progress& bar) {
    for (const Way& way : ways) {
        RayRow ours = row;
        ours.contender = name_of(way.hit);
        ours.traversal = name_of(way.traversal);
        ours.ldc = way.ldc;
        add(
            ours, [&](RayRow& r) { scene.measure_ours(way, !row.series, r); }, bar);
    }
    for (const StructureUpdate update : {StructureUpdate::rebuild, StructureUpdate::keep}) {
        RayRow khr = row;
        khr.contender = update == StructureUpdate::keep ? "khr static" : "khr";
        add(
            khr, [&](RayRow& r) { scene.measure_khr(update, !row.series, r); }, bar);
    }
    RayRow embree = row;
    embree.contender = "Embree";
    add(
        embree, [&](RayRow& r) { scene.measure_embree(r); }, bar);
}

void RayBench::measure_scene(const std::string& name, Progress& bar) {
    const BenchSceneChoice choice = choose_bench_scene(name, a_);
    if (choice.stands_in)
        print_note(fmt::format("{}: its file is missing: {} stands in (--models)", name, choice.shown));
    RayRow row;
    row.scene = name;
    row.shown = choice.shown;
    row.stands_in = choice.stands_in;
    row.size = a_.size;
    std::optional<MeasuredScene> scene;
    const auto look = [&](const glm::uvec2& size, const std::vector<RayKind>& kinds) {
        row.size = size;
        row.left_out = reason_against([&] {
            if (!scene) scene.emplace(device_, probe_, choice, a_.repeat);
            row.triangles = scene->triangles();
            scene->look(size, kinds);
        });
        return row.left_out.empty();
    };
    const auto measure = [&](const std::vector<Way>& ways) {
        if (scene) return measure_looks(*scene, row, ways, bar);
        row.contender = "all";
        add(row, {}, bar);
    };
    look(a_.size, kinds_);
    measure(ways_);
    if (!scene || name != series_scene()) return;
    row.series = true;
    for (const glm::uvec2& size : series_sizes()) {
        look(size, {RayKind::mirror});
        measure(series_ways_);
    }
}

/// What stands behind the rows.
void RayBench::end(bool complete) {
    say(ray_table_foot());
    say(ratio_table(rows_, kinds_));
    ended_ = true;
    write(complete);
    if (!a_.plots.empty()) write_plots(a_.plots, rows_);
}

void RayBench::run() {
    const Machine device = machine_of(device_);
    say(fmt::format("{}, driver {}, Vulkan {}, commit {}; {} on {} CPU threads; {} runs each\n\n{}", device.name,
                    device.driver, device.api_version, build_commit(), EmbreeContender::version(),
                    std::thread::hardware_concurrency(), a_.repeat, ray_table_head(kinds_)));
    Progress bar("measuring", double(rows_in_all_), "rows");
    try {
        for (const std::string& scene : a_.scenes) measure_scene(scene, bar);
    } catch (const Interrupted&) {
        end(false);
        fail("interrupted after {} rows{}", rows_.size(),
             a_.output.empty() ? "" : fmt::format(", which {} holds", a_.output.string()));
    }
    end(true);
    if (measured_ == 0) fail("none of the {} rows could be measured: {}", rows_.size(), reason_);
}

}  // namespace

void run_ray_bench(const BenchArguments& a) {
    RayBench(a).run();
}

}  // namespace peelray
