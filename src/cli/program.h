// The command line (DESIGN.md section 7): parsing, the subcommands, exit status.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace peelray {

/// Runs the program. Returns its exit status: 0 done; 1 the input or the device is at fault (one line on standard error);
/// 2 wrong usage.
int run_program(int argc, const char* const* argv);

/// Options that choose the device.
struct DeviceArguments {
    std::string device;
    bool validate = false;
};

/// Options that choose how rays are traced; shared by render and trace.
struct TracingArguments {
    std::string tracer = "ldc", builder = "auto", hit = "auto", traversal = "voxel", ldc = "auto";
    double tolerance = 0.001;
    std::string block = "8";

    /// Throws Error for what this version does not build yet, naming what does work.
    void check() const;
    uint32_t resolution() const;  ///< 0: automatic
};

struct RenderArguments {
    std::string scene;
    std::filesystem::path output, stats;
    std::string size = "1280x1024", camera, env, background;
    std::vector<float> eye, look, up;
    std::optional<float> fov;
    bool sky = false, floor = false;
    std::string material, tonemap = "neutral", aov;
    std::string effects = "reflection,refraction,shadow";
    double exposure = 0, time = 0;
    uint32_t bounces = 4, spp = 1, repeat = 1;
    TracingArguments tracing;
    DeviceArguments device;
};

struct TraceArguments {
    std::string scene;
    std::filesystem::path rays, hits, stats;
    bool any_hit = false;
    uint32_t repeat = 1;
    TracingArguments tracing;
    DeviceArguments device;
};

void run_render(const RenderArguments& arguments);
void run_trace(const TraceArguments& arguments);
void run_info(const std::string& scene);
void run_devices();

/// "1280x1024" to width and height. Throws Error with the text.
glm::uvec2 parse_size(const std::string& text);

/// The build's commit, for stats.
const char* build_commit();

}  // namespace peelray
