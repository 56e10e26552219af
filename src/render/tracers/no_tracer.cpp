#include "render/tracers/no_tracer.h"

namespace peelray {

BodyTable plain_bodies(Device& device, const Assembly& assembly) {
    std::vector<CubeBody> bodies;
    for (const Assembly::Body& body : assembly.bodies) {
        CubeBody& plain = bodies.emplace_back();
        plain.first_triangle = body.first_triangle;
        plain.triangles = body.triangles;
        plain.lower = body.lower;
        plain.upper = body.upper;
    }
    return {device, std::move(bodies), "scene"};
}

}  // namespace peelray
