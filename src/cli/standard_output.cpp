#include "cli/standard_output.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/error.h"
#include "base/interrupt.h"

namespace peelray {
namespace {

/// As large as anybody may make it (/proc/sys/fs/pipe-max-size); if the system allows less, it stays as it was.
constexpr int kPipeBytes = 1 << 20;

/// The pipe once more, never blocking, so that an interrupt is seen while nobody reads: of the one that we were given
/// the flags are the reader's and the shell's, too. Where that cannot be had, or it is no pipe: itself.
int opened_again(int file) {
    struct stat status;
    if (::fstat(file, &status) != 0 || !S_ISFIFO(status.st_mode)) return file;
    ::fcntl(file, F_SETPIPE_SZ, kPipeBytes);
    const int again = ::open("/proc/self/fd/1", O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    return again >= 0 ? again : file;
}

}  // namespace

bool is_standard_output(const std::filesystem::path& path) {
    return path == "-";
}

StandardOutput::StandardOutput() {
    if (::isatty(STDOUT_FILENO))
        fail(
            "'-o -' writes pictures as bytes, and the standard output is a terminal: pipe it into a program or a file");
    old_pipe_ = std::signal(SIGPIPE, SIG_IGN);
    file_ = opened_again(STDOUT_FILENO);
}

StandardOutput::~StandardOutput() {
    if (file_ != STDOUT_FILENO) ::close(file_);
    if (old_pipe_ != SIG_ERR) std::signal(SIGPIPE, old_pipe_);
}

void StandardOutput::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file_, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(size_t(written));
        } else if (errno == EAGAIN || errno == EINTR) {
            check_interrupt();
            pollfd waiting{file_, POLLOUT, 0};
            ::poll(&waiting, 1, 100);
        } else if (errno == EPIPE) {
            fail("the program that read the standard output has closed it: what it got is not whole");
        } else {
            fail("cannot write to the standard output: {}", std::strerror(errno));
        }
    }
}

}  // namespace peelray
