// Files that a command is about to write.
#pragma once

#include <filesystem>
#include <vector>

namespace peelray {

/// Throws Error if a file of `outputs` cannot be written, comes twice or is one of `inputs`. Inputs without a name are
/// left out.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

}  // namespace peelray
