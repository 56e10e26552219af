#include "cli/messages.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>

#include "cli/standard_output.h"

namespace peelray {

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

std::string message_of(const Error& error) {
    return error.line("--");
}

std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./:,=+@%", c); };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string out;
    for (char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return fmt::format("'{}'", out);
}

std::string shell_line(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        line += quoted(word);
    }
    return line;
}

void print_note(const std::string& text) {
    fmt::print(stderr, "peelray: note: {}\n", one_line(message_of(Error(text))));
}

void print_if_any(const std::string& note) {
    if (!note.empty()) print_note(note);
}

void print_result(const std::filesystem::path& output, const std::string& text) {
    if (is_standard_output(output))
        fmt::print(stderr, "standard output: {}\n", text);
    else
        fmt::print("{}: {}\n", output.string(), text);
}

}  // namespace peelray
