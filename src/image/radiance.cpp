// Radiance pictures (.hdr, "RGBE"), after Greg Ward, "Real Pixels", Graphics Gems II, and Radiance's color.c
// conventions. Read here and not by stb_image 2.27: that loops for ever on a truncated run and takes missing pixels for
// zeros.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "image/codecs.h"

namespace peelray {
namespace {

class Reader {
  public:
    Reader(const std::filesystem::path& path, std::string_view bytes) : path_(path), rest_(bytes) {}

    Image read() {
        read_header();
        Image image{width_, height_, {}};
        // Grown row by row: a short file with a huge size in its header costs nothing.
        std::vector<Rgbe> row(width_);
        for (row_ = 0; row_ < height_; ++row_) {
            read_row(row);
            for (const Rgbe& pixel : row) image.pixels.push_back(decode(pixel));
        }
        return image;
    }

  private:
    struct Rgbe {
        uint8_t r = 0, g = 0, b = 0, e = 0;
    };

    [[noreturn]] void broken(std::string_view what) const {
        fail("cannot read {}: {}; save it again as a Radiance picture", path_.string(), what);
    }

    std::string_view line() {
        const size_t end = rest_.find('\n');
        if (end == std::string_view::npos) broken("its header does not end");
        std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }

    void read_header() {
        line();  // "#?RADIANCE" or another program's name, checked by the caller
        for (std::string_view text = line(); !text.empty(); text = line())
            if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
                broken(fmt::format("it holds '{}', only 32-bit_rle_rgbe is supported", text.substr(7)));
        std::string_view size = line();
        const std::string_view all = size;
        int64_t sides[2] = {0, 0};
        for (int i = 0; i < 2; ++i) {
            const std::string_view axis = i == 0 ? "-Y " : "+X ";
            while (size.starts_with(' ')) size.remove_prefix(1);
            bool legal = size.starts_with(axis);
            if (legal) {
                size.remove_prefix(axis.size());
                const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), sides[i]);
                legal = error == std::errc();
                size.remove_prefix(size_t(end - size.data()));
            }
            if (!legal) broken(fmt::format("its size line is '{}', not '-Y HEIGHT +X WIDTH'", all));
        }
        check_size("read", path_, sides[1], sides[0]);
        width_ = uint32_t(sides[1]);
        height_ = uint32_t(sides[0]);
    }

    uint8_t byte() {
        if (rest_.empty()) broken(fmt::format("it ends in row {} of {}", row_ + 1, height_));
        const auto value = uint8_t(rest_.front());
        rest_.remove_prefix(1);
        return value;
    }

    void read_row(std::vector<Rgbe>& row) {
        const bool runs = width_ >= 8 && width_ < 32768 && rest_.size() >= 4 && rest_[0] == 2 && rest_[1] == 2 &&
                          !(uint8_t(rest_[2]) & 0x80);
        if (!runs) return read_flat_row(row);
        if ((uint8_t(rest_[2]) << 8 | uint8_t(rest_[3])) != int(width_))
            broken(fmt::format("row {} has another width than the picture", row_ + 1));
        rest_.remove_prefix(4);
        for (uint8_t Rgbe::*component : {&Rgbe::r, &Rgbe::g, &Rgbe::b, &Rgbe::e}) read_component(row, component);
    }

    /// One component of a row: a byte above 128 starts a run of one value, another one counts the values that follow.
    void read_component(std::vector<Rgbe>& row, uint8_t Rgbe::*component) {
        for (size_t x = 0; x < row.size();) {
            const unsigned code = byte();
            const bool run = code > 128;
            const size_t count = run ? code - 128 : code;
            if (count == 0 || count > row.size() - x)
                broken(fmt::format("row {} has a run of illegal length", row_ + 1));
            uint8_t value = run ? byte() : 0;
            for (size_t i = 0; i < count; ++i) {
                if (!run) value = byte();
                row[x++].*component = value;
            }
        }
    }

    /// The oldest layout: plain pixels, where (1, 1, 1, n) repeats the last one n times, more digits in further such
    /// pixels.
    void read_flat_row(std::vector<Rgbe>& row) {
        int shift = 0;
        for (size_t x = 0; x < row.size();) {
            Rgbe pixel;
            for (uint8_t Rgbe::*component : {&Rgbe::r, &Rgbe::g, &Rgbe::b, &Rgbe::e}) pixel.*component = byte();
            if (pixel.r != 1 || pixel.g != 1 || pixel.b != 1) {
                row[x++] = pixel;
                shift = 0;
                continue;
            }
            const size_t count = shift < 24 ? size_t(pixel.e) << shift : row.size();
            if (x == 0 || count > row.size() - x) broken(fmt::format("row {} has a run of illegal length", row_ + 1));
            std::fill_n(row.begin() + ptrdiff_t(x), count, row[x - 1]);
            x += count;
            shift += 8;
        }
    }

    static glm::vec4 decode(const Rgbe& pixel) {
        if (pixel.e == 0) return {0, 0, 0, 1};
        const float scale = std::ldexp(1.0f, int(pixel.e) - 136);
        return {float(pixel.r) * scale, float(pixel.g) * scale, float(pixel.b) * scale, 1};
    }

    const std::filesystem::path& path_;
    std::string_view rest_;
    uint32_t width_ = 0, height_ = 0, row_ = 0;
};

}  // namespace

// EXPOSURE lines are ignored, as other renderers do: the exposure is the user's.
Image decode_radiance(const std::filesystem::path& path, std::string_view bytes) {
    return Reader(path, bytes).read();
}

}  // namespace peelray
