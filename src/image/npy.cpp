// NumPy's .npy files, after NumPy enhancement proposal 1: magic, version, a Python dictionary as text, then raw data.
#include "image/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image/codecs.h"

static_assert(std::endian::native == std::endian::little, "records are written as they lie in memory");

namespace peelray {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

struct Header {
    std::optional<std::string> descr;  ///< a plain dtype, or the text of a structured one, which starts with [
    std::optional<bool> fortran_order;
    std::optional<std::vector<uint64_t>> shape;
};

/// The header's dictionary: Python literals, of which strings, booleans, tuples of integers and (as text) lists may
/// occur.
class Parser {
  public:
    Parser(const std::filesystem::path& path, std::string_view text) : path_(path), rest_(text) {}

    Header parse() {
        Header header;
        expect('{');
        while (!take('}')) {
            const std::string key = string();
            expect(':');
            if (key == "descr" && !header.descr)
                header.descr = peek() == '[' ? bracketed() : string();
            else if (key == "fortran_order" && !header.fortran_order)
                header.fortran_order = boolean();
            else if (key == "shape" && !header.shape)
                header.shape = tuple();
            else
                broken();  // the proposal allows exactly these three, once
            if (peek() != '}') expect(',');
        }
        skip_space();
        if (!rest_.empty() || !header.descr || !header.fortran_order || !header.shape) broken();
        return header;
    }

  private:
    [[noreturn]] void broken() const {
        fail("cannot read {}: its .npy header is broken; write it with numpy.save", path_.string());
    }
    void skip_space() {
        while (!rest_.empty() && std::string_view(" \t\r\n\f\v").find(rest_.front()) != std::string_view::npos)
            rest_.remove_prefix(1);
    }
    char peek() {
        skip_space();
        if (rest_.empty()) broken();
        return rest_.front();
    }
    bool take(char c) {
        if (peek() != c) return false;
        rest_.remove_prefix(1);
        return true;
    }
    void expect(char c) {
        if (!take(c)) broken();
    }

    std::string string() {
        const char quote = peek();
        if (quote != '\'' && quote != '"') broken();
        const size_t end = rest_.find(quote, 1);
        if (end == std::string_view::npos) broken();
        const std::string text(rest_.substr(1, end - 1));
        if (text.find_first_of("\\\n") != std::string::npos) broken();
        rest_.remove_prefix(end + 1);
        return text;
    }

    bool boolean() {
        skip_space();
        for (const std::string_view word : {"True", "False"}) {
            if (!rest_.starts_with(word)) continue;
            rest_.remove_prefix(word.size());
            return word == "True";
        }
        broken();
    }

    /// A structured dtype, kept as text for the error message; quotes hide brackets.
    std::string bracketed() {
        int depth = 0;
        char quote = 0;
        for (size_t i = 0; i < rest_.size(); ++i) {
            const char c = rest_[i];
            if (quote) {
                if (c == quote) quote = 0;
            } else if (c == '\'' || c == '"') {
                quote = c;
            } else if (c == '[') {
                ++depth;
            } else if (c == ']' && --depth == 0) {
                const std::string text(rest_.substr(0, i + 1));
                rest_.remove_prefix(i + 1);
                return text;
            }
        }
        broken();
    }

    std::vector<uint64_t> tuple() {
        std::vector<uint64_t> values;
        expect('(');
        while (!take(')')) {
            values.push_back(integer());
            if (peek() == ')') {
                if (values.size() == 1) broken();  // Python reads (5) as a number
                continue;
            }
            expect(',');
        }
        return values;
    }

    uint64_t integer() {
        uint64_t value = 0;
        size_t digits = 0;
        for (skip_space(); digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9'; ++digits) {
            const auto digit = uint64_t(rest_[digits] - '0');
            if (value > (std::numeric_limits<uint64_t>::max() - digit) / 10) broken();
            value = value * 10 + digit;
        }
        if (digits == 0) broken();
        rest_.remove_prefix(digits);
        if (rest_.starts_with('L')) rest_.remove_prefix(1);  // Python 2 wrote long integers so
        return value;
    }

    const std::filesystem::path& path_;
    std::string_view rest_;
};

/// Splits the file: the header's text is parsed, `bytes` is left with the data alone.
Header take_header(const std::filesystem::path& path, std::string_view& bytes) {
    if (!bytes.starts_with(magic)) fail("cannot read {}: not a .npy file; write it with numpy.save", path.string());
    if (bytes.size() < 8) fail("cannot read {}: truncated in the header; write it again", path.string());
    const int version = uint8_t(bytes[6]);
    if (version < 1 || version > 3 || bytes[7] != 0)
        fail("cannot read {}: .npy version {}.{} is unknown; write version 1.0, 2.0 or 3.0", path.string(), version,
             int(uint8_t(bytes[7])));
    const size_t width = version == 1 ? 2 : 4;
    uint32_t length = 0;
    if (bytes.size() >= 8 + width) std::memcpy(&length, bytes.data() + 8, width);
    if (bytes.size() < 8 + width || length > bytes.size() - 8 - width)
        fail("cannot read {}: truncated in the header; write it again", path.string());
    const Header header = Parser(path, bytes.substr(8 + width, length)).parse();
    bytes.remove_prefix(8 + width + length);
    return header;
}

std::string text(const std::vector<uint64_t>& shape) {
    std::string list;
    for (size_t i = 0; i < shape.size(); ++i) list += (i ? ", " : "") + std::to_string(shape[i]);
    return "(" + list + (shape.size() == 1 ? ",)" : ")");
}

}  // namespace

std::vector<RayRecord> read_rays(const std::filesystem::path& path) {
    const std::string file = read_file(path);
    std::string_view data = file;
    const Header header = take_header(path, data);
    // All of numpy's names for little-endian float32; '=' and '|' mean the machine's own order.
    constexpr std::array<std::string_view, 9> float32 = {"<f4", "=f4", "|f4",     "f4",    "<f",
                                                         "=f",  "f",   "float32", "single"};
    if (std::find(float32.begin(), float32.end(), *header.descr) == float32.end())
        fail("cannot read {}: it holds '{}', not little-endian float32 '<f4'; save rays.astype('<f4')", path.string(),
             *header.descr);
    const std::vector<uint64_t>& shape = *header.shape;
    if (shape.size() != 2 || shape[1] != 8)
        fail("cannot read {}: its shape is {}, not (n, 8): ox oy oz tmin dx dy dz tmax; reshape it", path.string(),
             text(shape));
    if (*header.fortran_order)
        fail("cannot read {}: its data is in Fortran order; save numpy.ascontiguousarray(rays)", path.string());
    if (shape[0] != data.size() / sizeof(RayRecord) || data.size() % sizeof(RayRecord) != 0)
        fail("cannot read {}: {} bytes of data for shape {}, it is {}; write it again", path.string(), data.size(),
             text(shape), shape[0] > data.size() / sizeof(RayRecord) ? "truncated" : "too long");
    std::vector<RayRecord> rays(shape[0]);
    if (!rays.empty()) std::memcpy(rays.data(), data.data(), data.size());
    return rays;
}

/// `descr`: the Python text of the dtype; `data`: `count` records of it.
static void write_records(const std::filesystem::path& path, std::string_view descr, size_t count,
                          std::span<const std::byte> data) {
    std::string dictionary = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({},), }}", descr, count);
    // Padded so that the data starts at a multiple of 64 bytes: it can be mapped into memory.
    constexpr size_t prefix = 10;
    dictionary.append(63 - (prefix + dictionary.size()) % 64, ' ');
    dictionary += '\n';
    std::string bytes(magic);
    bytes += {'\x01', '\x00', char(dictionary.size() & 0xff), char(dictionary.size() >> 8)};
    bytes += dictionary;
    bytes.append(reinterpret_cast<const char*>(data.data()), data.size());
    store_file(path, bytes);
}

void write_hits(const std::filesystem::path& path, const std::vector<HitRecord>& hits) {
    write_records(path, "[('t', '<f4'), ('triangle', '<u4'), ('u', '<f4'), ('v', '<f4')]", hits.size(),
                  std::as_bytes(std::span(hits)));
}

void write_costs(const std::filesystem::path& path, const std::vector<RayCosts>& costs) {
    std::string descr;
    for (const RayCostField& field : kRayCostFields)
        descr += fmt::format("{}('{}', '<u4')", descr.empty() ? "[" : ", ", field.name);
    write_records(path, descr + "]", costs.size(), std::as_bytes(std::span(costs)));
}

}  // namespace peelray
