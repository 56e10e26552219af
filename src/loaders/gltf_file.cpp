#include "loaders/gltf_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include "base/text.h"
#include "loaders/gltf_check.h"
#include "loaders/gltf_image_light.h"

namespace peelray {

namespace {

using nlohmann::json;

constexpr uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

template <typename T>
T load_as(const uint8_t* from) {
    T value;
    std::memcpy(&value, from, sizeof value);  // glTF is little-endian, and so is every machine we build for
    return value;
}

float load_float(const uint8_t* from, uint32_t type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(load_as<int8_t>(from) / 127.f, -1.f) : load_as<int8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? *from / 255.f : *from;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(load_as<int16_t>(from) / 32767.f, -1.f) : load_as<int16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalized ? load_as<uint16_t>(from) / 65535.f : load_as<uint16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return normalized ? static_cast<float>(load_as<uint32_t>(from) / 4294967295.0)
                              : static_cast<float>(load_as<uint32_t>(from));
        default:
            return load_as<float>(from);
    }
}

bool is_index_type(uint32_t type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

uint32_t load_index(const uint8_t* from, uint32_t type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? *from
           : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? load_as<uint16_t>(from)
                                                            : load_as<uint32_t>(from);
}

/// What stands for a camera of an unknown type, which is legal: one that shows nothing, see NodeReader::add_camera().
json no_camera() {
    return {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 1}}}};
}

void append_u32(Bytes& bytes, size_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
}

void append_chunk(Bytes& glb, uint32_t type, std::span<const uint8_t> bytes, uint8_t filler) {
    const size_t padded = (bytes.size() + 3) & ~size_t(3);
    append_u32(glb, padded);
    append_u32(glb, type);
    glb.insert(glb.end(), bytes.begin(), bytes.end());
    glb.insert(glb.end(), padded - bytes.size(), filler);
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path)
    : name_(printable(path.filename().string())), folder_(path.parent_path()), files_{path} {
    const Bytes bytes = read_file(path);
    if (bytes.empty()) fail("{}: the file is empty", name_);
    const bool is_glb = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    const Glb glb = is_glb ? split_glb(bytes) : Glb{bytes, {}};
    json checked;
    std::optional<GltfExtensions::ImageLight> image_light;
    try {
        const json root = json::parse(glb.json.begin(), glb.json.end());
        checked = check_gltf(root, name_, ignored_);
        image_light = image_light_of(root, name_);
    } catch (const json::exception& error) {
        fail("{}: not a glTF file: {}", name_, printable(error.what(), 200));
    }
    for (const json& node : checked["nodes"])
        if (node.contains("matrix") &&
            (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
            ++ignored_["{} node{|s} with a matrix and a placement by parts: the matrix counts (NODE_MATRIX_TRS)"];
    extensions_ = take_extensions(checked, ignored_);
    extensions_.image_light = std::move(image_light);
    hide_unknown_types(checked);
    take_uris(checked, is_glb ? std::optional(glb.binary.size()) : std::nullopt);
    load(checked.dump(), is_glb ? &glb : nullptr);
}

// tinygltf splits the container again, but only after we have looked: its own check of the binary chunk is 8 bytes off,
// and the JSON has to be checked first.
GltfFile::Glb GltfFile::split_glb(std::span<const uint8_t> all) {
    if (all.size() < 20) fail("{}: truncated GLB: {}, the headers need 20", name_, counted("{} byte{|s}", all.size()));
    const auto u32 = [&](size_t offset) { return load_as<uint32_t>(all.data() + offset); };
    if (u32(4) != 2) fail("{}: GLB version {} is not supported; convert it to glTF 2.0", name_, u32(4));
    const size_t length = u32(8);
    if (length > all.size())
        fail("{}: truncated GLB: the header says {} bytes, the file has {}", name_, length, all.size());
    Glb glb;
    size_t chunks = 0, at = 12;
    for (; at + 8 <= length; ++chunks) {
        const size_t size = u32(at), type = u32(at + 4);
        if (size > length - at - 8)
            fail("{}: truncated GLB: chunk {} says {} bytes, {} are left", name_, chunks, size, length - at - 8);
        const std::span<const uint8_t> chunk = all.subspan(at + 8, size);
        if (chunks == 0 && type != json_chunk) fail("{}: the first chunk of the GLB is not JSON", name_);
        if (chunks == 0)
            glb.json = chunk;
        else if (type == binary_chunk && glb.binary.empty())
            glb.binary = chunk;
        else if (type == binary_chunk || type == json_chunk)
            ++ignored_["{} chunk{|s} of the GLB beyond the first of their kind ignored (GLB_DUPLICATE_CHUNK)"];
        if (type == binary_chunk && chunks > 1 && glb.binary.data() == chunk.data())
            ++ignored_["{} binary chunk{|s} that {is|are} not the second of the GLB used (GLB_UNEXPECTED_BIN_CHUNK)"];
        at += 8 + ((size + 3) & ~size_t(3));
    }
    if (chunks == 0) fail("{}: truncated GLB: no chunk", name_);
    if (at < length)
        ++ignored_["{} GLB ends amid a chunk's header, which is ignored (GLB_UNEXPECTED_END_OF_CHUNK_HEADER)"];
    return glb;
}

// A later version's types are legal as long as nothing that is read uses them; tinygltf refuses them everywhere.
void GltfFile::hide_unknown_types(json& checked) {
    static const std::set<std::string> types = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    static const std::set<size_t> components = {5120, 5121, 5122, 5123, 5125, 5126};
    size_t i = 0;
    for (json& accessor : checked["accessors"]) {
        const std::string type = accessor["type"].get<std::string>();
        const auto component = accessor["componentType"].get<size_t>();
        if (!types.contains(type)) foreign_accessors_[i] = fmt::format("the type \"{}\"", printable(type, 20));
        if (!components.contains(component)) foreign_accessors_[i] = fmt::format("the component type {}", component);
        if (foreign_accessors_.contains(i)) accessor["type"] = "SCALAR", accessor["componentType"] = 5121;
        ++i;
    }
    for (json& camera : checked["cameras"])
        if (camera["type"] != "perspective" && camera["type"] != "orthographic") camera = no_camera();
}

// tinygltf undoes %XX wrongly, knows few kinds of data URIs, and wants buffers of exactly byteLength bytes. So it sees
// the buffer's number instead of the URI, and asks our reader for that. Of images it sees a name that is not a file: it
// would read all of them, and take those of buffer views without looking at the ranges.
void GltfFile::take_uris(json& checked, std::optional<size_t> glb_bytes) {
    for (json& buffer : checked["buffers"]) {
        const std::string at = where("buffers", buffer_sources_.size());
        BufferSource source{"", buffer["byteLength"].get<size_t>()};
        if (source.length == 0) fail("{}: byteLength is 0, a buffer has at least one byte", at);
        const bool is_fallback = extensions_.fallback_buffers[buffer_sources_.size()];
        const bool is_chunk = !buffer.contains("uri") && buffer_sources_.empty() && glb_bytes;
        if (buffer.contains("uri")) {
            source.uri = std::move(buffer["uri"].get_ref<std::string&>());
            source.has_data = !is_fallback;
        } else if (!is_chunk || (is_fallback && *glb_bytes < source.length)) {
            source.has_data = false;  // legal where nothing reads it, see bytes_of()
        } else if (*glb_bytes < source.length) {
            fail("{}: the buffer is too short: byteLength is {}, {}", at, source.length,
                 counted("there {is|are} {} byte{|s}", *glb_bytes));
        }
        if (!is_chunk || !source.has_data) buffer["uri"] = std::to_string(buffer_sources_.size());
        if (!source.has_data) buffer["byteLength"] = 1;  // tinygltf insists on bytes
        buffer_sources_.push_back(std::move(source));
    }
    for (json& image : checked["images"]) {
        ImageSource& source = image_sources_.emplace_back();
        if (image.contains("uri"))
            source.uri = std::move(image["uri"].get_ref<std::string&>());
        else if (image.contains("bufferView"))
            source.view = image["bufferView"].get<int>();
        image.erase("bufferView");
        image["uri"] = "image";
    }
    loaded_images_.resize(image_sources_.size());
}

void GltfFile::load(const std::string& text, const Glb* glb) {
    tinygltf::TinyGLTF loader;
    // Error passes through tinygltf, which holds nothing that does not clean up after itself.
    loader.SetFsCallbacks(
        {[](const std::string& name, void*) { return std::isdigit(static_cast<unsigned char>(name[0])) != 0; },
         [](const std::string& name, void*) { return name; },
         [](Bytes* out, std::string*, const std::string& name, void* self) {
             *out = static_cast<GltfFile*>(self)->read_buffer(std::stoul(name));
             return true;
         },
         nullptr, this});
    // No image reaches it, see take_uris(); without it tinygltf would decode with its own copy of stb_image.
    loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                             void*) { return true; },
                          nullptr);
    Bytes bytes;
    if (glb) {
        bytes = {'g', 'l', 'T', 'F', 2, 0, 0, 0, 0, 0, 0, 0};
        bytes.reserve(12 + 8 + text.size() + 3 + 8 + glb->binary.size() + 3);
        append_chunk(bytes, json_chunk, {reinterpret_cast<const uint8_t*>(text.data()), text.size()}, ' ');
        if (!glb->binary.empty()) append_chunk(bytes, binary_chunk, glb->binary, 0);
        const auto size = static_cast<uint32_t>(bytes.size());
        std::memcpy(bytes.data() + 8, &size, 4);
    }
    if (std::max(bytes.size(), text.size()) > UINT32_MAX) fail("{}: larger than 4 GiB; split the scene", name_);
    std::string errors, warnings;
    const bool is_loaded = glb ? loader.LoadBinaryFromMemory(&model_, &errors, &warnings, bytes.data(),
                                                             static_cast<uint32_t>(bytes.size()))
                               : loader.LoadASCIIFromString(&model_, &errors, &warnings, text.data(),
                                                            static_cast<uint32_t>(text.size()), "");
    if (!is_loaded) fail("{}: not a valid glTF file: {}", name_, printable(errors, 300));
}

Bytes GltfFile::read_uri(const std::string& uri, const std::string& where) {
    if (is_data_uri(uri)) return decode_data_uri(uri, where);
    const std::filesystem::path path = resolve_inside(folder_, percent_decode(uri, where), where);
    Bytes bytes = read_file(path, where);
    remember_file(files_, path);
    return bytes;
}

/// Exactly byteLength bytes: a file may be longer, tinygltf insists.
Bytes GltfFile::read_buffer(size_t index) {
    const auto& [uri, length, has_data] = buffer_sources_.at(index);
    if (!has_data) return Bytes(1);
    Bytes bytes = read_uri(uri, where("buffers", index) + ".uri");
    if (bytes.size() < length)
        fail("{}: the buffer is too short: byteLength is {}, {}", where("buffers", index), length,
             counted("there {is|are} {} byte{|s}", bytes.size()));
    bytes.resize(length);
    return bytes;
}

/// Whether a buffer has bytes. Those of a fallback are read when they are first asked for.
bool GltfFile::has_data(size_t buffer) {
    BufferSource& source = buffer_sources_[buffer];
    if (source.has_data) return true;
    if (source.uri.empty()) return false;
    source.has_data = true;
    model_.buffers[buffer].data = read_buffer(buffer);
    return true;
}

std::span<const uint8_t> GltfFile::bytes_of(const std::string& at, size_t buffer, uint64_t offset, uint64_t length) {
    if (!has_data(buffer))
        fail("{}: the buffer has no data: no \"uri\" and no GLB chunk; export the scene uncompressed",
             where("buffers", buffer));
    const std::span<const uint8_t> data = model_.buffers[buffer].data;
    if (offset > data.size() || length > data.size() - offset)
        fail("{}: bytes {} to {} are outside of its buffer of {} bytes", at, offset, offset + length, data.size());
    return data.subspan(offset, length);
}

std::span<const uint8_t> GltfFile::view(int index) {
    const auto i = static_cast<size_t>(index);
    const tinygltf::BufferView& view = model_.bufferViews[i];
    const auto buffer = static_cast<size_t>(view.buffer);
    std::optional<GltfExtensions::CompressedView>& compressed = extensions_.compressed_views[i];
    if (compressed && !decompressed_.contains(i)) {
        try {
            decompressed_[i] = decompress(i, *compressed);
        } catch (const Error&) {
            if (!has_data(buffer)) throw;
            compressed.reset();
            ++ignored_
                ["{} compressed buffer view{|s} that cannot be decoded read from {its|their} uncompressed fallback"];
        }
    }
    if (compressed) return decompressed_[i];
    return bytes_of(where("bufferViews", i), buffer, view.byteOffset, view.byteLength);
}

Bytes GltfFile::decompress(size_t view, const GltfExtensions::CompressedView& from) {
    const std::string at = where("bufferViews", view) + ".extensions";
    Bytes out = decode_meshopt(bytes_of(at, from.buffer, from.offset, from.length), from.layout, at);
    const size_t length = model_.bufferViews[view].byteLength;
    if (out.size() != length)
        fail("{}: {} elements of {} bytes are not the {} bytes of the buffer view", at, from.layout.count,
             from.layout.stride, length);
    return out;
}

double GltfFile::Accessor::largest() const {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return INT8_MAX;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return UINT8_MAX;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return INT16_MAX;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return UINT16_MAX;
        default:
            return UINT32_MAX;
    }
}

GltfFile::Accessor GltfFile::accessor(int index) const {
    const tinygltf::Accessor& from = model_.accessors[static_cast<size_t>(index)];
    Accessor out;
    out.where = where("accessors", static_cast<size_t>(index));
    if (from.count > UINT32_MAX) fail("{}: {} elements are more than 32-bit indices reach", out.where, from.count);
    out.count = static_cast<uint32_t>(from.count);
    out.components = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type)));
    out.component_type = static_cast<uint32_t>(from.componentType);
    out.normalized = from.normalized;
    out.is_backed = size_t(from.bufferView) + 1 < model_.bufferViews.size() || from.sparse.isSparse;  // see check_gltf
    if (const auto foreign = foreign_accessors_.find(static_cast<size_t>(index)); foreign != foreign_accessors_.end())
        fail("{}: {} is unknown", out.where, foreign->second);
    return out;
}

GltfFile::Elements GltfFile::elements(const std::string& where, int view_index, uint64_t offset, uint64_t count,
                                      size_t element_size) {
    if (static_cast<size_t>(view_index) + 1 >= model_.bufferViews.size()) return {};  // see check_gltf: without bytes
    const std::span<const uint8_t> data = view(view_index);
    const size_t stride_given = model_.bufferViews[static_cast<size_t>(view_index)].byteStride;
    if (stride_given && stride_given < element_size)
        fail("{}: byteStride {} of bufferViews[{}] is below {}", where, stride_given, view_index, element_size);
    const size_t stride = stride_given ? stride_given : element_size;
    const uint64_t needed = count ? offset + (count - 1) * stride + element_size : 0;
    if (needed > data.size())
        fail("{}: needs {} bytes ({} elements, offset {}, stride {}), its buffer view has {}", where, needed, count,
             offset, stride, data.size());
    return {data.subspan(std::min<uint64_t>(offset, data.size())), stride};
}

// A small file may name one accessor from thousands of primitives, or claim billions of zeros that no byte backs.
void GltfFile::spend(const Accessor& accessor) {
    constexpr uint64_t limit = uint64_t(1) << 31;
    decoded_ += uint64_t(accessor.count) * accessor.components;
    if (decoded_ > limit)
        fail("{}: the file's accessors hold more than {} numbers in all; split the scene", accessor.where, limit);
}

template <typename T, typename Load>
std::vector<T> GltfFile::read(const tinygltf::Accessor& from, const Accessor& accessor, Load load) {
    const auto size = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(accessor.component_type));
    const size_t components = accessor.components;
    const auto copy = [&](std::vector<T>& out, size_t element, const uint8_t* data) {
        for (size_t c = 0; c < components; ++c) out[element * components + c] = load(data + c * size);
    };
    const Elements base = elements(accessor.where, from.bufferView, from.byteOffset, accessor.count, size * components);
    // Nothing in the file bounds the count of an accessor without a buffer view, so we do.
    if (base.stride == 0 && accessor.count > (1u << 24))
        fail("{}: {} elements without a buffer view; at most {} are read", accessor.where, accessor.count, 1u << 24);
    spend(accessor);
    std::vector<T> out(accessor.count * components, T(0));
    if (!base.data.empty())
        for (size_t i = 0; i < accessor.count; ++i) copy(out, i, base.data.data() + i * base.stride);
    if (!from.sparse.isSparse) return out;

    const auto& sparse = from.sparse;
    const auto count = static_cast<uint64_t>(sparse.count), type = static_cast<uint64_t>(sparse.indices.componentType);
    const std::string where = accessor.where + ".sparse";
    if (count > accessor.count) fail("{}: {} sparse elements, the accessor has {}", where, count, accessor.count);
    if (!is_index_type(static_cast<uint32_t>(type))) fail("{}: component type {} is no unsigned integer", where, type);
    const Elements indices =
        elements(where, sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset), count,
                 static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type))));
    const Elements values = elements(where, sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset),
                                     count, size * components);
    for (uint64_t i = 0; i < count; ++i) {
        const size_t element = load_index(indices.data.data() + i * indices.stride, static_cast<uint32_t>(type));
        if (element >= accessor.count)
            fail("{}: sparse index {} is {}, the accessor has {} elements", where, i, element, accessor.count);
        copy(out, element, values.data.data() + i * values.stride);
    }
    return out;
}

std::vector<float> GltfFile::floats(int index) {
    const Accessor info = accessor(index);
    const tinygltf::Accessor& from = model_.accessors[static_cast<size_t>(index)];
    return read<float>(from, info,
                       [&](const uint8_t* data) { return load_float(data, info.component_type, from.normalized); });
}

std::vector<uint32_t> GltfFile::integers(int index) {
    const Accessor info = accessor(index);
    if (info.components != 1 || !is_index_type(info.component_type))
        fail("{}: indices must be SCALAR of unsigned bytes, shorts or ints, not {} components of type {}", info.where,
             info.components, info.component_type);
    return read<uint32_t>(model_.accessors[static_cast<size_t>(index)], info,
                          [&](const uint8_t* data) { return load_index(data, info.component_type); });
}

std::span<const uint8_t> GltfFile::image_bytes(int index) {
    const auto i = static_cast<size_t>(index);
    const ImageSource& source = image_sources_[i];
    if (!source.uri && source.view < 0)
        fail("{}: the image has neither \"uri\" nor \"bufferView\"", where("images", i));
    if (!source.uri) return view(source.view);
    if (!loaded_images_[i]) loaded_images_[i] = read_uri(*source.uri, where("images", i) + ".uri");
    return *loaded_images_[i];
}

bool GltfFile::is_image_missing(int index) const {
    const std::string file = image_file(index), at = where("images", static_cast<size_t>(index)) + ".uri";
    std::error_code error;
    return !file.empty() && !std::filesystem::exists(resolve_inside(folder_, percent_decode(file, at), at), error);
}

std::string GltfFile::image_file(int index) const {
    const std::optional<std::string>& uri = image_sources_[static_cast<size_t>(index)].uri;
    return uri && !is_data_uri(*uri) ? *uri : "";
}

}  // namespace peelray
