// The options of each command: what a user may type, and what it means. Private to src/cli.
#pragma once

#include <CLI/App.hpp>

#include "cli/arguments.h"

namespace peelray {

CLI::App* add_render(CLI::App& program, RenderArguments& arguments);
CLI::App* add_compare(CLI::App& program, CompareArguments& arguments);
CLI::App* add_trace(CLI::App& program, TraceArguments& arguments);
CLI::App* add_bench(CLI::App& program, BenchArguments& arguments);

/// Were any of the options that are `of` a kind given to the command?
bool gives_any(const CLI::App& command, const SettingList& options, bool (*of)(const SettingInfo&));
/// The options of a picture that were given to `compare`: `render` takes them as well.
std::vector<GivenOption> given_options(const CLI::App& compare, PictureArguments& arguments);

/// The words of a command line, with the values that were left out where an option need not be given one.
std::vector<std::string> with_implied_values(std::vector<std::string> words);

/// For help pages.
std::string builtin_list();
extern const char* const kSceneHelp;

}  // namespace peelray
