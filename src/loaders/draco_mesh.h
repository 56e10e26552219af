// Decodes a mesh that KHR_draco_mesh_compression holds, by Google's Draco.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace peelray {

struct DracoMesh {
    struct Attribute {
        uint32_t components = 0;
        bool is_integer = false;     ///< `values` are whole numbers, as stored
        bool is_normalized = false;  ///< integers that the stream itself says stand for [0, 1] or [-1, 1]
        double largest = 1;          ///< integers: the largest of their type
        std::vector<float> values;   ///< `components` per vertex
    };
    uint32_t vertices = 0;
    std::vector<uint32_t> corners;             ///< three per triangle, each below `vertices`
    std::map<uint32_t, Attribute> attributes;  ///< by unique id
};

/// `ids`: of the attributes that are wanted; what the stream does not have is missing. `most_triangles`: more than
/// these are refused before anything is allocated for them. Throws Error, prefixed with `where`, for what is no stream
/// of Draco's version 2.2 with a mesh, for one that is cut or damaged.
DracoMesh decode_draco(std::span<const uint8_t> stream, const std::set<uint32_t>& ids, uint64_t most_triangles,
                       const std::string& where);

}  // namespace peelray
