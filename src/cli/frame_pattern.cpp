#include "cli/frame_pattern.h"

#include <regex>

#include "base/error.h"
#include "settings/text.h"

namespace peelray {

namespace fs = std::filesystem;

namespace {

/// The length of the number's place at the beginning of `text`; 0: there is none.
size_t number_length(const std::string& text) {
    static const std::regex number("%(0[1-9])?d");
    std::smatch match;
    return std::regex_search(text, match, number, std::regex_constants::match_continuous) ? size_t(match.length()) : 0;
}

}  // namespace

bool has_frame_number(const fs::path& path) {
    const std::string name = path.filename().string();
    for (size_t i = 0; i < name.size(); i++) {
        if (name[i] != '%') continue;
        if (number_length(name.substr(i)) > 0) return true;
        if (name.compare(i, 2, "%%") == 0) i++;
    }
    return false;
}

FramePattern::FramePattern(const fs::path& pattern) : path_(pattern) {
    const std::string name = pattern.filename().string();
    bool found = false;
    for (size_t i = 0; i < name.size(); i++) {
        std::string& part = found ? after_ : before_;
        if (name[i] != '%') {
            part += name[i];
        } else if (name.compare(i, 2, "%%") == 0) {
            part += name[i++];
        } else if (const size_t length = number_length(name.substr(i))) {
            if (found)
                fail("'{}' has two numbers, but a frame has one: keep one %d or %0Nd, such as frame_%05d.exr",
                     pattern.string());
            found = true;
            digits_ = length > 2 ? name[i + 2] - '0' : 0;
            i += length - 1;
        } else {
            const size_t end = name.find_first_not_of("0123456789.+-# hjltz", i + 1);
            fail(
                "'{}' in '{}' is no place for a frame's number: write %d or %0Nd, such as %05d, and %% for a percent "
                "sign",
                name.substr(i, end == std::string::npos ? end : end - i + 1), pattern.string());
        }
    }
    if (!found)
        fail(
            "several frames need a name with a number in it, such as frame_%05d.exr, or a video, .mp4 or .webm; "
            "'{}' is one file",
            pattern.string());
}

fs::path FramePattern::file(uint32_t frame) const {
    return path_.parent_path() / fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::optional<uint32_t> FramePattern::frame_of(const fs::path& file) const {
    std::error_code error;
    const auto folder = [&](const fs::path& path) {
        return fs::weakly_canonical(path.has_parent_path() ? path.parent_path() : ".", error);
    };
    const std::string name = file.filename().string();
    if (name.size() < before_.size() + after_.size() || !name.starts_with(before_) || !name.ends_with(after_) ||
        folder(file) != folder(path_))
        return std::nullopt;
    const auto frame = parse_number<uint32_t>(
        std::string_view(name).substr(before_.size(), name.size() - before_.size() - after_.size()));
    return frame && this->file(*frame).filename() == name ? frame : std::nullopt;
}

}  // namespace peelray
