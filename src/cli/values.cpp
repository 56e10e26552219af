#include "cli/values.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "cli/paper_table.h"

namespace peelray {
namespace {

std::optional<std::vector<std::string>> parse_names(const std::string& text, const std::vector<std::string>& known) {
    const std::vector<std::string> names = split(text);
    const bool all_known = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        return std::find(known.begin(), known.end(), name) != known.end();
    });
    return all_known ? std::optional(names) : std::nullopt;
}

}  // namespace

std::vector<std::string> split(std::string_view list) {
    std::vector<std::string> parts;
    for (;;) {
        const size_t comma = list.find(',');
        parts.emplace_back(list.substr(0, comma));
        if (comma == std::string_view::npos) return parts;
        list.remove_prefix(comma + 1);
    }
}

std::optional<glm::uvec2> parse_size(const std::string& text) {
    const size_t x = text.find_first_of("xX");
    if (x == std::string::npos) return std::nullopt;
    const auto width = parse_number<uint32_t>(std::string_view(text).substr(0, x));
    const auto height = parse_number<uint32_t>(std::string_view(text).substr(x + 1));
    return width && height ? std::optional(glm::uvec2(*width, *height)) : std::nullopt;
}

std::optional<glm::vec3> parse_vector(const std::string& text) {
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

std::optional<std::optional<uint32_t>> parse_resolution(const std::string& text) {
    using Resolution = std::optional<uint32_t>;
    const Resolution number = parse_number<uint32_t>(text);
    return number || text == "auto" ? std::optional<Resolution>(number) : std::nullopt;
}

std::optional<glm::uvec2> parse_block(const std::string& text) {
    if (const auto side = parse_number<uint32_t>(text)) return glm::uvec2(*side);
    return parse_size(text);
}

namespace {

/// Two numbers with `separator` in between.
std::optional<std::pair<uint32_t, uint32_t>> parse_pair(std::string_view text, char separator) {
    const size_t at = text.find(separator);
    if (at == std::string_view::npos) return std::nullopt;
    const auto first = parse_number<uint32_t>(text.substr(0, at)), second = parse_number<uint32_t>(text.substr(at + 1));
    return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

}  // namespace

std::optional<FrameRange> parse_frames(const std::string& text) {
    const auto pair = parse_pair(text, ':');
    return pair ? std::optional(FrameRange{pair->first, pair->second}) : std::nullopt;
}

std::optional<Shard> parse_shard(const std::string& text) {
    const auto pair = parse_pair(text, '/');
    return pair ? std::optional(Shard{pair->first, pair->second}) : std::nullopt;
}

std::optional<std::vector<std::string>> parse_effects(const std::string& text) {
    return text == "none" ? std::optional(std::vector<std::string>()) : parse_names(text, effect_names());
}

std::optional<std::vector<std::string>> parse_aovs(const std::string& text) {
    return text == "all" ? std::optional(aov_names()) : parse_names(text, all_aov_names());
}

namespace {

std::optional<std::vector<std::string>> parse_distinct(const std::string& text, const std::vector<std::string>& known) {
    const auto names = parse_names(text, known);
    if (!names || std::set<std::string>(names->begin(), names->end()).size() < names->size()) return std::nullopt;
    return names;
}

}  // namespace

std::optional<std::vector<std::string>> parse_tracers(const std::string& text) {
    return parse_distinct(text, {"cubemap", "ldc", "reference", "none", "khr"});
}

std::optional<std::vector<std::string>> parse_hits(const std::string& text) {
    return parse_distinct(text, {"auto", "exact", "planar", "tolerance"});
}

std::optional<std::vector<std::string>> parse_bench_scenes(const std::string& text) {
    const std::vector<std::string> names = split(text);
    const bool empty = std::find(names.begin(), names.end(), "") != names.end();
    return empty ? std::nullopt : parse_distinct(text, names);
}

bool are_paper_scenes(const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [](const std::string& name) {
        return std::any_of(paper_scenes().begin(), paper_scenes().end(),
                           [&](const PaperScene& scene) { return scene.name == name; });
    });
}

std::optional<std::vector<std::string>> parse_builders(const std::string& text) {
    return parse_distinct(text, builder_names());
}

std::optional<std::vector<std::string>> parse_traversals(const std::string& text) {
    return parse_distinct(text, traversal_names());
}

std::optional<std::vector<std::string>> parse_hit_tests(const std::string& text) {
    return parse_distinct(text, hit_test_names());
}

std::optional<std::vector<std::string>> parse_ray_kinds(const std::string& text) {
    return parse_distinct(text, ray_kind_names());
}

namespace {

/// A list of values that `parse` knows, none twice.
template <typename Value>
std::optional<std::vector<Value>> parse_list(const std::string& text,
                                             std::optional<Value> (*parse)(const std::string&)) {
    std::vector<Value> values;
    for (const std::string& part : split(text)) {
        const std::optional<Value> value = parse(part);
        if (!value || std::find(values.begin(), values.end(), *value) != values.end()) return std::nullopt;
        values.push_back(*value);
    }
    return values;
}

}  // namespace

std::optional<std::vector<std::optional<uint32_t>>> parse_resolutions(const std::string& text) {
    return parse_list(text, parse_resolution);
}

std::optional<std::vector<glm::uvec2>> parse_sizes(const std::string& text) {
    return text == "none" ? std::optional(std::vector<glm::uvec2>()) : parse_list(text, parse_size);
}

const std::vector<std::string>& builder_names() {
    static const std::vector<std::string> names = {"peel", "abuffer", "compute"};
    return names;
}

const std::vector<std::string>& traversal_names() {
    static const std::vector<std::string> names = {"two-level", "mipmap", "voxel"};
    return names;
}

const std::vector<std::string>& hit_test_names() {
    static const std::vector<std::string> names = {"tolerance", "planar", "exact"};
    return names;
}

const std::vector<std::string>& ray_kind_names() {
    static const std::vector<std::string> names = {"primary", "mirror", "refraction", "shadow", "ambient", "diffuse"};
    return names;
}

const std::vector<std::string>& effect_names() {
    static const std::vector<std::string> names = {"reflection", "refraction", "shadow", "ambient"};
    return names;
}

std::string cost_aov(const RayCostField& field) {
    return fmt::format("cost_{}", field.name);
}

const std::vector<std::string>& ray_setup_names() {
    static const std::vector<std::string> names = {"reflection", "box", "directions"};
    return names;
}

const std::vector<std::string>& all_aov_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all = aov_names();
        all.insert(all.end(), ray_setup_names().begin(), ray_setup_names().end());
        for (const RayCostField& field : kRayCostFields) all.push_back(cost_aov(field));
        return all;
    }();
    return names;
}

const RayCostField* cost_field(const std::string& aov) {
    for (const RayCostField& field : kRayCostFields)
        if (aov == cost_aov(field)) return &field;
    return nullptr;
}

bool wants_ray_setup(const std::vector<std::string>& aovs) {
    return std::any_of(aovs.begin(), aovs.end(), [](const std::string& name) {
        return std::find(ray_setup_names().begin(), ray_setup_names().end(), name) != ray_setup_names().end();
    });
}

const std::vector<std::string>& aov_names() {
    static const std::vector<std::string> names = {"depth", "normal", "albedo", "position", "triangle", "material"};
    return names;
}

}  // namespace peelray
