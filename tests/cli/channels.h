// Auxiliary pictures, channel by channel.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <filesystem>
#include <string>
#include <vector>

namespace peelray {

/// All channels of an auxiliary picture of 64x48 pixels, one behind the other in the order of their names.
inline std::vector<float> channels_of(const std::filesystem::path& path) {
    constexpr size_t width = 64, height = 48;
    Imf::InputFile file(path.c_str());
    std::vector<std::string> names;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) names.push_back(c.name());
    std::vector<float> values(names.size() * width * height);
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < names.size(); i++)
        frame.insert(names[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&values[i * width * height]),
                                          sizeof(float), sizeof(float) * width));
    file.setFrameBuffer(frame);
    file.readPixels(0, int(height) - 1);
    return values;
}

}  // namespace peelray
