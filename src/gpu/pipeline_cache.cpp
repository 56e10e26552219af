#include "gpu/pipeline_cache.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/search_path.h"

namespace peelray {
namespace {

struct Header {
    char magic[8];
    uint64_t size, checksum;
};
constexpr char kMagic[8] = {'P', 'E', 'E', 'L', 'P', 'C', '0', '1'};

uint64_t fnv1a(const char* data, size_t size) {
    uint64_t hash = 14695981039346656037ull;
    for (size_t i = 0; i < size; i++) hash = (hash ^ uint8_t(data[i])) * 1099511628211ull;
    return hash;
}

}  // namespace

std::vector<char> PipelineCache::seal(const std::vector<char>& data) {
    Header header{{}, data.size(), fnv1a(data.data(), data.size())};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    std::vector<char> file(sizeof header + data.size());
    std::memcpy(file.data(), &header, sizeof header);
    if (!data.empty()) std::memcpy(file.data() + sizeof header, data.data(), data.size());
    return file;
}

std::vector<char> PipelineCache::unseal(const std::vector<char>& file) {
    Header header;
    if (file.size() < sizeof header) return {};
    std::memcpy(&header, file.data(), sizeof header);
    const char* data = file.data() + sizeof header;
    const size_t size = file.size() - sizeof header;
    if (std::memcmp(header.magic, kMagic, sizeof kMagic) || header.size != size || header.checksum != fnv1a(data, size))
        return {};
    return {data, data + size};
}

std::filesystem::path PipelineCache::file_for(const VkPhysicalDeviceProperties& properties) {
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    const std::filesystem::path folder = cache_folder(xdg ? xdg : "", home ? home : "");
    if (folder.empty()) return {};
    std::string uuid;
    for (uint8_t byte : properties.pipelineCacheUUID) uuid += fmt::format("{:02x}", byte);
    return folder / fmt::format("pipelines-{:04x}-{:04x}-{}.bin", properties.vendorID, properties.deviceID, uuid);
}

PipelineCache::PipelineCache(Device& device, bool on_disk) : device_(device) {
    if (on_disk) file_ = file_for(device.properties());
    if (!file_.empty()) {
        std::ifstream stream(file_, std::ios::binary);
        std::ostringstream read;
        read << stream.rdbuf();  // no exception where reading fails (a folder in the file's place)
        const std::string file = read.str();
        loaded_ = unseal({file.begin(), file.end()});
    }
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = loaded_.size();
    info.pInitialData = loaded_.data();
    check_vulkan(device.vk.vkCreatePipelineCache(device.handle, &info, nullptr, &cache_),
                 "creating the pipeline cache");
}

PipelineCache::~PipelineCache() {
    size_t size = 0;
    std::vector<char> data;
    if (!file_.empty() && device_.vk.vkGetPipelineCacheData(device_.handle, cache_, &size, nullptr) == VK_SUCCESS &&
        size) {
        data.resize(size);
        if (device_.vk.vkGetPipelineCacheData(device_.handle, cache_, &size, data.data()) != VK_SUCCESS) data.clear();
    }
    device_.vk.vkDestroyPipelineCache(device_.handle, cache_, nullptr);
    if (data.empty() || data == loaded_) return;
    // Several processes may end at once: each writes its own file, the rename is atomic, the last one wins.
    std::error_code error;
    std::filesystem::create_directories(file_.parent_path(), error);
    const std::filesystem::path temporary = fmt::format("{}.{}.tmp", file_.string(), getpid());
    const auto file = seal(data);
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(file.data(), std::streamsize(file.size()));
    stream.close();
    if (stream.good()) std::filesystem::rename(temporary, file_, error);
    std::filesystem::remove(temporary, error);
}

}  // namespace peelray
