// Small helpers for text that several modules read.
#pragma once

#include <algorithm>
#include <cctype>
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

}  // namespace peelray
