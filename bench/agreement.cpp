// agreement: random rays against the double-precision oracle (docs/accuracy.md).
//
//     agreement builtin:teapots bunny.off --rays 10000000 --hit exact,planar --ldc 256 --out agreement.json
//
// `exact`: every answer must be that of the ray, or of one within 2·10⁻⁶ of the scene's diagonal beside it. `planar`:
// how many answers are off by more than one voxel. Exit status 1 if an exact answer is wrong.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/progress.h"
#include "ldc/ray_sets.h"
#include "ldc/trace_params.h"
#include "loaders/load.h"
#include "reference/planar_answer.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;
using test::oracle_ray;
using test::RayKind;

struct Options {
    std::vector<std::string> scenes, hits = {"exact"};
    uint64_t rays = 10'000'000;
    uint32_t ldc = 256, seed = 1;
    std::string device, out;
};

TracerChoice choice_of(uint32_t ldc, HitTest test) {
    TracerChoice choice;
    choice.cubes.ldc = ldc;
    choice.cubes.hit = test;
    return choice;
}

/// An answer and how far it is off: across the surface, as a share of the diagonal; infinite: hit against miss.
struct Case {
    double off = -1;
    Ray ray{};
    FileHit hit{};
    OracleHit right{};
};

/// What came of the rays of one kind.
struct Tally {
    uint64_t rays = 0, hits = 0, same = 0, second_look = 0, wrong = 0, beside = 0, off_by_voxel = 0;
    Case worst;        ///< of the answers that are the ray's own, the one that is furthest off
    Case worst_wrong;  ///< of the others (exact: the wrong ones)

    void add(const Tally& other) {
        rays += other.rays;
        hits += other.hits;
        same += other.same;
        second_look += other.second_look;
        wrong += other.wrong;
        beside += other.beside;
        off_by_voxel += other.off_by_voxel;
        if (other.worst.off > worst.off) worst = other.worst;
        if (other.worst_wrong.off > worst_wrong.off) worst_wrong = other.worst_wrong;
    }
};

/// One scene with its cubes on the device, and its oracle.
class Bench {
  public:
    Bench(Device& device, const Scene& scene, const Geometry& geometry, const Oracle& oracle, uint32_t ldc,
          HitTest test)
        : device_(device),
          geometry_(geometry),
          oracle_(oracle),
          test_(test),
          commands_(device),
          scene_(device, scene, at_rest(scene), assemble(scene, at_rest(scene), motion_of(scene, "")),
                 choice_of(ldc, test)) {
        for (const LdcBody& body : scene_.stats(commands_).bodies) voxel_ = std::max(voxel_, body.grid.voxel);
    }

    Tally run(RayKind kind, uint64_t count, uint32_t seed, const std::function<void(uint64_t)>& progress) {
        // Where planar hits are good for a voxel only, a frame's rays start 0.7 voxels off their surface: so do these.
        test::RaySource source(geometry_, seed, test_ == HitTest::planar ? 0.7 * voxel_ : 0);
        Tally tally;
        constexpr uint64_t batch = 1 << 20;
        Buffer rays(device_, "rays", batch * sizeof(Ray)), hits(device_, "hits", batch * sizeof(FileHit));
        for (uint64_t first = 0; first < count; first += batch) {
            std::vector<Ray> sent(std::min(batch, count - first));
            for (Ray& ray : sent) ray = source.make(kind);
            commands_.upload(rays, std::span<const Ray>(sent));
            scene_.record(commands_, rays, uint32_t(sent.size()), hits, false);
            commands_.submit();
            judge(sent, commands_.download<FileHit>(hits, sent.size()), tally);
            progress(sent.size());
        }
        return tally;
    }

  private:
    /// Judges all answers on all cores.
    void judge(const std::vector<Ray>& rays, const std::vector<FileHit>& hits, Tally& tally) {
        std::atomic<size_t> next{0};
        std::mutex mutex;
        std::vector<std::thread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); i++)
            threads.emplace_back([&] {
                Tally own;
                for (size_t first; (first = next.fetch_add(4096)) < rays.size();)
                    for (size_t k = first; k < std::min(rays.size(), first + 4096); k++) judge(rays[k], hits[k], own);
                const std::lock_guard lock(mutex);
                tally.add(own);
            });
        for (std::thread& thread : threads) thread.join();
    }

    void judge(const Ray& ray, const FileHit& hit, Tally& tally) const {
        const Case answer{0, ray, hit, oracle_.closest(oracle_ray(ray))};
        const double off = distance(answer);
        const bool own = off <= (test_ == HitTest::exact ? 1e-5 : voxel_ / oracle_.diagonal());
        tally.rays++;
        tally.hits += answer.right.hit();
        tally.same += own;
        if (own) {
            if (off > tally.worst.off) tally.worst = {off, ray, hit, answer.right};
            return;
        }
        if (test_ == HitTest::planar &&
            right_beside(oracle_, geometry_, oracle_ray(ray), hit.triangle != ~0u ? double(hit.t) : INFINITY, voxel_)) {
            tally.beside++;
            return;
        }
        if (test_ == HitTest::planar) tally.off_by_voxel++;
        if (test_ == HitTest::exact && oracle_.check(oracle_ray(ray), hit.t, hit.triangle) != Verdict::wrong) {
            tally.second_look++;
            return;
        }
        if (test_ == HitTest::exact) tally.wrong++;
        if (off > tally.worst_wrong.off) tally.worst_wrong = {off, ray, hit, answer.right};
    }

    /// How far the answer is off, across the surface that is right, of the diagonal.
    double distance(const Case& answer) const {
        const double t = answer.hit.triangle != ~0u ? double(answer.hit.t) : INFINITY;
        return distance_off(geometry_, oracle_ray(answer.ray), t, answer.right) / oracle_.diagonal();
    }

    Device& device_;
    const Geometry& geometry_;
    const Oracle& oracle_;
    HitTest test_;
    Commands commands_;
    RayScene scene_;
    float voxel_ = 0;  ///< edge of the largest voxels of all cubes
};

Json describe(const Case& c) {
    if (c.off < 0) return nullptr;
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json("infinite"); };
    return {{"off_of_diagonal", number(c.off)},
            {"origin", {c.ray.origin.x, c.ray.origin.y, c.ray.origin.z}},
            {"direction", {c.ray.direction.x, c.ray.direction.y, c.ray.direction.z}},
            {"ours", {{"t", number(c.hit.t)}, {"triangle", c.hit.triangle}}},
            {"right", {{"t", number(c.right.t)}, {"triangle", c.right.triangle}}}};
}

Json measure(Device& device, const std::string& scene, const std::string& hit, const Options& options,
             uint64_t& wrong) {
    const Scene source = load_scene(scene);
    const Geometry geometry = flatten(source);
    const Oracle oracle(geometry, AlphaTest(source, geometry));
    Bench bench(device, source, geometry, oracle, options.ldc, hit == "planar" ? HitTest::planar : HitTest::exact);
    Json result = {{"scene", scene}, {"triangles", geometry.triangles.size()}, {"hit", hit}, {"ldc", options.ldc}};
    Tally all;
    Progress progress(scene + ", " + hit, double(options.rays));
    uint64_t done = 0;
    for (RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel, RayKind::on_surface}) {
        const Tally tally = bench.run(kind, (options.rays + 3) / 4, options.seed + uint32_t(kind),
                                      [&](uint64_t rays) { progress.update(double(done += rays)); });
        result["kinds"][test::name_of(kind)] = {{"rays", tally.rays},
                                                {"hits", tally.hits},
                                                {"same", tally.same},
                                                {"second_look", tally.second_look},
                                                {"wrong", tally.wrong},
                                                {"beside", tally.beside},
                                                {"off_by_voxel", tally.off_by_voxel},
                                                {"worst", describe(tally.worst)},
                                                {"worst_wrong", describe(tally.worst_wrong)}};
        all.add(tally);
    }
    result["total"] = {{"rays", all.rays},
                       {"hits", all.hits},
                       {"second_look", all.second_look},
                       {"wrong", all.wrong},
                       {"beside", all.beside},
                       {"off_by_voxel", all.off_by_voxel},
                       {"worst", describe(all.worst)},
                       {"worst_wrong", describe(all.worst_wrong)}};
    wrong += all.wrong;
    fmt::print("{} ({} triangles), {} {}: {} rays, {} hits", scene, geometry.triangles.size(), hit, options.ldc,
               all.rays, all.hits);
    if (hit == "exact")
        fmt::print(", {} wrong; the worst right one is off by {:.2e} of the diagonal\n", all.wrong, all.worst.off);
    else
        fmt::print(", {:.4f} % off by more than a voxel\n", 100.0 * double(all.off_by_voxel) / double(all.hits));
    const auto count = [](const Json& tally, const char* what) { return tally[what].get<uint64_t>(); };
    for (const auto& [kind, tally] : result["kinds"].items())
        if (hit == "exact")
            fmt::print("  {:<14} {} hits, {} by the second look\n", kind, count(tally, "hits"),
                       count(tally, "second_look"));
        else
            fmt::print("  {:<14} {} hits, {} off by more than a voxel, {} right for a ray less than a voxel beside\n",
                       kind, count(tally, "hits"), count(tally, "off_by_voxel"), count(tally, "beside"));
    if (all.worst_wrong.off >= 0) fmt::print("  worst of those: {}\n", describe(all.worst_wrong).dump());
    std::fflush(stdout);
    return result;
}

int run(const Options& options) {
    Device device({options.device, false});
    Json json = {{"device", device.info().name}, {"driver", device.info().driver}, {"rays", options.rays}};
    uint64_t wrong = 0;
    for (const std::string& scene : options.scenes)
        for (const std::string& hit : options.hits)
            json["results"].push_back(measure(device, scene, hit, options, wrong));
    if (!options.out.empty()) {
        std::ofstream file(options.out);
        file << json.dump(2) << "\n";
        file.close();
        if (!file) fail("cannot write '{}'", options.out);
    }
    return wrong > 0;
}

}  // namespace
}  // namespace peelray

int main(int argc, char** argv) {
    peelray::Options options;
    CLI::App app{"Random rays against the double-precision oracle."};
    app.add_option("SCENE", options.scenes, "files or builtin:NAME")->required();
    app.add_option("--rays", options.rays, "per scene, a quarter of each kind")->capture_default_str();
    app.add_option("--hit", options.hits, "a list out of exact,planar")
        ->delimiter(',')
        ->check(CLI::IsMember({"exact", "planar"}))
        ->capture_default_str();
    app.add_option("--ldc", options.ldc, "resolution of the cube")->check(CLI::Range(16, 2048))->capture_default_str();
    app.add_option("--seed", options.seed, "of the rays")->capture_default_str();
    app.add_option("--device", options.device, "by number or name");
    app.add_option("--out", options.out, "JSON to write");
    CLI11_PARSE(app, argc, argv);
    try {
        return peelray::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "agreement: {}\n", error.what());
        return 1;
    }
}
