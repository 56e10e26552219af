// Specialisation constants, matched with those of a shader by their names, as bindings are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace peelray {

/// A specialisation constant and its value; of a bool 0 or 1.
struct Constant {
    std::string name;  ///< of the variable in the shader
    uint32_t value;

    auto operator<=>(const Constant&) const = default;
};

/// All constants of a pass, in any order.
using Constants = std::vector<Constant>;

}  // namespace peelray
