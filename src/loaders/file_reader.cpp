#include "loaders/file_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "loaders/files.h"

namespace peelray {

namespace {

constexpr size_t block = 1 << 20;
constexpr double largest_whole = 9e15;  // doubles count exactly up to here

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

FileReader::FileReader(const std::filesystem::path& path, std::string name)
    : name_(std::move(name)), stream_(open_file(path, size_)) {
    if (size_ == 0) fail("{}: the file is empty", name_);
    buffer_.resize(block);
}

void FileReader::fill(size_t count) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
              buffer_.begin());
    begin_ += at_;
    end_ -= at_;
    at_ = 0;
    count = static_cast<size_t>(std::min<uint64_t>(count, size_ - begin_));
    if (count > buffer_.size()) buffer_.resize(std::max(count, std::min<size_t>(buffer_.size() * 2, size_ - begin_)));
    const auto wanted = static_cast<size_t>(std::min<uint64_t>(buffer_.size(), size_ - begin_) - end_);
    if (wanted == 0) return;
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(wanted));
    if (static_cast<size_t>(stream_.gcount()) != wanted)
        fail("{}: only {} of {} bytes could be read", name_, begin_ + end_ + static_cast<uint64_t>(stream_.gcount()),
             size_);
    end_ += wanted;
}

void FileReader::skip(uint64_t count) {
    while (count > 0) {
        const size_t piece = peek(static_cast<size_t>(std::min<uint64_t>(count, block))).size();
        if (piece == 0) return;
        at_ += std::min<uint64_t>(piece, count);
        count -= std::min<uint64_t>(piece, count);
    }
}

void FileReader::find_line_ends() {
    if (peek(3) == "\xEF\xBB\xBF") skip(3);
    const std::string_view begin = peek(block);
    const size_t end = begin.find_first_of("\r\n");
    if (end < begin.size() && begin[end] == '\r' && !begin.substr(end).starts_with("\r\n")) line_end_ = '\r';
}

bool FileReader::skip_blanks(bool across_lines) {
    for (bool hidden = false;; ++at_) {
        if (at_ == end_) {
            fill(1);
            if (at_ == end_) return false;
        }
        const char c = buffer_[at_];
        if (c == line_end_) {
            if (!across_lines) return false;
            ++line_;
            hidden = false;
        } else if (comments_ && c == '#') {
            hidden = true;
        } else if (!hidden && !is_space(c)) {
            return true;
        }
    }
}

std::string_view FileReader::next_word(bool across_lines) {
    if (!skip_blanks(across_lines)) return {};
    size_t length = 0;
    for (;;) {
        const char *first = buffer_.data() + at_, *last = buffer_.data() + end_, *c = first + length;
        while (c != last && !is_space(*c) && !(comments_ && *c == '#')) ++c;
        length = static_cast<size_t>(c - first);
        if (c != last) break;
        fill(length + 1);
        if (at_ + length == end_) break;
    }
    at_ += length;
    return {buffer_.data() + at_ - length, length};
}

std::string_view FileReader::peek_line() {
    size_t length = 0;
    for (;;) {
        const char *first = buffer_.data() + at_, *last = buffer_.data() + end_;
        const char* c = std::find(first + length, last, line_end_);
        length = static_cast<size_t>(c - first);
        if (c != last) break;
        fill(length + 1);
        if (at_ + length == end_) break;
    }
    return {buffer_.data() + at_, length};
}

std::string_view FileReader::rest_of_line() {
    std::string_view out = peek_line();
    at_ += out.size();
    if (at_ < end_) {
        ++at_;
        ++line_;
    }
    if (out.ends_with('\r')) out.remove_suffix(1);
    return out;
}

std::optional<double> to_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const char* last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error == std::errc() && end == last) return value;
    if (error == std::errc::result_out_of_range && end == last) {
        const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
        return tiny ? 0 : std::numeric_limits<double>::infinity();
    }
    // What Microsoft's C library prints for numbers that are none: 1.#IND, -1.#QNAN, 1.#INF, -nan(ind).
    if (word.find(".#") != word.npos || word.find("nan(") != word.npos) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

double FileReader::number() {
    const std::string_view next = word();
    if (next.empty()) fail_truncated();
    const std::optional<double> value = to_number(next);
    if (!value)
        fail("{}: line {}: \"{}\" in {} is no number; repair the file", name_, line_, printable(next, 30), part_name());
    return *value;
}

int64_t FileReader::whole() {
    const std::string_view next = word();
    if (next.empty()) fail_truncated();
    int64_t value = 0;
    const char* last = next.data() + next.size();
    const auto [end, error] = std::from_chars(next.data(), last, value);
    if (error == std::errc() && end == last) return value;
    const std::optional<double> number = to_number(next);
    if (!number || !(std::abs(*number) < largest_whole) || *number != std::floor(*number))
        fail("{}: line {}: \"{}\" in {} is no whole number; repair the file", name_, line_, printable(next, 30),
             part_name());
    return static_cast<int64_t>(*number);
}

std::string FileReader::part_name() const {
    return part.count ? fmt::format("{} {} of {}", part.what, part.index, part.count) : std::string(part.what);
}

void FileReader::fail_truncated() const {
    fail("{}: the file ends in {}; it is truncated, export it again", name_, part_name());
}

}  // namespace peelray
