// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace woodcock::denoise {

// The part of Open Image Denoise's C interface that is used here, as its manual has it (2.x,
// section "API Overview"). Booleans are C's.
struct OpaqueDevice;
struct OpaqueFilter;
using DeviceHandle = OpaqueDevice*;
using FilterHandle = OpaqueFilter*;

inline constexpr int cpuDevice = 1;    ///< OIDN_DEVICE_TYPE_CPU
inline constexpr int threeFloats = 3;  ///< OIDN_FORMAT_FLOAT3

/// Its functions, loaded from a file. They stay loaded until the program ends.
struct Functions {
    DeviceHandle (*newDevice)(int type) = nullptr;
    void (*setDeviceBool)(DeviceHandle, const char* name, bool value) = nullptr;
    void (*setDeviceInt)(DeviceHandle, const char* name, int value) = nullptr;
    int (*getDeviceInt)(DeviceHandle, const char* name) = nullptr;
    void (*commitDevice)(DeviceHandle) = nullptr;
    /// 0: none. The first error since the last call; without a device, the thread's.
    int (*getDeviceError)(DeviceHandle, const char** message) = nullptr;
    void (*releaseDevice)(DeviceHandle) = nullptr;
    FilterHandle (*newFilter)(DeviceHandle, const char* type) = nullptr;
    void (*setFilterImage)(FilterHandle, const char* name, void* pixels, int format,
                           std::size_t width, std::size_t height, std::size_t byteOffset,
                           std::size_t pixelStride, std::size_t rowStride) = nullptr;
    void (*setFilterBool)(FilterHandle, const char* name, bool value) = nullptr;
    void (*setFilterInt)(FilterHandle, const char* name, int value) = nullptr;
    void (*commitFilter)(FilterHandle) = nullptr;
    void (*executeFilter)(FilterHandle) = nullptr;
    void (*releaseFilter)(FilterHandle) = nullptr;

    std::filesystem::path file = {};  ///< that they are of, as the loader found it
    std::string version = {};         ///< "2.5.1"
};

/// Loads a library by its path, or by its name, where the loader looks for it. Throws
/// Error{Usage} where it cannot be loaded, or is none of version 2, or finds no device. Where there
/// is no library of this name, `missing` is true behind that.
Functions loadFunctions(const std::filesystem::path& file, bool& missing);

/// A device on the processor. Throws Error{Failure}.
class Device {
public:
    Device(const Functions& functions, int threads);
    ~Device() { functions_.releaseDevice(handle_); }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    DeviceHandle get() const { return handle_; }
    /// Throws Error{Failure} with what went wrong, if anything did.
    void check() const;

private:
    const Functions& functions_;
    DeviceHandle handle_;
};

}  // namespace woodcock::denoise
