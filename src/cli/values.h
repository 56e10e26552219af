// Option values that are more than a word: text to values. Nothing is returned for text of another form, which is wrong
// usage; whether a value makes sense for this scene and device is for others to say.
#pragma once

#include <charconv>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/program.h"

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
std::optional<glm::uvec2> parse_size(const std::string& text);
/// "1,2.5,-3"
std::optional<glm::vec3> parse_vector(const std::string& text);
/// A number, or "auto": none.
std::optional<std::optional<uint32_t>> parse_resolution(const std::string& text);
/// "8" or "8x4": the pixels of a block.
std::optional<glm::uvec2> parse_block(const std::string& text);
/// "10:20": the frames 10 to 19.
std::optional<FrameRange> parse_frames(const std::string& text);
/// "2/8": part 2 of 8, counted from 0.
std::optional<Shard> parse_shard(const std::string& text);
/// A list out of effect_names(), or "none": an empty one.
std::optional<std::vector<std::string>> parse_effects(const std::string& text);
/// A list out of all_aov_names(), or "all": aov_names().
std::optional<std::vector<std::string>> parse_aovs(const std::string& text);

/// Tracers to compare; none twice.
std::optional<std::vector<std::string>> parse_tracers(const std::string& text);
/// Hit tests to compare; none twice.
std::optional<std::vector<std::string>> parse_hits(const std::string& text);

/// What `bench` runs through, lists with nothing twice: scenes (any names, none empty), builders, traversals, hit tests
/// (without "auto"), kinds of rays, resolutions ("auto": none), picture sizes ("none": an empty list).
std::optional<std::vector<std::string>> parse_bench_scenes(const std::string& text);
/// Is each of them one of the paper's?
bool are_paper_scenes(const std::vector<std::string>& names);
std::optional<std::vector<std::string>> parse_builders(const std::string& text);
std::optional<std::vector<std::string>> parse_traversals(const std::string& text);
std::optional<std::vector<std::string>> parse_hit_tests(const std::string& text);
std::optional<std::vector<std::string>> parse_ray_kinds(const std::string& text);
std::optional<std::vector<std::optional<uint32_t>>> parse_resolutions(const std::string& text);
std::optional<std::vector<glm::uvec2>> parse_sizes(const std::string& text);

const std::vector<std::string>& builder_names();
const std::vector<std::string>& traversal_names();
const std::vector<std::string>& hit_test_names();
const std::vector<std::string>& ray_kind_names();
const std::vector<std::string>& effect_names();
const std::vector<std::string>& aov_names();
/// The auxiliary pictures of what the paper sets up before it traces (Figure 7).
const std::vector<std::string>& ray_setup_names();
/// The auxiliary picture of what a pixel's rays cost: cost_steps, ...
std::string cost_aov(const RayCostField& field);
const std::vector<std::string>& all_aov_names();
/// The field that this auxiliary picture shows; null: it is none of the costs.
const RayCostField* cost_field(const std::string& aov);
/// Is one of ray_setup_names() among these?
bool wants_ray_setup(const std::vector<std::string>& aovs);

}  // namespace peelray
