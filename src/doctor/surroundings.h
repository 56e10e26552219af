// Where the doctor looks for what a machine has: one place, so that tests can stage a machine in a folder.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace peelray {

struct Surroundings {
    std::filesystem::path root = "/";  ///< under which are dev, etc, proc, sys, usr
    /// Of the environment.
    std::function<std::optional<std::string>(const char* name)> variable;
    /// Who asks: whether a file may be used follows from its mode, owner and group.
    uid_t user = 0;
    std::vector<gid_t> groups;
    /// Why a shared library cannot be loaded; empty: it can.
    std::function<std::string(const std::string& library)> loading_fault;

    /// This process on this machine.
    static Surroundings real();

    /// A place in the machine, as "dev/dri".
    std::filesystem::path at(const std::filesystem::path& place) const { return root / place; }
    bool has(const std::filesystem::path& place) const;
    /// The first bytes of a file; empty where there is none.
    std::string text(const std::filesystem::path& place) const;
    /// Names in a folder that begin with `prefix`, sorted, as places; none where there is no such folder.
    std::vector<std::filesystem::path> files(const std::filesystem::path& folder, std::string_view prefix = "") const;
    std::string variable_or(const char* name, const std::string& otherwise) const;
    /// May it be read and written by who asks? Files that are not there may.
    bool may_use(const std::filesystem::path& place) const;
    /// The name of its group, or the number.
    std::string group_of(const std::filesystem::path& place) const;
    /// Does the process run in a container (Docker, Podman, Kubernetes, LXC)?
    bool in_container() const;
};

/// A file that tells Vulkan's loader of a driver.
struct DriverFile {
    std::filesystem::path file;
    std::string library;  ///< as the file names it; empty: it is no such file
    std::string fault;    ///< why the library cannot be loaded; empty: it can
};

/// All that the loader finds, where it looks (LoaderDriverInterface.md of Vulkan-Loader): VK_DRIVER_FILES or
/// VK_ICD_FILENAMES instead of the usual folders, VK_ADD_DRIVER_FILES beside them.
std::vector<DriverFile> driver_files(const Surroundings& around);

}  // namespace peelray
