#include "settings/limits.h"

#include "settings/text.h"

namespace peelray {

void fail_limits(const Limits& limits, Setting setting, const std::string& value) {
    fail("{}: choose {} ({})", fmt::format(fmt::runtime(limits.fault), value), limits.choose, setting);
}

template <typename Vector>
static void check_vector(const Limits& limits, Setting setting, const Vector& vector) {
    for (int i = 0; i < 3; i++)
        if (!std::isfinite(vector[i])) fail("{} must be three finite numbers", setting);
    for (int i = 0; i < 3; i++)
        if (!limits.allow(double(vector[i]))) fail_limits(limits, setting, print_text(vector));
}

void check_limits(const Limits& limits, Setting setting, const glm::vec3& vector) {
    check_vector(limits, setting, vector);
}

void check_limits(const Limits& limits, Setting setting, const glm::dvec3& vector) {
    check_vector(limits, setting, vector);
}

void check_limits(const Limits& limits, Setting setting, const glm::uvec2& size) {
    if (!limits.allow(size.x) || !limits.allow(size.y)) fail_limits(limits, setting, print_text(size));
}

void check_limits(const Limits& limits, Setting setting, const Background& background) {
    if (background.color) check_limits(limits, setting, *background.color);
}

void check_captures(BuilderKind builder, HitTest test) {
    if (builder == BuilderKind::peel && test == HitTest::exact)
        fail(
            "{} peel captures pixel centres, not all that a triangle touches: use {} planar or tolerance, or {} "
            "abuffer or compute",
            setting::builder, setting::hit, setting::builder);
}

}  // namespace peelray
