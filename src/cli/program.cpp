#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "cli/scene_names.h"
#include "cli/version.h"

namespace peelray {
namespace {

bool is_output_option(const std::string& word) {
    return word == "-o" || word.starts_with("--output") || (word.starts_with("-o") && word.size() > 2);
}

/// What to type, where somebody named a scene before any command or without one; empty: no scene was named.
/// `words`: the command line.
std::string advice_on_scene(std::vector<std::string> words, const CLI::App& program) {
    if (words.empty() || !is_scene_name(words.front())) return "";
    // A folder may have a command's name.
    const auto named = [&](const CLI::App* command) { return command->get_name() == words.front(); };
    if (!program.get_subcommands(named).empty()) return "";
    const auto chosen = program.get_subcommands();
    const std::string command = chosen.empty() ? "render" : chosen.front()->get_name();
    words.erase(std::remove(words.begin() + 1, words.end(), command), words.end());
    words.front() = scene_in(words.front());
    if (command == "render" && std::none_of(words.begin(), words.end(), is_output_option))
        words.insert(words.end(), {"-o", "picture.png"});
    words.insert(words.begin(), {"peelray", command});
    return shell_line(words);
}

/// What is wrong with the command line.
std::string describe(const CLI::ParseError& error, const CLI::App& program, const std::vector<std::string>& words) {
    const auto chosen = program.get_subcommands();
    if (const std::string advice = advice_on_scene(words, program); !advice.empty())
        return fmt::format("{} before the scene: {}", chosen.empty() ? "name a command" : "the command comes", advice);
    // What was not understood explains why something else seems missing.
    const auto rest = chosen.empty() ? program.remaining() : chosen.front()->remaining();
    const auto option = std::find_if(rest.begin(), rest.end(),
                                     [](const std::string& text) { return text.size() > 1 && text[0] == '-'; });
    if (option != rest.end()) return fmt::format("unknown option '{}'", *option);
    if (chosen.empty()) {
        const char* commands = "render, compare, trace, bench, info, devices or doctor";
        return rest.empty() ? fmt::format("name a command: {}", commands)
                            : fmt::format("unknown command '{}': there are {}", rest.front(), commands);
    }
    if (!rest.empty()) return fmt::format("'{}' is one argument too many", rest.front());
    return error.what();
}

/// What each command is asked for.
struct Arguments {
    RenderArguments render;
    CompareArguments compare;
    TraceArguments trace;
    BenchArguments bench;
    std::string info_scene;
    bool doctor_json = false;
    int status = 0;  ///< of the command, where it ends without an Error
};

struct Command {
    CLI::App* options;
    std::function<void()> run;
};

/// Runs a command whose options are within their limits.
template <typename Options>
void run_within_limits(Options& arguments, void (*run)(const Options&)) {
    check_limits(options_of(arguments));
    run(arguments);
}

std::vector<Command> add_commands(CLI::App& program, Arguments& a) {
    CLI::App* render = add_render(program, a.render);
    CLI::App* compare = add_compare(program, a.compare);
    CLI::App* trace = add_trace(program, a.trace);
    CLI::App* bench = add_bench(program, a.bench);
    CLI::App* info = program.add_subcommand("info", "Print what a scene holds");
    info->add_option("SCENE", a.info_scene, kSceneHelp)->required()->type_name("");
    info->footer(builtin_list());
    CLI::App* devices = program.add_subcommand("devices", "List the Vulkan devices (for --device)")->footer("");
    CLI::App* doctor =
        program.add_subcommand("doctor", "Say what this machine has and lacks, and draw a checked picture");
    doctor->add_flag("--json", a.doctor_json, "as JSON: for programs");
    doctor->footer(
        "One line per cause, with its remedy. A small picture is drawn on every device, and compared with the one of\n"
        "--tracer reference. Exit status 0: a Vulkan device passed; 1: only the CPU tracer works, or nothing.");
    CLI::App* view = program.add_subcommand("view", "Look around interactively (not built into this version)");
    view->allow_extras()->footer("");
    return {{render,
             [&a, render] {
                 a.render.asks_for_cubes =
                     a.render.device.validate ||
                     gives_any(*render, options_of(a.render), [](const SettingInfo& info) { return info.of_cubes; });
                 run_within_limits(a.render, run_render);
             }},
            {compare,
             [&a, compare] {
                 a.compare.given = given_options(*compare, a.compare);
                 run_within_limits(a.compare, run_compare);
             }},
            {trace, [&a] { run_within_limits(a.trace, run_trace); }},
            {bench, [&a] { run_within_limits(a.bench, run_bench); }},
            {info, [&a] { run_info(a.info_scene); }},
            {devices, run_devices},
            {doctor, [&a] { a.status = run_doctor(a.doctor_json); }},
            {view, [] {
                 fail(
                     "'view' is not built into this version: there are render, compare, trace, bench, info, "
                     "devices and doctor");
             }}};
}

}  // namespace

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

    Arguments arguments;
    const std::vector<Command> commands = add_commands(program, arguments);

    try {
        std::vector<std::string> words = with_implied_values({argv + 1, argv + argc});
        std::reverse(words.begin(), words.end());  // as CLI11 takes them
        program.parse(words);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // help and version
            program.exit(error);
            return 0;
        }
        const auto chosen = program.get_subcommands();
        fmt::print(stderr, "peelray: {} (see 'peelray{}{} --help')\n",
                   one_line(describe(error, program, {argv + 1, argv + argc})), chosen.empty() ? "" : " ",
                   chosen.empty() ? "" : chosen.front()->get_name());
        return 2;
    }
    try {
        for (const Command& command : commands)
            if (command.options->parsed()) command.run();
        if (std::fflush(stdout) != 0) fail("cannot write to the standard output: {}", std::strerror(errno));
    } catch (const Error& error) {
        fmt::print(stderr, "peelray: {}\n", one_line(message_of(error)));
        return 1;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "peelray: out of memory: the scene or picture is too large for this machine\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "peelray: internal error: {}: please report it\n", one_line(error.what()));
        return 1;
    }
    return arguments.status;
}

}  // namespace peelray
