#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "cli/values.h"
#include "image/image.h"
#include "scene/scene.h"

namespace peelray {
namespace {

/// Whatever a file's names brought along: one line, no terminal codes.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

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

void add_device_options(CLI::App& app, DeviceArguments& device) {
    app.add_option("--device", device.device,
                   "by number or part of its name, see 'peelray devices'; default: the fastest kind there is")
        ->type_name("N|NAME")
        ->group("Device");
    app.add_flag("--validate", device.validate, "run under the Vulkan validation layers; any message is an error")
        ->group("Device");
}

void add_tracing_options(CLI::App& app, TracingArguments& tracing) {
    const char* group = "Tracing";
    add_parsed(app, "--ldc", tracing.ldc, parse_resolution, "auto or a number from 16 to 2048",
               "resolution of the layered depth images, 16 to 2048; auto: by the number of triangles")
        ->type_name("auto|N")
        ->default_str("auto")
        ->group(group);
    add_choice(app, "--hit", tracing.hit, {"auto", "exact", "planar", "tolerance"},
               "exact: the triangles themselves; planar: the samples' planes, at a cost that does not depend on the "
               "number of triangles; "
               "auto: exact up to a few million triangles; tolerance: not built yet")
        ->group(group);
    add_number<double>(app, "--tolerance", tracing.tolerance, "distance of a hit of --hit tolerance, world units")
        ->default_str("0.001")
        ->group(group);
    add_choice(app, "--builder", tracing.builder, {"auto", "compute", "abuffer", "peel"},
               "how the layered depth cube is built (abuffer and peel: not built yet)")
        ->group(group);
    add_choice(app, "--traversal", tracing.traversal, {"voxel", "mipmap", "two-level"},
               "how rays walk through the cube (mipmap and two-level: not built yet)")
        ->group(group);
    add_parsed(app, "--block", tracing.block, parse_block, "a number of pixels such as 8 or 8x4",
               "pixels per block of --traversal two-level")
        ->type_name("N|NxM")
        ->default_str("8")
        ->group(group);
}

std::string builtin_list() {
    std::string text = "Built-in scenes:\n";
    for (const BuiltinScene& scene : builtin_scenes())
        text += fmt::format("  builtin:{:<10} {}\n", scene.name, scene.description);
    return text;
}

const char* const kSceneHelp = "a file (.gltf, .glb, .obj, .ply, .stl, .off) or builtin:NAME";

void add_render(CLI::App& program, RenderArguments& a) {
    CLI::App& app = *program.add_subcommand("render", "Render a scene to a picture");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    app.add_option("-o,--output", a.output, "picture to write: .png (tone-mapped sRGB), .exr or .hdr (linear radiance)")
        ->required()
        ->type_name("FILE");
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
    add_number<double>(app, "--time", a.time, "moment of the animation (not built yet: only 0)")
        ->type_name("SECONDS")
        ->group(view);
    app.add_option("--frames", a.frames, "frames of the animation (not built yet)")
        ->type_name("A:B")
        ->excludes("--time")
        ->group(view);
    add_number<double>(app, "--fps", a.fps, "frames per second (not built yet)")->group(view);

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
    add_choice(
        app, "--tracer", a.tracing.tracer, {"ldc", "reference", "cubemap", "khr", "none"},
        "ldc: secondary rays, traced in the layered depth cube; reference: all rays on the CPU in double "
        "precision; cubemap: the baseline without rays, cube maps of each object's surroundings and shadow maps; "
        "none: neither; khr: not built yet")
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
    add_tracing_options(app, a.tracing);

    const char* output = "More output";
    add_parsed(app, "--aov", a.aovs, parse_aovs, "a list out of depth,normal,albedo,position,triangle,material, or all",
               "also write these to NAME.KIND.exr beside NAME.png: a list out of "
               "depth,normal,albedo,position,triangle,material, or all")
        ->type_name("LIST")
        ->group(output);
    app.add_option("--stats", a.stats, "also write times, rays and memory as JSON")->type_name("FILE")->group(output);
    add_number<uint32_t>(app, "--repeat", a.repeat,
                         "for measuring: 2 or more frames after a first one that warms up; times are medians")
        ->default_str("1")
        ->group(output);
    add_device_options(app, a.device);
    app.footer(builtin_list() +
               "\nExamples:\n"
               "  peelray render builtin:teapots -o teapots.png --spp 16\n"
               "  peelray render model.glb -o picture.png --env studio.hdr --eye 2,1,3 --look 0,0.5,0\n"
               "  peelray render bunny.off -o mirror.png --material mirror --floor --stats stats.json");
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
    app.add_flag("--any-hit", a.any_hit, "stop at any hit, not only at the nearest: for shadow rays");
    app.add_option("--stats", a.stats, "also write times and memory as JSON")->type_name("FILE");
    add_number<uint32_t>(app, "--repeat", a.repeat,
                         "for measuring: trace 2 or more times after a first one that warms up; times are medians")
        ->default_str("1");
    add_choice(app, "--tracer", a.tracing.tracer, {"ldc", "reference", "cubemap", "khr"}, "only ldc is built yet")
        ->group("Tracing");
    add_tracing_options(app, a.tracing);
    add_device_options(app, a.device);
    app.footer(
        "Example, with NumPy: one ray from (0, 1, 9) along -z:\n"
        "  python3 -c \"import numpy as n; n.save('rays.npy', n.array([[0,1,9,0, 0,0,-1,100]], n.float32))\"\n"
        "  peelray trace builtin:teapots --rays rays.npy --out hits.npy\n"
        "  python3 -c \"import numpy as n; print(n.load('hits.npy'))\"");
}

/// What is wrong with the command line.
std::string describe(const CLI::ParseError& error, const CLI::App& program) {
    const auto chosen = program.get_subcommands();
    // What was not understood explains why something else seems missing.
    const auto rest = chosen.empty() ? program.remaining() : chosen.front()->remaining();
    const auto option = std::find_if(rest.begin(), rest.end(),
                                     [](const std::string& text) { return text.size() > 1 && text[0] == '-'; });
    if (option != rest.end()) return fmt::format("unknown option '{}'", *option);
    if (chosen.empty()) {
        const char* commands = "render, trace, info or devices";
        return rest.empty() ? fmt::format("name a command: {}", commands)
                            : fmt::format("unknown command '{}': there are {}", rest.front(), commands);
    }
    if (!rest.empty()) return fmt::format("'{}' is one argument too many", rest.front());
    return error.what();
}

}  // namespace

const char* build_commit() {
    return PEELRAY_COMMIT;
}

void TracingArguments::check() const {
    const auto later = [](const char* option, const std::string& value, const char* instead) {
        fail("{} {} is not built into this version: use {}", option, value, instead);
    };
    if (tracer == "khr") later("--tracer", tracer, "--tracer ldc");
    if (builder != "auto" && builder != "compute") later("--builder", builder, "--builder compute");
    if (hit == "tolerance") later("--hit", hit, "--hit exact or planar");
    if (traversal != "voxel") later("--traversal", traversal, "--traversal voxel");
    if (ldc && (*ldc < 16 || *ldc > 2048))
        fail("an LDI resolution of {} is out of range: choose 16 to 2048, or auto (--ldc)", *ldc);
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        fail("a tolerance of {} is impossible: choose a distance above 0 (--tolerance)", tolerance);
    if (block.x < 1 || block.y < 1 || block.x > 64 || block.y > 64)
        fail("a block of {}x{} pixels is out of range: choose 1 to 64 a side (--block)", block.x, block.y);
}

Geometry visible_geometry(const Scene& scene) {
    Geometry geometry = flatten(scene);
    const size_t count = geometry.triangles.size();
    if (geometry.zero_area == count)
        fail("{}: none of its {} triangles has an area; give a file with a surface", scene.name, count);
    const auto note = [](const std::string& text) { fmt::print(stderr, "peelray: note: {}\n", one_line(text)); };
    for (const std::string& text : scene.notes) note(text);
    if (geometry.zero_area > 0)
        note(fmt::format("{} of {} triangles have no area: they can never be hit", geometry.zero_area, count));
    for (const std::string& extension : scene.extensions_unsupported)
        note(fmt::format("the extension {} has no effect in this version", extension));
    return geometry;
}

void check_repeat(uint32_t repeat) {
    if (repeat < 1 || repeat > 10000) fail("{} repetitions are out of range: choose 1 to 10000 (--repeat)", repeat);
}

void check_outputs(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs) {
    std::error_code error;
    const auto whole = [&](const std::filesystem::path& path) {
        return std::filesystem::weakly_canonical(path, error);
    };
    for (size_t i = 0; i < outputs.size(); i++) {
        check_writable(outputs[i]);
        for (size_t k = 0; k < i; k++)
            if (whole(outputs[k]) == whole(outputs[i]))
                fail("{} would be written twice: give each output a name of its own", outputs[i].string());
        for (const auto& input : inputs)
            if (!input.empty() && whole(input) == whole(outputs[i]))
                fail("{} is an input and would be overwritten: name another output", input.string());
    }
}

int run_program(int argc, const char* const* argv) {
    CLI::App program{
        "Peelray: ray-traced reflections, refractions and shadows without ray-tracing hardware.\n"
        "It turns the scene into a layered depth cube, in which it traces the secondary rays."};
    program.name("peelray");
    program.require_subcommand(1);
    program.set_version_flag("--version", std::string("peelray ") + PEELRAY_VERSION + " (" + PEELRAY_COMMIT + ")");
    program.footer(
        "Try:  peelray render builtin:teapots -o teapots.png\n"
        "Each command has its own help:  peelray render --help");
    program.get_formatter()->column_width(34);

    RenderArguments render;
    TraceArguments trace;
    std::string info_scene;
    add_render(program, render);
    add_trace(program, trace);
    CLI::App* info = program.add_subcommand("info", "Print what a scene holds");
    info->add_option("SCENE", info_scene, kSceneHelp)->required()->type_name("");
    info->footer(builtin_list());
    program.add_subcommand("devices", "List the Vulkan devices (for --device)")->footer("");
    CLI::App* later[] = {program.add_subcommand("compare", "Compare tracers (not built into this version)"),
                         program.add_subcommand("bench", "Measure (not built into this version)"),
                         program.add_subcommand("view", "Look around interactively (not built into this version)")};
    for (CLI::App* app : later) app->allow_extras()->footer("");

    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // help and version
            program.exit(error);
            return 0;
        }
        const auto chosen = program.get_subcommands();
        fmt::print(stderr, "peelray: {} (see 'peelray{}{} --help')\n", one_line(describe(error, program)),
                   chosen.empty() ? "" : " ", chosen.empty() ? "" : chosen.front()->get_name());
        return 2;
    }
    try {
        if (program.got_subcommand("render")) run_render(render);
        if (program.got_subcommand("trace")) run_trace(trace);
        if (program.got_subcommand("info")) run_info(info_scene);
        if (program.got_subcommand("devices")) run_devices();
        for (CLI::App* app : later)
            if (app->parsed())
                fail("'{}' is not built into this version: there are render, trace, info and devices", app->get_name());
        if (std::fflush(stdout) != 0) fail("cannot write to the standard output: {}", std::strerror(errno));
    } catch (const Error& error) {
        fmt::print(stderr, "peelray: {}\n", one_line(error.what()));
        return 1;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "peelray: out of memory: the scene or picture is too large for this machine\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "peelray: internal error: {}: please report it\n", one_line(error.what()));
        return 1;
    }
    return 0;
}

}  // namespace peelray
