// Decodes what EXT_meshopt_compression and KHR_meshopt_compression hold, by meshoptimizer.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "loaders/files.h"

namespace peelray {

/// What a compressed buffer view says about its data, unchecked.
struct MeshoptLayout {
    size_t count = 0, stride = 0;  ///< elements, bytes of each
    std::string mode;              ///< ATTRIBUTES, TRIANGLES or INDICES
    std::string filter;            ///< NONE, or of ATTRIBUTES: OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR
};

/// count·stride bytes. Throws Error, prefixed with `where`, for a layout that the extension does not have, and for a
/// stream that is cut, damaged, of another version, or too short for so many elements.
Bytes decode_meshopt(std::span<const uint8_t> stream, const MeshoptLayout& layout, const std::string& where);

}  // namespace peelray
