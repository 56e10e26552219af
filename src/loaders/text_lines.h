// Lines, words and numbers of OBJ and MTL files.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace peelray {

/// The statements of a file, one a line. A backslash at the end of a line joins the next one to it; lines end with a
/// line feed, with a carriage return in front of it or with that alone. A byte order mark in front is skipped.
class TextLines {
  public:
    explicit TextLines(std::string_view text);
    /// Goes to the next line; false at the end.
    bool next();
    std::string_view line() const { return line_; }  ///< as it stands, with its comment, without its end
    size_t number() const { return number_; }        ///< counted from 1; of joined lines the first one

  private:
    std::string_view take_physical_line();

    std::string_view rest_, line_;
    std::string joined_;
    char end_ = '\n';
    size_t number_ = 0, physical_ = 0;
};

inline bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0';
}

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Takes the next word off the front; empty at the end.
std::string_view take_word(std::string_view& rest);

/// Up to the '#' that begins a comment; that of a number such as 1.#IND does not.
std::string_view without_comment(std::string_view line);

/// The same for a line that ends with a name, trimmed: there only a '#' after a blank begins a comment ("wood#2").
std::string_view name_without_comment(std::string_view name);

/// Takes the next word off the front and reads it as a number: 1, +1, .5, 1., 1e5. What stands for no number ("nan",
/// "inf", "-1.#IND") and what no float can hold gives a value that is not finite. Nothing: no number, `rest` stays.
std::optional<float> take_number(std::string_view& rest);

}  // namespace peelray
