// hierarchies: the same rays through the cubes' traversals and through Embree's BVH (docs/performance.md).
//
//     hierarchies builtin:teapots bunny.off --rays 2000000 --ldc 512 --out hierarchies.json
//
// All hits are exact. Embree takes single rays or packets on all cores, its own triangle test; the cubes are built on
// the device.
#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "bench/embree_contender.h"
#include "ldc/ray_sets.h"
#include "loaders/load.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;
using test::RayKind;

struct Options {
    std::vector<std::string> scenes;
    uint32_t rays = 1'000'000, ldc = 512, repeat = 7;
    std::string device, out;
};

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Tracing alone on the device, milliseconds, and what hits something.
double trace_on_gpu(Device& device, RayScene& scene, const std::vector<Ray>& rays, uint32_t repeat, size_t& found) {
    Commands commands(device);
    const Buffer sent(device, "rays", rays.size() * sizeof(Ray)), hits(device, "hits", rays.size() * sizeof(FileHit));
    commands.upload(sent, std::span<const Ray>(rays));
    std::vector<double> times;
    for (uint32_t i = 0; i <= repeat; i++) {
        scene.record(commands, sent, uint32_t(rays.size()), hits, false);
        commands.submit();
        double ms = 0;
        for (const PassTime& time : commands.times())
            if (time.name.starts_with("trace")) ms += time.ms;
        if (i > 0) times.push_back(ms);
    }
    found = 0;
    for (const FileHit& hit : commands.download<FileHit>(hits, rays.size())) found += hit.triangle != ~0u;
    return median(times);
}

Json measure(Device& device, const std::string& name, const Options& options) {
    const Scene scene = load_scene(name);
    const Geometry geometry = flatten(scene);
    EmbreeContender embree(geometry);
    const Timing embree_build = embree.time_build(1);
    Json result = {{"scene", name}, {"triangles", geometry.triangles.size()}};
    const auto rate = [&](double ms) { return double(options.rays) / ms * 1e-3; };
    for (const RayKind kind : {RayKind::uniform, RayKind::on_surface}) {
        test::RaySource source(geometry, 5);
        std::vector<Ray> rays(options.rays);
        for (Ray& ray : rays) ray = source.make(kind);
        Json& row = result["rays"][test::name_of(kind)];
        embree.take(rays);
        const double embree_rate = rate(embree.time_trace(false, options.repeat).median);
        const std::vector<FileHit> answers = embree.answers();
        row["embree"] = {{"build_ms", embree_build.median},
                         {"mrays_per_second", embree_rate},
                         {"hits", std::count_if(answers.begin(), answers.end(),
                                                [](const FileHit& hit) { return hit.triangle != ~0u; })}};
        fmt::print("{} ({} triangles), {}: Embree {:.1f} Mrays/s by {} (build {:.1f} ms)", name,
                   geometry.triangles.size(), test::name_of(kind), embree_rate, embree.way(), embree_build.median);
        for (const Traversal traversal : {Traversal::voxel, Traversal::two_level, Traversal::mipmap}) {
            TracerChoice choice;
            choice.cubes.ldc = options.ldc;
            choice.cubes.layout.traversal = traversal;
            const Moment rest = at_rest(scene);
            RayScene cubes(device, scene, rest, assemble(scene, rest, motion_of(scene, "")), choice);
            size_t found = 0;
            const double ms = trace_on_gpu(device, cubes, rays, options.repeat, found);
            row[name_of(traversal)] = {{"build_ms", cubes.build().ms}, {"mrays_per_second", rate(ms)}, {"hits", found}};
            fmt::print(", {} {:.0f} (build {:.2f} ms)", name_of(traversal), rate(ms), cubes.build().ms);
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
    return result;
}

void run(const Options& options) {
    Device device({options.device, false});
    Json json = {{"device", device.info().name},
                 {"driver", device.info().driver},
                 {"cpu_threads", std::thread::hardware_concurrency()},
                 {"rays", options.rays},
                 {"ldc", options.ldc}};
    for (const std::string& scene : options.scenes) json["results"].push_back(measure(device, scene, options));
    if (options.out.empty()) return;
    std::ofstream file(options.out);
    file << json.dump(2) << "\n";
    file.close();
    if (!file) fail("cannot write '{}'", options.out);
}

}  // namespace
}  // namespace peelray

int main(int argc, char** argv) {
    peelray::Options options;
    CLI::App app{"The same rays through cubes on the device and through Embree's BVH."};
    app.add_option("SCENE", options.scenes, "files or builtin:NAME")->required();
    app.add_option("--rays", options.rays, "of each kind")->check(CLI::Range(1u, 4'000'000u))->capture_default_str();
    app.add_option("--ldc", options.ldc, "resolution of the largest cube")
        ->check(CLI::Range(16, 2048))
        ->capture_default_str();
    app.add_option("--repeat", options.repeat, "times after one that warms up")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--device", options.device, "by number or name");
    app.add_option("--out", options.out, "JSON to write");
    CLI11_PARSE(app, argc, argv);
    try {
        peelray::run(options);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "hierarchies: {}\n", error.what());
        return 1;
    }
}
