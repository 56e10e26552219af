// The one infinite double.
#pragma once

#include <limits>

namespace peelray {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace peelray
