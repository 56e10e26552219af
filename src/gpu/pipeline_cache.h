// The pipeline cache on disk: compiled shaders survive the program.
#pragma once

#include <filesystem>
#include <vector>

#include "gpu/device.h"

namespace peelray {

/// Loads $XDG_CACHE_HOME/peelray/pipelines-VENDOR-DEVICE-UUID.bin (~/.cache without the variable) when made and saves
/// it when destroyed. A missing, truncated, corrupt or foreign file is ignored; a folder that cannot be written to is
/// not an error: the next start just compiles again.
class PipelineCache {
  public:
    PipelineCache(Device& device, bool on_disk);
    ~PipelineCache();
    VkPipelineCache handle() const { return cache_; }

    /// Wraps the driver's data with a checksum, so that a torn or damaged file never reaches the driver.
    static std::vector<char> seal(const std::vector<char>& data);
    /// The driver's data, or empty if `file` is not what seal() made.
    static std::vector<char> unseal(const std::vector<char>& file);
    /// Where the file lies; empty if neither XDG_CACHE_HOME nor HOME is set.
    static std::filesystem::path file_for(const VkPhysicalDeviceProperties& properties);

  private:
    Device& device_;
    std::filesystem::path file_;
    std::vector<char> loaded_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
};

}  // namespace peelray
