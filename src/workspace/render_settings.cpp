#include "workspace/render_settings.h"

namespace peelray {

DeviceOptions device_options(const DeviceArguments& a) {
    DeviceOptions options;
    options.select = a.device;
    options.validate = a.validate;
    options.memory_limit = uint64_t(a.memory_limit.value_or(0)) << 20;
    return options;
}

void choose_hit(RenderSettings& settings, std::optional<HitTest> hit) {
    settings.hit_auto = !hit;
    settings.cubes.hit = hit.value_or(HitTest::exact);
}

void choose_tracing(RenderSettings& settings, const TracingArguments& tracing) {
    CubeLayout& layout = settings.cubes.layout;
    settings.cubes.ldc = tracing.ldc.value_or(0);
    settings.cubes.refine = tracing.refine;
    settings.cubes.merge = tracing.merge;
    settings.cubes.tolerance = float(tracing.tolerance);
    layout.traversal = tracing.traversal;
    layout.block = tracing.block;
    layout.batch = tracing.batch;
    layout.half_depth = tracing.depth == 16;
    layout.builder = tracing.builder.value_or(BuilderKind::compute);
    layout.routing = tracing.routing;
}

static Backdrop backdrop_of(const LightArguments& a) {
    using Kind = Backdrop::Kind;
    if (a.is_transparent()) return {Kind::transparent};
    switch (a.visible()) {
        case EnvVisible::yes:
            return {Kind::environment};
        case EnvVisible::blurred:
            return {Kind::blurred};
        case EnvVisible::no:
            break;
    }
    return {Kind::color, a.background ? *a.background->color : glm::vec3(0)};
}

RenderSettings render_settings(const PictureArguments& a) {
    RenderSettings settings;
    settings.tracer = a.tracing.tracer.value_or(Tracer::ldc);
    settings.width = a.size.x;
    settings.height = a.size.y;
    choose_tracing(settings, a.tracing);
    choose_hit(settings, a.tracing.hit);
    settings.bounces = a.bounces;
    settings.gi = a.gi;
    settings.caustics = a.caustics;
    settings.spp = a.spp;
    settings.seed = a.seed;
    settings.clamp = a.clamp;
    settings.repeat = a.repeat;
    settings.rebuild = a.rebuild;
    settings.visibility = a.visibility;
    settings.backdrop = backdrop_of(a);
    settings.exposure = a.exposure;
    settings.tonemap = a.tonemap;
    settings.reflection = a.effects.has(Effect::reflection);
    settings.refraction = a.effects.has(Effect::refraction);
    settings.shadow = a.effects.has(Effect::shadow);
    settings.ambient = a.effects.has(Effect::ambient);
    settings.denoise = a.denoise;
    settings.energy_compensation = !a.no_energy_compensation;
    return settings;
}

}  // namespace peelray
