// The command line: parsing, the subcommands, exit status.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace peelray {

/// Runs the program. Returns its exit status: 0 done; 1 the input or the device is at fault (one line on standard
/// error); 2 wrong usage.
int run_program(int argc, const char* const* argv);

/// Options that choose the device.
struct DeviceArguments {
    std::string device;
    bool validate = false;
};

/// Options that choose how rays are traced; shared by render and trace.
struct TracingArguments {
    std::string tracer = "ldc", builder = "auto", hit = "auto", traversal = "voxel", routing = "geometry",
                batch = "none";
    double tolerance = 0.001;
    glm::uvec2 block{8};
    uint32_t depth = 32;          ///< bits
    std::optional<uint32_t> ldc;  ///< none: automatic

    /// Throws Error for values out of range, naming what does work.
    void check() const;
};

/// What a picture shows and how it is made; shared by render and compare.
struct PictureArguments {
    std::string scene;
    glm::uvec2 size{1280, 1024};
    std::string camera, env;
    std::optional<glm::vec3> eye, look, up, background;
    std::optional<float> fov;  ///< degrees
    bool sky = false, floor = false, rebuild = false;
    std::string visibility = "auto";
    std::string material, tonemap = "neutral";
    std::vector<std::string> effects = {"reflection", "refraction", "shadow"};
    float exposure = 0;
    std::optional<double> time;
    std::string animation;
    uint32_t bounces = 4, spp = 1, repeat = 1;
    TracingArguments tracing;
    DeviceArguments device;
};

/// The frames from `first` up to, but without, `end`.
struct FrameRange {
    uint32_t first = 0, end = 0;
};

/// Part `index` of `count`.
struct Shard {
    uint32_t index = 0, count = 1;
};

/// Several pictures in a row.
struct SequenceArguments {
    std::optional<FrameRange> frames;
    std::optional<uint32_t> turntable;  ///< frames of a full circle
    std::optional<double> fps;
    std::optional<Shard> shard;
    bool resume = false;
};

struct RenderArguments : PictureArguments {
    std::filesystem::path output, stats;
    std::vector<std::string> aovs;
    bool counters = false;
    SequenceArguments sequence;

    bool is_sequence() const { return sequence.frames || sequence.turntable; }
};

struct CompareArguments : PictureArguments {
    std::filesystem::path output, json, strip, worst;
    std::vector<std::string> tracers = {"cubemap", "ldc", "reference"}, hits = {"auto"};
    std::vector<std::filesystem::path> pictures;
    std::vector<std::string> given;  ///< the picture's options as they were typed
};

struct TraceArguments {
    std::string scene;
    std::filesystem::path rays, hits, stats, counters;
    bool any_hit = false;
    uint32_t repeat = 1;
    TracingArguments tracing;
    DeviceArguments device;
};

/// Lists that are empty stand for the default, which `run_bench` fills in.
struct BenchArguments {
    bool paper = false, all = false, quick = false, auto_check = false;
    std::vector<std::string> scenes, builders, traversals, hits, rays;
    std::vector<std::optional<uint32_t>> ldc;      ///< none: auto
    std::optional<std::vector<glm::uvec2>> sizes;  ///< of the series of picture sizes
    glm::uvec2 block{8}, size{0};
    std::optional<glm::uvec2> given_size;  ///< what `size` becomes, if given
    std::string routing = "geometry";
    std::optional<double> tolerance;  ///< none: in proportion to the scene
    uint32_t repeat = 0;
    std::optional<uint32_t> given_repeat;
    std::optional<std::filesystem::path> models;  ///< none: the folder "models", if there is one
    std::filesystem::path output, markdown, plots;
    DeviceArguments device;
};

void run_render(const RenderArguments& arguments);
/// `run_render` where `is_sequence()`.
void run_sequence(const RenderArguments& arguments);
void run_compare(const CompareArguments& arguments);
void run_trace(const TraceArguments& arguments);
void run_bench(const BenchArguments& arguments);
void run_info(const std::string& scene);
void run_devices();

/// The scene's triangles. Tells on standard error what of the scene is left out; throws Error if nothing can be hit,
/// unless that is but one moment of an animation.
void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment = false);
/// Whatever a file's names brought along, as one line without terminal codes.
std::string one_line(std::string text);
/// A line on standard error that is no complaint.
void print_note(const std::string& text);
/// Throws Error unless `repeat` is a sensible number of measurements.
void check_repeat(uint32_t repeat);
/// Throws Error if a file of `outputs` cannot be written, comes twice or is one of `inputs`; empty names are left out.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// The build's commit and the program's version, for stats.
const char* build_commit();
const char* program_version();

}  // namespace peelray
