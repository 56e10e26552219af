// What a user asks a command for: the settings of src/settings, and the files that go in and come out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench_settings.h"
#include "settings/settings.h"

namespace peelray {

struct RenderArguments : PictureArguments {
    std::filesystem::path output, stats, preview;
    std::vector<Aov> aovs;
    bool exr_layers = false;
    std::optional<YesNo> half;                   ///< none: yes
    std::optional<Compression> exr_compression;  ///< none: zip
    bool counters = false;
    std::optional<double> time_limit;  ///< seconds
    std::optional<float> noise_target;
    bool keep_partial = false;
    SequenceArguments sequence;
    bool asks_for_cubes = false;  ///< by an option that is SettingInfo::of_cubes, or --validate

    bool is_sequence() const { return sequence.frames || sequence.turntable; }
};

/// An option as it was typed.
struct GivenOption {
    std::string name;
    std::vector<std::string> words;  ///< its flag and, unless it is one that has none, its value
};

struct CompareArguments : PictureArguments {
    std::filesystem::path output, json, strip, worst;
    std::vector<Tracer> tracers = {Tracer::cubemap, Tracer::ldc, Tracer::reference};
    std::vector<std::optional<HitTest>> hits = {std::nullopt};  ///< none: auto
    std::vector<std::filesystem::path> pictures;
    std::vector<GivenOption> given;  ///< of the picture's
};

struct TraceArguments : SceneArguments {
    std::string scene;
    std::filesystem::path rays, hits, stats, counters;
    bool any_hit = false;
    uint32_t repeat = 1;
    TracingArguments tracing;
    DeviceArguments device;
};

/// Lists that are empty stand for the default, which `run_bench` fills in.
struct BenchArguments : BenchSettings {
    bool paper = false, auto_check = false, sequence = false;
    std::optional<glm::uvec2> given_size;  ///< what `size` becomes, if given
    std::optional<uint32_t> given_repeat;
    std::filesystem::path output, markdown, plots;
};

/// All options of a command but the scene, in the order of its help.
SettingList options_of(RenderArguments& arguments);
SettingList options_of(CompareArguments& arguments);
SettingList options_of(TraceArguments& arguments);
SettingList options_of(BenchArguments& arguments);

/// "exact", or "auto" for none.
std::string name_of(const std::optional<HitTest>& hit);

}  // namespace peelray
