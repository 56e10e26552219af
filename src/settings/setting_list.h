// Settings as a list: what each is called, says of itself and allows, with ways to read and write its value as text.
// Front ends (the options of the command line and their help, the manifest of a sequence) know no setting by itself.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "settings/limits.h"
#include "settings/text.h"

namespace peelray {

/// What is known of a setting, whatever its value.
struct SettingInfo {
    std::string name = {};   ///< "exposure": its flag is --exposure
    char letter = 0;         ///< of a short flag
    std::string group = {};  ///< heading of its help
    std::string help = {};
    std::string form = {};      ///< what is typed, for help: "X,Y,Z"; empty: after the type
    std::string expected = {};  ///< the same for an error: "three numbers X,Y,Z"; empty: after the type
    std::string preset = {};    ///< for help, where the value itself does not say what is done without it
    std::string none = {};      ///< of an optional value: the word for nothing, such as "auto"
    std::string implied = {};   ///< the value where none is typed; empty: one must be
    Limits limits = {};
    bool required = false;
    bool several = false;         ///< may be given several times: a list that grows
    bool changes_picture = true;  ///< false: it makes no difference to any picture or hit
    bool of_cubes = false;        ///< whoever gives it means the layered depth cubes, or to measure a device
    /// Names of settings that it excludes, and of one without which it has no meaning.
    std::vector<std::string> excludes = {};
    std::string needs = {};
};

/// A setting of one object, which must outlive it.
struct SettingEntry {
    SettingInfo info;
    bool is_flag = false;                              ///< given or not, without a value
    std::function<bool(const std::string&)> set;       ///< false: the text is of another form
    std::function<std::optional<std::string>()> text;  ///< the value as it would be typed; none: not chosen
    std::function<void()> check;                       ///< Throws Error for a value out of its limits
};

using SettingList = std::vector<SettingEntry>;

/// Null: there is none of this name.
inline const SettingEntry* find_setting(const SettingList& list, std::string_view name) {
    for (const SettingEntry& entry : list)
        if (entry.info.name == name) return &entry;
    return nullptr;
}

/// Throws Error for the first value that is out of its limits.
inline void check_limits(const SettingList& list) {
    for (const SettingEntry& entry : list) entry.check();
}

/// The word for nothing and the names of a choice, with bars in between.
template <Choice Value>
std::string form_of(const std::string& none) {
    std::string form = none;
    for (const Value value : values_of<Value>()) form.append(form.empty() ? "" : "|").append(name_of(value));
    return form;
}

/// Adds a setting whose text has ways of its own.
template <typename Value, typename Parse, typename Print>
void add_setting(SettingList& list, Value& value, SettingInfo info, Parse parse, Print print) {
    SettingEntry entry;
    entry.set = [&value, parse](const std::string& text) {
        auto parsed = parse(text);
        if (parsed) value = std::move(*parsed);
        return parsed.has_value();
    };
    entry.text = [&value, print] { return print(value); };
    entry.check = [&value, name = info.name, limits = info.limits] {
        if constexpr (requires { check_limits(limits, Setting{name}, value); })
            check_limits(limits, Setting{name}, value);
    };
    entry.info = std::move(info);
    list.push_back(std::move(entry));
}

namespace detail {

template <typename T>
struct Plain {
    using type = T;
    static constexpr bool is_optional = false;
};
template <typename T>
struct Plain<std::optional<T>> {
    using type = T;
    static constexpr bool is_optional = true;
};

template <typename Value>
void complete(SettingInfo& info) {
    if constexpr (Choice<Value>) {
        if (info.form.empty()) info.form = form_of<Value>(info.none);
        if (info.expected.empty()) info.expected = "one of " + info.form;
    } else if constexpr (std::is_integral_v<Value>) {
        if (info.form.empty()) info.form = "N";
        if (info.expected.empty()) info.expected = "a whole number from 0 up";
    } else if constexpr (std::is_floating_point_v<Value>) {
        if (info.form.empty()) info.form = "X";
        if (info.expected.empty()) info.expected = "a number";
    }
}

}  // namespace detail

/// Adds a setting that is parsed and printed as its type is; std::optional: none where it was not chosen.
template <typename Value>
void add_setting(SettingList& list, Value& value, SettingInfo info) {
    using Plain = detail::Plain<Value>;
    using Type = typename Plain::type;
    detail::complete<Type>(info);
    const std::string none = info.none;
    const auto parse = [none](const std::string& text) -> std::optional<Value> {
        if constexpr (Plain::is_optional)
            if (!none.empty() && text == none) return std::optional<Value>(std::in_place);
        if (const std::optional<Type> parsed = parse_as<Type>(text)) return Value(*parsed);
        return std::nullopt;
    };
    const auto print = [none](const Value& v) -> std::optional<std::string> {
        if constexpr (Plain::is_optional) {
            if (v) return print_text(*v);
            // A choice has no value that is none of its names; a number that is not chosen is nothing.
            return Choice<Type> && !none.empty() ? std::optional(none) : std::nullopt;
        } else {
            const std::string text = print_text(v);
            return text.empty() ? std::nullopt : std::optional(text);
        }
    };
    add_setting(list, value, std::move(info), parse, print);
}

/// Adds a setting that is given or not.
inline void add_setting(SettingList& list, bool& value, SettingInfo info) {
    add_setting(
        list, value, std::move(info),
        [](const std::string& text) {
            return text == "true" ? std::optional(true) : text == "false" ? std::optional(false) : std::nullopt;
        },
        [](bool given) { return given ? std::optional<std::string>("true") : std::nullopt; });
    list.back().is_flag = true;
}

}  // namespace peelray
