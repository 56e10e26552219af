// A folder of its own for each test, and what the tests say about errors.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"

namespace peelray {

class TempFolder : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "peelray-test-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::filesystem::path put(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder / name, std::ios::binary) << bytes;
        return folder / name;
    }
    static std::string get(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    size_t files() const { return size_t(std::distance(std::filesystem::recursive_directory_iterator(folder), {})); }

    std::filesystem::path folder;
};

/// `work` must throw an Error of one line that says `part` somewhere.
template <typename Work>
void expect_error(Work&& work, const std::string& part) {
    try {
        work();
        ADD_FAILURE() << "no error; expected: " << part;
    } catch (const Error& error) {
        const std::string text = error.line("--");
        EXPECT_NE(text.find(part), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
}

}  // namespace peelray
