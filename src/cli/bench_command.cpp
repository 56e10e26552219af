// `peelray bench`: what was asked for, and whether that makes sense.
#include "base/error.h"
#include "base/interrupt.h"
#include "bench/scenes.h"
#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/outputs.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

/// What was not given: the defaults of each kind of run.
BenchArguments with_defaults(BenchArguments a) {
    using Resolutions = std::vector<std::optional<uint32_t>>;
    a.size = a.given_size.value_or(a.quick ? glm::uvec2(256, 192) : glm::uvec2(1280, 1024));
    a.repeat = a.given_repeat.value_or(a.quick ? 3 : 20);
    if (a.paper) {
        if (a.ldc.empty()) a.ldc = Resolutions{512, 1024};
        return a;
    }
    if (a.sequence) {
        a.repeat = a.given_repeat.value_or(60);
        if (a.scenes.empty()) a.scenes = {"walker"};
        return a;
    }
    if (a.scenes.empty()) a.scenes = a.quick ? quick_bench_scenes() : default_bench_scenes();
    if (a.hits.empty()) a.hits = {HitTest::exact, HitTest::planar};
    if (a.auto_check) {
        if (a.ldc.empty()) a.ldc = Resolutions{64, 128, 192, 256, 384, 512, 768, 1024};
        return a;
    }
    if (a.traversals.empty()) a.traversals = {Traversal::voxel};
    if (a.rays.empty()) a.rays = values_of<RayKind>();
    if (a.ldc.empty()) a.ldc = Resolutions{std::nullopt, 256, 512, 1024};
    if (!a.sizes && !a.quick)
        a.sizes = {{360, 280}, {640, 512}, {1280, 1024}, {2560, 2048}, {4096, 3280}, {6400, 5120}};
    return a;
}

void check_arguments(const BenchArguments& a) {
    if (!a.paper) {
        for (const std::string& scene : a.scenes) check_bench_scene(scene);
        for (const HitTest hit : a.hits)
            if (hit == HitTest::tolerance)
                fail("'tolerance' has no right answers to compare with: it is measured by 'bench --paper' (--hits)");
    }
    std::error_code error;
    if (a.models && !fs::is_directory(*a.models, error))
        fail("there is no folder '{}': name the one with the meshes, or leave it out for built-in ones (--models)",
             a.models->string());
    std::vector<fs::path> outputs;
    for (const fs::path& path : {a.output, a.markdown})
        if (!path.empty()) outputs.push_back(path);
    if (!a.plots.empty()) outputs.push_back(a.plots / "triangles_rate.svg");
    check_outputs(outputs, {});
}

}  // namespace

void run_bench(const BenchArguments& given) {
    const BenchArguments a = with_defaults(given);
    check_arguments(a);
    watch_interrupts();
    if (a.paper) return run_paper_bench(a);
    if (a.auto_check) return run_auto_check(a);
    if (a.sequence) return run_sequence_bench(a);
#ifdef PEELRAY_WITH_REFERENCE
    run_ray_bench(a);
#else
    fail(
        "this program was built without the reference (PEELRAY_REFERENCE=OFF), which makes and judges the rays: there "
        "are --paper, --auto-check and --sequence");
#endif
}

}  // namespace peelray
