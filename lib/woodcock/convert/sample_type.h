// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/error.h"

namespace woodcock::convert {

/// How a number of a dense volume is stored.
enum class SampleType { U8, I8, U16, I16, U32, I32, U64, I64, F16, F32, F64 };

/// Sixteen bits that are an IEEE half.
struct HalfBits {
    std::uint16_t bits = 0;
};

/// Calls `use` with a value of the C++ type that the samples have (HalfBits for F16).
template <class Use>
decltype(auto) withSampleType(SampleType type, Use&& use) {
    switch (type) {
        case SampleType::U8:
            return use(std::uint8_t{});
        case SampleType::I8:
            return use(std::int8_t{});
        case SampleType::U16:
            return use(std::uint16_t{});
        case SampleType::I16:
            return use(std::int16_t{});
        case SampleType::U32:
            return use(std::uint32_t{});
        case SampleType::I32:
            return use(std::int32_t{});
        case SampleType::U64:
            return use(std::uint64_t{});
        case SampleType::I64:
            return use(std::int64_t{});
        case SampleType::F16:
            return use(HalfBits{});
        case SampleType::F64:
            return use(double{});
        case SampleType::F32:
            break;
    }
    return use(float{});
}

std::size_t sampleBytes(SampleType type);
const char* sampleTypeName(SampleType type);  ///< "u8", "f32", ...
std::vector<std::string> sampleTypeNames();

/// Errors: Usage, listing the names.
SampleType sampleTypeFromName(std::string_view name);

/// True where floats hold every value of the type exactly.
bool fitsFloat(SampleType type);

/// The bytes of one sample in the other order.
template <class T>
T swapBytes(T value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

}  // namespace woodcock::convert
