#include "workspace/automatic_tracer.h"

#include "base/error.h"
#include "gpu/device.h"

namespace peelray {

Tracer automatic_tracer([[maybe_unused]] const DeviceArguments& device) {
#ifdef PEELRAY_WITH_REFERENCE
    try {
        return device_info(device.device).kind == "CPU" ? Tracer::cpu : Tracer::ldc;
    } catch (const Error&) {
        if (!device.device.empty()) throw;
        return Tracer::cpu;
    }
#else
    return Tracer::ldc;
#endif
}

}  // namespace peelray
