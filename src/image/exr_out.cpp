// OpenEXR out. The library writes the header; rows go into the file straight from the pixels, in the format that
// "OpenEXR File Layout" describes: the library's way copies each value several times. ZIP is libdeflate's.
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <memory>

#include "image/codecs.h"
#include "image/exr_errors.h"
#include "image/half.h"

namespace peelray {
namespace {

static_assert(std::endian::native == std::endian::little, "an EXR is");

/// Files as large as OpenEXR's own, in less time (docs/lab_notes.md).
constexpr int kZipLevel = 4;

class MemoryOut : public Imf::OStream {
  public:
    MemoryOut() : OStream("memory") {}

    void write(const char data[], int count) override {
        const size_t end = position_ + size_t(count);
        if (end > bytes.size()) bytes.resize(end);
        std::memcpy(bytes.data() + position_, data, size_t(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    std::string bytes;

  private:
    size_t position_ = 0;
};

/// One channel to write: a float every `stride` floats.
struct Channel {
    std::string name;
    bool half;
    const float* data;
    size_t stride;
    size_t bytes() const { return half ? 2 : 4; }
};

struct ChannelPicture {
    uint32_t width, height;
    std::vector<Channel> channels;  ///< in the order of the file

    size_t row_bytes() const {
        size_t bytes = 0;
        for (const Channel& channel : channels) bytes += width * channel.bytes();
        return bytes;
    }
};

/// All that comes before the rows, with an empty table of where the blocks of them begin.
std::string file_head(const ChannelPicture& picture, bool zip) {
    Imf::Header header{int(picture.width), int(picture.height)};
    header.compression() = zip ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
    for (const Channel& channel : picture.channels)
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    MemoryOut stream;
    Imf::OutputFile(stream, header);  // writes no rows
    return std::move(stream.bytes);
}

/// Row `y`, channel by channel. Returns how many values half floats do not reach.
size_t put_row(const ChannelPicture& picture, uint32_t y, char* out) {
    size_t beyond = 0;
    for (const Channel& channel : picture.channels) {
        const float* from = channel.data + size_t(y) * picture.width * channel.stride;
        if (channel.half)
            beyond +=
                channel.stride == 4 ? put_halves<4>(from, picture.width, out) : put_halves<1>(from, picture.width, out);
        else if (channel.stride == 1)
            std::memcpy(out, from, picture.width * sizeof(float));
        else
            for (uint32_t x = 0; x < picture.width; x++)
                std::memcpy(out + x * sizeof(float), from + x * channel.stride, sizeof(float));
        out += picture.width * channel.bytes();
    }
    return beyond;
}

/// What ZIP_COMPRESSION does before it deflates: bytes at even places, then those at odd ones, each less the one
/// before.
void reorder(const char* from, size_t count, uint8_t* out) {
    const size_t evens = (count + 1) / 2;
    for (size_t i = 0; i < count / 2; i++) {
        out[i] = uint8_t(from[2 * i]);
        out[evens + i] = uint8_t(from[2 * i + 1]);
    }
    if (count % 2) out[evens - 1] = uint8_t(from[count - 1]);
    for (size_t i = count - 1; i > 0; i--) out[i] = uint8_t(out[i] - out[i - 1] + 128);
}

size_t put_rows(const ChannelPicture& picture, uint32_t first, uint32_t count, char* out) {
    size_t beyond = 0;
    for (uint32_t y = first; y < first + count; y++, out += picture.row_bytes()) beyond += put_row(picture, y, out);
    return beyond;
}

/// What comes before a block's rows.
void put_block_head(char* at, uint32_t first_row, size_t bytes) {
    const uint32_t numbers[] = {first_row, uint32_t(bytes)};
    std::memcpy(at, numbers, sizeof numbers);
}
constexpr size_t kBlockHead = 8;

/// A file without compression: where each row begins is known, and so it goes out in pieces that stay in the caches.
/// Returns how many values half floats do not reach.
size_t write_plain(const std::filesystem::path& path, const ChannelPicture& picture, std::string head) {
    const size_t block = kBlockHead + picture.row_bytes();
    const uint64_t size = head.size() + picture.height * block;
    for (uint64_t y = 0; y < picture.height; y++) {
        const uint64_t start = head.size() + y * block;
        std::memcpy(&head[head.size() - (picture.height - y) * sizeof start], &start, sizeof start);
    }
    const uint32_t each = uint32_t(std::max<size_t>(1, (256 << 10) / block));  // rows of a piece
    size_t beyond = 0;
    uint32_t y = 0;
    std::string piece;
    store_parts(path, size, [&]() -> std::string_view {
        if (!head.empty()) return piece = std::exchange(head, {});
        const uint32_t rows = std::min(each, picture.height - y);
        piece.resize(rows * block);
        for (uint32_t i = 0; i < rows; i++, y++) {
            put_block_head(&piece[i * block], y, picture.row_bytes());
            beyond += put_row(picture, y, &piece[i * block + kBlockHead]);
        }
        return piece;
    });
    return beyond;
}

/// A file of blocks of 16 rows, each deflated; what does not get smaller stays as it is: readers tell by its size.
size_t write_zipped(const std::filesystem::path& path, const ChannelPicture& picture, std::string file) {
    constexpr uint32_t each = 16;
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kZipLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<char> rows(each * picture.row_bytes());
    std::vector<uint8_t> ordered(rows.size());
    size_t beyond = 0, place = file.size() - (picture.height + each - 1) / each * sizeof(uint64_t);
    for (uint32_t y = 0; y < picture.height; y += each, place += sizeof(uint64_t)) {
        const uint64_t start = file.size();
        std::memcpy(&file[place], &start, sizeof start);
        const uint32_t count = std::min(each, picture.height - y);
        const size_t bytes = count * picture.row_bytes();
        beyond += put_rows(picture, y, count, rows.data());
        reorder(rows.data(), bytes, ordered.data());
        file.resize(start + kBlockHead + bytes);
        size_t size =
            libdeflate_zlib_compress(compressor.get(), ordered.data(), bytes, &file[start + kBlockHead], bytes - 1);
        if (size == 0) std::memcpy(&file[start + kBlockHead], rows.data(), size = bytes);
        put_block_head(&file[start], y, size);
        file.resize(start + kBlockHead + size);
    }
    store_file(path, file);
    return beyond;
}

/// Returns how many values half floats do not reach.
size_t write_channels(const std::filesystem::path& path, ChannelPicture picture, bool zip) {
    std::ranges::sort(picture.channels, {}, &Channel::name);
    return guarded("write", path, [&] {
        std::string head = file_head(picture, zip);
        return zip ? write_zipped(path, picture, std::move(head)) : write_plain(path, picture, std::move(head));
    });
}

void append(std::vector<Channel>& all, const std::vector<ExrChannel>& channels) {
    for (const ExrChannel& channel : channels) all.push_back({channel.name, false, channel.data, channel.stride});
}

}  // namespace

void write_exr_channels(const std::filesystem::path& path, uint32_t width, uint32_t height,
                        const std::vector<ExrChannel>& channels, const ExrFormat& format) {
    check_size("write", path, width, height);
    assert(!channels.empty());
    ChannelPicture picture{width, height, {}};
    append(picture.channels, channels);
    write_channels(path, std::move(picture), format.zip);
}

size_t write_exr_layers(const std::filesystem::path& path, const ImageView& image,
                        const std::vector<ExrChannel>& channels, const ExrFormat& format) {
    check_size("write", path, image.width, image.height);
    assert(image.pixels.size() == size_t(image.width) * image.height);
    const bool opaque = std::ranges::all_of(image.pixels, [](const glm::vec4& pixel) { return pixel.w == 1; });
    ChannelPicture picture{image.width, image.height, {}};
    const char* const colors[] = {"R", "G", "B", "A"};
    for (int c = 0; c < (opaque ? 3 : 4); c++)
        picture.channels.push_back({colors[c], format.half, &image.pixels[0][c], 4});
    append(picture.channels, channels);
    return write_channels(path, std::move(picture), format.zip);
}

}  // namespace peelray
