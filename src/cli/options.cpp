#include "cli/options.h"

#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "base/error.h"
#include "builtin/builtin.h"
#include "cli/values.h"
#include "scene/scene.h"

namespace peelray {
namespace {

/// An option whose text `parse` turns into a value. Text of another form than `form` is wrong usage.
template <typename Value, typename Parsed>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value,
                        std::optional<Parsed> (*parse)(const std::string&), const std::string& form,
                        const std::string& help) {
    return app.add_option_function<std::string>(
        name,
        [=, &value](const std::string& text) {
            const auto parsed = parse(text);
            if (!parsed) throw CLI::ValidationError(name, fmt::format("'{}' is not {}", text, form));
            value = *parsed;
        },
        help);
}

/// An option that is one number.
template <typename Number, typename Value>
CLI::Option* add_number(CLI::App& app, const std::string& name, Value& value, const std::string& help) {
    const auto parse = +[](const std::string& text) { return parse_number<Number>(text); };
    return add_parsed(app, name, value, parse, std::is_integral_v<Number> ? "a whole number from 0 up" : "a number",
                      help)
        ->type_name(std::is_integral_v<Number> ? "N" : "X");
}

CLI::Option* add_choice(CLI::App& app, const std::string& name, std::string& value,
                        const std::vector<std::string>& choices, const std::string& help) {
    std::string known;
    for (const std::string& choice : choices) known += (known.empty() ? "" : "|") + choice;
    const auto check = [=](const std::string& text) {
        const bool found = std::find(choices.begin(), choices.end(), text) != choices.end();
        return found ? "" : fmt::format("'{}' is not one of {}", text, known);
    };
    return app.add_option(name, value, help)->check(check)->type_name(known)->capture_default_str();
}

CLI::Option* add_block(CLI::App& app, glm::uvec2& block, const std::string& help) {
    return add_parsed(app, "--block", block, parse_block, "a number of pixels such as 8 or 8x4", help)
        ->type_name("N|NxM")
        ->default_str("8");
}

CLI::Option* add_routing(CLI::App& app, std::string& routing, const std::string& help) {
    return add_choice(app, "--routing", routing, {"geometry", "draws"}, help);
}

void add_device_options(CLI::App& app, DeviceArguments& device) {
    app.add_option("--device", device.device,
                   "by number or part of its name, see 'peelray devices'; default: the fastest kind there is")
        ->type_name("N|NAME")
        ->group("Device");
    app.add_flag("--validate", device.validate, "run under the Vulkan validation layers; any message is an error")
        ->group("Device");
}

const std::vector<std::string> kHits = {"auto", "exact", "planar", "tolerance"};
const char* const kHitHelp =
    "exact: the triangles themselves; planar: the samples' planes, at a cost that does not depend on the number of "
    "triangles; tolerance: the samples' depths, within --tolerance, as in the paper; auto: exact up to a few million "
    "triangles (with --builder peel: planar)";

void add_tracing_options(CLI::App& app, TracingArguments& tracing) {
    const char* group = "Tracing";
    add_parsed(
        app, "--ldc", tracing.ldc, parse_resolution, "auto or a number from 16 to 2048",
        "voxels along the longest side of the largest part that has a cube of its own, 16 to 2048; smaller parts get "
        "fewer; auto: by the number of triangles of each")
        ->type_name("auto|N")
        ->default_str("auto")
        ->group(group);
    add_number<double>(app, "--tolerance", tracing.tolerance, "distance of a hit of --hit tolerance, world units")
        ->default_str("0.001")
        ->group(group);
    add_choice(
        app, "--builder", tracing.builder, {"auto", "compute", "abuffer", "peel"},
        "who rasterises the layered depth cubes: compute shaders; the graphics pipeline in one pass (abuffer) or a "
        "pass per layer (peel, as in the paper); auto: compute")
        ->group(group);
    add_routing(app, tracing.routing,
                "how the graphics pipeline sends triangles to the three images: a geometry shader, or three draws")
        ->group(group);
    add_number<uint32_t>(app, "--depth", tracing.depth,
                         "bits of the samples' depths of --traversal two-level and mipmap: 32, or 16 as in the paper")
        ->type_name("16|32")
        ->default_str("32")
        ->group(group);
    add_choice(app, "--batch", tracing.batch, {"none", "layers", "rays"},
               "for measuring: two-level and mipmap test four layers of a pixel, or trace four rays, at a time")
        ->group(group);
    add_choice(
        app, "--traversal", tracing.traversal, {"voxel", "mipmap", "two-level"},
        "how rays walk through a cube: all of it at once by voxels, or one image after the other over blocks of pixels "
        "(two-level, as in the paper) or a full pyramid (mipmap)")
        ->group(group);
    add_block(app, tracing.block, "pixels per block of --traversal two-level, 2 to 32 a side")->group(group);
}

}  // namespace

std::string builtin_list() {
    std::string text = "Built-in scenes:\n";
    for (const BuiltinScene& scene : builtin_scenes())
        text += fmt::format("  builtin:{:<10} {}\n", scene.name, scene.description);
    return text;
}

const char* const kSceneHelp = "a file (.gltf, .glb, .obj, .ply, .stl, .off) or builtin:NAME";

namespace {

/// What a picture shows and how it is made; `compares`: the tracer and the hit test are lists of the caller's.
void add_picture_options(CLI::App& app, PictureArguments& a, bool compares) {
    add_parsed(app, "--size", a.size, parse_size, "a picture size WIDTHxHEIGHT, such as 1280x1024",
               "width and height in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->default_str("1280x1024");

    const char* view = "View";
    const char* vector = "three numbers X,Y,Z";
    add_parsed(app, "--eye", a.eye, parse_vector, vector, "where the camera stands")->type_name("X,Y,Z")->group(view);
    add_parsed(app, "--look", a.look, parse_vector, vector, "the point it looks at; default: the scene's centre")
        ->type_name("X,Y,Z")
        ->group(view);
    add_parsed(app, "--up", a.up, parse_vector, vector, "its upward direction; default: 0,1,0")
        ->type_name("X,Y,Z")
        ->group(view);
    add_number<float>(app, "--fov", a.fov, "vertical field of view; default: the camera's own, 40 where there is none")
        ->type_name("DEGREES")
        ->group(view);
    app.add_option("--camera", a.camera,
                   "a camera of the scene, see 'peelray info SCENE'; default: the first, or the whole scene in view")
        ->type_name("NAME|N")
        ->group(view);
    add_number<double>(app, "--time", a.time, "moment of the animation; default: everything at rest")
        ->type_name("SECONDS")
        ->group(view);
    app.add_option("--animation", a.animation,
                   "which one, see 'peelray info SCENE', or all at once; default: the first, with --time or --frames")
        ->type_name("NAME|N|all")
        ->group(view);

    const char* light = "Light";
    CLI::Option* env = app.add_option("--env", a.env, "environment map, equirectangular .hdr or .exr")
                           ->type_name("FILE")
                           ->group(light);
    CLI::Option* sky =
        app.add_flag("--sky", a.sky, "procedural sky with a sun; the default where the scene has no lights")
            ->excludes(env)
            ->group(light);
    add_parsed(app, "--background", a.background, parse_vector, "three numbers R,G,B",
               "one colour from everywhere, linear, from 0 up")
        ->type_name("R,G,B")
        ->excludes(env)
        ->excludes(sky)
        ->group(light);
    add_number<float>(app, "--exposure", a.exposure, "of a .png, in stops: each doubles the brightness")
        ->default_str("0")
        ->type_name("STOPS")
        ->group(light);
    add_choice(app, "--tonemap", a.tonemap, {"none", "aces", "neutral"}, "tone curve of a .png")->group(light);

    const char* effects = "Effects";
    if (!compares)
        add_choice(app, "--tracer", a.tracing.tracer, {"ldc", "reference", "cubemap", "khr", "none"},
                   "ldc: secondary rays, traced in the layered depth cube; reference: all rays on the CPU in double "
                   "precision; cubemap: the baseline without rays, cube maps of each object's surroundings and shadow "
                   "maps; none: neither; khr: secondary rays by the device's own ray tracing, where it has one "
                   "(VK_KHR_ray_tracing_pipeline)")
            ->group(effects);
    add_parsed(app, "--effects", a.effects, parse_effects,
               "a list out of reflection,refraction,shadow,ambient, or none",
               "what is traced, a list out of reflection,refraction,shadow,ambient, or none")
        ->type_name("LIST")
        ->default_str("reflection,refraction,shadow")
        ->group(effects);
    add_number<uint32_t>(app, "--bounces", a.bounces, "reflections and refractions in a row, 0 to 16")
        ->default_str("4")
        ->group(effects);
    add_number<uint32_t>(app, "--spp", a.spp, "samples per pixel: smooth edges and rough reflections")
        ->default_str("1")
        ->group(effects);
    add_choice(app, "--material", a.material, {"mirror", "glass", "clay"}, "make every surface of this")
        ->group(effects);
    app.add_flag("--floor", a.floor, "put the scene on a floor that mirrors a little")->group(effects);
    if (!compares) add_choice(app, "--hit", a.tracing.hit, kHits, kHitHelp)->group("Tracing");
    add_tracing_options(app, a.tracing);

    add_choice(
        app, "--visibility", a.visibility, {"auto", "compute", "raster"},
        "who finds what each pixel sees: compute shaders, or the graphics pipeline; auto: compute, where the device "
        "has 64-bit atomics and is no software")
        ->group("Tracing");
    add_number<uint32_t>(app, "--repeat", a.repeat,
                         "for measuring: 2 or more frames after a first one that warms up; times are medians")
        ->default_str("1")
        ->group("More output");
    app.add_flag(
           "--rebuild", a.rebuild,
           "for measuring: every cube, or acceleration structure, anew in every frame, as if everything changed its "
           "shape")
        ->group("More output");
    add_device_options(app, a.device);
}

}  // namespace

namespace {

/// The options that only several pictures in a row have.
constexpr const char* kSequenceOptions[] = {"--frames", "--turntable", "--fps", "--shard", "--resume"};

void add_sequence_options(CLI::App& app, SequenceArguments& a) {
    const char* group = "Several frames";
    add_parsed(
        app, "--frames", a.frames, parse_frames, "a range of frames A:B, such as 0:48",
        "the frames A, A+1, ..., B-1 of the animation (without B); frame k shows the moment k/F seconds. The output "
        "is then a name with one number, such as frame_%05d.exr, or a video, .mp4 or .webm")
        ->type_name("A:B")
        ->group(group);
    add_number<double>(app, "--fps", a.fps, "frames per second")->type_name("F")->default_str("30")->group(group);
    add_number<uint32_t>(app, "--turntable", a.turntable,
                         "N frames in which the camera goes once round the vertical line through its look point; all "
                         "else stands at --time or at rest, with --animation or --fps the animation runs")
        ->group(group);
    add_parsed(app, "--shard", a.shard, parse_shard, "a part i/n, such as 0/4",
               "only every n-th frame, from the i-th of the range on (i from 0): one of n runs that share the work")
        ->type_name("i/n")
        ->group(group);
    app.add_flag("--resume", a.resume, "go on with a run that ended early: leave the frames alone that it finished")
        ->group(group);
}

/// Makes `app` say where several frames are to be had.
void refuse_sequence_options(CLI::App& app) {
    for (const std::string name : kSequenceOptions)
        app.add_option_function<std::vector<std::string>>(
               name,
               [name](const std::vector<std::string>&) {
                   throw CLI::ValidationError(
                       name, "a comparison shows one moment (--time); several frames are for 'peelray render'");
               })
            ->expected(0, 1)
            ->group("");
}

}  // namespace

void add_render(CLI::App& program, RenderArguments& a) {
    CLI::App& app = *program.add_subcommand("render", "Render a scene to a picture, several or a video");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    app.add_option("-o,--output", a.output,
                   "picture to write: .png (tone-mapped sRGB), .exr or .hdr (linear radiance); for several frames see "
                   "--frames")
        ->required()
        ->type_name("FILE");
    add_picture_options(app, a, false);
    add_sequence_options(app, a.sequence);
    const char* output = "More output";
    add_parsed(
        app, "--aov", a.aovs, parse_aovs,
        "a list out of depth,normal,albedo,position,triangle,material,reflection,box,directions,cost_steps,cost_cells,"
        "cost_pixels,cost_samples,cost_triangles, or all",
        "also write these to NAME.KIND.exr beside NAME.png: a list out of "
        "depth,normal,albedo,position,triangle,material, or all of them; or out of reflection,box,directions: what "
        "the paper sets up for mirror rays (its Figure 7); or out of cost_steps,cost_cells,cost_pixels,cost_samples,"
        "cost_triangles: what all rays of a pixel cost in the cubes, with a heat map NAME.KIND.png")
        ->type_name("LIST")
        ->group(output);
    app.add_option("--stats", a.stats, "also write times, rays and memory as JSON")->type_name("FILE")->group(output);
    app.add_flag(
           "--counters", a.counters,
           "count what rays cost, for the stats: cells stepped to, lists met, pixels, samples and triangles tested; "
           "times are then not to be trusted")
        ->group(output);
    app.footer(builtin_list() +
               "\nExamples:\n"
               "  peelray render builtin:teapots -o teapots.png --spp 16\n"
               "  peelray render model.glb -o picture.png --env studio.hdr --eye 2,1,3 --look 0,0.5,0\n"
               "  peelray render bunny.off -o mirror.png --material mirror --floor --stats stats.json\n"
               "  peelray render walk.glb -o walk.mp4 --frames 0:90 --floor\n"
               "  peelray render bunny.off -o turn_%03d.png --turntable 120 --resume");
}

CLI::App& add_compare(CLI::App& program, CompareArguments& a) {
    CLI::App& app =
        *program.add_subcommand("compare", "Render a scene with several tracers and report how they differ");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    app.add_option("-o,--output", a.output, "report to write: one HTML file that needs nothing else")
        ->required()
        ->type_name("FILE.html");
    add_picture_options(app, a, true);
    refuse_sequence_options(app);
    const char* group = "Comparison";
    add_parsed(app, "--tracers", a.tracers, parse_tracers, "a list out of cubemap,ldc,reference,none,khr, each once",
               "who renders, a list out of cubemap,ldc,reference,none,khr")
        ->type_name("LIST")
        ->default_str("cubemap,ldc,reference")
        ->group(group);
    add_parsed(app, "--hit", a.hits, parse_hits, "a list out of auto,exact,planar,tolerance, each once",
               "hit tests of ldc, one picture each, a list out of auto,exact,planar,tolerance")
        ->type_name("LIST")
        ->default_str("auto")
        ->group(group);
    app.add_option(
           "--picture", a.pictures,
           "also compare this picture of the same scene and size, by another program: .png, .jpg (as it is) or .exr, "
           ".hdr (tone-mapped like the others); may be given several times")
        ->type_name("FILE")
        ->group(group)
        ->allow_extra_args(false);
    app.add_option("--json", a.json, "also write metrics and stats as JSON")->type_name("FILE")->group(group);
    app.add_option("--strip", a.strip, "also write all pictures side by side")->type_name("FILE.png")->group(group);
    app.add_option(
           "--worst", a.worst,
           "also write what surrounds each picture's worst pixel, magnified: the picture, the reference, the error")
        ->type_name("FILE.png")
        ->group(group);
    app.footer(
        "Pictures are compared with the one of --tracer reference, or with the last one where there is none.\n\n"
        "Examples:\n"
        "  peelray compare builtin:teapots -o report.html\n"
        "  peelray compare model.glb -o report.html --tracers ldc,reference --hit exact,planar --ldc 1024");
    return app;
}

void add_trace(CLI::App& program, TraceArguments& a) {
    CLI::App& app = *program.add_subcommand("trace", "Trace the rays of a .npy file and write what they hit");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    app.add_option(
           "--rays", a.rays,
           "rays to trace: float32 (n, 8): ox oy oz tmin dx dy dz tmax, in world units; t counts in lengths of d")
        ->required()
        ->type_name("FILE.npy");
    app.add_option("--out", a.hits,
                   "hits to write: structured (n): t f4 (+inf: a miss), triangle u4 (in file order), u f4, v f4")
        ->required()
        ->type_name("FILE.npy");
    app.add_option("--counters", a.counters,
                   "also write what each ray cost: structured (n): steps, cells, pixels, samples, triangles, u4 each; "
                   "times are then not to be trusted")
        ->type_name("FILE.npy");
    app.add_flag("--any-hit", a.any_hit, "stop at any hit, not only at the nearest: for shadow rays");
    app.add_option("--stats", a.stats, "also write times and memory as JSON")->type_name("FILE");
    add_number<uint32_t>(app, "--repeat", a.repeat,
                         "for measuring: trace 2 or more times after a first one that warms up; times are medians")
        ->default_str("1");
    add_choice(app, "--tracer", a.tracing.tracer, {"ldc", "reference", "cubemap", "khr"},
               "ldc: in the layered depth cubes; khr: by the device's own ray tracing, where it has one")
        ->group("Tracing");
    add_choice(app, "--hit", a.tracing.hit, kHits, kHitHelp)->group("Tracing");
    add_tracing_options(app, a.tracing);
    add_device_options(app, a.device);
    app.footer(
        "Example, with NumPy: one ray from (0, 1, 9) along -z:\n"
        "  python3 -c \"import numpy as n; n.save('rays.npy', n.array([[0,1,9,0, 0,0,-1,100]], n.float32))\"\n"
        "  peelray trace builtin:teapots --rays rays.npy --out hits.npy\n"
        "  python3 -c \"import numpy as n; print(n.load('hits.npy'))\"");
}

/// What belongs together although each option is well-formed. Throws CLI::ValidationError.
static void check_bench_usage(const BenchArguments& a) {
    if (!a.paper) return;
    if (!are_paper_scenes(a.scenes))
        throw CLI::ValidationError(
            "--scenes", fmt::format("'{}' is not a list out of bunny,car,dragon,igea,tiny, each once (--paper)",
                                    fmt::join(a.scenes, ",")));
    if (std::find(a.ldc.begin(), a.ldc.end(), std::nullopt) != a.ldc.end())
        throw CLI::ValidationError(
            "--ldc", "'auto' is not a list of numbers such as 512,1024, each once, as --paper needs them");
}

void add_bench(CLI::App& program, BenchArguments& a) {
    CLI::App& app = *program.add_subcommand(
        "bench", "Measure: cubes, rays and frames, against rivals on the same rays; the paper's Table 1 (--paper)");
    CLI::Option* paper = app.add_flag(
        "--paper", a.paper,
        "the paper's Table 1 again: (A) building the cubes of five scenes, all anew for every frame, (B) the rest of "
        "the frame");
    CLI::Option* quick = app.add_flag("--quick", a.quick,
                                      "a small fixed selection, in two minutes on two CPU cores: two blobs and the "
                                      "room, pictures of 256x192, exact, planar at 256, 3 runs")
                             ->excludes(paper);
    CLI::Option* automatic =
        app.add_flag("--auto-check", a.auto_check,
                     "frames with --ldc auto and --hit auto against the best of fixed resolutions and hit tests")
            ->excludes(paper)
            ->excludes(quick);
    app.add_option(
           "--models", a.models,
           "folder with bunny_7k.off, car2.glb, chinesedragon.gltf, igea.ply and tiny.glb, or with folders meshes "
           "and skinned that hold them; for what is missing a built-in scene stands in, a blob of as many triangles "
           "or, for "
           "tiny.glb, the walker")
        ->type_name("FOLDER")
        ->default_str("models");
    add_parsed(
        app, "--scenes", a.scenes, parse_bench_scenes, "a list of scenes, each once",
        "a list out of bunny,car,dragon,igea,tiny, built-in scenes and files (--paper: those five); default: the "
        "five, blobs of 8 thousand to 10 million triangles, and room")
        ->type_name("LIST")
        ->excludes(quick);
    add_parsed(app, "--size", a.given_size, parse_size, "a picture size WIDTHxHEIGHT, such as 1280x1024",
               "width and height of the picture")
        ->type_name("WIDTHxHEIGHT")
        ->default_str("1280x1024")
        ->excludes(quick);
    add_number<uint32_t>(app, "--repeat", a.given_repeat,
                         "how often everything is measured, after some that warm up; times are medians")
        ->default_str("20")
        ->excludes(quick);

    const char* group = "What is measured";
    add_parsed(app, "--hits", a.hits, parse_hit_tests, "a list out of tolerance,planar,exact, each once",
               "a list out of planar,exact, of --paper also tolerance; default: exact,planar")
        ->type_name("LIST")
        ->group(group)
        ->excludes(quick);
    add_parsed(app, "--ldc", a.ldc, parse_resolutions, "a list of numbers such as 512,1024, each once",
               "resolutions of the LDIs, 16 to 2048, or auto; default: auto,256,512,1024; of --paper: 512,1024")
        ->type_name("LIST")
        ->group(group)
        ->excludes(quick);
    add_parsed(app, "--traversals", a.traversals, parse_traversals, "a list out of two-level,mipmap,voxel, each once",
               "a list out of two-level,mipmap,voxel; default: voxel")
        ->type_name("LIST")
        ->excludes(automatic)
        ->group(group)
        ->excludes(quick);
    add_parsed(app, "--rays", a.rays, parse_ray_kinds,
               "a list out of primary,mirror,refraction,shadow,ambient,diffuse, each once",
               "a list out of primary,mirror,refraction,shadow,ambient,diffuse; default: all")
        ->type_name("LIST")
        ->excludes(paper)
        ->excludes(automatic)
        ->group(group)
        ->excludes(quick);
    add_parsed(app, "--sizes", a.sizes, parse_sizes, "a list of picture sizes, each once, or none",
               "picture sizes for a series: mirror rays of the blob that is nearest to 300000 triangles; default: "
               "360x280 to 6400x5120, with --quick none")
        ->type_name("LIST|none")
        ->excludes(paper)
        ->excludes(automatic)
        ->group(group)
        ->excludes(quick);

    const char* ways =
        "Of --paper (default: the paper's system, peel with two-level and tolerance, and ours, compute with voxel and "
        "exact or planar; with a list or --all: all combinations)";
    add_parsed(app, "--builders", a.builders, parse_builders, "a list out of peel,abuffer,compute, each once",
               "a list out of peel,abuffer,compute")
        ->type_name("LIST")
        ->needs(paper)
        ->group(ways);
    app.add_flag("--all", a.all, "every combination; what cannot be done is left out, with the reason")
        ->needs(paper)
        ->group(ways);
    add_block(app, a.block, "pixels per block of two-level")->needs(paper)->group(ways);
    add_routing(app, a.routing, "how peel and abuffer send triangles to the three images")->needs(paper)->group(ways);
    add_number<double>(app, "--tolerance", a.tolerance,
                       "distance of a hit of tolerance, world units; default: 0.001 if the object were one unit long")
        ->needs(paper)
        ->group(ways);
    const char* output = "More output";
    app.add_option("--out", a.output, "also write everything as JSON, after every row")
        ->type_name("FILE.json")
        ->group(output);
    app.add_option("--markdown", a.markdown, "also write the table to a file")->type_name("FILE.md")->group(output);
    app.add_option("--plots", a.plots,
                   "also write plots into this folder: against triangles, rays and resolution (.svg)")
        ->type_name("FOLDER")
        ->excludes(paper)
        ->excludes(automatic)
        ->group(output);
    add_device_options(app, a.device);
    app.callback([&a] { check_bench_usage(a); });
    app.footer(
        "The time of rays is withheld when the oracle, a double-precision ray tracer, finds too many answers wrong.\n\n"
        "Examples:\n"
        "  peelray bench --quick\n"
        "  peelray bench --models models --out bench.json --markdown bench.md --plots plots\n"
        "  peelray bench --scenes blob:120000,car.glb --rays mirror,shadow --ldc auto,256 --sizes none\n"
        "  peelray bench --paper --models models --out bench.json\n"
        "  peelray bench --paper --scenes bunny --builders compute --traversals voxel --ldc 256,512,1024");
}

std::vector<std::string> given_options(const CLI::App& app) {
    static const std::vector<std::string> own = {"--output", "--tracers", "--hit",  "--picture",
                                                 "--json",   "--strip",   "--worst"};
    std::vector<std::string> words;
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || !name.starts_with("--") || std::find(own.begin(), own.end(), name) != own.end())
            continue;
        words.push_back(name);
        if (option->get_expected_max() > 0)
            for (const std::string& value : option->results()) words.push_back(value);
    }
    return words;
}

}  // namespace peelray
