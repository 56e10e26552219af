#include "loaders/meshopt.h"

#include <meshoptimizer.h>

#include <optional>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "loaders/meshopt_attributes.h"

namespace peelray {

namespace {

// The library checks the stream, but leaves the layout to assertions.
void check_layout(const MeshoptLayout& layout, const std::string& where) {
    const auto& [count, stride, mode, filter] = layout;
    const auto refuse = [&](const char* what) {
        fail("{}: {} elements of {} bytes in mode {} with filter {}: {}", where, count, stride, printable(mode, 20),
             printable(filter, 20), what);
    };
    if (mode == "ATTRIBUTES") {
        if (stride == 0 || stride > 256 || stride % 4) refuse("byteStride must be a multiple of 4 up to 256");
        if ((filter == "OCTAHEDRAL" || filter == "COLOR") && stride != 4 && stride != 8)
            refuse("this filter needs a byteStride of 4 or 8");
        if (filter == "QUATERNION" && stride != 8) refuse("this filter needs a byteStride of 8");
        if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" && filter != "EXPONENTIAL" &&
            filter != "COLOR")
            refuse("this filter is not supported; export the scene with another one or without");
    } else if (mode == "TRIANGLES" || mode == "INDICES") {
        if (stride != 2 && stride != 4) refuse("indices have 2 or 4 bytes");
        if (mode == "TRIANGLES" && count % 3) refuse("the number of indices must be a multiple of 3");
        if (filter != "NONE") refuse("indices have no filter");
    } else {
        refuse("the mode must be ATTRIBUTES, TRIANGLES or INDICES");
    }
}

bool is_version_1(std::span<const uint8_t> stream, const MeshoptLayout& layout) {
    return layout.mode == "ATTRIBUTES" && !stream.empty() && stream[0] == 0xA1;
}

/// Nothing is allocated for elements that so few bytes cannot hold: attributes take at least 2 bits for each byte of 16
/// elements, in version 1 for each byte of 256; triangles and single indices take a byte each.
void check_count(std::span<const uint8_t> stream, const MeshoptLayout& layout, const std::string& where) {
    const size_t least = is_version_1(stream, layout)  ? layout.count / 256 * layout.stride / 4
                         : layout.mode == "ATTRIBUTES" ? layout.count / 64 * layout.stride
                         : layout.mode == "TRIANGLES"  ? layout.count / 3
                                                       : layout.count;
    if (least > stream.size())
        fail("{}: {} elements of {} bytes cannot come from {} compressed ones; repair the file", where, layout.count,
             layout.stride, stream.size());
}

void check_version(std::span<const uint8_t> stream, const MeshoptLayout& layout, const std::string& where) {
    const uint8_t kind = layout.mode == "ATTRIBUTES" ? 0xA0 : layout.mode == "TRIANGLES" ? 0xE0 : 0xD0;
    if (stream.empty()) fail("{}: the compressed data is empty", where);
    if ((stream[0] & 0xF0) != kind)
        fail("{}: the compressed data begins with byte {}, which is not that of mode {}; repair the file", where,
             stream[0], layout.mode);
    if (stream[0] > kind + 1)
        fail(
            "{}: compressed with version {} of the format, 1 is the newest that is read; export the scene with "
            "another encoder",
            where, stream[0] & 0x0F);
}

void apply_filter(Bytes& data, const MeshoptLayout& layout) {
    const auto& [count, stride, mode, filter] = layout;
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(data.data(), count, stride);
    if (filter == "COLOR") decode_meshopt_colors(data, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(data.data(), count, stride);
}

}  // namespace

Bytes decode_meshopt(std::span<const uint8_t> stream, const MeshoptLayout& layout, const std::string& where) {
    check_layout(layout, where);
    check_version(stream, layout, where);
    check_count(stream, layout, where);
    const auto& [count, stride, mode, filter] = layout;
    if (is_version_1(stream, layout)) {
        std::optional<Bytes> out = decode_meshopt_attributes_1(stream, count, stride);
        if (!out) fail("{}: the compressed data is damaged or cut; repair the file", where);
        apply_filter(*out, layout);
        return std::move(*out);
    }
    Bytes out(count * stride);
    const int error =
        mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(out.data(), count, stride, stream.data(), stream.size())
        : mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(out.data(), count, stride, stream.data(), stream.size())
                              : meshopt_decodeIndexSequence(out.data(), count, stride, stream.data(), stream.size());
    if (error)
        fail("{}: the compressed data is damaged or cut (meshoptimizer's error {}); repair the file", where, error);
    apply_filter(out, layout);
    return out;
}

}  // namespace peelray
