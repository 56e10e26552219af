// A device with the validation layers on, shared by all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "gpu/commands.h"
#include "gpu/device.h"

namespace peelray {

/// Tests on one device, which is opened once (compiling shaders is what takes time). A test fails when the validation
/// layers, synchronization validation included, say anything while it runs.
class DeviceTest : public testing::Test {
  protected:
    static Device& device() {
        static Device shared(DeviceOptions{"", true});
        return shared;
    }
    static const std::vector<std::string>& messages() { return device().validation_messages(); }

    void SetUp() override { said_before_ = messages().size(); }
    void TearDown() override {
        // Only what is new: one bad test shall not fail all later ones.
        for (size_t i = said_before_; i < messages().size(); i++)
            ADD_FAILURE() << "validation layers: " << messages()[i];
    }

    template <typename T>
    Buffer upload(const std::vector<T>& data, const std::string& name = "test data") {
        Buffer buffer(device(), name, data.size() * sizeof(T));
        commands().upload(buffer, std::span<const T>(data));
        return buffer;
    }
    template <typename T>
    std::vector<T> download(const Buffer& buffer, uint64_t count, uint64_t offset = 0) {
        return commands().download<T>(buffer, count, offset);
    }
    Commands& commands() {
        if (!commands_) commands_ = std::make_unique<Commands>(device());
        return *commands_;
    }

  private:
    size_t said_before_ = 0;
    std::unique_ptr<Commands> commands_;
};

/// `work` must throw an Error of one line that holds every one of `parts`.
template <typename Work>
void expect_error(Work&& work, std::initializer_list<std::string> parts) {
    try {
        work();
        ADD_FAILURE() << "no error; expected: " << *parts.begin();
    } catch (const Error& error) {
        const std::string text = error.line("--");
        for (const auto& part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
}

}  // namespace peelray
