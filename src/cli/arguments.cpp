#include "cli/arguments.h"

#include "settings/aovs.h"

namespace peelray {
namespace {

using Path = std::filesystem::path;

void append(SettingList& list, SettingList more) {
    for (SettingEntry& entry : more) list.push_back(std::move(entry));
}

/// A file that a command writes or reads besides the scene.
void add_file(SettingList& list, Path& path, SettingInfo info) {
    info.changes_picture = false;
    if (info.form.empty()) info.form = "FILE";
    add_setting(list, path, std::move(info));
}

/// A list of values that `parse` knows, none twice.
template <typename Value, typename Parse>
void add_list(SettingList& list, std::vector<Value>& values, SettingInfo info, Parse parse) {
    info.form = "LIST";
    add_setting(
        list, values, std::move(info),
        [parse](const std::string& text) { return parse_list<Value>(text, parse, true); },
        [](const std::vector<Value>&) { return std::optional<std::string>(); });
}

template <Choice Value>
void add_choices(SettingList& list, std::vector<Value>& values, SettingInfo info) {
    add_list(list, values, std::move(info), [](const std::string& name) { return value_named<Value>(name); });
}

std::optional<std::optional<HitTest>> parse_hit(const std::string& text) {
    using Hit = std::optional<HitTest>;
    if (text == "auto") return std::optional<Hit>(std::in_place);
    const Hit hit = value_named<HitTest>(text);
    return hit ? std::optional<Hit>(hit) : std::nullopt;
}

std::optional<std::optional<uint32_t>> parse_resolution(const std::string& text) {
    using Resolution = std::optional<uint32_t>;
    if (text == "auto") return std::optional<Resolution>(std::in_place);
    const Resolution number = parse_number<uint32_t>(text);
    return number ? std::optional<Resolution>(number) : std::nullopt;
}

}  // namespace

std::string name_of(const std::optional<HitTest>& hit) {
    return hit ? name_of(*hit) : "auto";
}

// ---- render

namespace {

/// How a picture of many samples ends early, and is looked at before.
void add_progress(SettingList& list, RenderArguments& a) {
    const std::string group = "Progress";
    add_setting(list, a.time_limit,
                {.name = "time-limit",
                 .group = group,
                 .help = "the picture, or each frame, ends with the samples that it has when this many seconds have "
                         "passed since its first sample was begun, at least one; --spp is still the most",
                 .form = "SECONDS",
                 .limits = kTimeLimits,
                 .excludes = {"repeat"}});
    add_setting(list, a.noise_target,
                {.name = "noise-target",
                 .group = group,
                 .help = "the picture, or each frame, ends when its noise is below X: in 95 of 100 pixels that see a "
                         "surface the standard error is below X times the pixel's luminance (and a hundredth of the "
                         "picture's); looked at from 8 samples on; --spp is still the most",
                 .limits = kNoiseLimits,
                 .excludes = {"repeat"}});
    add_file(list, a.preview,
             {.name = "preview",
              .group = group,
              .help = "while it works, write here what the picture looks like so far, every second at most; in the end "
                      "it shows the finished picture",
              .excludes = {"repeat", "frames", "turntable"}});
    add_setting(list, a.keep_partial,
                {.name = "keep-partial",
                 .group = group,
                 .help = "Ctrl-C ends the picture with the samples that it has; without, nothing is written then",
                 .changes_picture = false,
                 .excludes = {"repeat", "frames", "turntable"}});
}

/// A choice that has a default, and of which it matters whether it was made.
template <Choice Value>
void add_choice(SettingList& list, std::optional<Value>& value, Value preset, SettingInfo info) {
    info.form = form_of<Value>("");
    info.expected = "one of " + info.form;
    add_setting(
        list, value, std::move(info),
        [](const std::string& text) -> std::optional<std::optional<Value>> {
            if (const auto chosen = value_named<Value>(text)) return std::optional(chosen);
            return std::nullopt;
        },
        [preset](const std::optional<Value>& v) { return std::optional<std::string>(name_of(v.value_or(preset))); });
}

void add_exr(SettingList& list, RenderArguments& a, const std::string& group) {
    add_setting(
        list, a.exr_layers,
        {.name = "exr-layers",
         .group = group,
         .help = "put the pictures of --aov into the .exr itself, as layers that Blender and Nuke know, and not "
                 "into files beside it",
         .needs = "aov"});
    add_choice(
        list, a.half, YesNo::yes,
        {.name = "half",
         .group = group,
         .help = "whether the channels R, G, B and A of the .exr are half floats, of up to 65504; no: floats, of "
                 "twice the bytes; depths, numbers and all other auxiliary pictures are floats in any case",
         .implied = "yes"});
    add_choice(list, a.exr_compression, Compression::zip,
               {.name = "exr-compression",
                .group = group,
                .help = "of each .exr that is written; none: larger files, as fast as the disk is"});
}

}  // namespace

SettingList options_of(RenderArguments& a) {
    SettingList list;
    add_file(list, a.output,
             {.name = "output",
              .letter = 'o',
              .help = "picture to write: .png (tone-mapped sRGB), .exr or .hdr (linear radiance); for several frames "
                      "see --frames; -: the standard output, a PNG or, of several frames, a video as YUV4MPEG2",
              .required = true});
    append(list, picture_settings(a));
    append(list, sequence_settings(a.sequence));
    add_progress(list, a);
    const std::string group = "More output";
    add_setting(list, a.aovs,
                {.name = "aov",
                 .group = group,
                 .help = "also write these to NAME.KIND.exr beside NAME.png: a list out of " +
                         print_text(aovs_of(AovSource::surface)) + ", or all of them; or out of " +
                         print_text(aovs_of(AovSource::ray_setup)) +
                         ": what the paper sets up for mirror rays (its Figure 7); or out of " +
                         print_text(aovs_of(AovSource::samples)) +
                         ": the squared error that the mean of a pixel's samples has to be expected to have, and how "
                         "many there are; or out of " +
                         print_text(aovs_of(AovSource::costs)) +
                         ": what all rays of a pixel cost in the cubes, with a heat map NAME.KIND.png",
                 .form = "LIST",
                 .expected = "a list out of " + print_text(values_of<Aov>()) + ", or all"},
                parse_aovs, [](const std::vector<Aov>& aovs) {
                    // Their order has no effect.
                    ChoiceSet<Aov> set;
                    for (const Aov aov : aovs) set.add(aov);
                    const std::string names = print_text(set);
                    return names.empty() ? std::nullopt : std::optional(names);
                });
    add_exr(list, a, group);
    add_file(list, a.stats, {.name = "stats", .group = group, .help = "also write times, rays and memory as JSON"});
    add_setting(list, a.counters,
                {.name = "counters",
                 .group = group,
                 .help = "count what rays cost, for the stats: cells stepped to, lists met, pixels, samples and "
                         "triangles tested; this slows rays down, so times mean nothing",
                 .changes_picture = false,
                 .of_cubes = true});
    return list;
}

// ---- compare

SettingList options_of(CompareArguments& a) {
    SettingList list;
    add_file(list, a.output,
             {.name = "output",
              .letter = 'o',
              .help = "report to write: one HTML file that needs nothing else",
              .form = "FILE.html",
              .required = true});
    append(list, picture_settings(a, false));
    const std::string group = "Comparison";
    add_choices(list, a.tracers,
                {.name = "tracers",
                 .group = group,
                 .help = "the tracers that render, a list out of cubemap,ldc,cpu,reference,none,khr",
                 .expected = "a list out of cubemap,ldc,cpu,reference,none,khr, each once",
                 .preset = "cubemap,ldc,reference"});
    add_list(list, a.hits,
             {.name = "hit",
              .group = group,
              .help = "hit tests of ldc, one picture each, a list out of auto,exact,planar,tolerance",
              .expected = "a list out of auto,exact,planar,tolerance, each once",
              .preset = "auto"},
             parse_hit);
    add_setting(
        list, a.pictures,
        {.name = "picture",
         .group = group,
         .help = "also compare this picture of the same scene and size, by another program: .png, .jpg (as it is) or "
                 ".exr, .hdr (tone-mapped like the others); may be given several times",
         .form = "FILE",
         .several = true},
        [&a](const std::string& text) {
            std::vector<Path> pictures = a.pictures;
            pictures.emplace_back(text);
            return std::optional(pictures);
        },
        [](const std::vector<Path>&) { return std::optional<std::string>(); });
    add_file(list, a.json, {.name = "json", .group = group, .help = "also write metrics and stats as JSON"});
    add_file(list, a.strip,
             {.name = "strip", .group = group, .help = "also write all pictures side by side", .form = "FILE.png"});
    add_file(list, a.worst,
             {.name = "worst",
              .group = group,
              .help = "also write the surroundings of each picture's worst pixel, magnified: the picture, the "
                      "reference, the error",
              .form = "FILE.png"});
    return list;
}

// ---- trace

SettingList options_of(TraceArguments& a) {
    SettingList list;
    add_file(list, a.rays,
             {.name = "rays",
              .help = "rays to trace: float32 (n, 8): ox oy oz tmin dx dy dz tmax, in world units; t counts in lengths "
                      "of d",
              .form = "FILE.npy",
              .required = true});
    add_file(list, a.hits,
             {.name = "out",
              .help = "hits to write: structured (n): t f4 (+inf: a miss), triangle u4 (in file order), u f4, v f4",
              .form = "FILE.npy",
              .required = true});
    add_file(list, a.counters,
             {.name = "counters",
              .help = "also write what each ray cost: structured (n): steps, cells, pixels, samples, triangles, u4 "
                      "each; this slows rays down, so times mean nothing",
              .form = "FILE.npy"});
    add_setting(list, a.any_hit,
                {.name = "any-hit", .help = "stop at any hit instead of looking for the nearest: for shadow rays"});
    add_file(list, a.stats, {.name = "stats", .help = "also write times and memory as JSON"});
    add_scene(list, a);
    add_setting(list, a.repeat,
                {.name = "repeat",
                 .help = "for measuring: trace 2 or more times after one that warms up; times are medians",
                 .limits = kRepeatLimits,
                 .changes_picture = false});
    add_setting(
        list, a.tracing.tracer,
        {.name = "tracer",
         .group = "Tracing",
         .help = "ldc: in the layered depth cubes; khr: by the device's own ray tracing, where it has one",
         .form = "ldc|cpu|reference|cubemap|khr",
         .expected = "one of ldc|cpu|reference|cubemap|khr",
         .preset = "ldc"},
        [](const std::string& name) -> std::optional<std::optional<Tracer>> {
            const auto tracer = value_named<Tracer>(name);
            if (!tracer || tracer == Tracer::none) return std::nullopt;
            return tracer;
        },
        [](const std::optional<Tracer>& tracer) {
            return tracer ? std::optional<std::string>(name_of(*tracer)) : std::nullopt;
        });
    add_hit(list, a.tracing);
    add_tracing(list, a.tracing);
    add_device(list, a.device);
    return list;
}

// ---- bench

namespace {

/// What kind of run it is, and of what.
void add_runs(SettingList& list, BenchArguments& a) {
    add_setting(list, a.paper,
                {.name = "paper",
                 .help = "the paper's Table 1 again: (A) building the cubes of five scenes, all anew for every frame, "
                         "(B) the rest of the frame"});
    add_setting(list, a.quick,
                {.name = "quick",
                 .help = "a small fixed selection, in two minutes on two CPU cores: two blobs and the room, pictures "
                         "of 256x192, exact, planar at 256, 3 runs",
                 .excludes = {"paper"}});
    add_setting(list, a.auto_check,
                {.name = "auto-check",
                 .help = "frames with --ldc auto and --hit auto against the best of fixed resolutions and hit tests",
                 .excludes = {"paper", "quick"}});
    add_setting(list, a.sequence,
                {.name = "sequence",
                 .help = "frames of a sequence (--repeat of them, default 60) on their whole way: rendered, written as "
                         "PNG into a folder in TMPDIR, converted for a video; beside the encoders alone; default of "
                         "--scenes: walker",
                 .excludes = {"paper", "quick", "auto-check"}});
    add_setting(list, a.models,
                {.name = "models",
                 .help = "folder with bunny_7k.off, car2.glb, chinesedragon.gltf, igea.ply and tiny.glb, or with "
                         "folders meshes and skinned that hold them; for what is missing a built-in scene stands in, "
                         "a blob of as many triangles or, for tiny.glb, the walker",
                 .form = "FOLDER",
                 .preset = "models"});
    add_list(list, a.scenes,
             {.name = "scenes",
              .help = "a list out of bunny,car,dragon,igea,tiny, built-in scenes and files (--paper: those five); "
                      "default: the five, blobs of 8 thousand to 10 million triangles, and room",
              .expected = "a list of scenes, each once",
              .excludes = {"quick"}},
             [](const std::string& name) { return name.empty() ? std::nullopt : std::optional(name); });
    add_setting(list, a.given_size,
                {.name = "size",
                 .help = "width and height of the picture",
                 .form = "WIDTHxHEIGHT",
                 .expected = "a picture size WIDTHxHEIGHT, such as 1280x1024",
                 .preset = "1280x1024",
                 .limits = kSizeLimits,
                 .excludes = {"quick"}});
    add_setting(list, a.given_repeat,
                {.name = "repeat",
                 .help = "how often everything is measured, after some runs that warm up; times are medians",
                 .preset = "20",
                 .limits = kRepeatLimits,
                 .excludes = {"quick"}});
}

void add_measured(SettingList& list, BenchArguments& a) {
    const std::string group = "What is measured";
    add_choices(list, a.hits,
                {.name = "hits",
                 .group = group,
                 .help = "a list out of planar,exact, of --paper also tolerance; default: exact,planar",
                 .expected = "a list out of tolerance,planar,exact, each once",
                 .excludes = {"quick"}});
    add_list(list, a.ldc,
             {.name = "ldc",
              .group = group,
              .help = "resolutions of the LDIs, 16 to 2048, or auto; default: auto,256,512,1024; of --paper: 512,1024",
              .expected = "a list of numbers such as 512,1024, each once",
              .limits = kResolutionLimits,
              .excludes = {"quick"}},
             parse_resolution);
    add_refine(list, a.refine, {.group = group, .help = "of exact: voxels with more than N samples become finer ones"});
    add_merge(list, a.merge,
              {.group = group, .help = "of exact: moving objects of at most N triangles share a cube; 0: none do"});
    add_choices(list, a.traversals,
                {.name = "traversals",
                 .group = group,
                 .help = "a list out of two-level,mipmap,voxel; default: voxel",
                 .expected = "a list out of two-level,mipmap,voxel, each once",
                 .excludes = {"auto-check", "quick"}});
    add_choices(list, a.rays,
                {.name = "rays",
                 .group = group,
                 .help = "a list out of primary,mirror,refraction,shadow,ambient,diffuse; default: all",
                 .expected = "a list out of primary,mirror,refraction,shadow,ambient,diffuse, each once",
                 .excludes = {"paper", "auto-check", "quick"}});
    add_setting(
        list, a.sizes,
        {.name = "sizes",
         .group = group,
         .help = "picture sizes for a series: mirror rays of the blob that is nearest to 300000 triangles; "
                 "default: 360x280 to 6400x5120, with --quick none",
         .form = "LIST|none",
         .expected = "a list of picture sizes, each once, or none",
         .limits = kSizeLimits,
         .excludes = {"paper", "auto-check", "quick"}},
        [](const std::string& text) {
            return text == "none" ? std::optional(std::vector<glm::uvec2>())
                                  : parse_list<glm::uvec2>(text, parse_size, true);
        },
        [](const std::optional<std::vector<glm::uvec2>>&) { return std::optional<std::string>(); });
}

void add_ways(SettingList& list, BenchArguments& a) {
    const std::string group =
        "Of --paper (default: the paper's system, peel with two-level and tolerance, and ours, compute with voxel and "
        "exact or planar; with a list or --all: all combinations)";
    const std::string needs = "paper";
    add_choices(list, a.builders,
                {.name = "builders",
                 .group = group,
                 .help = "a list out of peel,abuffer,compute",
                 .expected = "a list out of peel,abuffer,compute, each once",
                 .needs = needs});
    add_setting(list, a.all,
                {.name = "all",
                 .group = group,
                 .help = "every combination; those that cannot be done are left out, with the reason",
                 .needs = needs});
    add_block(list, a.block, {.group = group, .help = "pixels per block of two-level", .needs = needs});
    add_setting(list, a.routing,
                {.name = "routing",
                 .group = group,
                 .help = "how peel and abuffer send triangles to the three images",
                 .needs = needs});
    add_setting(list, a.tolerance,
                {.name = "tolerance",
                 .group = group,
                 .help = "distance of a hit of tolerance, world units; default: 0.001 if the object were one unit long",
                 .limits = kToleranceLimits,
                 .needs = needs});
}

}  // namespace

SettingList options_of(BenchArguments& a) {
    SettingList list;
    add_runs(list, a);
    add_measured(list, a);
    add_ways(list, a);
    const std::string group = "More output";
    add_file(
        list, a.output,
        {.name = "out", .group = group, .help = "also write everything as JSON, after every row", .form = "FILE.json"});
    add_file(list, a.markdown,
             {.name = "markdown", .group = group, .help = "also write the table to a file", .form = "FILE.md"});
    add_file(list, a.plots,
             {.name = "plots",
              .group = group,
              .help = "also write plots into this folder: against triangles, rays and resolution (.svg)",
              .form = "FOLDER",
              .excludes = {"paper", "auto-check"}});
    add_device(list, a.device);
    return list;
}

}  // namespace peelray
