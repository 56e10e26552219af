#include "settings/text.h"

namespace peelray {

std::vector<std::string> split(std::string_view list) {
    std::vector<std::string> parts;
    for (;;) {
        const size_t comma = list.find(',');
        parts.emplace_back(list.substr(0, comma));
        if (comma == std::string_view::npos) return parts;
        list.remove_prefix(comma + 1);
    }
}

std::optional<glm::uvec2> parse_size(std::string_view text) {
    const size_t x = text.find_first_of("xX");
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = parse_number<uint32_t>(text.substr(0, x));
    const auto height = parse_number<uint32_t>(text.substr(x + 1));
    return width && height ? std::optional(glm::uvec2(*width, *height)) : std::nullopt;
}

std::optional<glm::uvec2> parse_block(std::string_view text) {
    if (const auto side = parse_number<uint32_t>(text)) return glm::uvec2(*side);
    return parse_size(text);
}

std::optional<glm::vec3> parse_vector(std::string_view text) {
    const std::vector<std::string> parts = split(text);
    if (parts.size() != 3) return std::nullopt;
    glm::vec3 vector;
    for (int i = 0; i < 3; i++) {
        const auto number = parse_number<float>(parts[size_t(i)]);
        if (!number) return std::nullopt;
        vector[i] = *number;
    }
    return vector;
}

std::optional<glm::dvec3> parse_double_vector(std::string_view text) {
    const std::optional<glm::vec3> rounded = parse_vector(text);
    if (!rounded) return std::nullopt;
    const std::vector<std::string> parts = split(text);
    glm::dvec3 vector;
    for (int i = 0; i < 3; i++) vector[i] = parse_number<double>(parts[size_t(i)]).value_or((*rounded)[i]);
    return vector;
}

std::optional<std::pair<uint32_t, uint32_t>> parse_pair(std::string_view text, char separator) {
    const size_t at = text.find(separator);
    if (at == std::string_view::npos) return std::nullopt;
    const auto first = parse_number<uint32_t>(text.substr(0, at)), second = parse_number<uint32_t>(text.substr(at + 1));
    return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

std::optional<FrameRange> parse_text(std::string_view text, FrameRange*) {
    const auto pair = parse_pair(text, ':');
    return pair ? std::optional(FrameRange{pair->first, pair->second}) : std::nullopt;
}

std::optional<Shard> parse_text(std::string_view text, Shard*) {
    const auto pair = parse_pair(text, '/');
    return pair ? std::optional(Shard{pair->first, pair->second}) : std::nullopt;
}

std::optional<Background> parse_text(std::string_view text, Background*) {
    if (text == "transparent") return Background{};
    const std::optional<glm::vec3> color = parse_vector(text);
    return color ? std::optional(Background(*color)) : std::nullopt;
}

std::string print_text(const glm::vec3& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

std::string print_text(const glm::dvec3& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

std::string print_text(const glm::uvec2& size) {
    return fmt::format("{}x{}", size.x, size.y);
}

std::string print_text(const FrameRange& frames) {
    return fmt::format("{}:{}", frames.first, frames.end);
}

std::string print_text(const Shard& shard) {
    return fmt::format("{}/{}", shard.index, shard.count);
}

std::string print_text(const Background& background) {
    return background.color ? print_text(*background.color) : "transparent";
}

}  // namespace peelray
