#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "cli/options.h"
#include "image/image.h"
#include "ldc/cubes.h"
#include "scene/scene.h"

namespace peelray {
namespace {

/// What is wrong with the command line.
std::string describe(const CLI::ParseError& error, const CLI::App& program) {
    const auto chosen = program.get_subcommands();
    // What was not understood explains why something else seems missing.
    const auto rest = chosen.empty() ? program.remaining() : chosen.front()->remaining();
    const auto option = std::find_if(rest.begin(), rest.end(),
                                     [](const std::string& text) { return text.size() > 1 && text[0] == '-'; });
    if (option != rest.end()) return fmt::format("unknown option '{}'", *option);
    if (chosen.empty()) {
        const char* commands = "render, compare, trace, bench, info or devices";
        return rest.empty() ? fmt::format("name a command: {}", commands)
                            : fmt::format("unknown command '{}': there are {}", rest.front(), commands);
    }
    if (!rest.empty()) return fmt::format("'{}' is one argument too many", rest.front());
    return error.what();
}

}  // namespace

void TracingArguments::check() const {
    if (ldc && (*ldc < 16 || *ldc > 2048))
        fail("an LDI resolution of {} is out of range: choose 16 to 2048, or auto (--ldc)", *ldc);
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        fail("a tolerance of {} is impossible: choose a distance above 0 (--tolerance)", tolerance);
    check_block(block);
    if (builder == "peel" && hit == "exact") check_captures(BuilderKind::peel, Sampling::conservative);
    if (batch != "none" && traversal == "voxel")
        fail(
            "--traversal voxel takes one sample and one ray at a time: use --batch {} with --traversal two-level or "
            "mipmap",
            batch);
    if (depth != 16 && depth != 32) fail("a depth of {} bits is not supported: choose 16 or 32 (--depth)", depth);
    if (depth == 16 && traversal == "voxel")
        fail("--traversal voxel has a depth format of its own: use --depth 16 with --traversal two-level or mipmap");
    if (depth == 16 && hit != "planar" && hit != "tolerance" && !(hit == "auto" && builder == "peel"))
        fail("depths of 16 bits are too coarse for --hit {}: use --depth 16 with --hit tolerance or planar", hit);
}

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

void print_note(const std::string& text) {
    fmt::print(stderr, "peelray: note: {}\n", one_line(text));
}

void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment) {
    const size_t count = geometry.triangles.size();
    if (geometry.zero_area == count && !is_moment)
        fail("{}: none of its {} triangles has an area; give a file with a surface", scene.name, count);
    for (const std::string& text : scene.notes) print_note(text);
    if (geometry.zero_area > 0)
        print_note(fmt::format("{} of {} triangles have no area: they can never be hit", geometry.zero_area, count));
    for (const std::string& extension : scene.extensions_unsupported)
        print_note(fmt::format("the extension {} has no effect in this version", extension));
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
    program.set_version_flag("--version", fmt::format("peelray {} ({})", program_version(), build_commit()));
    program.footer(
        "Try:  peelray render builtin:teapots -o teapots.png\n"
        "Each command has its own help:  peelray render --help");
    program.get_formatter()->column_width(34);

    RenderArguments render;
    TraceArguments trace;
    CompareArguments compare;
    BenchArguments bench;
    std::string info_scene;
    add_render(program, render);
    CLI::App& compare_options = add_compare(program, compare);
    add_trace(program, trace);
    add_bench(program, bench);
    CLI::App* info = program.add_subcommand("info", "Print what a scene holds");
    info->add_option("SCENE", info_scene, kSceneHelp)->required()->type_name("");
    info->footer(builtin_list());
    program.add_subcommand("devices", "List the Vulkan devices (for --device)")->footer("");
    CLI::App* view = program.add_subcommand("view", "Look around interactively (not built into this version)");
    view->allow_extras()->footer("");

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
        if (program.got_subcommand("compare")) {
            compare.given = given_options(compare_options);
            run_compare(compare);
        }
        if (program.got_subcommand("trace")) run_trace(trace);
        if (program.got_subcommand("bench")) run_bench(bench);
        if (program.got_subcommand("info")) run_info(info_scene);
        if (program.got_subcommand("devices")) run_devices();
        if (view->parsed())
            fail("'view' is not built into this version: there are render, compare, trace, bench, info and devices");
        if (std::fflush(stdout) != 0) fail("cannot write to the standard output: {}", std::strerror(errno));
    } catch (const Error& error) {
        fmt::print(stderr, "peelray: {}\n", one_line(error.line("--")));
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
