#include "loaders/draco_mesh.h"

#include <cstring>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/text.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#pragma GCC diagnostic pop

namespace peelray {

namespace {

class StreamReader {
  public:
    StreamReader(std::span<const uint8_t> stream, const std::string& where) : stream_(stream), where_(where) {}

    DracoMesh read(const std::set<uint32_t>& ids, uint64_t most_triangles) const {
        check_header(most_triangles);
        draco::DecoderBuffer buffer = buffered();
        draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) refuse(decoded.status().error_msg());
        const draco::Mesh& mesh = *decoded.value();
        DracoMesh out;
        out.vertices = mesh.num_points();
        read_corners(mesh, out);
        for (const uint32_t id : ids)
            if (const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id))
                out.attributes[id] = read_attribute(*attribute, out.vertices);
        return out;
    }

    [[noreturn]] void refuse(const std::string& reason) const {
        fail("{}: the {} bytes of Draco's data cannot be decoded: {}; repair the file", where_, stream_.size(),
             reason.empty() ? "they are damaged or cut" : printable(reason, 120));
    }

  private:
    draco::DecoderBuffer buffered() const {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(stream_.data()), stream_.size());
        return buffer;
    }

    // The decoder allocates for as many triangles as the stream claims, so the claim is looked at first.
    void check_header(uint64_t most_triangles) const {
        draco::DecoderBuffer buffer = buffered();
        draco::DracoHeader header;
        if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) refuse("they are no stream of Draco's");
        if (header.encoder_type != draco::TRIANGULAR_MESH) refuse("they hold no mesh of triangles");
        const uint16_t version = DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor);
        if (version != DRACO_BITSTREAM_VERSION(2, 2))
            refuse(fmt::format("their version is {}.{}, the extension's is 2.2", header.version_major,
                               header.version_minor));
        buffer.set_bitstream_version(version);
        draco::GeometryMetadata metadata;
        if (header.flags & METADATA_FLAG_MASK && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
            refuse("their metadata is damaged");
        uint8_t traversal = 0;
        uint32_t vertices = 0, triangles = 0;
        const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
        if (is_edgebreaker && (!buffer.Decode(&traversal) || !draco::DecodeVarint(&vertices, &buffer)))
            refuse("they are cut");
        if (!draco::DecodeVarint(&triangles, &buffer)) refuse("they are cut");
        if (triangles > most_triangles)
            refuse(fmt::format("they claim {} triangles, the primitive's accessors {} at most", triangles,
                               most_triangles));
    }

    void read_corners(const draco::Mesh& mesh, DracoMesh& out) const {
        out.corners.reserve(size_t(mesh.num_faces()) * 3);
        for (uint32_t i = 0; i < mesh.num_faces(); ++i)
            for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
                if (corner.value() >= out.vertices)
                    refuse(fmt::format("triangle {} has vertex {} of {}", i, corner.value(), out.vertices));
                out.corners.push_back(corner.value());
            }
    }

    DracoMesh::Attribute read_attribute(const draco::PointAttribute& from, uint32_t vertices) const {
        switch (from.data_type()) {
            case draco::DT_INT8:
                return read_typed<int8_t>(from, vertices);
            case draco::DT_UINT8:
            case draco::DT_BOOL:
                return read_typed<uint8_t>(from, vertices);
            case draco::DT_INT16:
                return read_typed<int16_t>(from, vertices);
            case draco::DT_UINT16:
                return read_typed<uint16_t>(from, vertices);
            case draco::DT_INT32:
                return read_typed<int32_t>(from, vertices);
            case draco::DT_UINT32:
                return read_typed<uint32_t>(from, vertices);
            case draco::DT_FLOAT32:
                return read_typed<float>(from, vertices);
            default:
                refuse(fmt::format("attribute {} is of type {}, which glTF does not have", from.unique_id(),
                                   static_cast<int>(from.data_type())));
        }
    }

    template <typename T>
    DracoMesh::Attribute read_typed(const draco::PointAttribute& from, uint32_t vertices) const {
        DracoMesh::Attribute out;
        out.components = from.num_components();
        out.is_integer = std::numeric_limits<T>::is_integer;
        out.is_normalized = from.normalized();
        out.largest = static_cast<double>(std::numeric_limits<T>::max());
        const size_t stored = from.buffer() ? from.buffer()->data_size() : 0, size = sizeof(T) * out.components;
        if (!from.is_mapping_identity() && from.indices_map_size() < vertices)
            refuse(fmt::format("attribute {} has fewer values than there are vertices", from.unique_id()));
        out.values.resize(size_t(vertices) * out.components);
        for (uint32_t i = 0; i < vertices; ++i) {
            const int64_t at = from.GetBytePos(from.mapped_index(draco::PointIndex(i)));
            if (at < 0 || uint64_t(at) + size > stored)
                refuse(fmt::format("attribute {} has no value for vertex {}", from.unique_id(), i));
            for (uint32_t c = 0; c < out.components; ++c) {
                T value;
                std::memcpy(&value, from.buffer()->data() + at + c * sizeof(T), sizeof value);
                out.values[size_t(i) * out.components + c] = static_cast<float>(value);
            }
        }
        return out;
    }

    std::span<const uint8_t> stream_;
    const std::string& where_;
};

}  // namespace

DracoMesh decode_draco(std::span<const uint8_t> stream, const std::set<uint32_t>& ids, uint64_t most_triangles,
                       const std::string& where) {
    const StreamReader reader(stream, where);
    try {
        return reader.read(ids, most_triangles);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {  // std::length_error and the like, from damaged counts
        reader.refuse(error.what());
    }
}

}  // namespace peelray
