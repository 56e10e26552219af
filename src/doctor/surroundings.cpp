#include "doctor/surroundings.h"

#include <dlfcn.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace peelray {
namespace {

namespace fs = std::filesystem;

/// The library that a driver file names; empty: none, also where the file is damaged.
std::string library_of(std::istream& driver_file) {
    const auto json = nlohmann::json::parse(driver_file, nullptr, false);
    if (!json.is_object() || !json.contains("ICD") || !json["ICD"].is_object()) return "";
    const auto path = json["ICD"].find("library_path");
    return path != json["ICD"].end() && path->is_string() ? path->get<std::string>() : "";
}

std::vector<fs::path> split(const std::string& list) {
    std::vector<fs::path> out;
    for (size_t at = 0; at < list.size();) {
        const size_t colon = std::min(list.find(':', at), list.size());
        if (colon > at) out.emplace_back(list.substr(at, colon - at));
        at = colon + 1;
    }
    return out;
}

}  // namespace

Surroundings Surroundings::real() {
    Surroundings out;
    out.variable = [](const char* name) -> std::optional<std::string> {
        const char* value = std::getenv(name);
        return value ? std::optional<std::string>(value) : std::nullopt;
    };
    out.user = ::geteuid();
    out.groups.resize(size_t(std::max(::getgroups(0, nullptr), 0)));
    if (::getgroups(int(out.groups.size()), out.groups.data()) < 0) out.groups.clear();
    out.groups.push_back(::getegid());
    out.loading_fault = [](const std::string& library) -> std::string {
        if (void* handle = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
            ::dlclose(handle);
            return "";
        }
        const char* fault = ::dlerror();
        return fault ? fault : "it cannot be loaded";
    };
    return out;
}

bool Surroundings::has(const fs::path& place) const {
    std::error_code error;
    return fs::exists(at(place), error);
}

std::string Surroundings::text(const fs::path& place) const {
    std::ifstream stream(at(place), std::ios::binary);
    std::string text(4096, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(std::max<std::streamsize>(stream.gcount(), 0)));
    return text;
}

std::vector<fs::path> Surroundings::files(const fs::path& folder, std::string_view prefix) const {
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(at(folder), error), end; !error && entry != end; entry.increment(error))
        if (entry->path().filename().string().starts_with(prefix)) out.push_back(folder / entry->path().filename());
    std::sort(out.begin(), out.end());
    return out;
}

std::string Surroundings::variable_or(const char* name, const std::string& otherwise) const {
    const auto value = variable(name);
    return value && !value->empty() ? *value : otherwise;
}

bool Surroundings::may_use(const fs::path& place) const {
    struct stat info;
    if (user == 0 || ::stat(at(place).c_str(), &info) != 0) return true;
    const bool in_group = std::find(groups.begin(), groups.end(), info.st_gid) != groups.end();
    const mode_t bits = user == info.st_uid ? info.st_mode >> 6 : in_group ? info.st_mode >> 3 : info.st_mode;
    return (bits & 6) == 6;
}

std::string Surroundings::group_of(const fs::path& place) const {
    struct stat info;
    if (::stat(at(place).c_str(), &info) != 0) return "render";
    const group* entry = ::getgrgid(info.st_gid);
    return entry ? entry->gr_name : std::to_string(info.st_gid);
}

bool Surroundings::in_container() const {
    return has(".dockerenv") || has("run/.containerenv") || variable("container").has_value() ||
           variable("KUBERNETES_SERVICE_HOST").has_value();
}

std::vector<DriverFile> driver_files(const Surroundings& around) {
    std::vector<fs::path> places;
    const auto add_all = [&](const std::vector<fs::path>& named) {
        for (const fs::path& path : named) {
            // What variables name stands in the real machine.
            std::error_code error;
            if (!fs::is_directory(path, error)) {
                places.push_back(path);
                continue;
            }
            for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
                places.push_back(entry->path());
        }
    };
    const std::string instead = around.variable_or("VK_DRIVER_FILES", around.variable_or("VK_ICD_FILENAMES", ""));
    add_all(split(around.variable_or("VK_ADD_DRIVER_FILES", "")));
    if (!instead.empty()) {
        add_all(split(instead));
    } else {
        for (const char* folder : {"etc/xdg/vulkan/icd.d", "usr/local/etc/vulkan/icd.d", "etc/vulkan/icd.d",
                                   "usr/local/share/vulkan/icd.d", "usr/share/vulkan/icd.d"})
            for (const fs::path& place : around.files(folder)) places.push_back(around.at(place));
        const std::string home = around.variable_or("HOME", "");
        for (const std::string& base : {around.variable_or("XDG_CONFIG_HOME", home + "/.config"),
                                        around.variable_or("XDG_DATA_HOME", home + "/.local/share")})
            if (base.starts_with("/")) add_all({fs::path(base) / "vulkan/icd.d"});
    }
    std::vector<DriverFile> out;
    for (const fs::path& path : places) {
        std::ifstream stream(path);
        if (!stream || path.extension() != ".json") continue;
        DriverFile driver{path, library_of(stream), ""};
        if (driver.library.empty())
            driver.fault = "the file names no library";
        else if (driver.library.find('/') == std::string::npos)
            driver.fault = around.loading_fault(driver.library);  // as the loader finds any library
        else
            driver.fault = around.loading_fault((path.parent_path() / driver.library).string());
        out.push_back(std::move(driver));
    }
    return out;
}

}  // namespace peelray
