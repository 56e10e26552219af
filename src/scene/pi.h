// The circle's constant in single precision.
#pragma once

#include <numbers>

namespace peelray {

inline constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace peelray
