// Whole files in and out; nothing half-written is ever seen under the final name.
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "image/codecs.h"

namespace fs = std::filesystem;

namespace peelray {
namespace {

constexpr const char* kTemporaryPrefix = ".peelray-";

std::string reason(int code) {
    return std::generic_category().message(code);
}

/// A file descriptor that closes itself.
struct Descriptor {
    int number;
    explicit Descriptor(int n) : number(n) {}
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
};

/// Removes a temporary file unless it has been renamed.
struct Temporary {
    fs::path path;
    bool renamed = false;
    ~Temporary() {
        std::error_code ignored;
        if (!renamed) fs::remove(path, ignored);
    }
};

/// Folders that were made for a file, removed again unless the file was written.
class MadeFolders {
  public:
    MadeFolders(const fs::path& path, const fs::path& folder) {
        std::error_code error;
        std::vector<fs::path> missing;
        for (fs::path each = folder; !each.empty() && !fs::exists(each, error); each = each.parent_path())
            missing.push_back(each);
        for (auto each = missing.rbegin(); each != missing.rend(); ++each) {
            // Another process may make it at the same time.
            if (fs::create_directory(*each, error)) made_.push_back(*each);
            if (!error || fs::is_directory(*each)) continue;
            remove();
            fail("cannot write {}: cannot make the folder {}: {}; name a place that can be written", path.string(),
                 each->string(), error.message());
        }
    }
    ~MadeFolders() { remove(); }
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;
    void keep() { made_.clear(); }

  private:
    void remove() {
        std::error_code ignored;
        // One that holds something by now stays.
        for (auto each = made_.rbegin(); each != made_.rend(); ++each) fs::remove(*each, ignored);
    }

    std::vector<fs::path> made_;
};

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// The nearest folder above a file that is there.
fs::path standing_folder(const fs::path& file) {
    std::error_code error;
    fs::path folder = folder_of(file);
    while (folder.has_relative_path() && fs::symlink_status(folder, error).type() == fs::file_type::not_found)
        folder = folder_of(folder);
    return folder;
}

/// The file that `path` stands for. A link is followed, so that the link stays; devices, pipes and folders are refused,
/// since renaming onto /dev/null would replace it.
fs::path destination(const fs::path& path) {
    if (path.empty()) fail("cannot write a file without a name: name the file to write");
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::none)
        fail("cannot write {}: {}; name another one", path.string(), error.message());
    if (fs::is_directory(status) || !path.has_filename())
        fail("cannot write {}: it is a folder; name a file in it", path.string());
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail("cannot write {}: it is not a regular file; name another one", path.string());
    // What is not there yet may have ".." in it.
    const bool resolve = fs::is_symlink(path, error) || !fs::exists(folder_of(path), error);
    const fs::path target = resolve ? fs::weakly_canonical(path, error) : path;
    const fs::path folder = standing_folder(target);
    if (!fs::is_directory(folder, error))
        fail("cannot write {}: {} is not a folder; name another one", path.string(), folder.string());
    return target;
}

/// Creates an empty file beside `target` under a name that nobody else has. The extension stays: writers may choose by
/// it. The name does not grow with the target's, which may be as long as the file system allows. `path` is for
/// messages.
fs::path reserve(const fs::path& path, const fs::path& target, const fs::path& folder) {
    static std::atomic<unsigned> counter{0};
    std::string extension = target.extension().string();
    if (extension.size() > 16) extension.clear();
    for (;;) {
        const fs::path name = folder / fmt::format("{}{}-{}.tmp{}", kTemporaryPrefix, ::getpid(), counter++, extension);
        const Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (file.number >= 0) return name;
        if (errno != EEXIST)
            fail("cannot write {}: {}; name a place that can be written", path.string(), reason(errno));
    }
}

/// 0, or the system's error number.
int write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes.remove_prefix(size_t(written));
    }
    return 0;
}

/// 0, or the system's error number.
int write_parts(const fs::path& path, const NextPart& next) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
    if (file.number < 0) return errno;
    for (std::string_view part = next(); !part.empty(); part = next())
        if (const int error = write_all(file.number, part)) return error;
    // Network file systems and quotas report a failed write as late as here.
    return ::close(std::exchange(file.number, -1)) == 0 ? 0 : errno;
}

}  // namespace

void check_writable(const fs::path& path) {
    const fs::path target = destination(path);
    const Temporary probe{reserve(path, target, standing_folder(target))};
}

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path target = destination(path);
    MadeFolders folders(path, folder_of(target));
    Temporary temporary{reserve(path, target, target.parent_path())};
    write(temporary.path);
    std::error_code error;
    const fs::file_status old = fs::status(target, error);
    if (fs::exists(old)) fs::permissions(temporary.path, old.permissions(), error);
    fs::rename(temporary.path, target, error);
    if (error) fail("cannot write {}: {}; name a place that can be written", path.string(), error.message());
    temporary.renamed = true;
    folders.keep();
}

bool write_if_absent(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path target = destination(path);
    MadeFolders folders(path, folder_of(target));
    Temporary temporary{reserve(path, target, target.parent_path())};
    write(temporary.path);
    // A link is refused where the name is taken, a rename is not.
    if (::link(temporary.path.c_str(), target.c_str()) == 0) {
        folders.keep();
        return true;
    }
    if (errno == EEXIST) return false;
    std::error_code error;
    if (fs::exists(target, error)) return false;
    fs::rename(temporary.path, target, error);  // a file system without links
    if (error) fail("cannot write {}: {}; name a place that can be written", path.string(), error.message());
    temporary.renamed = true;
    folders.keep();
    return true;
}

void remove_stale_temporaries(const fs::path& folder) {
    std::error_code error;
    const auto now = fs::file_time_type::clock::now();
    fs::directory_iterator entry(folder.empty() ? "." : folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(kTemporaryPrefix) || name.find(".tmp") == std::string::npos) continue;
        std::error_code gone;
        const bool old = now - entry->last_write_time(gone) > std::chrono::hours(24);
        if (!gone && old && entry->is_regular_file(gone)) fs::remove(entry->path(), gone);
    }
}

std::string read_file(const fs::path& path) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number < 0) fail("cannot read {}: {}; check the path", path.string(), reason(errno));
    std::string bytes;
    std::error_code unknown;
    const uintmax_t size = fs::file_size(path, unknown);
    if (!unknown) bytes.reserve(size);
    char block[1 << 16];
    for (;;) {
        const ssize_t count = ::read(file.number, block, sizeof block);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("cannot read {}: {}; check the path", path.string(), reason(errno));
        if (count == 0) break;
        bytes.append(block, size_t(count));
    }
    if (bytes.empty()) fail("cannot read {}: the file is empty; it was not written to the end", path.string());
    return bytes;
}

void store_file(const fs::path& path, std::string_view bytes) {
    store_parts(path, bytes.size(), [&] { return std::exchange(bytes, {}); });
}

void store_parts(const fs::path& path, uint64_t size, const NextPart& next) {
    write_atomically(path, [&](const fs::path& temporary) {
        if (const int error = write_parts(temporary, next))
            fail("cannot write {}: {}; {} bytes are needed there", path.string(), reason(error), size);
    });
}

void check_size(std::string_view doing, const fs::path& path, int64_t width, int64_t height) {
    if (width <= 0 || height <= 0)
        fail("cannot {} {}: an image of {} x {} pixels is empty; each side needs at least one", doing, path.string(),
             width, height);
    if (width > max_side || height > max_side || uint64_t(width) * uint64_t(height) > max_pixels)
        fail("cannot {} {}: {} x {} pixels are too many; at most {} a side and {} in all are supported", doing,
             path.string(), width, height, max_side, max_pixels);
}

}  // namespace peelray
