// Small helpers for text that several modules read.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

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

}  // namespace peelray
