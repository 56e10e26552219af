// Specialisation constants put into a shader's code.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "gpu/constants.h"

namespace peelray {

/// SPIR-V with its specialisation constants, and what follows from them, as plain constants. `values`: by constant_id,
/// of bools 0 or 1; a constant without one keeps its default.
///
/// A pipeline could be given them beside the code; the validation layers then put them in themselves and look through
/// the whole shader again for each pipeline of each process. A shader without such constants they look through once and
/// remember: half of what tests of pictures took.
std::vector<uint32_t> specialize(std::span<const uint32_t> code, const std::map<uint32_t, uint32_t>& values);

}  // namespace peelray
