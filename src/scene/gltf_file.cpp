#include "scene/gltf_file.h"

#include <algorithm>
#include <cstring>

namespace peelray {

namespace {

uint32_t read_u32(std::span<const uint8_t> bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + offset, 4);  // glTF is little-endian, and so is every machine we build for
    return value;
}

uint32_t component_size(uint32_t type) {
    switch (type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

uint32_t component_count(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return 0;
}

template <typename T>
T load(const uint8_t* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

float load_float(const uint8_t* from, uint32_t type, bool normalized) {
    switch (type) {
        case 5120:
            return normalized ? std::max(load<int8_t>(from) / 127.f, -1.f) : load<int8_t>(from);
        case 5121:
            return normalized ? *from / 255.f : *from;
        case 5122:
            return normalized ? std::max(load<int16_t>(from) / 32767.f, -1.f) : load<int16_t>(from);
        case 5123:
            return normalized ? load<uint16_t>(from) / 65535.f : load<uint16_t>(from);
        case 5125:
            return normalized ? static_cast<float>(load<uint32_t>(from) / 4294967295.0)
                              : static_cast<float>(load<uint32_t>(from));
        default:
            return load<float>(from);
    }
}

uint32_t load_index(const uint8_t* from, uint32_t type) {
    return type == 5121 ? *from : type == 5123 ? load<uint16_t>(from) : load<uint32_t>(from);
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path)
    : name_(printable(path.filename().string())), folder_(path.parent_path()) {
    parse(path);
    const std::string version = root().object("asset").text("version", "");
    if (!version.starts_with("2."))
        fail("{}: glTF version \"{}\" is not supported; convert it to glTF 2.0", name_, printable(version, 20));
    buffers_ = root().objects("buffers");
    views_ = root().objects("bufferViews");
    accessors_ = root().objects("accessors");
    images_ = root().objects("images");
    loaded_buffers_.resize(buffers_.size());
    loaded_images_.resize(images_.size());
}

void GltfFile::parse(const std::filesystem::path& path) {
    bytes_ = read_file(path);
    if (bytes_.empty()) fail("{}: the file is empty", name_);
    std::span<const uint8_t> text = bytes_;
    if (text.size() >= 4 && std::memcmp(text.data(), "glTF", 4) == 0) text = split_glb();
    try {
        json_ = nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& error) {
        fail("{}: not a glTF file: {}", name_, printable(error.what(), 200));
    }
    if (!json_.is_object()) fail("{}: not a glTF file: its JSON is {}, must be an object", name_, json_.type_name());
    if (!root().has("asset")) fail("{}: not a glTF file: it has no \"asset\"", name_);
}

std::span<const uint8_t> GltfFile::split_glb() {
    const std::span<const uint8_t> all = bytes_;
    if (all.size() < 20) fail("{}: truncated GLB: {} bytes, the headers need 20", name_, all.size());
    if (read_u32(all, 4) != 2)
        fail("{}: GLB version {} is not supported; convert it to glTF 2.0", name_, read_u32(all, 4));
    const size_t length = read_u32(all, 8);
    if (length > all.size())
        fail("{}: truncated GLB: the header says {} bytes, the file has {}", name_, length, all.size());
    std::span<const uint8_t> json;
    size_t chunks = 0;
    for (size_t at = 12; at + 8 <= length; ++chunks) {
        const size_t size = read_u32(all, at);
        const uint32_t type = read_u32(all, at + 4);
        if (size > length - at - 8)
            fail("{}: truncated GLB: chunk {} says {} bytes, {} are left", name_, chunks, size, length - at - 8);
        const std::span<const uint8_t> chunk = all.subspan(at + 8, size);
        if (chunks == 0) {
            if (type != 0x4E4F534A) fail("{}: the first chunk of the GLB is not JSON", name_);
            json = chunk;
        } else if (type == 0x004E4942 && !glb_chunk_) {
            glb_chunk_ = chunk;
        }
        at += 8 + ((size + 3) & ~size_t(3));
    }
    if (chunks == 0) fail("{}: truncated GLB: no chunk", name_);
    return json;
}

std::span<const uint8_t> GltfFile::buffer(uint32_t index) {
    const JsonView& json = buffers_[index];
    const uint64_t length = json.required_count("byteLength");
    std::span<const uint8_t> data;
    if (!json.has("uri")) {
        if (index != 0 || !glb_chunk_) fail("{}: the buffer has no data: no \"uri\" and no GLB chunk", json.where());
        data = *glb_chunk_;
    } else {
        std::optional<Bytes>& loaded = loaded_buffers_[index];
        const std::string where = json.where() + ".uri";
        if (!loaded) {
            const std::string uri = json.text("uri", "");
            loaded = is_data_uri(uri) ? decode_data_uri(uri, where)
                                      : read_file(resolve_inside(folder_, percent_decode(uri, where), where), where);
        }
        data = *loaded;
    }
    if (data.size() < length)
        fail("{}: the buffer is too short: byteLength is {}, there are {} bytes", json.where(), length, data.size());
    return data.first(length);
}

std::span<const uint8_t> GltfFile::view(uint32_t index) {
    const JsonView& json = views_[index];
    const std::span<const uint8_t> data = buffer(json.required_index("buffer", buffers_.size(), "buffers"));
    const uint64_t offset = json.count("byteOffset", 0), length = json.required_count("byteLength");
    if (offset > data.size() || length > data.size() - offset)
        fail("{}: bytes {} to {} are outside of its buffer of {} bytes", json.where(), offset, offset + length,
             data.size());
    return data.subspan(offset, length);
}

GltfFile::Accessor GltfFile::accessor(uint32_t index) const {
    const JsonView& json = accessors_[index];
    Accessor out;
    out.where = json.where();
    const uint64_t count = json.required_count("count");
    if (count > UINT32_MAX) fail("{}: {} elements are more than 32-bit indices reach", out.where, count);
    out.count = static_cast<uint32_t>(count);
    const std::string type = json.text("type", "");
    out.components = component_count(type);
    if (!out.components) fail("{}: the type \"{}\" is unknown", out.where, printable(type, 20));
    out.component_type = static_cast<uint32_t>(std::min<uint64_t>(json.required_count("componentType"), UINT32_MAX));
    if (!component_size(out.component_type))
        fail("{}: the component type {} is unknown", out.where, out.component_type);
    out.normalized = json.flag("normalized", false);
    return out;
}

GltfFile::Elements GltfFile::elements(const JsonView& json, const Accessor& accessor, uint64_t count,
                                      size_t element_size) {
    const std::optional<uint32_t> index = json.index("bufferView", views_.size(), "buffer views");
    if (!index) return {};
    const std::span<const uint8_t> data = view(*index);
    const uint64_t stride_given = views_[*index].count("byteStride", 0);
    if (stride_given && (stride_given < element_size || stride_given > 252))
        fail("{}: byteStride {} of {} is out of range [{}, 252]", json.where(), stride_given, views_[*index].where(),
             element_size);
    const size_t stride = stride_given ? stride_given : element_size;
    const uint64_t offset = json.count("byteOffset", 0);
    const uint64_t needed = count ? offset + (count - 1) * stride + element_size : 0;
    if (needed > data.size())
        fail("{}: needs {} bytes ({} elements, offset {}, stride {}), its buffer view has {}", accessor.where, needed,
             count, offset, stride, data.size());
    return {data.subspan(std::min<uint64_t>(offset, data.size())), stride};
}

// A small file may name one accessor from thousands of primitives, or claim billions of zeros that no byte backs.
void GltfFile::spend(const Accessor& accessor) {
    constexpr uint64_t limit = uint64_t(1) << 31;
    decoded_ += uint64_t(accessor.count) * accessor.components;
    if (decoded_ > limit)
        fail("{}: the file's accessors hold more than {} numbers in all; split the scene", accessor.where, limit);
}

template <typename Store>
void GltfFile::read(uint32_t index, const Accessor& accessor, Store store) {
    const JsonView& json = accessors_[index];
    const size_t size = component_size(accessor.component_type);
    const Elements from = elements(json, accessor, accessor.count, size * accessor.components);
    if (!from.data.empty())
        for (size_t i = 0; i < accessor.count; ++i) {
            const uint8_t* element = from.data.data() + i * from.stride;
            for (size_t c = 0; c < accessor.components; ++c) store(i * accessor.components + c, element + c * size);
        }
    if (json.has("sparse")) read_sparse(json.object("sparse"), accessor, store);
}

template <typename Store>
void GltfFile::read_sparse(const JsonView& json, const Accessor& accessor, Store store) {
    const uint64_t count = json.required_count("count");
    if (count > accessor.count)
        fail("{}: {} sparse elements, the accessor has {}", json.where(), count, accessor.count);
    const JsonView at = json.object("indices"), values = json.object("values");
    const uint64_t type = at.required_count("componentType");
    if (type != 5121 && type != 5123 && type != 5125)
        fail("{}: component type {} is no unsigned integer", at.where(), type);
    const size_t size = component_size(accessor.component_type),
                 index_size = component_size(static_cast<uint32_t>(type));
    const Elements indices = elements(at, accessor, count, index_size);
    const Elements data = elements(values, accessor, count, size * accessor.components);
    if (count && (indices.data.empty() || data.data.empty()))
        fail("{}: \"bufferView\" of the sparse indices or values is missing", json.where());
    for (uint64_t i = 0; i < count; ++i) {
        const size_t element = load_index(indices.data.data() + i * indices.stride, static_cast<uint32_t>(type));
        if (element >= accessor.count)
            fail("{}: sparse index {} is {}, the accessor has {} elements", json.where(), i, element, accessor.count);
        for (size_t c = 0; c < accessor.components; ++c)
            store(element * accessor.components + c, data.data.data() + i * data.stride + c * size);
    }
}

namespace {

// An accessor without a buffer view is all zeros; nothing in the file bounds its count, so we do.
void check_unbacked(const JsonView& json, const GltfFile::Accessor& accessor) {
    if (!json.has("bufferView") && accessor.count > (1u << 24))
        fail("{}: {} elements without a buffer view; at most {} are read", accessor.where, accessor.count, 1u << 24);
}

}  // namespace

std::vector<float> GltfFile::floats(uint32_t index) {
    const Accessor from = accessor(index);
    check_unbacked(accessors_[index], from);
    elements(accessors_[index], from, from.count,
             size_t(component_size(from.component_type)) * from.components);  // before allocating
    spend(from);
    std::vector<float> out(size_t(from.count) * from.components, 0.f);
    read(index, from,
         [&](size_t i, const uint8_t* data) { out[i] = load_float(data, from.component_type, from.normalized); });
    return out;
}

std::vector<uint32_t> GltfFile::integers(uint32_t index) {
    const Accessor from = accessor(index);
    if (from.components != 1 ||
        (from.component_type != 5121 && from.component_type != 5123 && from.component_type != 5125))
        fail("{}: indices must be SCALAR of unsigned bytes, shorts or ints, not {} components of type {}", from.where,
             from.components, from.component_type);
    check_unbacked(accessors_[index], from);
    elements(accessors_[index], from, from.count, component_size(from.component_type));  // before allocating
    spend(from);
    std::vector<uint32_t> out(from.count, 0);
    read(index, from, [&](size_t i, const uint8_t* data) { out[i] = load_index(data, from.component_type); });
    return out;
}

std::span<const uint8_t> GltfFile::image_bytes(uint32_t index) {
    const JsonView& json = images_[index];
    if (!json.has("uri")) return view(json.required_index("bufferView", views_.size(), "buffer views"));
    std::optional<Bytes>& loaded = loaded_images_[index];
    if (!loaded) {
        const std::string uri = json.text("uri", ""), where = json.where() + ".uri";
        loaded = is_data_uri(uri) ? decode_data_uri(uri, where)
                                  : read_file(resolve_inside(folder_, percent_decode(uri, where), where), where);
    }
    return *loaded;
}

}  // namespace peelray
