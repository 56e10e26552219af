// Small helpers for text that several modules read.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace peelray {

/// In lower case, byte by byte: for ASCII names.
inline std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// A file's extension with its dot, in lower case.
inline std::string lower_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

/// `text` on one line with unprintable bytes replaced and at most `limit` bytes long, fit for an error message.
inline std::string printable(std::string_view text, size_t limit = 120) {
    std::string line;
    for (const char c : text.substr(0, limit)) line += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
    return text.size() > limit ? line + "..." : line;
}

/// A sentence about a number of things: "{}" becomes the number, "{one|several}" the word that goes with it, "{{" and
/// "}}" single braces.
inline std::string counted(std::string_view sentence, uint64_t count) {
    std::string line;
    for (size_t i = 0; i < sentence.size(); i++) {
        const char c = sentence[i];
        if ((c == '{' || c == '}') && i + 1 < sentence.size() && sentence[i + 1] == c) {
            line += sentence[i++];
            continue;
        }
        const size_t end = c == '{' ? sentence.find('}', i) : std::string_view::npos;
        if (end == std::string_view::npos) {
            line += c;
            continue;
        }
        const std::string_view choice = sentence.substr(i + 1, end - i - 1);
        const size_t bar = choice.find('|');
        line += choice.empty()                  ? std::to_string(count)
                : bar == std::string_view::npos ? sentence.substr(i, end - i + 1)
                : count == 1                    ? choice.substr(0, bar)
                                                : choice.substr(bar + 1);
        i = end;
    }
    return line;
}

/// printable() text out of a file, for a sentence of counted(): its braces are no places to fill.
inline std::string escaped(std::string_view text, size_t limit = 120) {
    std::string line;
    for (const char c : printable(text, limit)) line.append(c == '{' || c == '}' ? 2 : 1, c);
    return line;
}

}  // namespace peelray
