#include "loaders/gltf_draco.h"

#include <algorithm>
#include <set>

namespace peelray {

namespace {

/// How many triangles a stream may claim: as many as there are corners by the accessors, which is three times what they
/// should be, and no more than its bytes could hold. (The best that Draco does, on flat regular grids, is some hundreds
/// of triangles a byte.)
uint64_t most_triangles(const GltfFile& file, const tinygltf::Primitive& primitive, size_t bytes) {
    const uint64_t corners = primitive.indices >= 0
                                 ? file.accessor(primitive.indices).count
                                 : uint64_t(file.accessor(primitive.attributes.at("POSITION")).count) * 3;
    return std::min({corners, uint64_t(bytes) << 16, uint64_t(1) << 28});
}

}  // namespace

DracoGeometry::DracoGeometry(GltfFile& file, const DracoSource& source, const tinygltf::Primitive& primitive,
                             const std::string& where) {
    const std::string at = where + ".extensions.KHR_draco_mesh_compression";
    const std::span<const uint8_t> stream = file.view(source.view);
    std::set<uint32_t> ids;
    for (const auto& [name, id] : source.attributes)
        if (primitive.attributes.contains(name)) ids.insert(id);
    mesh_ = decode_draco(stream, ids, most_triangles(file, primitive, stream.size()), at);
    for (const auto& [name, id] : source.attributes) {
        const auto accessor = primitive.attributes.find(name);
        if (accessor == primitive.attributes.end()) continue;  // nobody asks for it
        const auto values = mesh_.attributes.find(id);
        if (values == mesh_.attributes.end())
            fail("{}: {} is attribute {} of Draco's data, which has none of that number", at, name, id);
        GltfFile::Accessor info = file.accessor(accessor->second);
        matches_ &= info.count == mesh_.vertices;
        info.where = fmt::format("{}.attributes.{}", at, name);
        info.count = mesh_.vertices;
        info.components = values->second.components;
        info.is_backed = true;
        file.spend(info);
        attributes_[name] = {std::move(info), &values->second};
    }
    if (!has("POSITION")) fail("{}: it has no POSITION", at);
    if (primitive.indices >= 0 && primitive.mode == TINYGLTF_MODE_TRIANGLES)
        matches_ &= file.accessor(primitive.indices).count == mesh_.corners.size();
}

std::vector<float> DracoGeometry::floats(const std::string& attribute) const {
    const auto& [info, from] = attributes_.at(attribute);
    std::vector<float> out = from->values;
    // An encoder may store integers for floats, and floats for integers.
    const bool is_normalized = info.is_float() ? from->is_normalized : info.normalized;
    if (!from->is_integer || !is_normalized) return out;
    const double largest = info.is_float() ? from->largest : info.largest();
    for (float& value : out) value = std::max(static_cast<float>(value / largest), -1.f);
    return out;
}

}  // namespace peelray
