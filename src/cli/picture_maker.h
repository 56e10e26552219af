// Pictures of one scene by any tracer.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/prepare.h"

namespace peelray {

/// A picture and how it was made.
struct MadePicture {
    Picture picture;
    nlohmann::ordered_json stats;  ///< as the stats file has it
    std::string device;            ///< its name
    std::string summary;           ///< cube and times, for a reader of the terminal; may be empty
};

/// Opens the device when a tracer first needs one and keeps it from picture to picture.
class PictureMaker {
  public:
    /// Both must outlive it.
    PictureMaker(const PreparedScene& scene, const DeviceArguments& device);
    ~PictureMaker();

    /// Throws Error: no device, impossible settings, an interrupt, a validation message.
    MadePicture make(const std::string& tracer, RenderSettings settings);

  private:
    MadePicture make_on_gpu(const RenderSettings& settings);
    MadePicture make_reference(const RenderSettings& settings);

    const PreparedScene& scene_;
    const DeviceArguments& arguments_;
    std::unique_ptr<Device> device_;
};

}  // namespace peelray
