#include "bench/paper_bench.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "bench/clock_probe.h"
#include "motion/animation.h"
#include "workspace/render_settings.h"
#include "workspace/workspace.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

/// The paper's system and ours; where a list was given, or --all, everything.
std::vector<PaperBench::Combination> choose_combinations(const BenchSettings& a) {
    if (!a.all && a.builders.empty() && a.traversals.empty() && a.hits.empty())
        return {{BuilderKind::peel, Traversal::two_level, HitTest::tolerance},
                {BuilderKind::compute, Traversal::voxel, HitTest::exact},
                {BuilderKind::compute, Traversal::voxel, HitTest::planar}};
    // All: from the paper's system to ours.
    const auto chosen = []<typename Value>(const std::vector<Value>& list) {
        const std::vector<Value> all = values_of<Value>();
        return list.empty() ? std::vector<Value>(all.rbegin(), all.rend()) : list;
    };
    std::vector<PaperBench::Combination> combinations;
    for (const BuilderKind builder : chosen(a.builders))
        for (const Traversal traversal : chosen(a.traversals))
            for (const HitTest hit : chosen(a.hits)) combinations.push_back({builder, traversal, hit});
    return combinations;
}

std::vector<const PaperScene*> choose_scenes(const BenchSettings& a) {
    std::vector<const PaperScene*> scenes;
    for (const PaperScene& scene : paper_scenes())
        if (a.scenes.empty() || std::find(a.scenes.begin(), a.scenes.end(), scene.name) != a.scenes.end())
            scenes.push_back(&scene);
    return scenes;
}

/// The depth complexity of a scene's LDIs: the samples of the fullest pixel of all. None: the stats count lists of
/// voxels, which is another thing.
std::optional<uint32_t> depth_complexity(const RenderStats& stats) {
    if (!stats.choice.layout.by_pixel()) return std::nullopt;
    return stats.cubes.counts.longest;
}

/// Frames that come before those that are measured, beside the renderer's own first one: a GPU that was idle needs some
/// to raise its clock.
constexpr uint32_t kWarmUp = 4;
/// The same where every moment of an animation is measured by itself.
constexpr uint32_t kWarmUpOfMoment = 2;

float longest_side(const Box& box) {
    const glm::vec3 size = box.upper - box.lower;
    return std::max({size.x, size.y, size.z});
}

/// Times and the last frame's stats of what was measured.
void summarise(const std::vector<MadePicture>& pictures, PaperRow& row) {
    std::vector<double> a, b, frame;
    std::vector<std::pair<std::string, std::vector<double>>> passes;
    for (const MadePicture& picture : pictures) {
        for (const RenderStats::FrameTime& time : picture.stats.render.frames) {
            a.push_back(time.build_ms);
            b.push_back(time.frame_ms - time.build_ms);
            frame.push_back(time.frame_ms);
        }
        for (const PassTime& pass : picture.stats.render.passes) {
            auto found =
                std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.first == pass.name; });
            if (found == passes.end()) found = passes.insert(passes.end(), {pass.name, {}});
            found->second.push_back(pass.ms);
        }
    }
    row.a = timing_of(a);
    row.b = timing_of(b);
    row.frame = timing_of(frame);
    for (const auto& [name, ms] : passes) row.passes.push_back({name, timing_of(ms).median});
    row.stats = pictures.back().stats;
}

/// The box of what a built-in scene is about: the object of most triangles.
Box largest_object(const Geometry& geometry) {
    const auto object = std::max_element(geometry.objects.begin(), geometry.objects.end(),
                                         [](const auto& a, const auto& b) { return a.count < b.count; });
    Box box;
    for (uint32_t i = object->first; i < object->first + object->count; i++)
        for (int k = 0; k < 3; k++) box.add(geometry.positions[geometry.triangles[i][k]]);
    return box;
}

/// One scene of the table, ready to be measured.
class BenchScene {
  public:
    /// Throws Error where the scene cannot be had.
    BenchScene(const PaperScene& scene, const BenchSettings& a, const std::optional<fs::path>& file,
               const Notes& notes);

    uint64_t triangles() const { return workspace_->scene().triangles(); }
    double tolerance() const { return tolerance_; }
    /// Fills in what was measured. Throws Error where that cannot be done, Interrupted.
    void measure(PaperRow& row, const std::function<void(double)>& progress);
    /// After an Error: what follows gets a device that is as new. Throws Error if the validation layers said anything,
    /// which must not be passed over.
    void recover();

  private:
    std::vector<MadePicture> render(const RenderSettings& settings, const std::function<void(double)>& progress);
    uint32_t object_pixels(const std::vector<LdcBody>& bodies) const;
    MadePicture make(RenderSettings settings, uint32_t warm_up, const Shot& shot,
                     const std::function<void(double)>& progress);

    PictureArguments arguments_;
    std::optional<Workspace> workspace_;
    bool rendered_ = false;  ///< something has been rendered since the last look
    double tolerance_ = 0, duration_ = 0;
    float object_side_ = 0;  ///< longest, of what stands on the floor
    uint32_t repeat_;
};

BenchScene::BenchScene(const PaperScene& scene, const BenchSettings& a, const std::optional<fs::path>& file,
                       const Notes& notes)
    : repeat_(a.repeat) {
    PictureArguments& p = arguments_;
    p.scene = file ? file->string() : scene.stand_in;
    p.size = a.size;
    p.device = a.device;
    p.rebuild = true;
    p.double_sided = true;
    p.tracing.block = a.block;
    p.tracing.routing = a.routing;
    p.floor = p.sky = file.has_value();
    if (file) p.material = scene.material;
    p.animation = file ? scene.animation : scene.stand_in_animation;
    if (!p.animation.empty()) p.time = 0;
    workspace_.emplace(p, notes);
    PosedScene& opened = workspace_->scene();
    if (p.time) duration_ = find_animations(opened.scene(), p.animation).front()->duration;
    object_side_ = longest_side(file ? opened.framed() : largest_object(opened.geometry()));
    // Meshes come in metres, inches or what their scanner had: the paper's 0.001 is taken for an object of one unit, of
    // which it is a pixel of 1024 (docs/paper.md).
    tolerance_ = a.tolerance.value_or(0.001 * object_side_);
    p.tracing.tolerance = tolerance_;
}

/// The picture of one moment with the times of `settings.repeat` frames, those that warm up left out.
MadePicture BenchScene::make(RenderSettings settings, uint32_t warm_up, const Shot& shot,
                             const std::function<void(double)>& progress) {
    const uint32_t frames = settings.repeat;
    if (repeat_ > 1) settings.repeat += warm_up + 1;  // the renderer leaves out the first itself
    MadePicture made = workspace_->render(settings, shot, progress);
    std::vector<RenderStats::FrameTime>& times = made.stats.render.frames;
    times.erase(times.begin(), times.end() - frames);
    return made;
}

/// All frames at one moment, or one at each of as many moments of an animation.
std::vector<MadePicture> BenchScene::render(const RenderSettings& settings,
                                            const std::function<void(double)>& progress) {
    std::vector<MadePicture> pictures;
    if (duration_ == 0) {
        pictures.push_back(make(settings, kWarmUp, {}, progress));
        return pictures;
    }
    RenderSettings of_moment = settings;
    of_moment.repeat = 1;
    for (uint32_t i = 0; i < repeat_; i++) {
        pictures.push_back(make(of_moment, kWarmUpOfMoment, {duration_ * i / repeat_},
                                [&](double share) { progress((i + share) / repeat_); }));
        pictures.back().picture = {};  // of no use, and large
    }
    return pictures;
}

/// Pixels along the longest side of what stands on the floor, in the cube that holds most triangles.
uint32_t BenchScene::object_pixels(const std::vector<LdcBody>& bodies) const {
    const auto most = std::max_element(bodies.begin(), bodies.end(),
                                       [](const LdcBody& a, const LdcBody& b) { return a.triangles < b.triangles; });
    return uint32_t(std::lround(object_side_ / most->grid.voxel));
}

void BenchScene::measure(PaperRow& row, const std::function<void(double)>& progress) {
    TracingArguments& tracing = arguments_.tracing;
    tracing.builder = row.builder;
    tracing.traversal = row.traversal;
    tracing.hit = row.hit;
    tracing.ldc = row.ldc;
    // What the options exclude costs no device: some drivers cannot be opened any number of times by one process.
    rendered_ = false;
    check(tracing);
    RenderSettings settings = render_settings(arguments_);
    settings.repeat = repeat_;
    settings.cubes.ldc_each = true;
    rendered_ = true;
    summarise(render(settings, progress), row);
    row.object_pixels = object_pixels(row.stats->render.bodies);
    row.layers = depth_complexity(row.stats->render);
}

void BenchScene::recover() {
    if (!rendered_) return;
    workspace_->check_validation();
    workspace_->renew_device();
    rendered_ = false;
}

}  // namespace

PaperBench::PaperBench(const BenchSettings& settings, Notes notes)
    : settings_(settings),
      notes_(std::move(notes)),
      combinations_(choose_combinations(settings)),
      scenes_(choose_scenes(settings)) {
    const Device device(device_options(settings.device));
    check_timestamps(device);
    machine_ = machine_of(device);
}

size_t PaperBench::rows() const {
    return scenes_.size() * combinations_.size() * settings_.ldc.size();
}

void PaperBench::run(const std::function<void(const PaperRow&)>& add, const RowProgress& progress) {
    for (const PaperScene* scene : scenes_) run(*scene, add, progress);
}

void PaperBench::run(const PaperScene& paper, const std::function<void(const PaperRow&)>& add,
                     const RowProgress& progress) {
    const auto file = find_model(settings_.models.value_or("models"), paper);
    if (!file)
        note(notes_, fmt::format("{}: there is no {}: {} stands in ({})", paper.name, paper.file, paper.stand_in,
                                 Setting{"models"}));
    std::optional<BenchScene> scene;
    std::string unusable;
    try {
        scene.emplace(paper, settings_, file, notes_);
    } catch (const Error& error) {
        unusable = error.text();
    }
    for (const Combination& c : combinations_)
        for (const auto& ldc : settings_.ldc) {
            check_interrupt();
            PaperRow row{&paper, file ? file->filename().string() : paper.stand_in, !file};
            row.builder = c.builder;
            row.traversal = c.traversal;
            row.hit = c.hit;
            row.ldc = *ldc;
            row.left_out = unusable;
            if (scene) {
                row.triangles = scene->triangles();
                row.tolerance = scene->tolerance();
                try {
                    scene->measure(row, [&](double share) { progress(double(done_) + share); });
                } catch (const Interrupted&) {
                    throw;
                } catch (const Error& error) {
                    row.left_out = error.text();
                    scene->recover();
                }
            }
            add(row);
            progress(double(++done_));
        }
}

}  // namespace peelray
