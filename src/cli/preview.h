// A picture file that shows how far a picture has got.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

#include "scene/picture.h"

namespace peelray {

/// Without finish() the file is removed again, if there is one: what was left unfinished leaves nothing.
class Preview {
  public:
    /// Empty: there is none.
    explicit Preview(std::filesystem::path path) : path_(std::move(path)) {}
    ~Preview();
    Preview(const Preview&) = delete;
    Preview& operator=(const Preview&) = delete;

    explicit operator bool() const { return !path_.empty(); }
    /// Writes what `look` makes if a second has passed since the last time, and ten times as long as that took. If it
    /// cannot be written a note says so, and there is no preview any more.
    void update(const std::function<Picture()>& look);
    /// The file shows the finished picture.
    void finish(const Picture& picture);

  private:
    using Clock = std::chrono::steady_clock;
    void write(const Picture& picture);

    std::filesystem::path path_;
    Clock::time_point due_{};
    bool written_ = false;
};

}  // namespace peelray
