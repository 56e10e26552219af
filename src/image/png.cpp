// PNG out, for sequences above all: rows are filtered by loops that the compiler vectorises, libdeflate compresses the
// whole. docs/lab_notes.md compares it with other libraries, levels and filters.
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <memory>

#include "base/error.h"
#include "image/codecs.h"

namespace peelray {
namespace {

/// More would make files by 2 to 5 % smaller and take two to four times as long.
constexpr int kPngLevel = 1;

/// Filters by their numbers in the file (PNG specification, section 9). The mean of two neighbours made no file smaller
/// by more than 1 %.
enum Filter : uint8_t { sub = 1, up = 2, paeth = 4 };

/// Bytes of a row and, for each of them, of the pixel to its left, of the row above, and of the pixel above left.
struct Row {
    const uint8_t *now, *left, *above, *corner;
    size_t count;
};

void subtract(const uint8_t* __restrict now, const uint8_t* __restrict from, uint8_t* __restrict out, size_t count) {
    for (size_t i = 0; i < count; i++) out[i] = uint8_t(now[i] - from[i]);
}

/// Less whichever neighbour is nearest to left + above - corner.
void subtract_nearest(const Row& row, uint8_t* __restrict out) {
    for (size_t i = 0; i < row.count; i++) {
        const int16_t left = row.left[i], above = row.above[i], corner = row.corner[i];
        const auto size = [](int x) { return int16_t(x < 0 ? -x : x); };
        const int16_t to_left = size(above - corner), to_above = size(left - corner);
        const int16_t to_corner = size(above + left - 2 * corner);
        const int16_t other = to_above <= to_corner ? above : corner;
        const int16_t to_other = to_above <= to_corner ? to_above : to_corner;
        out[i] = uint8_t(row.now[i] - (to_left <= to_other ? left : other));
    }
}

void apply(Filter filter, const Row& row, uint8_t* out) {
    if (filter == sub) subtract(row.now, row.left, out, row.count);
    if (filter == up) subtract(row.now, row.above, out, row.count);
    if (filter == paeth) subtract_nearest(row, out);
}

/// How far the bytes are from 0, as signed ones: the less, the better they compress.
uint64_t size_of(const uint8_t* bytes, size_t count) {
    uint64_t sum = 0;
    for (size_t first = 0; first < count; first += 1 << 16) {
        uint32_t part = 0;
        for (size_t i = first; i < std::min(count, first + (1 << 16)); i++)
            part += std::min(bytes[i], uint8_t(-bytes[i]));
        sum += part;
    }
    return sum;
}

template <size_t Components>
void pack(std::span<const uint32_t> pixels, uint8_t* __restrict out) {
    for (size_t i = 0; i < pixels.size(); i++)
        for (size_t c = 0; c < Components; c++) out[Components * i + c] = uint8_t(pixels[i] >> (8 * c));
}

/// All rows, each behind the number of its filter.
std::unique_ptr<uint8_t[]> filtered_rows(const Image8View& image, size_t components) {
    const size_t count = image.width * components;
    auto out = std::make_unique_for_overwrite<uint8_t[]>((count + 1) * image.height);
    // Rows as they are, with a pixel of zeros before them; above the first one all is zero.
    std::vector<uint8_t> above(components + count), now(components + count), tried(count);
    for (uint32_t y = 0; y < image.height; y++) {
        const auto pixels = image.pixels.subspan(size_t(y) * image.width, image.width);
        uint8_t* bytes = now.data() + components;
        components == 4 ? pack<4>(pixels, bytes) : pack<3>(pixels, bytes);
        const Row row{bytes, now.data(), above.data() + components, above.data(), count};
        uint8_t* best = out.get() + (count + 1) * y;
        uint64_t least = UINT64_MAX;
        for (const Filter filter : {sub, up, paeth}) {
            apply(filter, row, tried.data());
            const uint64_t size = size_of(tried.data(), count);
            if (size >= least) continue;
            least = size;
            best[0] = filter;
            std::memcpy(best + 1, tried.data(), count);
        }
        std::swap(above, now);
    }
    return out;
}

void put_number(char* at, uint32_t number) {
    for (int i = 0; i < 4; i++) at[i] = char(number >> (24 - 8 * i));
}

/// Length, name, data and checksum; `size` bytes of data are to follow the 8 of its head in `file`.
void close_chunk(std::string& file, size_t start, const char* name, size_t size) {
    put_number(&file[start], uint32_t(size));
    std::memcpy(&file[start + 4], name, 4);
    file.resize(start + 8 + size + 4);
    put_number(&file[start + 8 + size], libdeflate_crc32(0, &file[start + 4], 4 + size));
}

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr size_t kHeader = 13;  ///< bytes of data

std::string start_file(const Image8View& image, bool alpha, size_t room) {
    std::string file(kSignature);
    file.resize(file.size() + 8 + kHeader + 4 + 8 + room);
    const size_t start = kSignature.size();
    char* data = &file[start + 8];
    put_number(data, image.width);
    put_number(data + 4, image.height);
    data[8] = 8;                         // bits
    data[9] = alpha ? 6 : 2;             // RGBA or RGB
    data[10] = data[11] = data[12] = 0;  // deflate, the five filters, not interlaced
    put_number(&file[start], kHeader);
    std::memcpy(&file[start + 4], "IHDR", 4);
    put_number(data + kHeader, libdeflate_crc32(0, data - 4, 4 + kHeader));
    return file;
}

}  // namespace

std::string encode_png(const std::filesystem::path& path, const Image8View& image, bool alpha) {
    check_size("write", path, image.width, image.height);
    assert(image.pixels.size() == size_t(image.width) * image.height);
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kPngLevel), libdeflate_free_compressor);
    if (!compressor)
        fail("cannot write {}: not enough memory to compress {} x {} pixels", path.string(), image.width, image.height);
    const size_t components = alpha ? 4 : 3, bytes = (image.width * components + 1) * image.height;
    const std::unique_ptr<uint8_t[]> rows = filtered_rows(image, components);
    // What a file of this many pixels takes at most fits into one chunk, and that into its four bytes of length.
    static_assert(max_pixels * 4 + max_side < (uint64_t(1) << 31) - (1 << 20));
    const size_t room = libdeflate_zlib_compress_bound(compressor.get(), bytes);
    std::string file = start_file(image, alpha, room);
    const size_t start = file.size() - room - 8;
    const size_t size = libdeflate_zlib_compress(compressor.get(), rows.get(), bytes, &file[start + 8], room);
    assert(size > 0);
    close_chunk(file, start, "IDAT", size);
    const size_t end = file.size();
    file.resize(end + 8);
    close_chunk(file, end, "IEND", 0);
    return file;
}

void write_png(const std::filesystem::path& path, const Image8View& image, bool alpha) {
    store_file(path, encode_png(path, image, alpha));
}

}  // namespace peelray
