// Reads a file a block at a time, as bytes or as words, so that a large one never lies in memory whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace peelray {

/// Bytes of a file, from front to back. Throws Error, as read_file() does, when the file cannot be read or is empty.
class FileReader {
  public:
    /// `name`: the file's, for messages.
    FileReader(const std::filesystem::path& path, std::string name);

    const std::string& name() const { return name_; }
    uint64_t size() const { return size_; }
    uint64_t offset() const { return begin_ + at_; }  ///< of the next byte
    uint64_t left() const { return size_ - offset(); }

    /// The next `count` bytes, or all that are left where those are fewer. Valid until the next call.
    std::string_view peek(size_t count) {
        if (end_ - at_ < count) fill(count);
        return {buffer_.data() + at_, std::min(count, end_ - at_)};
    }
    void skip(uint64_t count);

    /// The next `count` bytes, which are used up; nullptr where fewer are left.
    const char* take(size_t count) {
        if (end_ - at_ < count) fill(count);
        if (end_ - at_ < count) return nullptr;
        at_ += count;
        return buffer_.data() + at_ - count;
    }

    /// The next word, on whichever line; empty at the end. Blanks stand between words; '#' hides the rest of its line
    /// if `comments` were asked for. Valid until the next call.
    std::string_view word() { return next_word(true); }
    /// The same, on the same line; empty at its end.
    std::string_view word_on_line() { return next_word(false); }
    /// What is left of the line, comments too, without its end, which is used up.
    std::string_view rest_of_line();
    /// The same without using it up.
    std::string_view peek_line();
    /// Whether '#' begins a comment: no unless this is called.
    void allow_comments() { comments_ = true; }
    /// For a text: skips a byte order mark, and finds out whether a carriage return alone ends lines, as on old Macs.
    void find_line_ends();
    /// Of the last word or line, counted from 1.
    uint64_t line() const { return line_; }

    /// The next word as a number; what no double can hold is infinite. Throws Error for a word that is no number ("nan"
    /// and "1.#IND" are).
    double number();
    /// The next word as a whole number.
    int64_t whole();

    /// What is being read, for messages: "vertex 2 of 8".
    struct Part {
        std::string_view what;
        uint64_t index = 0, count = 0;  ///< count 0: there is one only
    };
    Part part;
    std::string part_name() const;
    /// Throws Error for a file that ends in `part`.
    [[noreturn]] void fail_truncated() const;

  private:
    void fill(size_t count);
    std::string_view next_word(bool across_lines);
    bool skip_blanks(bool across_lines);

    std::string name_;
    uint64_t size_ = 0;
    std::ifstream stream_;
    uint64_t begin_ = 0, line_ = 1;  ///< begin_: the file's offset of the buffer's first byte
    std::vector<char> buffer_;
    size_t at_ = 0, end_ = 0;  ///< what the buffer holds and was not used yet
    bool comments_ = false;
    char line_end_ = '\n';
};

/// A word as a number, as FileReader::number() reads it; nothing: it is none.
std::optional<double> to_number(std::string_view word);

}  // namespace peelray
