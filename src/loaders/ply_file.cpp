// The header of a PLY file, and the values of its body.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/text.h"
#include "loaders/ply.h"

namespace peelray {

namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr std::array<TypeName, 18> type_names = {{{"char", PlyType::int8},
                                                  {"uchar", PlyType::uint8},
                                                  {"short", PlyType::int16},
                                                  {"ushort", PlyType::uint16},
                                                  {"int", PlyType::int32},
                                                  {"uint", PlyType::uint32},
                                                  {"float", PlyType::float32},
                                                  {"double", PlyType::float64},
                                                  {"int8", PlyType::int8},
                                                  {"uint8", PlyType::uint8},
                                                  {"int16", PlyType::int16},
                                                  {"uint16", PlyType::uint16},
                                                  {"int32", PlyType::int32},
                                                  {"uint32", PlyType::uint32},
                                                  {"int64", PlyType::int64},
                                                  {"uint64", PlyType::uint64},
                                                  {"float32", PlyType::float32},
                                                  {"float64", PlyType::float64}}};

/// The words of one line of the header.
class HeaderLine {
  public:
    HeaderLine(const FileReader& file, uint64_t number, std::string_view text)
        : file_(file), number_(number), rest_(text) {}

    std::string_view word() {
        const size_t begin = std::min(rest_.find_first_not_of(" \t\r\v\f"), rest_.size());
        const size_t end = std::min(rest_.find_first_of(" \t\r\v\f", begin), rest_.size());
        const std::string_view out = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return out;
    }

    /// What is left, without blanks at its ends.
    std::string_view rest() const {
        const size_t begin = std::min(rest_.find_first_not_of(" \t\r"), rest_.size());
        const size_t end = rest_.find_last_not_of(" \t\r");
        return end == rest_.npos ? std::string_view() : rest_.substr(begin, end + 1 - begin);
    }

    PlyType type() {
        const std::string_view name = word();
        for (const TypeName& known : type_names)
            if (known.name == name) return known.type;
        fail("{}: line {}: the PLY header has the unknown type \"{}\"", file_.name(), number_, printable(name, 20));
    }

    PlyProperty property() {
        PlyProperty out;
        HeaderLine list = *this;
        if (list.word() == "list") {
            *this = list;
            out.count = type();
            if (is_floating(*out.count))
                fail("{}: line {}: a list is counted by numbers that are not whole; use uchar or int", file_.name(),
                     number_);
        }
        out.type = type();
        out.name = word();
        if (out.name.empty()) fail("{}: line {}: the property has no name", file_.name(), number_);
        return out;
    }

    PlyElement element() {
        PlyElement out;
        out.name = word();
        const std::optional<double> count = to_number(word());
        if (!count || !(*count >= 0) || *count > 1e15 || *count != std::floor(*count))
            fail("{}: line {}: the PLY header gives no count for element \"{}\"", file_.name(), number_,
                 printable(out.name, 40));
        out.count = static_cast<uint64_t>(*count);
        return out;
    }

    HeaderLine& operator=(const HeaderLine& other) {
        rest_ = other.rest_;
        return *this;
    }
    HeaderLine(const HeaderLine&) = default;

  private:
    const FileReader& file_;
    uint64_t number_;
    std::string_view rest_;
};

PlyHeader::Format read_format(std::string_view name, const FileReader& file) {
    if (name == "ascii") return PlyHeader::Format::ascii;
    if (name == "binary_little_endian") return PlyHeader::Format::little_endian;
    if (name == "binary_big_endian") return PlyHeader::Format::big_endian;
    fail("{}: the PLY format \"{}\" is unknown; use ascii, binary_little_endian or binary_big_endian", file.name(),
         printable(name, 30));
}

bool is_ply(FileReader& file) {
    const std::string_view begin = file.peek(4);
    if (!begin.starts_with("ply")) return false;
    if (begin.size() > 3 && !std::strchr(" \t\r\n", begin[3])) return false;
    file.find_line_ends();
    return true;
}

}  // namespace

size_t size_of(PlyType type) {
    constexpr std::array<size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<size_t>(type)];
}

bool is_floating(PlyType type) {
    return type == PlyType::float32 || type == PlyType::float64;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
    for (const PlyElement& element : elements)
        if (element.name == name) return &element;
    return nullptr;
}

PlyHeader read_ply_header(FileReader& file) {
    if (!is_ply(file)) fail("{}: not a PLY file: it does not begin with \"ply\"", file.name());
    file.rest_of_line();
    PlyHeader header;
    std::optional<PlyHeader::Format> format;
    for (;;) {
        if (file.left() == 0)
            fail("{}: the PLY header has no end_header; the file is truncated or no PLY file", file.name());
        const uint64_t number = file.line();
        HeaderLine line(file, number, file.rest_of_line());
        const std::string_view key = line.word();
        if (key == "end_header") break;
        if (key == "format") {
            format = read_format(line.word(), file);
        } else if (key == "element") {
            header.elements.push_back(line.element());
        } else if (key == "property") {
            if (header.elements.empty())
                fail("{}: line {}: the PLY header has a property before any element", file.name(), number);
            header.elements.back().properties.push_back(line.property());
        } else if (key == "comment") {
            if (lower_case(std::string(line.word())) == "texturefile") header.textures.emplace_back(line.rest());
        } else if (!key.empty() && key != "obj_info") {
            fail("{}: line {}: the PLY header has the unknown line \"{}\"", file.name(), number, printable(key, 40));
        }
    }
    if (!format) fail("{}: the PLY header has no format line", file.name());
    header.format = *format;
    return header;
}

uint64_t PlyBody::bits(PlyType type) {
    const size_t size = size_of(type);
    const char* raw = file_.take(size);
    if (!raw) file_.fail_truncated();
    uint64_t out = 0;
    if (format_ == PlyHeader::Format::little_endian) {
        for (size_t i = size; i-- > 0;) out = out << 8 | static_cast<uint8_t>(raw[i]);
    } else {
        for (size_t i = 0; i < size; ++i) out = out << 8 | static_cast<uint8_t>(raw[i]);
    }
    return out;
}

double PlyBody::number(PlyType type) {
    if (is_ascii()) return file_.number();
    if (type == PlyType::float32) return std::bit_cast<float>(static_cast<uint32_t>(bits(type)));
    if (type == PlyType::float64) return std::bit_cast<double>(bits(type));
    return static_cast<double>(whole(type));
}

int64_t PlyBody::whole(PlyType type) {
    if (is_ascii()) return file_.whole();
    if (is_floating(type)) {
        const double value = number(type);
        if (!(std::abs(value) < 9e15) || value != std::floor(value))
            fail("{}: {}: {} in {} is no whole number; repair the file", file_.name(), place(), value,
                 file_.part_name());
        return static_cast<int64_t>(value);
    }
    const uint64_t value = bits(type);
    switch (type) {
        case PlyType::int8:
            return static_cast<int8_t>(value);
        case PlyType::int16:
            return static_cast<int16_t>(value);
        case PlyType::int32:
            return static_cast<int32_t>(value);
        default:
            return static_cast<int64_t>(value);
    }
}

uint64_t PlyBody::length(const PlyProperty& list) {
    const int64_t count = whole(*list.count);
    const uint64_t left = file_.left(), size = is_ascii() ? 1 : size_of(list.type);
    if (count < 0 || static_cast<uint64_t>(count) > left / size)
        fail("{}: {}: {} claims a list of {} values, {} bytes are left; the file is truncated or damaged", file_.name(),
             place(), file_.part_name(), count, left);
    return static_cast<uint64_t>(count);
}

void PlyBody::skip(PlyType type, uint64_t count) {
    if (!is_ascii()) {
        if (count * size_of(type) > file_.left()) file_.fail_truncated();
        file_.skip(count * size_of(type));
        return;
    }
    for (; count > 0; --count)
        if (file_.word().empty()) file_.fail_truncated();
}

double PlyBody::least_size(const PlyElement& element) const {
    double size = 0;
    for (const PlyProperty& property : element.properties)
        size += is_ascii() ? 2.0 : static_cast<double>(size_of(property.count.value_or(property.type)));
    return size;
}

std::string PlyBody::place() const {
    return is_ascii() ? fmt::format("line {}", file_.line()) : fmt::format("byte {}", file_.offset());
}

}  // namespace peelray
