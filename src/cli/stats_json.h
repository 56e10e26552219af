// The stats files: the one place where statistics become JSON. Keys, their order and their values are a contract.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "workspace/stats.h"

namespace peelray {

/// Device, driver, API version and the build's commit.
nlohmann::ordered_json machine_json(const Machine& machine);
/// All of a picture.
nlohmann::ordered_json picture_json(const PictureStats& stats);
/// Of `peelray trace`.
nlohmann::ordered_json trace_json(const TraceStats& stats);

/// Parts of a picture's: rays by kind; cubes (the first 64 one by one), null where none traced; bytes by structure.
nlohmann::ordered_json rays_json(const RayCounts& rays);
/// What the rays of a kind cost: mean, 50th and 99th percentile and the most of a single ray, by kRayCostFields.
nlohmann::ordered_json kind_costs_json(const KindCosts& cost);
nlohmann::ordered_json cubes_json(const PictureStats& stats);
nlohmann::ordered_json memory_bytes_json(const RenderStats& stats);

/// Writes indented JSON, atomically. Throws Error if unwritable.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);
/// The same, but leaves a file that is there alone. Returns whether it wrote.
bool write_json_if_absent(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace peelray
