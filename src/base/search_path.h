// Where programs and what is kept from run to run are, by the environment's variables.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace peelray {

/// The first executable file `name` in the folders of `path`, which colons part; none: there is none.
std::optional<std::filesystem::path> find_program(std::string_view path, std::string_view name);

/// The program's own folder in `xdg_cache_home`, or else in `home`/.cache; empty where both are.
std::filesystem::path cache_folder(std::string_view xdg_cache_home, std::string_view home);

}  // namespace peelray
