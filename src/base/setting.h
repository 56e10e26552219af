// Names of settings, for errors: what below a front end says which settings are at fault, the front end how they are
// written there.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>

namespace peelray {

/// A setting that an error names, by its name in the table of settings (src/settings).
struct Setting {
    std::string_view name;
};

/// Those that code below the table has reason to name.
namespace setting {
inline constexpr Setting animation{"animation"}, background{"background"}, batch{"batch"}, block{"block"},
    bounces{"bounces"}, builder{"builder"}, camera{"camera"}, caustics{"caustics"}, clamp{"clamp"}, depth{"depth"},
    device{"device"}, double_sided{"double-sided"}, effects{"effects"}, env_visible{"env-visible"}, eye{"eye"},
    fov{"fov"}, gi{"gi"}, hit{"hit"}, ldc{"ldc"}, look{"look"}, memory_limit{"memory-limit"},
    noise_target{"noise-target"}, routing{"routing"}, shadow_catcher{"shadow-catcher"}, size{"size"}, spp{"spp"},
    time{"time"}, time_limit{"time-limit"}, tolerance{"tolerance"}, tracer{"tracer"}, traversal{"traversal"}, up{"up"},
    validate{"validate"}, variant{"variant"}, visibility{"visibility"};
}  // namespace setting

/// Around the name of a setting in the text of an Error. A front end that prints the text replaces both.
inline constexpr char kSettingBegin = '\x0e', kSettingEnd = '\x0f';

}  // namespace peelray

template <>
struct fmt::formatter<peelray::Setting> : fmt::formatter<std::string_view> {
    template <typename Context>
    auto format(const peelray::Setting& setting, Context& context) const {
        return fmt::format_to(context.out(), "{}{}{}", peelray::kSettingBegin, setting.name, peelray::kSettingEnd);
    }
};
