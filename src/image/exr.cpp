// OpenEXR: files of any writer in.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/error.h"
#include "image/codecs.h"
#include "image/exr_errors.h"

namespace peelray {
namespace {

class MemoryIn : public Imf::IStream {
  public:
    explicit MemoryIn(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}

    bool read(char out[], int count) override {
        if (count < 0 || position_ > bytes_.size() || uint64_t(count) > bytes_.size() - position_)
            throw std::runtime_error("unexpected end of the file");
        std::memcpy(out, bytes_.data() + position_, size_t(count));
        position_ += uint64_t(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::string_view bytes_;
    uint64_t position_ = 0;
};

/// Which channel of the file becomes red, green, blue and alpha; "" : none.
struct Selection {
    std::array<std::string, 4> names;
    bool luminance_chroma = false;
};

bool has(const Imf::ChannelList& channels, const std::string& name) {
    return channels.findChannel(name) != nullptr;
}

Selection select(const std::filesystem::path& path, const Imf::ChannelList& channels) {
    std::vector<std::string> colors;
    std::string all;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        if (it.name() != std::string_view("A")) colors.emplace_back(it.name());
        all += (all.empty() ? "" : ", ") + std::string(it.name());
    }
    const std::string alpha = has(channels, "A") ? "A" : "";
    if (has(channels, "X") && has(channels, "Y") && has(channels, "Z") && !has(channels, "R"))
        fail("cannot read {}: its channels ({}) are CIE X, Y, Z; save it with R, G, B", path.string(), all);
    if (colors.size() == 1) return {{colors[0], colors[0], colors[0], alpha}, false};
    if (has(channels, "R") && has(channels, "G") && has(channels, "B")) return {{"R", "G", "B", alpha}, false};
    if (has(channels, "Y") && has(channels, "RY") && has(channels, "BY")) return {{}, true};
    if (has(channels, "Y")) return {{"Y", "Y", "Y", alpha}, false};
    for (const std::string& name : colors) {  // a layer of its own, such as "beauty.R"
        if (!name.ends_with(".R")) continue;
        const std::string layer = name.substr(0, name.size() - 1);
        if (has(channels, layer + "G") && has(channels, layer + "B"))
            return {{name, layer + "G", layer + "B", has(channels, layer + "A") ? layer + "A" : ""}, false};
    }
    fail("cannot read {}: no colour among its channels ({}); save it with R, G, B or Y", path.string(), all);
}

Image read_luminance_chroma(std::string_view bytes, const Imath::Box2i& window, Image image) {
    MemoryIn stream(bytes);
    Imf::RgbaInputFile file(stream);
    std::vector<Imf::Rgba> row(image.width);
    for (int y = window.min.y; y <= window.max.y; ++y) {
        // Stride 0 in y and a base that cancels the window's offset: each row lands in `row`. The address is never
        // formed outside of OpenEXR, hence the integer.
        const auto base = reinterpret_cast<intptr_t>(row.data()) - intptr_t(window.min.x) * intptr_t(sizeof(Imf::Rgba));
        file.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(base), 1, 0);
        file.readPixels(y);
        for (uint32_t x = 0; x < image.width; ++x)
            image.at(x, uint32_t(y - window.min.y)) = {row[x].r, row[x].g, row[x].b, row[x].a};
    }
    return image;
}

Image read_channels(Imf::InputPart& part, const Imath::Box2i& window, const Selection& selection, Image image) {
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 4; ++c) {
        if (selection.names[size_t(c)].empty()) continue;
        if (c > 0 && c < 3 && selection.names[size_t(c)] == selection.names[0]) continue;
        buffer.insert(selection.names[size_t(c)], Imf::Slice::Make(Imf::FLOAT, &image.pixels[0][c], window,
                                                                   sizeof(glm::vec4), sizeof(glm::vec4) * image.width));
    }
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
    if (selection.names[1] == selection.names[0])
        for (glm::vec4& pixel : image.pixels) pixel.y = pixel.z = pixel.x;
    return image;
}

/// What the display window shows of the data: pixels outside of the data are black, as transparent as the file can say.
Image crop_to_display(const std::filesystem::path& path, const Imath::Box2i& data, const Imath::Box2i& display,
                      Image from, bool has_alpha) {
    if (data == display) return from;
    check_size("read", path, int64_t(display.max.x) - display.min.x + 1, int64_t(display.max.y) - display.min.y + 1);
    const int left = std::max(data.min.x, display.min.x), right = std::min(data.max.x, display.max.x),
              top = std::max(data.min.y, display.min.y), bottom = std::min(data.max.y, display.max.y);
    if (left > right || top > bottom)
        fail("cannot read {}: its data lies outside of its display window; save it with the window of the data",
             path.string());
    Image out{uint32_t(display.max.x - display.min.x + 1), uint32_t(display.max.y - display.min.y + 1), {}};
    out.pixels.assign(size_t(out.width) * out.height, glm::vec4(0, 0, 0, has_alpha ? 0 : 1));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
            out.at(uint32_t(x - display.min.x), uint32_t(y - display.min.y)) =
                from.at(uint32_t(x - data.min.x), uint32_t(y - data.min.y));
    return out;
}

/// From a file's primaries to CIE X, Y, Z: white, (1, 1, 1), is of luminance 1.
glm::dmat3 primaries_to_xyz(const Imf::Chromaticities& c) {
    const auto xyz = [](const Imath::V2f& xy) { return glm::dvec3(xy.x, xy.y, 1 - xy.x - xy.y) / double(xy.y); };
    const glm::dmat3 primaries(xyz(c.red), xyz(c.green), xyz(c.blue));
    const glm::dvec3 amounts = glm::inverse(primaries) * xyz(c.white);
    return {primaries[0] * amounts.x, primaries[1] * amounts.y, primaries[2] * amounts.z};
}

/// From a file's primaries to Rec. 709's. White stays white: colours are adapted as the eye is (Lindbloom, "Chromatic
/// Adaptation", Bradford's matrix).
glm::dmat3 primaries_to_rec709(const Imf::Chromaticities& from) {
    const Imf::Chromaticities rec709;
    const glm::dmat3 cones =
        glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
    const glm::dmat3 file = primaries_to_xyz(from), ours = primaries_to_xyz(rec709);
    const glm::dvec3 gains = (cones * (ours * glm::dvec3(1))) / (cones * (file * glm::dvec3(1)));
    const glm::dmat3 scale(gains.x, 0, 0, 0, gains.y, 0, 0, 0, gains.z);
    return glm::inverse(ours) * glm::inverse(cones) * scale * cones * file;
}

/// Pixels in the primaries of Rec. 709, where the file has others. Those on one line make no colours: `note` says so.
void convert_primaries(const std::filesystem::path& path, const Imf::Header& header, Image& image, std::string& note) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities from = Imf::chromaticities(header), rec709;
    const auto near = [](const Imath::V2f& a, const Imath::V2f& b) { return (a - b).length() < 1e-3f; };
    if (near(from.red, rec709.red) && near(from.green, rec709.green) && near(from.blue, rec709.blue) &&
        near(from.white, rec709.white))
        return;
    const glm::dmat3 matrix = primaries_to_rec709(from);
    bool spans = true;
    for (int i = 0; i < 9; i++) spans &= std::abs(matrix[i / 3][i % 3]) < 1e3;  // false for NaN
    if (!spans) {
        note = fmt::format("{}: its primaries (\"chromaticities\") span no colours: it is read as Rec. 709",
                           path.filename().string());
        return;
    }
    for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(glm::vec3(matrix * glm::dvec3(pixel)), pixel.w);
}

Image decode(const std::filesystem::path& path, std::string_view bytes, std::string& note) {
    // A limit of the library, for the process: it guards what OpenEXR itself allocates while it reads headers.
    Imf::Header::setMaxImageSize(int(max_side), int(max_side));
    Imf::Header::setMaxTileSize(int(max_side), int(max_side));
    MemoryIn stream(bytes);
    Imf::MultiPartInputFile file(stream);
    int number = 0;
    while (number < file.parts() && file.header(number).hasType() && Imf::isDeepData(file.header(number).type()))
        ++number;
    if (number == file.parts()) fail("cannot read {}: it holds deep data only; flatten it first", path.string());
    Imf::InputPart part(file, number);
    const Imf::ChannelList& channels = part.header().channels();
    const Imath::Box2i window = part.header().dataWindow();
    check_size("read", path, int64_t(window.max.x) - window.min.x + 1, int64_t(window.max.y) - window.min.y + 1);
    const Selection selection = select(path, channels);
    for (const std::string& name : selection.names) {
        const Imf::Channel* channel = name.empty() ? nullptr : channels.findChannel(name);
        if (channel && (channel->xSampling != 1 || channel->ySampling != 1))
            fail("cannot read {}: its channel {} is subsampled; save it at full resolution", path.string(), name);
    }
    if (selection.luminance_chroma && number != 0)
        fail("cannot read {}: luminance and chroma in a later part; save it with R, G, B", path.string());
    Image image{uint32_t(window.max.x - window.min.x + 1), uint32_t(window.max.y - window.min.y + 1), {}};
    image.pixels.assign(size_t(image.width) * image.height, glm::vec4(0, 0, 0, 1));
    image = selection.luminance_chroma ? read_luminance_chroma(bytes, window, std::move(image))
                                       : read_channels(part, window, selection, std::move(image));
    const bool is_grey = !selection.luminance_chroma && selection.names[1] == selection.names[0];
    if (!is_grey) convert_primaries(path, part.header(), image, note);
    const bool has_alpha = selection.luminance_chroma ? has(channels, "A") : !selection.names[3].empty();
    return crop_to_display(path, window, part.header().displayWindow(), std::move(image), has_alpha);
}

}  // namespace

Image decode_exr(const std::filesystem::path& path, std::string_view bytes, std::string& note) {
    return guarded("read", path, [&] { return decode(path, bytes, note); });
}

}  // namespace peelray
