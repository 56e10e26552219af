#include "cli/manifest.h"

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "cli/content_hash.h"
#include "cli/stats_json.h"
#include "cli/version.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Settings by their flags, as a user would type them, so that a message can say them.
Json settings_of(const RenderArguments& arguments, const Sequence& sequence, const PosedScene& scene) {
    RenderArguments a = arguments;
    // What was chosen, where nothing was given; of a file its name, since its content is compared.
    a.time = sequence.runs ? std::nullopt : scene.time();
    a.animation = scene.animation();
    a.sequence.fps = sequence.runs ? std::optional(sequence.fps) : std::nullopt;
    a.env = fs::path(a.env).filename().string();
    return manifest_settings(options_of(a));
}

/// Files by their names as seen from the scene's folder, so that the whole may be moved.
Json files_of(const RenderArguments& a, const Scene& scene) {
    Json files = Json::object();
    std::error_code error;
    const fs::path self(a.scene), parent = self.has_parent_path() ? self.parent_path() : fs::path(".");
    const fs::path folder = fs::weakly_canonical(parent, error);
    for (const fs::path& file : scene.files) {
        // A scene that is a link goes by the link's name; what it names lies in the link's folder.
        const fs::path name = file == self ? self.filename() : file.lexically_relative(folder);
        files[name.generic_string()] = content_hash(file);
    }
    if (!a.env.empty()) files["--env " + fs::path(a.env).filename().string()] = content_hash(a.env);
    return files;
}

std::string shown(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    return value.is_boolean() ? "given" : "not given";
}

/// What differs between two objects, "NAME was BEFORE, is NOW" each.
void compare(const Json& before, const Json& now, const std::string& prefix, std::vector<std::string>& differences) {
    const auto value = [](const Json& object, const std::string& key) {
        return object.is_object() && object.contains(key) ? object[key] : Json(nullptr);
    };
    const auto look_at = [&](const std::string& key) {
        const Json old = value(before, key), young = value(now, key);
        if (old != young)
            differences.push_back(fmt::format("{}{} was {}, is {}", prefix, key, shown(old), shown(young)));
    };
    for (const auto& [key, unused] : now.items()) look_at(key);
    if (!before.is_object()) return;
    for (const auto& [key, unused] : before.items())
        if (!now.contains(key)) look_at(key);
}

/// One line of all that differs; empty: nothing.
std::string differences(const Json& before, const Json& now) {
    std::vector<std::string> found;
    const auto part = [](const Json& json, const char* key) { return json.contains(key) ? json[key] : Json(nullptr); };
    const auto plain = [](Json json) {
        json.erase("settings");
        json.erase("files");
        return json;
    };
    compare(plain(before), plain(now), "the ", found);
    const bool other_scene = part(before, "scene") != part(now, "scene");
    compare(part(before, "settings"), part(now, "settings"), "", found);
    if (!other_scene) compare(part(before, "files"), part(now, "files"), "the content of ", found);
    constexpr size_t most = 3;
    std::string line;
    for (size_t i = 0; i < std::min(found.size(), most); i++) line += (i ? "; " : "") + found[i];
    if (found.size() > most) line += fmt::format("; and {} more", found.size() - most);
    return line;
}

Json read_manifest(const fs::path& path) {
    std::ifstream stream(path);
    const Json json = Json::parse(stream, nullptr, false);
    if (!json.is_object() || json.value("manifest", Json()) != 1)
        fail("{} is no manifest of a sequence that this version knows: remove it to start anew", path.string());
    return json;
}

}  // namespace

Json manifest_settings(const SettingList& settings) {
    Json json = Json::object();
    for (const SettingEntry& setting : settings) {
        if (!setting.info.changes_picture) continue;
        const std::optional<std::string> text = setting.text();
        json[fmt::format("--{}", setting.info.name)] = !text             ? Json(nullptr)
                                                       : setting.is_flag ? Json(true)
                                                                         : Json(*text);
    }
    return json;
}

fs::path manifest_path(const fs::path& pattern) {
    return pattern.string() + ".json";
}

Json make_manifest(const RenderArguments& a, const Sequence& sequence, const PosedScene& scene,
                   const std::string& renderer) {
    const Json json = {{"manifest", 1},
                       {"program", fmt::format("peelray {}", program_version())},
                       {"commit", build_commit()},
                       {"device", renderer},
                       {"scene", a.scene.starts_with("builtin:") ? a.scene : fs::path(a.scene).filename().string()},
                       {"settings", settings_of(a, sequence, scene)},
                       {"files", files_of(a, scene.scene())}};
    // As it will read from the file: names need not be UTF-8, JSON is.
    return Json::parse(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void settle_manifest(const fs::path& path, const Json& now, bool shares_frames) {
    std::error_code error;
    if (!shares_frames) {
        const bool agrees = fs::exists(path, error) && Json::parse(std::ifstream(path), nullptr, false) == now;
        if (!agrees) write_json(path, now);
        return;
    }
    // Of several runs that start together one writes it, the others compare.
    if (!fs::exists(path, error) && write_json_if_absent(path, now)) return;
    const std::string line = differences(read_manifest(path), now);
    if (!line.empty())
        fail(
            "the frames that are there were made differently: {} ({}); use the same, or remove that file to start anew",
            line, path.string());
}

}  // namespace peelray
