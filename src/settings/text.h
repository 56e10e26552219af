// Values as they are typed: text to values and back. Nothing is returned for text of another form, which is wrong
// usage; whether a value makes sense for this scene and device is for others to say.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "settings/choices.h"

namespace peelray {

/// A whole text that is one number: no blanks, no leading plus. T: a float type ("inf" and "nan" count) or an integer
/// one.
template <typename T>
std::optional<T> parse_number(std::string_view text) {
    T value{};
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && at == end ? std::optional(value) : std::nullopt;
}

/// The parts between commas; empty ones too.
std::vector<std::string> split(std::string_view list);
/// "1280x1024": width and height, each from 0 up.
std::optional<glm::uvec2> parse_size(std::string_view text);
/// "8" or "8x4": the pixels of a block.
std::optional<glm::uvec2> parse_block(std::string_view text);
/// "1,2.5,-3"; no number is beyond the range of single precision.
std::optional<glm::vec3> parse_vector(std::string_view text);
std::optional<glm::dvec3> parse_double_vector(std::string_view text);
/// Two numbers with `separator` in between.
std::optional<std::pair<uint32_t, uint32_t>> parse_pair(std::string_view text, char separator);

/// The frames from `first` up to, but without, `end`: "10:20" are the frames 10 to 19.
struct FrameRange {
    uint32_t first = 0, end = 0;
};

/// Part `index` of `count`: "2/8", counted from 0.
struct Shard {
    uint32_t index = 0, count = 1;
};

/// What is seen where nothing is: a colour, or nothing at all.
struct Background {
    std::optional<glm::vec3> color;  ///< linear; none: transparent
    Background() = default;
    Background(const glm::vec3& color) : color(color) {}
    bool is_transparent() const { return !color; }
};

/// Several values with commas in between, each known to `parse`; `once`: none twice.
template <typename Value, typename Parse>
std::optional<std::vector<Value>> parse_list(std::string_view text, Parse&& parse, bool once) {
    std::vector<Value> values;
    for (const std::string& part : split(text)) {
        const std::optional<Value> value = parse(part);
        if (!value || (once && std::find(values.begin(), values.end(), *value) != values.end())) return std::nullopt;
        values.push_back(*value);
    }
    return values;
}

/// The first part of each: as it would be typed.
std::string print_text(const glm::vec3& vector);
std::string print_text(const glm::dvec3& vector);
std::string print_text(const glm::uvec2& size);
std::string print_text(const FrameRange& frames);
std::string print_text(const Shard& shard);
std::string print_text(const Background& background);
inline std::string print_text(const std::string& text) {
    return text;
}
inline std::string print_text(const std::filesystem::path& path) {
    return path.string();
}
template <typename Number>
requires std::is_arithmetic_v<Number> std::string print_text(Number number) {
    return fmt::format("{}", number);
}
template <Choice Value>
std::string print_text(Value value) {
    return name_of(value);
}
template <Choice Value>
std::string print_text(const ChoiceSet<Value>& set) {
    std::string text;
    for (const Value value : values_of<Value>())
        if (set.has(value)) text.append(text.empty() ? "" : ",").append(name_of(value));
    return text;
}
template <typename Value>
std::string print_text(const std::vector<Value>& list) {
    std::string text;
    for (const Value& value : list) text.append(text.empty() ? "" : ",").append(print_text(value));
    return text;
}

/// A type's way to be parsed: none for text of another form.
inline std::optional<std::string> parse_text(std::string_view text, std::string*) {
    return std::string(text);
}
inline std::optional<std::filesystem::path> parse_text(std::string_view text, std::filesystem::path*) {
    return std::filesystem::path(text);
}
inline std::optional<glm::uvec2> parse_text(std::string_view text, glm::uvec2*) {
    return parse_size(text);
}
inline std::optional<glm::vec3> parse_text(std::string_view text, glm::vec3*) {
    return parse_vector(text);
}
inline std::optional<glm::dvec3> parse_text(std::string_view text, glm::dvec3*) {
    return parse_double_vector(text);
}
std::optional<FrameRange> parse_text(std::string_view text, FrameRange*);
std::optional<Shard> parse_text(std::string_view text, Shard*);
/// "1,0.5,0" or "transparent".
std::optional<Background> parse_text(std::string_view text, Background*);
template <typename Number>
requires std::is_arithmetic_v<Number> std::optional<Number> parse_text(std::string_view text, Number*) {
    return parse_number<Number>(text);
}
template <Choice Value>
std::optional<Value> parse_text(std::string_view text, Value*) {
    return value_named<Value>(text);
}
/// Values of the list are told apart: none comes twice.
template <typename Value>
std::optional<std::vector<Value>> parse_text(std::string_view text, std::vector<Value>*) {
    return parse_list<Value>(
        text, [](const std::string& part) { return parse_text(part, static_cast<Value*>(nullptr)); }, true);
}

template <typename Value>
std::optional<Value> parse_as(std::string_view text) {
    return parse_text(text, static_cast<Value*>(nullptr));
}

}  // namespace peelray
