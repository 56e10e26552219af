#include "cli/video.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/search_path.h"
#include "base/text.h"

extern char** environ;

namespace peelray {

namespace fs = std::filesystem;

namespace {

using namespace std::chrono_literals;

/// Everything on ffmpeg's command line.
std::vector<std::string> command_line(const fs::path& ffmpeg, const fs::path& file, const glm::uvec2& size,
                                      double fps) {
    const std::string where = "file:" + file.string();  // a name with a colon is no address
    std::vector<std::string> words = {ffmpeg.string(), "-hide_banner", "-loglevel", "error", "-nostats", "-y"};

    const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
    add({"-xerror"});  // without it a full disk leaves half a .webm and exit status 0
    add({"-f", "rawvideo", "-pix_fmt", "rgb0", "-video_size", fmt::format("{}x{}", size.x, size.y), "-framerate",
         fmt::format("{}", fps), "-i", "pipe:0", "-an"});
    // Players take HD video for BT.709; without these ffmpeg converts by BT.601, and colours shift.
    add({"-vf", "scale=in_range=full:out_range=limited:out_color_matrix=bt709", "-pix_fmt", "yuv420p", "-colorspace",
         "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"});
    if (lower_extension(file) == ".webm")
        add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"});
    else
        add({"-c:v", "libx264", "-crf", "18", "-preset", "medium", "-movflags", "+faststart", "-f", "mp4"});
    add({where});
    return words;
}

/// The ends of a pipe, and other descriptors, closed on errors.
struct Handle {
    int number = -1;
    ~Handle() {
        if (number >= 0) ::close(number);
    }
    int release() { return std::exchange(number, -1); }
};

}  // namespace

bool is_video(const fs::path& path) {
    const std::string extension = lower_extension(path);
    return extension == ".mp4" || extension == ".webm";
}

fs::path find_ffmpeg() {
    const char* path = std::getenv("PATH");
    if (const auto program = find_program(path ? path : "", "ffmpeg")) return *program;
    fail(
        "there is no ffmpeg on the PATH, which encodes videos: install it (apt-get install ffmpeg), or write pictures "
        "with -o NAME_%05d.png");
}

void check_video_size(const glm::uvec2& size) {
    if (size.x % 2 == 0 && size.y % 2 == 0) return;
    fail("a video of {}x{} pixels is impossible, width and height must be even: use --size {}x{}", size.x, size.y,
         size.x + size.x % 2, size.y + size.y % 2);
}

VideoWriter::VideoWriter(const fs::path& ffmpeg, const fs::path& file, const glm::uvec2& size, double fps)
    : size_(size), old_pipe_(std::signal(SIGPIPE, SIG_IGN)) {
    // From here on a write to an ffmpeg that ended is an error, not the end of this program.
    start(ffmpeg, file, fps);
}

VideoWriter::~VideoWriter() {
    kill();
    if (messages_ >= 0) ::close(messages_);
    if (old_pipe_ != SIG_ERR) std::signal(SIGPIPE, old_pipe_);
}

void VideoWriter::start(const fs::path& ffmpeg, const fs::path& file, double fps) {
    std::vector<std::string> words = command_line(ffmpeg, file, size_, fps);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("cannot start ffmpeg: {}", std::strerror(errno));
    Handle theirs{ends[0]}, ours{ends[1]}, messages{::memfd_create("ffmpeg", MFD_CLOEXEC)};
    if (messages.number < 0) fail("cannot start ffmpeg: {}", std::strerror(errno));

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, theirs.number, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, messages.number, 2);
    // In a process group of its own, so that a Ctrl-C reaches us alone, who then end it; and with SIGPIPE as it finds
    // it elsewhere. (SIGXFSZ it inherits ignored: then it can say that a file is too large.)
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t defaults, none;
    sigemptyset(&none);
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    const int error = ::posix_spawn(&process_, ffmpeg.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) {
        process_ = -1;
        fail("cannot start {}: {}", ffmpeg.string(), std::strerror(error));
    }
    // Never blocking, so that an interrupt is seen while ffmpeg is busy.
    ::fcntl(ours.number, F_SETFL, O_NONBLOCK);
    ::fcntl(ours.number, F_SETPIPE_SZ, 1 << 20);  // where it may: fewer, larger pieces
    input_ = ours.release();
    messages_ = messages.release();
}

void VideoWriter::add(std::span<const uint32_t> pixels) {
    const std::span<const std::byte> bytes = std::as_bytes(pixels);
    for (size_t at = 0; at < bytes.size();) {
        const ssize_t written = ::write(input_, bytes.data() + at, bytes.size() - at);
        if (written > 0) {
            at += size_t(written);
        } else if (errno == EAGAIN || errno == EINTR) {
            check_interrupt();
            pollfd waiting{input_, POLLOUT, 0};
            ::poll(&waiting, 1, 100);
        } else {
            fail_because_it_ended();
        }
    }
}

void VideoWriter::finish() {
    close_input();
    while (!has_ended()) {
        check_interrupt();
        std::this_thread::sleep_for(10ms);
    }
    if (status_ != 0) fail_because_it_ended();
}

bool VideoWriter::has_ended() {
    if (process_ < 0) return true;
    if (::waitpid(process_, &status_, WNOHANG) != process_) return false;
    process_ = -1;
    return true;
}

void VideoWriter::close_input() {
    if (input_ >= 0) ::close(std::exchange(input_, -1));
}

void VideoWriter::kill() {
    close_input();
    if (process_ < 0) return;
    ::kill(-process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
    process_ = -1;
}

/// The last line that is not empty; of what ffmpeg says it tells the most.
std::string VideoWriter::last_message() const {
    const off_t size = ::lseek(messages_, 0, SEEK_END), most = 4096;
    std::string text(size_t(std::min(size, most)), '\0');
    const ssize_t count = ::pread(messages_, text.data(), text.size(), size - off_t(text.size()));
    text.resize(size_t(std::max<ssize_t>(count, 0)));
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    return text.substr(text.find_last_of("\r\n") + 1);
}

void VideoWriter::fail_because_it_ended() {
    close_input();
    // It reads no more; a moment later it has ended and said why.
    for (int i = 0; i < 200 && !has_ended(); i++) std::this_thread::sleep_for(10ms);
    const bool ended = process_ < 0;
    kill();
    const std::string how = !ended                 ? "it reads no more"
                            : WIFSIGNALED(status_) ? fmt::format("ended by signal {}", WTERMSIG(status_))
                                                   : fmt::format("exit status {}", WEXITSTATUS(status_));
    const std::string said = last_message();
    fail("ffmpeg failed ({}): {}; no video was written", how, said.empty() ? "it does not say why" : said);
}

}  // namespace peelray
