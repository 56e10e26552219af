#include "ldc/base_color.h"

#include "ldc/triangle_buffers.h"

namespace peelray {

std::vector<Binding> base_color_bindings(const BaseColorBuffers& b) {
    return {{"materials", b.materials},
            {"texture_infos", b.texture_infos},
            Binding::if_used("texels", b.texels),
            {"uvs", b.uvs},
            {"colors", b.colors},
            {"triangle_materials", b.triangle_materials}};
}

std::vector<Binding> with_hit_materials(std::span<const Binding> bindings, const TriangleBuffers& triangles) {
    std::vector<Binding> all(bindings.begin(), bindings.end());
    const BaseColorBuffers none, *read = triangles.masks ? triangles.masks : triangles.sides;
    for (const Binding& binding : if_used(base_color_bindings(read ? *read : none))) all.push_back(binding);
    return all;
}

}  // namespace peelray
