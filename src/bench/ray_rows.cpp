#include "bench/ray_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace peelray {

const TracedSet* RayRow::set(RayKind kind) const {
    const auto found = std::find_if(sets.begin(), sets.end(), [&](const TracedSet& s) { return s.kind == kind; });
    return found == sets.end() ? nullptr : &*found;
}

std::optional<double> RayRow::dynamic_ms() const {
    const TracedSet *mirror = set(RayKind::mirror), *shadow = set(RayKind::shadow);
    if (build.runs == 0 || !mirror || !shadow || !mirror->counts() || !shadow->counts()) return std::nullopt;
    return build.median + mirror->time.median + shadow->time.median;
}

std::string RayRow::label() const {
    if (!is_ours()) return contender;
    const std::string n = ldc ? fmt::format("{}", *ldc) : "auto";
    return traversal == Traversal::voxel ? fmt::format("{} {}", contender, n)
                                         : fmt::format("{} {} {}", contender, name_of(traversal), n);
}

}  // namespace peelray
