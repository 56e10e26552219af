#include "loaders/compressed_files.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <draco/compression/encode.h>
#pragma GCC diagnostic pop

namespace peelray::testing {

namespace {

draco::GeometryAttribute::Type draco_type(const std::string& name) {
    if (name == "POSITION") return draco::GeometryAttribute::POSITION;
    if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
    if (name.starts_with("COLOR")) return draco::GeometryAttribute::COLOR;
    if (name.starts_with("TEXCOORD")) return draco::GeometryAttribute::TEX_COORD;
    return draco::GeometryAttribute::GENERIC;
}

draco::DataType draco_component(int type) {
    static const std::map<int, draco::DataType> types = {{5120, draco::DT_INT8},   {5121, draco::DT_UINT8},
                                                         {5122, draco::DT_INT16},  {5123, draco::DT_UINT16},
                                                         {5125, draco::DT_UINT32}, {5126, draco::DT_FLOAT32}};
    return types.at(type);
}

size_t components_of(const std::string& shape) {
    return shape == "SCALAR" ? 1 : static_cast<size_t>(shape.back() - '0');
}

size_t bytes_of(int type) {
    return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

}  // namespace

Grid::Grid(uint32_t side) {
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const float u = float(x) / float(side - 1), v = float(y) / float(side - 1);
            positions.insert(positions.end(), {u, v, 0.2f * std::sin(7 * u) * std::cos(5 * v)});
            const glm::vec3 n = glm::normalize(
                glm::vec3(-1.4f * std::cos(7 * u) * std::cos(5 * v), std::sin(7 * u) * std::sin(5 * v), 1.f));
            normals.insert(normals.end(), {n.x, n.y, n.z});
            uvs.insert(uvs.end(), {u, v});
        }
    for (uint32_t y = 0; y + 1 < side; ++y)
        for (uint32_t x = 0; x + 1 < side; ++x) {
            const uint32_t a = y * side + x, b = a + 1, c = b + side, d = a + side;
            corners.insert(corners.end(), {a, b, c, a, c, d});
        }
}

size_t DracoWriter::vertices() const {
    const Attribute& first = attributes_.at(0);
    return first.bytes.size() / components_of(first.shape) / bytes_of(first.type);
}

std::string DracoWriter::stream(DracoMethod method) const {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(vertices()));
    draco::Encoder encoder;
    for (size_t i = 0; i < attributes_.size(); ++i) {
        const Attribute& from = attributes_[i];
        const auto components = static_cast<uint8_t>(components_of(from.shape));
        const auto size = static_cast<int64_t>(components * bytes_of(from.type));
        draco::GeometryAttribute attribute;
        attribute.Init(draco_type(from.name), nullptr, components, draco_component(from.type), from.normalized, size,
                       0);
        const int index = mesh.AddAttribute(attribute, true, static_cast<uint32_t>(vertices()));
        mesh.attribute(index)->set_unique_id(from.id(i));
        for (uint32_t v = 0; v < vertices(); ++v)
            mesh.attribute(index)->SetAttributeValue(draco::AttributeValueIndex(v), from.bytes.data() + v * size);
        if (from.bits) encoder.SetAttributeQuantization(draco_type(from.name), from.bits);
    }
    for (size_t i = 0; i + 2 < corners_.size(); i += 3)
        mesh.AddFace(
            {draco::PointIndex(corners_[i]), draco::PointIndex(corners_[i + 1]), draco::PointIndex(corners_[i + 2])});
    encoder.SetEncodingMethod(method == DracoMethod::sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
    // The slowest speed chooses the traversal that codes valences.
    if (method == DracoMethod::valence)
        encoder.SetSpeedOptions(0, 0);
    else
        encoder.SetSpeedOptions(6, 6);
    draco::EncoderBuffer out;
    if (const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &out); !status.ok())
        throw std::runtime_error(status.error_msg_string());
    return {out.data(), out.size()};
}

json DracoWriter::plain() const {
    json gltf = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    json attributes;
    for (const Attribute& from : attributes_)
        attributes[from.name] =
            add_accessor(gltf, from.bytes, from.type, from.shape.c_str(), vertices(), from.normalized);
    const size_t indices = add_accessor(gltf, pack(corners_), 5125, "SCALAR", corners_.size());
    gltf["meshes"] = json::array({{{"primitives", json::array({{{"attributes", attributes}, {"indices", indices}}})}}});
    return gltf;
}

json DracoWriter::file(const std::string& stream) const {
    json gltf = plain();
    for (json& accessor : gltf["accessors"]) accessor.erase("bufferView");
    gltf["buffers"] = json::array({{{"byteLength", stream.size()}, {"uri", data_uri(stream)}}});
    gltf["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", stream.size()}}});
    json ids;
    for (size_t i = 0; i < attributes_.size(); ++i) ids[attributes_[i].name] = attributes_[i].id(i);
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}, {"attributes", ids}};
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return gltf;
}

DracoWriter grid_writer(const Grid& grid, int bits) {
    DracoWriter writer(grid.corners);
    writer.add("POSITION", 5126, "VEC3", grid.positions, false, bits);
    writer.add("NORMAL", 5126, "VEC3", grid.normals, false, bits);
    writer.add("TEXCOORD_0", 5126, "VEC2", grid.uvs, false, bits);
    return writer;
}

std::string meshopt_stream(const std::string& bytes, size_t stride, const std::string& mode) {
    const size_t count = bytes.size() / stride;
    std::vector<unsigned char> out;
    size_t size = 0;
    if (mode == "ATTRIBUTES") {
        out.resize(meshopt_encodeVertexBufferBound(count, stride));
        size = meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride);
    } else {
        std::vector<unsigned> indices(count);
        for (size_t i = 0; i < count; ++i) {
            uint32_t value = 0;
            std::memcpy(&value, bytes.data() + i * stride, stride);
            indices[i] = value;
        }
        const size_t most = mode == "TRIANGLES" ? meshopt_encodeIndexBufferBound(count, UINT32_MAX)
                                                : meshopt_encodeIndexSequenceBound(count, UINT32_MAX);
        out.resize(most);
        size = mode == "TRIANGLES" ? meshopt_encodeIndexBuffer(out.data(), most, indices.data(), count)
                                   : meshopt_encodeIndexSequence(out.data(), most, indices.data(), count);
    }
    return {reinterpret_cast<const char*>(out.data()), size};
}

namespace {

uint32_t zigzag(uint32_t difference, int width) {
    const uint32_t mask = width == 32 ? ~0u : (1u << width) - 1, sign = 1u << (width - 1);
    return (difference & sign ? ~(difference << 1) : difference << 1) & mask;
}

/// What is stored for four bytes of an element, given those of the element before.
uint32_t meshopt_delta(uint32_t value, uint32_t before, uint8_t channel) {
    if (channel & 2) return std::rotl(value ^ before, channel >> 4);
    const int width = channel & 1 ? 16 : 8;
    uint32_t out = 0;
    for (int shift = 0; shift < 32; shift += width) out |= zigzag((value >> shift) - (before >> shift), width) << shift;
    return out;
}

/// Sixteen deltas with `bits` each where that holds them, the others behind.
std::string meshopt_group(const std::string& deltas, int bits) {
    if (bits == 8) return deltas;
    std::string packed(size_t(2 * bits), '\0'), more;
    const int per_byte = bits ? 8 / bits : 1, all = (1 << bits) - 1;
    for (int i = 0; i < 16 && bits; ++i) {
        const int delta = static_cast<uint8_t>(deltas[size_t(i)]), stored = std::min(delta, all), place = i % per_byte;
        packed[size_t(i / per_byte)] |= static_cast<char>(stored << (bits == 1 ? place : 8 - bits * (place + 1)));
        if (stored == all) more += static_cast<char>(delta);
    }
    return packed + more;
}

/// The deltas of one byte position of a block, with the width of each group that takes the least room.
std::string meshopt_groups(std::string deltas, int control) {
    deltas.resize((deltas.size() + 15) / 16 * 16, '\0');
    std::string headers((deltas.size() / 16 + 3) / 4, '\0'), data;
    for (size_t group = 0; group < deltas.size() / 16; ++group) {
        const std::string sixteen = deltas.substr(16 * group, 16);
        int best = -1;
        std::string shortest;
        for (int header = 0; header < 4; ++header) {
            const int step = header + control, bits = step ? 1 << (step - 1) : 0;
            if (bits == 0 && sixteen != std::string(16, '\0')) continue;
            const std::string packed = meshopt_group(sixteen, bits);
            if (best >= 0 && packed.size() >= shortest.size()) continue;
            best = header;
            shortest = packed;
        }
        headers[group / 4] |= static_cast<char>(best << (group % 4 * 2));
        data += shortest;
    }
    return headers + data;
}

}  // namespace

std::string meshopt_stream_1(const std::string& bytes, size_t stride, const std::vector<uint8_t>& channels,
                             const std::vector<int>& controls) {
    const size_t count = bytes.size() / stride, most = std::min<size_t>((8192 / stride) & ~size_t(15), 256);
    std::string before = bytes.substr(0, stride), out = "\xA1";
    for (size_t first = 0; first < count; first += most) {
        const size_t elements = std::min(most, count - first);
        std::vector<std::string> deltas(stride);
        for (size_t i = first; i < first + elements; ++i) {
            const std::string element = bytes.substr(i * stride, stride);
            for (size_t at = 0; at < stride; at += 4) {
                uint32_t value, last;
                std::memcpy(&value, &element[at], 4);
                std::memcpy(&last, &before[at], 4);
                const uint32_t delta = meshopt_delta(value, last, channels[at / 4]);
                for (size_t k = 0; k < 4; ++k) deltas[at + k] += static_cast<char>(delta >> (8 * k));
            }
            before = element;
        }
        std::string header(stride / 4, '\0'), data;
        for (size_t byte = 0; byte < stride; ++byte) {
            const bool is_still = deltas[byte] == std::string(elements, '\0');
            const int control = is_still ? 2 : controls[byte];
            header[byte / 4] |= static_cast<char>(control << (byte % 4 * 2));
            if (control < 2) data += meshopt_groups(deltas[byte], control);
            if (control == 3) data += deltas[byte];
        }
        out += header + data;
    }
    const size_t tail = stride + stride / 4;
    if (tail < 24) out.append(24 - tail, '\0');
    return out + bytes.substr(0, stride) + std::string(channels.begin(), channels.end());
}

std::string meshopt_filtered(const std::vector<float>& values, size_t stride, const std::string& filter, int bits) {
    // Of its encoder later versions of the library have another signature: an exponent and a mantissa of `bits`.
    if (filter == "EXPONENTIAL") {
        std::vector<uint32_t> out;
        for (const float value : values) {
            int exponent = 0;
            std::frexp(value, &exponent);
            exponent -= bits - 1;
            const auto mantissa = static_cast<int32_t>(std::lround(std::ldexp(value, -exponent)));
            out.push_back(static_cast<uint32_t>(exponent) << 24 | (static_cast<uint32_t>(mantissa) & 0xFFFFFF));
        }
        return pack(out);
    }
    std::string out(values.size() / 4 * stride, '\0');
    const auto encode = filter == "OCTAHEDRAL" ? &meshopt_encodeFilterOct : &meshopt_encodeFilterQuat;
    encode(out.data(), values.size() / 4, stride, bits, values.data());
    return out;
}

void compress_view(json& gltf, size_t accessor, const std::string& bytes, size_t stride, const char* mode,
                   const char* filter) {
    const std::string stream = meshopt_stream(bytes, stride, mode);
    json& view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"].get<size_t>()];
    const auto fallback = view["buffer"].get<size_t>();
    gltf["buffers"][fallback] = {{"byteLength", bytes.size()},
                                 {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
    gltf["buffers"].push_back({{"byteLength", stream.size()}, {"uri", data_uri(stream)}});
    view["byteLength"] = bytes.size();
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", gltf["buffers"].size() - 1},
                                                     {"byteLength", stream.size()},
                                                     {"byteStride", stride},
                                                     {"count", bytes.size() / stride},
                                                     {"mode", mode},
                                                     {"filter", filter}};
    if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
}

}  // namespace peelray::testing
