#include "render/render_settings.h"

#include <algorithm>

namespace peelray {

CubeChoice choose_automatically(const Device& device, uint32_t triangles, const RenderSettings& settings) {
    CubeChoice choice = settings.cubes;
    // Beyond this the triangles are smaller than what a fine cube resolves, and `exact` lists grow long.
    const uint64_t most = choice.layout.by_pixel() ? ~0ull : most_exact_triangles(device);
    if (settings.hit_auto)
        choice.hit = triangles > std::min<uint64_t>(4'000'000, most) ? HitTest::planar : HitTest::exact;
    // Peeling captures pixel centres.
    if (settings.hit_auto && choice.layout.builder == BuilderKind::peel) choice.hit = HitTest::planar;
    return choice;
}

}  // namespace peelray
