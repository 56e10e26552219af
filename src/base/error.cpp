#include "base/error.h"

#include <algorithm>

namespace peelray {
namespace {

/// `text` with `prefix` instead of the beginnings of settings, and without their ends.
std::string without_marks(std::string_view text, std::string_view prefix) {
    std::string line;
    for (const char c : text) {
        if (c == kSettingBegin)
            line += prefix;
        else if (c != kSettingEnd)
            line += c;
    }
    return line;
}

}  // namespace

Error::Error(const std::string& text) : std::runtime_error(without_marks(text, "")), text_(text) {
    for (size_t begin = text.find(kSettingBegin); begin != std::string::npos;
         begin = text.find(kSettingBegin, begin + 1)) {
        const size_t end = text.find(kSettingEnd, begin);
        if (end == std::string::npos) break;
        const std::string name = text.substr(begin + 1, end - begin - 1);
        if (std::find(settings_.begin(), settings_.end(), name) == settings_.end()) settings_.push_back(name);
    }
}

std::string Error::line(std::string_view prefix) const {
    return without_marks(text_, prefix);
}

}  // namespace peelray
