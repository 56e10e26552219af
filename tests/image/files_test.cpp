// Writing: never a partial file, never a stray one, and the reason in the error.
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "image/image.h"
#include "temp_folder.h"

namespace fs = std::filesystem;

namespace peelray {
namespace {

using Files = TempFolder;

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST_F(Files, WritesThroughATemporaryInTheSameFolder) {
    const fs::path path = folder / "out.png";
    fs::path seen;
    write_atomically(path, [&](const fs::path& temporary) {
        seen = temporary;
        EXPECT_EQ(temporary.parent_path(), folder);
        EXPECT_EQ(temporary.extension(), ".png");
        EXPECT_FALSE(fs::exists(path));
        write_text(temporary, "all");
    });
    EXPECT_NE(seen, path);
    EXPECT_EQ(get(path), "all");
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, KeepsTheOldFileWhenWritingFails) {
    const fs::path path = put("out.txt", "old");
    EXPECT_THROW(write_atomically(path,
                                  [](const fs::path& temporary) {
                                      write_text(temporary, "ha");
                                      throw std::runtime_error("broken half-way");
                                  }),
                 std::runtime_error);
    EXPECT_EQ(get(path), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, ReplacesAnOldFileAndKeepsItsMode) {
    const fs::path path = put("out.txt", "a longer old text");
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    write_atomically(path, [](const fs::path& temporary) { write_text(temporary, "new"); });
    EXPECT_EQ(get(path), "new");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
}

TEST_F(Files, OfManyThatWriteIfAbsentOneDoes) {
    const fs::path path = folder / "out.json";
    std::atomic<int> started{0}, wrote{0};
    std::vector<std::thread> writers;
    for (int i = 0; i < 8; i++)
        writers.emplace_back([&, i] {
            // All have looked and found nothing before the first one is done.
            wrote += write_if_absent(path, [&](const fs::path& temporary) {
                write_text(temporary, std::to_string(i));
                started++;
                while (started < 8) std::this_thread::yield();
            });
        });
    for (std::thread& writer : writers) writer.join();
    EXPECT_EQ(wrote, 1);
    EXPECT_EQ(files(), 1u);
    const std::string first = get(path);
    EXPECT_EQ(first.size(), 1u);
    EXPECT_FALSE(write_if_absent(path, [](const fs::path& temporary) { write_text(temporary, "late"); }));
    EXPECT_EQ(get(path), first);
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, FollowsALink) {
    fs::create_directory(folder / "there");
    const fs::path target = put("there/real.txt", "old");
    fs::create_symlink(target, folder / "link.txt");
    write_atomically(folder / "link.txt", [](const fs::path& temporary) { write_text(temporary, "new"); });
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(get(target), "new");
}

TEST_F(Files, CheckWritableLeavesNoTrace) {
    check_writable(folder / "new.png");
    EXPECT_EQ(files(), 0u);
    const fs::path old = put("old.png", "content");
    const auto time = fs::last_write_time(old);
    check_writable(old);
    EXPECT_EQ(get(old), "content");
    EXPECT_EQ(fs::last_write_time(old), time);
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, AcceptsANameInTheCurrentFolderAndTheLongestName) {
    const fs::path before = fs::current_path();
    fs::current_path(folder);
    EXPECT_NO_THROW(check_writable("plain.png"));
    EXPECT_NO_THROW(check_writable(std::string(251, 'x') + ".png"));
    write_atomically(std::string(251, 'x') + ".png", [](const fs::path& temporary) { write_text(temporary, "x"); });
    fs::current_path(before);
    EXPECT_EQ(files(), 1u);
}

/// Root may write into read-only folders, hence places where nobody can.
TEST_F(Files, SaysWhyAPlaceIsNotWritable) {
    const fs::path file = put("file", "x");
    for (const auto& [path, reason] : std::initializer_list<std::pair<fs::path, std::string>>{
             {folder, "is a folder"},
             {folder / "", "is a folder"},
             {folder / "new/", "is a folder"},
             {file / "out.png", "is not a folder"},
             {"/proc/out.png", "/proc/out.png"},
             {"/dev/null", "not a regular file"},
             {folder / (std::string(300, 'x') + ".png"), "File name too long"},
             {"", "without a name"}}) {
        expect_error([&] { check_writable(path); }, reason);
        bool called = false;
        expect_error([&] { write_atomically(path, [&](const fs::path&) { called = true; }); }, reason);
        EXPECT_FALSE(called);
    }
    EXPECT_EQ(files(), 1u);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Files, AFullDiskIsAnErrorAndLeavesNothing) {
    // A limit on the size of files does to write() what a full disk does.
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    rlimit small = old;
    small.rlim_cur = 1000;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    Image noise{64, 64, {}};
    for (uint32_t i = 0; i < 64 * 64; ++i)
        noise.pixels.emplace_back(float(i * 2654435761u >> 8), float(i % 77), float(i), 1);
    expect_error([&] { write_hdr(folder / "big.exr", noise, {.half = false}); }, "File too large");
    expect_error([&] { write_hdr(folder / "big.hdr", noise); }, "File too large");
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(files(), 0u);
}

TEST_F(Files, ManyWritersOfOneFileNeverMix) {
    const fs::path path = folder / "shared.txt";
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&, i] {
            for (int k = 0; k < 20; ++k)
                write_atomically(path, [&](const fs::path& t) { write_text(t, std::string(5000, char('a' + i))); });
        });
    for (std::thread& thread : threads) thread.join();
    const std::string text = get(path);
    EXPECT_EQ(text, std::string(5000, text.at(0)));
    EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace peelray
