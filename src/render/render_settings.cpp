#include "render/render_settings.h"

namespace peelray {

CubeChoice choose_automatically(uint32_t triangles, const RenderSettings& settings) {
    CubeChoice choice = settings.cubes;
    if (!settings.hit_auto) return choice;
    // Beyond this the triangles are smaller than what a fine cube resolves, and `exact` lists grow long.
    choice.hit = triangles > 4'000'000 ? HitTest::planar : HitTest::exact;
    // Peeling captures pixel centres.
    if (choice.layout.builder == BuilderKind::peel) choice.hit = HitTest::planar;
    choice.may_be_planar = choice.hit == HitTest::exact;
    return choice;
}

bool needs_rays(const RenderSettings& settings, bool has_blended) {
    return settings.shadow || settings.ambient || settings.gi > 0 || settings.counters ||
           (has_blended && settings.refraction) ||
           (settings.bounces > 0 && (settings.reflection || settings.refraction));
}

}  // namespace peelray
