#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>

#include "base/error.h"

namespace peelray {
namespace {

void add_device_options(CLI::App& app, DeviceArguments& device) {
    app.add_option("--device", device.device, "GPU by number or part of its name (see 'peelray devices'); default: the fastest kind there is")
        ->group("Device");
    app.add_flag("--validate", device.validate, "run under the Vulkan validation layers; any message is an error")->group("Device");
}

void add_tracing_options(CLI::App& app, TracingArguments& tracing) {
    const char* group = "Tracing";
    app.add_option("--builder", tracing.builder, "how the layered depth cube is built")
        ->check(CLI::IsMember({"auto", "compute", "abuffer", "peel"}))->capture_default_str()->group(group);
    app.add_option("--hit", tracing.hit, "exact: the triangles themselves; planar: the samples' planes, cost independent of the triangle count; "
                                         "tolerance: the paper's test")
        ->check(CLI::IsMember({"auto", "exact", "planar", "tolerance"}))->capture_default_str()->group(group);
    app.add_option("--tolerance", tracing.tolerance, "distance of a 'tolerance' hit, world units")->capture_default_str()->group(group);
    app.add_option("--traversal", tracing.traversal, "how rays walk through the cube")
        ->check(CLI::IsMember({"voxel", "mipmap", "two-level"}))->capture_default_str()->group(group);
    app.add_option("--block", tracing.block, "pixels per block of the two-level traversal, n or nxm")->capture_default_str()->group(group);
    app.add_option("--ldc", tracing.ldc, "resolution of the layered depth images: auto or 16 to 2048")->capture_default_str()->group(group);
}

void add_render(CLI::App& program, RenderArguments& a) {
    CLI::App& app = *program.add_subcommand("render", "Render a scene to a picture");
    app.add_option("SCENE", a.scene, "a file (glTF, GLB, OBJ, PLY, STL, OFF) or builtin:teapots|glass|tree|blob:N")->required();
    app.add_option("-o,--output", a.output, "picture to write: .png (tone-mapped sRGB), .exr or .hdr (linear radiance)")->required();
    app.add_option("--size", a.size, "width x height in pixels")->capture_default_str();

    const char* view = "View";
    app.add_option("--eye", a.eye, "camera position x,y,z")->delimiter(',')->expected(3)->group(view);
    app.add_option("--look", a.look, "point it looks at; default: the scene's centre")->delimiter(',')->expected(3)->group(view);
    app.add_option("--up", a.up, "up direction; default: 0,1,0")->delimiter(',')->expected(3)->group(view);
    app.add_option("--fov", a.fov, "vertical field of view in degrees")->group(view);
    app.add_option("--camera", a.camera, "a camera of the file, by name or number; default: the first, else the scene is framed")->group(view);
    app.add_option("--time", a.time, "time of the animation in seconds (animations are not played yet: only 0)")->group(view);

    const char* light = "Light";
    app.add_option("--env", a.env, "environment map, equirectangular .hdr or .exr")->group(light);
    app.add_flag("--sky", a.sky, "procedural sky with a sun (the default where the scene has no lights)")->group(light);
    app.add_option("--background", a.background, "one colour from everywhere, linear r,g,b")->group(light);
    app.add_option("--exposure", a.exposure, "stops; for .png only")->capture_default_str()->group(light);
    app.add_option("--tonemap", a.tonemap, "tone curve of .png")->check(CLI::IsMember({"none", "aces", "neutral"}))->capture_default_str()->group(light);

    const char* effects = "Effects";
    app.add_option("--tracer", a.tracing.tracer, "ldc: rays traced in the layered depth cube; none: primary shading only")
        ->check(CLI::IsMember({"ldc", "reference", "cubemap", "khr", "none"}))->capture_default_str()->group(effects);
    app.add_option("--bounces", a.bounces, "secondary rays in a row, 0 to 16")->capture_default_str()->group(effects);
    app.add_option("--spp", a.spp, "samples per pixel: antialiasing and rough reflections")->capture_default_str()->group(effects);
    app.add_option("--effects", a.effects, "what is traced: any of reflection,refraction,shadow,ambient, or none")->capture_default_str()->group(effects);
    app.add_option("--material", a.material, "give every surface this material: mirror, glass, clay")
        ->check(CLI::IsMember({"mirror", "glass", "clay"}))->group(effects);
    app.add_flag("--floor", a.floor, "put the scene on a floor that mirrors a little")->group(effects);
    add_tracing_options(app, a.tracing);

    const char* output = "More output";
    app.add_option("--aov", a.aov, "also write depth,normal,albedo,position,triangle,material: OUT.NAME.exr each (a list, or all)")->group(output);
    app.add_option("--stats", a.stats, "write times, rays and memory as JSON")->group(output);
    app.add_option("--repeat", a.repeat, "render so many frames after a first one; times are medians (for measuring)")->capture_default_str()->group(output);
    add_device_options(app, a.device);
    app.footer("Examples:\n"
               "  peelray render builtin:teapots -o teapots.png --spp 16\n"
               "  peelray render model.glb -o picture.png --env studio.hdr --eye 2,1,3 --look 0,0.5,0\n"
               "  peelray render bunny.off -o mirror.png --material mirror --floor --stats stats.json");
}

void add_trace(CLI::App& program, TraceArguments& a) {
    CLI::App& app = *program.add_subcommand("trace", "Trace rays of a .npy file and write what they hit");
    app.add_option("SCENE", a.scene, "a file or builtin:NAME")->required();
    app.add_option("--rays", a.rays, "float32 (n, 8): ox oy oz tmin dx dy dz tmax, world units")->required();
    app.add_option("--out", a.hits, "structured (n): t f4 (+inf: a miss), triangle u4, u f4, v f4")->required();
    app.add_flag("--any-hit", a.any_hit, "stop at the first hit found, not the nearest (shadow rays)");
    app.add_option("--stats", a.stats, "write times and memory as JSON");
    app.add_option("--repeat", a.repeat, "trace so many times after a first time; times are medians (for measuring)")->capture_default_str();
    add_tracing_options(app, a.tracing);
    add_device_options(app, a.device);
}

}  // namespace

const char* build_commit() { return PEELRAY_COMMIT; }

glm::uvec2 parse_size(const std::string& text) {
    glm::uvec2 size(0);
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, size.x);
    if (first.ec == std::errc() && first.ptr < end && (*first.ptr == 'x' || *first.ptr == 'X')) {
        const auto second = std::from_chars(first.ptr + 1, end, size.y);
        if (second.ec == std::errc() && second.ptr == end && size.x > 0 && size.y > 0) return size;
    }
    fail("'{}' is no picture size: write WIDTHxHEIGHT, such as 1280x1024 (--size)", text);
}

void TracingArguments::check() const {
    const auto later = [](const char* option, const std::string& value, const char* instead) {
        fail("{} {} is not built into this version: use {}", option, value, instead);
    };
    if (tracer != "ldc" && tracer != "none") later("--tracer", tracer, "--tracer ldc or none");
    if (builder != "auto" && builder != "compute") later("--builder", builder, "--builder compute");
    if (hit == "tolerance") later("--hit", hit, "--hit exact or planar");
    if (traversal != "voxel") later("--traversal", traversal, "--traversal voxel");
}

uint32_t TracingArguments::resolution() const {
    if (ldc == "auto") return 0;
    uint32_t value = 0;
    const auto parsed = std::from_chars(ldc.data(), ldc.data() + ldc.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != ldc.data() + ldc.size() || value < 16 || value > 2048)
        fail("'{}' is no LDI resolution: write auto or a number from 16 to 2048 (--ldc)", ldc);
    return value;
}

int run_program(int argc, const char* const* argv) {
    CLI::App program{"Peelray: ray-traced reflections, refractions and shadows without ray-tracing hardware.\n"
                     "The scene is rasterised into a layered depth cube, in which secondary rays are traced."};
    program.name("peelray");
    program.require_subcommand(1);
    program.set_version_flag("--version", std::string("peelray ") + PEELRAY_VERSION + " (" + PEELRAY_COMMIT + ")");
    program.footer("Try:  peelray render builtin:teapots -o teapots.png\n"
                   "Each command has its own help:  peelray render --help");
    program.get_formatter()->column_width(34);

    RenderArguments render;
    TraceArguments trace;
    std::string info_scene;
    add_render(program, render);
    add_trace(program, trace);
    CLI::App* info = program.add_subcommand("info", "Print what a scene holds");
    info->add_option("SCENE", info_scene, "a file or builtin:NAME")->required();
    program.add_subcommand("devices", "List the Vulkan devices");
    CLI::App* later[] = {program.add_subcommand("compare", "Compare tracers (not built into this version)"),
                         program.add_subcommand("bench", "Measure (not built into this version)"),
                         program.add_subcommand("view", "Look around interactively (not built into this version)")};
    for (CLI::App* app : later) app->allow_extras();

    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // help and version
            program.exit(error);
            return 0;
        }
        const auto chosen = program.get_subcommands();
        fmt::print(stderr, "peelray: {} (see 'peelray{}{} --help')\n", error.what(), chosen.empty() ? "" : " ",
                   chosen.empty() ? "" : chosen.front()->get_name());
        return 2;
    }
    try {
        if (program.got_subcommand("render")) run_render(render);
        if (program.got_subcommand("trace")) run_trace(trace);
        if (program.got_subcommand("info")) run_info(info_scene);
        if (program.got_subcommand("devices")) run_devices();
        for (CLI::App* app : later)
            if (app->parsed()) fail("'{}' is not built into this version: there are render, trace, info and devices", app->get_name());
    } catch (const Error& error) {
        fmt::print(stderr, "peelray: {}\n", error.what());
        return 1;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "peelray: out of memory: the scene or picture is too large for this machine\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "peelray: internal error: {}: please report it\n", error.what());
        return 1;
    }
    return 0;
}

}  // namespace peelray
