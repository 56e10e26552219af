#include "render/tracers/khr_tracer.h"
#include "render/tracers/ldc_tracer.h"
#include "render/tracers/no_tracer.h"

namespace peelray {

std::unique_ptr<RayTracer> make_tracer(const TracerChoice& choice, const TracedWorld& world) {
    switch (choice.tracer) {
        case Tracer::ldc:
            return std::make_unique<LdcTracer>(world, choice);
        case Tracer::khr:
            return std::make_unique<KhrTracer>(world, choice);
        case Tracer::cpu:
        case Tracer::reference:
        case Tracer::cubemap:
        case Tracer::none:
            break;
    }
    return std::make_unique<NoTracer>(world);
}

bool shades_by_maps(const TracerChoice& choice) {
    return choice.tracer == Tracer::cubemap;
}

}  // namespace peelray
