#include "ldc/base_color.h"

#include "ldc/cubes.h"

namespace peelray {

std::vector<Binding> base_color_bindings(const BaseColorBuffers& b) {
    return {{"materials", b.materials}, {"texture_infos", b.texture_infos},
            {"texels", b.texels},       {"uvs", b.uvs},
            {"colors", b.colors},       {"triangle_materials", b.triangle_materials}};
}

std::vector<Binding> with_alpha_test(std::span<const Binding> bindings, const TriangleBuffers& triangles) {
    std::vector<Binding> all(bindings.begin(), bindings.end());
    if (triangles.masks) {
        const std::vector<Binding> masks = base_color_bindings(*triangles.masks);
        all.insert(all.end(), masks.begin(), masks.end());
        return all;
    }
    for (const char* name : {"materials", "texture_infos", "texels", "uvs", "colors", "triangle_materials"})
        all.push_back({name, triangles.positions});
    return all;
}

}  // namespace peelray
