// SPDX-License-Identifier: Apache-2.0
#include "woodcock/denoise/library.h"

#include <dlfcn.h>

#include <type_traits>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"

namespace woodcock::denoise {

namespace {

constexpr int versionNeeded = 2;

std::string messageOf(const Functions& functions, DeviceHandle device) {
    const char* message = nullptr;
    if (functions.getDeviceError(device, &message) == 0) return "";
    return message && *message ? shown(message) : "an error without a message";
}

std::string loaderMessage() {
    const char* message = dlerror();
    return message ? shown(message) : "the loader does not say why";
}

/// Looks up all functions; throws Error{Usage} where one is not there.
void lookUp(void* library, const std::filesystem::path& file, Functions& functions) {
    const auto find = [&](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
        if (!function)
            throw usageError("'{}' is not Open Image Denoise {}: it has no function {}",
                             file.string(), versionNeeded, name);
    };
    find(functions.newDevice, "oidnNewDevice");
    find(functions.setDeviceBool, "oidnSetDeviceBool");
    find(functions.setDeviceInt, "oidnSetDeviceInt");
    find(functions.getDeviceInt, "oidnGetDeviceInt");
    find(functions.commitDevice, "oidnCommitDevice");
    find(functions.getDeviceError, "oidnGetDeviceError");
    find(functions.releaseDevice, "oidnReleaseDevice");
    find(functions.newFilter, "oidnNewFilter");
    find(functions.setFilterImage, "oidnSetSharedFilterImage");
    find(functions.setFilterBool, "oidnSetFilterBool");
    find(functions.setFilterInt, "oidnSetFilterInt");
    find(functions.commitFilter, "oidnCommitFilter");
    find(functions.executeFilter, "oidnExecuteFilter");
    find(functions.releaseFilter, "oidnReleaseFilter");
}

/// Of a library that the loader found by its name.
std::filesystem::path fileOf(const Functions& functions, const std::filesystem::path& asked) {
    Dl_info info{};
    const bool known = dladdr(reinterpret_cast<void*>(functions.newDevice), &info) != 0;
    return known && info.dli_fname ? std::filesystem::path(info.dli_fname) : asked;
}

/// "2.5.1"; throws Error{Usage} on another version than is needed.
std::string versionOf(const Functions& functions, DeviceHandle device) {
    const int major = functions.getDeviceInt(device, "versionMajor");
    const std::string version =
        fmt::format("{}.{}.{}", major, functions.getDeviceInt(device, "versionMinor"),
                    functions.getDeviceInt(device, "versionPatch"));
    if (major != versionNeeded)
        throw usageError("'{}' is Open Image Denoise {}, and version {} is needed",
                         functions.file.string(), version, versionNeeded);
    return version;
}

}  // namespace

Functions loadFunctions(const std::filesystem::path& file, bool& missing) {
    missing = false;
    void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        const std::string message = loaderMessage();
        missing = message.starts_with(file.string() + ": ") &&
                  message.find("No such file") != std::string::npos;
        throw usageError("'{}' cannot be loaded: {}", file.string(), message);
    }
    Functions functions;
    lookUp(library, file, functions);
    functions.file = fileOf(functions, file);
    try {
        const Device device(functions, 1);
        functions.version = versionOf(functions, device.get());
        device.check();
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Usage) throw;
        throw usageError("'{}' does not work: {}", functions.file.string(), e.what());
    }
    return functions;
}

Device::Device(const Functions& functions, int threads)
    : functions_(functions), handle_(functions.newDevice(cpuDevice)) {
    if (!handle_) {
        const std::string message = messageOf(functions, nullptr);
        throw failure("Open Image Denoise has no device for this processor{}{}",
                      message.empty() ? "" : ": ", message);
    }
    // Else it ties its threads, which may be ours, to cores.
    functions.setDeviceBool(handle_, "setAffinity", false);
    if (threads > 0) functions.setDeviceInt(handle_, "numThreads", threads);
    functions.commitDevice(handle_);
    try {
        check();
    } catch (...) {
        functions.releaseDevice(handle_);
        throw;
    }
}

void Device::check() const {
    if (const std::string message = messageOf(functions_, handle_); !message.empty())
        throw failure("Open Image Denoise fails: {}", message);
}

}  // namespace woodcock::denoise
