// What the program says on the terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace peelray {

/// Whatever a file's names brought along, as one line without terminal codes.
std::string one_line(std::string text);
/// The line of an Error, with settings as their flags.
std::string message_of(const Error& error);
/// Words as a POSIX shell takes them: a line to type.
std::string quoted(const std::string& word);
std::string shell_line(const std::vector<std::string>& words);
/// A line on standard error that is no complaint. Settings in it, as fmt prints a Setting, become their flags.
void print_note(const std::string& text);
void print_if_any(const std::string& note);
/// What came of `output`: a line on the standard output, or on standard error where the output is the former.
void print_result(const std::filesystem::path& output, const std::string& text);

}  // namespace peelray
