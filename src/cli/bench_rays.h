// What plain `peelray bench` found out, as JSON and as a Markdown table.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/ray_rows.h"

namespace peelray {

nlohmann::ordered_json ray_row_json(const RayRow& row);

std::string ray_table_head(const std::vector<RayKind>& kinds);
std::string ray_table_row(const RayRow& row, const std::vector<RayKind>& kinds);
std::string ray_table_foot();
/// How many times as long as the rivals ours take for the same rays; empty without rivals.
std::string ratio_table(const std::vector<RayRow>& rows, const std::vector<RayKind>& kinds);
/// What our rays cost, but for the cheaper half: it is the dearest that a picture waits for. Empty without ours.
std::string costs_table(const std::vector<RayRow>& rows);

}  // namespace peelray
