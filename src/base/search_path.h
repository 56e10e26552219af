// Programs on the PATH.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace peelray {

/// The first executable file `name` in the folders of `path`, which colons part; none: there is none.
std::optional<std::filesystem::path> find_program(std::string_view path, std::string_view name);

}  // namespace peelray
