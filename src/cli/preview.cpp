#include "cli/preview.h"

#include <algorithm>

#include "base/error.h"
#include "cli/messages.h"
#include "cli/picture_files.h"

namespace peelray {

Preview::~Preview() {
    std::error_code error;
    if (written_) std::filesystem::remove(path_, error);
}

void Preview::update(const std::function<Picture()>& look) {
    const Clock::time_point start = Clock::now();
    if (path_.empty() || start < due_) return;
    write(look());
    const Clock::time_point end = Clock::now();
    due_ = end + std::max<Clock::duration>(std::chrono::seconds(1), 10 * (end - start));
}

void Preview::finish(const Picture& picture) {
    if (!path_.empty()) write(picture);
    written_ = false;
}

void Preview::write(const Picture& picture) {
    try {
        write_picture(picture, {}, path_);
        written_ = true;
    } catch (const Error& error) {
        print_note(fmt::format("there is no preview any more: {}", error.text()));
        path_.clear();
        written_ = false;
    }
}

}  // namespace peelray
