#include "scene/generated.h"

#include <cmath>
#include <numbers>

namespace peelray {
namespace {

constexpr double kDropEvery = 0.55;  // seconds

/// Repeatable numbers in [0, 1).
float random_of(uint64_t a, uint64_t b) {
    uint64_t x = a * 0x9E3779B97F4A7C15ull + b * 0xD1B54A32D192ED03ull + 0x632BE59BD9B4E019ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return float((x ^ (x >> 31)) >> 40) * 0x1p-24f;
}

}  // namespace

WaterDrop drop_at(const Water& water, uint64_t step) {
    // The number of the drop that the time of this step has passed, if the last one's has not.
    const auto number = [&](uint64_t s) { return uint64_t(double(s) / water.steps_per_second / kDropEvery); };
    if (step == 0 || number(step) == number(step - 1)) return {};
    const uint64_t i = number(step);
    const float reach = 0.42f * water.size;
    return {{reach * (2 * random_of(i, 0) - 1), reach * (2 * random_of(i, 1) - 1)},
            -0.9f - 0.9f * random_of(i, 2),
            0.06f + 0.05f * random_of(i, 3)};
}

WaterSteps steps_until(const Water& water, double time) {
    const double steps = std::floor(time * water.steps_per_second + 1e-6);
    return {uint64_t(steps), std::max(time - steps / water.steps_per_second, 0.0)};
}

glm::vec3 drift_of(const Water::Float& f, double time) {
    const double turns = time / double(f.period) + f.phase, angle = 2 * std::numbers::pi * (turns - std::floor(turns));
    return {f.around.x + f.drift * float(std::cos(angle)), f.around.y + f.drift * float(std::sin(angle)), float(angle)};
}

}  // namespace peelray
