// The scenes of the benchmarks of rays and of `auto`.
#pragma once

#include "bench/bench_settings.h"
#include "scene/scene.h"

namespace peelray {

/// How a scene is shown: the settings that `render` would get.
struct BenchSceneChoice {
    std::string name;   ///< as --scenes has it
    std::string shown;  ///< file name or built-in scene
    bool stands_in = false;
    PictureArguments picture;
    std::optional<Light> light;  ///< of the shadow rays; none: the scene's first, else the sky's sun
};

/// What is measured without --scenes: the paper's five, blobs over four decades, an interior; and with --quick.
std::vector<std::string> default_bench_scenes();
std::vector<std::string> quick_bench_scenes();

/// Throws Error for a name that is none of the paper's scenes, of the built-in ones ("blob:8000" or
/// "builtin:blob:8000") and of files.
void check_bench_scene(const std::string& name);

/// `name`: passed check_bench_scene().
BenchSceneChoice choose_bench_scene(const std::string& name, const BenchSettings& settings);

}  // namespace peelray
