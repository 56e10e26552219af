#include "loaders/text_lines.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace peelray {

TextLines::TextLines(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    if (rest_.find('\n') == std::string_view::npos) end_ = '\r';
}

std::string_view TextLines::take_physical_line() {
    const size_t end = rest_.find(end_);
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++physical_;
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    return line;
}

bool TextLines::next() {
    if (rest_.empty()) return false;
    line_ = take_physical_line();
    number_ = physical_;
    const auto continues = [](std::string_view line) {
        return line.ends_with('\\') && line.find('#') == std::string_view::npos;
    };
    if (!continues(line_)) return true;
    joined_.assign(line_.substr(0, line_.size() - 1));
    while (!rest_.empty()) {
        const std::string_view more = take_physical_line();
        joined_ += ' ';
        const bool goes_on = continues(more);
        joined_ += more.substr(0, more.size() - (goes_on ? 1 : 0));
        if (!goes_on) break;
    }
    line_ = joined_;
    return true;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view take_word(std::string_view& rest) {
    size_t begin = 0;
    while (begin < rest.size() && is_blank(rest[begin])) ++begin;
    size_t end = begin;
    while (end < rest.size() && !is_blank(rest[end])) ++end;
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

std::string_view without_comment(std::string_view line) {
    size_t at = line.find('#');
    while (at != std::string_view::npos && at > 0 && line[at - 1] == '.') at = line.find('#', at + 1);
    return line.substr(0, at);
}

std::string_view name_without_comment(std::string_view name) {
    for (size_t at = name.find('#'); at != std::string_view::npos; at = name.find('#', at + 1))
        if (at == 0 || is_blank(name[at - 1])) return trimmed(name.substr(0, at));
    return trimmed(name);
}

std::optional<float> take_number(std::string_view& rest) {
    std::string_view after = rest, word = take_word(after);
    if (word.starts_with('+')) {
        word.remove_prefix(1);
        if (word.starts_with('-')) return std::nullopt;
    }
    float value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    std::string_view left = word.substr(size_t(end - word.data()));
    if (error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        double wide = 0;  // too small for a float is zero, too large is not
        std::from_chars(word.data(), word.data() + word.size(), wide);
        value = std::abs(wide) < 1 ? static_cast<float>(wide) : std::numeric_limits<float>::infinity();
    }
    if (!left.empty()) {
        // What Microsoft's libraries print for NaN and infinity: 1.#QNAN, -1.#IND00, 1.#INF.
        if (!left.starts_with("#") || left.size() < 4 || !std::isalpha(static_cast<unsigned char>(left[1])))
            return std::nullopt;
        value = std::numeric_limits<float>::quiet_NaN();
    }
    rest = after;
    return value;
}

}  // namespace peelray
