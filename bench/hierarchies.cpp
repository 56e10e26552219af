// hierarchies: the same rays through the cubes' traversals and through Embree's BVH (docs/performance.md).
//
//     hierarchies builtin:teapots bunny.off --rays 2000000 --ldc 512 --out hierarchies.json
//
// All hits are exact. Embree takes single rays on all cores, its own triangle test; the cubes are built on the device.
#include <embree3/rtcore.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "ldc/ray_sets.h"
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

double now_ms() {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(time).count();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Embree's BVH over a scene's triangles.
class Embree {
  public:
    explicit Embree(const Geometry& geometry) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* positions =
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, geometry.positions.size());
        std::memcpy(positions, geometry.positions.data(), geometry.positions.size() * 12);
        void* indices =
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, geometry.triangles.size());
        std::memcpy(indices, geometry.triangles.data(), geometry.triangles.size() * 12);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        const double start = now_ms();
        rtcCommitScene(scene_);
        build_ms = now_ms() - start;
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// Milliseconds for all rays on all cores; `hits`: how many hit something.
    double trace(const std::vector<Ray>& rays, std::atomic<size_t>& hits) const {
        std::atomic<size_t> next{0};
        std::vector<std::thread> threads;
        const double start = now_ms();
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); i++)
            threads.emplace_back([&] {
                size_t found = 0;
                for (size_t first; (first = next.fetch_add(4096)) < rays.size();)
                    for (size_t k = first; k < std::min(rays.size(), first + 4096); k++) found += hit(rays[k]);
                hits += found;
            });
        for (std::thread& thread : threads) thread.join();
        return now_ms() - start;
    }

    double build_ms = 0;

  private:
    bool hit(const Ray& ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query{};
        query.ray = {ray.origin.x,
                     ray.origin.y,
                     ray.origin.z,
                     ray.tmin,
                     ray.direction.x,
                     ray.direction.y,
                     ray.direction.z,
                     0,
                     ray.tmax,
                     ~0u,
                     0,
                     0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }

    RTCDevice device_;
    RTCScene scene_;
};

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
    const Embree embree(geometry);
    Json result = {{"scene", name}, {"triangles", geometry.triangles.size()}};
    const auto rate = [&](double ms) { return double(options.rays) / ms * 1e-3; };
    for (const RayKind kind : {RayKind::uniform, RayKind::on_surface}) {
        test::RaySource source(geometry, 5);
        std::vector<Ray> rays(options.rays);
        for (Ray& ray : rays) ray = source.make(kind);
        Json& row = result["rays"][test::name_of(kind)];
        std::vector<double> times;
        std::atomic<size_t> hits{0};
        for (uint32_t i = 0; i <= options.repeat; i++) {
            hits = 0;
            const double ms = embree.trace(rays, hits);
            if (i > 0) times.push_back(ms);
        }
        row["embree"] = {
            {"build_ms", embree.build_ms}, {"mrays_per_second", rate(median(times))}, {"hits", hits.load()}};
        fmt::print("{} ({} triangles), {}: Embree {:.1f} Mrays/s (build {:.1f} ms)", name, geometry.triangles.size(),
                   test::name_of(kind), rate(median(times)), embree.build_ms);
        for (const Traversal traversal : {Traversal::voxel, Traversal::two_level, Traversal::mipmap}) {
            CubeChoice choice;
            choice.ldc = options.ldc;
            choice.layout.traversal = traversal;
            RayScene cubes(device, scene, assemble(scene, motion_of(scene, "")), choice);
            size_t found = 0;
            const double ms = trace_on_gpu(device, cubes, rays, options.repeat, found);
            row[name_of(traversal)] = {{"build_ms", cubes.build_ms()}, {"mrays_per_second", rate(ms)}, {"hits", found}};
            fmt::print(", {} {:.0f} (build {:.2f} ms)", name_of(traversal), rate(ms), cubes.build_ms());
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
