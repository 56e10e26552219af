// Pictures and videos on the standard output (-o -).
#pragma once

#include <filesystem>
#include <string_view>

namespace peelray {

/// Is it the name "-"?
bool is_standard_output(const std::filesystem::path& path);

/// The standard output for bytes, until it goes. A pipe is written to in pieces as large as it can be made.
class StandardOutput {
  public:
    /// Throws Error where it is a terminal. From here on a closed pipe is an Error, not the end of the program.
    StandardOutput();
    ~StandardOutput();
    StandardOutput(const StandardOutput&) = delete;
    StandardOutput& operator=(const StandardOutput&) = delete;

    /// Writes all. Throws Error, such as for a reader that is gone, and Interrupted while the reader takes nothing.
    void write(std::string_view bytes);

  private:
    int file_ = 1;
    void (*old_pipe_)(int);  ///< what SIGPIPE did before
};

}  // namespace peelray
