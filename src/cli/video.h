// Videos, encoded by the program `ffmpeg` that is installed.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>

namespace peelray {

/// Is it named .mp4 or .webm?
bool is_video(const std::filesystem::path& path);

/// The `ffmpeg` on PATH. Throws Error where there is none, saying what to install or do instead.
std::filesystem::path find_ffmpeg();

/// Throws Error unless a video can have this size: 4:2:0 colour comes in blocks of 2x2 pixels.
void check_video_size(const glm::uvec2& size);

/// A video in the making: frames go to ffmpeg one by one.
class VideoWriter {
  public:
    /// Starts `ffmpeg`, which writes `file` (.mp4: H.264, .webm: VP9), replacing what is there. Throws Error.
    VideoWriter(const std::filesystem::path& ffmpeg, const std::filesystem::path& file, const glm::uvec2& size,
                double fps);
    /// Ends ffmpeg where the video was not finished.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// A frame's 8-bit sRGB pixels, red in the lowest byte. Throws Error with ffmpeg's own last message if it failed,
    /// and Interrupted.
    void add(std::span<const uint32_t> pixels);
    /// After the last frame: waits until the video is whole. Throws like add().
    void finish();

  private:
    void start(const std::filesystem::path& ffmpeg, const std::filesystem::path& file, double fps);
    bool has_ended();
    void close_input();
    void kill();
    std::string last_message() const;
    [[noreturn]] void fail_because_it_ended();

    glm::uvec2 size_;
    pid_t process_ = -1;     ///< -1: not running
    int status_ = 0;         ///< as waitpid() says, once it ended
    int input_ = -1;         ///< its standard input
    int messages_ = -1;      ///< its standard error, in memory
    void (*old_pipe_)(int);  ///< what SIGPIPE did before
};

}  // namespace peelray
