// Acceleration structures (VK_KHR_acceleration_structure): what the device's own ray tracing searches.
#pragma once

#include "gpu/buffer.h"

namespace peelray {

/// A structure in a part of a buffer (Buffer::Where::ray_tracing), which must outlive it.
class AccelerationStructure {
  public:
    /// Where one may begin in a buffer.
    static constexpr uint64_t kAlignment = 256;

    AccelerationStructure() = default;
    AccelerationStructure(Device& device, const Buffer& storage, uint64_t offset, uint64_t bytes,
                          VkAccelerationStructureTypeKHR type);
    ~AccelerationStructure() { reset(); }
    AccelerationStructure(AccelerationStructure&& other) noexcept { *this = std::move(other); }
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

    void reset();
    VkAccelerationStructureKHR handle() const { return handle_; }
    const Buffer& storage() const { return *storage_; }
    VkDeviceAddress address() const;
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

    /// What rays that are traced in this one read beside it: the storage of the structures that it shows.
    std::vector<const Buffer*> shown;

  private:
    Device* device_ = nullptr;
    const Buffer* storage_ = nullptr;
    VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
};

/// What a structure is built from: triangles, or instances of other structures.
class StructureSource {
  public:
    /// Triangles [first, first + count) of `triangles` (three uint32 each) with corners in `positions` (three floats
    /// each), of which they use none beyond `last_vertex`. Opaque: hits need not be asked about.
    void add_triangles(const Buffer& positions, const Buffer& triangles, uint32_t first, uint32_t count,
                       uint32_t last_vertex, bool opaque);
    /// `count` of VkAccelerationStructureInstanceKHR; the only part then. `shown`: the storage of their structures.
    void set_instances(const Buffer& instances, uint32_t count, std::vector<const Buffer*> shown);

    VkAccelerationStructureTypeKHR type() const { return type_; }
    /// Without `to`: for asking how large it gets.
    VkAccelerationStructureBuildGeometryInfoKHR info(VkBuildAccelerationStructureFlagsKHR flags) const;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges() const { return ranges_.data(); }
    const std::vector<uint32_t>& counts() const { return counts_; }
    const std::vector<const Buffer*>& inputs() const { return inputs_; }

  private:
    VkAccelerationStructureTypeKHR type_ = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    std::vector<VkAccelerationStructureGeometryKHR> geometries_;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges_;
    std::vector<uint32_t> counts_;
    std::vector<const Buffer*> inputs_;
};

/// Bytes of a structure, and of the scratch memory of its build and its update.
struct StructureSizes {
    uint64_t structure = 0, build = 0, update = 0;
};
StructureSizes sizes_of(Device& device, const StructureSource& source, VkBuildAccelerationStructureFlagsKHR flags);

/// One of several builds that run together.
struct StructureBuild {
    const StructureSource& source;
    const AccelerationStructure& structure;  ///< large enough
    VkBuildAccelerationStructureFlagsKHR flags = 0;
    bool update = false;          ///< its boxes only, in place: what it was built from has moved since
    uint64_t scratch_offset = 0;  ///< of its part of the scratch memory, a multiple of the device's alignment
};

}  // namespace peelray
