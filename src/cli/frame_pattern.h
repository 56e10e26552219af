// File names with a frame's number in them, as printf writes it: "frame_%05d.exr".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace peelray {

/// Has the file's name (not its folder) a place for a number?
bool has_frame_number(const std::filesystem::path& path);

class FramePattern {
  public:
    /// Throws Error unless the file's name holds exactly one %d or %0Nd; %% is a percent sign. The folder is taken as
    /// it is.
    explicit FramePattern(const std::filesystem::path& pattern);

    std::filesystem::path file(uint32_t frame) const;
    /// The frame whose file this is.
    std::optional<uint32_t> frame_of(const std::filesystem::path& file) const;
    /// The pattern as it was given.
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    std::string before_, after_;
    int digits_ = 0;  ///< at least, filled up with zeros
};

}  // namespace peelray
