#include "gpu/instance.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <mutex>

#include "base/error.h"
#include "base/text.h"

namespace peelray {
namespace {

const char* const kNoDriver =
    "no Vulkan driver found: install one (Debian/Ubuntu: the package mesa-vulkan-drivers runs on any CPU)";

void load_vulkan() {
    if (!has_vulkan_loader())
        fail("no Vulkan loader found: install one (Debian/Ubuntu: packages libvulkan1 and mesa-vulkan-drivers)");
}

bool layer_available(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [&](auto& layer) { return !std::strcmp(layer.layerName, name); });
}

bool instance_extension_available(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 3;
        default:
            return 4;
    }
}

/// What the device lacks of the features that the passes use; empty: nothing.
std::string missing_features(VkPhysicalDevice device, uint32_t api_version, uint32_t& queue_family) {
    if (api_version < VK_API_VERSION_1_3) return "Vulkan 1.3";
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    if (!v12.scalarBlockLayout) return "scalarBlockLayout";
    if (!v12.hostQueryReset) return "hostQueryReset";
    if (!v13.synchronization2) return "synchronization2";
    if (!v13.dynamicRendering) return "dynamicRendering";
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (queue_family = 0; queue_family < count; queue_family++) {
        const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[queue_family].queueFlags & both) == both) return "";
    }
    return "a queue with graphics and compute";
}

PhysicalDevice describe(VkPhysicalDevice device) {
    PhysicalDevice result{device, {}, 0};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    const auto& p = properties.properties;
    const char* kinds[] = {"discrete", "integrated", "virtual", "CPU", "other"};
    result.info.name = p.deviceName;
    result.info.kind = kinds[rank(p.deviceType)];
    result.info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    result.info.api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(p.apiVersion),
                                          VK_API_VERSION_MINOR(p.apiVersion), VK_API_VERSION_PATCH(p.apiVersion));
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    result.info.memory = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            result.info.memory = std::max<uint64_t>(result.info.memory, memory.memoryHeaps[i].size);
    result.info.lacking = missing_features(device, p.apiVersion, result.queue_family);
    result.info.usable = result.info.lacking.empty();
    return result;
}

}  // namespace

bool has_vulkan_loader() {
    static std::once_flag once;
    static VkResult result = VK_ERROR_INITIALIZATION_FAILED;
    std::call_once(once, [] { result = volkInitialize(); });
    return result == VK_SUCCESS;
}

VkInstance create_instance(bool validate, const VkDebugUtilsMessengerCreateInfoEXT* messenger, bool& debug_utils) {
    load_vulkan();
    const char* layer = "VK_LAYER_KHRONOS_validation";
    if (validate && !layer_available(layer))
        fail("{} needs the Vulkan validation layers: install them (Debian/Ubuntu: package vulkan-validationlayers)",
             setting::validate);
    debug_utils = instance_extension_available(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "peelray";
    application.apiVersion = VK_API_VERSION_1_3;
    // Synchronisation validation proves the derived barriers; the messenger here also hears of instance creation
    // itself.
    const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, messenger, 1, enabled};
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validate ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = validate ? 1 : 0;
    info.ppEnabledLayerNames = &layer;
    info.enabledExtensionCount = debug_utils ? 1 : 0;
    info.ppEnabledExtensionNames = &extension;
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) fail("{}", kNoDriver);
    check_vulkan(result, "creating the Vulkan instance");
    volkLoadInstanceOnly(instance);
    return instance;
}

std::vector<PhysicalDevice> physical_devices(VkInstance instance) {
    uint32_t count = 0;
    if (vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS || count == 0) fail("{}", kNoDriver);
    std::vector<VkPhysicalDevice> handles(count);
    check_vulkan(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "listing the Vulkan devices");
    handles.resize(count);
    auto type = [](VkPhysicalDevice device) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        return rank(properties.deviceType);
    };
    std::stable_sort(handles.begin(), handles.end(), [&](auto a, auto b) { return type(a) < type(b); });
    std::vector<PhysicalDevice> devices;
    for (auto handle : handles) {
        devices.push_back(describe(handle));
        devices.back().info.index = uint32_t(devices.size() - 1);
    }
    return devices;
}

PhysicalDevice choose_device(VkInstance instance, const std::string& select) {
    const auto devices = physical_devices(instance);
    std::string names;
    for (const auto& device : devices)
        names += fmt::format("{}{}: {}", names.empty() ? "" : ", ", device.info.index, device.info.name);
    const PhysicalDevice* chosen = nullptr;
    const bool number =
        !select.empty() && std::all_of(select.begin(), select.end(), [](unsigned char c) { return std::isdigit(c); });
    for (const auto& device : devices) {
        const bool match = select.empty() ? device.info.usable
                           : number       ? std::to_string(device.info.index) == select
                                          : lower_case(device.info.name).find(lower_case(select)) != std::string::npos;
        if (match && !chosen) chosen = &device;
    }
    if (!chosen && !select.empty()) fail("no Vulkan device '{}': there is {} (see 'peelray devices')", select, names);
    if (!chosen) chosen = &devices.front();
    if (!chosen->info.usable)
        fail(
            "the Vulkan device '{}' lacks {}, which Peelray needs: update its driver or choose another {} (there is "
            "{})",
            chosen->info.name, chosen->info.lacking, setting::device, names);
    return *chosen;
}

/// What is to be found out of an instance that is there for that alone.
template <typename Find>
static auto find_in_instance(Find find) {
    struct Instance {
        bool debug_utils = false;
        VkInstance handle = create_instance(false, nullptr, debug_utils);
        ~Instance() { vkDestroyInstance(handle, nullptr); }
    } instance;
    return find(instance.handle);
}

std::vector<DeviceInfo> list_devices() {
    return find_in_instance([](VkInstance instance) {
        std::vector<DeviceInfo> infos;
        for (const auto& device : physical_devices(instance)) infos.push_back(device.info);
        return infos;
    });
}

DeviceInfo device_info(const std::string& select) {
    return find_in_instance([&](VkInstance instance) { return choose_device(instance, select).info; });
}

}  // namespace peelray
