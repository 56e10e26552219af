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

/// CIE XYZ to linear Rec. 709 with its white point D65 (IEC 61966-2-1); columns.
const glm::mat3 rec709_from_xyz{{3.2404542f, -0.9692660f, 0.0556434f},
                                {-1.5371385f, 1.8760108f, -0.2040259f},
                                {-0.4985314f, 0.0415560f, 1.0572252f}};

class Reader {
  public:
    Reader(const std::filesystem::path& path, std::string_view bytes) : path_(path), rest_(bytes) {}

    Image read() {
        read_header();
        Image image{width_, height_, {}};
        // Grown row by row: a short file with a huge size in its header costs nothing.
        std::vector<Rgbe> row(length_);
        for (row_ = 0; row_ < rows_; ++row_) {
            read_row(row);
            for (const Rgbe& pixel : row) image.pixels.push_back(decode(pixel));
        }
        return orient(std::move(image));
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
        for (std::string_view text = line(); !text.empty(); text = line()) {
            if (text.starts_with("FORMAT=")) read_format(text.substr(7));
            if (text.starts_with("EXPOSURE=")) divide(text.substr(9), 1);
            if (text.starts_with("COLORCORR=")) divide(text.substr(10), 3);
        }
        read_size(line());
    }

    void read_format(std::string_view format) {
        while (format.starts_with(' ')) format.remove_prefix(1);
        while (format.ends_with(' ')) format.remove_suffix(1);
        is_xyz_ = format == "32-bit_rle_xyze";
        if (!is_xyz_ && format != "32-bit_rle_rgbe")
            broken(fmt::format("it holds '{}', only 32-bit_rle_rgbe and 32-bit_rle_xyze are supported", format));
    }

    /// The pixels were multiplied by such factors, of each line in turn, and are divided by them again.
    void divide(std::string_view text, int count) {
        const std::string_view all = text;
        glm::vec3 factors(0);
        for (int i = 0; i < count; ++i) {
            while (text.starts_with(' ')) text.remove_prefix(1);
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factors[i]);
            if (error != std::errc() || !(factors[i] > 0) || !std::isfinite(factors[i]))
                broken(fmt::format("its header has the factor '{}', which no pixel can be divided by", all));
            text.remove_prefix(size_t(end - text.data()));
        }
        scale_ /= count == 1 ? glm::vec3(factors.x) : factors;
    }

    /// "-Y HEIGHT +X WIDTH" in any order and with any signs: the first axis leads from row to row of the file, the
    /// second along them; +Y leads up, -X to the left.
    void read_size(std::string_view size) {
        const std::string_view all = size;
        int64_t sides[2] = {0, 0};
        char axes[2] = {0, 0};
        bool minus[2] = {false, false};
        for (int i = 0; i < 2; ++i) {
            while (size.starts_with(' ')) size.remove_prefix(1);
            bool legal = size.size() > 3 && (size[0] == '-' || size[0] == '+') && (size[1] == 'X' || size[1] == 'Y') &&
                         size[2] == ' ';
            if (legal) {
                minus[i] = size[0] == '-';
                axes[i] = size[1];
                while (size.size() > 2 && size[2] == ' ') size.remove_prefix(1);
                size.remove_prefix(2);
                const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), sides[i]);
                legal = error == std::errc();
                size.remove_prefix(size_t(end - size.data()));
            }
            if (!legal || axes[0] == axes[1])
                broken(fmt::format("its size line is '{}', not such as '-Y HEIGHT +X WIDTH'", all));
        }
        by_columns_ = axes[0] == 'X';
        is_upside_down_ = !minus[by_columns_ ? 1 : 0];
        is_mirrored_ = minus[by_columns_ ? 0 : 1];
        const int64_t width = sides[by_columns_ ? 0 : 1], height = sides[by_columns_ ? 1 : 0];
        check_size("read", path_, width, height);
        width_ = uint32_t(width);
        height_ = uint32_t(height);
        rows_ = by_columns_ ? width_ : height_;
        length_ = by_columns_ ? height_ : width_;
    }

    /// From the file's order to rows from the top, each from the left.
    Image orient(Image from) const {
        if (!by_columns_ && !is_upside_down_ && !is_mirrored_) return from;
        Image out{width_, height_, std::vector<glm::vec4>(from.pixels.size())};
        for (uint32_t y = 0; y < height_; ++y)
            for (uint32_t x = 0; x < width_; ++x) {
                const size_t fx = is_mirrored_ ? width_ - 1 - x : x, fy = is_upside_down_ ? height_ - 1 - y : y;
                out.at(x, y) = from.pixels[by_columns_ ? fx * height_ + fy : fy * width_ + fx];
            }
        return out;
    }

    uint8_t byte() {
        if (rest_.empty()) broken(fmt::format("it ends in row {} of {}", row_ + 1, rows_));
        const auto value = uint8_t(rest_.front());
        rest_.remove_prefix(1);
        return value;
    }

    void read_row(std::vector<Rgbe>& row) {
        const bool runs = length_ >= 8 && length_ < 32768 && rest_.size() >= 4 && rest_[0] == 2 && rest_[1] == 2 &&
                          !(uint8_t(rest_[2]) & 0x80);
        if (!runs) return read_flat_row(row);
        if ((uint8_t(rest_[2]) << 8 | uint8_t(rest_[3])) != int(length_))
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

    glm::vec4 decode(const Rgbe& pixel) const {
        if (pixel.e == 0) return {0, 0, 0, 1};
        const glm::vec3 color = glm::vec3(pixel.r, pixel.g, pixel.b) * std::ldexp(1.0f, int(pixel.e) - 136);
        return {(is_xyz_ ? rec709_from_xyz * color : color) * scale_, 1};
    }

    const std::filesystem::path& path_;
    std::string_view rest_;
    uint32_t width_ = 0, height_ = 0;
    uint32_t rows_ = 0, length_ = 0, row_ = 0;  ///< as they stand in the file
    bool is_xyz_ = false, by_columns_ = false, is_upside_down_ = false, is_mirrored_ = false;
    glm::vec3 scale_{1};
};

}  // namespace

Image decode_radiance(const std::filesystem::path& path, std::string_view bytes) {
    return Reader(path, bytes).read();
}

}  // namespace peelray
