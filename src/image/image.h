// Images in memory and on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace peelray {

/// Linear Rec. 709 RGBA, row 0 at the top.
struct Image {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec4> pixels;  ///< width·height

    glm::vec4& at(uint32_t x, uint32_t y) { return pixels[size_t(y) * width + x]; }
    const glm::vec4& at(uint32_t x, uint32_t y) const { return pixels[size_t(y) * width + x]; }
};

/// 8-bit sRGB RGBA, row 0 at the top.
struct Image8 {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels;  ///< red in the lowest byte
};

/// The same, kept by somebody else.
struct ImageView {
    uint32_t width = 0, height = 0;
    std::span<const glm::vec4> pixels;
    ImageView(uint32_t width, uint32_t height, std::span<const glm::vec4> pixels)
        : width(width), height(height), pixels(pixels) {}
    ImageView(const Image& image) : ImageView(image.width, image.height, image.pixels) {}
};
struct Image8View {
    uint32_t width = 0, height = 0;
    std::span<const uint32_t> pixels;
    Image8View(uint32_t width, uint32_t height, std::span<const uint32_t> pixels)
        : width(width), height(height), pixels(pixels) {}
    Image8View(const Image8& image) : Image8View(image.width, image.height, image.pixels) {}
};

/// How an EXR holds a picture.
struct ExrFormat {
    bool half = true;  ///< the channels R, G, B and A are half floats, ±65504 at most, else floats
    bool zip = true;   ///< ZIP compression, blocks of 16 rows; else none
};

/// Reads Radiance (.hdr) or OpenEXR (.exr) by its content: RGB(A), Y, luminance-chroma, one channel (grey) or one
/// layer's R, G, B; of several parts the first flat one. An EXR's display window is the image: what its data window
/// lacks of it is black, what stands over is cut. A Radiance file comes in any of the eight orientations and as RGB or
/// CIE XYZ (with the white point D65: X, Y, Z of 0.95, 1, 1.09 make 1, 1, 1; Radiance's own tools write 179 times
/// that); its EXPOSURE and COLORCORR factors are divided out. Every pixel comes out finite and ≥ 0: NaN and negative
/// values become 0, infinity the largest half (65504). No alpha in the file: 1. Throws Error: missing, broken, not one
/// of the two, empty, deep data only, channels X, Y, Z, more than 2^16 pixels per side or 2^28 in all. An EXR's
/// primaries become those of Rec. 709; `note`, if given: what was not understood.
Image read_hdr(const std::filesystem::path& path, std::string* note = nullptr);

/// Texels along a side of an environment map at most: more detail than a picture shows, in 0.7 GiB with its levels.
inline constexpr uint32_t kWidestEnvironment = 8192;

/// Reads an environment map from the same files. Values that are no radiance (negative, infinite, NaN, beyond 1e12)
/// become 0, alpha 1, and maps with a side above kWidestEnvironment are halved until they are within it; `notes` gets
/// a line for each. Throws Error as read_hdr() does.
Image read_environment(const std::filesystem::path& path, std::vector<std::string>& notes);

/// Reads PNG or JPEG (any stb-readable LDR format). Throws Error.
Image8 read_ldr(const std::filesystem::path& path);

/// Writes a float image; the extension chooses .exr (as `format` says) or .hdr (no alpha, negative values and NaN
/// become 0). An EXR has an alpha channel only if some alpha is not 1. Returns how many values were beyond what half
/// floats reach and became ±65504; NaN stays. All writers write to a temporary name first and rename, so that no
/// partial file is ever seen. Throws Error if unwritable.
size_t write_hdr(const std::filesystem::path& path, const ImageView& image, const ExrFormat& format = {});

/// A channel ("Z", "id", "normal.X"): width·height floats that somebody else keeps, row 0 first.
struct ExrChannel {
    std::string name;
    const float* data;  ///< a pixel's value is at data[stride * pixel]
    size_t stride = 1;
};

/// Writes channels to an EXR, as floats. Of `format` the compression counts.
void write_exr_channels(const std::filesystem::path& path, uint32_t width, uint32_t height,
                        const std::vector<ExrChannel>& channels, const ExrFormat& format = {});

/// Writes a picture to EXR as write_hdr() does and, into the same file, more channels as write_exr_channels() does:
/// what comes before the last dot of their names is their layer ("normal.X").
size_t write_exr_layers(const std::filesystem::path& path, const ImageView& image,
                        const std::vector<ExrChannel>& channels, const ExrFormat& format = {});

/// Writes an 8-bit PNG. `alpha` false drops the alpha channel. The same pixels make the same bytes.
void write_png(const std::filesystem::path& path, const Image8View& image, bool alpha = false);

/// The bytes of such a file; `path` is where they go to, for the errors.
std::string encode_png(const std::filesystem::path& path, const Image8View& image, bool alpha = false);

/// Writes all bytes, under a temporary name first. Throws Error if unwritable, on a full disk as well.
void store_file(const std::filesystem::path& path, std::string_view bytes);

/// Fails early, before long work: throws Error if a file cannot be created at `path` (not writable, is a folder, has a
/// file where a folder must be). Leaves nothing behind and does not touch a file that is there.
void check_writable(const std::filesystem::path& path);

/// Calls `write(temporary_path)` and renames the result to `path`. The folders that are missing are made first. Removes
/// all of that if `write` throws. Throws Error if unwritable.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write);

/// Like write_atomically, but leaves a file that is there already alone, also one that another process puts there at
/// the same moment. Returns whether it wrote.
bool write_if_absent(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);

/// Removes what killed runs left of half-written files in a folder: only what was not touched for a day, since another
/// run may be writing there.
void remove_stale_temporaries(const std::filesystem::path& folder);

}  // namespace peelray
