#include "ldc/base_color.h"

#include "ldc/cubes.h"

namespace peelray {

std::vector<Binding> base_color_bindings(const BaseColorBuffers& b) {
    return {{"materials", b.materials}, {"texture_infos", b.texture_infos},
            {"texels", b.texels},       {"uvs", b.uvs},
            {"colors", b.colors},       {"triangle_materials", b.triangle_materials}};
}

std::vector<Binding> alpha_bindings(const TriangleBuffers& triangles) {
    if (triangles.masks) return base_color_bindings(*triangles.masks);
    std::vector<Binding> bindings;
    for (const char* name : {"materials", "texture_infos", "texels", "uvs", "colors", "triangle_materials"})
        bindings.push_back({name, triangles.positions});
    return bindings;
}

}  // namespace peelray
