#include "base/search_path.h"

#include <unistd.h>

namespace peelray {

std::optional<std::filesystem::path> find_program(std::string_view path, std::string_view name) {
    while (!path.empty()) {
        const size_t colon = path.find(':');
        const std::filesystem::path program = std::filesystem::path(path.substr(0, colon)) / name;
        std::error_code error;
        if (std::filesystem::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) return program;
        path = colon == std::string_view::npos ? std::string_view() : path.substr(colon + 1);
    }
    return std::nullopt;
}

std::filesystem::path cache_folder(std::string_view xdg_cache_home, std::string_view home) {
    if (!xdg_cache_home.empty()) return std::filesystem::path(xdg_cache_home) / "peelray";
    if (!home.empty()) return std::filesystem::path(home) / ".cache" / "peelray";
    return {};
}

}  // namespace peelray
