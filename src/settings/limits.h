// Ranges of settings, for the table and for what works below it: a limit and its message are stated once.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "settings/choices.h"
#include "settings/text.h"

namespace peelray {

/// The values of a number, or of each component of a vector, that make sense.
struct Limits {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    double least = -infinity, most = infinity;
    bool open = false;  ///< neither end is allowed
    double step = 0;    ///< only least, least + step, ... are; 0: everything in between
    /// What an Error says: of the value, with {} for it, and what to choose.
    const char* fault = "{} is out of range";
    const char* choose = "";

    bool allow(double value) const {
        const bool inside = open ? value > least && value < most : value >= least && value <= most;
        return inside && (step == 0 || std::fmod(value - least, step) == 0);
    }
};

inline constexpr Limits kResolutionLimits{
    .least = 16, .most = 2048, .fault = "an LDI resolution of {} is out of range", .choose = "16 to 2048, or auto"};
inline constexpr Limits kRefineLimits{
    .least = 1, .most = 1e9, .fault = "a list of {} samples is none", .choose = "1 or more, or auto"};
inline constexpr Limits kMemoryLimits{
    .least = 1, .most = 1e7, .fault = "a memory limit of {} MiB is out of range", .choose = "1 to 10000000"};
inline constexpr Limits kMergeLimits{
    .least = 0, .most = 1e9, .fault = "{} triangles are out of range", .choose = "0 or more, or auto"};
inline constexpr Limits kBlockLimits{
    .least = 2, .most = 32, .fault = "a block of {} pixels is out of range", .choose = "2 to 32 a side"};
inline constexpr Limits kBounceLimits{.least = 0, .most = 16, .fault = "{} bounces are too many", .choose = "0 to 16"};
inline constexpr Limits kPhotonLimits{
    .least = 0, .most = 1 << 24, .fault = "{} photons are too many", .choose = "0 to 16777216"};
inline constexpr Limits kSampleLimits{
    .least = 1, .most = 65536, .fault = "{} samples per pixel are out of range", .choose = "1 to 65536"};

inline constexpr Limits kClampLimits{
    .least = 0, .open = true, .fault = "a limit of {} to samples is impossible", .choose = "a radiance above 0"};
inline constexpr Limits kTimeLimits{
    .least = 0, .open = true, .fault = "a time limit of {} seconds is impossible", .choose = "one above 0"};
inline constexpr Limits kNoiseLimits{
    .least = 0, .open = true, .fault = "a noise of {} is impossible", .choose = "one above 0, such as 0.05"};

/// Throws the Error of a value, as it is typed, that is out of its limits.
[[noreturn]] void fail_limits(const Limits& limits, Setting setting, const std::string& value);
/// Throws Error unless the vector is finite and its components are allowed.
void check_limits(const Limits& limits, Setting setting, const glm::vec3& vector);
void check_limits(const Limits& limits, Setting setting, const glm::dvec3& vector);
void check_limits(const Limits& limits, Setting setting, const glm::uvec2& size);
/// Of its colour.
void check_limits(const Limits& limits, Setting setting, const Background& background);

template <typename Number>
requires std::is_arithmetic_v<Number>
void check_limits(const Limits& limits, Setting setting, Number value) {
    if (!limits.allow(double(value))) fail_limits(limits, setting, fmt::format("{}", value));
}
template <typename Value>
requires requires(const Limits& limits, Setting setting, const Value& value) {
    check_limits(limits, setting, value);
}
void check_limits(const Limits& limits, Setting setting, const std::optional<Value>& value) {
    if (value) check_limits(limits, setting, *value);
}
template <typename Value>
requires requires(const Limits& limits, Setting setting, const Value& value) {
    check_limits(limits, setting, value);
}
void check_limits(const Limits& limits, Setting setting, const std::vector<Value>& values) {
    for (const Value& value : values) check_limits(limits, setting, value);
}

/// Throws Error, naming what would work, where a builder does not capture what a hit test needs.
void check_captures(BuilderKind builder, HitTest test);

}  // namespace peelray
