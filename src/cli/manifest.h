// The file beside a sequence's pictures that says how they were made, so that no run mixes pictures of two settings.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/sequence.h"

namespace peelray {

/// "frame_%05d.exr.json" for "frame_%05d.exr".
std::filesystem::path manifest_path(const std::filesystem::path& pattern);

/// Those of `settings` that change pictures, by their flags; null: not chosen.
nlohmann::ordered_json manifest_settings(const SettingList& settings);

/// All that shapes the pictures: options by their values, the program, what renders, and the content of every file that
/// was read. What does not, such as the range of frames, is left out. Throws Error if a file vanished.
nlohmann::ordered_json make_manifest(const RenderArguments& arguments, const Sequence& sequence,
                                     const PosedScene& scene, const std::string& renderer);

/// Makes `path` say what `now` does. A file there that says so is left alone, and so is its time. One that says
/// otherwise is replaced, but where the run shares its frames with others (--resume, --shard) it is an Error that tells
/// what differs: what it was, what it is.
void settle_manifest(const std::filesystem::path& path, const nlohmann::ordered_json& now, bool shares_frames);

}  // namespace peelray
