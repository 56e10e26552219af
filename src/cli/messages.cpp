#include "cli/messages.h"

#include <algorithm>
#include <cstdio>

namespace peelray {

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    return text;
}

std::string message_of(const Error& error) {
    return error.line("--");
}

void print_note(const std::string& text) {
    fmt::print(stderr, "peelray: note: {}\n", one_line(message_of(Error(text))));
}

}  // namespace peelray
